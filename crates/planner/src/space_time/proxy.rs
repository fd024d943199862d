//! Obstacle proxies: convex pieces with the data of a fast contact test.

use crate::Problem;
use crate::space_time::piece::Piece;
use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::{Pose, Vector, cross, to_port};
use searoom_geometry::tolerance::TOUCH_M;
use searoom_model::trajectory::Segment;
use searoom_model::vessel::{Hull, OwnShip};
use searoom_sets::contact::{self, Interval};
use searoom_sets::{EllipsoidObstacle, PolytopeObstacle, SpaceTimeObstacle};

/// Metres by which a disc must stay out of own ship's reach to be ignored: much larger than
/// rounding errors.
const REACH_M: f64 = 1e-3;

/// Rounding of a place and of a velocity that changes nothing, metres and m/s.
const SAME_M: f64 = 1e-6;
const SAME_MPS: f64 = 1e-9;

/// Convex piece inside a growing, moving disc.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Proxy<'a> {
    /// Index of the obstacle.
    pub obstacle: usize,
    /// Polytope of the piece; for an ellipsoid its outer polytope. Its time counts from the
    /// window's start.
    pub body: &'a PolytopeObstacle,
    /// Ellipsoid of the piece, where it is one.
    pub ellipsoid: Option<&'a EllipsoidObstacle>,
    /// Time window of the piece; `None` for ever.
    pub window: Option<Interval>,
    centre: Vector,
    drift: Vector,
    radius: f64,
    growth: f64,
}

impl<'a> Proxy<'a> {
    pub(crate) fn new(part: &'a Piece) -> Self {
        let (body, ellipsoid) = (&part.body, part.ellipsoid.as_ref());
        let (centre, drift) = (body.initial().centroid(), body.velocity().centroid());
        let (radius, growth) = match ellipsoid {
            // the root of the trace of the outer section is the sum of the roots of the two sets
            Some(e) => (e.initial().root_of_trace(), e.velocity().root_of_trace()),
            None => (
                body.initial().translated(-centre).reach(),
                body.velocity().translated(-drift).reach(),
            ),
        };
        Self {
            obstacle: part.obstacle,
            body,
            ellipsoid,
            window: part.window,
            centre,
            drift,
            radius,
            growth,
        }
    }

    /// Polytope at rest, without a time window.
    pub(crate) fn at_rest(obstacle: usize, body: &'a PolytopeObstacle) -> Self {
        let centre = body.initial().centroid();
        Self {
            obstacle,
            body,
            ellipsoid: None,
            window: None,
            centre,
            drift: Vector::zeros(),
            radius: body.initial().translated(-centre).reach(),
            growth: 0.0,
        }
    }

    /// False where own ship cannot meet it until the horizon: the enclosing disc stays out of own
    /// ship's reach at the greatest speed. True where that is unknown.
    fn is_within_reach(&self, own: &OwnShip, horizon: f64) -> bool {
        let start = self.start();
        let (from, to) = self
            .window
            .map_or((0.0, horizon), |w| (w.start, w.end.min(horizon)));
        // distance of the disc from own ship's start, minus the distance that own ship can have
        // sailed
        let apart = self.centre - self.drift * start - own.pose.position;
        let closing = self.growth + own.max_speed();
        let spare = |t: f64| {
            (apart + self.drift * t).norm() - (self.radius - self.growth * start) - closing * t
        };
        // convex in time: the minimum is at an end, or where the rate is zero
        let square = self.drift.norm_squared() - closing * closing;
        let along = apart.dot(&self.drift) / self.drift.norm_squared();
        let across = cross(self.drift, apart).abs() / self.drift.norm();
        let least = closing * across / (self.drift.norm() * square.max(0.0).sqrt()) - along;
        // a NaN becomes the beginning
        let least = least.max(from).min(to);
        // negated on purpose: a NaN is within reach
        ![from, least, to].into_iter().all(|t| spare(t) > REACH_M)
    }

    /// True only where it contains a body at all times: a polytope without a window, whose initial set and
    /// velocities contain the body's, but for rounding. O(vertices × vertices).
    pub(crate) fn contains_body(&self, body: &PolytopeObstacle) -> bool {
        let inside = |outer: &ConvexPolygon, inner: &ConvexPolygon, rounding: f64| {
            let mut vertices = inner.vertices().iter();
            vertices.all(|vertex| outer.signed_distance(*vertex) <= rounding)
        };
        self.window.is_none()
            && self.ellipsoid.is_none()
            && inside(self.body.velocity(), body.velocity(), SAME_MPS)
            && inside(self.body.initial(), body.initial(), SAME_M)
    }

    /// Enclosing disc at a time, metres; `None` outside the time window.
    pub(crate) fn disc_at(&self, time: f64) -> Option<(Vector, f64)> {
        let is_over = |w: Interval| !(time >= w.start && time <= w.end);
        if self.window.is_some_and(is_over) {
            return None;
        }
        let time = time - self.start();
        Some((
            self.centre + self.drift * time,
            self.radius + self.growth * time,
        ))
    }

    /// Velocity of the disc's centre, m/s.
    pub(crate) fn drift(&self) -> Vector {
        self.drift
    }

    /// Upper bound of the speed of all its points, m/s.
    pub(crate) fn speed(&self) -> f64 {
        self.drift.norm() + self.growth
    }

    /// Start of the piece's clock, seconds.
    pub(crate) fn start(&self) -> f64 {
        self.window.map_or(0.0, |w| w.start)
    }

    /// Part of a segment within the time window, in the clock of the piece.
    #[cold]
    #[inline(never)]
    fn during(window: &Interval, segment: &Segment) -> Option<Segment> {
        if segment.start_time > window.end || segment.end_time() < window.start {
            return None;
        }
        let part = segment.between(window.start, window.end);
        Some(Segment {
            start_time: part.start_time - window.start,
            ..part
        })
    }

    /// Lower bound of the distance between the segment and the piece, metres. A negative value says
    /// nothing; infinity means that the piece does not exist then.
    #[inline]
    pub(crate) fn clearance_bound(&self, segment: &Segment) -> f64 {
        match &self.window {
            None => self.local_clearance_bound(segment),
            Some(window) => Self::during(window, segment)
                .map_or(f64::INFINITY, |s| self.local_clearance_bound(&s)),
        }
    }

    /// [`Self::clearance_bound`] for a segment with a known midpoint.
    #[inline]
    pub(crate) fn clearance_bound_about(&self, segment: &Segment, middle: Vector) -> f64 {
        match &self.window {
            None => self.bound_about(segment, middle),
            Some(_) => self.clearance_bound(segment),
        }
    }

    #[inline]
    fn local_clearance_bound(&self, segment: &Segment) -> f64 {
        self.bound_about(segment, segment.middle().position)
    }

    /// Least distance from the enclosing disc, metres: along a line, or from the midpoint of an arc.
    #[inline]
    fn bound_about(&self, segment: &Segment, middle: Vector) -> f64 {
        let half = 0.5 * segment.duration;
        let apart = middle - self.centre - self.drift * (segment.start_time + half);
        let radius = self.radius + self.growth * segment.end_time();
        if segment.is_arc() {
            return apart.norm() - (segment.speed + self.drift.norm()) * half - radius;
        }
        // relative to the disc, from the start to the midpoint
        let way = middle - segment.start.position - self.drift * half;
        let nearest = -apart.dot(&way) / way.norm_squared();
        // without a way any place on it
        let nearest = if nearest.is_nan() {
            0.0
        } else {
            nearest.clamp(-1.0, 1.0)
        };
        (apart + way * nearest).norm() - radius
    }

    /// Signed distance from the section in metres, negative inside: the slack of a polytope, the
    /// distance of an ellipsoid. `None` outside the time window.
    pub(crate) fn slack(&self, position: Vector, time: f64) -> Option<f64> {
        if let Some(w) = &self.window
            && !(time >= w.start && time <= w.end)
        {
            return None;
        }
        let local = time - self.start();
        Some(match self.ellipsoid {
            Some(ellipsoid) => ellipsoid.signed_distance(position, local).distance,
            None => self.body.slack(position, local).value,
        })
    }

    /// The interval during which a position is inside, deeper than touching.
    pub(crate) fn covers(&self, position: Vector, from: f64, to: f64) -> Option<Interval> {
        // an arrival at the horizon may be after it by rounding
        let duration = (to - from).max(0.0);
        let wait = Segment::straight(Pose::new(position, 0.0), from, duration, 0.0);
        let wait = match &self.window {
            None => wait,
            Some(window) => Self::during(window, &wait)?,
        };
        let inside = match self.ellipsoid {
            Some(ellipsoid) => ellipsoid.line_contact(&wait),
            None => contact::line_contact(self.body, &wait, TOUCH_M),
        }?;
        Some(Interval {
            start: inside.start + self.start(),
            end: inside.end + self.start(),
        })
    }

    /// Separation between a hull at a pose and the section along the axes of both, metres: negative
    /// in overlap, else a lower bound of the distance. `None` outside the time window.
    pub(crate) fn clearance_of(&self, hull: &Hull, pose: &Pose, time: f64) -> Option<f64> {
        self.disc_at(time)?;
        let (local, ahead) = (time - self.start(), pose.ahead());
        let port = to_port(ahead);
        let half =
            |n: &Vector| 0.5 * (hull.length * n.dot(&ahead).abs() + hull.beam * n.dot(&port).abs());
        let (initial, velocity) = (self.body.initial(), self.body.velocity());
        let theirs = self.body.faces().iter();
        let theirs = theirs.map(|f| f.slack(pose.position, local) - half(&f.normal));
        let ours = [ahead, port, -ahead, -port].into_iter();
        let ours = ours.map(|n| {
            n.dot(&pose.position) - initial.support(n) - velocity.support(n) * local - half(&n)
        });
        Some(theirs.chain(ours).fold(f64::NEG_INFINITY, f64::max))
    }

    /// Distance from a point inside to the boundary of the section in a direction, metres.
    pub(crate) fn exit_distance(&self, position: Vector, time: f64, toward: Vector) -> f64 {
        let local = time - self.start();
        self.body
            .faces()
            .iter()
            .filter(|f| f.normal.dot(&toward) > 1e-9)
            .map(|f| (-f.slack(position, local)).max(0.0) / f.normal.dot(&toward))
            .fold(f64::INFINITY, f64::min)
    }

    /// First instant at which the segment is inside, deeper than touching.
    pub(crate) fn first_contact(&self, segment: &Segment) -> Option<f64> {
        let Some(window) = &self.window else {
            return self.local_contact(segment);
        };
        let local = Self::during(window, segment)?;
        self.local_contact(&local).map(|t| t + window.start)
    }

    fn local_contact(&self, segment: &Segment) -> Option<f64> {
        if self.local_clearance_bound(segment) > 0.0 {
            return None;
        }
        match self.ellipsoid {
            Some(ellipsoid) => ellipsoid_contact(ellipsoid, segment),
            None => contact::first_contact(self.body, segment, TOUCH_M),
        }
    }

    /// True when the segment with midpoint `middle` is inside, deeper than touching.
    fn meets_about(&self, segment: &Segment, middle: Vector) -> bool {
        match &self.window {
            None => self.local_meets(segment, middle),
            Some(window) => Self::during(window, segment)
                .is_some_and(|s| self.local_meets(&s, s.middle().position)),
        }
    }

    fn local_meets(&self, segment: &Segment, middle: Vector) -> bool {
        // negated on purpose: a NaN is tested
        !(self.bound_about(segment, middle) > 0.0)
            && match self.ellipsoid {
                Some(ellipsoid) => ellipsoid_contact(ellipsoid, segment).is_some(),
                None => contact::meets(self.body, segment, TOUCH_M),
            }
    }
}

/// First contact with an ellipsoid. A line that does not touch it is decided in closed form.
fn ellipsoid_contact(ellipsoid: &EllipsoidObstacle, segment: &Segment) -> Option<f64> {
    if !segment.is_arc() {
        ellipsoid.first_contact(segment, 0.0)?;
    }
    ellipsoid.first_contact(segment, TOUCH_M)
}

/// First obstacle, in their order, that the first segment in contact meets deeper than touching.
pub(crate) fn first_met(proxies: &[Proxy], segments: &[Segment]) -> Option<usize> {
    segments.iter().find_map(|s| {
        let middle = s.middle().position;
        let met = proxies.iter().find(|h| h.meets_about(s, middle));
        met.map(|h| h.obstacle)
    })
}

/// First contact of a chain of segments with any obstacle: `(obstacle, time)`. Among simultaneous
/// contacts the first obstacle counts.
pub(crate) fn first_contact(proxies: &[Proxy], segments: &[Segment]) -> Option<(usize, f64)> {
    for segment in segments {
        let hit = proxies
            .iter()
            .filter_map(|h| h.first_contact(segment).map(|t| (h.obstacle, t)))
            .min_by(|a, b| a.1.total_cmp(&b.1));
        if hit.is_some() {
            return hit;
        }
    }
    None
}

/// Broad phase: proxies that own ship can meet until the horizon. All later costs are proportional
/// to their number.
pub(crate) fn within_reach<'a>(problem: &Problem, pieces: &'a [Piece]) -> Vec<Proxy<'a>> {
    let proxies = pieces.iter().map(Proxy::new);
    proxies
        .filter(|h| h.is_within_reach(problem.own, problem.horizon))
        .collect()
}

/// Proxies grouped by obstacle, in their order.
pub(crate) fn by_obstacle<'h, 'a>(
    proxies: &'h [Proxy<'a>],
) -> impl Iterator<Item = &'h [Proxy<'a>]> {
    proxies.chunk_by(|a, b| a.obstacle == b.obstacle)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_fixtures::own_ship;
    use rand::{Rng, SeedableRng};
    use searoom_geometry::frame::direction;
    use searoom_geometry::{ConvexPolygon, outer_disc};

    /// A disc around a ship, and sets that contain it or do not: every place of the disc at any time is in a
    /// set that is said to contain it.
    #[test]
    fn what_contains_a_body_is_met_wherever_the_body_is() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let (mut contained, mut others) = (0, 0);
        for _ in 0..2_000 {
            let mut near = |most: f64| {
                let angle: f64 = rng.random_range(-3.1..3.1);
                direction(angle) * rng.random_range(0.0..most)
            };
            let (centre, drift) = (near(500.0), near(8.0));
            let disc = outer_disc(60.0, 0.0).translated(centre);
            let body = PolytopeObstacle::new("", disc, ConvexPolygon::point(drift));
            let around: Vec<Vector> = (0..5).map(|_| drift + near(0.5)).collect();
            let velocity = ConvexPolygon::hull(&around).expect("finite");
            let initial = outer_disc(80.0, 0.3).translated(centre + near(40.0));
            let set = PolytopeObstacle::new("", initial, velocity);
            let proxy = Proxy::at_rest(0, &set);
            if !proxy.contains_body(&body) {
                others += 1;
                continue;
            }
            contained += 1;
            for time in [0.0, 1.0, 60.0, 1_000.0] {
                for vertex in body.initial().vertices() {
                    let slack = set.slack(*vertex + drift * time, time).value;
                    assert!(slack <= SAME_M + SAME_MPS * time, "{slack} at {time}");
                }
            }
        }
        assert!(contained > 100 && others > 100, "{contained} {others}");
    }

    /// Compares with sampling, for sets that move, rest, approach and recede, and for pieces with
    /// time windows.
    #[test]
    fn proxies_out_of_reach_are_never_met() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(4);
        let (mut within, mut beyond) = (0, 0);
        for case in 0..4000 {
            let mut near = |most: f64| {
                let angle: f64 = rng.random_range(-3.1..3.1);
                direction(angle) * rng.random_range(0.0..most)
            };
            let own = OwnShip {
                pose: Pose::new(near(3000.0), 0.0),
                ..own_ship(&[2.5, 5.0, 6.0])
            };
            let drift = if case % 5 == 0 {
                Vector::zeros()
            } else {
                near(14.0)
            };
            let spread: Vec<Vector> = (0..4).map(|_| drift + near(0.8)).collect();
            let velocity = ConvexPolygon::hull(&spread).expect("finite");
            let initial = outer_disc(150.0, 0.0).translated(near(12_000.0));
            let body = PolytopeObstacle::new("", initial, velocity);
            let window = (case % 3 == 0).then_some(Interval {
                start: 200.0,
                end: 500.0,
            });
            let piece = Piece {
                obstacle: 0,
                window,
                body,
                ellipsoid: None,
            };
            let proxy = Proxy::new(&piece);
            let horizon = 900.0;
            let least = (0..=9000)
                .filter_map(|k| {
                    let time = horizon * f64::from(k) / 9000.0;
                    let (centre, radius) = proxy.disc_at(time)?;
                    let apart = (centre - own.pose.position).norm();
                    Some(apart - radius - own.max_speed() * time)
                })
                .fold(f64::INFINITY, f64::min);
            if proxy.is_within_reach(&own, horizon) {
                within += 1;
                // distance of an instant from the nearest sample
                assert!(least <= REACH_M + 0.05 * 30.0, "{least}");
            } else {
                beyond += 1;
                assert!(least > 0.0, "{least}");
            }
        }
        assert!(within > 500 && beyond > 500, "{within} {beyond}");
    }
}
