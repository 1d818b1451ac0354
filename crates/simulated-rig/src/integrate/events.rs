//! What ends a smooth piece of motion, and where.

use super::piece::{Piece, Touch};
use crate::equations::{ContactModel, Phase4};

/// Steps shorter than this count as none.
pub(super) const SHORTEST: f64 = 1e-11;

/// What ends a smooth piece of motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Event {
    /// First touch, end of press, end of overlap or end of a dead zone, by the state of touch.
    Contact,
    /// Separating masses that overlap still are pressed together again.
    PressedAgain,
    /// Mass x turns, or starts to slide.
    TurnX,
    /// Mass y turns, or starts to slide.
    TurnY,
}

impl Event {
    pub(super) const ALL: [Self; 4] = [Self::Contact, Self::PressedAgain, Self::TurnX, Self::TurnY];
}

/// Where a step must end for an event.
pub(super) struct Crossing {
    pub(super) length: f64,
    /// Whether the event happens there; otherwise the step only comes closer.
    pub(super) fires: bool,
}

impl Piece {
    /// Positive until an event happens.
    fn margin(&self, event: Event, t: f64, s: &Phase4) -> f64 {
        let e = &self.equations;
        let drive = || e.drive(self.phase + e.eta * t);
        match event {
            Event::Contact => match (self.touch, &e.law) {
                (Touch::Apart, _) => -e.overlap(s),
                (Touch::Pressed, ContactModel::Compliant(c)) => c.press(e.overlap(s), s[1] + s[3]),
                (Touch::Joined, _) => {
                    let forces = e.free(drive(), s);
                    let slides = self.slides[0] + self.slides[1];
                    forces[0] + forces[1] - e.friction * slides
                }
                _ => e.overlap(s),
            },
            Event::PressedAgain => match (self.touch, &e.law) {
                (Touch::Recovering, ContactModel::Compliant(c)) => {
                    -c.press(e.overlap(s), s[1] + s[3])
                }
                _ => f64::INFINITY,
            },
            Event::TurnX | Event::TurnY if e.friction == 0.0 => f64::INFINITY,
            Event::TurnY if self.touch == Touch::Joined => f64::INFINITY,
            Event::TurnX | Event::TurnY => {
                let mass = usize::from(event == Event::TurnY);
                if self.slides[mass] == 0.0 {
                    e.friction - self.pull(mass, drive(), s).abs()
                } else {
                    self.slides[mass] * s[2 * mass + 1]
                }
            }
        }
    }

    /// Where an event's margin crosses zero within a step that ends at `to`.
    pub(super) fn crossing(&self, event: Event, length: f64, to: &Phase4) -> Option<Crossing> {
        let margin = |t: f64| self.margin(event, t, &self.moved(t));
        if self.margin(event, length, to) >= 0.0 {
            return None;
        }
        let start = self.margin(event, 0.0, &self.state);
        if start > 0.0 {
            let end = self.margin(event, length, to);
            return Some(Crossing {
                length: root(&margin, (length, start, end)),
                fires: true,
            });
        }
        // The last event left the margin at zero: it must become positive before it can cross.
        let mut shorter = 0.25 * length;
        while shorter > SHORTEST {
            if margin(shorter) > 0.0 {
                return Some(Crossing {
                    length: shorter,
                    fires: false,
                });
            }
            shorter *= 0.25;
        }
        Some(Crossing {
            length: 0.0,
            fires: true,
        })
    }
}

/// Root of `f`, positive at 0 and negative at the bracket's end, by the Illinois method
/// (Dowell and Jarratt 1971). `bracket`: its length, f at 0, f at the end.
fn root(f: &impl Fn(f64) -> f64, (length, start, end): (f64, f64, f64)) -> f64 {
    let (mut a, mut fa, mut b, mut fb) = (0.0, start, length, end);
    let mut last_side = 0;
    for _ in 0..80 {
        if b - a <= 1e-15 * length.max(1e-3) {
            break;
        }
        let c = (a * fb - b * fa) / (fb - fa);
        let fc = f(c);
        if fc == 0.0 {
            return c;
        }
        let side = if fc < 0.0 { -1 } else { 1 };
        if side < 0 {
            (b, fb) = (c, fc);
            fa *= if side == last_side { 0.5 } else { 1.0 };
        } else {
            (a, fa) = (c, fc);
            fb *= if side == last_side { 0.5 } else { 1.0 };
        }
        last_side = side;
    }
    b
}
