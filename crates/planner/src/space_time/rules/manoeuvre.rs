//! Manoeuvres by the rules: one bold alteration in ample time, kept until every other ship is past and
//! clear, then back to the route, as a navigator would order it (Rules 8 and 13 to 17).
//!
//! ```text
//! hold ─► turn ─► straight [─► parallel] ─► passed ─► turn back ─► join the route
//! hold ─► half speed or less ───────────► passed ─► follow the route
//! ```
//!
//! An [`OutwardLeg`], until passed, and an [`Ending`] are a [`Manoeuvre`] of at most five
//! parameters. It is allowed if it is clear and by the rules.

use crate::clock::Clock;
use crate::space_time::context::Context;
use crate::space_time::land;
use crate::space_time::manoeuvre::chain::Chain;
use crate::space_time::manoeuvre::motion::until;
use crate::space_time::manoeuvre::return_to_line::motion_back;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::proxy::{Proxy, first_met};
use crate::space_time::rules::compliance::complies;
use crate::{Escape, PlannedManoeuvre, Problem, UnderWay};
use searoom_colregs::{APPARENT_TIME, APPARENT_TURN, Encountered};
use searoom_geometry::frame::{Pose, Vector, wrap};
use searoom_geometry::tolerance::{self, TOUCH_M};
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_model::trajectory::Segment;
use searoom_sets::{Obstacle, PolytopeObstacle, SpaceTimeObstacle, contact};

/// Seconds in which a harbour vessel sails its turning radius.
const NORMAL_TURN_S: f64 = 20.0;

/// Seconds of the least segment.
pub(super) const LEAST_S: f64 = 3.0;

/// Ratio of the costs above which less speed replaces a turn, Rule 8(c).
const SPEED_PRICE: f64 = 2.0;

/// Ratio of the costs above which own ship is on time again by a change of speed for less than
/// [`LEAST_S`].
const SHORT_PRICE: f64 = 2.0;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Parameters {
    /// Seconds at which the route is left.
    pub leave: f64,
    pub first: FirstAlteration,
    pub ending: Ending,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FirstAlteration {
    /// Turn in radians to port, seconds until the parallel course, and the speed in m/s.
    Turn { turn: f64, aside: f64, speed: f64 },
    /// The speed that is kept until passed, m/s.
    Slow { speed: f64 },
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Ending {
    /// Seconds from passing to the return.
    pub after: f64,
    /// Angle between the return line and the route, radians.
    pub back: f64,
}

impl FirstAlteration {
    /// Factor of the cost.
    pub(super) fn price(&self) -> f64 {
        match self {
            Self::Slow { .. } => SPEED_PRICE,
            Self::Turn { .. } => 1.0,
        }
    }
}

impl Parameters {
    /// One parameter changed by a step; `None` where it has none.
    pub(super) fn stepped(mut self, parameter: usize, step: f64, unit: f64) -> Option<Self> {
        let (ending, seconds) = (&mut self.ending, 20.0 * unit * step);
        match (parameter, &mut self.first) {
            (0, FirstAlteration::Turn { turn, .. }) => {
                let more = (turn.abs() + 0.15 * step).max(APPARENT_TURN);
                *turn = more * turn.signum();
            }
            (1, FirstAlteration::Turn { aside, .. }) if aside.is_finite() => {
                *aside = (*aside + seconds).max(LEAST_S);
            }
            (2, _) => ending.after = (ending.after + seconds).max(0.0),
            (3, FirstAlteration::Turn { .. }) => {
                ending.back = (ending.back + 0.15 * step).clamp(0.1, 1.4);
            }
            (4, _) => self.leave += seconds,
            _ => return None,
        }
        Some(self)
    }
}

/// A manoeuvre to the end of the route.
#[derive(Debug, Clone)]
pub(super) struct Manoeuvre {
    /// The manoeuvre that it goes on with.
    pub begun: Option<UnderWay>,
    pub parameters: Parameters,
    pub motion: Vec<Segment>,
    /// Seconds at which own ship turns back or changes its speed back.
    returns: f64,
    /// Seconds at which own ship is on the route again.
    pub joined: f64,
    /// By which manoeuvres are compared, m²: a turn is preferred over less speed.
    pub cost: f64,
}

impl Manoeuvre {
    /// The manoeuvre as a plan names it.
    pub(super) fn planned(&self) -> PlannedManoeuvre {
        let leave = self.parameters.leave;
        let heading = |s: &Segment| s.pose_at(leave).heading;
        let first_heading = self.first_segment().map_or(0.0, heading);
        let begun = self.begun;
        PlannedManoeuvre {
            begins: begun.map_or(leave, |begun| begun.begins),
            returns: self.returns,
            joins: self.joined,
            first_heading: begun.map_or(first_heading, |begun| begun.first_heading),
            turn: begun.map_or(self.escape().turn, |begun| begun.turn),
        }
    }

    pub(super) fn escape(&self) -> Escape {
        let (turn, speed) = match self.parameters.first {
            FirstAlteration::Turn { turn, .. } => (turn, None),
            FirstAlteration::Slow { speed } => (0.0, Some(speed)),
        };
        let then = || self.first_segment().map_or(0.0, |s| s.speed);
        Escape {
            held_until: self.parameters.leave,
            turn,
            speed: speed.unwrap_or_else(then),
        }
    }

    fn first_segment(&self) -> Option<&Segment> {
        let leave = self.parameters.leave;
        self.motion.iter().find(|s| s.end_time() > leave)
    }
}

/// The motion until every target is passed.
pub(super) struct OutwardLeg {
    leave: f64,
    pub first: FirstAlteration,
    /// Number of segments before the route is left.
    before: usize,
    pub motion: Vec<Segment>,
}

impl OutwardLeg {
    /// The part after the route is left.
    pub(super) fn off_route(&self) -> &[Segment] {
        &self.motion[self.before..]
    }
}

/// A target that own ship must not pass nearer than a length.
pub(super) struct Passing<'a> {
    pub encountered: &'a Encountered,
    /// The nominal hull, grown by own half-diagonal and the longer ship's length.
    within_a_length: PolytopeObstacle,
    /// The nominal hull, grown by own hull on its first course.
    pub hulls: PolytopeObstacle,
}

impl<'a> Passing<'a> {
    fn new(problem: &Problem, encountered: &'a Encountered) -> Self {
        let (own, ship) = (&problem.own.hull, &encountered.ship);
        let hull = encountered.hull.polygon(&ship.pose);
        let around = own.half_diagonal() + own.length.max(encountered.hull.length);
        let disc = outer_disc(around, ship.pose.heading);
        let course = Pose::new(Vector::zeros(), encountered.own.pose.heading);
        let moving =
            |initial| PolytopeObstacle::new("", initial, ConvexPolygon::point(ship.velocity()));
        Self {
            encountered,
            within_a_length: moving(hull.minkowski_sum(&disc)),
            hulls: moving(hull.minkowski_sum(&own.polygon(&course).negated())),
        }
    }

    pub(super) fn keeps_clear(&self) -> bool {
        self.encountered.role.duties().keeps_clear
    }
}

/// The manoeuvres of one problem.
pub(super) struct Manoeuvres<'s, 'a> {
    context: &'s Context<'a>,
    pub nominal_motion: &'s [Segment],
    /// Seconds from which on the nominal motion follows the route.
    pub from: f64,
    /// Per obstacle, true if the motion has to be clear of it to the end, and not only until own
    /// ship is on the route again.
    to_the_end: Vec<bool>,
    pub passing: Vec<Passing<'s>>,
    pub clock: Clock,
    /// True for a target that is not passed nearer than a length, Rule 8(d).
    pub keeps_a_length: fn(&Passing) -> bool,
    /// True where turns are made at half speed or less.
    pub slows_to_turn: bool,
    /// Factor of the durations: 1 for a harbour vessel that sails its turning radius in 20 s.
    pub unit: f64,
}

impl<'s, 'a> Manoeuvres<'s, 'a> {
    pub(super) fn new(
        context: &'s Context<'a>,
        (nominal_motion, from): (&'s [Segment], f64),
        all: bool,
        clock: Clock,
    ) -> Self {
        let problem = context.problem;
        let has_target = |obstacle: &Obstacle| {
            let mut encountered = problem.encountered.iter();
            encountered.any(|e| obstacle.contains(e.ship.moved(e.tcpa).pose.position, e.tcpa))
        };
        let obstacles = problem.obstacles.iter();
        let passing = problem.encountered.iter().map(|e| Passing::new(problem, e));
        let turn_s = problem.own.turning_radius / ManoeuvreSpeeds::of(problem).normal;
        Self {
            context,
            nominal_motion,
            from,
            to_the_end: obstacles.map(|o| all || has_target(o)).collect(),
            passing: passing.collect(),
            clock,
            keeps_a_length: |_| true,
            slows_to_turn: false,
            unit: (turn_s / NORMAL_TURN_S).max(1.0),
        }
    }

    pub(super) fn problem(&self) -> &'s Problem<'s> {
        self.context.problem
    }

    /// A manoeuvre, if it is clear and costs less than `below`.
    pub(super) fn manoeuvre(&self, parameters: &Parameters, below: f64) -> Option<Manoeuvre> {
        let before = until(self.nominal_motion, parameters.leave);
        let out = self.outward_leg(&before, parameters.leave, parameters.first)?;
        let found = self.with_ending(&out, parameters.ending)?;
        let cheaper = found.cost < below;
        (cheaper && self.is_clear(out.off_route()) && self.is_allowed(&out, &found))
            .then_some(found)
    }

    /// A motion on the route until `leave`, continued until every target is passed.
    pub(super) fn outward_leg(
        &self,
        before: &[Segment],
        leave: f64,
        first: FirstAlteration,
    ) -> Option<OutwardLeg> {
        let (problem, route) = (self.problem(), self.context.route);
        let (own, begun) = (problem.own, problem.under_way);
        let mut motion = before.to_vec();
        let along = self.along_at(leave);
        match first {
            FirstAlteration::Slow { speed } => {
                let (on, _) = route.pose_at(along);
                let passed = self.passed(on.position, on.ahead() * speed, leave)?;
                let least = APPARENT_TIME + begun.map_or(0.0, |begun| begun.begins);
                let slow = (passed - leave).max(least).max(LEAST_S);
                let end = route.run(along, leave, slow * speed, speed, &mut motion);
                // at the end of the route the reduction may be too short to be apparent
                if end - along < speed * least - tolerance::LENGTH_M {
                    return None;
                }
            }
            FirstAlteration::Turn { turn, aside, speed } => {
                let pose = before.last().map_or(own.pose, Segment::end);
                let mut chain = Chain::new(pose, leave, speed, own.turning_radius);
                let (turn, back) = begun.map_or((turn, -turn), |begun| {
                    let back = wrap(begun.first_heading - begun.heading);
                    (wrap(begun.heading - pose.heading), back)
                });
                chain.arc(turn * own.turning_radius);
                if aside.is_finite() {
                    chain.line(speed * aside);
                    chain.arc(back * own.turning_radius);
                }
                let velocity = chain.pose.ahead() * speed;
                let passed = self.passed(chain.pose.position, velocity, chain.time)?;
                // a straight part between two turns, also where the target is passed at once
                chain.line(speed * (passed - chain.time).max(LEAST_S));
                // a turn along a corner of the route is no alteration
                let arc = chain.segments.first()?;
                if begun.is_none() && self.is_on_route(arc.end(), along + arc.length()) {
                    return None;
                }
                motion.extend(chain.segments);
            }
        }
        let in_time = motion.last()?.end_time() <= problem.horizon;
        let before = before.len();
        in_time.then_some(OutwardLeg {
            leave,
            first,
            before,
            motion,
        })
    }

    /// An outward leg completed to the end of the route. Whether this is clear is not yet known.
    pub(super) fn with_ending(&self, out: &OutwardLeg, ending: Ending) -> Option<Manoeuvre> {
        let (problem, route) = (self.problem(), self.context.route);
        let mut motion = out.motion.clone();
        let returns = motion.last()?.end_time() + ending.after;
        let joined;
        match out.first {
            FirstAlteration::Slow { speed } => {
                let slow: f64 = out.off_route().iter().map(Segment::length).sum();
                let along = self.along_at(out.leave);
                motion.truncate(out.before);
                let slow = slow + ending.after * speed;
                let along = route.run(along, out.leave, slow, speed, &mut motion);
                joined = motion.last()?.end_time();
                motion.extend(route.follow(along, joined));
            }
            FirstAlteration::Turn { turn, .. } => {
                let last = motion.last_mut()?;
                last.duration += ending.after;
                let (pose, time) = (last.end(), last.end_time());
                let near = problem.desired.nearest(pose.position, time, 0.0);
                let mut legs = near.leg..problem.desired.legs().len().min(near.leg + 2);
                let back = legs
                    .find_map(|leg| motion_back(problem, route, (&pose, time), leg, ending.back))?;
                // on to the same side it would be a circle
                if back[0].is_arc() && back[0].turn_rate * turn > 0.0 {
                    return None;
                }
                joined = self.joining_time(&back)?;
                motion.extend(back);
            }
        }
        // the route has segments of its own, as short as its corners are, and a turn under way is
        // not whole
        let off_route = motion[out.before..].iter();
        let mut whole = off_route.skip(usize::from(problem.under_way.is_some()));
        let tidy = whole.all(|s| s.start_time >= joined || s.duration >= LEAST_S);
        (tidy && motion.last()?.end_time() <= problem.horizon).then(|| Manoeuvre {
            begun: problem.under_way,
            parameters: Parameters {
                leave: out.leave,
                first: out.first,
                ending,
            },
            returns,
            joined,
            cost: self.cost(&out.first, &motion, joined),
            motion,
        })
    }

    fn cost(&self, first: &FirstAlteration, motion: &[Segment], joined: f64) -> f64 {
        let on_route = motion.partition_point(|s| s.start_time < joined - tolerance::TIME_S);
        let is_short = match &motion[on_route..] {
            [now, next, ..] => now.duration < LEAST_S && now.speed != next.speed,
            _ => false,
        };
        let short_price = if is_short { SHORT_PRICE } else { 1.0 };
        self.problem().error_to_end(motion) * first.price() * short_price
    }

    /// Time from which on a return follows the route: after an arc, a line and an arc at most.
    fn joining_time(&self, back: &[Segment]) -> Option<f64> {
        let mut left: f64 = back.iter().map(Segment::length).sum();
        let joins = back.iter().take(3).find(|s| {
            left -= s.length();
            self.is_on_route(s.end(), self.context.route.length() - left)
        });
        joins.map(Segment::end_time)
    }

    /// First time at which every target is past and clear on a straight course: on its first
    /// course own ship would have it behind, the range opens, and it is more than a length away.
    fn passed(&self, position: Vector, velocity: Vector, time: f64) -> Option<f64> {
        const STEP_S: f64 = 5.0;
        let mut passed = time;
        for Passing { encountered: e, .. } in &self.passing {
            let target = e.ship.velocity();
            let apart = e.ship.moved(time).pose.position - position;
            for course in [e.own.velocity(), velocity] {
                // falls at a constant rate on a straight course
                let relative = course - target;
                let left = apart.dot(&relative);
                let rate = (velocity - target).dot(&relative);
                // a NaN is never passed
                if !(left <= 0.0) {
                    passed = passed.max((rate > 0.0).then_some(time + left / rate)?);
                }
            }
        }
        while passed <= self.problem().horizon {
            let there = position + velocity * (passed - time);
            let clear = |p: &Passing| p.within_a_length.slack(there, passed).value > 0.0;
            if self.kept_off().all(clear) {
                return Some(passed);
            }
            passed += STEP_S;
        }
        None
    }

    /// True for segments that are clear of every set, of land, and of a length around every target.
    pub(super) fn is_clear(&self, segments: &[Segment]) -> bool {
        first_met(self.context.proxies, segments).is_none()
            && !land::meets(self.problem().land_obstacle, segments)
            && self.keeps_lengths(segments)
    }

    /// [`Self::is_clear`] of the obstacles that count to the end, and of land if all do.
    fn is_clear_to_the_end(&self, segments: &[Segment]) -> bool {
        let clear = |p: &Proxy| segments.iter().all(|s| p.first_contact(s).is_none());
        let mut proxies = self.context.proxies.iter();
        let all = self.to_the_end.iter().all(|whole| *whole);
        proxies.all(|p| !self.to_the_end[p.obstacle] || clear(p))
            && !(all && land::meets(self.problem().land_obstacle, segments))
            && self.keeps_lengths(segments)
    }

    fn keeps_lengths(&self, segments: &[Segment]) -> bool {
        let near =
            |s, p: &Passing| contact::first_contact(&p.within_a_length, s, TOUCH_M).is_some();
        !segments.iter().any(|s| self.kept_off().any(|p| near(s, p)))
    }

    /// True for a manoeuvre that is clear to its end where its outward leg is, and by the rules.
    pub(super) fn is_allowed(&self, out: &OutwardLeg, manoeuvre: &Manoeuvre) -> bool {
        let motion = &manoeuvre.motion;
        let off_route = match out.first {
            FirstAlteration::Turn { .. } => &motion[out.before..],
            FirstAlteration::Slow { .. } => &[],
        };
        // the last segment may have become longer
        let rest = &motion[out.motion.len() - 1..];
        let joins = rest.partition_point(|s| s.start_time < manoeuvre.joined);
        self.is_clear(&rest[..joins])
            && self.is_clear_to_the_end(&rest[joins..])
            && complies(self.problem(), self.to_judge(motion), off_route)
    }

    /// The part of a motion that the rules judge: all but an approach to the route and manoeuvres
    /// before it.
    pub(super) fn to_judge<'m>(&self, motion: &'m [Segment]) -> &'m [Segment] {
        &motion[motion.partition_point(|s| s.start_time < self.from)..]
    }

    /// The targets that are not passed nearer than a length.
    pub(super) fn kept_off(&self) -> impl Iterator<Item = &Passing<'s>> {
        self.passing.iter().filter(|p| (self.keeps_a_length)(p))
    }

    /// Distance along the route at a time at which the nominal motion follows it, metres.
    fn along_at(&self, time: f64) -> f64 {
        let left = self.nominal_motion.iter().map(|s| {
            let duration = (s.end_time() - s.start_time.max(time)).max(0.0);
            duration * s.speed
        });
        self.context.route.length() - left.sum::<f64>()
    }

    /// True for a pose of the route after this many metres.
    fn is_on_route(&self, pose: Pose, along: f64) -> bool {
        let (on, _) = self.context.route.pose_at(along);
        (pose.position - on.position).norm() <= tolerance::JOINT_M
            && wrap(pose.heading - on.heading).abs() <= tolerance::JOINT_RAD
    }
}
