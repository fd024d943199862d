//! The interface of a manoeuvring model: three degrees of freedom in the plane.

use nalgebra::{Matrix3, Matrix6, Matrix6x3, Vector3, Vector6};

/// Position east and north, metres; heading, radians counter-clockwise from east; surge ahead and
/// sway to port, m/s; yaw rate, rad/s counter-clockwise.
pub type StateVector = Vector6<f64>;

/// Surge ahead and sway to port, newtons; yaw moment counter-clockwise, newton metres.
pub type ForceVector = Vector3<f64>;

/// Units in which the components of a ship's states and forces are of order one, for solvers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// In the units of [`StateVector`].
    pub state: StateVector,
    /// In the units of [`ForceVector`].
    pub force: ForceVector,
}

/// A ship that moves by forces: `state' = drift(state) + gain force`, twice differentiable and
/// independent of position and time.
///
/// The derivatives of every implementor are checked against differences.
///
/// ```
/// use searoom_model::vessel::{ForceVector, Manoeuvring, StateVector, VesselKind};
///
/// /// Seconds until a ship at rest has half the speed that a force holds, by steps of 0.1 s.
/// fn seconds_to_half(ship: &dyn Manoeuvring, speed: f64) -> f64 {
///     let force: ForceVector = ship.steady(speed);
///     let (mut state, mut time) = (StateVector::zeros(), 0.0);
///     while state[3] < speed / 2.0 {
///         state += ship.rates(&state, &force) * 0.1;
///         time += 0.1;
///     }
///     time
/// }
///
/// let model = seconds_to_half(VesselKind::CyberShip2.exact(1.255).as_ref(), 0.2);
/// assert!((1.0..60.0).contains(&model), "{model}");
/// ```
pub trait Manoeuvring: std::fmt::Debug + Sync {
    /// The time derivative of the state. O(1).
    fn rates(&self, state: &StateVector, force: &ForceVector) -> StateVector;

    /// The derivative of the rates with respect to the state, independent of the forces.
    fn jacobian(&self, state: &StateVector) -> Matrix6<f64>;

    /// The derivative of the rates with respect to the forces, a constant.
    fn gain(&self) -> Matrix6x3<f64>;

    /// The second derivative of `weights . rates` with respect to the state, symmetric.
    fn curvature(&self, state: &StateVector, weights: &StateVector) -> Matrix6<f64>;

    /// The forces that hold a steady surge speed (m/s) without sway or yaw.
    fn steady(&self, surge: f64) -> ForceVector {
        let state = StateVector::new(0.0, 0.0, 0.0, surge, 0.0, 0.0);
        let drift = self.rates(&state, &ForceVector::zeros());
        let gain = self.gain().fixed_rows::<3>(3).into_owned();
        let inverse = gain.try_inverse().unwrap_or_else(Matrix3::zeros);
        -(inverse * drift.fixed_rows::<3>(3))
    }

    /// Units in which the model's numbers are of order one.
    fn scales(&self) -> Scales;

    /// The state after `duration` seconds under a constant force, by `steps` steps of the classic
    /// Runge–Kutta method.
    fn integrated(
        &self,
        from: &StateVector,
        force: &ForceVector,
        duration: f64,
        steps: usize,
    ) -> StateVector {
        let h = duration / steps as f64;
        let mut x = *from;
        for _ in 0..steps {
            let a = self.rates(&x, force);
            let b = self.rates(&(x + 0.5 * h * a), force);
            let c = self.rates(&(x + 0.5 * h * b), force);
            let d = self.rates(&(x + h * c), force);
            x += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        }
        x
    }
}

/// `J(heading) velocity`: the rates of position and heading, for every ship.
pub(super) fn kinematics(state: &StateVector) -> [f64; 3] {
    let (sin, cos) = state[2].sin_cos();
    [
        state[3] * cos - state[4] * sin,
        state[3] * sin + state[4] * cos,
        state[5],
    ]
}

#[cfg(test)]
pub(super) mod contract {
    //! Tests that hold for every implementor.

    use super::*;

    /// States and forces over the ship's operating range, in its own units. No speed is near zero,
    /// where there may be a kink.
    fn cases(ship: &impl Manoeuvring) -> Vec<(StateVector, ForceVector)> {
        let Scales { state, force } = ship.scales();
        (0..40)
            .map(|i| {
                let wave = |k: f64| (f64::from(i) * k + k).sin();
                let speed = |k: f64| 0.05_f64.copysign(wave(k)) + 0.4 * wave(k);
                let x = StateVector::new(
                    9.0 * wave(0.3),
                    7.0 * wave(0.7),
                    3.0 * wave(1.1),
                    speed(1.3),
                    0.3 * speed(1.7),
                    speed(0.9),
                );
                let u = ForceVector::new(wave(2.1), wave(0.4), wave(3.3));
                (x.component_mul(&state), u.component_mul(&force))
            })
            .collect()
    }

    /// First and second derivatives against central differences, relative to the ship's units.
    pub fn derivatives_match_differences(ship: &impl Manoeuvring) {
        let Scales {
            state: unit,
            force: unit_force,
        } = ship.scales();
        let step = 1e-5;
        for (x, u) in cases(ship) {
            let weights = StateVector::from_fn(|i, _| 1.0 - 0.3 * i as f64).component_div(&unit);
            let (jacobian, curvature) = (ship.jacobian(&x), ship.curvature(&x, &weights));
            for j in 0..6 {
                let mut by = StateVector::zeros();
                by[j] = step * unit[j];
                let slope = (ship.rates(&(x + by), &u) - ship.rates(&(x - by), &u)) / (2.0 * by[j]);
                let bend = (ship.jacobian(&(x + by)) - ship.jacobian(&(x - by))) / (2.0 * by[j]);
                let bend = bend.transpose() * weights;
                for i in 0..6 {
                    let off = (jacobian[(i, j)] - slope[i]) * unit[j] / unit[i];
                    assert!(off.abs() < 1e-8, "rate {i} by {j}: {off:e}");
                    let off = (curvature[(i, j)] - bend[i]) * unit[i] * unit[j];
                    assert!(off.abs() < 1e-7, "curvature {i} {j}: {off:e}");
                    assert_eq!(curvature[(i, j)], curvature[(j, i)]);
                }
            }
            let more = ship.rates(&x, &(u + unit_force)) - ship.rates(&x, &u);
            let off = (more - ship.gain() * unit_force).component_div(&unit);
            assert!(off.amax() < 1e-12, "gain: {off}");
        }
    }

    /// Steady forces hold the speed, and at rest none are needed.
    pub fn steady_forces_hold_the_speed(ship: &impl Manoeuvring) {
        let unit = ship.scales().state;
        for share in [0.0, 0.1, 0.3, 0.7] {
            let surge = share * unit[3];
            let state = StateVector::new(0.0, 0.0, 0.4, surge, 0.0, 0.0);
            let rates = ship.rates(&state, &ship.steady(surge));
            for i in 3..6 {
                assert!(rates[i].abs() < 1e-12 * unit[i], "{rates}");
            }
            assert!((rates[0].hypot(rates[1]) - surge).abs() < 1e-12 * unit[3]);
        }
    }
}
