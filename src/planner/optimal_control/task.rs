//! What one solve is asked, and how it becomes stages.

use super::keep_out::KeepOut;
use super::reference::{Side, reference};
use super::solver::Vector;
use super::transcription::{Row, Span, Transcription, Weights};
use crate::frame::{Pose, Vector as Place};
use crate::trajectory::{DesiredTrajectory, Node};
use crate::vessel::{ForceVector, Manoeuvring, StateVector};

/// Of the interval: where every set is kept out of before it is known where it is deepest.
const BASE_FRACTIONS: [f64; 2] = [0.5, 1.0];

/// How the cost weighs and what the forces may be.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Controls {
    /// To either side of zero: newtons, newtons, newton metres.
    pub force_limits: ForceVector,
    /// Of the stage cost.
    pub weights: Weights,
}

/// From a state at a time on: stay near the desired trajectory, out of every set, at least cost.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a, V> {
    /// The ship, smooth.
    pub vessel: &'a V,
    /// Cost and limits.
    pub controls: Controls,
    /// Where she is meant to be, and when.
    pub desired: &'a DesiredTrajectory,
    /// The sets.
    pub keep_outs: &'a [KeepOut],
    /// Where she is.
    pub first: StateVector,
    /// When that is, seconds on the clock of sets and desired trajectory.
    pub start_time: f64,
    /// Seconds.
    pub duration: f64,
    /// Of the duration, at least one.
    pub intervals: usize,
}

/// States at the nodes and forces between them, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// One more than intervals.
    pub states: Vec<StateVector>,
    /// Per interval.
    pub forces: Vec<ForceVector>,
}

impl<'a, V: Manoeuvring> Task<'a, V> {
    /// Seconds of one interval.
    pub fn step(&self) -> f64 {
        self.duration / self.intervals as f64
    }

    /// The time at the start of an interval, or at the end for the number of intervals.
    pub fn time(&self, interval: usize) -> f64 {
        self.start_time + self.duration * interval as f64 / self.intervals as f64
    }

    /// The stages, with rows at the middle and end of every interval.
    #[doc(hidden)]
    pub fn transcription(&self) -> Transcription<'a, V> {
        let half = 0.5 * self.step();
        let spans = (0..self.intervals)
            .map(|k| Span {
                reference: [
                    reference(self.desired, self.time(k), Side::After),
                    reference(self.desired, self.time(k) + half, Side::After),
                    reference(self.desired, self.time(k + 1), Side::Before),
                ],
            })
            .collect();
        let mut stages = Transcription::new(
            self.vessel,
            self.step(),
            self.first,
            self.controls,
            self.cost_unit(),
            spans,
        );
        for (k, rows) in stages.rows_mut().iter_mut().enumerate() {
            rows.extend(self.base_rows(k));
        }
        stages
    }

    /// The largest weight in the ship's own units, those of time included: ships of every size are one problem to the solver.
    fn cost_unit(&self) -> f64 {
        let (scales, weights) = (self.vessel.scales(), self.controls.weights);
        let time = scales.state[0] / scales.state[3];
        let state = weights.state.component_mul(&scales.state.map(|s| s * s));
        let force = weights.force.component_mul(&scales.force.map(|s| s * s));
        let most = state.amax().max(force.amax());
        if most > 0.0 { most * time } else { 1.0 }
    }

    /// The rows that an interval has from the start.
    pub(super) fn base_rows(&self, interval: usize) -> impl Iterator<Item = Row> + '_ {
        BASE_FRACTIONS.into_iter().flat_map(move |fraction| {
            (0..self.keep_outs.len()).map(move |i| self.row(interval, i, fraction))
        })
    }

    /// A row at a fraction of an interval.
    pub(super) fn row(&self, interval: usize, obstacle: usize, fraction: f64) -> Row {
        let time = self.time(interval) + fraction * self.step();
        Row::new(obstacle, fraction, self.keep_outs[obstacle].at(time))
    }

    /// The nodes of a motion; the last one holds no force.
    pub fn nodes(&self, states: &[StateVector], forces: &[ForceVector]) -> Vec<Node> {
        states
            .iter()
            .enumerate()
            .map(|(k, state)| {
                let force = forces.get(k).copied().unwrap_or_else(Vector::zeros);
                node(self.time(k), state, &force)
            })
            .collect()
    }
}

/// A state and forces as a node of a trajectory.
pub fn node(time: f64, state: &StateVector, force: &ForceVector) -> Node {
    Node {
        time,
        pose: Pose::new(Place::new(state[0], state[1]), state[2]),
        velocity: Place::new(state[3], state[4]),
        yaw_rate: state[5],
        force: Place::new(force[0], force[1]),
        moment: force[2],
    }
}
