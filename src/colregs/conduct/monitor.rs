//! The second judge: rules as formulas of temporal logic over a trace, each with its robustness (docs/colregs.md 4.2; Krasowski &
//! Althoff, doi:10.1109/IV48863.2021.9575294). It shares the sights, the sectors of roles and the thresholds with the first judge, and no formula.

use super::super::role::{Role, SteadyShip, role_within};
use super::meeting::{Meeting, Sight};
use super::thresholds::Thresholds;
use crate::frame::{Pose, wrap};

/// What a monitor found.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::colregs::conduct::{Thresholds, Verdict};
///
/// let scenario = Scenario::read("scenarios/colregs/stand-on.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let thresholds = Thresholds::standard();
/// let toward_the_ferry = run.conduct(thresholds).remove(0).expect("a plan among ships");
/// let verdicts = toward_the_ferry.findings.each_ref().map(|finding| finding.verdict);
/// assert!(verdicts.contains(&Verdict::Satisfied) && verdicts.contains(&Verdict::Idle));
/// assert_eq!(Verdict::Idle.name(), "idle");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// The formula holds, and its premise was met.
    Satisfied,
    /// It does not.
    Violated,
    /// Its premise was never met.
    Idle,
    /// The trace ends before it is decided.
    Undecided,
}

impl Verdict {
    /// As documents name it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Satisfied => "satisfied",
            Self::Violated => "violated",
            Self::Idle => "idle",
            Self::Undecided => "undecided",
        }
    }
}

/// In what robustness is measured.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::colregs::conduct::{Measure, Thresholds};
///
/// let scenario = Scenario::read("scenarios/colregs/stand-on.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let thresholds = Thresholds::standard();
/// let toward_the_ferry = run.conduct(thresholds).remove(0).expect("a plan among ships");
/// let safety = &toward_the_ferry.findings[0];
/// assert_eq!((safety.monitor, safety.measure), ("S", Measure::Distance));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Metres.
    Distance,
    /// Radians.
    Angle,
    /// Seconds.
    Time,
}

/// One formula over one trace.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::colregs::conduct::{Finding, Thresholds, Verdict};
///
/// let scenario = Scenario::read("scenarios/colregs/stand-on.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let thresholds = Thresholds::standard();
/// let toward_the_ferry = run.conduct(thresholds).remove(0).expect("a plan among ships");
/// let safety: &Finding = &toward_the_ferry.findings[0];
/// assert_eq!(safety.verdict, Verdict::Satisfied);
/// assert!(safety.robustness.expect("metres") > 100.0, "never nearer than that");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Finding {
    /// `S`, `R1` (in extremis), `R3` (crossing), `R4` (head-on), `R5` (overtaking) or `R6` (stand-on).
    pub monitor: &'static str,
    /// What was found.
    pub verdict: Verdict,
    /// By how much it holds at its worst, negative where it is violated; `None` when idle.
    pub robustness: Option<f64>,
    /// Of the robustness.
    pub measure: Measure,
    /// When it is at its worst, seconds; `None` when idle.
    pub time: Option<f64>,
}

/// A trace with what is measured.
struct Trace<'a> {
    sights: &'a [Sight],
    /// Own ship's in each of the sights.
    roles: Vec<Option<Role>>,
    t: &'a Thresholds,
    target_length: f64,
}

/// A stretch of sights, from one in which a predicate begins to hold.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    from: usize,
    /// The first in which it no longer holds.
    until: usize,
}

impl Trace<'_> {
    /// The relative velocity hits a disc about the target in time.
    fn collision_possible(&self, sight: &Sight) -> bool {
        let m = &self.t.monitor;
        let ahead = sight.ahead();
        let radius = m.lengths * self.target_length;
        let range = sight.range();
        // negated on purpose: what is not known to be clear is possible
        if !(range > radius) {
            return true;
        }
        if ahead.time < 0.0 || ahead.distance > radius {
            return false;
        }
        let relative = (sight.own.velocity() - sight.target.velocity()).norm();
        let chord = (radius * radius - ahead.distance * ahead.distance)
            .max(0.0)
            .sqrt();
        ahead.time - chord / relative <= m.time
    }

    fn role(&self, sight: &Sight) -> Option<Role> {
        if !self.collision_possible(sight) {
            return None;
        }
        role_within(&sight.own, &sight.target, &self.t.sectors)
    }

    /// The role is still the same after the time to react, if both hold course and speed.
    fn persists(&self, sight: &Sight, role: Role) -> bool {
        let seconds = self.t.monitor.react;
        let on = |ship: &SteadyShip| SteadyShip {
            pose: Pose::new(
                ship.pose.position + ship.velocity() * seconds,
                ship.pose.heading,
            ),
            ..*ship
        };
        let then = Sight {
            own: on(&sight.own),
            target: on(&sight.target),
            ..*sight
        };
        sight.ahead().time > seconds && self.role(&then) == Some(role)
    }

    /// Where a role begins, and how long it stays.
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

    /// `G(role begins and persists -> F within the time to react and manoeuvre, and while the range shrinks: a turn of at least
    /// so much)`; to starboard alone, or to either side.
    fn turns(&self, monitor: &'static str, role: Role, either: bool) -> Finding {
        let m = &self.t.monitor;
        let mut worst: Option<(f64, f64)> = None;
        let mut open = false;
        let begun = self.stretches(|r| r == role);
        for stretch in begun
            .iter()
            .filter(|s| self.persists(&self.sights[s.from], role))
        {
            let first = &self.sights[stretch.from];
            let until = first.time + m.react + 2.0 * m.manoeuvre;
            let meanwhile = || {
                let closing = |s: &&Sight| s.time <= until && s.opening() <= 0.0;
                self.sights[stretch.from..].iter().take_while(closing)
            };
            let turn = meanwhile()
                .map(|s| {
                    let turn = wrap(first.own.pose.heading - s.own.pose.heading);
                    if either { turn.abs() } else { turn }
                })
                .fold(0.0, f64::max);
            let robustness = turn - m.turn;
            let ends = stretch.from + meanwhile().count() == self.sights.len();
            if robustness < 0.0 && ends {
                open = true;
            }
            if worst.is_none_or(|w| robustness < w.0) {
                worst = Some((robustness, first.time));
            }
        }
        Self::finding(monitor, Measure::Angle, worst, open)
    }

    /// `G(stand-on and collision possible -> course held until they no longer are)`.
    fn holds(&self) -> Finding {
        let mut worst: Option<(f64, f64)> = None;
        for stretch in self.stretches(|r| matches!(r, Role::StandOn | Role::Overtaken)) {
            let first = self.sights[stretch.from].own.pose.heading;
            for sight in &self.sights[stretch.from..stretch.until] {
                let turn = wrap(sight.own.pose.heading - first).abs();
                let robustness = self.t.score.hold - turn;
                if worst.is_none_or(|w| robustness < w.0) {
                    worst = Some((robustness, sight.time));
                }
            }
        }
        Self::finding("R6", Measure::Angle, worst, false)
    }

    /// `G(the hulls are apart)`.
    fn apart(&self) -> Finding {
        let mut worst = (f64::INFINITY, 0.0);
        for sight in self.sights {
            // negated on purpose: a NaN is the worst
            if !(sight.apart >= worst.0) {
                worst = (sight.apart, sight.time);
            }
        }
        Self::finding("S", Measure::Distance, Some(worst), false)
    }

    /// `G(the hulls would meet within the time to manoeuvre if both held on -> F that ends before they meet)`: an escape is in execution.
    fn leaves_extremis(&self) -> Finding {
        // negated on purpose: what is not known to be later is within
        let within = |s: &&Sight| !(s.meets_in > self.t.monitor.manoeuvre);
        let in_extremis = self.sights.iter().filter(within);
        let worst = in_extremis
            .map(|s| (s.meets_in, s.time))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        let finding = Self::finding("R1", Measure::Time, worst, false);
        let open = self.sights.last().is_some_and(|s| within(&s));
        match finding.verdict {
            Verdict::Satisfied if open => Finding {
                verdict: Verdict::Undecided,
                ..finding
            },
            _ => finding,
        }
    }

    fn finding(
        monitor: &'static str,
        measure: Measure,
        worst: Option<(f64, f64)>,
        open: bool,
    ) -> Finding {
        let verdict = match worst {
            None => Verdict::Idle,
            // touching is meeting: the sets are closed
            Some((r, _)) if r > 0.0 || (r == 0.0 && measure == Measure::Angle) => {
                Verdict::Satisfied
            }
            Some(_) if open => Verdict::Undecided,
            Some(_) => Verdict::Violated,
        };
        Finding {
            monitor,
            verdict,
            robustness: worst.map(|w| w.0),
            measure,
            time: worst.map(|w| w.1),
        }
    }
}

/// Every monitor over one meeting. O(sights).
pub fn monitors(meeting: &Meeting, t: &Thresholds) -> [Finding; 6] {
    let mut trace = Trace {
        sights: meeting.sights(),
        roles: Vec::new(),
        t,
        target_length: meeting.target_length(),
    };
    trace.roles = trace.sights.iter().map(|s| trace.role(s)).collect();
    [
        trace.apart(),
        trace.leaves_extremis(),
        trace.turns("R3", Role::GiveWay, false),
        trace.turns("R4", Role::HeadOn, false),
        trace.turns("R5", Role::Overtaking, true),
        trace.holds(),
    ]
}
