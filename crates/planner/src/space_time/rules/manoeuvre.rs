//! Manoeuvres by the rules: one bold alteration in ample time, kept until every other ship is past and
//! clear, then back to the route, as a navigator would order it (Rules 8 and 13 to 17).
//!
//! ```text
//! hold ─► turn ─► straight [─► parallel] ─► passed ─► turn back ─► join the route
//! hold ─► half speed or less, or a stop ─► passed ─► follow the route
//! ```
//!
//! A [`Partial`] manoeuvre is built part by part: each part is the shortest one whose line is clear
//! ([`hug`](super::hug)), so only the departure, the course, and the way back are chosen.

use crate::space_time::bound::Heuristic;
use crate::space_time::context::Context;
use crate::space_time::land;
use crate::space_time::manoeuvre::chain::Chain;
use crate::space_time::manoeuvre::interceptor::Interceptor;
use crate::space_time::manoeuvre::motion::until;
use crate::space_time::manoeuvre::return_to_line::motion_back;
use crate::space_time::proxy::Proxy;
use crate::space_time::rules::automaton::Effort;
use crate::space_time::rules::bodies::Passing;
use crate::space_time::rules::compliance::{after_nearest, complies};
use crate::space_time::rules::hug::{Held, HeldTurn, least_clear};
use crate::space_time::settings::RuleSettings;
use crate::{Escape, PlannedManoeuvre, Problem, Tidiness, UnderWay};
use searoom_colregs::{APPARENT_SPEED, APPARENT_TIME, APPARENT_TURN, Encountered};
use searoom_geometry::frame::{Pose, Side, Vector, cross, heading_of, wrap};
use searoom_geometry::tolerance;
use searoom_model::trajectory::Segment;
use searoom_sets::{Obstacle, PolytopeObstacle, SpaceTimeObstacle};

/// The first alteration of a manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum FirstAlteration {
    /// Turn in radians to port, and the speed in m/s.
    Turn { turn: f64, speed: f64 },
    /// The speed that is kept until passed, m/s; 0 for a stop.
    Slow { speed: f64 },
}

impl FirstAlteration {
    pub(super) fn speed(&self) -> f64 {
        let (Self::Turn { speed, .. } | Self::Slow { speed }) = *self;
        speed
    }
}

/// How own ship goes on until the targets are passed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Outward {
    /// On its new course.
    Direct,
    /// On a course parallel to the first one, from the least offset on at which it is clear until this
    /// many seconds after the targets are passed. One that is just clear may have no way back.
    Parallel { spare: f64 },
}

/// How own ship comes back once the targets are passed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum WayBack {
    /// Onto the route, by a line at this angle to it, radians.
    At(f64),
    /// By one turn and a line to the last waypoint, at the greatest speed or at the one ordered there.
    ToEnd,
}

/// Where a partial manoeuvre ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Phase {
    /// On the route, before any alteration.
    Route,
    /// At the beginning of the line after the first alteration.
    Out,
    /// Where every target is passed, on the line that leads there.
    Passed,
    /// At the end of the route.
    End,
}

/// A manoeuvre up to a phase.
#[derive(Debug, Clone)]
pub(super) struct Partial {
    pub phase: Phase,
    /// Seconds at which the route is left.
    pub leave: f64,
    pub first: FirstAlteration,
    pub outward: Outward,
    pub way_back: WayBack,
    /// Number of segments before the route is left.
    pub before: usize,
    /// From t = 0 on.
    pub motion: Vec<Segment>,
    /// Seconds at which own ship turns back or changes its speed back; known at the end.
    returns: f64,
    /// Seconds at which own ship is on the route again; known at the end.
    pub joined: f64,
    /// True for an end that is known to be by the rules.
    pub is_judged: bool,
    /// By which manoeuvres are compared, m²: a turn is preferred over less speed.
    pub cost: f64,
}

impl Partial {
    /// On the route at t = 0.
    pub(super) fn start() -> Self {
        Self {
            phase: Phase::Route,
            leave: 0.0,
            first: FirstAlteration::Slow { speed: 0.0 },
            outward: Outward::Direct,
            way_back: WayBack::ToEnd,
            before: 0,
            motion: Vec::new(),
            returns: 0.0,
            joined: 0.0,
            is_judged: false,
            cost: 0.0,
        }
    }

    /// Pose and time at its end.
    pub(super) fn end(&self, own: Pose) -> (Pose, f64) {
        let last = self.motion.last();
        last.map_or((own, 0.0), |last| (last.end(), last.end_time()))
    }

    /// The part after the route is left.
    pub(super) fn off_route(&self) -> &[Segment] {
        &self.motion[self.before..]
    }
}

/// A manoeuvre to the end of the route.
#[derive(Debug, Clone)]
pub(super) struct Manoeuvre {
    /// The manoeuvre that it goes on with.
    pub begun: Option<UnderWay>,
    pub whole: Partial,
    /// Factor of its cost.
    pub price: f64,
}

impl Manoeuvre {
    /// The manoeuvre as a plan names it.
    pub(super) fn planned(&self) -> PlannedManoeuvre {
        let leave = self.whole.leave;
        let heading = |s: &Segment| s.pose_at(leave).heading;
        let first_heading = self.first_segment().map_or(0.0, heading);
        let begun = self.begun;
        PlannedManoeuvre {
            begins: begun.map_or(leave, |begun| begun.begins),
            returns: self.whole.returns,
            joins: self.whole.joined,
            first_heading: begun.map_or(first_heading, |begun| begun.first_heading),
            turn: begun.map_or(self.escape().turn, |begun| begun.turn),
        }
    }

    pub(super) fn escape(&self) -> Escape {
        let (turn, speed) = match self.whole.first {
            FirstAlteration::Turn { turn, .. } => (turn, None),
            FirstAlteration::Slow { speed } => (0.0, Some(speed)),
        };
        let then = || self.first_segment().map_or(0.0, |s| s.speed);
        Escape {
            held_until: self.whole.leave,
            turn,
            speed: speed.unwrap_or_else(then),
        }
    }

    fn first_segment(&self) -> Option<&Segment> {
        let leave = self.whole.leave;
        self.whole.motion.iter().find(|s| s.end_time() > leave)
    }
}

/// Limits and prices of the alterations that a manoeuvre may have.
#[derive(Debug, Clone, Copy)]
pub(super) struct Family<'a> {
    /// Least first turn, radians.
    pub least_turn: f64,
    /// First turns, where there are several departures, and where there is one, as multiples of 30°.
    pub turns: [&'a [f64]; 2],
    /// Greatest of the lower speeds, as a fraction of the ordered one.
    pub most_slow: f64,
    /// Least time at a lower speed, seconds.
    pub least_slow: f64,
    /// Least duration of a segment, seconds.
    pub least: f64,
    /// Ratio of the costs above which less speed replaces a turn.
    pub speed_price: f64,
    /// True where own ship may also speed up.
    pub may_speed_up: bool,
}

impl<'a> Family<'a> {
    /// By the rules toward these targets: an alteration is readily apparent (Rule 8).
    pub(super) fn by_the_rules(encountered: &[Encountered], settings: &'a RuleSettings) -> Self {
        let mut encountered = encountered.iter();
        Self {
            least_turn: APPARENT_TURN,
            turns: [&settings.turns, &settings.all_turns],
            most_slow: APPARENT_SPEED,
            least_slow: APPARENT_TIME,
            least: settings.least_s,
            speed_price: settings.speed_price,
            may_speed_up: encountered.any(|e| e.role.duties().may_speed_up),
        }
    }

    /// Without roles: smaller turns, any lower speed at no extra price, and more speed. The least times are those
    /// of a tidy plan, in seconds of the problem.
    pub(super) fn without_roles(tidy: &Tidiness, settings: &'a RuleSettings) -> Self {
        Self {
            least_turn: settings.plain_turn,
            turns: [&settings.plain_turns, &settings.plain_turns],
            most_slow: settings.plain_slow,
            least_slow: tidy.speed_time,
            least: tidy.segment_time,
            speed_price: 1.0,
            may_speed_up: true,
        }
    }
}

/// The manoeuvres of one problem.
pub(super) struct Manoeuvres<'s, 'a> {
    pub context: &'s Context<'a>,
    pub nominal_motion: &'s [Segment],
    /// Seconds from which on the nominal motion follows the route.
    pub from: f64,
    /// Per obstacle, true if the motion has to be clear of it to the end, and not only until own
    /// ship is on the route again.
    to_the_end: Vec<bool>,
    pub passing: Vec<Passing<'s>>,
    pub family: Family<'a>,
    /// True for a target from which one length of the longer ship is kept, Rule 8(d).
    pub keeps_a_length: fn(&Passing) -> bool,
    /// True where turns are made at half speed or less.
    pub slows_to_turn: bool,
    /// True where own ship may also stop.
    pub stops: bool,
    /// True where own ship follows a target on its route at less speed, and does not pass it.
    pub follows: bool,
    /// Largest first turn, radians.
    pub most_turn: f64,
    /// Factor of the durations: 1 for a harbour vessel that sails its turning radius in 20 s.
    pub unit: f64,
    /// Bound of the cost to go without any set.
    pub bound: Heuristic<'s>,
    /// The time left, and the account of the search.
    pub effort: Effort<'s>,
}

impl<'s, 'a> Manoeuvres<'s, 'a> {
    pub(super) fn new(
        context: &'s Context<'a>,
        (nominal_motion, from): (&'s [Segment], f64),
        all: bool,
        family: Family<'a>,
        effort: Effort<'s>,
    ) -> Self {
        let problem = context.problem;
        let settings = &problem.settings.rules;
        let has_target = |obstacle: &Obstacle| {
            let mut encountered = problem.encountered.iter();
            encountered.any(|e| obstacle.contains(e.ship.moved(e.tcpa).pose.position, e.tcpa))
        };
        let obstacles = problem.obstacles.iter();
        let passing = problem.encountered.iter().map(|e| Passing::new(context, e));
        let turn_s = problem.own.turning_radius / context.speeds.normal;
        Self {
            context,
            nominal_motion,
            from,
            to_the_end: obstacles.map(|o| all || has_target(o)).collect(),
            passing: passing.collect(),
            family,
            keeps_a_length: |_| true,
            slows_to_turn: false,
            stops: false,
            follows: false,
            most_turn: settings.largest_turn,
            unit: (turn_s / settings.turn_s).max(1.0),
            bound: Heuristic::new(problem.desired, problem.time_weight, problem.own),
            effort,
        }
    }

    pub(super) fn problem(&self) -> &'s Problem<'s> {
        self.context.problem
    }

    pub(super) fn settings(&self) -> &'s RuleSettings {
        &self.context.problem.settings.rules
    }

    /// Factor of the cost.
    pub(super) fn price(&self, first: FirstAlteration) -> f64 {
        match first {
            FirstAlteration::Slow { .. } => self.family.speed_price,
            FirstAlteration::Turn { .. } => 1.0,
        }
    }

    /// A motion on the route until `leave`, and the first alteration there. `None` where the turn only
    /// follows a corner of the route.
    pub(super) fn out(&self, leave: f64, first: FirstAlteration) -> Option<Partial> {
        let (own, begun) = (self.problem().own, self.problem().under_way);
        let mut motion = until(self.nominal_motion, leave);
        let before = motion.len();
        if let FirstAlteration::Turn { turn, speed } = first {
            let pose = motion.last().map_or(own.pose, Segment::end);
            let mut chain = Chain::new(pose, leave, speed, own.turning_radius);
            let turn = begun.map_or(turn, |begun| wrap(begun.heading - pose.heading));
            chain.arc(turn * own.turning_radius);
            // a turn along a corner of the route is no alteration
            if begun.is_none() {
                let arc = chain.segments.first()?;
                if self.is_on_route(arc.end(), self.along_at(leave) + arc.length()) {
                    return None;
                }
            }
            motion.extend(chain.segments);
        }
        let cost = self.problem().error_of(&motion) * self.price(first);
        Some(Partial {
            phase: Phase::Out,
            leave,
            first,
            before,
            motion,
            cost,
            ..Partial::start()
        })
    }

    /// A turn continued straight until every target is passed.
    pub(super) fn direct(&self, out: &Partial) -> Option<Partial> {
        let own = self.problem().own;
        let (pose, time) = out.end(own.pose);
        let speed = out.first.speed();
        let passed = self.guard(pose, speed, time)?;
        // a straight part between two turns, also where the target is passed at once
        let line = Segment::straight(pose, time, (passed - time).max(self.family.least), speed);
        if !self.is_clear(&[line]) {
            return None;
        }
        self.passed_after(out, Outward::Direct, &[line])
    }

    /// A turn continued by the least straight part after which a parallel course is clear until every
    /// target is passed and `spare` seconds longer. Where there is one with less to spare, it is not
    /// nearer than that.
    pub(super) fn parallel(
        &self,
        out: &Partial,
        spare: f64,
        close: f64,
        than: Option<&Partial>,
    ) -> Option<Partial> {
        let FirstAlteration::Turn { turn, speed } = out.first else {
            return None;
        };
        let (own, begun) = (self.problem().own, self.problem().under_way);
        let (pose, time) = out.end(own.pose);
        let back = begun.map_or(-turn, |begun| wrap(begun.first_heading - begun.heading));
        let held = HeldTurn {
            pose,
            time,
            held_speed: speed,
            turn: back,
            speed,
            radius: own.turning_radius,
        };
        // on a course that is sailed already there is no least time
        let least = if begun.is_some() {
            0.0
        } else {
            self.family.least
        };
        let narrower = than.and_then(|than| than.motion.get(out.motion.len()));
        let narrower = narrower
            .filter(|line| !line.is_arc())
            .map(|line| line.duration);
        let least = narrower.map_or(least, |hold| hold.max(least));
        let most = self.clear_for(pose, speed, time);
        let trial = |hold: f64| {
            let line = Segment::straight(pose, time, hold, speed);
            let mut chain = Chain::new(line.end(), time + hold, speed, own.turning_radius);
            chain.arc(back * own.turning_radius);
            let (pose, time) = (chain.pose, chain.time);
            let passed = self.passed(pose.position, pose.ahead() * speed, time)?;
            let on = |until: f64| {
                Segment::straight(pose, time, (until - time).max(self.family.least), speed)
            };
            if !self.is_clear(&[on(passed + spare)]) || !self.is_clear(&chain.segments) {
                return None;
            }
            let guard = self.heads_freely(pose, speed, (time, passed))?;
            if guard > passed && !self.is_clear(&[on(guard + spare)]) {
                return None;
            }
            let mut added: Vec<Segment> = Vec::with_capacity(3);
            added.extend((hold > 0.0).then_some(line));
            added.extend(chain.segments);
            added.push(on(guard));
            Some(added)
        };
        let holds = (least, most);
        let touching = self.touching(&held, holds);
        let trial = |hold: f64| trial(hold).into();
        let added = least_clear(holds, touching, (self.unit, close), trial)?;
        self.passed_after(out, Outward::Parallel { spare }, &added)
    }

    /// True where the last line stays clear for so many seconds longer.
    pub(super) fn goes_on(&self, passed: &Partial, seconds: f64) -> bool {
        let last = passed.motion.last();
        last.is_some_and(|last| {
            let longer = last.duration + seconds;
            self.is_clear(&[Segment {
                duration: longer,
                ..*last
            }])
        })
    }

    fn passed_after(&self, out: &Partial, outward: Outward, added: &[Segment]) -> Option<Partial> {
        let mut partial = out.clone();
        partial.phase = Phase::Passed;
        partial.outward = outward;
        partial.cost += self.problem().error_of(added) * self.price(out.first);
        partial.motion.extend_from_slice(added);
        let in_time = partial.motion.last()?.end_time() <= self.problem().horizon;
        in_time.then_some(partial)
    }

    /// A way back to the end of the route after the least further hold after which it is clear, where it
    /// costs less than `below`.
    pub(super) fn back(
        &self,
        passed: &Partial,
        way_back: WayBack,
        close: f64,
        below: f64,
    ) -> Option<Partial> {
        let FirstAlteration::Turn { turn, speed } = passed.first else {
            return None;
        };
        match way_back {
            WayBack::At(angle) => self.back_onto_route(passed, (turn, speed), angle, close, below),
            WayBack::ToEnd => self.to_end(passed, speed, close, below),
        }
    }

    fn back_onto_route(
        &self,
        passed: &Partial,
        (turn, speed): (f64, f64),
        angle: f64,
        close: f64,
        below: f64,
    ) -> Option<Partial> {
        let (problem, route) = (self.problem(), self.context.route);
        let (pose, time) = passed.end(problem.own.pose);
        let near = problem.desired.nearest(pose.position, time, 0.0).leg;
        let course = &problem.desired.legs()[near];
        let off = cross(course.direction, pose.position - course.start);
        let side = if off >= 0.0 {
            Side::Port
        } else {
            Side::Starboard
        };
        let toward = heading_of(course.direction) - side.turn_sign() * angle;
        let held = HeldTurn {
            pose,
            time,
            held_speed: speed,
            turn: wrap(toward - pose.heading),
            speed: problem.own.max_speed(),
            radius: problem.own.turning_radius,
        };
        let most = self.clear_for(pose, speed, time);
        let leads_off = self.leads_off(passed);
        let trial = |hold: f64| {
            let line = Segment::straight(pose, time, hold, speed);
            let (pose, time) = (line.end(), line.end_time());
            let near = problem.desired.nearest(pose.position, time, 0.0).leg;
            let mut legs = near..problem.desired.legs().len().min(near + 2);
            let returned =
                legs.find_map(|leg| motion_back(problem, route, (&pose, time), leg, angle));
            let Some(back) = returned else {
                return Held::Blocked;
            };
            // on to the same side it would be a circle
            let circles = || back[0].is_arc() && back[0].turn_rate * turn > 0.0;
            let Some(joined) = self.joining_time(&back).filter(|_| !circles()) else {
                return Held::Blocked;
            };
            let back = (&back[..], WayBack::At(angle));
            match self.ended(passed, (time, joined), hold, back) {
                Some(end) if end.cost < below => Held::from(self.judged(end)),
                // a longer hold may be cheaper, where it leads toward the route or leaves a longer change
                // of speed
                Some(end) if leads_off && self.plain_cost(&end) >= below => Held::TooDear,
                _ => Held::Blocked,
            }
        };
        let holds = (0.0, most);
        let touching = self.touching(&held, holds);
        least_clear(holds, touching, (self.unit, close), trial)
    }

    /// True where the route is too short for a return at an angle, in radians, from the end of a partial
    /// manoeuvre.
    pub(super) fn ends_soon(&self, passed: &Partial, angle: f64) -> bool {
        let (own, desired) = (self.problem().own, self.problem().desired);
        let (pose, time) = passed.end(own.pose);
        let nearest = desired.nearest(pose.position, time, 0.0);
        let leg = &desired.legs()[nearest.leg];
        let off = cross(leg.direction, pose.position - leg.start).abs();
        desired.length() - nearest.distance <= off / angle.tan() + 4.0 * own.turning_radius
    }

    /// The least further hold after which one turn and a line lead to the last waypoint, which is where
    /// own ship joins the route.
    fn to_end(&self, passed: &Partial, speed: f64, close: f64, below: f64) -> Option<Partial> {
        let (own, end) = (self.problem().own, self.problem().desired.end());
        let (pose, time) = passed.end(own.pose);
        let holds = (0.0, self.clear_for(pose, speed, time));
        let ordered = self
            .context
            .route
            .ordered_speed(self.context.route.length());
        let mut speeds = vec![own.max_speed(), ordered];
        speeds.dedup();
        let trial = |hold: f64| {
            let line = Segment::straight(pose, time, hold, speed);
            let (pose, time) = (line.end(), line.end_time());
            let radius = own.turning_radius;
            let to_end = |(side, speed): (Side, f64)| {
                let turning = Interceptor::new(&pose, time, speed, radius, side);
                let (turn, line) = turning.path_to(end)?;
                let mut chain = Chain::new(pose, time, speed, radius);
                chain.arc(side.turn_sign() * turn * radius);
                chain.line(line);
                Some(chain)
            };
            let ends = speeds.iter().filter_map(|speed| {
                let ways = Side::BOTH.into_iter().map(|side| (side, *speed));
                let chain = ways
                    .filter_map(to_end)
                    .min_by(|a, b| a.time.total_cmp(&b.time))?;
                let back = (&chain.segments[..], WayBack::ToEnd);
                let end = self.ended(passed, (time, chain.time), hold, back)?;
                (end.cost < below).then(|| self.judged(end))?
            });
            // a longer hold may be cheaper, as it may end without a circle
            Held::from(ends.min_by(|a, b| a.cost.total_cmp(&b.cost)))
        };
        // a hold that is clear by a circle leads to a shorter one without
        let found = least_clear(holds, Vec::new(), (self.unit, close), trial)?;
        let last = found.motion.iter().rfind(|s| s.is_arc());
        let turn = last.map_or(0.0, |arc| arc.turn_rate.abs() * arc.duration);
        (turn < self.settings().largest_last).then_some(found)
    }

    /// The last line of a partial manoeuvre prolonged, and a return to the end of the route, where that
    /// is tidy and clear.
    fn ended(
        &self,
        passed: &Partial,
        (returns, joined): (f64, f64),
        hold: f64,
        (back, way_back): (&[Segment], WayBack),
    ) -> Option<Partial> {
        let problem = self.problem();
        // the route has segments of its own, as short as its corners are
        let tidy = |s: &Segment| s.start_time >= joined || s.duration >= self.family.least;
        let in_time = back.last()?.end_time() <= problem.horizon;
        let joins = back.partition_point(|s| s.start_time < joined);
        let clear = in_time
            && back.iter().all(tidy)
            && self.is_clear(&back[..joins])
            && self.is_clear_to_the_end(&back[joins..]);
        if !clear {
            return None;
        }
        let mut partial = passed.clone();
        partial.motion.last_mut()?.duration += hold;
        partial.motion.extend_from_slice(back);
        partial.phase = Phase::End;
        (partial.returns, partial.joined, partial.way_back) = (returns, joined, way_back);
        partial.cost = self.cost(&partial);
        Some(partial)
    }

    /// An end that does not head to a forbidden side too soon: on the way back the hulls may be closest
    /// later than on the line, and the judge forbids to head to that side until then.
    fn judged(&self, mut end: Partial) -> Option<Partial> {
        end.is_judged = self.passing.iter().any(Passing::forbids_a_heading);
        let is_lawful = !end.is_judged || self.is_by_the_judges(&end);
        is_lawful.then_some(end)
    }

    /// Less speed along the route for the least time after which the route is clear at the greatest
    /// speed, to its end.
    pub(super) fn slowed(&self, out: &Partial, close: f64) -> Option<Partial> {
        let (problem, route) = (self.problem(), self.context.route);
        let (leave, speed, begun) = (out.leave, out.first.speed(), problem.under_way);
        let along = self.along_at(leave);
        let (on, _) = route.pose_at(along);
        let passed = match (
            self.passed(on.position, on.ahead() * speed, leave),
            self.follows,
        ) {
            (Some(passed), false) => passed,
            // at this speed own ship passes not all of them before the horizon
            (None, true) => leave,
            (Some(_), true) | (None, false) => return None,
        };
        let least = self.family.least_slow + begun.map_or(0.0, |begun| begun.begins);
        let hold = (passed - leave).max(least).max(self.family.least);
        let held = HeldTurn {
            pose: on,
            time: leave,
            held_speed: speed,
            turn: 0.0,
            speed: problem.own.max_speed(),
            radius: problem.own.turning_radius,
        };
        let trial = |hold: f64| {
            let mut motion = out.motion.clone();
            let end = match speed > 0.0 {
                true => route.run(along, leave, hold * speed, speed, &mut motion),
                false => {
                    motion.push(Segment::straight(on, leave, hold, speed));
                    along
                }
            };
            // at the end of the route the reduction may be too short to be apparent
            if end - along < speed * least - tolerance::LENGTH_M {
                return None;
            }
            let joined = motion.last().map(Segment::end_time)?;
            let slow = motion.len();
            motion.extend(route.follow(end, joined));
            let in_time = motion
                .last()
                .is_some_and(|s| s.end_time() <= problem.horizon);
            let tidy = motion[out.before..slow]
                .iter()
                .all(|s| s.duration >= self.family.least);
            let clear = in_time
                && (tidy || begun.is_some())
                && self.is_clear(&motion[out.before..slow])
                && self.is_clear_to_the_end(&motion[slow..]);
            if !clear {
                return None;
            }
            let mut partial = Partial {
                phase: Phase::End,
                motion,
                returns: joined,
                joined,
                ..out.clone()
            };
            partial.cost = self.cost(&partial);
            Some(partial)
        };
        let holds = (hold, problem.horizon - leave);
        let touching = self.touching(&held, holds);
        let trial = |hold: f64| trial(hold).into();
        least_clear(holds, touching, (self.unit, close), trial)
    }

    fn cost(&self, whole: &Partial) -> f64 {
        let (motion, joined) = (&whole.motion, whole.joined);
        let on_route = motion.partition_point(|s| s.start_time < joined - tolerance::TIME_S);
        let is_short = match &motion[on_route..] {
            [now, next, ..] => now.duration < self.family.least && now.speed != next.speed,
            _ => false,
        };
        let short_price = if is_short {
            self.settings().short_price
        } else {
            1.0
        };
        self.plain_cost(whole) * short_price
    }

    /// The cost without the price of a short change of speed.
    fn plain_cost(&self, whole: &Partial) -> f64 {
        self.problem().error_to_end(&whole.motion) * self.price(whole.first)
    }

    /// Pose at which the route is left.
    pub(super) fn departs_from(&self, partial: &Partial) -> Pose {
        match partial.before {
            0 => self.problem().own.pose,
            before => partial.motion[before - 1].end(),
        }
    }

    /// True where a turn leads off the one leg of the mission along which own ship departs: then each
    /// longer hold, and each wider course, is farther from it and later.
    pub(super) fn leads_off(&self, partial: &Partial) -> bool {
        let problem = self.problem();
        let ([leg], FirstAlteration::Turn { turn, .. }, None) =
            (problem.desired.legs(), partial.first, problem.under_way)
        else {
            return false;
        };
        let from = self.departs_from(partial);
        let along = cross(leg.direction, from.ahead()).abs() <= 1e-9
            && leg.direction.dot(&from.ahead()) > 0.0;
        along && cross(leg.direction, from.position - leg.start) * turn >= 0.0
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

    /// First time at which every target is past and clear on a straight course, and after which own
    /// ship may head to any side of its first course.
    fn guard(&self, pose: Pose, speed: f64, time: f64) -> Option<f64> {
        let passed = self.passed(pose.position, pose.ahead() * speed, time)?;
        self.heads_freely(pose, speed, (time, passed))
    }

    /// First time from `passed` on after which own ship may head to any side of its first course.
    fn heads_freely(&self, pose: Pose, speed: f64, (time, passed): (f64, f64)) -> Option<f64> {
        let problem = self.problem();
        let after = self.passing.iter().filter(|p| p.forbids_a_heading());
        let after = after.map(|p| after_nearest(problem, p.encountered, pose, speed, time));
        let after = after.fold(passed, f64::max);
        (after <= self.problem().horizon).then_some(after)
    }

    /// First time at which every target is past and clear on a straight course: on its first
    /// course own ship would have it behind, the range opens, and it is more than a length away, where its set
    /// does not ask for more.
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
            let clear = |body: &PolytopeObstacle| body.slack(there, passed).value > 0.0;
            if self.kept_off().all(clear) {
                return Some(passed);
            }
            passed += STEP_S;
        }
        None
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

    /// True for a whole manoeuvre that is by the rules.
    pub(super) fn is_lawful(&self, whole: &Partial) -> bool {
        whole.is_judged || self.is_by_the_judges(whole)
    }

    fn is_by_the_judges(&self, whole: &Partial) -> bool {
        let off_route = match whole.first {
            FirstAlteration::Turn { .. } => whole.off_route(),
            FirstAlteration::Slow { .. } => &[],
        };
        complies(self.problem(), self.to_judge(&whole.motion), off_route)
    }

    /// The part of a motion that the rules judge: all but an approach to the route and manoeuvres
    /// before it.
    pub(super) fn to_judge<'m>(&self, motion: &'m [Segment]) -> &'m [Segment] {
        &motion[motion.partition_point(|s| s.start_time < self.from)..]
    }

    /// What is within a length of the targets that are not passed nearer than that, but for those whose
    /// sets ask for more.
    pub(super) fn kept_off(&self) -> impl Iterator<Item = &PolytopeObstacle> {
        let kept = self.passing.iter().filter(|p| (self.keeps_a_length)(p));
        kept.filter_map(Passing::within_a_length)
    }

    /// Distance along the route at a time at which the nominal motion follows it, metres.
    pub(super) fn along_at(&self, time: f64) -> f64 {
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
