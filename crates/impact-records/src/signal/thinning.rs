//! Fewer points of many.

/// Every second, third … of points that are more than `most`.
pub fn thinned<T>(points: &[T], most: usize) -> impl Iterator<Item = &T> {
    points.iter().step_by(points.len().div_ceil(most).max(1))
}
