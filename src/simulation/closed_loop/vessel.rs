//! Own ship's true motion under orders of course, turn rate and speed.

use crate::frame::{Pose, Vector, wrap};
use crate::scenario::VesselModel;
use crate::vessel::OwnShip;

/// Longest step of the integration, seconds: a sixtieth of the default time constant of the turn
/// rate.
const INTEGRATION_STEP: f64 = 0.05;

/// m/s. The manoeuvring of a slower ship is that at this speed: the time constant of Nomoto's model
/// is infinite at rest.
const STEERAGE_WAY: f64 = 0.5;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct VesselState {
    pub pose: Pose,
    /// Speed through the water, m/s.
    pub speed: f64,
    /// rad/s, to port positive.
    pub turn_rate: f64,
    /// Radians, a turn to port positive.
    pub rudder: f64,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Order {
    /// Radians.
    pub heading: f64,
    /// Turn rate on the planned path, rad/s.
    pub turn_rate: f64,
    /// Speed through the water, m/s.
    pub speed: f64,
}

#[derive(Debug, Clone, Copy)]
pub(super) struct Vessel {
    pub model: VesselModel,
    pub length: f64,
    pub turning_radius: f64,
}

impl Vessel {
    pub fn new(model: VesselModel, own: &OwnShip) -> Self {
        Self {
            model,
            length: own.hull.length,
            turning_radius: own.turning_radius,
        }
    }

    /// Smallest radius of a steady turn, metres.
    pub fn least_radius(&self) -> f64 {
        match self.model {
            VesselModel::Kinematic | VesselModel::FirstOrder { .. } => self.turning_radius,
            VesselModel::Nomoto { gain, rudder, .. } => self.length / (gain * rudder),
        }
    }

    /// Seconds by which the ship answers late to an order of turn rate at a speed.
    pub fn lag(&self, speed: f64) -> f64 {
        match self.model {
            VesselModel::Kinematic => 0.0,
            VesselModel::FirstOrder { course_time, .. } => course_time,
            VesselModel::Nomoto { time, .. } => time * self.length / speed.max(STEERAGE_WAY),
        }
    }

    /// Seconds by which the ship answers late to an order of speed.
    pub fn speed_lag(&self) -> f64 {
        match self.model {
            VesselModel::Kinematic => 0.0,
            VesselModel::FirstOrder { speed_time, .. } | VesselModel::Nomoto { speed_time, .. } => {
                speed_time
            }
        }
    }

    /// Moves the ship under constant orders in a current (m/s) for `step` seconds.
    pub fn advance(&self, state: &mut VesselState, order: &Order, current: Vector, step: f64) {
        let count = (step / INTEGRATION_STEP).ceil().max(1.0);
        let dt = step / count;
        for _ in 0..count as usize {
            let before = *state;
            self.respond(state, order, dt);
            let turn = dt * 0.5 * (before.turn_rate + state.turn_rate);
            let middle = Pose::new(before.pose.position, before.pose.heading + 0.5 * turn);
            let speed = 0.5 * (before.speed + state.speed);
            state.pose.position += (middle.ahead() * speed + current) * dt;
            state.pose.heading = before.pose.heading + turn;
        }
    }

    /// Changes rudder, turn rate and speed over a short time.
    fn respond(&self, state: &mut VesselState, order: &Order, dt: f64) {
        let off = wrap(order.heading - state.pose.heading);
        let approach = |value: f64, wanted: f64, time: f64| {
            wanted + (value - wanted) * (-dt / time.max(1e-9)).exp()
        };
        match self.model {
            VesselModel::Kinematic | VesselModel::FirstOrder { .. } => {
                let course_time = self.lag(state.speed);
                let fastest = state.speed / self.turning_radius;
                // a quarter of the bandwidth of the turn rate, which does not overshoot
                let wanted = order.turn_rate + off / (4.0 * course_time).max(1.0);
                let wanted = wanted.clamp(-fastest, fastest);
                state.turn_rate = approach(state.turn_rate, wanted, course_time);
            }
            VesselModel::Nomoto {
                gain,
                time,
                rudder,
                rudder_rate,
                ..
            } => {
                let way = state.speed.max(STEERAGE_WAY);
                let (gain, time) = (gain * way / self.length, time * self.length / way);
                // poles of the turn: -0.38/time and -2.62/time
                let frequency = 1.0 / time;
                let wanted = order.turn_rate
                    + time
                        * (frequency * frequency * off
                            + 2.0 * frequency * (order.turn_rate - state.turn_rate));
                let wanted = (wanted / gain).clamp(-rudder, rudder);
                let moved = (wanted - state.rudder).clamp(-rudder_rate * dt, rudder_rate * dt);
                state.rudder += moved;
                state.turn_rate = approach(state.turn_rate, gain * state.rudder, time);
            }
        }
        state.speed = approach(state.speed, order.speed, self.speed_lag());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const NOMOTO: VesselModel = VesselModel::Nomoto {
        gain: 1.0,
        time: 1.0,
        rudder: 0.6,
        rudder_rate: 0.1,
        speed_time: 5.0,
    };
    const FIRST_ORDER: VesselModel = VesselModel::FirstOrder {
        course_time: 3.0,
        speed_time: 5.0,
    };

    fn vessel(model: VesselModel) -> Vessel {
        Vessel {
            model,
            length: 30.0,
            turning_radius: 100.0,
        }
    }

    fn order(heading: f64, turn_rate: f64, speed: f64) -> Order {
        Order {
            heading,
            turn_rate,
            speed,
        }
    }

    fn at_rest_on_course() -> VesselState {
        VesselState {
            pose: Pose::new(Vector::zeros(), 0.3),
            speed: 5.0,
            turn_rate: 0.0,
            rudder: 0.0,
        }
    }

    #[test]
    fn every_model_reaches_an_ordered_course_and_speed_and_drifts_with_the_current() {
        for model in [VesselModel::Kinematic, FIRST_ORDER, NOMOTO] {
            let vessel = vessel(model);
            let mut state = at_rest_on_course();
            let order = order(1.3, 0.0, 4.0);
            for _ in 0..400 {
                vessel.advance(&mut state, &order, Vector::zeros(), 0.5);
            }
            assert!((state.pose.heading - 1.3).abs() < 1e-3, "{state:?}");
            assert!((state.speed - 4.0).abs() < 1e-9 && state.turn_rate.abs() < 1e-4);
            let before = state.pose;
            let current = Vector::new(0.5, -1.0);
            vessel.advance(&mut state, &order, current, 0.5);
            let moved = (state.pose.position - before.position) / 0.5;
            assert!((moved - before.ahead() * 4.0 - current).norm() < 1e-2);
        }
    }

    /// The turn rate of Nomoto's model after a step of the rudder is `K rudder (1 - exp(-t / T))`.
    #[test]
    fn the_rudder_is_limited_and_a_hard_turn_has_the_radius_of_the_model() {
        let vessel = vessel(NOMOTO);
        let mut state = at_rest_on_course();
        let hard = order(3.0, 1.0, 5.0);
        vessel.advance(&mut state, &hard, Vector::zeros(), 1.0);
        assert!((state.rudder - 0.1).abs() < 1e-9, "{state:?}");
        for _ in 0..10 {
            vessel.advance(&mut state, &hard, Vector::zeros(), 1.0);
            assert!(state.rudder <= 0.6 && state.turn_rate <= 0.1 + 1e-9);
        }
        state.rudder = 0.6;
        state.turn_rate = 0.0;
        let time = 6.0; // T' L / U
        vessel.advance(&mut state, &hard, Vector::zeros(), time);
        let expected = 0.1 * (1.0 - (-1.0_f64).exp());
        let off = (state.turn_rate - expected).abs();
        assert!(off < 1e-6, "{state:?} {expected}");
        assert!((vessel.least_radius() - 50.0).abs() < 1e-9);
    }

    #[test]
    fn a_first_order_ship_does_not_turn_faster_than_its_radius_allows() {
        let vessel = vessel(FIRST_ORDER);
        let mut state = at_rest_on_course();
        let hard = order(3.0, 0.0, 5.0);
        for _ in 0..20 {
            vessel.advance(&mut state, &hard, Vector::zeros(), 0.5);
            assert!(state.turn_rate <= 0.05 + 1e-12);
        }
    }
}
