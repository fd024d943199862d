//! Deviation of the ship from a plan, one interval at a time.

use super::task::Profile;
use searoom_model::vessel::Manoeuvring;

/// Steps of the integration per interval.
const STEPS: usize = 20;

/// Largest component of the deviation at the next node, in the ship's units, when the ship starts
/// at a node and applies its forces. Intervals are judged separately, because a directionally
/// unstable ship amplifies every error.
pub fn largest_defect<V: Manoeuvring>(vessel: &V, profile: &Profile, step: f64) -> f64 {
    let unit = vessel.scales().state;
    profile
        .states
        .windows(2)
        .zip(&profile.forces)
        .map(|(pair, force)| {
            let reached = vessel.integrated(&pair[0], force, step, STEPS);
            let off = (reached - pair[1]).component_div(&unit);
            // a maximum would lose a NaN
            if off.sum().is_finite() {
                off.amax()
            } else {
                f64::INFINITY
            }
        })
        .fold(0.0, f64::max)
}
