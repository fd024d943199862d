//! Compliance monitors: rules as formulas of temporal logic over samples, each with its robustness
//! (docs/colregs.md 4.2; Krasowski and Althoff, doi:10.1109/IV48863.2021.9575294).

use super::samples::{EncounterSample, EncounterSamples};
use crate::colregs::{Role, SteadyShip, Thresholds, role_within};
use crate::frame::{Pose, wrap};

/// Verdict of a monitor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MonitorVerdict {
    /// The formula holds, and its premise was met.
    Satisfied,
    /// The formula does not hold.
    Violated,
    /// Its premise was never met.
    Idle,
    /// The trace ends before it is decided.
    Undecided,
}

impl MonitorVerdict {
    /// Its name in documents.
    pub fn name(self) -> &'static str {
        match self {
            Self::Satisfied => "satisfied",
            Self::Violated => "violated",
            Self::Idle => "idle",
            Self::Undecided => "undecided",
        }
    }
}

/// Unit of robustness.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Metres.
    Distance,
    /// Radians.
    Angle,
    /// Seconds.
    Time,
}

/// Result of one monitor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonitorResult {
    /// `S`, `R1` (in extremis), `R3` (crossing), `R4` (head-on), `R5` (overtaking) or `R6`
    /// (stand-on).
    pub monitor: &'static str,
    /// The verdict.
    pub verdict: MonitorVerdict,
    /// Least margin by which the formula holds, negative if violated; `None` if idle.
    pub robustness: Option<f64>,
    /// Unit of the robustness.
    pub measure: Measure,
    /// Time of the least margin, seconds; `None` if idle.
    pub time: Option<f64>,
}

/// The samples with own ship's role in each, and the thresholds.
struct Trace<'a> {
    samples: &'a [EncounterSample],
    roles: Vec<Option<Role>>,
    t: &'a Thresholds,
    target_length: f64,
}

/// A run of samples in which a predicate holds.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    from: usize,
    /// The first sample in which it no longer holds.
    until: usize,
}

impl Trace<'_> {
    /// True if the relative velocity hits a disc about the target in time.
    fn collision_possible(&self, sample: &EncounterSample) -> bool {
        let m = &self.t.monitor;
        let ahead = sample.ahead();
        let radius = m.lengths * self.target_length;
        let range = sample.range();
        // negated on purpose: what is not known to be clear is possible
        if !(range > radius) {
            return true;
        }
        if ahead.time < 0.0 || ahead.distance > radius {
            return false;
        }
        let relative = (sample.own.velocity() - sample.target.velocity()).norm();
        let chord = (radius * radius - ahead.distance * ahead.distance)
            .max(0.0)
            .sqrt();
        ahead.time - chord / relative <= m.time
    }

    fn role(&self, sample: &EncounterSample) -> Option<Role> {
        if !self.collision_possible(sample) {
            return None;
        }
        role_within(&sample.own, &sample.target, &self.t.sectors)
    }

    /// True if the role is the same after the time to react, with course and speed held.
    fn persists(&self, sample: &EncounterSample, role: Role) -> bool {
        let seconds = self.t.monitor.react;
        let on = |ship: &SteadyShip| SteadyShip {
            pose: Pose::new(
                ship.pose.position + ship.velocity() * seconds,
                ship.pose.heading,
            ),
            ..*ship
        };
        let then = EncounterSample {
            own: on(&sample.own),
            target: on(&sample.target),
            ..*sample
        };
        sample.ahead().time > seconds && self.role(&then) == Some(role)
    }

    /// Runs of samples with a role.
    fn stretches(&self, wanted: impl Fn(Role) -> bool) -> Vec<Stretch> {
        let roles = self.roles.iter();
        let has: Vec<bool> = roles.map(|role| role.is_some_and(&wanted)).collect();
        let mut found: Vec<Stretch> = Vec::new();
        for k in 0..has.len() {
            if has[k] && (k == 0 || !has[k - 1]) {
                let until = (k..has.len()).find(|j| !has[*j]).unwrap_or(has.len());
                found.push(Stretch { from: k, until });
            }
        }
        found
    }

    /// `G(role begins and persists -> F[react + 2 manoeuvre](range shrinks until turn >= m.turn))`,
    /// the turn to starboard, or to either side.
    fn turns(&self, monitor: &'static str, role: Role, either: bool) -> MonitorResult {
        let m = &self.t.monitor;
        let mut worst: Option<(f64, f64)> = None;
        let mut open = false;
        let begun = self.stretches(|r| r == role);
        for stretch in begun
            .iter()
            .filter(|s| self.persists(&self.samples[s.from], role))
        {
            let first = &self.samples[stretch.from];
            let until = first.time + m.react + 2.0 * m.manoeuvre;
            let meanwhile = || {
                let closing = |s: &&EncounterSample| s.time <= until && s.opening() <= 0.0;
                self.samples[stretch.from..].iter().take_while(closing)
            };
            let turn = meanwhile()
                .map(|s| {
                    let turn = wrap(first.own.pose.heading - s.own.pose.heading);
                    if either { turn.abs() } else { turn }
                })
                .fold(0.0, f64::max);
            let robustness = turn - m.turn;
            let ends = stretch.from + meanwhile().count() == self.samples.len();
            if robustness < 0.0 && ends {
                open = true;
            }
            if worst.is_none_or(|w| robustness < w.0) {
                worst = Some((robustness, first.time));
            }
        }
        Self::result(monitor, Measure::Angle, worst, open)
    }

    /// `G(stand-on and collision possible -> course held until they no longer are)`.
    fn holds(&self) -> MonitorResult {
        let mut worst: Option<(f64, f64)> = None;
        for stretch in self.stretches(|r| r.duties().stands_on) {
            let first = self.samples[stretch.from].own.pose.heading;
            for sample in &self.samples[stretch.from..stretch.until] {
                let turn = wrap(sample.own.pose.heading - first).abs();
                let robustness = self.t.score.hold - turn;
                if worst.is_none_or(|w| robustness < w.0) {
                    worst = Some((robustness, sample.time));
                }
            }
        }
        Self::result("R6", Measure::Angle, worst, false)
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
        Self::result("S", Measure::Distance, Some(worst), false)
    }

    /// `G(in extremis -> F not in extremis, before the hulls meet)`. In extremis, the hulls meet
    /// within the time to manoeuvre if both hold course and speed.
    fn leaves_extremis(&self) -> MonitorResult {
        // negated on purpose: what is not known to be later is within
        let within = |s: &&EncounterSample| !(s.meets_in > self.t.monitor.manoeuvre);
        let in_extremis = self.samples.iter().filter(within);
        let worst = in_extremis
            .map(|s| (s.meets_in, s.time))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let result = Self::result("R1", Measure::Time, worst, false);
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
        monitor: &'static str,
        measure: Measure,
        worst: Option<(f64, f64)>,
        open: bool,
    ) -> MonitorResult {
        let verdict = match worst {
            None => MonitorVerdict::Idle,
            // touching is encounter: the sets are closed
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

/// Results of every monitor over one encounter. O(samples).
pub fn monitors(encounter: &EncounterSamples, t: &Thresholds) -> [MonitorResult; 6] {
    let mut trace = Trace {
        samples: encounter.samples(),
        roles: Vec::new(),
        t,
        target_length: encounter.target_length(),
    };
    trace.roles = trace.samples.iter().map(|s| trace.role(s)).collect();
    [
        trace.apart(),
        trace.leaves_extremis(),
        trace.turns("R3", Role::GiveWay, false),
        trace.turns("R4", Role::HeadOn, false),
        trace.turns("R5", Role::Overtaking, true),
        trace.holds(),
    ]
}
