//! Optimal control task, and its conversion to stages.

use super::keep_out::KeepOut;
use super::reference::{LegSide, reference};
use super::solver::Vector;
use super::transcription::{Row, Span, Transcription, Weights};
use crate::ControlSettings;
use searoom_geometry::frame::{Pose, Vector as Place};
use searoom_model::trajectory::{DesiredTrajectory, ForceNode};
use searoom_model::vessel::{ForceVector, Manoeuvring, StateVector};

/// Fractions of every interval at which all sets are constrained from the start.
const BASE_FRACTIONS: [f64; 2] = [0.5, 1.0];

/// Cost weights and force limits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Controls {
    /// Force limits to either side of zero: newtons, newtons, newton metres.
    pub force_limits: ForceVector,
    /// Weights of the stage cost.
    pub weights: Weights,
}

impl From<&ControlSettings> for Controls {
    fn from(settings: &ControlSettings) -> Self {
        Self {
            force_limits: settings.force_limits,
            weights: Weights {
                state: settings.state_weights,
                force: settings.force_weights,
            },
        }
    }
}

/// Task from a state at a time on: stay near the desired trajectory and out of every set, at least
/// cost.
#[derive(Debug, Clone, Copy)]
pub struct Task<'a, V> {
    /// Ship model with smoothed damping.
    pub vessel: &'a V,
    /// Cost and limits.
    pub controls: Controls,
    /// Desired trajectory.
    pub desired: &'a DesiredTrajectory,
    /// Sets to keep out of.
    pub keep_outs: &'a [KeepOut],
    /// Initial state.
    pub first: StateVector,
    /// Duration, seconds.
    pub duration: f64,
    /// Number of intervals, at least one.
    pub intervals: usize,
}

/// States at the nodes and forces between them, SI.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    /// States, one more than intervals.
    pub states: Vec<StateVector>,
    /// Forces, one per interval.
    pub forces: Vec<ForceVector>,
}

impl<'a, V: Manoeuvring> Task<'a, V> {
    /// Length of one interval, seconds.
    pub fn step(&self) -> f64 {
        self.duration / self.intervals as f64
    }

    /// Time at the start of an interval; with the number of intervals, at the end.
    pub fn time(&self, interval: usize) -> f64 {
        self.duration * interval as f64 / self.intervals as f64
    }

    /// Stages with rows at the middle and end of every interval.
    #[doc(hidden)]
    pub fn transcription(&self) -> Transcription<'a, V> {
        let half = 0.5 * self.step();
        let spans = (0..self.intervals)
            .map(|k| Span {
                reference: [
                    reference(self.desired, self.time(k), LegSide::After),
                    reference(self.desired, self.time(k) + half, LegSide::After),
                    reference(self.desired, self.time(k + 1), LegSide::Before),
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

    /// Largest weight in the ship's own units, including time. Scaling by it makes ships of every
    /// size the same problem to the solver.
    fn cost_unit(&self) -> f64 {
        let (scales, weights) = (self.vessel.scales(), self.controls.weights);
        let time = scales.state[0] / scales.state[3];
        let state = weights.state.component_mul(&scales.state.map(|s| s * s));
        let force = weights.force.component_mul(&scales.force.map(|s| s * s));
        let most = state.amax().max(force.amax());
        if most > 0.0 { most * time } else { 1.0 }
    }

    /// Rows of an interval before any are added.
    pub(super) fn base_rows(&self, interval: usize) -> impl Iterator<Item = Row> + '_ {
        BASE_FRACTIONS.into_iter().flat_map(move |fraction| {
            (0..self.keep_outs.len()).map(move |i| self.row(interval, i, fraction))
        })
    }

    /// Row at a fraction of an interval.
    pub(super) fn row(&self, interval: usize, obstacle: usize, fraction: f64) -> Row {
        let time = self.time(interval) + fraction * self.step();
        Row::new(obstacle, fraction, self.keep_outs[obstacle].at(time))
    }

    /// Nodes of a motion; the last one has zero force.
    pub fn nodes(&self, states: &[StateVector], forces: &[ForceVector]) -> Vec<ForceNode> {
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

/// State at a node of a trajectory.
pub fn state(node: &ForceNode) -> StateVector {
    let (place, way) = (node.pose.position, node.velocity);
    StateVector::new(
        place.x,
        place.y,
        node.pose.heading,
        way.x,
        way.y,
        node.yaw_rate,
    )
}

/// Forces from a node of a trajectory on.
pub fn force(node: &ForceNode) -> ForceVector {
    ForceVector::new(node.force.x, node.force.y, node.moment)
}

/// State and forces as a node of a trajectory.
pub fn node(time: f64, state: &StateVector, force: &ForceVector) -> ForceNode {
    ForceNode {
        time,
        pose: Pose::new(Place::new(state[0], state[1]), state[2]),
        velocity: Place::new(state[3], state[4]),
        yaw_rate: state[5],
        force: Place::new(force[0], force[1]),
        moment: force[2],
    }
}
