//! The risk that a motion takes.

use crate::obstacle::{Obstacle, PeakRisk, SpaceTimeObstacle};
use crate::tolerance;
use crate::trajectory::Trajectory;

/// The largest risk along a trajectory. One that is nowhere deeper than [`tolerance::DEPTH_M`] in the set, which it may
/// touch, is at none: a set without spread is at risk 1 on its very boundary. For the same reason one that is nowhere
/// deeper in the set of the `accepted` risk, in `[0, 1)`, is at no more than that.
pub fn peak_risk(set: &Obstacle, trajectory: &Trajectory, accepted: f64) -> PeakRisk {
    // a motion under forces is looked at instant by instant, there the depth is asked for
    if trajectory.steered().is_some() {
        return set.peak_risk_along(trajectory);
    }
    let clear_of = |set: &Obstacle| {
        let enters = |s| set.first_contact(s, tolerance::DEPTH_M).is_some();
        !trajectory.segments().iter().any(enters)
    };
    if clear_of(set) {
        return PeakRisk {
            risk: 0.0,
            time: trajectory.start_time(),
        };
    }
    let peak = set.peak_risk_along(trajectory);
    if peak.risk > accepted && accepted > 0.0 && clear_of(&set.at_risk(accepted)) {
        return PeakRisk {
            risk: accepted,
            ..peak
        };
    }
    peak
}
