//! Which manoeuvre: the cheapest lawful path of the graph of manoeuvres, then a pattern search over the
//! four numbers that no contact decides.
//!
//! ```text
//! departures and courses ─► A* ─► departure, turn, way back and room, each hold by hugging
//! ```
//!
//! A ship that keeps clear departs in ample time; one that stands on holds until its escape is due.
//! Each search keeps one ship length from every target first, then only from those own ship gives way to,
//! then from none, where that is the only way or costs a tenth; turns at half speed or less come last.

use std::cmp::Ordering;
use std::ops::RangeInclusive;

use crate::search::{Search, Stop};
use crate::space_time::context::Context;
use crate::space_time::manoeuvre::interceptor::{Interceptor, Limits};
use crate::space_time::manoeuvre::motion::{pose_at, until};
use crate::space_time::manoeuvre::speeds::{ManoeuvreSpeeds, due_leg};
use crate::space_time::rules::automaton::{Effort, Graph, outward, ways_back, wider};
use crate::space_time::rules::bodies::Passing;
use crate::space_time::rules::compliance::broken_rules;
use crate::space_time::rules::departure::SAMPLE_S;
use crate::space_time::rules::hug::{COARSE_S, FINE_S, HeldTurn};
use crate::space_time::rules::manoeuvre::{
    Family, FirstAlteration, Manoeuvre, Manoeuvres, Outward, Partial, WayBack,
};
use crate::{FAR_OFF_LENGTHS, MANY_TIMES, Problem, Tidiness, UnderWay};
use searoom_colregs::APPARENT_TURN;
use searoom_geometry::frame::{Side, wrap};
use searoom_model::trajectory::Segment;

/// Radians by which a turn to a tangent is clear of it.
const CLEAR_OF_TANGENT: f64 = 1e-6;

/// Factor of the least turn: its duration must not be too short by rounding.
const SPARE: f64 = 1.001;

/// Tangents nearer to each other than this are one, radians.
const SAME_TANGENT: f64 = 0.03;

/// Bisection steps for the last escape of a stand-on ship, after the samples.
const HALVINGS: usize = 5;

/// The numbers of a manoeuvre that no contact decides.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Numbers {
    leave: f64,
    first: FirstAlteration,
    outward: Outward,
    way_back: WayBack,
}

impl Numbers {
    fn of(partial: &Partial) -> Self {
        Self {
            leave: partial.leave,
            first: partial.first,
            outward: partial.outward,
            way_back: partial.way_back,
        }
    }
}

const FROM_NONE: fn(&Passing) -> bool = |_| false;

/// The cheapest manoeuvre toward obstacles without roles whose segments are not short ([`Family`]). It departs
/// before the nominal motion meets one after `contact` seconds. About a millisecond among a few sets.
pub(crate) fn without_roles(
    context: &Context,
    nominal_motion: &[Segment],
    contact: f64,
    tidy: &Tidiness,
    effort: Effort,
) -> Option<Vec<Segment>> {
    let problem = Problem {
        encountered: &[],
        under_way: None,
        ..*context.problem
    };
    let context = Context {
        problem: &problem,
        ..*context
    };
    let (motion, family) = (
        (nominal_motion, 0.0),
        Family::without_roles(tidy, &problem.settings.rules),
    );
    let manoeuvres = Manoeuvres::new(&context, motion, true, family, effort);
    let found = manoeuvres.best(0.0..=contact.max(0.0), f64::INFINITY);
    found.map(|found| found.whole.motion)
}

impl Manoeuvres<'_, '_> {
    /// The cheapest end of the manoeuvre that is under way.
    pub(super) fn going_on(&mut self, begun: &UnderWay) -> Option<Manoeuvre> {
        let slows = begun.turn == 0.0 && !begun.is_returning || begun.speed == 0.0;
        let first = match slows {
            true => FirstAlteration::Slow { speed: begun.speed },
            false => FirstAlteration::Turn {
                // a return may turn to either side
                turn: if begun.is_returning { 0.0 } else { begun.turn },
                speed: begun.speed,
            },
        };
        let find = |search: &Self, below| search.best_of(vec![(0.0, first)], 0.0..=0.0, below);
        let passing = self.relaxed(find);
        match slows {
            true => self.or_following(passing, find),
            false => passing,
        }
    }

    /// The cheapest manoeuvre of a ship that keeps clear, begun in ample time, where the nominal
    /// motion meets an obstacle after `contact` seconds.
    pub(super) fn giving_way(&mut self, contact: f64) -> Option<Manoeuvre> {
        let from = self.from;
        let latest = self.ample_time().min(contact).max(from);
        let find = |search: &Self, below| search.best(from..=latest, below);
        let passing = self.relaxed(find);
        // on a long route own ship passes
        let (route, radius) = (self.context.route, self.problem().own.turning_radius);
        let left = route.length() - self.along_at(contact);
        match left <= self.settings().follow_radii * radius {
            true => self.or_following(passing, find),
            false => passing,
        }
    }

    /// The manoeuvre of a ship that stands on: it holds its course until it is near, as long as
    /// there is an escape.
    pub(super) fn standing_on(&mut self, contact: f64) -> Option<Manoeuvre> {
        if self.hurries() {
            return None;
        }
        let may = self.may_act() + SAMPLE_S;
        let settings = self.settings();
        // standing on (Rule 17) takes priority over the one-length clearance, and over a moderate turn
        let keeps_a_length = self.keeps_a_length;
        let ways = [
            (settings.largest_escape, keeps_a_length),
            (settings.largest_escape, FROM_NONE),
            (settings.largest_turn, keeps_a_length),
            (settings.largest_turn, FROM_NONE),
        ];
        let (mut latest, mut tried): (Option<f64>, Option<f64>) = (None, None);
        for (most_turn, keeps_a_length) in ways {
            let kept = self.kept_off().count();
            self.keeps_a_length = keeps_a_length;
            // without a length to give up the escapes are the same
            if tried == Some(most_turn) && self.kept_off().count() == kept {
                continue;
            }
            tried = Some(most_turn);
            let found = self.latest_escape(contact, may, most_turn);
            if found > latest {
                latest = found;
            }
            if latest.is_some_and(|latest| latest >= may) || self.effort.clock.is_up() {
                break;
            }
        }
        let mut latest = latest?;
        self.most_turn = settings.largest_turn;
        if latest < may && may < contact && self.best(may..=may, f64::INFINITY).is_some() {
            latest = may;
        }
        let mut wanted = latest - settings.spare_s;
        // where it cannot hold on for as long as it must, not longer than is safe
        if !(latest < may - SAMPLE_S) {
            wanted = wanted.min(self.comes_within(settings.act_lengths)).max(may);
        }
        let latest = latest.max(self.from);
        let leave = self.tidy_time(wanted.clamp(self.from, latest));
        self.relaxed(|search, below| {
            let found = search.best(leave..=leave, below);
            let latest = search.tidy_time(latest);
            found.or_else(|| search.best(latest..=latest, below))
        })
    }

    /// The manoeuvre with a length off all targets; where there is none, off those that own ship keeps clear
    /// of, or off none. One that keeps it off fewer is also taken where it costs a tenth
    /// ([`Self::is_worth_a_length`]). Each is made with turns at the ordered speed, or else at half or less;
    /// where there is none, also with stops. `find` looks for manoeuvres of a level that cost less than so many m².
    fn relaxed(&mut self, find: impl Fn(&Self, f64) -> Option<Manoeuvre>) -> Option<Manoeuvre> {
        let may_stop = self.problem().own.speeds.contains(&0.0);
        let stops: &[bool] = if may_stop { &[false, true] } else { &[false] };
        stops.iter().find_map(|stops| {
            self.stops = *stops;
            self.of_the_levels(&find)
        })
    }

    /// A manoeuvre, or a cheaper one in which own ship follows a target on its route at less speed and does not
    /// pass it.
    fn or_following(
        &mut self,
        passing: Option<Manoeuvre>,
        find: impl Fn(&Self, f64) -> Option<Manoeuvre>,
    ) -> Option<Manoeuvre> {
        let below = passing
            .as_ref()
            .map_or(f64::INFINITY, |best| best.whole.cost);
        self.keeps_a_length = |_| true;
        (self.slows_to_turn, self.follows) = (false, true);
        let following = find(self, below);
        self.follows = false;
        let broken = |of: &Manoeuvre| broken_rules(self.problem(), &of.whole.motion);
        match (following, passing) {
            (Some(following), Some(passing)) if broken(&following) > broken(&passing) => {
                Some(passing)
            }
            (following, passing) => following.or(passing),
        }
    }

    fn of_the_levels(
        &mut self,
        find: &impl Fn(&Self, f64) -> Option<Manoeuvre>,
    ) -> Option<Manoeuvre> {
        let problem = self.problem();
        let may_slow = problem.duty().may_slow && problem.under_way.is_none();
        let sailed = problem.error_of(&until(self.nominal_motion, self.from));
        let mut best: Option<Manoeuvre> = None;
        let mut tried = usize::MAX;
        let levels: [fn(&Passing) -> bool; 3] = [|_| true, |p| p.keeps_clear(), FROM_NONE];
        for keeps_a_length in levels {
            self.keeps_a_length = keeps_a_length;
            let number = self.kept_off().count();
            if number == tried {
                continue;
            }
            tried = number;
            let below = best.as_ref().map_or(f64::INFINITY, |best| {
                // what was sailed before is no part of the price
                let since = best.whole.cost - sailed * best.price;
                sailed + since / MANY_TIMES
            });
            let slows: &[bool] = match may_slow && best.is_none() {
                true => &[false, true],
                false => &[false],
            };
            let found = slows.iter().find_map(|slows_to_turn| {
                self.slows_to_turn = *slows_to_turn;
                find(self, below)
            });
            best = match (best, found) {
                (Some(best), Some(found)) if !self.is_worth_a_length(&found, &best) => Some(best),
                (best, found) => found.or(best),
            };
            if self.effort.clock.is_up() {
                break;
            }
        }
        best
    }

    /// True for a manoeuvre at a tenth of the cost that breaks fewer rules than another, or as many where that
    /// one is far off the path.
    fn is_worth_a_length(&self, cheaper: &Manoeuvre, other: &Manoeuvre) -> bool {
        let problem = self.problem();
        let broken = |of: &Manoeuvre| broken_rules(problem, &of.whole.motion);
        let far = FAR_OFF_LENGTHS * problem.own.hull.length;
        let is_far_off = other.whole.cost > far * far;
        match broken(cheaper).cmp(&broken(other)) {
            Ordering::Less => true,
            Ordering::Equal => is_far_off,
            Ordering::Greater => false,
        }
    }

    /// The latest time from which there is an escape: a lawful manoeuvre with a turn of at most
    /// `most_turn` that costs at most `late_price` times one from when own ship `may` act. By
    /// sampling and bisection.
    fn latest_escape(&mut self, contact: f64, may: f64, most_turn: f64) -> Option<f64> {
        self.most_turn = self.settings().largest_turn;
        let may = self.tidy_time(may.clamp(self.from, contact));
        // what is sailed before both is no part of the price
        let before = self.problem().error_of(&until(self.nominal_motion, may));
        let early = self.best(may..=may, f64::INFINITY);
        let below = early.map_or(f64::INFINITY, |early| {
            let before = before * early.price;
            before + self.settings().late_price * (early.whole.cost - before)
        });
        self.most_turn = most_turn;
        let samples = self.settings().escape_samples;
        let step = (contact - self.from) / samples as f64;
        let exists = |time: f64| self.has_escape(self.tidy_time(time), below);
        let mut times = (0..=samples).rev().map(|k| self.from + step * k as f64);
        let mut latest = times.find(|time| self.effort.clock.is_up() || exists(*time))?;
        let mut too_late = (latest + step).min(contact);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (latest + too_late);
            if self.effort.clock.is_up() {
                break;
            }
            if exists(middle) {
                latest = middle;
            } else {
                too_late = middle;
            }
        }
        (!self.effort.clock.is_up()).then_some(latest)
    }

    /// True where some lawful manoeuvre from a departure costs less than `below`.
    fn has_escape(&self, leave: f64, below: f64) -> bool {
        let is_escape = |end: Partial| end.cost < below && self.is_lawful(&end);
        let firsts = self.first_alterations(leave..=leave, false);
        let angles = self.angles();
        firsts.into_iter().any(|(leave, first)| {
            if self.effort.clock.is_up() {
                return false;
            }
            let out = self.out(leave, first);
            let Some(out) = out.filter(|o| o.cost < below && self.is_clear(o.off_route())) else {
                return false;
            };
            match first {
                FirstAlteration::Slow { .. } => self.slowed(&out, COARSE_S).is_some_and(is_escape),
                FirstAlteration::Turn { .. } => {
                    let returns =
                        |passed: &Partial| ways_back(self, passed, &angles, below).any(is_escape);
                    outward(self, &out).any(|passed| {
                        let mut next = Some(passed);
                        while let Some(passed) = next {
                            if passed.cost < below && returns(&passed) {
                                return true;
                            }
                            next = wider(self, &passed);
                        }
                        false
                    })
                }
            }
        })
    }

    /// The cheapest manoeuvre with a departure in a window, where it costs less than `below`.
    fn best(&self, window: RangeInclusive<f64>, below: f64) -> Option<Manoeuvre> {
        let departures = self.first_alterations(window.clone(), true);
        self.best_of(departures, window, below)
    }

    /// The cheapest manoeuvre that begins with one of some first alterations, improved within a window
    /// of departures.
    fn best_of(
        &self,
        departures: Vec<(f64, FirstAlteration)>,
        window: RangeInclusive<f64>,
        below: f64,
    ) -> Option<Manoeuvre> {
        let problem = self.problem();
        let mut angles = self.angles();
        // a return goes on as it is
        let begun = problem.under_way.filter(|begun| begun.is_returning);
        angles.extend(begun.map(|begun| wrap(begun.heading - begun.first_heading).abs()));
        let mut graph = Graph {
            manoeuvres: self,
            departures,
            angles: &angles,
            below,
        };
        let mut search = Search::new(Partial::start());
        let begun = problem.under_way;
        let mut best: Option<(usize, Partial)> = None;
        for _ in 0..self.settings().most_goals {
            let Stop::Goal(goal) = search.next_goal(&mut graph, self.settings().most_expanded)
            else {
                break;
            };
            let found = &search.nodes()[goal].state;
            let ends = [self.improved(found.clone(), window.clone()), found.clone()];
            for whole in ends {
                let broken = self.broken_before_risk(&whole);
                if best.as_ref().is_none_or(|(least, _)| broken < *least) {
                    best = Some((broken, whole));
                }
                if broken == 0 {
                    break;
                }
            }
            if best.as_ref().is_some_and(|(least, _)| *least == 0) {
                break;
            }
        }
        self.effort.explored.borrow_mut().add(self, search);
        best.map(|(_, whole)| Manoeuvre {
            begun,
            price: self.price(whole.first),
            whole,
        })
    }

    /// Number of rules that the judges find broken by a manoeuvre that departs before a risk has begun:
    /// the role toward that target is then another one than on the route.
    fn broken_before_risk(&self, whole: &Partial) -> usize {
        let mut all = self.passing.iter().map(|p| p.encountered);
        match all.any(|e| whole.leave < e.risk_since) {
            true => broken_rules(self.problem(), &whole.motion),
            false => 0,
        }
    }

    /// Pattern search over the departure, the turn, the angle of the return and the time for which a
    /// parallel course stays clear: each in turn, by steps that shrink. Every hold hugs,
    /// closer than in the graph.
    fn improved(&self, mut best: Partial, window: RangeInclusive<f64>) -> Partial {
        // built closer it may hug elsewhere, and be dearer
        best = (self.built(&Numbers::of(&best), best.cost)).unwrap_or(best);
        let mut scale = 1.0;
        for _ in 0..self.settings().rounds {
            let mut gained = false;
            for (number, step) in self.settings().steps.into_iter().enumerate() {
                let better = [scale, -scale].into_iter().find_map(|scale| {
                    if self.effort.clock.is_up() {
                        return None;
                    }
                    let numbers = self.stepped(&best, number, scale * step, &window)?;
                    self.built(&numbers, best.cost)
                });
                gained |= better.is_some();
                best = better.unwrap_or(best);
            }
            if !gained {
                scale *= 0.5;
            }
        }
        best
    }

    /// The numbers of a manoeuvre with one of them changed; `None` where it has no such number or this
    /// changes nothing.
    fn stepped(
        &self,
        best: &Partial,
        number: usize,
        step: f64,
        window: &RangeInclusive<f64>,
    ) -> Option<Numbers> {
        let old = Numbers::of(best);
        let mut new = old;
        match (number, &mut new.first, &mut new.outward) {
            (0, ..) => {
                let moved = old.leave + step * self.unit;
                new.leave = self.tidy_time(moved.clamp(*window.start(), *window.end()));
                // on another leg the ordered speed may be another
                let ordered = |time| ManoeuvreSpeeds::at(self.problem(), time);
                if ordered(new.leave) != ordered(old.leave) {
                    return None;
                }
            }
            (1, FirstAlteration::Turn { turn, speed }, _) if self.problem().under_way.is_none() => {
                let least = self.least_turn(*speed).min(self.most_turn);
                *turn = (turn.abs() + step).clamp(least, self.most_turn) * turn.signum();
            }
            (2, FirstAlteration::Turn { .. }, _) => {
                let WayBack::At(angle) = old.way_back else {
                    return None;
                };
                let [least, most] = self.settings().angle_range;
                let least = least.max(self.least_angle());
                let most = least.max(most);
                new.way_back = WayBack::At((angle + step).clamp(least, most));
            }
            (3, FirstAlteration::Turn { .. }, Outward::Parallel { spare }) => {
                *spare = (*spare + step * self.unit).max(0.0);
            }
            _ => return None,
        }
        (new != old).then_some(new)
    }

    /// The lawful manoeuvre of some numbers, where it costs less than `below`. Every hold is the least.
    fn built(&self, numbers: &Numbers, below: f64) -> Option<Partial> {
        let cheaper = |partial: &Partial| partial.cost + self.to_go(partial) < below;
        let out = self.out(numbers.leave, numbers.first).filter(cheaper)?;
        if !self.is_clear(out.off_route()) {
            return None;
        }
        let end = match numbers.first {
            FirstAlteration::Slow { .. } => self.slowed(&out, FINE_S),
            FirstAlteration::Turn { .. } => {
                let passed = match numbers.outward {
                    Outward::Direct => self.direct(&out),
                    Outward::Parallel { spare } => self.parallel(&out, spare, FINE_S, None),
                };
                self.back(&passed.filter(cheaper)?, numbers.way_back, FINE_S, below)
            }
        };
        end.filter(|end| cheaper(end) && self.is_lawful(end))
    }

    /// First alterations with a departure in a window, the latest first, with turns to
    /// tangents or without.
    fn first_alterations(
        &self,
        window: RangeInclusive<f64>,
        with_tangents: bool,
    ) -> Vec<(f64, FirstAlteration)> {
        let times = self.departures(*window.start(), *window.end());
        let ordered = |time: &f64| ManoeuvreSpeeds::at(self.problem(), *time);
        let stretches: Vec<&[f64]> = times.chunk_by(|a, b| ordered(a) == ordered(b)).collect();
        let mut all = Vec::new();
        for times in &stretches {
            let (Some(latest), Some(first)) = (times.first(), times.last()) else {
                continue;
            };
            let (from, to) = (
                due_leg(self.problem(), *first),
                due_leg(self.problem(), *latest),
            );
            let window = window.start().max(from.start_time)..=window.end().min(to.end_time());
            let speeds = ordered(latest);
            self.add_first_alterations((times, window), speeds, with_tangents, &mut all);
        }
        all
    }

    /// First alterations at some times of a window, where these are the speeds.
    fn add_first_alterations(
        &self,
        (times, window): (&[f64], RangeInclusive<f64>),
        ordered: ManoeuvreSpeeds,
        with_tangents: bool,
        all: &mut Vec<(f64, FirstAlteration)>,
    ) {
        let problem = self.problem();
        let duty = problem.duty();
        // a fraction of the ordered speed, also where the ship cannot keep just that
        let most = self.family.most_slow * ordered.wanted.min(ordered.normal) * (1.0 + 1e-9);
        let slow = problem.own.speeds.iter().copied();
        let slow = slow.filter(|u| duty.may_slow && *u <= most && (*u > 0.0 || self.stops));
        let faster =
            (self.family.may_speed_up && ordered.fast > ordered.normal).then_some(ordered.fast);
        let speeds: Vec<f64> = match self.slows_to_turn {
            // no turn is one of a ship that follows
            _ if self.follows => Vec::new(),
            true => slow.clone().filter(|u| *u > 0.0).collect(),
            false => std::iter::once(ordered.normal).chain(faster).collect(),
        };
        let stands_on = duty.stands_on;
        let sides = duty.sides().iter().copied();
        let sides: Vec<Side> = sides
            .filter(|side| !(stands_on && *side == Side::Port))
            .collect();
        for &speed in &speeds {
            for side in &sides {
                let [of_several, of_one] = self.family.turns;
                let turns = match with_tangents && times.len() == 1 {
                    true => of_one,
                    false => of_several,
                };
                let least = self.least_turn(speed);
                let turns = turns.iter().map(|turn| (turn * APPARENT_TURN).max(least));
                let turns = turns.filter(|turn| *turn <= self.most_turn);
                let mut turns: Vec<f64> = turns.map(|turn| turn * side.turn_sign()).collect();
                turns.dedup();
                for &time in times {
                    if self.effort.clock.is_up() {
                        return;
                    }
                    let tangents = match with_tangents {
                        true => self.tangents(time, speed, *side),
                        false => Vec::new(),
                    };
                    let turns = turns.iter().copied().chain(tangents);
                    all.extend(turns.map(|turn| (time, FirstAlteration::Turn { turn, speed })));
                }
                if times.len() > 1 {
                    for &turn in &turns {
                        let hugging = self.hugging_departures(&window, turn, speed);
                        let first = FirstAlteration::Turn { turn, speed };
                        all.extend(hugging.into_iter().map(|time| (time, first)));
                    }
                }
            }
        }
        if !self.slows_to_turn || self.follows {
            let slow = slow.map(|speed| FirstAlteration::Slow { speed });
            all.extend(slow.flat_map(|first| times.iter().map(move |time| (*time, first))));
        }
    }

    /// The least turn: of the family, and long enough for a segment, radians.
    fn least_turn(&self, speed: f64) -> f64 {
        let Family {
            least_turn, least, ..
        } = self.family;
        least_turn.max(SPARE * least * speed / self.problem().own.turning_radius)
    }

    /// Angles of the returns, radians.
    fn angles(&self) -> Vec<f64> {
        let mut angles = self
            .settings()
            .angles
            .map(|angle| angle.max(self.least_angle()))
            .to_vec();
        angles.dedup();
        angles
    }

    /// The least angle of a return, whose last turn is long enough for a segment, radians.
    fn least_angle(&self) -> f64 {
        let own = self.problem().own;
        SPARE * self.family.least * own.max_speed() / own.turning_radius
    }

    /// The turns to a side from a departure, to lines that touch a set on its far side, radians.
    fn tangents(&self, time: f64, speed: f64, side: Side) -> Vec<f64> {
        let problem = self.problem();
        let pose = match pose_at(self.nominal_motion, time) {
            Some(pose) if time > 0.0 => pose,
            _ => problem.own.pose,
        };
        let turning = Interceptor::new(&pose, time, speed, problem.own.turning_radius, side);
        let limits = Limits {
            turn: self.most_turn,
            time: problem.horizon,
        };
        let mut tangents: Vec<f64> = Vec::new();
        for proxy in self.context.proxies {
            let met = proxy.body.moving_vertices().iter().filter_map(|vertex| {
                let origin = vertex.origin - vertex.velocity * proxy.start();
                turning.intercept(origin, vertex.velocity, limits)
            });
            let Some(turn) = met.map(|met| met.turn).reduce(f64::max) else {
                continue;
            };
            let same = |other: &f64| (other.abs() - turn).abs() < SAME_TANGENT;
            if turn > self.least_turn(speed) && turn < self.most_turn && !tangents.iter().any(same)
            {
                tangents.push((turn + CLEAR_OF_TANGENT) * side.turn_sign());
            }
        }
        tangents
    }

    /// The latest departures in a window after which the line of a turn touches a body, while the
    /// nominal motion is straight.
    fn hugging_departures(&self, window: &RangeInclusive<f64>, turn: f64, speed: f64) -> Vec<f64> {
        let (from, to) = (*window.start(), *window.end());
        let lines = self.nominal_motion.iter().filter(|s| !s.is_arc());
        let lines = lines.filter(|s| s.end_time() > from && s.start_time < to);
        let mut times: Vec<f64> = Vec::new();
        for line in lines {
            let line = line.between(from, to);
            let held = HeldTurn {
                pose: line.start,
                time: line.start_time,
                held_speed: line.speed,
                turn,
                speed,
                radius: self.problem().own.turning_radius,
            };
            let holds = self.touching(&held, (0.0, line.duration)).into_iter();
            times.extend(holds.map(|hold| self.tidy_time(line.start_time + hold)));
        }
        times.sort_by(|a, b| b.total_cmp(a));
        times.dedup();
        times.truncate(self.settings().hugging_departures);
        times
    }
}
