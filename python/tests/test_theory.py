"""Theory: closed forms and invariants."""

import numpy as np
import pytest

import impactid


def test_without_impacts_the_motion_is_the_linear_response():
    # X = A cos(ητ − …) with A = 1/√((1−η²)² + (2βη)²), far from any contact
    eta, beta = 0.8, 0.05
    motion = impactid.simulate(eta=eta, rho=50.0, damping_ratio=beta, skip_periods=200, periods=2)
    amplitude = 1 / np.hypot(1 - eta**2, 2 * beta * eta)
    assert np.max(np.abs(motion.x)) == pytest.approx(amplitude, rel=1e-3)
    np.testing.assert_allclose(motion.x, motion.y, atol=1e-9)
    assert not motion.joined.any()
    assert all(len(column) == 0 for column in motion.impacts.values())


def test_every_impact_has_the_restitution_asked_for():
    motion = impactid.simulate(eta=0.9, rho=0.5, restitution=0.6)
    before = motion.impacts["closing_speed_before"]
    after = motion.impacts["closing_speed_after"]
    assert len(before) > 3
    np.testing.assert_allclose(-after / before, 0.6, rtol=1e-9)
    # the masses never overlap by more than the samples' spacing allows
    assert np.max(motion.x + motion.y) < 2 * 0.5 + 1e-9


def test_a_boundary_is_found_both_ways():
    there = impactid.boundary("s2", restitution=0.6, eta=[1.05, 1.1])
    assert there.rho.shape == (2,) and there.valid.all()
    back = impactid.boundary("s2", restitution=0.6, rho=float(there.rho[1]))
    assert back.eta[0] == pytest.approx(1.1, abs=1e-6)


def test_a_boundary_that_does_not_exist_is_nan():
    none = impactid.boundary("s1", motion="2/1", eta=[1.25, 4.0])
    assert np.isfinite(none.rho[0]) and np.isnan(none.rho[1])
    np.testing.assert_array_equal(none.eta, [1.25, 4.0])
    assert not none.valid[1]
    none = impactid.boundary("s2", rho=200.0)
    assert np.isnan(none.eta[0]) and none.rho[0] == 200.0 and not none.valid[0]


def test_several_points_of_a_boundary_give_the_first():
    found = impactid.boundary("s1", motion="2/1", rho=-0.3)
    assert found.eta.shape == (1,)
    assert found.eta[0] == pytest.approx(1.25383, abs=1e-4)


def test_boundaries_of_no_motion_take_none():
    assert impactid.boundary("joined", eta=1.2).rho[0] == pytest.approx(-1)
    assert impactid.boundary("grazing", eta=1.2).rho[0] == pytest.approx(2.12322, abs=1e-5)
    with pytest.raises(impactid.ProgramError, match="motion"):
        impactid.boundary("grazing", motion="1/3", eta=1.2)


def test_wrong_arguments():
    with pytest.raises(ValueError, match="either eta or rho"):
        impactid.boundary("s2")
    with pytest.raises(ValueError, match="s2, s1, grazing.*s9"):
        impactid.boundary("s9", eta=1.0)
    with pytest.raises(TypeError, match="drive_ratio"):
        impactid.simulate(eta=1.0, rho=1.0, wobble=2.0)
    with pytest.raises(impactid.ProgramError):
        impactid.simulate(eta=1.0, rho=1.0, restitution=1.5)
