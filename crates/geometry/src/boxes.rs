//! Axis-aligned boxes.

use super::ConvexPolygon;
use crate::frame::Vector;

/// An axis-aligned box.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// South-western corner.
    pub low: Vector,
    /// North-eastern corner.
    pub high: Vector,
}

impl Window {
    /// The box between two corners.
    pub fn new(low: Vector, high: Vector) -> Self {
        Self { low, high }
    }

    /// The smallest box around points; `None` without points.
    pub fn around<'a>(points: impl IntoIterator<Item = &'a Vector>) -> Option<Self> {
        let mut points = points.into_iter();
        let first = points.next()?;
        let alone = Self::at(*first);
        Some(points.fold(alone, |w, p| Self {
            low: w.low.inf(p),
            high: w.high.sup(p),
        }))
    }

    /// The box of one point.
    pub fn at(point: Vector) -> Self {
        Self {
            low: point,
            high: point,
        }
    }

    /// The box with `margin` more on every side.
    pub fn grown(&self, margin: f64) -> Self {
        Self {
            low: self.low.add_scalar(-margin),
            high: self.high.add_scalar(margin),
        }
    }

    /// Size, `high - low`.
    pub fn size(&self) -> Vector {
        self.high - self.low
    }

    /// Centre.
    pub fn center(&self) -> Vector {
        (self.low + self.high) / 2.0
    }

    /// True for a point inside; false for NaN.
    pub fn contains(&self, p: Vector) -> bool {
        p.x >= self.low.x && p.x <= self.high.x && p.y >= self.low.y && p.y <= self.high.y
    }

    /// True where two boxes have a point in common. A NaN is near.
    pub fn meets(&self, other: &Self) -> bool {
        // negated so that a NaN is near
        !(self.low.x > other.high.x
            || self.low.y > other.high.y
            || self.high.x < other.low.x
            || self.high.y < other.low.y)
    }

    /// Vertices of the part of a convex set inside the box, counter-clockwise; empty where there is
    /// none.
    pub fn part_of(&self, set: &ConvexPolygon) -> Vec<Vector> {
        let sides = [
            (Vector::new(1.0, 0.0), self.high.x),
            (Vector::new(-1.0, 0.0), -self.low.x),
            (Vector::new(0.0, 1.0), self.high.y),
            (Vector::new(0.0, -1.0), -self.low.y),
        ];
        sides
            .iter()
            .fold(set.vertices().to_vec(), |kept, (normal, limit)| {
                clipped(&kept, |p| normal.dot(p) - limit)
            })
    }
}

/// The part of a convex polygon where a linear function is not positive; empty where there is none
/// (Sutherland & Hodgman, doi:10.1145/360767.360802).
pub fn clipped(polygon: &[Vector], beyond: impl Fn(&Vector) -> f64) -> Vec<Vector> {
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, a) in polygon.iter().enumerate() {
        let b = &polygon[(i + 1) % polygon.len()];
        let (fa, fb) = (beyond(a), beyond(b));
        if fa <= 0.0 {
            kept.push(*a);
        }
        if (fa <= 0.0) != (fb <= 0.0) {
            kept.push(a + (b - a) * (fa / (fa - fb)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::BoxIndex;
    use rand::{Rng, SeedableRng};

    #[test]
    fn the_index_finds_what_a_scan_finds() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(78);
        let mut draw = || {
            let mut whole = |most: i32| f64::from(rng.random_range(0..most));
            let p = Vector::new(whole(50), whole(50));
            let size = Vector::new(whole(9), whole(9));
            Window::new(p, p + size)
        };
        let boxes: Vec<Window> = (0..200).map(|_| draw()).collect();
        let index = BoxIndex::new(boxes.iter().copied());
        for _ in 0..200 {
            let w = draw();
            let expected: Vec<usize> = (0..boxes.len()).filter(|i| w.meets(&boxes[*i])).collect();
            let mut found: Vec<usize> = index.meeting(&w).collect();
            found.sort_unstable();
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn a_set_is_cut_at_the_edges_of_the_box() {
        let at = |x: f64, y: f64| Vector::new(x, y);
        let window = Window::new(at(0.0, 0.0), at(10.0, 10.0));
        let hull = |points: &[Vector]| ConvexPolygon::hull(points).expect("finite");
        let across = hull(&[at(5.0, 5.0), at(15.0, 5.0), at(15.0, 15.0), at(5.0, 15.0)]);
        assert!((hull(&window.part_of(&across)).area() - 25.0).abs() < 1e-9);
        let around = hull(&[at(-50.0, -50.0), at(50.0, -50.0), at(0.0, 90.0)]);
        assert!((hull(&window.part_of(&around)).area() - 100.0).abs() < 1e-9);
        let beside = hull(&[at(20.0, 0.0), at(30.0, 0.0), at(30.0, 5.0)]);
        assert!(window.part_of(&beside).is_empty());
    }
}
