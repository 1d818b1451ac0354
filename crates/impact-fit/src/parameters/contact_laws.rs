//! Contacts of other laws than a spring and a damper, integrated step by step: what a fit must allow for where it
//! does not know the law.

/// A law of contact between bodies that only press.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Law {
    /// F = u + cu'
    KelvinVoigt,
    /// F = u (1 + cu')
    Linear,
    /// Hunt and Crossley: F = u^{3/2} (1 + cu')
    HuntCrossley,
    /// Tsuji: F = u^{3/2} + cu^{1/4} u', one R at every speed
    Tsuji,
    /// F = u³ (1 + cu')
    Cubic,
    /// Walton and Braun: F = u while loaded, F = (u − u₀)/R² while unloaded
    WaltonBraun,
}

impl Law {
    /// All but the first.
    pub(super) const OTHERS: [Self; 5] = [
        Self::Linear,
        Self::HuntCrossley,
        Self::Tsuji,
        Self::Cubic,
        Self::WaltonBraun,
    ];
}

/// What a short contact of unit duration and approach speed makes of the impact outside of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coefficients {
    /// Where both flights meet beyond the gap.
    pub(super) reach: f64,
    /// What an acceleration toward each other adds to the ratio of the speeds there.
    pub(super) press: f64,
    /// The same of βΩ, beside what it does as an acceleration before the impact.
    pub(super) drag: f64,
    /// What an acceleration toward each other adds to the speed at the end.
    pub(super) push: f64,
}

/// Acceleration by which the coefficients are differenced.
const SMALL: f64 = 2e-3;

impl Coefficients {
    /// Of a law with the damping that gives R.
    pub(super) fn of(law: Law, restitution: f64) -> Self {
        let contact = Contact::with_restitution(law, restitution);
        let alone = contact.run([0.0, 0.0]);
        let slope = |of: &dyn Fn(f64) -> f64| (of(SMALL) - of(-SMALL)) / (2.0 * SMALL) / alone.time;
        let press = slope(&|a| contact.run([a, 0.0]).outside([a, 0.0])[1]);
        // βΩ: u'' = −2βΩu', which before the impact is an acceleration of −2βΩ
        let decay = slope(&|b| contact.run([0.0, 2.0 * b]).outside([0.0, 2.0 * b])[1]);
        Self {
            reach: alone.outside([0.0, 0.0])[0] / alone.time,
            press,
            drag: decay + 2.0 * press,
            push: slope(&|a| contact.run([a, 0.0]).speed),
        }
    }
}

/// A law with its damping.
#[derive(Debug, Clone, Copy)]
struct Contact {
    law: Law,
    damping: f64,
}

/// Where a contact ends.
#[derive(Debug, Clone, Copy)]
struct End {
    time: f64,
    overlap: f64,
    speed: f64,
}

impl End {
    /// Depth at which both flights meet, and the ratio of the speeds there: after over before.
    fn outside(&self, [push, decay]: [f64; 2]) -> [f64; 2] {
        let (before, after) = (push - decay, push - decay * self.speed);
        let gap = |s: f64| {
            let late = s - self.time;
            s + 0.5 * before * s * s
                - (self.overlap + self.speed * late + 0.5 * after * late * late)
        };
        let slope = |s: f64| 1.0 + before * s - self.speed - after * (s - self.time);
        let guess = (self.overlap - self.speed * self.time) / (1.0 - self.speed);
        let s = (0..20).fold(guess, |s, _| s - gap(s) / slope(s));
        let depth = s + 0.5 * before * s * s;
        let later = self.speed + after * (s - self.time);
        [depth, -later / (1.0 + before * s)]
    }
}

/// Steps of the integration in a unit of time.
const STEPS: f64 = 400.0;

impl Contact {
    fn with_restitution(law: Law, restitution: f64) -> Self {
        let (mut low, mut high) = (0.0, if law == Law::KelvinVoigt { 1.9 } else { 6.0 });
        if law == Law::WaltonBraun {
            (low, high) = (restitution, restitution);
        }
        for _ in 0..40 {
            let damping = 0.5 * (low + high);
            let found = -Self { law, damping }.run([0.0, 0.0]).speed;
            if found > restitution {
                low = damping;
            } else {
                high = damping;
            }
        }
        Self {
            law,
            damping: 0.5 * (low + high),
        }
    }

    /// Force at an overlap and its rate; `deepest`: the greatest overlap, once it has been passed.
    fn force(&self, [u, rate]: [f64; 2], deepest: Option<f64>) -> f64 {
        let (c, depth) = (self.damping, u.max(0.0));
        let force = match self.law {
            Law::KelvinVoigt => u + c * rate,
            Law::Linear => depth * (1.0 + c * rate),
            Law::HuntCrossley => depth.powf(1.5) * (1.0 + c * rate),
            Law::Tsuji => depth.powf(1.5) + c * depth.powf(0.25) * rate,
            Law::Cubic => depth.powi(3) * (1.0 + c * rate),
            Law::WaltonBraun => match deepest {
                Some(most) => (u - most * (1.0 - c * c)) / (c * c),
                None => u,
            },
        };
        force.max(0.0)
    }

    /// One step of Runge and Kutta's fourth order.
    fn step(
        &self,
        at: [f64; 2],
        h: f64,
        [push, decay]: [f64; 2],
        deepest: Option<f64>,
    ) -> [f64; 2] {
        let rate = |s: [f64; 2]| [s[1], push - decay * s[1] - self.force(s, deepest)];
        let moved = |k: [f64; 2], h: f64| [at[0] + h * k[0], at[1] + h * k[1]];
        let first = rate(at);
        let second = rate(moved(first, 0.5 * h));
        let third = rate(moved(second, 0.5 * h));
        let fourth = rate(moved(third, h));
        [0, 1].map(|i| at[i] + h / 6.0 * (first[i] + 2.0 * second[i] + 2.0 * third[i] + fourth[i]))
    }

    /// From first touch at unit speed to the end of the press, with an acceleration and a decay beside it.
    fn run(&self, beside: [f64; 2]) -> End {
        let (mut time, mut at, mut deepest) = (0.0, [0.0, 1.0], None);
        let h = 1.0 / STEPS;
        loop {
            let turns = |s: [f64; 2]| deepest.is_none() && s[1] < 0.0;
            let ends = |s: [f64; 2]| s[1] < 0.0 && self.force(s, deepest) <= 0.0;
            let next = self.step(at, h, beside, deepest);
            if !turns(next) && !ends(next) {
                (at, time) = (next, time + h);
                continue;
            }
            // a turn or the end lies within the step
            let (mut low, mut high) = (0.0, h);
            for _ in 0..50 {
                let middle = 0.5 * (low + high);
                let there = self.step(at, middle, beside, deepest);
                if turns(there) || ends(there) {
                    high = middle;
                } else {
                    low = middle;
                }
            }
            (at, time) = (self.step(at, low, beside, deepest), time + low);
            if deepest.is_none() {
                deepest = Some(at[0]);
                continue;
            }
            return End {
                time,
                overlap: at[0],
                speed: at[1],
            };
        }
    }
}
