"""Closed forms of equal masses: the resonance curve and motions z = 1/n (Peterka). Dimensionless."""

import math


def amplitude(eta, beta):
    """Amplitude of the impactless motion over the static deflection; as a clearance the grazing boundary."""
    return 1.0 / math.sqrt((1.0 - eta**2) ** 2 + 4.0 * beta**2 * eta**2)


def coefficients(eta, beta, restitution, n):
    """alpha and Q of the condition (rho - alpha v)^2 + (Q v / eta)^2 = A^2."""
    omega = math.sqrt(1.0 - beta**2)
    period = 2.0 * math.pi * n / eta
    e = math.exp(-beta * period)
    c, s = math.cos(omega * period), math.sin(omega * period)
    kappa = e * s / (1.0 - e * c)
    b = (1.0 + restitution) / (omega * (e * (c - s * kappa) - 1.0))
    alpha = kappa * b
    return alpha, -restitution + beta * alpha - omega * b


def saddle_node(eta, beta, restitution, n=1):
    """Clearance at which z = 1/n ends in a saddle-node."""
    alpha, q = coefficients(eta, beta, restitution, n)
    return amplitude(eta, beta) * math.sqrt(1.0 + (alpha * eta / q) ** 2)


def approach_speeds(eta, rho, beta, restitution, n=1):
    """Both speeds x' before the impact of z = 1/n, or none."""
    alpha, q = coefficients(eta, beta, restitution, n)
    a = alpha**2 + (q / eta) ** 2
    d = (alpha * rho) ** 2 - a * (rho**2 - amplitude(eta, beta) ** 2)
    if d < 0.0:
        return ()
    return tuple((alpha * rho + sign * math.sqrt(d)) / a for sign in (1.0, -1.0))


def crossing(function, target, low, high):
    """Where a function that falls from low to high takes the target."""
    for _ in range(80):
        middle = 0.5 * (low + high)
        if function(middle) > target:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
