//! Distance from own hull to land, by the edges of polygons and the even-odd rule.

use crate::distance::clearance::{Body, least_distance_below};
use crate::least::Least;
use crate::moving_set::MovingSet;
use crate::piece::Piece;
use searoom_geometry::frame::Vector;
use searoom_geometry::{ConvexPolygon, EdgeTree, Polygon};

/// Land polygons with a spatial index of their edges.
pub(crate) struct LandBodies<'a> {
    land: &'a [Polygon],
    edges: EdgeTree,
}

impl<'a> LandBodies<'a> {
    /// Builds the index of edges. O(edges log edges).
    pub fn new(land: &'a [Polygon]) -> Self {
        Self {
            land,
            edges: EdgeTree::new(land.iter().flat_map(Polygon::edges)),
        }
    }

    /// Least signed distance between own hull and land along a chain of pieces; negative on land.
    ///
    /// `reach` is the distance in metres from the centre of the hull to its farthest point. A hull
    /// that starts on water and touches no edge stays on water. Only edges are therefore tested,
    /// each as a fixed set of two points. A position inside a polygon is on land, whatever the
    /// edges show. The result is certified like that of [`least_distance_below`] and is infinite
    /// without land. Costs O(log edges) per piece, and probes for the near edges.
    pub fn least_distance<P: Piece>(&self, pieces: &[P], own: Body, reach: f64) -> Least {
        let mut least = Least::new();
        for s in pieces {
            for time in [s.start_time(), s.end_time()] {
                let position = s.pose_at(time).position;
                if self.land.iter().any(|polygon| polygon.contains(position)) {
                    let depth = self.edges.nearest(position);
                    least.see(depth.map_or(f64::NAN, |edge| -edge.distance), time);
                }
            }
            // No point of the hull leaves this disc during the piece.
            let half = 0.5 * (s.end_time() - s.start_time());
            let middle = s.pose_at(s.start_time() + half).position;
            let radius = s.bounds().speed * half + reach;
            let Some(first) = self.edges.nearest(middle) else {
                // Without edges there is no land. With edges, only a NaN position has no nearest
                // edge.
                if !self.land.is_empty() {
                    least.see(f64::NAN, s.start_time());
                }
                continue;
            };
            self.look(&mut least, s, own, first.index);
            let near = self.edges.within(middle, least.value + radius);
            let mut near: Vec<(f64, usize)> = near
                .filter(|edge| edge.index != first.index)
                .map(|edge| (edge.distance - radius, edge.index))
                .collect();
            near.sort_unstable_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            for (bound, index) in near {
                // Negated on purpose: an edge is tested if either side is NaN.
                if !(bound >= least.value) {
                    self.look(&mut least, s, own, index);
                }
            }
        }
        least
    }

    /// Updates `least` with the distance to one edge along a piece.
    fn look<P: Piece>(&self, least: &mut Least, piece: &P, own: Body, index: usize) {
        let (a, b) = self.edges.edge(index);
        let set = MovingSet::new(
            &ConvexPolygon::from_ccw(vec![a, b]),
            &ConvexPolygon::point(Vector::zeros()),
        );
        let here = least_distance_below(*least, std::slice::from_ref(piece), own, &set);
        least.see(here.value, here.time);
        least.certified &= here.certified;
        least.probes += here.probes;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::places;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use searoom_geometry::frame::Pose;
    use searoom_model::trajectory::Segment;
    use searoom_model::vessel::Hull;

    fn comb(rng: &mut ChaCha8Rng) -> Polygon {
        let mut ring: Vec<Vector> = (0..7)
            .map(|k| Vector::new(f64::from(k) * 25.0, rng.random_range(-40.0..40.0)))
            .collect();
        ring.push(Vector::new(150.0, 90.0));
        ring.push(Vector::new(0.0, 90.0));
        let hole = places(&[(60.0, 60.0), (90.0, 60.0), (75.0, 80.0)]);
        Polygon::new(&[ring, hole]).expect("valid")
    }

    /// Compares with hulls sampled in time against every edge.
    #[test]
    fn land_distances_match_a_dense_scan() {
        let mut rng = ChaCha8Rng::seed_from_u64(77);
        let hull = Hull::new(20.0, 6.0);
        let (mut clear, mut aground) = (0, 0);
        for case in 0..150 {
            let land = comb(&mut rng);
            let [x, y] = [-50.0..200.0, -120.0..20.0].map(|range| rng.random_range(range));
            let s = Segment::new(
                Pose::new(Vector::new(x, y), rng.random_range(-3.0..3.0)),
                3.0,
                rng.random_range(1.0..30.0),
                4.0,
                if case % 2 == 0 { 0.0 } else { 0.08 },
            );
            let reach = hull.half_diagonal();
            let land = [land];
            let found = LandBodies::new(&land).least_distance(&[s], Body::hull(&hull), reach);
            let mut scan = f64::INFINITY;
            for k in 0..=300 {
                let pose = s.pose_after(s.duration * f64::from(k) / 300.0);
                let rectangle = hull.polygon(&pose);
                for (a, b) in land[0].edges() {
                    let edge = ConvexPolygon::hull(&[a, b]).expect("finite");
                    scan = scan.min(rectangle.separation(&edge));
                }
            }
            assert!(found.certified);
            if scan > 0.0 && !land[0].contains(s.start.position) {
                clear += 1;
                assert!(
                    found.value <= scan + 1e-7 && scan - found.value < 0.5,
                    "{found:?} {scan}"
                );
            } else {
                aground += 1;
                assert!(found.value < 0.0, "{found:?} {scan}");
            }
        }
        assert!(clear > 40 && aground > 20, "{clear} {aground}");
    }

    #[test]
    fn a_hull_that_never_leaves_the_inside_is_aground() {
        let ring = places(&[(0.0, 0.0), (1000.0, 0.0), (1000.0, 1000.0), (0.0, 1000.0)]);
        let land = [Polygon::new(&[ring]).expect("valid")];
        let hull = Hull::new(20.0, 6.0);
        let inland = Segment::straight(Pose::new(Vector::new(400.0, 500.0), 0.0), 0.0, 10.0, 5.0);
        let found = LandBodies::new(&land).least_distance(&[inland], Body::hull(&hull), 11.0);
        assert!(found.value <= -400.0, "{found:?}");
        let nowhere = LandBodies::new(&[]).least_distance(&[inland], Body::hull(&hull), 11.0);
        assert_eq!(nowhere.value, f64::INFINITY);
    }
}
