//! Checks when the plans of a simulation were made, by the clock of the closed loop.

use searoom_document::{RelaxationKind, ReplanDocument, SimulationDocument};
use searoom_evaluation::Violation;
use searoom_model::SailedVessel;

/// Rounding of times: this many seconds, and this fraction of the duration.
pub(super) const TIME_S: f64 = 1e-6;

/// The plans of a simulation, and the clock by which they are made.
///
/// The loop advances by `step_s`, or less up to the next event: a plan takes effect or ends, one is
/// due, or the simulation ends. A plan is due `replan_s` after the last one, or [`BEFORE_END_S`]
/// and the delay before the end of a plan that ends short. It is not made where own ship's plan
/// ends before it could take effect. Events ask for one in between, while no plan waits to take
/// effect. A plan ends short where it ends before the last waypoint and before its horizon.
///
/// [`BEFORE_END_S`]: ReplanDocument::BEFORE_END_S
pub(super) struct Cycles<'a> {
    document: &'a SimulationDocument,
    /// Rounding of a time, seconds.
    rounding: f64,
    /// Time from the start to the end of the longest plan, seconds.
    longest: f64,
}

impl<'a> Cycles<'a> {
    pub(super) fn of(document: &'a SimulationDocument) -> Self {
        Self {
            document,
            rounding: TIME_S * (1.0 + document.duration_s),
            longest: document.replans.iter().map(length).fold(0.0, f64::max),
        }
    }

    pub(super) fn is_same(&self, a: f64, b: f64) -> bool {
        (a - b).abs() <= self.rounding
    }

    /// True for a plan that ends where it begins: the loop ends there, unless another one is made
    /// before.
    fn is_stop(&self, plan: &ReplanDocument) -> bool {
        plan.end_s
            .is_some_and(|end| self.is_same(end, plan.start_t_s))
    }

    /// The plan of these that own ship follows at a time, seconds.
    fn active(&self, plans: &'a [ReplanDocument], time: f64) -> Option<&'a ReplanDocument> {
        let (last, before) = plans.split_last()?;
        let is_active = |p: &&ReplanDocument| p.followed && p.start_t_s <= time + self.rounding;
        let before = before.iter().rev().filter(|p| !self.is_stop(p));
        std::iter::once(last).chain(before).find(is_active)
    }

    /// When own ship's plan ends, with these plans; infinite without one.
    fn plan_end(&self, plans: &'a [ReplanDocument], time: f64) -> f64 {
        let active = self.active(plans, time);
        active.and_then(|plan| plan.end_s).unwrap_or(f64::INFINITY)
    }

    /// True where the last plan leads to the last waypoint, and the simulation to its end.
    pub(super) fn ends_at_last_waypoint(&self) -> bool {
        let (plans, end) = (&self.document.replans, self.document.duration_s);
        self.active(plans, end)
            .is_some_and(|plan| arrives(plan) && self.is_same(self.plan_end(plans, end), end))
    }

    /// Plans at other times than those at which the loop makes them, and times between its steps.
    pub(super) fn check(&self) -> Vec<Violation> {
        let (document, end) = (self.document, self.document.duration_s);
        let (settings, plans) = (&document.settings, &document.replans[..]);
        let mut found = Vec::new();
        let mut require = |holds: bool, what: &str, time: f64| {
            if !holds {
                found.push(Violation::new(what.to_owned(), time));
            }
        };
        let of_period = |time: f64| 0.0 <= time && time <= settings.replan_s;
        let is_step = settings.step_s >= 0.01;
        let are_times = is_step && of_period(settings.step_s) && of_period(settings.delay_s);
        require(
            are_times,
            "a step below 0.01 s, or a step or a delay longer than the time between plans",
            0.0,
        );
        let Some(last) = plans.last() else {
            require(false, "plans are missing", end);
            return found;
        };
        let is_first = plans[0].t_s == 0.0 && plans[0].start_t_s == 0.0;
        require(is_first, "the first plan is missing", 0.0);
        for (index, plan) in plans.iter().enumerate() {
            let (before, time) = (&plans[..index], plan.t_s);
            let has_end = plan.end_s.is_none_or(|end| end >= plan.start_t_s);
            let has_end = has_end && plan.end_s.is_some() == plan.cost_m2.is_some();
            require(has_end, "a plan that ends at another time", time);
            if index > 0 {
                let starts = self.is_same(plan.start_t_s, time + settings.delay_s);
                require(starts, "a plan that begins at another time", time);
                let is_due = match plan.reason == ReplanDocument::PERIOD {
                    true => self
                        .due(before)
                        .into_iter()
                        .any(|due| self.is_same(time, due)),
                    false => self.may_be_asked_for(before, time),
                };
                require(
                    is_due && time <= end + self.rounding,
                    "a plan at another time",
                    time,
                );
            }
        }
        // another plan would have been due, and would have taken effect
        let plan_end = self.plan_end(plans, end);
        let is_made = |due: f64| due + settings.delay_s + self.rounding < plan_end;
        let has_next = |due: f64| due + self.rounding < end && is_made(due);
        let is_complete = !self.due(plans).into_iter().all(has_next);
        let latest = last.t_s + settings.replan_s + settings.delay_s;
        require(
            is_complete && end <= latest + self.rounding,
            "plans are missing",
            end,
        );
        let until = plan_end.min(settings.duration_s);
        let ends = match document.interrupted {
            true => end <= until + self.rounding,
            false => self.is_same(end, until),
        };
        require(
            ends,
            "it ends neither with its plan nor at its duration",
            end,
        );
        let alarms = document.alarms.iter().map(|alarm| alarm.t_s);
        let targets = document.targets.iter();
        let acts =
            targets.flat_map(|t| t.track.iter().map(|s| s.at.t_s).chain([t.unknown_until_s]));
        // one is enough: with another step it is most of them
        if let Some(time) = alarms.chain(acts).find(|time| !self.is_step(*time)) {
            require(false, "a time between two steps", time);
        }
        found
    }

    /// When the next plan is due after these. Of a plan that may reach the horizon it is unknown
    /// whether it ends short.
    fn due(&self, plans: &'a [ReplanDocument]) -> Vec<f64> {
        let settings = &self.document.settings;
        let last = plans.last();
        let of_period = last.map_or(0.0, |plan| plan.t_s) + settings.replan_s;
        let from = last.map_or(0.0, waits_until);
        let ends_early =
            |plan: &&ReplanDocument| settings.vessel != SailedVessel::CyberShip2 && !arrives(plan);
        let Some(active) = self.active(plans, from).filter(ends_early) else {
            return vec![of_period];
        };
        let end = active.end_s.unwrap_or(f64::INFINITY);
        let early = end - settings.delay_s - ReplanDocument::BEFORE_END_S;
        let may_reach_horizon = length(active) + self.rounding >= self.longest;
        if early < from - self.rounding || of_period <= early {
            vec![of_period]
        } else if early <= from + self.rounding || may_reach_horizon {
            vec![of_period, early]
        } else {
            vec![early]
        }
    }

    /// True where an event may ask for a plan at a time after the last one.
    fn may_be_asked_for(&self, before: &'a [ReplanDocument], time: f64) -> bool {
        let is_before = |due: f64| time <= due + self.rounding;
        before.last().is_some_and(|last| {
            waits_until(last) <= time + self.rounding
                && self.due(before).into_iter().any(is_before)
                && self.is_step_after(last, time)
        })
    }

    /// True for a time at which a step begins or ends.
    fn is_step(&self, time: f64) -> bool {
        let plans = &self.document.replans;
        let begun = plans.partition_point(|plan| plan.t_s <= time + self.rounding);
        let last = begun.checked_sub(1).map(|last| &plans[last]);
        self.is_same(time, self.document.duration_s)
            || last.is_some_and(|last| self.is_step_after(last, time))
    }

    /// True for the time of a step after a plan, if no other one is made in between.
    fn is_step_after(&self, plan: &ReplanDocument, time: f64) -> bool {
        let settings = &self.document.settings;
        // an event that makes no plan, because own ship's ends before, moves the next time at which one is due
        let events = [
            Some(plan.t_s),
            Some(plan.start_t_s).filter(|_| plan.followed),
            Some(plan.t_s + settings.replan_s),
        ];
        let events = events.into_iter().flatten();
        let mut events = events.filter(|event| *event <= time + self.rounding);
        events.any(|from| {
            let steps = ((time - from) / settings.step_s).round();
            self.is_same(time, from + steps * settings.step_s)
        })
    }
}

/// Seconds from the start to the end of a plan.
fn length(plan: &ReplanDocument) -> f64 {
    plan.end_s.map_or(0.0, |end| end - plan.start_t_s)
}

/// Until when no other plan is made after this one.
fn waits_until(plan: &ReplanDocument) -> f64 {
    if plan.followed {
        plan.start_t_s
    } else {
        plan.t_s
    }
}

/// True for a plan to the last waypoint.
pub(super) fn arrives(plan: &ReplanDocument) -> bool {
    plan.left_out_m == 0.0 && !plan.relaxations.contains(&RelaxationKind::Arrival)
}
