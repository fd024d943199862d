//! Stretches of a path that are too near to land.

use super::Map;
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance;
use searoom_geometry::{ConvexPolygon, Window, stretch_near};

/// Metres: resolution of the worst distance. Along a quay every place is nearly the worst.
const SETTLED_M: f64 = 0.02;

/// A stretch of one leg of a path that is too near to land.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LandCrossing {
    /// Which leg, from 0.
    pub leg: usize,
    /// Metres along the leg where the stretch begins and ends.
    pub from: f64,
    /// See `from`.
    pub to: f64,
    /// The place nearest to land.
    pub worst: Vector,
    /// Metres missing there: required clearance minus the distance from land, negative on land.
    pub missing: f64,
}

impl Map {
    /// Stretches of a polyline that are nearer to land than `clearance >= 0` metres, in order of
    /// legs and places. Touching is allowed, to [`tolerance::DEPTH_M`]. The ends are exact, the
    /// missing distance is exact to 2 cm. O(log n) and the pieces near the path.
    pub fn crossings(&self, path: &[Vector], clearance: f64) -> Vec<LandCrossing> {
        let mut found = Vec::new();
        for (leg, pair) in path.windows(2).enumerate() {
            let ends = [pair[0], pair[1]];
            let length = (ends[1] - ends[0]).norm();
            let Some(window) = Window::around(&ends) else {
                continue;
            };
            let mut near: Vec<_> = self
                .pieces_within(&window.grown(clearance))
                .into_iter()
                .filter_map(|piece| stretch_near(piece, ends, clearance))
                .map(|s| (s.from, s.to))
                .collect();
            near.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut joined: Vec<(f64, f64)> = Vec::new();
            for (from, to) in near {
                match joined.last_mut() {
                    // shares apart by less than a length are one stretch
                    Some(last) if from <= last.1 + tolerance::LENGTH_M / length => {
                        last.1 = last.1.max(to);
                    }
                    _ => joined.push((from, to)),
                }
            }
            for (from, to) in joined {
                let at = |share: f64| ends[0] + (ends[1] - ends[0]) * share;
                let (worst, distance) = self.nearest_to_land(at(from), at(to));
                let missing = clearance - distance;
                // negated on purpose: a NaN is missing
                if !(missing <= tolerance::DEPTH_M) {
                    found.push(LandCrossing {
                        leg,
                        from: from * length,
                        to: to * length,
                        worst,
                        missing,
                    });
                }
            }
        }
        found
    }

    /// Metres between a convex set and the land, negative in overlap: then minus the shortest way
    /// out of the piece that it is deepest in. Only land within `reach` metres is looked at;
    /// infinite without any.
    pub fn separation(&self, set: &ConvexPolygon, reach: f64) -> f64 {
        Window::around(set.vertices()).map_or(f64::INFINITY, |window| {
            self.pieces_within(&window.grown(reach))
                .into_iter()
                .map(|piece| piece.separation(set))
                .fold(f64::INFINITY, f64::min)
        })
    }

    /// The place on the line from `a` to `b` with the least signed distance from land, to
    /// [`SETTLED_M`]. Found by halving, as the distance changes by at most a metre per metre.
    fn nearest_to_land(&self, a: Vector, b: Vector) -> (Vector, f64) {
        let mut best = (a, self.signed_distance(a));
        let mut see = |p: Vector| {
            let distance = self.signed_distance(p);
            // negated on purpose: a NaN is taken over
            if !(distance >= best.1) {
                best = (p, distance);
            }
            (distance, best.1)
        };
        see(b);
        let mut open = vec![(a, b)];
        while let Some((from, to)) = open.pop() {
            let middle = (from + to) * 0.5;
            let (distance, least) = see(middle);
            let half = 0.5 * (to - from).norm();
            if distance - half < least - SETTLED_M {
                open.push((middle, to));
                open.push((from, middle));
            }
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use searoom_geometry::Polygon;

    fn square(x: f64, y: f64, half: f64) -> Polygon {
        let corners = [(-half, -half), (half, -half), (half, half), (-half, half)];
        let ring = corners.map(|(dx, dy)| Vector::new(x + dx, y + dy)).to_vec();
        Polygon::new(&[ring]).expect("valid")
    }

    #[test]
    fn a_crossing_says_where_and_by_how_much() {
        let map = Map::new(vec![square(50.0, 0.0, 10.0), square(500.0, 30.0, 10.0)]).expect("land");
        let path = [(0.0, 2.0), (200.0, 2.0), (600.0, 2.0)].map(|(x, y)| Vector::new(x, y));
        let found = map.crossings(&path, 5.0);
        let [only] = found[..] else {
            panic!("{found:?}");
        };
        assert_eq!(only.leg, 0);
        assert!((only.from - 35.0).abs() < 1e-9 && (only.to - 65.0).abs() < 1e-9);
        assert!((only.missing - 13.0).abs() < 0.02, "{only:?}");
        // beside the second square it is 18 m off
        assert!(map.crossings(&path[1..], 18.0).is_empty());
        let near = map.crossings(&path[1..], 18.5);
        assert!((near[0].missing - 0.5).abs() < 0.02 && near[0].leg == 0);
        // along an edge is touching
        let along = [(0.0, 10.0), (100.0, 10.0)].map(|(x, y)| Vector::new(x, y));
        assert!(map.crossings(&along, 0.0).is_empty());
    }

    /// The signed distance itself, sampled every decimetre.
    #[test]
    fn crossings_match_a_dense_scan() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(76);
        let mut crossed = 0;
        for _ in 0..60 {
            let squares: Vec<Polygon> = (0..8)
                .map(|k| {
                    let (column, row) = (f64::from(k % 4), f64::from(k / 4));
                    let half = rng.random_range(2.0..20.0);
                    square(50.0 * column, 50.0 * row, half)
                })
                .collect();
            let map = Map::new(squares).expect("land");
            let path: Vec<Vector> = (0..4)
                .map(|_| {
                    Vector::new(
                        rng.random_range(-30.0..180.0),
                        rng.random_range(-30.0..80.0),
                    )
                })
                .collect();
            let clearance = rng.random_range(0.0..8.0);
            let found = map.crossings(&path, clearance);
            crossed += found.len();
            for (leg, pair) in path.windows(2).enumerate() {
                let length = (pair[1] - pair[0]).norm();
                for k in 0..(length * 10.0) as usize {
                    let along = k as f64 / 10.0;
                    let p = pair[0] + (pair[1] - pair[0]) * (along / length);
                    let missing = clearance - map.signed_distance(p);
                    let within = found
                        .iter()
                        .find(|c| c.leg == leg && along >= c.from && along <= c.to);
                    if missing.abs() > 1e-6 {
                        assert_eq!(within.is_some(), missing > 0.0, "{missing} {found:?}");
                    }
                    if let Some(c) = within {
                        assert!(missing <= c.missing + 0.021);
                    }
                }
            }
        }
        assert!(crossed > 50, "{crossed}");
    }
}
