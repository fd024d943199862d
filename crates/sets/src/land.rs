//! Land as an obstacle for own ship's centre: many static convex blocks.

use std::sync::LazyLock;

use super::{PolytopeObstacle, contact};
use searoom_geometry::frame::Vector;
use searoom_geometry::{BoxIndex, ConvexPolygon, Window, outer_disc};
use searoom_model::trajectory::Segment;

/// Name of land among the names of targets.
pub const LAND: &str = "land";

/// Outer approximation of the points nearer to land than a radius: a union of convex blocks. Each
/// block is the Minkowski sum of a convex piece of land and a circumscribed 16-gon, at most 2 % of
/// the radius too large.
///
/// A block is a space-time polytope whose only velocity is zero, so planners treat it like any
/// other. Pieces of one land touch and their blocks overlap by twice the radius, so no path passes
/// between two pieces.
#[derive(Debug, Clone)]
pub struct LandObstacle {
    blocks: Vec<PolytopeObstacle>,
    index: BoxIndex,
}

impl LandObstacle {
    /// No land.
    pub fn none() -> &'static Self {
        static NONE: LazyLock<LandObstacle> = LazyLock::new(|| LandObstacle::around([], 0.0));
        &NONE
    }

    /// Land around convex pieces, grown by `radius >= 0` metres: own ship's half-diagonal, which
    /// permits any heading, plus the margin to land.
    pub fn around<'a>(pieces: impl IntoIterator<Item = &'a ConvexPolygon>, radius: f64) -> Self {
        let disc = outer_disc(radius, 0.0);
        Self::of(pieces.into_iter().map(|p| p.minkowski_sum(&disc)))
    }

    /// A copy with every block mapped.
    pub fn mapped(&self, to: impl Fn(&ConvexPolygon) -> ConvexPolygon) -> Self {
        Self::of(self.blocks.iter().map(|b| to(b.initial())))
    }

    fn of(blocks: impl Iterator<Item = ConvexPolygon>) -> Self {
        let rest = ConvexPolygon::point(Vector::zeros());
        let blocks: Vec<PolytopeObstacle> = blocks
            .map(|block| PolytopeObstacle::new(LAND, block, rest.clone()))
            .collect();
        let windows = blocks
            .iter()
            .filter_map(|b| Window::around(b.initial().vertices()));
        Self {
            index: BoxIndex::new(windows),
            blocks,
        }
    }

    /// True without land.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// The convex blocks.
    pub fn blocks(&self) -> &[PolytopeObstacle] {
        &self.blocks
    }

    /// Indices of the blocks whose boxes meet a window, in no order.
    pub fn near<'a>(&'a self, window: &Window) -> impl Iterator<Item = usize> + use<'a> {
        self.index.meeting(window)
    }

    /// Largest depth of a position in any block, metres; `None` on water, NaN for a NaN.
    pub fn depth(&self, position: Vector) -> Option<f64> {
        if !(position.x.is_finite() && position.y.is_finite()) {
            return Some(f64::NAN);
        }
        self.near(&Window::at(position))
            .map(|b| -self.blocks[b].slack(position, 0.0).value)
            .filter(|depth| *depth >= 0.0)
            .max_by(f64::total_cmp)
    }

    /// Distance from a position along the unit vector `toward` to the first point outside every
    /// block, metres; 0 on water.
    pub fn way_out(&self, position: Vector, toward: Vector) -> f64 {
        let mut gone = 0.0;
        // a ray does not enter a convex block twice
        for _ in 0..=self.blocks.len() {
            let here = position + toward * gone;
            let step = self
                .near(&Window::at(here))
                .filter(|b| self.blocks[*b].slack(here, 0.0).value < 0.0)
                .map(|b| exit(&self.blocks[b], here, toward))
                .fold(0.0, f64::max);
            if step == 0.0 {
                break;
            }
            gone += step;
        }
        gone
    }

    /// True when a segment is at least `depth` metres inside a block.
    pub fn meets(&self, segment: &Segment, depth: f64) -> bool {
        self.near(&window_of(segment))
            .any(|b| contact::meets(&self.blocks[b], segment, depth))
    }

    /// The first instant at which a segment is at least `depth` metres inside a block.
    pub fn first_contact(&self, segment: &Segment, depth: f64) -> Option<f64> {
        self.near(&window_of(segment))
            .filter_map(|b| contact::first_contact(&self.blocks[b], segment, depth))
            .min_by(f64::total_cmp)
    }
}

/// Distance from a position inside a block to its edge along `toward`, metres.
fn exit(block: &PolytopeObstacle, position: Vector, toward: Vector) -> f64 {
    block
        .faces()
        .iter()
        .map(|f| (f.normal.dot(&toward), -f.slack(position, 0.0)))
        .filter(|(rate, _)| *rate > 0.0)
        .map(|(rate, depth)| depth / rate)
        .fold(f64::INFINITY, f64::min)
        .max(0.0)
}

/// A box around a segment; all of the plane where the segment is not finite.
pub fn window_of(segment: &Segment) -> Window {
    if !segment.is_valid() {
        let all = Vector::repeat(f64::MAX);
        return Window::new(-all, all);
    }
    let (start, end) = (segment.start.position, segment.end().position);
    let ends = Window::new(start.inf(&end), start.sup(&end));
    if !segment.is_arc() {
        return ends;
    }
    // an arc is within its sagitta of its chord, or within its radius for half a circle or more
    let turn = (segment.turn_rate * segment.duration).abs();
    let half = 0.5 * turn.min(std::f64::consts::PI);
    let sagitta = segment.radius().abs() * (1.0 - half.cos());
    let beyond = if turn > std::f64::consts::PI {
        2.0 * segment.radius().abs()
    } else {
        sagitta
    };
    ends.grown(beyond)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::random_vector;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use searoom_geometry::frame::{Pose, direction};

    fn random_land(rng: &mut ChaCha8Rng) -> (Vec<ConvexPolygon>, f64, LandObstacle) {
        let pieces: Vec<ConvexPolygon> = (0..rng.random_range(1..25))
            .map(|_| {
                let centre = random_vector(rng, 300.0);
                let points: Vec<Vector> = (0..rng.random_range(3..8))
                    .map(|k| centre + direction(f64::from(k)) * rng.random_range(5.0..60.0))
                    .collect();
                ConvexPolygon::hull(&points).expect("finite")
            })
            .collect();
        let radius = rng.random_range(0.1..30.0);
        let land = LandObstacle::around(&pieces, radius);
        (pieces, radius, land)
    }

    /// Outer and tight, compared with the distance from the pieces themselves.
    #[test]
    fn blocks_hold_every_place_within_the_radius_and_little_more() {
        let mut rng = ChaCha8Rng::seed_from_u64(81);
        for _ in 0..100 {
            let (pieces, radius, land) = random_land(&mut rng);
            for _ in 0..200 {
                let p = random_vector(&mut rng, 400.0);
                let distance = pieces
                    .iter()
                    .map(|c| c.signed_distance(p))
                    .fold(f64::INFINITY, f64::min);
                let inside = land.depth(p).is_some();
                assert!(inside || distance > radius - 1e-9);
                assert!(!inside || distance < 1.02 * radius + 1e-9);
            }
            assert!(
                land.depth(Vector::new(f64::NAN, 0.0))
                    .is_none_or(|d| d.is_nan())
            );
        }
    }

    /// The index finds every block that a search of all blocks finds.
    #[test]
    fn contacts_match_a_scan_over_all_blocks() {
        let mut rng = ChaCha8Rng::seed_from_u64(82);
        let (mut met, mut clear) = (0, 0);
        for _ in 0..200 {
            let (_, _, land) = random_land(&mut rng);
            for _ in 0..20 {
                let segment = Segment::new(
                    Pose::new(random_vector(&mut rng, 400.0), rng.random_range(-3.0..3.0)),
                    7.0,
                    rng.random_range(0.0..90.0),
                    5.0,
                    [0.0, 0.05, -0.1][rng.random_range(0..3)],
                );
                let first = land
                    .blocks()
                    .iter()
                    .filter_map(|b| contact::first_contact(b, &segment, 1e-7))
                    .min_by(f64::total_cmp);
                assert_eq!(land.first_contact(&segment, 1e-7), first, "{segment:?}");
                assert_eq!(land.meets(&segment, 1e-7), first.is_some());
                met += usize::from(first.is_some());
                clear += usize::from(first.is_none());
            }
        }
        assert!(met > 500 && clear > 500, "{met} {clear}");
        let lost = Segment::straight(Pose::new(Vector::new(f64::NAN, 0.0), 0.0), 0.0, 1.0, 5.0);
        let (_, _, land) = random_land(&mut rng);
        assert!(land.meets(&lost, 1e-7));
    }

    /// Small steps along the ray.
    #[test]
    fn the_way_out_ends_where_no_block_is() {
        let mut rng = ChaCha8Rng::seed_from_u64(83);
        let mut through_several = 0;
        for _ in 0..300 {
            let (_, _, land) = random_land(&mut rng);
            let block = land.blocks()[0].initial().centroid();
            let toward = direction(rng.random_range(-3.0..3.0));
            let out = land.way_out(block, toward);
            assert!(land.depth(block + toward * (out + 1e-6)).is_none());
            let inside = |gone: f64| land.depth(block + toward * gone).is_some();
            assert!((0..=200).all(|k| inside(out * f64::from(k) / 200.0 * (1.0 - 1e-9))));
            through_several += usize::from(out > exit(&land.blocks()[0], block, toward) + 1.0);
        }
        assert!(through_several > 20, "{through_several}");
        assert_eq!(
            LandObstacle::none().way_out(Vector::zeros(), direction(1.0)),
            0.0
        );
    }
}
