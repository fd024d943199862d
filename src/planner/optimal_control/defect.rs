//! Deviation of the ship from a plan, one interval at a time.

use super::task::Profile;
use crate::vessel::{ForceVector, Manoeuvring, StateVector};

/// Steps of the classic Runge–Kutta method per interval.
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
            let off = (integrated(vessel, &pair[0], force, step) - pair[1]).component_div(&unit);
            // a maximum would lose a NaN
            if off.sum().is_finite() {
                off.amax()
            } else {
                f64::INFINITY
            }
        })
        .fold(0.0, f64::max)
}

fn integrated<V: Manoeuvring>(
    vessel: &V,
    from: &StateVector,
    force: &ForceVector,
    duration: f64,
) -> StateVector {
    let h = duration / STEPS as f64;
    let mut x = *from;
    for _ in 0..STEPS {
        let a = vessel.rates(&x, force);
        let b = vessel.rates(&(x + 0.5 * h * a), force);
        let c = vessel.rates(&(x + 0.5 * h * b), force);
        let d = vessel.rates(&(x + h * c), force);
        x += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    x
}
