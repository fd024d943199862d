//! Own ship under the forces of its plan.

use super::own::NO_WAY;
use crate::colregs::SteadyShip;
use crate::frame::{Pose, Vector, heading_of};
use crate::planner::ControlSettings;
use crate::planner::optimal_control::{force, node, state};
use crate::trajectory::{ForceNode, Steered};
use crate::vessel::{ForceVector, OwnShip, StateVector};

/// Longest step of the integration, in the model's unit of time: a second at the length of the
/// model, whose shortest time constant is five.
const INTEGRATION_STEP: f64 = 0.02;

/// The planner's ship model without smoothing, integrated apart from the plan.
#[derive(Debug, Clone, Copy)]
pub(super) struct ForcedShip {
    control: ControlSettings,
    pub state: StateVector,
}

impl ForcedShip {
    pub fn new(control: ControlSettings, own: &OwnShip) -> Self {
        let velocity = Vector::new(own.speed, 0.0);
        let at_rest = node(0.0, &StateVector::zeros(), &ForceVector::zeros());
        let start = ForceNode {
            pose: own.pose,
            velocity,
            ..at_rest
        };
        Self {
            control,
            state: state(&start),
        }
    }

    fn node(&self, time: f64) -> ForceNode {
        node(time, &self.state, &ForceVector::zeros())
    }

    pub fn pose(&self) -> Pose {
        self.node(0.0).pose
    }

    /// Place, course and speed over ground.
    pub fn steady(&self) -> SteadyShip {
        let (mut pose, velocity) = (self.pose(), self.node(0.0).ground_velocity());
        if velocity.norm() > NO_WAY {
            pose.heading = heading_of(velocity);
        }
        SteadyShip::new(pose, velocity.norm())
    }

    /// Straight ahead for `duration` seconds, under the forces that hold the present speed.
    pub fn held(&self, duration: f64) -> Option<Steered> {
        let vessel = self.control.vessel.exact(self.control.length);
        let (begun, force) = (self.node(0.0), vessel.steady(self.state[3]));
        let mut ended = self.state;
        let way = begun.ground_velocity() * duration;
        (ended[0], ended[1]) = (ended[0] + way.x, ended[1] + way.y);
        let nodes = [(0.0, &self.state), (duration, &ended)];
        Steered::new(
            nodes
                .map(|(time, state)| node(time, state, &force))
                .to_vec(),
        )
        .ok()
    }

    /// Applies the forces that a plan has from `time` on, for `step` seconds. O(nodes of the plan).
    pub fn advance(&mut self, plan: &Steered, time: f64, step: f64) {
        let vessel = self.control.vessel.exact(self.control.length);
        let unit = vessel.scales().state;
        let longest = INTEGRATION_STEP * unit[0] / unit[3];
        for pair in plan.nodes().windows(2) {
            let from = pair[0].time.max(time);
            let duration = pair[1].time.min(time + step) - from;
            if duration > 0.0 {
                let steps = (duration / longest).ceil() as usize;
                self.state = vessel.integrated(&self.state, &force(&pair[0]), duration, steps);
            }
        }
    }
}
