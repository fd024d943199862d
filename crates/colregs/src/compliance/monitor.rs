//! Compliance monitors: rules as formulas of temporal logic over samples, each with its robustness
//! (docs/reference/colregs.md 4.2; Krasowski and Althoff, doi:10.1109/IV48863.2021.9575294).

use super::role_intervals::RoleInterval;
use super::samples::{EncounterSample, EncounterSamples};
use crate::{APPARENT_SPEED, APPARENT_TIME, MayAct, Role, Thresholds, role_within};
use searoom_geometry::frame::wrap;

searoom_geometry::words! {
    /// Verdict of a monitor.
    pub enum MonitorVerdict {
        /// The formula holds, and its premise was met.
        Satisfied => "satisfied",
        /// The formula does not hold.
        Violated => "violated",
        /// Its premise was never met.
        Idle => "idle",
        /// The trace ends before it is decided.
        Undecided => "undecided",
    }
}

searoom_geometry::words! {
    /// Quantity of a robustness, with its unit in documents.
    pub enum Measure {
        /// Metres.
        Distance => "m",
        /// Radians; degrees in documents.
        Angle => "deg",
        /// Seconds.
        Time => "s",
    }
}

searoom_geometry::words! {
    /// A monitor, by its number in documents.
    pub enum Monitor {
        /// No contact of the hulls.
        Contact => "S",
        /// In extremis.
        CollisionCourse => "R1",
        /// Crossing.
        Crossing => "R3",
        /// Head-on.
        HeadOn => "R4",
        /// Overtaking.
        Overtaking => "R5",
        /// Stand-on.
        StandOn => "R6",
    }
}

/// Result of one monitor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonitorResult {
    /// The monitor.
    pub monitor: Monitor,
    /// The verdict.
    pub verdict: MonitorVerdict,
    /// Least margin by which the formula holds, negative if violated; `None` if idle.
    pub robustness: Option<f64>,
    /// Quantity of the robustness.
    pub measure: Measure,
    /// Time of the least margin, seconds; `None` if idle.
    pub time: Option<f64>,
}

/// The samples, own ship's roles, and the thresholds.
struct Trace<'a> {
    samples: &'a [EncounterSample],
    roles: &'a [RoleInterval],
    t: &'a Thresholds,
    /// Factor of the times.
    factor: f64,
    /// Seconds from which on own ship need not hold its course because of another target.
    excused_from: f64,
    /// Length of the longer ship, metres.
    length: f64,
    /// m/s.
    ordered_speed: f64,
}

impl Trace<'_> {
    /// The samples of every role that is wanted and persists, from its beginning to its end.
    fn wanted(
        &self,
        wanted: impl Fn(Role) -> bool,
    ) -> impl Iterator<Item = (Role, &[EncounterSample])> {
        let roles = self.roles.iter().filter(move |r| wanted(r.role));
        roles.filter_map(|role| {
            let from = self.samples.partition_point(|s| s.time < role.from);
            let until = self.samples.partition_point(|s| s.time <= role.until);
            let within = self.samples.get(from..until)?;
            self.persists(within.first()?, role.role)
                .then_some((role.role, within))
        })
    }

    /// True if the role is the same after the time to react, with course and speed held.
    fn persists(&self, sample: &EncounterSample, role: Role) -> bool {
        let seconds = self.factor * self.t.monitor.react;
        let own = sample.at_speed(self.ordered_speed).own.moved(seconds);
        let target = sample.target.moved(seconds);
        let then = sample.with_ships(own, target);
        then.ahead().time > 0.0 && role_within(&own, &target, &self.t.sectors) == Some(role)
    }

    /// True if own ship is at reduced speed for long enough to be seen, beginning among the first
    /// `before` samples.
    fn slows(&self, samples: &[EncounterSample], before: usize) -> bool {
        let slow = |s: &EncounterSample| s.own.speed <= APPARENT_SPEED * self.ordered_speed + 1e-9;
        let mut since: Option<f64> = None;
        samples.iter().enumerate().any(|(k, sample)| {
            let held = since.is_some_and(|since| sample.time - since >= APPARENT_TIME - 1e-6);
            since = match since {
                _ if !slow(sample) => None,
                None if k < before => Some(sample.time),
                kept => kept,
            };
            held
        })
    }

    /// `G(role begins and persists -> F[react + 2 manoeuvre](not past until turn >= m.turn))`,
    /// the turn to starboard, or to either side. Where a lower speed may replace the turn, it is
    /// held for [`APPARENT_TIME`].
    fn alters(&self, monitor: Monitor, either_side: bool, may_slow: bool) -> MonitorResult {
        let m = &self.t.monitor;
        let mut worst: Option<(f64, f64)> = None;
        let mut open = false;
        let asks = |role: Role| role.duties().alteration_monitor == Some(monitor);
        for (_, samples) in self.wanted(asks) {
            let first = samples[0].at_speed(self.ordered_speed);
            let until = first.time + self.factor * m.response();
            let before_passing = |s: &&EncounterSample| s.time <= until && !s.is_past(&first.own);
            let meanwhile = samples.iter().take_while(before_passing).count();
            let turn = samples[..meanwhile]
                .iter()
                .map(|s| {
                    let turn = wrap(first.own.pose.heading - s.own.pose.heading);
                    if either_side { turn.abs() } else { turn }
                })
                .fold(0.0, f64::max);
            let mut robustness = turn - m.turn;
            if may_slow && self.slows(samples, meanwhile) {
                robustness = robustness.max(0.0);
            }
            if robustness < 0.0 && meanwhile == samples.len() {
                open = true;
            }
            if worst.is_none_or(|w| robustness < w.0) {
                worst = Some((robustness, first.time));
            }
        }
        Self::result(monitor, Measure::Angle, worst, open)
    }

    /// `G(stands on and persists -> course held until past, stage 3 or in extremis)`.
    fn holds(&self) -> MonitorResult {
        let mut worst: Option<(f64, f64)> = None;
        for (role, samples) in self.wanted(|r| r.duties().stands_on) {
            let first = samples[0].own.pose.heading;
            for sample in samples
                .iter()
                .take_while(|s| !self.may_act(role, &samples[0], s))
            {
                let turn = wrap(sample.own.pose.heading - first).abs();
                let robustness = self.t.score.hold - turn;
                if worst.is_none_or(|w| robustness < w.0) {
                    worst = Some((robustness, sample.time));
                }
            }
        }
        Self::result(Monitor::StandOn, Measure::Angle, worst, false)
    }

    /// First time at which own ship need not hold its course, as it keeps clear or may act.
    fn frees_at(&self) -> f64 {
        let keeps_clear = (self.roles.iter()).filter(|r| r.role.duties().keeps_clear);
        let acts = self.wanted(|r| r.duties().stands_on);
        let acts = acts.filter_map(|(role, samples)| {
            let mut may = samples
                .iter()
                .filter(|s| self.may_act(role, &samples[0], s));
            may.next().map(|s| s.time)
        });
        keeps_clear
            .map(|r| r.from)
            .chain(acts)
            .fold(f64::INFINITY, f64::min)
    }

    /// True from stage 3 on and in extremis: a stand-on ship may act, Rule 17(a)(ii) and (b).
    fn may_act(&self, role: Role, first: &EncounterSample, sample: &EncounterSample) -> bool {
        let limits = &self.t.score;
        let stage_3 = match role.duties().may_act {
            MayAct::BeforeClosestApproach => {
                let left = first.ahead().time - (sample.time - first.time);
                left <= limits.overtaken_lengths * self.length / self.ordered_speed
            }
            MayAct::WithinRange => sample.range() <= limits.stage_3_lengths * self.length,
        };
        stage_3
            || sample.time >= self.excused_from
            || sample.meets_in <= self.factor * self.t.monitor.manoeuvre
    }

    /// `G(the hulls are apart)`.
    fn apart(&self) -> MonitorResult {
        let mut worst = (f64::INFINITY, 0.0);
        for sample in self.samples {
            // negated on purpose: a NaN is the worst
            if !(sample.apart >= worst.0) {
                worst = (sample.apart, sample.time);
            }
        }
        Self::result(Monitor::Contact, Measure::Distance, Some(worst), false)
    }

    /// `G(in extremis -> F not in extremis, before the hulls meet)`. In extremis, the hulls meet
    /// within the time to manoeuvre if both hold course and speed.
    fn leaves_extremis(&self) -> MonitorResult {
        // negated on purpose: what is not known to be later is within
        let within = |s: &&EncounterSample| !(s.meets_in > self.factor * self.t.monitor.manoeuvre);
        let in_extremis = self.samples.iter().filter(within);
        let worst = in_extremis
            .map(|s| (s.meets_in, s.time))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let result = Self::result(Monitor::CollisionCourse, Measure::Time, worst, false);
        let open = self.samples.last().is_some_and(|s| within(&s));
        match result.verdict {
            MonitorVerdict::Satisfied if open => MonitorResult {
                verdict: MonitorVerdict::Undecided,
                ..result
            },
            _ => result,
        }
    }

    fn result(
        monitor: Monitor,
        measure: Measure,
        worst: Option<(f64, f64)>,
        open: bool,
    ) -> MonitorResult {
        let verdict = match worst {
            None => MonitorVerdict::Idle,
            // touching is contact: the sets are closed
            Some((r, _)) if r > 0.0 || (r == 0.0 && measure == Measure::Angle) => {
                MonitorVerdict::Satisfied
            }
            Some(_) if open => MonitorVerdict::Undecided,
            Some(_) => MonitorVerdict::Violated,
        };
        MonitorResult {
            monitor,
            verdict,
            robustness: worst.map(|w| w.0),
            measure,
            time: worst.map(|w| w.1),
        }
    }
}

fn trace<'a>(
    encounter: &'a EncounterSamples,
    roles: &'a [RoleInterval],
    excused_from: f64,
    t: &'a Thresholds,
) -> Trace<'a> {
    Trace {
        samples: encounter.samples(),
        roles,
        t,
        factor: t.time_factor(encounter.own_length()),
        excused_from,
        length: encounter.length(),
        ordered_speed: encounter.ordered_speed(),
    }
}

/// First time at which own ship need not hold its course because of this target; infinite if that
/// never is.
pub(super) fn frees_at(
    encounter: &EncounterSamples,
    roles: &[RoleInterval],
    t: &Thresholds,
) -> f64 {
    trace(encounter, roles, f64::INFINITY, t).frees_at()
}

/// Results of every monitor over one encounter. `excused_from` as in
/// [`ComplianceReport::of_all`](super::ComplianceReport::of_all). O(samples).
pub fn monitors(
    encounter: &EncounterSamples,
    roles: &[RoleInterval],
    excused_from: f64,
    t: &Thresholds,
) -> [MonitorResult; 6] {
    let trace = trace(encounter, roles, excused_from, t);
    [
        trace.apart(),
        trace.leaves_extremis(),
        trace.alters(Monitor::Crossing, false, true),
        trace.alters(Monitor::HeadOn, false, false),
        trace.alters(Monitor::Overtaking, true, true),
        trace.holds(),
    ]
}
