//! How a motion looks: each has its own shape and its own colour, distinguishable in grey and by the
//! colour-blind; and the pale tint of its region.

use impact_records::signal::whole;
use plotters::style::RGBColor;

use super::canvas::{Canvas, Colour, Point, Stroke};
use super::look;
use impact_records::motion::Motion;

/// Shape of a mark.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Shape {
    /// An open circle.
    Circle,
    /// A filled circle.
    Disc,
    /// A filled circle with a pale core.
    Target,
    /// A filled square.
    Square,
    /// An open square.
    Box,
    /// A filled triangle.
    Triangle,
    /// An open triangle.
    Delta,
    /// A filled triangle, point downward.
    Wedge,
    /// A filled diamond.
    Diamond,
    /// An open diamond.
    Lozenge,
    /// A filled five-pointed star.
    Star,
    /// An upright cross.
    Plus,
    /// A diagonal cross.
    Cross,
    /// A horizontal bar.
    Bar,
    /// A small dot.
    Dot,
}

/// How a motion is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct MotionLook {
    /// Shape of its marks.
    pub(crate) shape: Shape,
    /// Colour of its marks.
    pub colour: Colour,
    /// Tint of its region.
    pub tint: Colour,
}

/// The look of a motion: the common ones by name, all others by their p and n.
pub fn of(motion: &Motion) -> MotionLook {
    match motion {
        Motion::Impactless => looks(Shape::Circle, look::SLATE, 0.0),
        Motion::Periodic {
            impacts_p,
            periods_n,
            dead_zone,
        } => periodic(*impacts_p, *periods_n, *dead_zone),
        Motion::Beat => looks(Shape::Plus, look::BROWN, 0.16),
        Motion::Chaotic => looks(Shape::Cross, look::DARK_RED, 0.16),
        Motion::Sticking => looks(Shape::Bar, look::GREY, 0.22),
        Motion::Undetermined { .. } => looks(Shape::Dot, look::GREY, 0.10),
    }
}

fn periodic(p: u32, n: u32, dead_zone: bool) -> MotionLook {
    match (p, n, dead_zone) {
        (1, 1, false) => looks(Shape::Disc, look::BLUE, 0.17),
        (_, 1, true) => looks(Shape::Target, look::SKY, 0.26),
        (1, 2, _) => looks(Shape::Square, look::VERMILION, 0.17),
        (2, 2, _) => looks(Shape::Box, look::ORANGE, 0.26),
        (2, 1, _) => looks(Shape::Triangle, look::GREEN, 0.17),
        (1, 3, _) => looks(Shape::Diamond, look::PURPLE, 0.20),
        (1, 4, _) => looks(Shape::Wedge, look::PLUM, 0.17),
        (1, 5, _) => looks(Shape::Star, look::BROWN, 0.14),
        (2, 3 | 4, _) => looks(Shape::Lozenge, look::PURPLE, 0.10),
        (_, 1, _) => looks(Shape::Delta, look::GREEN, 0.10),
        _ => other(p, n),
    }
}

fn other(p: u32, n: u32) -> MotionLook {
    const SHAPES: [Shape; 4] = [Shape::Lozenge, Shape::Delta, Shape::Star, Shape::Wedge];
    const COLOURS: [Colour; 5] = [
        look::PLUM,
        look::ORANGE,
        look::BROWN,
        look::SKY,
        look::GREEN,
    ];
    let shape = SHAPES[(p as usize + 2 * n as usize) % SHAPES.len()];
    looks(
        shape,
        COLOURS[(2 * p as usize + n as usize) % COLOURS.len()],
        0.12,
    )
}

fn looks(shape: Shape, colour: Colour, depth: f64) -> MotionLook {
    MotionLook {
        shape,
        colour,
        tint: mix(colour, depth),
    }
}

/// A colour thinned with white.
pub fn mix(colour: Colour, depth: f64) -> Colour {
    let thin = |c: u8| {
        let thinned = whole::count((255.0 - depth * (255.0 - f64::from(c))).round());
        u8::try_from(thinned).unwrap_or(u8::MAX)
    };
    RGBColor(thin(colour.0), thin(colour.1), thin(colour.2))
}

/// Order of motions in legends: impactless, then periodic by n and p, then the rest.
pub fn order(motion: &Motion) -> (u32, u32, u32, bool) {
    match motion {
        Motion::Impactless => (0, 0, 0, false),
        Motion::Periodic {
            impacts_p,
            periods_n,
            dead_zone,
        } => (1, *periods_n, *impacts_p, *dead_zone),
        Motion::Beat => (2, 0, 0, false),
        Motion::Chaotic => (3, 0, 0, false),
        Motion::Sticking => (4, 0, 0, false),
        Motion::Undetermined { .. } => (5, 0, 0, false),
    }
}

/// The motions met, each label once, in the order of legends.
pub(crate) fn met<'a>(motions: impl IntoIterator<Item = &'a Motion>) -> Vec<&'a Motion> {
    let mut seen: Vec<&Motion> = Vec::new();
    for motion in motions {
        if !seen.iter().any(|m| m.label() == motion.label()) {
            seen.push(motion);
        }
    }
    seen.sort_by_key(|m| order(m));
    seen
}

/// Draws a mark of a radius in points, with a thin light rim that parts it from its neighbours.
pub(crate) fn draw(canvas: &mut Canvas, at: Point, radius: f64, mark: MotionLook) {
    draw_all(canvas, &[at], radius, mark);
}

/// Draws marks of one look; where they overlap, the outlines of all are seen.
pub(crate) fn draw_all(canvas: &mut Canvas, all: &[Point], radius: f64, mark: MotionLook) {
    for at in all {
        fill(canvas, *at, radius, mark);
    }
    for at in all {
        outline(canvas, *at, radius, mark);
    }
}

fn fill(canvas: &mut Canvas, at: Point, r: f64, mark: MotionLook) {
    let c = mark.colour;
    match mark.shape {
        Shape::Circle => canvas.disc(at, r, look::PAPER),
        Shape::Disc | Shape::Target => canvas.disc(at, r, c),
        Shape::Dot => canvas.disc(at, 0.55 * r, c),
        Shape::Box | Shape::Delta | Shape::Lozenge => {
            canvas.fill(&corners(at, r, mark.shape), look::PAPER);
        }
        Shape::Square | Shape::Triangle | Shape::Wedge | Shape::Diamond | Shape::Star => {
            canvas.fill(&corners(at, r, mark.shape), c);
        }
        Shape::Plus | Shape::Cross | Shape::Bar => {}
    }
}

fn outline(canvas: &mut Canvas, at: Point, r: f64, mark: MotionLook) {
    let (x, y) = at;
    let c = mark.colour;
    let thick = Stroke::solid(c, 0.32 * r);
    let rim = Stroke::solid(look::PAPER, 0.25);
    match mark.shape {
        Shape::Circle => canvas.ring(at, 0.85 * r, thick),
        Shape::Target => canvas.disc(at, 0.42 * r, look::PAPER),
        Shape::Disc | Shape::Dot => {}
        Shape::Box | Shape::Delta | Shape::Lozenge => {
            canvas.outline(&corners(at, r, mark.shape), thick);
        }
        Shape::Square | Shape::Triangle | Shape::Wedge | Shape::Diamond | Shape::Star => {
            canvas.outline(&corners(at, r, mark.shape), rim);
        }
        Shape::Plus => crossed(canvas, at, 1.1 * r, 0.0, c),
        Shape::Cross => crossed(canvas, at, 1.1 * r, 45.0, c),
        Shape::Bar => canvas.segment((x - r, y), (x + r, y), Stroke::solid(c, 0.6 * r)),
    }
}

/// The corners of a polygonal mark; of another there are none.
fn corners((x, y): Point, r: f64, shape: Shape) -> Vec<Point> {
    match shape {
        Shape::Square => regular(x, y, 1.15 * r, 4, 45.0),
        Shape::Box => regular(x, y, 1.1 * r, 4, 45.0),
        Shape::Triangle => regular(x, y + 0.15 * r, 1.3 * r, 3, 90.0),
        Shape::Delta => regular(x, y + 0.15 * r, 1.2 * r, 3, 90.0),
        Shape::Wedge => regular(x, y - 0.15 * r, 1.3 * r, 3, -90.0),
        Shape::Diamond => regular(x, y, 1.3 * r, 4, 0.0),
        Shape::Lozenge => regular(x, y, 1.2 * r, 4, 0.0),
        Shape::Star => star(x, y, 1.4 * r),
        _ => Vec::new(),
    }
}

fn regular(x: f64, y: f64, radius: f64, corners: u32, start_degrees: f64) -> Vec<Point> {
    (0..corners)
        .map(|i| {
            let a = (start_degrees + 360.0 * f64::from(i) / f64::from(corners)).to_radians();
            (x + radius * a.cos(), y - radius * a.sin())
        })
        .collect()
}

fn star(x: f64, y: f64, radius: f64) -> Vec<Point> {
    (0..10)
        .map(|i| {
            let a = (90.0 + 36.0 * f64::from(i)).to_radians();
            let r = if i % 2 == 0 { radius } else { 0.45 * radius };
            (x + r * a.cos(), y - r * a.sin())
        })
        .collect()
}

fn crossed(canvas: &mut Canvas, (x, y): Point, arm: f64, turn_degrees: f64, colour: Colour) {
    for quarter in [0.0, 90.0] {
        let a = f64::to_radians(turn_degrees + quarter);
        let (dx, dy) = (arm * a.cos(), arm * a.sin());
        canvas.segment(
            (x - dx, y - dy),
            (x + dx, y + dy),
            Stroke::solid(colour, 0.42 * arm),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn common_motions_differ_in_shape_and_in_colour() {
        let common: Vec<Motion> = vec![
            Motion::Impactless,
            Motion::periodic(1, 1),
            Motion::Periodic {
                impacts_p: 1,
                periods_n: 1,
                dead_zone: true,
            },
            Motion::periodic(1, 2),
            Motion::periodic(2, 2),
            Motion::periodic(2, 1),
            Motion::periodic(1, 3),
            Motion::periodic(1, 4),
            Motion::Beat,
            Motion::Chaotic,
        ];
        for (i, a) in common.iter().enumerate() {
            for b in &common[..i] {
                assert_ne!(of(a).shape, of(b).shape, "{a} and {b}");
                assert_ne!(of(a).colour, of(b).colour, "{a} and {b}");
            }
        }
    }

    #[test]
    fn legends_name_each_motion_once_in_order() {
        let motions = [
            Motion::Chaotic,
            Motion::periodic(1, 2),
            Motion::Impactless,
            Motion::periodic(1, 2),
        ];
        let labels: Vec<_> = met(&motions).iter().map(|m| m.label()).collect();
        assert_eq!(labels, ["0", "1/2", "chaotic"]);
    }
}
