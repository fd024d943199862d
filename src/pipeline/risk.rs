//! The risk of a motion.

use crate::obstacle::{Obstacle, PeakRisk, SpaceTimeObstacle};
use crate::tolerance;
use crate::trajectory::Trajectory;

/// The largest risk along a trajectory.
///
/// The risk is 0 where the trajectory is nowhere deeper than [`tolerance::DEPTH_M`] in the set. A
/// set without velocity spread has risk 1 on its boundary, but touching is allowed. The risk is at
/// most `accepted`, in `[0, 1)`, where the trajectory is nowhere deeper than that in its level set.
pub fn peak_risk(set: &Obstacle, trajectory: &Trajectory, accepted: f64) -> PeakRisk {
    // a motion under forces is sampled, and the samples check the depth
    if trajectory.steered().is_some() {
        return set.peak_risk_along(trajectory);
    }
    let clear_of = |set: &Obstacle| !set.is_entered(trajectory.segments(), tolerance::DEPTH_M);
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
