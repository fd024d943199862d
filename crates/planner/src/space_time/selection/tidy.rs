//! Tidy manoeuvres: few turns, few changes of speed, no short segments.
//!
//! Where the conflicts are near together, the graph of manoeuvres by the rules has one, without roles.
//! Besides, a refined manoeuvre is simplified: one speed, no short segment variables, few turns. It is
//! refined again with a least time for each segment variable. Candidates are ranked by their cost
//! with the [`Prices`] of their alterations. So the manoeuvre as it was wins where the simpler one
//! is too dear or not clear.

use std::cell::RefCell;

use super::{Selection, leaders, refined};
use crate::clock::Clock;
use crate::space_time::context::Context;
use crate::space_time::manoeuvre::conflict::{Conflict, far_apart};
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::refinement::quadratic::MAX_VARIABLES;
use crate::space_time::refinement::structure::SegmentVariable;
use crate::space_time::refinement::{InitialGuess, Refinement};
use crate::space_time::route::Route;
use crate::space_time::rules::automaton::Effort;
use crate::space_time::rules::search::without_roles;
use crate::space_time::settings::TidySettings;
use crate::{AGAINST_THE_RULES, Problem, Tidiness};
use searoom_geometry::frame::Side;
use searoom_model::trajectory::Segment;
use searoom_parallel as parallel;

/// Prices of the alterations of a motion.
#[derive(Debug, Clone, Copy)]
pub(super) struct Prices<'a> {
    /// `None` where tidiness is not asked for.
    tidy: Option<Tidiness>,
    own_speed: f64,
    settings: &'a TidySettings,
    /// Manoeuvres that a plan is expected to have: conflicts that are far apart have one each.
    manoeuvres: usize,
    /// Alterations already in the nominal motion (corners, legs of different speeds, returns to schedule),
    /// which are not charged.
    nominal: Alterations,
}

impl<'a> Prices<'a> {
    pub(super) fn of(problem: &Problem<'a>, route: &Route, conflicts: &[Conflict]) -> Self {
        let (tidy, own_speed, settings) = (problem.tidy, problem.own.speed, &problem.settings.tidy);
        let nominal = tidy.map(|tidy| {
            let of = |route: &Route| {
                Alterations::of(own_speed, &route.follow(0.0, 0.0), &tidy, settings)
            };
            Alterations {
                short: of(&route.without_recovery()).short,
                ..of(route)
            }
        });
        Self {
            tidy,
            own_speed,
            settings,
            manoeuvres: far_apart(conflicts, problem.settings.conflicts.apart_s),
            nominal: nominal.unwrap_or_default(),
        }
    }

    /// Factor of the cost of a motion by which candidates are ranked; 1 where tidiness is not asked
    /// for.
    pub(super) fn factor(&self, motion: &[Segment]) -> f64 {
        let Some(tidy) = self.tidy else {
            return 1.0;
        };
        let found = Alterations::of(self.own_speed, motion, &tidy, self.settings);
        let settings = self.settings;
        let number = found.speed_changes + found.turns;
        let excess = self.excess(&found).min(settings.most_excess);
        1.0 + settings.price * number as f64 / self.manoeuvres as f64
            + settings.excess_price * excess as f64
    }

    /// True for a motion with no more alterations than a tidy plan has, and without short times.
    fn is_tidy(&self, motion: &[Segment]) -> bool {
        let found = |tidy| Alterations::of(self.own_speed, motion, &tidy, self.settings);
        self.tidy.is_none_or(|tidy| self.excess(&found(tidy)) == 0)
    }

    /// True where a plan needs several manoeuvres one after another.
    fn is_for_several(&self) -> bool {
        self.manoeuvres > 1
    }

    /// Number of alterations too many and of times too short, beyond those of the nominal motion.
    fn excess(&self, found: &Alterations) -> usize {
        let nominal = &self.nominal;
        let speed_changes =
            self.settings.most_speed_changes * self.manoeuvres + nominal.speed_changes;
        let turns = self.settings.most_turns * self.manoeuvres + nominal.turns;
        found.speed_changes.saturating_sub(speed_changes)
            + found.turns.saturating_sub(turns)
            + found.short.saturating_sub(nominal.short)
    }
}

/// Alterations of a motion.
#[derive(Debug, Clone, Copy, Default)]
struct Alterations {
    turns: usize,
    speed_changes: usize,
    /// Segments and times at a speed that are too short.
    short: usize,
}

impl Alterations {
    /// Alterations of a motion without equal neighbours, from a speed on.
    fn of(own_speed: f64, motion: &[Segment], tidy: &Tidiness, settings: &TidySettings) -> Self {
        let is_short = |time: f64, least: f64| time < least * (1.0 - 1e-6);
        let mut found = Self::default();
        let (mut speed, mut since, mut turn) = (own_speed, f64::NEG_INFINITY, 0.0_f64);
        for s in motion {
            found.short += usize::from(is_short(s.duration, tidy.segment_time));
            if (s.speed - speed).abs() > settings.speed_change * own_speed {
                found.speed_changes += 1;
                found.short += usize::from(is_short(s.start_time - since, tidy.speed_time));
                (speed, since) = (s.speed, s.start_time);
            }
            let by = s.turn_rate * s.duration;
            if by == 0.0 || by * turn < 0.0 {
                found.turns += usize::from(turn.abs() > settings.turn);
                turn = 0.0;
            }
            turn += by;
        }
        found.turns += usize::from(turn.abs() > settings.turn);
        found
    }
}

impl Selection<'_> {
    /// Adds the best clear candidate of the refinements and of tidy ones. Tidy ones are the manoeuvre of
    /// [`without_roles`] and the best refinements simplified, or, where these are not tidy or too dear, the
    /// simplified initial guesses. Each of the refinements makes good the time it has lost, or does not.
    pub(super) fn add_tidy(
        &mut self,
        tidy: &Tidiness,
        (nominal_motion, conflicts): (&[Segment], &[Conflict]),
        running: &[Refinement],
        guesses: &[InitialGuess],
        clock: Clock,
    ) {
        let late_route = self.context.route.without_recovery();
        let mut pool = Pool {
            prices: self.prices,
            on_time: Context {
                segment_time: tidy.segment_time,
                ..self.context
            },
            late: Context {
                segment_time: tidy.segment_time,
                route: &late_route,
                ..self.context
            },
            motions: Vec::new(),
        };
        for refinement in running {
            pool.add_refined(refinement);
        }
        if let [conflict, ..] = conflicts
            && !self.prices.is_for_several()
            && !clock.is_up()
        {
            let explored = RefCell::default();
            let effort = Effort {
                clock,
                explored: &explored,
            };
            let contact = conflict.from;
            let found = without_roles(&pool.on_time, nominal_motion, contact, tidy, effort);
            if let Some(motion) = found {
                pool.add(handicap(self.context.problem, &motion), motion);
            }
        }
        let (speeds, settings) = (self.context.speeds, self.prices.settings);
        for (guess, rank) in leaders(running, settings.leaders, settings.leader_margin) {
            if pool.has_tidy_below(settings.enough * rank) {
                break;
            }
            for pattern in Speeds::all(&speeds) {
                let context = match pattern.stays_late(&speeds) {
                    true => &pool.late,
                    false => &pool.on_time,
                };
                let simple = simplified(&guess, &speeds, pattern, (tidy, settings));
                let refined =
                    simple.and_then(|guess| refined(context, guess, settings.iterations, clock));
                refined.iter().for_each(|r| pool.add_refined(r));
            }
        }
        if !pool.has_tidy_below(f64::INFINITY) && !clock.is_up() {
            let context = pool.on_time;
            let mut found: Vec<Refinement> = Vec::new();
            for guess in guesses {
                let simple = Speeds::of_one(&speeds).into_iter();
                let simple =
                    simple.filter_map(|at| simplified(guess, &speeds, at, (tidy, settings)));
                found.extend(simple.filter_map(|guess| Refinement::fitting(&context, guess)));
            }
            parallel::each(&mut found, |r| {
                r.go_on(&context, settings.iterations, clock)
            });
            found.iter().for_each(|r| pool.add_refined(r));
        }
        pool.add(1.0, late_route.follow(0.0, 0.0));
        for (_, motion) in pool.cheapest_first() {
            if self.add_candidate(motion) {
                return;
            }
        }
    }
}

/// Factor on the cost of a motion when it is ranked among others, as that of a refinement: its first turn is
/// better to the preferred side.
fn handicap(problem: &Problem, motion: &[Segment]) -> f64 {
    let first = motion.iter().find_map(|s| Side::of_turn(s.turn_rate));
    match (first, problem.first_turn) {
        (Some(first), Some(preferred)) if first != preferred => 1.0 + AGAINST_THE_RULES,
        _ => 1.0,
    }
}

/// Candidates with their priced costs.
struct Pool<'a> {
    prices: Prices<'a>,
    /// Own ship makes good the time it has lost, or does not.
    on_time: Context<'a>,
    late: Context<'a>,
    motions: Vec<(f64, Vec<Segment>)>,
}

impl Pool<'_> {
    fn add(&mut self, handicap: f64, motion: Vec<Segment>) {
        let cost = self.on_time.problem.error_to_end(&motion);
        let rank = handicap * cost * self.prices.factor(&motion);
        if rank.is_finite() {
            self.motions.push((rank, motion));
        }
    }

    fn add_refined(&mut self, refinement: &Refinement) {
        for context in [self.on_time, self.late] {
            if let Some(motion) = refinement.best_motion(&context) {
                self.add(refinement.handicap(), motion);
            }
        }
    }

    /// True where the candidate that ranks first is tidy and its priced cost at most this, m².
    fn has_tidy_below(&self, most: f64) -> bool {
        let best = self.motions.iter().min_by(|a, b| a.0.total_cmp(&b.0));
        best.is_some_and(|(rank, motion)| *rank <= most && self.prices.is_tidy(motion))
    }

    fn cheapest_first(mut self) -> Vec<(f64, Vec<Segment>)> {
        self.motions.sort_by(|a, b| a.0.total_cmp(&b.0));
        self.motions
    }
}

/// Speeds of a simplified manoeuvre.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Speeds {
    /// One speed from leaving the route, or from a run before that.
    One(f64),
    /// The slow speed from the first to the last segment variable that has it, then another.
    SlowThen { slow: f64, then: f64 },
}

impl Speeds {
    fn of_one(speeds: &ManoeuvreSpeeds) -> Vec<Self> {
        let mut of_one = vec![Self::One(speeds.normal), Self::One(speeds.fast)];
        of_one.dedup();
        of_one
    }

    fn all(speeds: &ManoeuvreSpeeds) -> Vec<Self> {
        let mut all = Self::of_one(speeds);
        let ManoeuvreSpeeds {
            slow, normal, fast, ..
        } = *speeds;
        if slow < normal {
            all.extend([normal, fast].map(|then| Self::SlowThen { slow, then }));
            all.dedup();
        }
        all
    }

    /// True where own ship goes on at its normal speed after less speed, without making good the
    /// time lost.
    fn stays_late(self, speeds: &ManoeuvreSpeeds) -> bool {
        matches!(self, Self::SlowThen { then, .. } if then == speeds.normal)
    }
}

/// A manoeuvre with few changes of speed and few turns, and without segment variables that take
/// less than the least time. `None` where nothing is left of it.
fn simplified(
    guess: &InitialGuess,
    speeds: &ManoeuvreSpeeds,
    pattern: Speeds,
    (tidy, settings): (&Tidiness, &TidySettings),
) -> Option<InitialGuess> {
    let normal = speeds.normal;
    let given: Vec<_> = guess.pieces().filter(|piece| piece.1 > 0.0).collect();
    let (last_speed, slow) = match pattern {
        Speeds::One(speed) => (speed, None),
        Speeds::SlowThen { slow, then } => {
            let is_slow = |(variable, _): &(SegmentVariable, f64)| variable.speed() == slow;
            let first = given.iter().position(is_slow)?;
            let last = given.iter().rposition(is_slow)?;
            let times = given[first..=last].iter().map(|(_, length)| length / slow);
            let time: f64 = times.sum();
            if time < settings.dropped * tidy.speed_time {
                return None;
            }
            (then, Some((first, last, slow)))
        }
    };
    let mut parts: Vec<(SegmentVariable, f64)> = Vec::with_capacity(MAX_VARIABLES);
    for (i, (variable, length)) in given.into_iter().enumerate() {
        let speed = match slow {
            Some((first, last, slow)) if (first..=last).contains(&i) => slow,
            Some((first, ..)) if i < first => normal,
            None if variable.is_on_route() && variable.speed() != last_speed => normal,
            _ => last_speed,
        };
        // after another run its time would depend on where it begins
        let at_first = parts
            .iter()
            .all(|part| matches!(part.0, SegmentVariable::Ordered { .. }));
        let variable = match variable.is_on_route() && speed == normal && at_first {
            true => SegmentVariable::Ordered { speed },
            false => variable.at_speed(speed),
        };
        join(&mut parts, variable, length);
    }
    let is_arc = |part: &(SegmentVariable, f64)| matches!(part.0, SegmentVariable::Arc { .. });
    loop {
        let arcs = parts.iter().filter(|part| is_arc(part)).count();
        let too_many = arcs + 1 > settings.most_turns;
        let relative = |part: &(SegmentVariable, f64)| part.1 / part.0.speed();
        let shortest = (0..parts.len())
            .filter(|i| !too_many || is_arc(&parts[*i]))
            .min_by(|a, b| relative(&parts[*a]).total_cmp(&relative(&parts[*b])));
        match shortest {
            Some(i) if too_many || relative(&parts[i]) < settings.dropped * tidy.segment_time => {
                parts.remove(i);
            }
            _ => break,
        }
        for (variable, length) in std::mem::take(&mut parts) {
            join(&mut parts, variable, length);
        }
    }
    let follows = guess.structure.ending == Ending::Follow;
    let returns = matches!(guess.structure.ending, Ending::Return { .. });
    if follows && slow.is_none() || returns && !parts.iter().any(is_arc) {
        return None;
    }
    for (variable, length) in &mut parts {
        *length = length.max(tidy.segment_time * variable.speed());
    }
    let ending = guess.structure.ending.at_speed(last_speed);
    Some(InitialGuess::new(&parts, ending))
}

/// Appends a segment variable, or lengthens the last one of its kind.
fn join(parts: &mut Vec<(SegmentVariable, f64)>, variable: SegmentVariable, length: f64) {
    match parts.last_mut() {
        _ if length <= 0.0 => {}
        Some((last, sum)) if *last == variable => *sum += length,
        _ => parts.push((variable, length)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use searoom_geometry::frame::{Pose, Vector};

    /// Speeds and turn rates, each for a number of seconds.
    fn motion(parts: &[(f64, f64, f64)]) -> Vec<Segment> {
        let mut motion: Vec<Segment> = Vec::new();
        for (duration, speed, turn_rate) in parts {
            let (pose, time) = motion.last().map_or_else(
                || (Pose::new(Vector::zeros(), 0.0), 0.0),
                |last| (last.end(), last.end_time()),
            );
            motion.push(Segment::new(pose, time, *duration, *speed, *turn_rate));
        }
        motion
    }

    #[test]
    fn alterations_are_counted() {
        let tidy = Tidiness::at_length(30.0);
        for (parts, turns, speed_changes, short) in [
            (&[(100.0, 5.0, 0.0)][..], 0, 0, 0),
            // an arc at two speeds is one turn; 20 s are too short for a speed
            (
                &[(20.0, 6.0, 0.05), (10.0, 5.0, 0.05), (9.0, 5.0, -0.05)],
                2,
                2,
                1,
            ),
            (
                &[(40.0, 5.0, 0.0), (2.0, 5.0, 0.05), (40.0, 5.0, 0.0)],
                1,
                0,
                1,
            ),
            // less than 2 %, less than 2 degrees
            (
                &[(40.0, 5.05, 0.0), (3.0, 5.0, 0.01), (40.0, 5.0, 0.0)],
                0,
                0,
                0,
            ),
        ] {
            let found = Alterations::of(5.0, &motion(parts), &tidy, &TidySettings::DEFAULT);
            let numbers = (found.turns, found.speed_changes, found.short);
            assert_eq!(numbers, (turns, speed_changes, short), "{parts:?}");
        }
    }

    #[test]
    fn a_simple_manoeuvre_has_few_turns_one_speed_and_no_short_segment() {
        use searoom_geometry::frame::Side::{Port, Starboard};
        let speeds = ManoeuvreSpeeds {
            slow: 2.5,
            normal: 5.0,
            fast: 6.0,
            wanted: 5.0,
        };
        let tidy = Tidiness::at_length(30.0);
        let arc = |side, speed| SegmentVariable::Arc { side, speed };
        let line = |speed| SegmentVariable::Line { speed };
        let parts = [
            (SegmentVariable::Ordered { speed: 5.0 }, 300.0),
            (arc(Starboard, 2.5), 40.0),
            (arc(Starboard, 6.0), 80.0),
            (line(2.5), 3.0),
            (arc(Port, 5.0), 1.0),
            (line(6.0), 200.0),
            (arc(Port, 6.0), 60.0),
            (line(6.0), 50.0),
            (arc(Port, 6.0), 70.0),
            (arc(Starboard, 6.0), 25.0),
        ];
        let guess = InitialGuess::new(&parts, Ending::Return { leg: 0, speed: 6.0 });
        let simple = simplified(
            &guess,
            &speeds,
            Speeds::One(6.0),
            (&tidy, &TidySettings::DEFAULT),
        )
        .expect("a manoeuvre");
        let kept: Vec<_> = simple.pieces().collect();
        let expected = [
            (SegmentVariable::Ordered { speed: 5.0 }, 300.0),
            (arc(Starboard, 6.0), 120.0),
            (line(6.0), 203.0),
            (arc(Port, 6.0), 60.0),
            (line(6.0), 50.0),
            (arc(Port, 6.0), 70.0),
        ];
        assert_eq!(kept, expected);
        // too little time at the slow speed
        let then = Speeds::SlowThen {
            slow: 2.5,
            then: 5.0,
        };
        let slow = InitialGuess {
            lengths: guess.lengths.map(|length| 0.1 * length),
            ..guess
        };
        assert!(simplified(&slow, &speeds, then, (&tidy, &TidySettings::DEFAULT)).is_none());
    }
}
