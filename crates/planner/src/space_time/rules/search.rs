//! Which manoeuvre: the cheapest one of a coarse grid, improved by a pattern search.
//!
//! ```text
//! departures ─► first alterations ─► clear outward legs ─► endings ─► cheapest ─► pattern search
//! ```
//!
//! A ship that keeps clear tries six departures, the latest first; one that stands on holds first.
//! Each is tried with a length off all targets, then off fewer, and with turns at half speed or
//! less where nothing else is clear. A manoeuvre under way keeps the parameters that are done.

use std::ops::RangeInclusive;

use crate::UnderWay;
use crate::space_time::manoeuvre::motion::until;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::rules::compliance::keeps_off_bows;
use crate::space_time::rules::departure::SAMPLE_S;
use crate::space_time::rules::manoeuvre::{
    Ending, FirstAlteration, Manoeuvre, Manoeuvres, OutwardLeg, Passing,
};
use searoom_colregs::{APPARENT_SPEED, APPARENT_TURN, ON_COURSE};
use searoom_geometry::frame::{Side, wrap};

/// Turns, as multiples of the least readily apparent turn.
const TURNS: [f64; 8] = [1.0, 1.35, 1.7, 2.2, 2.7, 3.5, 4.5, 6.0];

/// Seconds on the new course before a parallel course is steered; infinite for no parallel course.
const ASIDE_S: [f64; 6] = [f64::INFINITY, 15.0, 35.0, 60.0, 100.0, 180.0];

/// Seconds from passing to the return.
const AFTER_S: [f64; 5] = [0.0, 15.0, 40.0, 90.0, 180.0];

/// Angles between the return line and the route, radians.
const BACK: [f64; 3] = [0.3, 0.6, 1.0];

/// Rounds of the pattern search.
const ROUNDS: usize = 7;

/// Sampled instants of the escape of a stand-on ship, bisection steps after that, and the stride
/// through the endings.
const SAMPLES: usize = 40;
const HALVINGS: usize = 5;
const ENDING_STRIDE: usize = 2;

/// Seconds by which a stand-on ship acts before the latest certified escape.
const SPARE_S: f64 = 40.0;

/// Ratio of the cost of a late escape to that of an earlier manoeuvre above which a stand-on ship
/// acts earlier, where it may.
const LATE_PRICE: f64 = 4.0;

/// Range in lengths within which a stand-on ship acts.
const ACT_LENGTHS: f64 = 6.0;

const FROM_NONE: fn(&Passing) -> bool = |_| false;

impl Manoeuvres<'_, '_> {
    /// The cheapest end of the manoeuvre that is under way.
    pub(super) fn going_on(&mut self) -> Option<Manoeuvre> {
        self.relaxed(|search| search.best_at(0.0, f64::INFINITY))
    }

    /// The cheapest manoeuvre of a ship that keeps clear, begun in ample time, where the nominal
    /// motion meets an obstacle after `contact` seconds.
    pub(super) fn giving_way(&mut self, contact: f64) -> Option<Manoeuvre> {
        let from = self.from;
        let latest = self.ample_time().min(contact).max(from);
        self.relaxed(|search| {
            let mut best: Option<Manoeuvre> = None;
            for time in search.departures(from, latest) {
                let below = best.as_ref().map_or(f64::INFINITY, |best| best.cost);
                let found = search.cheapest(time, below);
                let improved = found.map(|found| search.improved(found, from..=latest));
                best = improved.or(best);
            }
            best
        })
    }

    /// The manoeuvre of a ship that stands on: it holds its course until it is near, as long as
    /// there is an escape that is not far dearer than to act earlier.
    pub(super) fn standing_on(&mut self, contact: f64) -> Option<Manoeuvre> {
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
        if latest < may && may < contact && self.cheapest(may, f64::INFINITY).is_some() {
            latest = may;
        }
        let mut wanted = latest - SPARE_S;
        // where it cannot hold on for as long as it must, not longer than is safe
        if !(latest < may - SAMPLE_S) {
            wanted = wanted.min(self.comes_within(ACT_LENGTHS)).max(may);
        }
        let latest = latest.max(self.from);
        let leave = self.tidy_time(wanted.clamp(self.from, latest));
        let late = self.relaxed(|search| {
            let found = search.best_at(leave, f64::INFINITY);
            found.or_else(|| search.best_at(search.tidy_time(latest), f64::INFINITY))
        })?;
        self.earlier_action(&late, may).or(Some(late))
    }

    /// A manoeuvre that costs far less than a late one, begun before it but not before own ship may
    /// act: the latest of five. It keeps a length off the same targets as the late one.
    fn earlier_action(&mut self, late: &Manoeuvre, may: f64) -> Option<Manoeuvre> {
        let leave = late.parameters.leave;
        if !(leave > may) {
            return None;
        }
        let times = self.departures(may.max(self.from), leave).into_iter();
        // `from` may be before it may act
        let mut times = times.filter(|time| *time < leave && *time >= may - SAMPLE_S);
        // what is sailed before both is no part of the price
        let before = until(self.nominal_motion, self.from);
        let before = self.problem().error_of(&before);
        let below = before + (late.cost - before) / LATE_PRICE;
        // for the late one alone nothing else was clear
        self.slows_to_turn = false;
        times.find_map(|time| self.best_at(time, below))
    }

    /// The first manoeuvre that is found: with a length off all targets, off those that own ship
    /// keeps clear of, off none; of each with turns at the ordered speed, then at half or less.
    fn relaxed(&mut self, find: impl Fn(&Self) -> Option<Manoeuvre>) -> Option<Manoeuvre> {
        let problem = self.problem();
        let may_slow = problem.duty().may_slow && problem.under_way.is_none();
        let speeds: &[bool] = if may_slow { &[false, true] } else { &[false] };
        let mut tried = usize::MAX;
        let levels: [fn(&Passing) -> bool; 3] = [|_| true, |p| p.keeps_clear(), FROM_NONE];
        for keeps_a_length in levels {
            self.keeps_a_length = keeps_a_length;
            let number = self.kept_off().count();
            if number == tried {
                continue;
            }
            tried = number;
            for slows_to_turn in speeds {
                self.slows_to_turn = *slows_to_turn;
                let found = find(self);
                if found.is_some() || self.clock.is_up() {
                    return found;
                }
            }
        }
        None
    }

    /// The latest time from which an escape is found, by sampling and bisection.
    fn latest_escape(&self, contact: f64) -> Option<f64> {
        let step = (contact - self.from) / SAMPLES as f64;
        let exists = |time: f64| {
            let time = self.tidy_time(time);
            self.clear_outward_legs(time, f64::INFINITY).any(|out| {
                let few = self.endings(&out).into_iter().step_by(ENDING_STRIDE);
                let mut escapes = few.filter_map(|ending| self.with_ending(&out, ending));
                escapes.any(|escape| self.is_allowed(&out, &escape))
            })
        };
        let mut times = (0..=SAMPLES).rev().map(|k| self.from + step * k as f64);
        let mut latest = times.find(|time| self.clock.is_up() || exists(*time))?;
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

    /// The cheapest clear manoeuvre of the grid from a departure, if it costs less than `below`.
    fn cheapest(&self, leave: f64, below: f64) -> Option<Manoeuvre> {
        let goes_on = || !self.clock.is_up();
        let outs = self.clear_outward_legs(leave, below);
        let outs: Vec<OutwardLeg> = outs.take_while(|_| goes_on()).collect();
        let all = outs.iter().flat_map(|out| {
            let endings = self.endings(out).into_iter();
            endings.filter_map(move |ending| Some((out, self.with_ending(out, ending)?)))
        });
        let mut found: Vec<_> = all.filter(|(_, found)| found.cost < below).collect();
        found.sort_by(|(_, a), (_, b)| a.cost.total_cmp(&b.cost));
        let mut found = found.into_iter().take_while(|_| goes_on());
        found.find_map(|(out, found)| self.is_allowed(out, &found).then_some(found))
    }

    /// [`Self::cheapest`], improved without another departure.
    fn best_at(&self, leave: f64, below: f64) -> Option<Manoeuvre> {
        let found = self.cheapest(leave, below)?;
        Some(self.improved(found, leave..=leave))
    }

    /// Pattern search: each parameter in turn, by steps that shrink.
    fn improved(&self, mut best: Manoeuvre, leave: RangeInclusive<f64>) -> Manoeuvre {
        let mut step = 1.0;
        for _ in 0..ROUNDS {
            let mut gained = false;
            for parameter in 0..5 {
                let better = [step, -step].into_iter().find_map(|step| {
                    if self.clock.is_up() {
                        return None;
                    }
                    let tried = best.parameters.stepped(parameter, step, self.unit);
                    let mut tried = tried.filter(|tried| *tried != best.parameters)?;
                    tried.leave = self.tidy_time(tried.leave.clamp(*leave.start(), *leave.end()));
                    self.manoeuvre(&tried, best.cost)
                });
                gained |= better.is_some();
                best = better.unwrap_or(best);
            }
            if !gained {
                step *= 0.5;
            }
        }
        best
    }

    /// The motions from a departure until every target is passed, those that are clear so far, keep
    /// off the targets' bows, and cost less than `below`.
    fn clear_outward_legs(&self, leave: f64, below: f64) -> impl Iterator<Item = OutwardLeg> + '_ {
        let before = until(self.nominal_motion, leave);
        self.alterations().into_iter().filter_map(move |first| {
            let out = self.outward_leg(&before, leave, first)?;
            // what follows can only add to the cost; without a limit this needs no sum
            let cheap =
                below.is_infinite() || self.problem().error_of(&out.motion) * first.price() < below;
            (cheap
                && self.is_clear(out.off_route())
                && keeps_off_bows(self.problem(), self.to_judge(&out.motion)))
            .then_some(out)
        })
    }

    fn alterations(&self) -> Vec<FirstAlteration> {
        let problem = self.problem();
        if let Some(begun) = problem.under_way {
            return self.alterations_under_way(&begun);
        }
        let (ordered, duty) = (ManoeuvreSpeeds::of(problem), problem.duty());
        // half of the desired speed, also where the ship cannot keep just that
        let legs = problem.desired.legs().iter().map(|leg| leg.speed);
        let desired = legs.fold(0.0, f64::max).min(ordered.normal);
        let most = APPARENT_SPEED * desired * (1.0 + 1e-9);
        let slow = problem.own.moving_speeds();
        let slow = slow.filter(|u| duty.may_slow && *u <= most);
        let may_speed_up = (problem.encountered.iter()).any(|e| e.role.duties().may_speed_up);
        let faster = (may_speed_up && ordered.fast > ordered.normal).then_some(ordered.fast);
        let speeds: Vec<f64> = match self.slows_to_turn {
            true => slow.clone().collect(),
            false => std::iter::once(ordered.normal).chain(faster).collect(),
        };
        let mut all: Vec<FirstAlteration> = Vec::new();
        for speed in speeds {
            for side in duty.sides() {
                if duty.stands_on && *side == Side::Port {
                    continue;
                }
                for turn in TURNS.map(|turn| turn * APPARENT_TURN * side.turn_sign()) {
                    let asides = ASIDE_S.map(|aside| aside * self.unit);
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
    fn alterations_under_way(&self, begun: &UnderWay) -> Vec<FirstAlteration> {
        let (mut turn, speed) = (begun.turn, begun.speed);
        let is_parallel = wrap(begun.heading - begun.first_heading).abs() <= ON_COURSE;
        let mut asides = vec![f64::INFINITY];
        if begun.is_returning {
            turn = 0.0;
        } else if turn == 0.0 {
            return vec![FirstAlteration::Slow { speed }];
        } else if !is_parallel {
            asides = ASIDE_S.map(|aside| aside * self.unit).to_vec();
            asides.extend([0.0, begun.aside]);
        }
        let turn_for = |aside| FirstAlteration::Turn { turn, aside, speed };
        asides.into_iter().map(turn_for).collect()
    }

    fn endings(&self, out: &OutwardLeg) -> Vec<Ending> {
        let mut angles = match out.first {
            FirstAlteration::Turn { .. } => BACK.to_vec(),
            FirstAlteration::Slow { .. } => BACK[..1].to_vec(),
        };
        // a return goes on as it is
        let begun = self.problem().under_way.filter(|begun| begun.is_returning);
        angles.extend(begun.map(|begun| wrap(begun.heading - begun.first_heading).abs()));
        let after = AFTER_S.map(|after| after * self.unit).into_iter();
        let endings =
            after.flat_map(|after| angles.iter().map(move |&back| Ending { after, back }));
        endings.collect()
    }
}
