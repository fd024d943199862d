//! The start from the last plan, for a controller that plans again as the ship moves.

use super::reference::{LegSide, reference};
use super::task::{Profile, Task, force, state};
use searoom_model::trajectory::Steered;
use searoom_model::vessel::{Manoeuvring, StateVector};

/// Start of the next plan: own ship's state, and the plan that it follows.
#[derive(Debug, Clone, PartialEq)]
pub struct WarmStart {
    /// Own ship's state at t = 0.
    pub state: StateVector,
    /// The last plan, in the clock of the new one.
    pub plan: Steered,
}

impl WarmStart {
    /// The last plan on the grid of a task. After its end it moves as the desired trajectory does.
    pub(super) fn profile<V: Manoeuvring>(&self, task: &Task<V>) -> Profile {
        let nodes = self.plan.nodes();
        let end = nodes[nodes.len() - 1].time;
        let desired = |time| reference(task.desired, time, LegSide::Before);
        let at = |time: f64| {
            let held = time.min(end);
            let mut planned = state(&self.plan.piece_at(held).node_at(held));
            let way = desired(time.max(end)) - desired(end);
            planned[0] += way[0];
            planned[1] += way[1];
            planned
        };
        let middle = |k: usize| task.time(k) + 0.5 * task.step();
        Profile {
            states: std::iter::once(task.first)
                .chain((1..=task.intervals).map(|k| at(task.time(k))))
                .collect(),
            forces: (0..task.intervals)
                .map(|k| force(self.plan.node_at(middle(k).min(end).next_down())))
                .collect(),
        }
    }
}
