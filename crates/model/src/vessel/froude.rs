//! A model scaled by Froude's law.

use nalgebra::{Matrix6, Matrix6x3};

use super::manoeuvring::{ForceVector, Manoeuvring, Scales, StateVector};

/// A ship that is `scale` times as long as its model.
///
/// Times and speeds grow with the square root of the scale, masses and forces with its cube (the
/// water density is equal), moments with its fourth power.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FroudeScaled<V> {
    model: V,
    state: StateVector,
    force: ForceVector,
    time: f64,
}

impl<V: Manoeuvring> FroudeScaled<V> {
    /// `scale` is positive: the ship's length over the model's.
    pub fn new(model: V, scale: f64) -> Self {
        let time = scale.sqrt();
        let speed = scale / time;
        let force = scale.powi(3);
        Self {
            model,
            state: StateVector::new(scale, scale, 1.0, speed, speed, 1.0 / time),
            force: ForceVector::new(force, force, force * scale),
            time,
        }
    }
}

impl<V: Manoeuvring> Manoeuvring for FroudeScaled<V> {
    fn rates(&self, state: &StateVector, force: &ForceVector) -> StateVector {
        self.model
            .rates(
                &state.component_div(&self.state),
                &force.component_div(&self.force),
            )
            .component_mul(&self.state)
            / self.time
    }

    fn jacobian(&self, state: &StateVector) -> Matrix6<f64> {
        let model = self.model.jacobian(&state.component_div(&self.state));
        Matrix6::from_fn(|i, j| model[(i, j)] * self.state[i] / (self.state[j] * self.time))
    }

    fn gain(&self) -> Matrix6x3<f64> {
        let model = self.model.gain();
        Matrix6x3::from_fn(|i, j| model[(i, j)] * self.state[i] / (self.force[j] * self.time))
    }

    fn curvature(&self, state: &StateVector, weights: &StateVector) -> Matrix6<f64> {
        let model = self.model.curvature(
            &state.component_div(&self.state),
            &weights.component_mul(&self.state),
        );
        // the product of the two units in one order for both halves: exactly symmetric
        Matrix6::from_fn(|i, j| model[(i, j)] / (self.state[i] * self.state[j] * self.time))
    }

    fn scales(&self) -> Scales {
        let model = self.model.scales();
        Scales {
            state: model.state.component_mul(&self.state),
            force: model.force.component_mul(&self.force),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::CyberShip2;
    use super::super::manoeuvring::contract;
    use super::*;

    #[test]
    fn derivatives_and_steady_forces_at_full_scale() {
        let ship = FroudeScaled::new(CyberShip2::SMOOTH, 70.0);
        contract::derivatives_match_differences(&ship);
        contract::steady_forces_hold_the_speed(&ship);
    }

    /// 25.8 kg at 1:70 are 8,849 t; times are 8.37 times as long.
    #[test]
    fn masses_grow_with_the_cube_and_a_manoeuvre_with_the_root() {
        let ship = FroudeScaled::new(CyberShip2::EXACT, 70.0);
        let pushed = ship.rates(&StateVector::zeros(), &ForceVector::new(1e6, 0.0, 0.0));
        assert!((1e6 / pushed[3] - 25.8 * 343e3).abs() < 1e-3);
        let rates = ship.jacobian(&StateVector::zeros())[(3, 3)];
        assert!((rates * 70.0_f64.sqrt() + 0.72 / 25.8).abs() < 1e-15);
    }
}
