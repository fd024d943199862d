//! A target: a tracked ship or explicit sets, with its possible positions at t = 0 and its possible
//! velocities.

pub mod route;
mod uncertainty;

pub use uncertainty::{TimedVelocitySet, Uncertainty};

use crate::vessel::Hull;
use route::{RouteLeg, RoutePoint, Spread, Track};
use searoom_geometry::frame::{Pose, Vector, direction, heading_of, to_port, wrap};
use searoom_geometry::tolerance::{self, ELLIPSE_SIDES, SIGMAS};
use searoom_geometry::{ConvexPolygon, DISC_SIDES, outer_disc};

/// Half the angle between two tangents of the outer arc, radians: 5°.
const TANGENT_SPACING: f64 = std::f64::consts::PI / 36.0;

/// Turn within one time interval of a turning target, radians: 5°.
const TURN_PER_INTERVAL: f64 = std::f64::consts::PI / 36.0;

/// Largest radius of a turn on a known route, in lengths of the ship: the advance of a turn by 90°
/// with full rudder is at most 4.5 lengths (IMO resolution MSC.137(76)).
const TURN_LENGTHS: f64 = 4.5;

/// Most velocity sets of a ship on a known route.
const ROUTE_SETS: usize = 50;

/// Sides of a turned hull's outer polygon shorter than this fraction of the half-diagonal are
/// omitted.
const SHORT_SIDE: f64 = 1e-3;

/// Kind of ship domain around a target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DomainKind {
    /// A symmetric base, extended to the side that the encounter forbids.
    Colregs,
    /// One convex polygon, large in front and to starboard, sized by the target's length.
    Paper,
    /// No domain: only hull and margin.
    Hull,
    /// Distances from the hull's edge, metres.
    Custom {
        /// Ahead of the bow.
        fore: f64,
        /// Behind the stern.
        aft: f64,
        /// To port.
        port: f64,
        /// To starboard.
        starboard: f64,
    },
}

/// A leg of a target's known route.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KnownLeg {
    /// Where it ends, metres.
    pub to: Vector,
    /// Nominal speed on it, m/s, positive.
    pub speed: f64,
}

/// A tracked ship: nominal motion and its uncertainty.
#[derive(Debug, Clone, PartialEq)]
pub struct ShipTrack {
    /// Estimated hull centre and heading at t = 0. The course equals the heading: no drift.
    pub pose: Pose,
    /// Estimated speed, m/s, not negative.
    pub speed: f64,
    /// Hull.
    pub hull: Hull,
    /// Standard deviation of the position, metres per axis.
    pub position_std: f64,
    /// Standard deviation of the speed, m/s.
    pub speed_std: f64,
    /// Standard deviation of the course, radians.
    pub course_std: f64,
    /// By how much the ship may change its speed, m/s.
    pub speed_spread: f64,
    /// By how much the ship may change its course to either side, radians, without
    /// `starboard_turn`.
    pub course_spread: f64,
    /// How much farther to starboard the course may be, radians, to port where it is negative: a
    /// ship that gives way turns to starboard (docs/reference/scenario.md).
    pub starboard_turn: f64,
    /// Largest turn rate to either side, radians per second, not negative: the possible courses grow
    /// by `turn_rate t` to either side.
    pub turn_rate: f64,
    /// Positions at t = 0 about the estimate that earlier plans allow, metres; `None` for any.
    pub kept_positions: Option<ConvexPolygon>,
    /// How far the hull may be turned from the heading at t = 0 to either side, radians, where that is
    /// known apart from the courses: a ship at rest drifts to any side, and lies in one direction.
    /// `None` for a hull that lies in the direction of the course.
    pub heading_spread: Option<f64>,
    /// Velocities that the ship is known to keep to, given or from earlier plans; `None` for any,
    /// and for a ship that may turn.
    pub kept_velocities: Option<ConvexPolygon>,
    /// The ship's known route from its position on, with the speeds of the legs; empty for a ship
    /// that keeps course and speed. Heading and speed at t = 0 are those of the first leg. It goes
    /// on beyond the last place.
    pub route: Vec<KnownLeg>,
    /// How much earlier or later the ship may turn on its route than its speed says, seconds.
    pub time_spread: f64,
    /// Metres between the centres: there is risk of collision (Rule 7(a)) up to this distance at the
    /// closest approach, where it is more than that of the limits. 0 but for a ship whose set own
    /// ship alters for.
    pub risk_distance: f64,
    /// The requested ship domain.
    pub domain: DomainKind,
}

impl ShipTrack {
    /// A ship whose state is known and that keeps it, without a ship domain; metres, radians, m/s.
    pub fn exact(pose: Pose, speed: f64, hull: Hull) -> Self {
        Self {
            pose,
            speed,
            hull,
            position_std: 0.0,
            speed_std: 0.0,
            course_std: 0.0,
            speed_spread: 0.0,
            course_spread: 0.0,
            starboard_turn: 0.0,
            turn_rate: 0.0,
            kept_positions: None,
            heading_spread: None,
            kept_velocities: None,
            route: Vec::new(),
            time_spread: 0.0,
            risk_distance: 0.0,
            domain: DomainKind::Hull,
        }
    }

    /// The ship with a polygon of the velocities that it may take, in place of its spreads,
    /// standard deviations and turns. Its hull may have every heading on which it may move.
    /// O(vertices).
    pub fn with_velocities(self, velocities: ConvexPolygon) -> Self {
        let speeds = velocities.vertices().iter().map(|v| v.norm());
        let fastest = speeds.fold(0.0, f64::max);
        let slowest = velocities.signed_distance(Vector::zeros());
        let off = |v: &Vector| wrap(heading_of(*v) - self.pose.heading).abs();
        let widest = velocities.vertices().iter().map(off).fold(0.0, f64::max);
        // around zero, or over half a turn, every course is possible
        let is_narrow = slowest > 0.0 && widest < std::f64::consts::FRAC_PI_2;
        Self {
            speed_spread: (fastest - self.speed).max(self.speed - slowest.max(0.0)),
            course_spread: if is_narrow {
                widest
            } else {
                std::f64::consts::PI
            },
            speed_std: 0.0,
            course_std: 0.0,
            starboard_turn: 0.0,
            turn_rate: 0.0,
            kept_velocities: Some(velocities),
            ..self
        }
    }

    /// The ship on a known route, with the heading and the speed of its first leg. The places
    /// differ from one another and the first from the ship's position.
    pub fn with_route(mut self, route: Vec<KnownLeg>) -> Self {
        if let Some(first) = route.first() {
            self.pose.heading = heading_of(first.to - self.pose.position);
            self.speed = first.speed;
        }
        self.route = route;
        self
    }

    /// Estimated velocity at t = 0, m/s.
    pub fn velocity(&self) -> Vector {
        self.pose.ahead() * self.speed
    }

    /// The nominal motion as straight runs: the start of each in seconds, the pose and the speed
    /// then. The first begins at t = 0, the last has no end.
    pub fn runs(&self) -> impl Iterator<Item = (f64, Pose, f64)> + '_ {
        let (mut time, mut place) = (0.0, self.pose.position);
        let legs = self.route.iter().map(move |leg| {
            let way = leg.to - place;
            let run = (time, Pose::new(place, heading_of(way)), leg.speed);
            (time, place) = (time + way.norm() / leg.speed, leg.to);
            run
        });
        let steady = self.route.is_empty();
        let steady = steady.then_some((0.0, self.pose, self.speed));
        steady.into_iter().chain(legs)
    }

    /// The nominal velocities over time. Runs that are too short to end at a time of their own are
    /// left out.
    pub fn nominal_velocities(&self) -> Vec<TimedVelocitySet> {
        let ends = self.runs().skip(1).map(|run| run.0).chain([f64::INFINITY]);
        let runs = self
            .runs()
            .zip(ends)
            .filter(|((since, ..), until)| since < until);
        let timed = runs.map(|((_, pose, speed), until)| {
            TimedVelocitySet::new(until, ConvexPolygon::point(pose.ahead() * speed))
        });
        timed.collect()
    }

    /// Estimated pose at `time`; before t = 0 as if the ship had come straight.
    pub fn pose_at(&self, time: f64) -> Pose {
        self.nominal_at(time).0
    }

    /// Estimated pose and speed at `time`. O(legs of a known route).
    pub fn nominal_at(&self, time: f64) -> (Pose, f64) {
        let mut now = (0.0, self.pose, self.speed);
        if !self.route.is_empty() {
            now = self
                .runs()
                .take_while(|run| run.0 <= time)
                .last()
                .unwrap_or(now);
        }
        let (since, pose, speed) = now;
        let moved = pose.ahead() * speed * (time - since);
        (Pose::new(pose.position + moved, pose.heading), speed)
    }

    /// Greatest nominal speed, m/s.
    pub fn greatest_speed(&self) -> f64 {
        self.runs()
            .map(|(.., speed)| speed)
            .fold(self.speed, f64::max)
    }

    /// The known route as a track with turns on radii of up to `TURN_LENGTHS`; `None` without one.
    fn track(&self) -> Option<Track> {
        let start = (!self.route.is_empty()).then_some(self.pose.position)?;
        let places = std::iter::once(start).chain(self.route.iter().map(|leg| leg.to));
        let points = places.map(|position| RoutePoint {
            position,
            turn_radius: None,
        });
        let legs = self.route.iter().map(|leg| RouteLeg {
            slow: leg.speed,
            fast: leg.speed,
        });
        let radius = TURN_LENGTHS * self.hull.length;
        let (points, legs): (Vec<_>, Vec<_>) = (points.collect(), legs.collect());
        // no turn has a radius of its own that might not fit
        Track::along(&points, &legs, radius, None).ok()
    }

    /// The middle of the headings until the end of a known route, radians, and half their width,
    /// without what the ship may do beside the route.
    fn route_headings(&self) -> (f64, f64) {
        let (mut heading, mut low, mut high) = (self.pose.heading, 0.0_f64, 0.0_f64);
        let mut off = 0.0;
        for (_, pose, _) in self.runs() {
            let turn = wrap(pose.heading - heading);
            if route::is_to_either_side(turn) {
                return (self.pose.heading, std::f64::consts::PI);
            }
            off += turn;
            heading = pose.heading;
            (low, high) = (low.min(off), high.max(off));
        }
        (self.pose.heading + 0.5 * (low + high), 0.5 * (high - low))
    }

    /// The middle of the possible courses, radians.
    pub fn middle_course(&self) -> f64 {
        self.pose.heading - 0.5 * self.starboard_turn
    }

    /// Half the width of the courses that the ship may steer about the middle, radians.
    pub fn course_freedom(&self) -> f64 {
        self.course_spread + 0.5 * self.starboard_turn.abs()
    }

    /// Half the width of the possible courses, radians: what the ship may do, and three standard
    /// deviations.
    pub fn course_half_width(&self) -> f64 {
        self.course_freedom() + SIGMAS * self.course_std
    }

    /// Half the width of the possible speeds, m/s: what the ship may do, and three standard
    /// deviations. Speeds below 0 are left out.
    pub fn speed_half_width(&self) -> f64 {
        self.speed_spread + SIGMAS * self.speed_std
    }

    /// The middle of the headings that the ship may have until `time`, and half their width, radians:
    /// at most half a turn. Of a known route every leg counts, at any time.
    pub fn headings(&self, time: f64) -> (f64, f64) {
        // a rate of 0 does not turn the ship, however long it lasts
        let turned = match self.turn_rate == 0.0 {
            true => 0.0,
            false => self.turn_rate.abs() * time,
        };
        let (middle, half) = match self.heading_spread {
            Some(spread) => (self.pose.heading, spread + turned),
            None if !self.route.is_empty() => {
                let (middle, turned) = self.route_headings();
                (middle, self.course_half_width() + turned)
            }
            None => (self.middle_course(), self.course_half_width() + turned),
        };
        // `min` of a NaN and a number is the number: every heading
        (middle, half.min(std::f64::consts::PI))
    }

    /// An outer polygon of the possible positions at t = 0 about the estimate, metres: the disc of
    /// three standard deviations, less what earlier plans exclude.
    pub fn outer_positions(&self) -> ConvexPolygon {
        let all = outer_disc(SIGMAS * self.position_std, self.middle_course());
        match &self.kept_positions {
            Some(kept) => all.outer_intersection(kept).unwrap_or(all),
            None => all,
        }
    }

    /// An outer polygon of the hull at t = 0 for every possible heading until `time`.
    ///
    /// For a known heading it is the hull itself, otherwise at most 2 % of the half-diagonal
    /// larger. Its sides are among those of [`searoom_geometry::outer_disc`] about the heading, so
    /// the sum with such a disc has no more vertices than the disc.
    pub fn outer_hull(&self, time: f64) -> ConvexPolygon {
        let (middle, spread) = self.headings(time);
        let pose = Pose::new(self.pose.position, middle);
        if spread == 0.0 {
            return self.hull.polygon(&pose);
        }
        let reach = self.hull.half_diagonal();
        let corner = self.hull.beam.atan2(self.hull.length);
        // a quarter of the sides, from ahead to abeam; the others are reflections
        let quarter = DISC_SIDES / 4;
        let step = std::f64::consts::FRAC_PI_2 / quarter as f64;
        let support = |side: f64| {
            let off = (side * step - corner).abs() - spread;
            reach * off.max(0.0).cos()
        };
        let is_long = |side: f64| {
            let beside = support(side - 1.0) + support(side + 1.0);
            beside - 2.0 * support(side) * step.cos() > SHORT_SIDE * reach * step.sin()
        };
        let mut sides = vec![0.0];
        sides.extend((1..quarter).map(|k| k as f64).filter(|side| is_long(*side)));
        sides.push(quarter as f64);
        let meet = |pair: &[f64]| {
            let (ahead, gap) = (direction(pair[0] * step), (pair[1] - pair[0]) * step);
            let [here, next] = [support(pair[0]), support(pair[1])];
            ahead * here + to_port(ahead) * ((next - here * gap.cos()) / gap.sin())
        };
        let bow: Vec<Vector> = sides.windows(2).map(meet).collect();
        let mirrored = |x: f64, y: f64| {
            let there = bow.iter().map(move |p| Vector::new(p.x * x, p.y * y));
            there.map(|p| pose.world_coordinates(p))
        };
        let mut points: Vec<Vector> = mirrored(1.0, 1.0).collect();
        points.extend(mirrored(-1.0, 1.0).rev());
        points.extend(mirrored(-1.0, -1.0));
        points.extend(mirrored(1.0, -1.0).rev());
        ConvexPolygon::from_ccw(points)
    }

    /// An outer polygon of the velocities with a speed within [`Self::speed_half_width`], at least
    /// 0, and a course within [`Self::course_half_width`] about the middle.
    ///
    /// Tangents at most 5° from their touching points replace the outer arc. It exceeds the largest
    /// speed by at most 0.4 %.
    pub fn outer_velocity_set(&self) -> ConvexPolygon {
        self.outer_velocities_within(self.course_half_width())
    }

    /// Outer velocity sets of the ship while it turns at up to `turn_rate` radians per second to
    /// either side, so that its course at `t` is within [`Self::course_half_width`] + `turn_rate t`.
    ///
    /// Each set is that of the end of its time interval, when it is widest. An interval lasts at
    /// most until 5° of turn, so a half-width is at most 5° too wide. All courses are possible from
    /// `horizon` seconds on, or earlier where they are. A rate of 0 gives one set; a rate that is
    /// not finite gives every course at once.
    ///
    /// On a known route each set holds the velocities of all legs and turns that the ship may be on
    /// in its interval: it has made good their lengths at a speed within its spread.
    pub fn outer_velocity_sets(&self, turn_rate: f64, horizon: f64) -> Vec<TimedVelocitySet> {
        let timed =
            |until, spread| TimedVelocitySet::new(until, self.outer_velocities_within(spread));
        if let Some(track) = self.track() {
            let spread = Spread {
                speed: self.speed_half_width(),
                course: self.course_half_width(),
                time: self.time_spread,
                place: SIGMAS * self.position_std,
            };
            let sets = track
                .outer_velocity_sets(&spread, horizon, ROUTE_SETS)
                .into_iter();
            return sets
                .map(|(until, set)| TimedVelocitySet::new(until, set))
                .collect();
        }
        let rate = turn_rate.abs();
        if rate == 0.0 {
            return vec![timed(f64::INFINITY, self.course_half_width())];
        }
        let all = std::f64::consts::PI;
        let duration = TURN_PER_INTERVAL / rate;
        let mut sets = Vec::new();
        let mut start = 0.0;
        while start < horizon && rate.is_finite() {
            let until = f64::min(start + duration, horizon);
            let spread = self.course_half_width() + rate * until;
            if !(spread < all && until > start) {
                break;
            }
            sets.push(timed(until, spread));
            start = until;
        }
        sets.push(timed(f64::INFINITY, all));
        sets
    }

    fn outer_velocities_within(&self, half_width: f64) -> ConvexPolygon {
        let slow = (self.speed - self.speed_half_width()).max(0.0);
        let fast = self.speed + self.speed_half_width();
        let (middle, spread) = (self.middle_course(), half_width.min(std::f64::consts::PI));
        let mut points = Vec::new();
        for edge in [-spread, spread] {
            let ahead = direction(middle + edge);
            points.push(ahead * slow);
            points.push(ahead * fast);
        }
        // Tangents count from the ends: sets that turn by their spacing share their normals, and
        // sections stay small.
        let mut end = spread;
        let mut corners = Vec::new();
        while end > 2.0 * TANGENT_SPACING * (1.0 + tolerance::LIMIT) {
            corners
                .extend([-1.0, 1.0].map(|side| (side * (end - TANGENT_SPACING), TANGENT_SPACING)));
            end -= 2.0 * TANGENT_SPACING;
        }
        if end > TANGENT_SPACING {
            corners.extend([-1.0, 1.0].map(|side| (side * end / 2.0, end / 2.0)));
        } else if end > 0.0 {
            corners.push((0.0, end));
        }
        let corner = |(course, half): (f64, f64)| direction(middle + course) * (fast / half.cos());
        points.extend(corners.into_iter().map(corner));
        // finite by construction; should a number overflow, every velocity is possible
        let all = ConvexPolygon::hull(&points).unwrap_or_else(|_| everything());
        match &self.kept_velocities {
            Some(kept) if self.turn_rate == 0.0 => all.outer_intersection(kept).unwrap_or(all),
            _ => all,
        }
    }
}

fn everything() -> ConvexPolygon {
    let far = f64::MAX.sqrt();
    ConvexPolygon::rectangle(Vector::zeros(), far, far)
}

/// Motion of a target, as far as it is known.
#[derive(Debug, Clone, PartialEq)]
pub enum Motion {
    /// A tracked ship.
    Ship(ShipTrack),
    /// Explicit sets, all polygons or all ellipses. Own ship is a point, and nothing is added.
    Sets(Uncertainty),
}

searoom_geometry::words! {
    /// Kind of a target's sets.
    pub enum Representation {
        /// Polygons, unchanged.
        Polytope => "polytope",
        /// The smallest ellipses around them.
        Ellipsoid => "ellipsoid",
    }
}

searoom_geometry::words! {
    /// Navigational status.
    pub enum Status {
        /// Under way using her engine.
        UnderWay => "under way",
        /// At anchor.
        Anchored => "anchored",
        /// Not under command.
        NotUnderCommand => "not under command",
        /// Restricted in her ability to manoeuvre.
        Restricted => "restricted",
        /// Constrained by her draught.
        ConstrainedByDraught => "constrained by draught",
        /// Moored.
        Moored => "moored",
        /// Aground.
        Aground => "aground",
        /// Engaged in fishing.
        Fishing => "fishing",
        /// Under way under sail.
        Sailing => "sailing",
        /// Towing astern.
        TowingAstern => "towing astern",
        /// Pushing ahead or towing alongside.
        Pushing => "pushing",
        /// A distress transmitter that is active.
        Distress => "distress",
        /// A distress transmitter under test.
        DistressTest => "distress test",
    }
}

/// A tracked target.
#[derive(Debug, Clone, PartialEq)]
pub struct Target {
    /// Unique within a scenario.
    pub name: String,
    /// Its motion, as far as it is known.
    pub motion: Motion,
    /// Kind of its sets; unused where ellipses are given.
    pub representation: Representation,
    /// Navigational status, where it is known. No set and no role follows from it.
    pub status: Option<Status>,
}

impl Target {
    /// Nominal position at `time`: the estimate, or that of the centres of the sets.
    pub fn position_at(&self, time: f64) -> Vector {
        match &self.motion {
            Motion::Ship(ship) => ship.pose_at(time).position,
            Motion::Sets(sets) => sets.center_at(time),
        }
    }

    /// Metres between a hull at `pose` and the target's nominal hull at `time`, negative in overlap.
    /// For explicit sets: from the centre of the hull, as they include it.
    pub fn distance_from(&self, hull: &Hull, pose: &Pose, time: f64) -> f64 {
        match &self.motion {
            Motion::Ship(ship) => {
                let other = ship.hull.polygon(&ship.pose_at(time));
                hull.polygon(pose).separation(&other)
            }
            Motion::Sets(sets) => sets.outer_section(time).signed_distance(pose.position),
        }
    }

    /// The first time in an interval, seconds, at which the nominal target meets a hull that lies
    /// still at a pose; `None` where it never does. Explicit sets move with the velocity at the
    /// centre of their velocities, against the centre of the hull. O(changes of the velocity).
    pub fn first_meets(&self, hull: &Hull, pose: &Pose, [from, until]: [f64; 2]) -> Option<f64> {
        let mut begin = from;
        for change in self.changes() {
            let end = change.min(until);
            if !(begin < end || begin == from && from == until) {
                continue;
            }
            let moved = self.position_at(end) - self.position_at(begin);
            let around = match &self.motion {
                Motion::Ship(ship) => {
                    let other = ship.hull.polygon(&ship.pose_at(begin));
                    other.minkowski_sum(&hull.polygon(pose).negated())
                }
                Motion::Sets(sets) => {
                    let here = self.position_at(begin) - sets.initial.center() - pose.position;
                    sets.initial.outer_polygon(ELLIPSE_SIDES).translated(here)
                }
            };
            if let Some(share) = around.first_on(Vector::zeros(), -moved) {
                return Some(begin + share * (end - begin));
            }
            begin = end;
        }
        None
    }

    /// The explicit sets, if it has them.
    pub fn sets(&self) -> Option<&Uncertainty> {
        match &self.motion {
            Motion::Ship(_) => None,
            Motion::Sets(sets) => Some(sets),
        }
    }

    /// The times at which its nominal velocity changes, seconds; the last one is infinite.
    pub fn changes(&self) -> Vec<f64> {
        let until = |sets: &[TimedVelocitySet]| sets.iter().map(|set| set.until).collect();
        match &self.motion {
            Motion::Ship(ship) => until(&ship.nominal_velocities()),
            Motion::Sets(sets) => until(&sets.velocities),
        }
    }

    /// The tracked ship, if it is one.
    pub fn ship(&self) -> Option<&ShipTrack> {
        match &self.motion {
            Motion::Ship(ship) => Some(ship),
            Motion::Sets(_) => None,
        }
    }
}

#[cfg(test)]
mod tests;
