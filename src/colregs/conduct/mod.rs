//! How own ship behaved toward a target: two judges that see trajectories alone.
//!
//! `score` computes the scores of the literature and names the rules that are broken; `monitor` reads the rules as formulas of
//! temporal logic. They share the sights of a [`Meeting`], the sectors of roles and the
//! thresholds, which differ from source to source and so are data (`thresholds.toml`). No formula is shared: they may disagree.

mod alteration;
mod latch;
mod meeting;
mod monitor;
mod score;
mod thresholds;
mod thresholds_file;

pub use latch::{RoleSpell, roles};
pub use meeting::Meeting;
pub(crate) use meeting::OwnTrack;
pub use monitor::{Finding, Measure, Verdict, monitors};
pub use score::{Scores, scores};
pub use thresholds::{MonitorLimits, RiskLimits, ScoreLimits, Thresholds};
pub use thresholds_file::{ThresholdsError, ThresholdsFault};

use crate::target::ShipTrack;

/// A rule that own ship breaks.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::colregs::conduct::{Breach, Thresholds};
///
/// let scenario = Scenario::read("scenarios/colregs/stand-on.toml".as_ref())?;
/// let run = pipeline::run(scenario);
/// let thresholds = Thresholds::standard().expect("the profile of the program");
/// let toward_the_ferry = run.conduct(thresholds).remove(0).expect("a plan among ships");
/// let breach: &Breach = &toward_the_ferry.breaches[0];
/// assert_eq!(breach.rule, "17(c)");
/// assert!(breach.what.contains("to port"));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Breach {
    /// Of the collision regulations: `14(a)`, `17(c)`, ...
    pub rule: &'static str,
    /// Seconds.
    pub time: f64,
    /// In words.
    pub what: String,
}

/// What both judges say.
///
/// # Examples
///
/// ```
/// use searoom::colregs::conduct::{Conduct, Meeting, Thresholds};
/// use searoom::scenario::Scenario;
/// use searoom::pipeline;
/// use searoom::study::compare;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let thresholds = Thresholds::standard().expect("the profile of the program");
/// let ferry = scenario.targets[0].ship().expect("a ship");
/// // whoever holds course and speed does not keep clear
/// let held = compare::hold_course(&scenario).trajectory;
/// let meeting = Meeting::along(&held, scenario.own_ship.hull, ferry);
/// let judged: Conduct = Conduct::judge(&meeting, thresholds);
/// assert!(!judged.complies() && judged.scores.least() < 0.1);
///
/// let run = pipeline::run(scenario);
/// let planned = run.conduct(thresholds).remove(0).expect("a plan");
/// assert!(planned.complies() && planned.scores.least() > judged.scores.least());
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Conduct {
    /// The roles of own ship over time; empty when there is no risk of collision.
    pub roles: Vec<RoleSpell>,
    /// In the first of them.
    pub scores: Scores,
    /// In the first of them, in order of time.
    pub breaches: Vec<Breach>,
    /// Over the whole of the meeting.
    pub findings: [Finding; 6],
}

impl Conduct {
    /// Of own ship in a meeting, by the numbers of a profile. A target in extremis, restricted visibility and lights are not
    /// judged. O(sights).
    pub fn judge(meeting: &Meeting, thresholds: &Thresholds) -> Self {
        let roles = roles(meeting, thresholds);
        let (scores, breaches) = match roles.first() {
            Some(first) => scores(meeting, first, thresholds),
            None => (score::safety(meeting, thresholds), Vec::new()),
        };
        Self {
            roles,
            scores,
            breaches,
            findings: monitors(meeting, thresholds),
        }
    }

    /// [`Conduct::judge`] of own ship along a track toward a target: of one that stays so far away that it has no role, by the nearest
    /// sight alone.
    pub(crate) fn along(track: &OwnTrack, target: &ShipTrack, thresholds: &Thresholds) -> Self {
        let (risk, monitor) = (&thresholds.risk, &thresholds.monitor);
        let length = track.hull().length.max(target.hull.length);
        let near = (risk.lengths * length).max(monitor.lengths * target.hull.length);
        let soon = risk.time.max(monitor.time).max(monitor.manoeuvre);
        let far = near + soon * track.closing(target);
        Self::judge(&track.meeting(target, far), thresholds)
    }

    /// True when neither judge finds a rule broken.
    pub fn complies(&self) -> bool {
        self.broken().next().is_none()
    }

    /// The rules that the first judge finds broken, and the monitors that the second finds violated, by their names; a rule may be there
    /// more than once.
    pub fn broken(&self) -> impl Iterator<Item = &'static str> {
        let violated = |f: &&Finding| f.verdict == Verdict::Violated;
        let monitors = self.findings.iter().filter(violated).map(|f| f.monitor);
        self.breaches.iter().map(|b| b.rule).chain(monitors)
    }
}

#[cfg(test)]
mod by_hand;
#[cfg(test)]
mod tests;
