//! Manoeuvres as a navigator would order them (Rules 8 and 13 to 17): one bold alteration in ample
//! time, kept until every other ship is past and clear, then back to the route.
//!
//! ```text
//! hold ─► turn ─► straight [─► parallel] ─► passed ─► turn back ─► join the route
//! hold ─► half speed or less ───────────► passed ─► follow the route
//! ```
//!
//! Where neither is clear, the turn is made at half speed or less.
//!
//! A manoeuvre has at most five parameters. Six departures are tried, the latest first. The cheapest
//! manoeuvre of a coarse grid is improved by a pattern search where it beats the best so far. There
//! are few turns and few changes of speed by construction. A manoeuvre under way keeps the parameters
//! that are done; the search chooses the others.

use crate::colregs::{
    APPARENT_SPEED, APPARENT_TIME, APPARENT_TURN, Encountered, MayAct, ON_COURSE, Role, SMALL_TURN,
};
use crate::frame::{Pose, Side, Vector, heading_of, wrap};
use crate::geometry::outer_disc;
use crate::obstacle::{Obstacle, PolytopeObstacle, SpaceTimeObstacle, contact};
use crate::planner::clock::Clock;
use crate::planner::space_time::chain::Chain;
use crate::planner::space_time::graph::return_to_line::motion_back;
use crate::planner::space_time::land;
use crate::planner::space_time::motion::until;
use crate::planner::space_time::proxy::first_met;
use crate::planner::space_time::refinement::trial::Context;
use crate::planner::space_time::rules::compliance::{complies, keeps_off_bows};
use crate::planner::space_time::selection::initial_guess::ManoeuvreSpeeds;
use crate::planner::{Escape, PlannedManoeuvre, Problem, UnderWay};
use crate::tolerance::{self, TOUCH_M};
use crate::trajectory::Segment;

/// Turns, as multiples of the least readily apparent turn.
const TURNS: [f64; 8] = [1.0, 1.35, 1.7, 2.2, 2.7, 3.5, 4.5, 6.0];

/// Seconds on the new course before a parallel course is steered; infinite for no parallel course.
const ASIDE_S: [f64; 6] = [f64::INFINITY, 15.0, 35.0, 60.0, 100.0, 180.0];

/// Seconds from passing to the return.
const AFTER_S: [f64; 5] = [0.0, 15.0, 40.0, 90.0, 180.0];

/// The search for the latest escape tries every second ending.
const ENDING_STRIDE: usize = 2;

/// Angles between the return line and the route, radians.
const BACK: [f64; 3] = [0.3, 0.6, 1.0];

/// Departures, as fractions of the time until the latest one.
const LEAVE: [f64; 6] = [1.0, 0.8, 0.6, 0.4, 0.2, 0.0];

/// Seconds within which the first alteration follows a risk that begins late. A ship that overtakes
/// alters sooner: once it has turned, the closest approach comes early.
const REACT_S: f64 = 20.0;
const OVERTAKING_REACT_S: f64 = 10.0;

/// Seconds in which a harbour vessel sails its turning radius.
const NORMAL_TURN_S: f64 = 20.0;

/// Seconds of the least segment.
const LEAST_S: f64 = 3.0;

/// Ratio of the costs above which less speed replaces a turn, Rule 8(c).
const SPEED_PRICE: f64 = 2.0;

/// Ratio of the costs above which own ship is on time again by a change of speed for less than
/// [`LEAST_S`].
const SHORT_PRICE: f64 = 2.0;

/// Rounds of the pattern search.
const ROUNDS: usize = 7;

/// Sampled instants of the escape of a stand-on ship, and bisection steps after that.
const SAMPLES: usize = 40;
const HALVINGS: usize = 5;

/// Seconds by which a stand-on ship acts before the latest certified escape.
const SPARE_S: f64 = 40.0;

/// Seconds: more than the step of the judges' samples, so that one of them sees an alteration that
/// is in time.
const SAMPLE_S: f64 = 1.5;

/// Ratio of the cost of a late escape to that of an earlier manoeuvre above which a stand-on ship
/// acts earlier, where it may.
const LATE_PRICE: f64 = 4.0;

/// Range in lengths within which a stand-on ship acts.
const ACT_LENGTHS: f64 = 6.0;

/// Parameters of a manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Parameters {
    /// Seconds at which the route is left.
    leave: f64,
    first: FirstAlteration,
    /// Seconds from passing to the return.
    after: f64,
    /// Angle between the return line and the route, radians.
    back: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum FirstAlteration {
    /// Turn in radians to port, seconds until the parallel course, and the speed in m/s.
    Turn { turn: f64, aside: f64, speed: f64 },
    /// The speed that is kept until passed, m/s.
    Slow { speed: f64 },
}

/// A clear manoeuvre.
#[derive(Debug, Clone)]
pub(super) struct Found {
    /// The manoeuvre that it goes on with.
    pub begun: Option<UnderWay>,
    manoeuvre: Parameters,
    pub motion: Vec<Segment>,
    /// Seconds at which own ship turns back or changes its speed back.
    returns: f64,
    /// Seconds at which own ship is on the route again.
    pub joined: f64,
    /// Cost by which manoeuvres are compared, m².
    rank: f64,
}

impl Found {
    /// The manoeuvre as a plan names it.
    pub(super) fn planned(&self) -> PlannedManoeuvre {
        let leave = self.manoeuvre.leave;
        let before = self.motion.iter().find(|s| s.end_time() > leave);
        let heading = before.map_or(0.0, |s| s.pose_at(leave).heading);
        let (begins, first_heading) = match self.begun {
            Some(begun) => (begun.begins, begun.first_heading),
            None => (leave, heading),
        };
        PlannedManoeuvre {
            begins,
            returns: self.returns,
            joins: self.joined,
            first_heading,
            turn: self.begun.map_or(self.escape().turn, |begun| begun.turn),
        }
    }

    pub(super) fn escape(&self) -> Escape {
        let (turn, speed) = match self.manoeuvre.first {
            FirstAlteration::Turn { turn, .. } => (turn, None),
            FirstAlteration::Slow { speed } => (0.0, Some(speed)),
        };
        let leave = self.manoeuvre.leave;
        let then = self.motion.iter().find(|s| s.end_time() > leave);
        Escape {
            held_until: leave,
            turn,
            speed: speed.or(then.map(|s| s.speed)).unwrap_or(0.0),
        }
    }
}

/// A target that own ship must not pass nearer than a length.
struct Passing<'a> {
    encountered: &'a Encountered,
    /// The nominal hull, grown by own half-diagonal and the longer ship's length.
    within_a_length: PolytopeObstacle,
    /// The nominal hull, grown by own hull on its first course.
    hulls: PolytopeObstacle,
}

const FROM_ALL: fn(&Passing) -> bool = |_| true;
const FROM_KEPT_CLEAR: fn(&Passing) -> bool = |p| p.encountered.role.duties().keeps_clear;
const FROM_NONE: fn(&Passing) -> bool = |_| false;

/// The manoeuvres of one problem.
pub(super) struct Manoeuvres<'s, 'a> {
    context: &'s Context<'a>,
    nominal_motion: &'s [Segment],
    /// Seconds from which on the nominal motion follows the route.
    from: f64,
    /// Per obstacle, true if the motion has to be clear of it to the end, and not only until own
    /// ship is on the route again.
    to_the_end: Vec<bool>,
    passing: Vec<Passing<'s>>,
    clock: Clock,
    /// True for a target that is not passed nearer than a length, Rule 8(d).
    keeps_a_length: fn(&Passing) -> bool,
    /// True where turns are made at half speed or less.
    slows_to_turn: bool,
    /// Factor of the durations: 1 for a harbour vessel that sails its turning radius in 20 s.
    unit: f64,
}

impl<'s, 'a> Manoeuvres<'s, 'a> {
    pub(super) fn new(
        context: &'s Context<'a>,
        (nominal_motion, from): (&'s [Segment], f64),
        all: bool,
        clock: Clock,
    ) -> Self {
        let has_target = |obstacle: &Obstacle| {
            context.problem.encountered.iter().any(|e| {
                let there = e.ship.pose.position + e.ship.velocity() * e.tcpa;
                obstacle.contains(there, e.tcpa)
            })
        };
        let obstacles = context.problem.obstacles.iter();
        let to_the_end = obstacles.map(|o| all || has_target(o)).collect();
        let own = &context.problem.own.hull;
        let radius = context.problem.own.turning_radius;
        let passing = context.problem.encountered.iter().map(|encountered| {
            let (hull, ship) = (&encountered.hull, &encountered.ship);
            let around = own.half_diagonal() + own.length.max(hull.length);
            let disc = outer_disc(around, ship.pose.heading);
            let initial = hull.polygon(&ship.pose).minkowski_sum(&disc);
            let velocity = crate::geometry::ConvexPolygon::point(ship.velocity());
            let course = Pose::new(Vector::zeros(), encountered.own.pose.heading);
            let both = hull
                .polygon(&ship.pose)
                .minkowski_sum(&own.polygon(&course).negated());
            Passing {
                encountered,
                within_a_length: PolytopeObstacle::new("", initial, velocity.clone()),
                hulls: PolytopeObstacle::new("", both, velocity),
            }
        });
        Self {
            context,
            nominal_motion,
            from,
            to_the_end,
            passing: passing.collect(),
            clock,
            keeps_a_length: FROM_ALL,
            slows_to_turn: false,
            unit: (radius / ManoeuvreSpeeds::of(context.problem).normal / NORMAL_TURN_S).max(1.0),
        }
    }

    fn problem(&self) -> &'s Problem<'s> {
        self.context.problem
    }

    /// The cheapest end of the manoeuvre that is under way.
    pub(super) fn going_on(&mut self) -> Option<Found> {
        self.with_a_length_if_possible(|search| {
            let found = search.cheapest(0.0)?;
            Some(search.improved(found, 0.0..=0.0))
        })
    }

    /// The cheapest manoeuvre of a ship that keeps clear, begun in ample time, where the nominal
    /// motion meets an obstacle after `contact` seconds.
    pub(super) fn giving_way(&mut self, contact: f64) -> Option<Found> {
        let latest = self.ample().min(contact);
        self.with_a_length_if_possible(|search| {
            let from = search.from;
            let latest = latest.max(from);
            let times = search.departures(from, latest).into_iter();
            times.fold(None, |best: Option<Found>, time| {
                let below = best.as_ref().map_or(f64::INFINITY, |best| best.rank);
                let found = search.cheaper(time, below);
                let improved = found.map(|found| search.improved(found, from..=latest));
                improved.or(best)
            })
        })
    }

    /// The manoeuvre of a ship that stands on: it holds its course until it is near, as long as
    /// there is an escape that is not far dearer than to act earlier.
    pub(super) fn standing_on(&mut self, contact: f64) -> Option<Found> {
        if self.hurries() {
            return None;
        }
        let may = self.may_act() + SAMPLE_S;
        let mut latest = self.latest_escape(contact);
        if latest.is_none_or(|latest| latest < may) {
            // to hold on for as long as it must is worth more than a length
            self.keeps_a_length = FROM_NONE;
            latest = self.latest_escape(contact);
        }
        let mut latest = latest?;
        if latest < may && may < contact && self.cheapest(may).is_some() {
            latest = may;
        }
        let near = self.comes_within(ACT_LENGTHS);
        let wanted = (latest - SPARE_S).min(near).max(may);
        // it cannot hold on for as long as it must: then not longer than is safe
        let wanted = if latest < may - SAMPLE_S {
            latest - SPARE_S
        } else {
            wanted
        };
        let latest = latest.max(self.from);
        let leave = self.tidy_time(wanted.clamp(self.from, latest));
        let late = self.with_a_length_if_possible(|search| {
            let found = search.cheapest(leave);
            let found = found.or_else(|| search.cheapest(search.tidy_time(latest)))?;
            let leave = found.manoeuvre.leave;
            Some(search.improved(found, leave..=leave))
        })?;
        self.much_cheaper(&late, may).or(Some(late))
    }

    /// An earlier manoeuvre that costs far less than a late one, begun when own ship may act or after:
    /// the latest of five. It keeps a length off the same targets as the late one.
    fn much_cheaper(&mut self, late: &Found, may: f64) -> Option<Found> {
        if !(late.manoeuvre.leave > may) {
            return None;
        }
        let mut times = self.departures(may.max(self.from), late.manoeuvre.leave);
        // `from` may be before it may act
        times.retain(|time| *time < late.manoeuvre.leave && *time >= may - SAMPLE_S);
        // what is sailed before both is no part of the price
        let before = self
            .problem()
            .error_of(&until(self.nominal_motion, self.from));
        let below = before + (late.rank - before) / LATE_PRICE;
        // for the late one alone nothing else was clear
        self.slows_to_turn = false;
        let found = times.iter().find_map(|time| self.cheaper(*time, below))?;
        let leave = found.manoeuvre.leave;
        Some(self.improved(found, leave..=leave))
    }

    /// Some times of departure until the latest one, the latest first.
    fn departures(&self, from: f64, latest: f64) -> Vec<f64> {
        let times = LEAVE.map(|share| self.tidy_time(from + share * (latest - from)));
        let mut times = times.to_vec();
        times.dedup();
        times
    }

    /// True where own ship starts on the path and can keep the desired speed, but the nominal motion
    /// does not keep it, because the horizon requires an earlier arrival. That is no hold.
    fn hurries(&self) -> bool {
        let (own, leg) = (self.problem().own, &self.problem().desired.legs()[0]);
        if self.from > 0.0 {
            return false;
        }
        let off = (own.pose.position - leg.start).norm();
        let turn = wrap(own.pose.heading - heading_of(leg.direction)).abs();
        let desired = |speed: f64| (speed - leg.speed).abs() <= tolerance::FIGURE * leg.speed;
        off <= tolerance::JOINT_M
            && turn <= tolerance::joint_rad(own.turning_radius)
            && own.speeds.iter().any(|speed| desired(*speed))
            && !self
                .nominal_motion
                .first()
                .is_some_and(|s| desired(s.speed))
    }

    fn with_a_length_if_possible(
        &mut self,
        find: impl Fn(&Self) -> Option<Found>,
    ) -> Option<Found> {
        let problem = self.problem();
        let may_slow = problem.duty().may_slow && problem.under_way.is_none();
        let mut tried = usize::MAX;
        for keeps_a_length in [FROM_ALL, FROM_KEPT_CLEAR, FROM_NONE] {
            let number = self.passing.iter().filter(|p| keeps_a_length(p)).count();
            if number == tried {
                continue;
            }
            tried = number;
            self.keeps_a_length = keeps_a_length;
            for slows_to_turn in [false, true] {
                if slows_to_turn && !may_slow {
                    break;
                }
                self.slows_to_turn = slows_to_turn;
                let found = find(self);
                if found.is_some() || self.clock.is_up() {
                    return found;
                }
            }
        }
        None
    }

    /// Latest time of the first alteration, seconds. It is in ample time for every target, and a
    /// turn can soon be seen after it.
    fn ample(&self) -> f64 {
        let (limits, own) = (self.problem().thresholds, self.problem().own);
        let ample = limits.ample_time(own.hull.length);
        let soon = limits.time_factor(own.hull.length) * limits.monitor.response();
        let turning = SMALL_TURN * own.turning_radius / ManoeuvreSpeeds::of(self.problem()).normal;
        let keeps_clear = |p: &&Passing| p.encountered.role.duties().keeps_clear;
        let latest = self.passing.iter().filter(keeps_clear).map(|p| {
            let e = p.encountered;
            let react = match e.role {
                Role::Overtaking => OVERTAKING_REACT_S,
                _ => REACT_S,
            };
            let seen = e.risk_since + (soon - turning - SAMPLE_S).max(react);
            (e.tcpa - ample).max(e.risk_since + react).min(seen)
        });
        latest.fold(f64::INFINITY, f64::min).max(0.0)
    }

    /// First time at which a stand-on ship may act on the nominal motion: Rule 17(a)(ii), or in
    /// extremis, when the hulls would soon meet.
    fn may_act(&self) -> f64 {
        let limits = self.problem().thresholds;
        let own_length = self.problem().own.hull.length;
        let times = self.passing.iter().map(|p| {
            let e = p.encountered;
            let length = self.length(e);
            let mut meets = (self.nominal_motion.iter())
                .filter_map(|s| contact::first_contact(&p.hulls, s, 0.0));
            let extremis = limits.monitor.manoeuvre * limits.time_factor(own_length);
            let in_extremis = meets.next().map_or(f64::INFINITY, |time| time - extremis);
            let stage_3 = match e.role.duties().may_act {
                MayAct::BeforeClosestApproach => {
                    e.tcpa - limits.score.overtaken_lengths * length / e.own.speed
                }
                MayAct::WithinRange => {
                    self.comes_within_of(e, limits.score.stage_3_lengths * length)
                }
            };
            stage_3.min(in_extremis)
        });
        // to act for one target excuses toward the others
        times.fold(f64::INFINITY, f64::min).max(0.0)
    }

    fn length(&self, e: &Encountered) -> f64 {
        e.hull.length.max(self.problem().own.hull.length)
    }

    /// Time at which the nominal motion comes within a number of lengths of a target; infinite if
    /// it never does.
    fn comes_within(&self, lengths: f64) -> f64 {
        let all = self.passing.iter().map(|p| p.encountered);
        all.map(|e| self.comes_within_of(e, lengths * self.length(e)))
            .fold(f64::INFINITY, f64::min)
    }

    fn comes_within_of(&self, e: &Encountered, range: f64) -> f64 {
        let near = |s: &Segment| {
            let relative = s.velocity_at(s.start_time) - e.ship.velocity();
            let apart = s.start.position - e.ship.pose.position - e.ship.velocity() * s.start_time;
            let (a, b) = (relative.norm_squared(), apart.dot(&relative));
            let c = apart.norm_squared() - range * range;
            if c <= 0.0 {
                return Some(s.start_time);
            }
            let time = (-b - (b * b - a * c).sqrt()) / a;
            (time >= 0.0 && time <= s.duration).then_some(s.start_time + time)
        };
        self.nominal_motion
            .iter()
            .find_map(near)
            .unwrap_or(f64::INFINITY)
    }

    /// The latest time from which an escape is found, by sampling and bisection.
    fn latest_escape(&self, contact: f64) -> Option<f64> {
        let step = (contact - self.from) / SAMPLES as f64;
        let exists = |time: f64| self.has_clear(self.tidy_time(time));
        let mut times = (0..=SAMPLES).rev().map(|k| self.from + step * k as f64);
        let mut latest = times.find(|t| self.clock.is_up() || exists(*t))?;
        let mut too_late = latest + step;
        for _ in 0..HALVINGS {
            let middle = 0.5 * (latest + too_late);
            if self.clock.is_up() {
                break;
            }
            if exists(middle) {
                latest = middle;
            } else {
                too_late = middle;
            }
        }
        (!self.clock.is_up()).then_some(latest)
    }

    fn alterations(&self) -> Vec<FirstAlteration> {
        let problem = self.problem();
        let (own, duty) = (problem.own, problem.duty());
        if let Some(begun) = problem.under_way {
            return self.ways_on(&begun);
        }
        let ordered = ManoeuvreSpeeds::of(problem);
        let may_speed_up = (problem.encountered.iter()).any(|e| e.role.duties().may_speed_up);
        let faster = (may_speed_up && ordered.fast > ordered.normal).then_some(ordered.fast);
        // half of the desired speed, also where the ship cannot keep just that
        let legs = problem.desired.legs().iter().map(|leg| leg.speed);
        let desired = legs.fold(0.0, f64::max).min(ordered.normal);
        let slow = APPARENT_SPEED * desired * (1.0 + 1e-9);
        let slow = own.moving_speeds().filter(|u| duty.may_slow && *u <= slow);
        let turns = TURNS.map(|turn| turn * APPARENT_TURN);
        let asides = ASIDE_S.map(|aside| aside * self.unit);
        let mut all: Vec<FirstAlteration> = Vec::new();
        let speeds: Vec<f64> = match self.slows_to_turn {
            // nothing else was clear
            true => slow.clone().collect(),
            false => std::iter::once(ordered.normal).chain(faster).collect(),
        };
        for speed in speeds {
            for side in duty.sides() {
                if duty.stands_on && *side == Side::Port {
                    continue;
                }
                for turn in turns.map(|turn| turn * side.turn_sign()) {
                    all.extend(asides.map(|aside| FirstAlteration::Turn { turn, aside, speed }));
                }
            }
        }
        if !self.slows_to_turn {
            all.extend(slow.map(|speed| FirstAlteration::Slow { speed }));
        }
        all
    }

    /// Choices that a manoeuvre under way still has. A turn is completed and kept. The parallel
    /// course may follow once.
    fn ways_on(&self, begun: &UnderWay) -> Vec<FirstAlteration> {
        let (turn, speed) = (begun.turn, begun.speed);
        let aside = f64::INFINITY;
        if begun.is_returning {
            return vec![FirstAlteration::Turn {
                turn: 0.0,
                aside,
                speed,
            }];
        }
        if turn == 0.0 {
            return vec![FirstAlteration::Slow { speed }];
        }
        let is_parallel = wrap(begun.heading - begun.first_heading).abs() <= ON_COURSE;
        let asides = if is_parallel { &ASIDE_S[..1] } else { &ASIDE_S };
        let asides = asides.iter().map(|aside| aside * self.unit);
        let last: &[f64] = if is_parallel {
            &[]
        } else {
            &[0.0, begun.aside]
        };
        let asides = asides.chain(last.iter().copied());
        let turns = asides.map(|aside| FirstAlteration::Turn { turn, aside, speed });
        turns.collect()
    }

    /// The motions from a departure until every target is passed, those that are clear so far, keep
    /// off the targets' bows, and are cheaper than a rank.
    fn clear_outward_legs(&self, leave: f64, below: f64) -> impl Iterator<Item = OutwardLeg> + '_ {
        let before = until(self.nominal_motion, leave);
        let alterations = self.alterations().into_iter();
        alterations.filter_map(move |first| {
            let out = self.out(&before, leave, first)?;
            // what follows can only add to the cost; without a limit this needs no sum
            let cheap = below.is_infinite()
                || self.problem().error_of(&out.motion) * speed_price(&first) < below;
            (cheap
                && self.is_clear(&out.motion[out.before..])
                && keeps_off_bows(self.problem(), self.to_judge(&out.motion)))
            .then_some(out)
        })
    }

    fn has_clear(&self, leave: f64) -> bool {
        self.clear_outward_legs(leave, f64::INFINITY).any(|out| {
            let few = self.endings(&out).into_iter().step_by(ENDING_STRIDE);
            few.into_iter().any(|ending| {
                self.completed(&out, ending)
                    .is_some_and(|(m, joined)| self.is_allowed(&out, &m, joined))
            })
        })
    }

    /// A time that leaves no short segment before it.
    fn tidy_time(&self, time: f64) -> f64 {
        if time < self.from + LEAST_S {
            self.from
        } else {
            time
        }
    }

    /// Distance along the route at a time at which the nominal motion follows it, metres.
    fn along_at(&self, time: f64) -> f64 {
        let left = self.nominal_motion.iter().map(|s| {
            let duration = (s.end_time() - s.start_time.max(time)).max(0.0);
            duration * s.speed
        });
        self.context.route.length() - left.sum::<f64>()
    }

    /// Seconds from passing to the return, and the angle of the return.
    fn endings(&self, out: &OutwardLeg) -> Vec<(f64, f64)> {
        let mut angles = match out.first {
            FirstAlteration::Turn { .. } => BACK.to_vec(),
            FirstAlteration::Slow { .. } => BACK[..1].to_vec(),
        };
        // a return goes on as it is
        let begun = self.problem().under_way.filter(|begun| begun.is_returning);
        angles.extend(begun.map(|begun| wrap(begun.heading - begun.first_heading).abs()));
        let after = AFTER_S.map(|after| after * self.unit).into_iter();
        let endings = after.flat_map(|after| angles.iter().map(move |back| (after, *back)));
        endings.collect()
    }

    /// The cheapest clear manoeuvre that begins at a time.
    fn cheapest(&self, leave: f64) -> Option<Found> {
        self.cheaper(leave, f64::INFINITY)
    }

    /// The cheapest clear manoeuvre that begins at a time, if it is cheaper than a rank.
    fn cheaper(&self, leave: f64, below: f64) -> Option<Found> {
        let mut candidates: Vec<(f64, usize, Parameters)> = Vec::new();
        let outs = self
            .clear_outward_legs(leave, below)
            .take_while(|_| !self.clock.is_up());
        let outs: Vec<OutwardLeg> = outs.collect();
        for (index, out) in outs.iter().enumerate() {
            let first = out.first;
            for (after, back) in self.endings(out) {
                let Some((motion, joined)) = self.completed(out, (after, back)) else {
                    continue;
                };
                let rank = self.rank(&first, &motion, joined);
                if rank < below {
                    let manoeuvre = Parameters {
                        leave,
                        first,
                        after,
                        back,
                    };
                    candidates.push((rank, index, manoeuvre));
                }
            }
        }
        candidates.sort_by(|a, b| a.0.total_cmp(&b.0));
        let candidates = candidates.into_iter().take_while(|_| !self.clock.is_up());
        candidates.into_iter().find_map(|(rank, out, manoeuvre)| {
            let out = &outs[out];
            let (motion, joined) = self.completed(out, (manoeuvre.after, manoeuvre.back))?;
            self.is_allowed(out, &motion, joined).then_some(Found {
                begun: self.problem().under_way,
                manoeuvre,
                returns: out.returns(manoeuvre.after),
                joined,
                rank,
                motion,
            })
        })
    }

    /// Cost by which manoeuvres are compared: a turn is preferred over less speed.
    fn rank(&self, first: &FirstAlteration, motion: &[Segment], joined: f64) -> f64 {
        let on_route = motion.partition_point(|s| s.start_time < joined - tolerance::TIME_S);
        // the route has segments of its own, as short as its corners are
        let short = motion[on_route..]
            .windows(2)
            .next()
            .is_some_and(|pair| pair[0].duration < LEAST_S && pair[0].speed != pair[1].speed);
        let short_price = if short { SHORT_PRICE } else { 1.0 };
        self.problem().error_to_end(motion) * speed_price(first) * short_price
    }

    /// Pattern search: each parameter in turn, by steps that shrink.
    fn improved(&self, mut best: Found, leave: std::ops::RangeInclusive<f64>) -> Found {
        let mut step = 1.0;
        for _ in 0..ROUNDS {
            let mut gained = false;
            for parameter in 0..5 {
                for sign in [1.0, -1.0] {
                    if self.clock.is_up() {
                        return best;
                    }
                    let tried = best.manoeuvre.stepped(parameter, sign * step, self.unit);
                    let Some(mut tried) = tried.filter(|t| *t != best.manoeuvre) else {
                        continue;
                    };
                    tried.leave = self.tidy_time(tried.leave.clamp(*leave.start(), *leave.end()));
                    if let Some(found) = self.found(&tried, best.rank) {
                        best = found;
                        gained = true;
                        break;
                    }
                }
            }
            if !gained {
                step *= 0.5;
            }
        }
        best
    }

    /// A manoeuvre, if it is clear and cheaper than a rank.
    fn found(&self, manoeuvre: &Parameters, below: f64) -> Option<Found> {
        let before = until(self.nominal_motion, manoeuvre.leave);
        let out = self.out(&before, manoeuvre.leave, manoeuvre.first)?;
        let (motion, joined) = self.completed(&out, (manoeuvre.after, manoeuvre.back))?;
        let rank = self.rank(&manoeuvre.first, &motion, joined);
        let found = Found {
            begun: self.problem().under_way,
            manoeuvre: *manoeuvre,
            returns: out.returns(manoeuvre.after),
            motion,
            joined,
            rank,
        };
        let cheaper = rank < below;
        let clear = || self.is_clear(&out.motion[out.before..]);
        (cheaper && clear() && self.is_allowed(&out, &found.motion, joined)).then_some(found)
    }

    /// The motion until every target is passed.
    fn out(&self, before: &[Segment], leave: f64, first: FirstAlteration) -> Option<OutwardLeg> {
        let problem = self.problem();
        let own = problem.own;
        let mut motion = before.to_vec();
        let pose = motion.last().map_or(own.pose, Segment::end);
        match first {
            FirstAlteration::Slow { speed } => {
                let route = self.context.route;
                let along = self.along_at(leave);
                let (on, _) = route.pose_at(along);
                let passed = self.passed(on.position, on.ahead() * speed, leave)?;
                let least = match problem.under_way {
                    Some(begun) => APPARENT_TIME + begun.begins,
                    None => APPARENT_TIME,
                };
                let slow = (passed - leave).max(least).max(LEAST_S);
                let end = route.run(along, leave, slow * speed, speed, &mut motion);
                // at the end of the route the reduction may be too short to be apparent
                if end - along < speed * least - tolerance::LENGTH_M {
                    return None;
                }
            }
            FirstAlteration::Turn { turn, aside, speed } => {
                let mut chain = Chain::new(pose, leave, speed, own.turning_radius);
                let (turn, back) = match problem.under_way {
                    Some(begun) => (
                        wrap(begun.heading - pose.heading),
                        wrap(begun.first_heading - begun.heading),
                    ),
                    None => (turn, -turn),
                };
                chain.arc(turn * own.turning_radius);
                let straight = |chain: &Chain| {
                    let velocity = chain.pose.ahead() * speed;
                    self.passed(chain.pose.position, velocity, chain.time)
                };
                if aside.is_finite() {
                    chain.line(speed * aside);
                    chain.arc(back * own.turning_radius);
                }
                let passed = straight(&chain)?;
                // a straight part between two turns, also where the target is passed at once
                chain.line(speed * (passed - chain.time).max(LEAST_S));
                // a turn along a corner of the route is no alteration
                let arc = chain.segments.first()?;
                if problem.under_way.is_none()
                    && self.is_on_route(arc.end(), self.along_at(leave) + arc.length())
                {
                    return None;
                }
                motion.extend(chain.segments);
            }
        }
        let in_time = motion.last()?.end_time() <= problem.horizon;
        let before = before.len();
        in_time.then_some(OutwardLeg {
            first,
            leave,
            before,
            motion,
        })
    }

    /// The motion to the end of the route for an ending, and the time from which on it follows the
    /// route.
    fn completed(
        &self,
        out: &OutwardLeg,
        (after, back): (f64, f64),
    ) -> Option<(Vec<Segment>, f64)> {
        let (problem, route) = (self.problem(), self.context.route);
        let mut motion = out.motion.clone();
        let joined;
        if let FirstAlteration::Slow { speed } = out.first {
            let slow: f64 = motion[out.before..].iter().map(Segment::length).sum();
            let along = self.along_at(out.leave);
            motion.truncate(out.before);
            let along = route.run(along, out.leave, slow + after * speed, speed, &mut motion);
            joined = motion.last()?.end_time();
            motion.extend(route.follow(along, joined));
        } else {
            let last = motion.last_mut()?;
            last.duration += after;
            let (pose, time) = (last.end(), last.end_time());
            let near = problem.desired.nearest(pose.position, time, 0.0);
            let legs = near.leg..problem.desired.legs().len().min(near.leg + 2);
            let mut backs =
                legs.filter_map(|leg| motion_back(problem, route, (&pose, time), leg, back));
            let back = backs.next()?;
            // on to the same side it would be a circle
            let again = |turn: f64| back[0].is_arc() && back[0].turn_rate * turn > 0.0;
            if matches!(out.first, FirstAlteration::Turn { turn, .. } if again(turn)) {
                return None;
            }
            joined = self.joins(&back)?;
            motion.extend(back);
        }
        // the route has segments of its own, as short as its corners are
        let manoeuvre = motion[out.before..].iter();
        let mut manoeuvre = manoeuvre.take_while(|s| s.start_time < joined);
        if problem.under_way.is_some() {
            // what is left of a turn
            manoeuvre.next();
        }
        let tidy = manoeuvre.all(|s| s.duration >= LEAST_S);
        let in_time = motion.last()?.end_time() <= problem.horizon;
        (tidy && in_time).then_some((motion, joined))
    }

    /// Time from which on a return follows the route: after an arc, a line and an arc at most.
    fn joins(&self, back: &[Segment]) -> Option<f64> {
        let route = self.context.route;
        let mut left: f64 = back.iter().map(Segment::length).sum();
        back.iter().take(3).find_map(|s| {
            left -= s.length();
            self.is_on_route(s.end(), route.length() - left)
                .then_some(s.end_time())
        })
    }

    /// First time at which every target is past and clear on a straight course: on its first
    /// course own ship would have it behind, the range opens, and it is more than a length away.
    fn passed(&self, position: Vector, velocity: Vector, time: f64) -> Option<f64> {
        const STEP_S: f64 = 5.0;
        let horizon = self.problem().horizon;
        let mut passed = time;
        for p in &self.passing {
            let e = p.encountered;
            let target = e.ship.velocity();
            let apart = e.ship.pose.position + target * time - position;
            // each falls at a constant rate on a straight course
            let ahead_of = |course: Vector| {
                let relative = course - target;
                let left = apart.dot(&relative);
                let rate = (velocity - target).dot(&relative);
                if left <= 0.0 {
                    Some(time)
                } else {
                    (rate > 0.0).then_some(time + left / rate)
                }
            };
            passed = passed
                .max(ahead_of(e.own.velocity())?)
                .max(ahead_of(velocity)?);
        }
        while passed <= horizon {
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
    fn is_clear(&self, segments: &[Segment]) -> bool {
        first_met(self.context.proxies, segments).is_none()
            && !land::meets(self.problem().land_obstacle, segments)
            && !segments.iter().any(|s| self.is_within_a_length(s))
    }

    /// True for a motion that goes on from a clear one, is clear to its end, and by the rules.
    fn is_allowed(&self, out: &OutwardLeg, motion: &[Segment], joined: f64) -> bool {
        let off_route = match out.first {
            FirstAlteration::Turn { .. } => &motion[out.before..],
            FirstAlteration::Slow { .. } => &[],
        };
        // the last segment may have become longer
        let rest = &motion[out.motion.len() - 1..];
        let (back, on_route) = rest.split_at(rest.partition_point(|s| s.start_time < joined));
        self.is_clear(back)
            && self.is_clear_to_the_end(on_route)
            && complies(self.problem(), self.to_judge(motion), off_route)
    }

    /// The part of a motion that the rules judge: all but an approach to the route and manoeuvres
    /// before it.
    fn to_judge<'m>(&self, motion: &'m [Segment]) -> &'m [Segment] {
        &motion[motion.partition_point(|s| s.start_time < self.from)..]
    }

    /// The targets that are not passed nearer than a length.
    fn kept_off(&self) -> impl Iterator<Item = &Passing<'s>> {
        self.passing.iter().filter(|p| (self.keeps_a_length)(p))
    }

    fn is_within_a_length(&self, segment: &Segment) -> bool {
        self.kept_off()
            .any(|p| contact::first_contact(&p.within_a_length, segment, TOUCH_M).is_some())
    }

    fn is_clear_to_the_end(&self, segments: &[Segment]) -> bool {
        let mut proxies = self.context.proxies.iter();
        let all = self.to_the_end.iter().all(|whole| *whole);
        let land = self.problem().land_obstacle;
        proxies.all(|proxy| {
            !self.to_the_end[proxy.obstacle]
                || segments.iter().all(|s| proxy.first_contact(s).is_none())
        }) && !(all && land::meets(land, segments))
            && !segments.iter().any(|s| self.is_within_a_length(s))
    }

    /// True for a pose of the route after this many metres.
    fn is_on_route(&self, pose: Pose, along: f64) -> bool {
        let (on, _) = self.context.route.pose_at(along);
        (pose.position - on.position).norm() <= tolerance::JOINT_M
            && wrap(pose.heading - on.heading).abs() <= tolerance::JOINT_RAD
    }
}

/// Factor of the cost of a manoeuvre by less speed.
fn speed_price(first: &FirstAlteration) -> f64 {
    match first {
        FirstAlteration::Slow { .. } => SPEED_PRICE,
        FirstAlteration::Turn { .. } => 1.0,
    }
}

/// The motion until every target is passed.
struct OutwardLeg {
    first: FirstAlteration,
    /// Seconds at which the route is left, and the number of segments before.
    leave: f64,
    before: usize,
    motion: Vec<Segment>,
}

impl OutwardLeg {
    /// Time of the return, for seconds after passing.
    fn returns(&self, after: f64) -> f64 {
        self.motion.last().map_or(self.leave, Segment::end_time) + after
    }
}

impl Parameters {
    /// One parameter changed by a step; `None` where it has none.
    fn stepped(&self, parameter: usize, step: f64, unit: f64) -> Option<Self> {
        let mut next = *self;
        match (parameter, &mut next.first) {
            (0, FirstAlteration::Turn { turn, .. }) => {
                let more = (turn.abs() + 0.15 * step).max(APPARENT_TURN);
                *turn = more * turn.signum();
            }
            (1, FirstAlteration::Turn { aside, .. }) if aside.is_finite() => {
                *aside = (*aside + 20.0 * unit * step).max(LEAST_S);
            }
            (2, _) => next.after = (next.after + 20.0 * unit * step).max(0.0),
            (3, FirstAlteration::Turn { .. }) => {
                next.back = (next.back + 0.15 * step).clamp(0.1, 1.4);
            }
            (4, _) => next.leave += 20.0 * unit * step,
            _ => return None,
        }
        Some(next)
    }
}

#[cfg(test)]
mod tests {
    use crate::pipeline;
    use crate::scenario::Scenario;

    /// Less speed that is kept for some time after passing may reach a corner of the route.
    #[test]
    fn less_speed_is_kept_on_the_route_only() {
        let text = r#"
            title = "Less speed before a corner"
            horizon_s = 359.1
            [own_ship]
            position = { east_m = 0.0, north_m = 0.0 }
            course_deg = 90.0
            speed_mps = 5.0
            length_m = 30.0
            beam_m = 8.0
            turning_radius_m = 100.0
            speeds_mps = [2.5, 5.0, 6.0]
            safety_margin_m = 20.0
            [mission]
            waypoints = [
                { east_m = 0.0, north_m = 0.0 }, { east_m = 405.01, north_m = 0.0 },
                { east_m = 706.65, north_m = -45.04 }, { east_m = 944.59, north_m = 116.11 },
            ]
            speed_mps = 5.0
            [planner]
            compliance = "rules"
            [[targets]]
            name = "t0"
            position = { east_m = 633.181, north_m = 373.244 }
            course_deg = 165.24
            speed_mps = 2.878
            length_m = 30.0
            beam_m = 8.0
        "#;
        let run = pipeline::run(Scenario::parse(text).expect("valid"));
        assert!(run.planned.outcome.plan().is_some(), "{:?}", run.planned);
    }
}
