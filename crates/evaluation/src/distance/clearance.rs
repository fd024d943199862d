//! Distances in continuous time between own ship, a rectangle or a point, and a moving set.

use crate::least::{Least, Probe};
use crate::moving_set::{Face, MovingSet};
use crate::piece::Piece;
use searoom_geometry::frame::{Pose, Vector, to_port};
use searoom_geometry::tolerance;
use searoom_geometry::{Between, shortest_between};
use searoom_model::trajectory::Bounds;
use searoom_model::vessel::Hull;

/// Least signed distance between own hull and a moving set along a chain of pieces.
///
/// In overlap, it is negative: minus the shortest translation that separates the two. The distance
/// is parry's; the depth is the smallest overlap along a normal of either shape (separating axes).
/// Exact to [`searoom_geometry::tolerance::MARGIN_M`] and certified: between two probes, supporting lines that
/// separate the two bound the distance from below. About a hundred probes for a segment near the
/// minimum and one for a segment far from it, each linear in the vertices. A distance that parry
/// does not find, or that a supporting line contradicts, is NaN, which counts as a collision.
pub(crate) fn least_distance<P: Piece>(pieces: &[P], own: Body, set: &MovingSet) -> Least {
    least_distance_below(Least::new(), pieces, own, set)
}

/// [`least_distance`] with a `known` least distance to something else. Parts that are not nearer
/// are not refined.
pub(crate) fn least_distance_below<P: Piece>(
    known: Least,
    pieces: &[P],
    own: Body,
    set: &MovingSet,
) -> Least {
    let mut least = Least {
        certified: true,
        probes: 0,
        ..known
    };
    for s in pieces {
        for time in [s.start_time(), s.end_time()] {
            let found = own.probe(s, &s.bounds(), set, [time, 0.0], least.value);
            least.see(found.value, time);
        }
    }
    for s in pieces {
        let bounds = s.bounds();
        least.search(s.start_time(), s.end_time(), |time, half, known| {
            own.probe(s, &bounds, set, [time, half], known)
        });
    }
    least
}

/// Own ship's shape about its position: a rectangle, or a point of zero size.
#[derive(Debug, Clone, Copy)]
pub struct Body {
    half_length: f64,
    half_beam: f64,
}

/// Velocity and turn rate of own ship at an instant.
#[derive(Debug, Clone, Copy)]
struct Moving {
    velocity: Vector,
    turn_rate: f64,
}

/// Widest gap between own ship and a set along a normal of either.
struct Widest {
    /// Its width, and the greatest lower bound of any gap.
    gap: Probe,
    /// Direction from the set to own ship across it.
    across: Vector,
}

impl Widest {
    fn new() -> Self {
        Self {
            gap: Probe::new(f64::NEG_INFINITY, f64::NEG_INFINITY),
            across: Vector::zeros(),
        }
    }

    /// True for the width of a gap that changes nothing: a bound exceeds it by more than rounding.
    fn exceeds(&self, width: f64) -> bool {
        width < self.gap.lower - tolerance::DEPTH_M
    }

    fn see(&mut self, gap: Probe, across: Vector) {
        if gap.value > self.gap.value {
            (self.gap.value, self.across) = (gap.value, across);
        }
        self.gap.lower = self.gap.lower.max(gap.lower);
    }
}

/// One side of own hull: its normal, and its distance from the centre.
#[derive(Debug, Clone, Copy)]
struct Side {
    normal: Vector,
    reach: f64,
}

/// Position and velocity of a corner.
#[derive(Debug, Clone, Copy)]
struct Corner {
    position: Vector,
    velocity: Vector,
}

impl Body {
    /// The position alone, without a hull.
    pub const POINT: Self = Self {
        half_length: 0.0,
        half_beam: 0.0,
    };

    /// The hull at own heading.
    pub fn hull(hull: &Hull) -> Self {
        Self {
            half_length: hull.length / 2.0,
            half_beam: hull.beam / 2.0,
        }
    }

    fn is_point(&self) -> bool {
        self.half_length == 0.0 && self.half_beam == 0.0
    }

    /// Returns the distance at `time` and its lower bound within `half` seconds. The discs around
    /// both, or one face of the set, decide where they prove a distance above the `known` one.
    fn probe(
        &self,
        piece: &impl Piece,
        bounds: &Bounds,
        set: &MovingSet,
        [time, half]: [f64; 2],
        known: f64,
    ) -> Probe {
        let pose = piece.pose_at(time);
        // Minima and maxima below lose a NaN, so it is caught here.
        if !(pose.position.x.is_finite() && pose.position.y.is_finite() && time.is_finite()) {
            return Probe::new(f64::NAN, f64::NAN);
        }
        let reach = self.half_length.hypot(self.half_beam);
        let apart = set.disc.least_distance(piece, [time, half]);
        if let Some(far) = Probe::beyond(known, apart - reach) {
            return far;
        }
        let moving = Moving {
            velocity: piece.velocity_at(time),
            turn_rate: piece.turn_rate_at(time),
        };
        let corners = self.corners(&pose, &moving);
        let corners = if self.is_point() {
            &corners[..1]
        } else {
            &corners[..]
        };
        // A corner deviates from its tangent by at most half of its acceleration times the time
        // squared.
        let bend = 0.5
            * half
            * half
            * (bounds.acceleration
                + (bounds.yaw_rate * bounds.yaw_rate + bounds.yaw_acceleration) * reach);
        // Distance of the body from a face now, and its lower bound within `half` seconds.
        let beyond = |face: &Face| {
            let mut gap = Probe::new(f64::INFINITY, f64::INFINITY);
            for corner in corners {
                let value = face.normal.dot(&corner.position) - face.support(time);
                let rate = face.normal.dot(&corner.velocity) - face.rate;
                gap.value = gap.value.min(value);
                gap.lower = gap.lower.min(value - rate.abs() * half - bend);
            }
            gap
        };
        let mut widest = Widest::new();
        for face in &set.faces {
            // No nearest corner is farther from the face than the centre.
            if widest.exceeds(face.normal.dot(&pose.position) - face.support(time)) {
                continue;
            }
            let gap = beyond(face);
            if let Some(far) = Probe::beyond(known, gap.lower) {
                return far;
            }
            widest.see(gap, face.normal);
        }
        if !self.is_point() {
            let ahead = pose.ahead();
            let port = to_port(ahead);
            let sides = [
                (ahead, self.half_length),
                (-ahead, self.half_length),
                (port, self.half_beam),
                (-port, self.half_beam),
            ];
            let center = set.disc.center.at(time) - pose.position;
            for (normal, reach) in sides {
                // No vertex is farther from the side than the mean of all.
                if widest.exceeds(normal.dot(&center) - reach) {
                    continue;
                }
                let side = Side { normal, reach };
                let gap = beyond_side(&pose, &moving, bounds, side, set, time, half);
                widest.see(gap, -normal);
            }
        }
        let Widest {
            gap: mut best,
            across,
        } = widest;
        // No normal of either shape separates them: they overlap, and the smallest overlap along a
        // normal is the depth.
        if !(best.value > 0.0) {
            return best;
        }
        // Relative to own ship, where the numbers are small.
        let on_set =
            |n: Vector| farthest(n, set.vertices.iter().map(|v| v.at(time) - pose.position));
        let on_hull = |n: Vector| farthest(n, corners.iter().map(|c| c.position - pose.position));
        match shortest_between(on_set, on_hull, across) {
            // A supporting line proves the gap `best.value`. A distance that is shorter by more
            // than rounding is wrong.
            Some(Between {
                shortest,
                resolution,
            }) if shortest.norm() >= best.value - resolution.max(tolerance::TOUCH_M) => {
                best.value = best.value.max(shortest.norm());
                if let Some(normal) = shortest.try_normalize(0.0) {
                    best.lower = best.lower.max(beyond(&set.face(normal)).lower);
                }
                best
            }
            _ => Probe::new(f64::NAN, f64::NAN),
        }
    }

    fn corners(&self, pose: &Pose, moving: &Moving) -> [Corner; 4] {
        let (l, b, ahead) = (self.half_length, self.half_beam, pose.ahead());
        [(l, -b), (l, b), (-l, b), (-l, -b)].map(|(x, y)| {
            let position = pose.position + ahead * x + to_port(ahead) * y;
            Corner {
                position,
                velocity: moving.velocity + to_port(position - pose.position) * moving.turn_rate,
            }
        })
    }
}

/// Returns the farthest of some points in a direction.
fn farthest(n: Vector, points: impl Iterator<Item = Vector>) -> Vector {
    let (mut most, mut best) = (f64::NEG_INFINITY, Vector::repeat(f64::NAN));
    for p in points {
        let reach = n.dot(&p);
        if reach > most {
            (most, best) = (reach, p);
        }
    }
    best
}

/// Distance of a set from one side of own hull now, and its lower bound within `half` seconds. The
/// side turns with the hull: a fixed line would lose a distance of first order in time at the ends
/// of the side.
fn beyond_side(
    pose: &Pose,
    moving: &Moving,
    bounds: &Bounds,
    Side { normal, reach }: Side,
    set: &MovingSet,
    time: f64,
    half: f64,
) -> Probe {
    let turning = to_port(normal) * moving.turn_rate;
    let turn = bounds.yaw_rate;
    let swing = bounds.yaw_rate * bounds.yaw_rate + bounds.yaw_acceleration;
    let mut gap = Probe::new(f64::INFINITY, f64::INFINITY);
    for vertex in &set.vertices {
        let offset = vertex.at(time) - pose.position;
        let relative = vertex.velocity - moving.velocity;
        let value = normal.dot(&offset) - reach;
        let rate = normal.dot(&relative) + turning.dot(&offset);
        // Largest second derivative of n . (p - x) within `half` seconds.
        let fastest = vertex.velocity.norm() + bounds.speed;
        let bend =
            swing * (offset.norm() + fastest * half) + 2.0 * turn * fastest + bounds.acceleration;
        gap.value = gap.value.min(value);
        gap.lower = gap
            .lower
            .min(value - rate.abs() * half - 0.5 * bend * half * half);
    }
    gap
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::{places, random_vector};
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use searoom_geometry::ConvexPolygon;
    use searoom_model::trajectory::Segment;

    fn polygon(rng: &mut ChaCha8Rng, extent: f64) -> ConvexPolygon {
        let points: Vec<Vector> = (0..rng.random_range(1..7))
            .map(|_| {
                let p = random_vector(rng, 1.0);
                let on_grid = rng.random_bool(0.3);
                (if on_grid { p.map(f64::round) } else { p }) * extent
            })
            .collect();
        ConvexPolygon::hull(&points).expect("finite")
    }

    fn segment(rng: &mut ChaCha8Rng) -> Segment {
        let position = random_vector(rng, 60.0);
        let turns = rng.random_bool(0.5);
        let turn_rate = if turns {
            rng.random_range(-0.3..0.3)
        } else {
            0.0
        };
        Segment::new(
            Pose::new(position, rng.random_range(-3.0..3.0)),
            rng.random_range(0.0..5.0),
            rng.random_range(0.0..15.0),
            rng.random_range(0.0..8.0),
            turn_rate,
        )
    }

    #[test]
    fn least_distances_match_a_dense_scan() {
        let mut rng = ChaCha8Rng::seed_from_u64(21);
        let hull = Hull::new(12.0, 4.0);
        for case in 0..400 {
            let (initial, velocity) = (polygon(&mut rng, 15.0), polygon(&mut rng, 2.0));
            let set = MovingSet::new(&initial, &velocity);
            let s = segment(&mut rng);
            let whole = case % 2 == 0;
            let body = [Body::POINT, Body::hull(&hull)][usize::from(whole)];
            let found = least_distance(&[s], body, &set);
            let at = |time: f64| {
                let section = initial.minkowski_sum(&velocity.scaled(time));
                let pose = s.pose_at(time);
                if whole {
                    hull.polygon(&pose).separation(&section)
                } else {
                    section.signed_distance(pose.position)
                }
            };
            let scan = (0..=2000)
                .map(|i| at(s.start_time + s.duration * f64::from(i) / 2000.0))
                .fold(f64::INFINITY, f64::min);
            assert!(found.certified);
            assert!((at(found.time) - found.value).abs() < 1e-9, "{found:?}");
            assert!(found.value <= scan + 1e-7, "{found:?} {scan}");
            assert!(scan - found.value < 0.1, "{found:?} {scan}");
        }
    }

    #[test]
    fn sliding_along_a_face_costs_few_probes() {
        let square = |r: f64| ConvexPolygon::rectangle(Vector::zeros(), r, r);
        let set = MovingSet::new(&square(10.0), &square(0.5));
        // First along the growing upper face, then around a corner of a fixed set.
        let slide = Segment::straight(
            Pose::new(Vector::new(-8.0, 10.0), 0.5),
            0.0,
            60.0,
            0.5 / 0.5_f64.sin(),
        );
        let found = least_distance(&[slide], Body::POINT, &set);
        assert!(
            found.certified && found.value.abs() < 1e-9 && found.probes < 10,
            "{found:?}"
        );
        let rest = MovingSet::new(&square(10.0), &ConvexPolygon::point(Vector::zeros()));
        let round = Segment {
            start: Pose::new(Vector::new(10.0, -40.0), std::f64::consts::FRAC_PI_2),
            turn_rate: 0.05,
            speed: 2.5,
            ..slide
        };
        let mut touching = round;
        let corner = Vector::new(10.0, 10.0) - round.pose_after(20.0).position;
        touching.start.position = corner + round.start.position;
        let found = least_distance(&[touching], Body::POINT, &rest);
        assert!(found.certified && found.probes < 300, "{found:?}");
    }

    #[test]
    fn turning_broadside_past_a_corner_costs_few_probes() {
        // The nearest point is inside own ship's side, which turns; a fixed line bounds it badly.
        let buoy = ConvexPolygon::point(Vector::new(0.0, 40.0));
        let set = MovingSet::new(&buoy, &ConvexPolygon::point(Vector::zeros()));
        let hull = Hull::new(30.0, 8.0);
        // On a circle of 100 m about (0, 100), lowest after 10 s.
        let (half_turn, rate) = (0.6_f64, 0.06);
        let s = Segment::new(
            Pose::new(
                Vector::new(-100.0 * half_turn.sin(), 100.0 - 100.0 * half_turn.cos()),
                -half_turn,
            ),
            0.0,
            20.0,
            6.0,
            rate,
        );
        let found = least_distance(&[s], Body::hull(&hull), &set);
        assert!(found.certified && found.probes < 300, "{found:?}");
        assert!((found.value - 36.0).abs() < 1e-6 && (found.time - 10.0).abs() < 0.01);
    }

    /// A segment that rounding makes a triangle 1e-10 m wide.
    #[test]
    fn a_very_narrow_set_has_its_distance() {
        let polygon = |corners: &[(f64, f64)]| ConvexPolygon::from_ccw(places(corners));
        let initial = polygon(&[
            (762_685.624_368_940_2, 6_168_232.524_121_132),
            (762_685.624_368_940_4, 6_168_232.524_121_132),
            (762_678.774_740_306_7, 6_168_233.161_103_492),
        ]);
        let velocity = polygon(&[
            (-0.641_405_323_401_804_8, 0.777_317_240_375_171_6),
            (-0.301_026_296_450_760_1, 1.123_255_943_507_063_3),
            (-0.460_141_589_050_973_7, 1.359_746_818_844_742_8),
            (-0.814_503_325_480_200_5, 0.852_190_956_664_051_2),
            (-0.782_862_531_922_230_4, 0.828_035_330_096_622_6),
        ]);
        let start = Vector::new(762_689.677_311_486_6, 6_168_232.662_751_141);
        let (speed, rate) = (6.225_487_885_817_392, 22.293_386_329_197_396_f64);
        let pose = Pose::new(start, std::f64::consts::PI);
        let arc = Segment::new(pose, 0.0, 1.0, speed, -rate.to_radians());
        let centre = velocity.centroid();
        let small = velocity.translated(-centre).scaled(0.056);
        let set = MovingSet::new(&initial, &small.translated(centre));
        for k in 0..1000 {
            let time = 1e-3 * f64::from(k);
            let here = arc.pose_at(time);
            let still = Segment::straight(here, time, 1e-9, 0.0);
            let found = least_distance(&[still], Body::POINT, &set).value;
            let section = initial.minkowski_sum(&small.translated(centre).scaled(time));
            let exact = ConvexPolygon::point(here.position).separation(&section);
            assert!((found - exact).abs() < 1e-6, "{k}: {found} {exact}");
        }
    }

    #[test]
    fn a_point_that_is_not_a_number_has_no_distance() {
        let still = ConvexPolygon::point(Vector::zeros());
        let set = MovingSet::new(&still, &still);
        let mut s = segment(&mut ChaCha8Rng::seed_from_u64(1));
        s.start.position.x = f64::NAN;
        assert!(least_distance(&[s], Body::POINT, &set).value.is_nan());
    }
}
