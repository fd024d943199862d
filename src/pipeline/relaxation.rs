//! What a plan gave up of what was asked.

use super::sets::TargetSets;
use crate::colregs::Role;
use crate::obstacle::{PeakRisk, SpaceTimeObstacle};

/// What a plan gave up.
#[derive(Debug, Clone, PartialEq)]
pub enum Relaxation {
    /// A shape was drawn back toward its hard set.
    Domain {
        /// Name of the target.
        target: String,
        /// Metres, the largest cut.
        amount: f64,
    },
    /// The plan enters the set of a target.
    Risk {
        /// Name of the target.
        target: String,
        /// The largest risk along the plan, eq. (25), in `(0, 1]`.
        amount: f64,
        /// Seconds: of this target's set nothing is claimed before, and from then on the plan is clear of the whole
        /// set. `None` where the plan is clear of the level set of the accepted risk all along.
        until: Option<f64>,
    },
    /// The plan does not arrive before the horizon.
    Arrival {
        /// Name of the target whose set is in the way.
        target: String,
        /// Metres of the way that are left at the horizon.
        amount: f64,
    },
    /// The plan does not keep to the rules.
    Compliance {
        /// Name of a target that asks something of own ship.
        target: String,
        /// Her role toward it.
        role: Role,
    },
}

/// What was given up of the sets, most important first: risks, the greatest first, then arrival, then shapes, the largest cut first.
pub(super) fn relaxations(
    sets: &[TargetSets],
    cuts: &[f64],
    risks: &[PeakRisk],
    released: &[Option<f64>],
    late: Option<Relaxation>,
) -> Vec<Relaxation> {
    let mut taken: Vec<(&TargetSets, f64, Option<f64>)> = (sets.iter())
        .zip(risks)
        .zip(released)
        .map(|((set, peak), until)| (set, peak.risk, *until))
        .filter(|(_, risk, until)| *risk > 0.0 || until.is_some())
        .collect();
    taken.sort_by(|a, b| b.1.total_cmp(&a.1));
    let mut drawn: Vec<(&TargetSets, f64)> = (sets.iter().zip(cuts.iter().copied()))
        .filter(|(_, cut)| *cut > 0.0)
        .collect();
    drawn.sort_by(|a, b| b.1.total_cmp(&a.1));
    let name = |set: &TargetSets| set.hard.name().to_owned();
    let risked = taken
        .into_iter()
        .map(|(set, amount, until)| Relaxation::Risk {
            target: name(set),
            amount,
            until,
        });
    let cut = drawn.into_iter().map(|(set, amount)| Relaxation::Domain {
        target: name(set),
        amount,
    });
    risked.chain(late).chain(cut).collect()
}
