//! Lines before they are drawn: clipped, thinned, dashed.

/// A position in points from the upper left corner.
pub(crate) type Point = (f64, f64);

/// Largest distance in points by which thinning may move a line: no more than drawing units are apart.
const THINNING_TOLERANCE: f64 = 0.05;

/// A rectangle in points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rect {
    /// Left edge.
    pub left: f64,
    /// Upper edge.
    pub top: f64,
    /// Right edge.
    pub right: f64,
    /// Lower edge.
    pub bottom: f64,
}

impl Rect {
    /// A rectangle from its upper left corner and its size.
    pub fn new(left: f64, top: f64, width: f64, height: f64) -> Self {
        Self {
            left,
            top,
            right: left + width,
            bottom: top + height,
        }
    }

    /// Its corners, from the upper left one round.
    pub(crate) fn corners(&self) -> [Point; 4] {
        let (left, right) = (self.left, self.right);
        let (top, bottom) = (self.top, self.bottom);
        [(left, top), (right, top), (right, bottom), (left, bottom)]
    }

    /// Width.
    pub(crate) fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Height.
    pub(crate) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// Whether a point is inside or on the edge.
    pub(crate) fn contains(&self, (x, y): Point) -> bool {
        x >= self.left && x <= self.right && y >= self.top && y <= self.bottom
    }
}

/// The parts of a line inside a rectangle (Liang–Barsky, segment by segment).
/// Points that are not finite break the line.
pub fn clip(points: &[Point], rect: &Rect) -> Vec<Vec<Point>> {
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    let mut joined = false;
    for pair in points.windows(2) {
        match clip_segment(pair[0], pair[1], rect) {
            Some((from, to)) => {
                if !joined {
                    pieces.push(vec![from]);
                }
                if let Some(piece) = pieces.last_mut() {
                    piece.push(to);
                }
                joined = to == pair[1];
            }
            None => joined = false,
        }
    }
    pieces
}

fn clip_segment(a: Point, b: Point, rect: &Rect) -> Option<(Point, Point)> {
    if ![a.0, a.1, b.0, b.1].iter().all(|v| v.is_finite()) {
        return None;
    }
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let (mut t0, mut t1) = (0.0_f64, 1.0_f64);
    let edges = [
        (-dx, a.0 - rect.left),
        (dx, rect.right - a.0),
        (-dy, a.1 - rect.top),
        (dy, rect.bottom - a.1),
    ];
    for (p, q) in edges {
        if p == 0.0 {
            if q < 0.0 {
                return None;
            }
        } else if p < 0.0 {
            t0 = t0.max(q / p);
        } else {
            t1 = t1.min(q / p);
        }
    }
    let point = |t: f64| (a.0 + t * dx, a.1 + t * dy);
    let end = if t1 >= 1.0 { b } else { point(t1) };
    (t0 <= t1).then(|| (point(t0), end))
}

/// A polygon clipped to a rectangle (Sutherland–Hodgman).
pub(crate) fn clip_polygon(points: &[Point], rect: &Rect) -> Vec<Point> {
    let inside: [&dyn Fn(Point) -> f64; 4] = [
        &|p: Point| p.0 - rect.left,
        &|p: Point| rect.right - p.0,
        &|p: Point| p.1 - rect.top,
        &|p: Point| rect.bottom - p.1,
    ];
    inside.iter().fold(points.to_vec(), |polygon, edge| {
        clip_half_plane(&polygon, edge)
    })
}

fn clip_half_plane(points: &[Point], distance: &dyn Fn(Point) -> f64) -> Vec<Point> {
    let mut kept = Vec::with_capacity(points.len() + 4);
    for (i, &b) in points.iter().enumerate() {
        let a = points[(i + points.len() - 1) % points.len()];
        let (da, db) = (distance(a), distance(b));
        if (da < 0.0) != (db < 0.0) {
            let t = da / (da - db);
            kept.push((a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1)));
        }
        if db >= 0.0 {
            kept.push(b);
        }
    }
    kept
}

/// Leaves out points of a line that no reader could see missing (Douglas–Peucker).
pub(crate) fn thin(points: &[Point]) -> Vec<Point> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    keep[0] = true;
    keep[points.len() - 1] = true;
    let mut open = vec![(0, points.len() - 1)];
    while let Some((from, to)) = open.pop() {
        if let Some(far) = farthest(points, from, to) {
            keep[far] = true;
            open.push((from, far));
            open.push((far, to));
        }
    }
    points
        .iter()
        .zip(keep)
        .filter_map(|(&p, k)| k.then_some(p))
        .collect()
}

fn farthest(points: &[Point], from: usize, to: usize) -> Option<usize> {
    let (far, most) = (from + 1..to)
        .map(|i| (i, square_to_segment(points[i], points[from], points[to])))
        .fold(
            (0, 0.0),
            |best, next| if next.1 > best.1 { next } else { best },
        );
    (most > THINNING_TOLERANCE * THINNING_TOLERANCE).then_some(far)
}

/// Square of the distance of a point from the segment between two others.
fn square_to_segment(p: Point, a: Point, b: Point) -> f64 {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let square = dx * dx + dy * dy;
    let t = if square > 0.0 {
        ((p.0 - a.0) * dx + (p.1 - a.1) * dy) / square
    } else {
        0.0
    };
    let t = t.clamp(0.0, 1.0);
    let (across, down) = (p.0 - a.0 - t * dx, p.1 - a.1 - t * dy);
    across * across + down * down
}

/// A line cut into dashes.
pub(crate) fn dashes(points: &[Point], pattern: &[f64]) -> Vec<Vec<Point>> {
    let mut pieces = Vec::new();
    let mut current = vec![points[0]];
    let (mut index, mut left) = (0, pattern[0]);
    for pair in points.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            if length <= left {
                left -= length;
                current.push(to);
                break;
            }
            let t = left / length;
            from = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
            current.push(from);
            if index % 2 == 0 {
                pieces.push(std::mem::take(&mut current));
            }
            current = vec![from];
            index += 1;
            left = pattern[index % pattern.len()];
        }
    }
    if index % 2 == 0 && current.len() > 1 {
        pieces.push(current);
    }
    pieces
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn points() -> impl Strategy<Value = Vec<Point>> {
        proptest::collection::vec((-50.0..150.0f64, -50.0..150.0f64), 2..40)
    }

    proptest! {
        #[test]
        fn prop_clipped_lines_stay_inside(line in points()) {
            let rect = Rect::new(0.0, 0.0, 100.0, 100.0);
            for piece in clip(&line, &rect) {
                for (x, y) in piece {
                    prop_assert!(x > -1e-9 && x < 100.0 + 1e-9 && y > -1e-9 && y < 100.0 + 1e-9);
                }
            }
        }

        #[test]
        fn prop_thinning_moves_no_point_visibly(line in points()) {
            let kept = thin(&line);
            for &p in &line {
                let nearest = kept
                    .windows(2)
                    .map(|s| square_to_segment(p, s[0], s[1]).sqrt())
                    .fold(f64::INFINITY, f64::min);
                prop_assert!(nearest <= THINNING_TOLERANCE + 1e-9);
            }
            prop_assert_eq!(kept.first(), line.first());
            prop_assert_eq!(kept.last(), line.last());
        }

        #[test]
        fn prop_dashes_cover_their_share(length in 10.0..500.0f64) {
            let pieces = dashes(&[(0.0, 0.0), (length, 0.0)], &[3.0, 2.0]);
            let drawn: f64 = pieces.iter().map(|p| p[p.len() - 1].0 - p[0].0).sum();
            prop_assert!((drawn - 0.6 * length).abs() <= 2.0);
        }
    }

    #[test]
    fn a_straight_line_keeps_its_two_ends() {
        let line: Vec<Point> = (0..100)
            .map(|i| (f64::from(i), 2.0 * f64::from(i)))
            .collect();
        assert_eq!(thin(&line).len(), 2);
    }
}
