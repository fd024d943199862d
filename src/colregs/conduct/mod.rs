//! How own ship behaved toward a target: two judges that see trajectories alone.
//!
//! `score` computes the scores of the literature and names the rules that are broken; `monitor` reads the rules as formulas of
//! temporal logic. They share the sights of a [`Meeting`] and no more, and may disagree: thresholds differ from source to
//! source, so these are data (`thresholds.toml`).

mod alteration;
mod latch;
mod meeting;
mod monitor;
mod score;
mod thresholds;

pub use alteration::{Alteration, alterations};
pub use latch::{RoleSpell, roles};
pub use meeting::{Ahead, Meeting, Sight};
pub use monitor::{Finding, Measure, Verdict, monitors};
pub use score::{Scores, scores};
pub use thresholds::{MonitorLimits, RiskLimits, ScoreLimits, Thresholds};

/// A rule that own ship breaks.
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
#[derive(Debug, Clone, PartialEq)]
pub struct Conduct {
    /// The roles of own ship over time; empty when there is no risk of collision.
    pub roles: Vec<RoleSpell>,
    /// In the first of them.
    pub scores: Scores,
    /// In the first of them, in order of time.
    pub breaches: Vec<Breach>,
    /// Over the whole of the meeting.
    pub findings: [Finding; 5],
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

    /// True when neither judge finds a rule broken.
    pub fn complies(&self) -> bool {
        let broken = |f: &Finding| f.verdict == Verdict::Violated;
        self.breaches.is_empty() && !self.findings.iter().any(broken)
    }
}

#[cfg(test)]
mod tests;
