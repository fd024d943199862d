//! The part of a straight path that is near a convex set.

use super::ConvexPolygon;
use crate::frame::Vector;
use crate::numerics::{GoldenSection, bisected};

/// A part of a path, as parameters from 0 at its start to 1 at its end.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// In `[0, 1]`.
    pub from: f64,
    /// In `[0, 1]`, not before `from`.
    pub to: f64,
}

/// Steps of the searches: to the last digit of a parameter.
const STEPS: usize = 70;

/// The part of the path from `a` to `b` within `distance >= 0` of the set; `None` when there is
/// none. O(vertices).
///
/// The distance from a convex set is convex along a line: golden section finds a point within, and
/// bisection the ends.
pub fn stretch_near(set: &ConvexPolygon, [a, b]: [Vector; 2], distance: f64) -> Option<Stretch> {
    let gap = |share: f64| set.signed_distance(a + (b - a) * share) - distance;
    let mut search = GoldenSection::new(0.0, 1.0, gap);
    for _ in 0..STEPS {
        if search.left.1 <= 0.0 || search.right.1 <= 0.0 {
            break;
        }
        search.shorten(gap);
    }
    let ends = [0.0, 1.0].map(|share| (share, gap(share)));
    let places = [search.left, search.right].into_iter().chain(ends);
    let (inside, _) = places.into_iter().find(|(_, gap)| *gap <= 0.0)?;
    let [from, to] = ends.map(|(end, gap_there)| {
        if gap_there <= 0.0 {
            return end;
        }
        let [within, _] = bisected([inside, end], STEPS, |share| gap(share) <= 0.0);
        within
    });
    Some(Stretch { from, to })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::random_vector;
    use rand::{Rng, SeedableRng};

    /// Compares with the distance, sampled.
    #[test]
    fn the_stretch_is_where_the_distance_is_small() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(74);
        let (mut near, mut far) = (0, 0);
        for case in 0..3000 {
            let mut at = || {
                let p = random_vector(&mut rng, 9.0);
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
