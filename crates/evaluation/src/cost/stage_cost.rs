//! Stage cost of a motion under forces, computed from its states and forces alone.

use crate::steered::{Steering, force, state};
use searoom_geometry::frame::{heading_of, wrap};
use searoom_geometry::tolerance;
use searoom_model::trajectory::DesiredTrajectory;
use searoom_model::vessel::{ForceVector, StateVector};

/// Diagonals of the stage cost `(x - r)' Q (x - r) + tau' R tau`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageWeights {
    /// Diagonal of `Q`, per squared unit of [`StateVector`] and second.
    pub state: StateVector,
    /// Diagonal of `R`, per squared unit of [`ForceVector`] and second.
    pub force: ForceVector,
}

/// Integral of the stage cost by Simpson's rule over every interval.
///
/// The state at half time is on the cubic through both nodes, with the vessel's rates there. The
/// definition is that of the planner; the code is separate and uses the published vessel model.
/// O(nodes). The sum is less accurate in an interval within which a leg ends.
///
/// If a leg ends at a node or halfway between two, rounding decides which leg counts there. The
/// three results are for leg ends as given, and shifted by a rounding later and earlier.
pub fn stage_costs(
    steering: &Steering,
    desired: &DesiredTrajectory,
    weights: &StageWeights,
) -> [f64; 3] {
    let rounding = tolerance::LEG_END * (1.0 + desired.duration());
    [[0.0, 0.0], [rounding, rounding], [rounding, -rounding]]
        .map(|late| summed(steering, desired, weights, late))
}

/// Stage cost with shifted leg ends. `late` is the shift in seconds, one value for nodes and one
/// for half times. At the start of an interval the shift is subtracted.
fn summed(
    steering: &Steering,
    desired: &DesiredTrajectory,
    weights: &StageWeights,
    [at_nodes, halfway]: [f64; 2],
) -> f64 {
    let nodes = steering.motion.nodes();
    let mut sum = 0.0;
    for pair in nodes.windows(2) {
        let (x, y, u) = (state(&pair[0]), state(&pair[1]), force(&pair[0]));
        let duration = pair[1].time - pair[0].time;
        let bend = steering.vessel.rates(&x, &u) - steering.vessel.rates(&y, &u);
        let middle = 0.5 * (x + y) + 0.125 * duration * bend;
        let off = |at: &StateVector, time: f64, moment: Moment, late: f64| {
            let mut off = at - wanted(desired, time, moment, late);
            off[2] = wrap(off[2]);
            (0..6)
                .map(|i| weights.state[i] * off[i] * off[i])
                .sum::<f64>()
        };
        let driven: f64 = (0..3).map(|i| weights.force[i] * u[i] * u[i]).sum();
        let half = pair[0].time + 0.5 * duration;
        let ends = off(&x, pair[0].time, Moment::Later, -at_nodes)
            + off(&y, pair[1].time, Moment::Earlier, at_nodes);
        let middle = off(&middle, half, Moment::Later, halfway);
        sum += duration * ((ends + 4.0 * middle) / 6.0 + driven);
    }
    sum
}

/// Selects the leg that counts at the instant between two legs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Moment {
    Earlier,
    Later,
}

/// Reference state: on the current leg at its course and speed, or at rest at the end after the
/// last leg.
fn wanted(desired: &DesiredTrajectory, time: f64, moment: Moment, late: f64) -> StateVector {
    let legs = desired.legs();
    let under_way = legs.iter().position(|leg| match moment {
        Moment::Earlier => time <= leg.end_time() + late,
        Moment::Later => time < leg.end_time() + late,
    });
    let leg = &legs[under_way.unwrap_or(legs.len() - 1)];
    let speed = under_way.map_or(0.0, |index| legs[index].speed);
    let place = desired.position_at(time);
    StateVector::new(place.x, place.y, heading_of(leg.direction), speed, 0.0, 0.0)
}
