//! CyberShip II, a supply ship at 1:70: the model of the paper's appendix with the sign of its
//! rates corrected.

use nalgebra::{Matrix3, Matrix6, Matrix6x3, Vector3};

use super::manoeuvring::{ForceVector, Manoeuvring, Scales, StateVector, kinematics};

/// Inertia with added mass: kg, kg, kg m, kg m².
const M11: f64 = 25.8;
const M22: f64 = 33.8;
const M23: f64 = 1.0115;
const M33: f64 = 2.76;

/// Damping: linear in surge, sway and yaw rate, and quadratic.
const SURGE: f64 = 0.72;
const SURGE_SQUARE: f64 = 1.33;
const SWAY: f64 = 0.86;
const SWAY_SQUARE: f64 = 36.28;
const SWAY_BY_YAW: f64 = -0.11;
const YAW_BY_SWAY: f64 = -0.11;
const YAW_BY_SWAY_SQUARE: f64 = -5.04;
const YAW: f64 = 0.5;

/// Speed below which the smoothed model rounds the kink of `|speed|`, m/s. The deviation is at most
/// 1.5e-5 N, a micrometre in two seconds.
const ROUNDED_MPS: f64 = 1e-3;

/// The model `M v' = tau - C(v) v - D(v) v`, docs/reference/theory.md section 9.
///
/// The printed rates have the opposite sign, with which damping adds energy. The model is unstable
/// on a straight course at transit speed: without control, a heading error grows a millionfold in
/// 100 s. Length 1.255 m; forces within 2 N in surge, 1.5 N in sway, 1.5 Nm in yaw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CyberShip2 {
    rounded: f64,
}

impl CyberShip2 {
    /// The published model. Its damping has kinks in the second derivative at rest.
    pub const EXACT: Self = Self { rounded: 0.0 };

    /// With `sqrt(speed² + (1 mm/s)²)` for `|speed|`: twice differentiable everywhere.
    pub const SMOOTH: Self = Self {
        rounded: ROUNDED_MPS,
    };

    fn inverse_inertia() -> Matrix3<f64> {
        let determinant = M22 * M33 - M23 * M23;
        Matrix3::new(
            1.0 / M11,
            0.0,
            0.0,
            0.0,
            M33 / determinant,
            -M23 / determinant,
            0.0,
            -M23 / determinant,
            M22 / determinant,
        )
    }

    /// `|speed| speed` and its first two derivatives.
    fn square(&self, speed: f64) -> [f64; 3] {
        if self.rounded == 0.0 {
            let sign = if speed == 0.0 { 0.0 } else { speed.signum() };
            return [speed * speed.abs(), 2.0 * speed.abs(), 2.0 * sign];
        }
        let square = speed * speed;
        let root = (square + self.rounded * self.rounded).sqrt();
        [
            speed * root,
            root + square / root,
            speed * (3.0 - square / (root * root)) / root,
        ]
    }
}

impl Manoeuvring for CyberShip2 {
    fn rates(&self, state: &StateVector, force: &ForceVector) -> StateVector {
        let [east, north, turn] = kinematics(state);
        let (u, v, r) = (state[3], state[4], state[5]);
        let ([uu, ..], [vv, ..]) = (self.square(u), self.square(v));
        let momentum = M22 * v + M23 * r;
        let net = Vector3::new(
            force[0] + momentum * r - SURGE * u - SURGE_SQUARE * uu,
            force[1] - M11 * u * r - SWAY * v - SWAY_SQUARE * vv - SWAY_BY_YAW * r,
            force[2] - momentum * u + M11 * u * v
                - YAW_BY_SWAY * v
                - YAW_BY_SWAY_SQUARE * vv
                - YAW * r,
        );
        let gained = Self::inverse_inertia() * net;
        StateVector::new(east, north, turn, gained[0], gained[1], gained[2])
    }

    fn jacobian(&self, state: &StateVector) -> Matrix6<f64> {
        let (sin, cos) = state[2].sin_cos();
        let (u, v, r) = (state[3], state[4], state[5]);
        let ([_, du, _], [_, dv, _]) = (self.square(u), self.square(v));
        let net = Matrix3::new(
            -SURGE - SURGE_SQUARE * du,
            M22 * r,
            M22 * v + 2.0 * M23 * r,
            -M11 * r,
            -SWAY - SWAY_SQUARE * dv,
            -M11 * u - SWAY_BY_YAW,
            -(M22 - M11) * v - M23 * r,
            -(M22 - M11) * u - YAW_BY_SWAY - YAW_BY_SWAY_SQUARE * dv,
            -M23 * u - YAW,
        );
        let mut jacobian = Matrix6::zeros();
        jacobian[(0, 2)] = -u * sin - v * cos;
        jacobian[(0, 3)] = cos;
        jacobian[(0, 4)] = -sin;
        jacobian[(1, 2)] = u * cos - v * sin;
        jacobian[(1, 3)] = sin;
        jacobian[(1, 4)] = cos;
        jacobian[(2, 5)] = 1.0;
        jacobian
            .fixed_view_mut::<3, 3>(3, 3)
            .copy_from(&(Self::inverse_inertia() * net));
        jacobian
    }

    fn gain(&self) -> Matrix6x3<f64> {
        let mut gain = Matrix6x3::zeros();
        gain.fixed_view_mut::<3, 3>(3, 0)
            .copy_from(&Self::inverse_inertia());
        gain
    }

    fn curvature(&self, state: &StateVector, weights: &StateVector) -> Matrix6<f64> {
        let (sin, cos) = state[2].sin_cos();
        let (u, v) = (state[3], state[4]);
        let ([_, _, ddu], [_, _, ddv]) = (self.square(u), self.square(v));
        // the inertia is symmetric, so its inverse may weigh the forces
        let w = Self::inverse_inertia() * weights.fixed_rows::<3>(3);
        let (east, north) = (weights[0], weights[1]);
        let mut bend = Matrix6::zeros();
        let mut set = |i: usize, j: usize, value: f64| {
            bend[(i, j)] = value;
            bend[(j, i)] = value;
        };
        set(
            2,
            2,
            -east * (u * cos - v * sin) - north * (u * sin + v * cos),
        );
        set(2, 3, north * cos - east * sin);
        set(2, 4, -east * cos - north * sin);
        set(3, 3, -SURGE_SQUARE * ddu * w[0]);
        set(3, 4, -(M22 - M11) * w[2]);
        set(3, 5, -M11 * w[1] - M23 * w[2]);
        set(
            4,
            4,
            -(SWAY_SQUARE * w[1] + YAW_BY_SWAY_SQUARE * w[2]) * ddv,
        );
        set(4, 5, M22 * w[0]);
        set(5, 5, 2.0 * M23 * w[0]);
        bend
    }

    /// All one: the model's SI values are of that order.
    fn scales(&self) -> Scales {
        Scales {
            state: StateVector::repeat(1.0),
            force: ForceVector::repeat(1.0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::manoeuvring::contract;
    use super::*;

    #[test]
    fn derivatives_and_steady_forces() {
        for ship in [CyberShip2::EXACT, CyberShip2::SMOOTH] {
            contract::derivatives_match_differences(&ship);
            contract::steady_forces_hold_the_speed(&ship);
        }
    }

    /// The matrices of the appendix, written out; the Coriolis forces do no work.
    #[test]
    fn the_rates_are_those_of_the_matrices() {
        let inertia = Matrix3::new(25.8, 0.0, 0.0, 0.0, 33.8, 1.0115, 0.0, 1.0115, 2.76);
        for i in 0..50 {
            let wave = |k: f64| (f64::from(i) * k).sin();
            let state = StateVector::new(3.0, 4.0, wave(0.3), wave(0.7), wave(1.1), wave(1.9));
            let force = Vector3::new(wave(2.3), wave(0.2), wave(0.9));
            let (u, v, r) = (state[3], state[4], state[5]);
            let velocity = Vector3::new(u, v, r);
            let side = 33.8 * v + 1.0115 * r;
            let coriolis = Matrix3::new(0.0, 0.0, -side, 0.0, 0.0, 25.8 * u, side, -25.8 * u, 0.0);
            let damping = Matrix3::new(
                0.72 + 1.33 * u.abs(),
                0.0,
                0.0,
                0.0,
                0.86 + 36.28 * v.abs(),
                -0.11,
                0.0,
                -0.11 - 5.04 * v.abs(),
                0.5,
            );
            let gained = inertia.try_inverse().expect("regular")
                * (force - coriolis * velocity - damping * velocity);
            let rates = CyberShip2::EXACT.rates(&state, &force);
            assert!((rates.fixed_rows::<3>(3) - gained).amax() < 1e-13);
            assert!((velocity.transpose() * coriolis * velocity)[0].abs() < 1e-13);
        }
    }

    #[test]
    fn smoothing_moves_the_rates_by_less_than_a_micrometre_per_second_squared() {
        for i in -300..300 {
            let speed = 1e-5 * f64::from(i);
            let state = StateVector::new(0.0, 0.0, 0.0, speed, -speed, 0.0);
            let force = ForceVector::zeros();
            let off =
                CyberShip2::EXACT.rates(&state, &force) - CyberShip2::SMOOTH.rates(&state, &force);
            assert!(off.amax() < 2e-6, "{off}");
        }
    }
}
