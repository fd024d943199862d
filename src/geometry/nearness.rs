//! The part of a straight path that is near a convex set.

use super::ConvexPolygon;
use crate::frame::{Vector, cross};

/// A part of a path, as parameters from 0 at its start to 1 at its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// In `[0, 1]`.
    pub from: f64,
    /// In `[0, 1]`, not before `from`.
    pub to: f64,
}

/// The part of the path from `a` to `b` within `distance >= 0` of the set, in closed form; `None`
/// when there is none. O(vertices).
///
/// The distance from a convex set is convex along a line. So the part is the span of the parts
/// within the set, within the strip beside each edge and around each vertex.
pub fn stretch_near(set: &ConvexPolygon, [a, b]: [Vector; 2], distance: f64) -> Option<Stretch> {
    let mut span: Option<Stretch> = None;
    let mut keep = |found: Option<Stretch>| {
        if let Some(f) = found {
            span = Some(span.map_or(f, |s| Stretch {
                from: s.from.min(f.from),
                to: s.to.max(f.to),
            }));
        }
    };
    let step = b - a;
    for vertex in set.vertices() {
        keep(within_disc(a - vertex, step, distance));
    }
    let mut inside = Some(Stretch { from: 0.0, to: 1.0 });
    for (from, to) in set.edges() {
        let length = (to - from).norm();
        let along = (to - from) / length;
        let beside = |low: f64, high: f64| {
            let across = clip(cross(along, a - from), cross(along, step), low, high)?;
            let ahead = clip(along.dot(&(a - from)), along.dot(&step), 0.0, length)?;
            both(across, ahead)
        };
        // the inside is to port
        keep(beside(-distance, 0.0));
        let port = clip(
            cross(along, a - from),
            cross(along, step),
            0.0,
            f64::INFINITY,
        );
        inside = inside.zip(port).and_then(|(i, p)| both(i, p));
    }
    // points and segments consist of vertices and strips
    if set.vertices().len() > 2 {
        keep(inside);
    }
    span
}

/// Where `start + parameter × rate` is between two limits.
fn clip(start: f64, rate: f64, low: f64, high: f64) -> Option<Stretch> {
    if rate == 0.0 {
        return (start >= low && start <= high).then_some(Stretch { from: 0.0, to: 1.0 });
    }
    let (s, t) = ((low - start) / rate, (high - start) / rate);
    let (from, to) = (s.min(t).max(0.0), s.max(t).min(1.0));
    (from <= to).then_some(Stretch { from, to })
}

fn both(a: Stretch, b: Stretch) -> Option<Stretch> {
    let (from, to) = (a.from.max(b.from), a.to.min(b.to));
    (from <= to).then_some(Stretch { from, to })
}

/// Where `offset + parameter × step` is within a distance of zero.
fn within_disc(offset: Vector, step: Vector, distance: f64) -> Option<Stretch> {
    let square = step.norm_squared();
    if square == 0.0 {
        return (offset.norm() <= distance).then_some(Stretch { from: 0.0, to: 1.0 });
    }
    let middle = -offset.dot(&step) / square;
    let beside = cross(step, offset).powi(2) / square;
    let reach = distance * distance - beside;
    if !(reach >= 0.0) {
        return None;
    }
    let half = (reach / square).sqrt();
    let (from, to) = ((middle - half).max(0.0), (middle + half).min(1.0));
    (from <= to).then_some(Stretch { from, to })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};

    /// Compares with the distance, sampled.
    #[test]
    fn the_stretch_is_where_the_distance_is_small() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(74);
        let (mut near, mut far) = (0, 0);
        for case in 0..3000 {
            let mut at = || {
                let p = Vector::new(rng.random_range(-9.0..9.0), rng.random_range(-9.0..9.0));
                if case % 3 == 0 { p.map(f64::round) } else { p }
            };
            let points: Vec<Vector> = (0..1 + case % 7).map(|_| at() * 0.5).collect();
            let set = ConvexPolygon::hull(&points).expect("finite");
            let (a, b) = (at(), if case % 11 == 0 { at() * 0.0 } else { at() });
            let distance = rng.random_range(0.0..3.0);
            let found = stretch_near(&set, [a, b], distance);
            near += usize::from(found.is_some());
            far += usize::from(found.is_none());
            for k in 0..=400 {
                let share = f64::from(k) / 400.0;
                let gap = set.signed_distance(a + (b - a) * share) - distance;
                if gap.abs() > 1e-9 {
                    let within = found.is_some_and(|s| share >= s.from && share <= s.to);
                    assert_eq!(within, gap < 0.0, "{share} {gap} {found:?} {set:?}");
                }
            }
        }
        assert!(near > 500 && far > 500, "{near} {far}");
    }
}
