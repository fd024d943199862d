//! How far the ship is from where a plan says, one interval at a time.

use super::task::Profile;
use crate::vessel::{ForceVector, Manoeuvring, StateVector};

/// Steps of the classic Runge–Kutta method per interval.
const STEPS: usize = 20;

/// The largest component, in the ship's units, by which the ship is off the next node when she starts at each node with
/// its forces. Intervals are judged one by one: a directionally unstable ship forgets no error.
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
