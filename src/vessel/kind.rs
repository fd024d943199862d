//! The ships whose models are in the tree, by their names in files.

use super::{CyberShip2, ForceVector, FroudeScaled, Manoeuvring, Scales, StateVector};

/// Her length over that of the model she was named after.
pub const FULL_SCALE: f64 = 70.0;

/// Metres, of CyberShip II.
const MODEL_LENGTH: f64 = 1.255;

/// Newtons, newtons, newton metres, of CyberShip II.
const MODEL_FORCE_LIMITS: ForceVector = ForceVector::new(2.0, 1.5, 1.5);

/// Weights of the stage cost for CyberShip II where a file names none: a metre off the way costs as much per second as
/// 0.7 N of each force; the heading is free.
const MODEL_STATE_WEIGHTS: StateVector = StateVector::new(0.05, 0.05, 0.0, 1.0, 1.0, 1.0);
const MODEL_FORCE_WEIGHTS: ForceVector = ForceVector::new(0.1, 0.1, 0.1);

/// A ship's forces stand for those of ships so many times longer or shorter, at most.
pub const ALIKE: f64 = 1.5;

/// A ship that can be planned for by her forces.
///
/// ```
/// use searoom::vessel::{CyberShip2, ForceVector, FroudeScaled, Manoeuvring, StateVector, VesselKind};
///
/// let model = CyberShip2::EXACT;
/// let full = FroudeScaled::new(CyberShip2::EXACT, 70.0);
/// assert_eq!(VesselKind::CyberShip2Full.length(), VesselKind::CyberShip2.length() * 70.0);
/// // at rest without force she stays
/// let rest = StateVector::zeros();
/// assert_eq!(model.rates(&rest, &ForceVector::zeros()), rest);
/// // Froude's law: seventy times the length, 70³ times the force at the same Froude number
/// let force = |ship: &dyn Manoeuvring, speed: f64| ship.steady(speed).x;
/// let ratio = force(&full, 0.2 * 70f64.sqrt()) / force(&model, 0.2);
/// assert!((ratio / 70f64.powi(3) - 1.0).abs() < 1e-6);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VesselKind {
    /// CyberShip II, 1.255 m long.
    CyberShip2,
    /// The ship that CyberShip II is a model of, at 70 times her size: 88 m long.
    CyberShip2Full,
}

impl VesselKind {
    /// All of them.
    pub const ALL: [Self; 2] = [Self::CyberShip2, Self::CyberShip2Full];

    /// The word for it in files.
    pub fn word(self) -> &'static str {
        match self {
            Self::CyberShip2 => "cybership2",
            Self::CyberShip2Full => "cybership2-full",
        }
    }

    /// Metres.
    pub fn length(self) -> f64 {
        match self {
            Self::CyberShip2 => MODEL_LENGTH,
            Self::CyberShip2Full => MODEL_LENGTH * FULL_SCALE,
        }
    }

    /// The model as published, not smoothed: what plans are judged with.
    pub fn exact(self) -> Box<dyn Manoeuvring> {
        match self {
            Self::CyberShip2 => Box::new(CyberShip2::EXACT),
            Self::CyberShip2Full => Box::new(FroudeScaled::new(CyberShip2::EXACT, FULL_SCALE)),
        }
    }

    /// True for a length, metres, that differs from hers by a factor of [`ALIKE`] at most: her forces may stand for those
    /// of a ship so long.
    pub fn is_alike(self, length: f64) -> bool {
        let [low, high] = self.lengths_alike();
        (low..=high).contains(&length)
    }

    /// The least and the greatest such length, metres.
    pub fn lengths_alike(self) -> [f64; 2] {
        [self.length() / ALIKE, self.length() * ALIKE]
    }

    /// The largest forces that she can make: newtons, newtons, newton metres.
    pub fn force_limits(self) -> ForceVector {
        MODEL_FORCE_LIMITS.component_mul(&self.units().force)
    }

    /// Weights of the stage cost for her states, per squared unit of [`StateVector`] and second: those of the model by
    /// Froude's law, so that both ships sail the same plan at their own size.
    pub fn state_weights(self) -> StateVector {
        let unit = self.units().state;
        MODEL_STATE_WEIGHTS.component_div(&unit.component_mul(&unit))
    }

    /// The same for her forces, per squared unit of [`ForceVector`] and second.
    pub fn force_weights(self) -> ForceVector {
        let unit = self.units().force;
        MODEL_FORCE_WEIGHTS.component_div(&unit.component_mul(&unit))
    }

    /// What is one of each component of the model's, for her.
    fn units(self) -> Scales {
        match self {
            Self::CyberShip2 => CyberShip2::EXACT.scales(),
            Self::CyberShip2Full => FroudeScaled::new(CyberShip2::EXACT, FULL_SCALE).scales(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stage_cost_of_the_same_plan_is_the_same_at_any_size() {
        let (model, full) = (VesselKind::CyberShip2, VesselKind::CyberShip2Full);
        let off = StateVector::new(0.3, -0.2, 0.1, 0.05, 0.02, -0.01);
        let force = ForceVector::new(1.2, -0.4, 0.7);
        let cost = |kind: VesselKind, off: StateVector, force: ForceVector| {
            off.component_mul(&off).dot(&kind.state_weights())
                + force.component_mul(&force).dot(&kind.force_weights())
        };
        let unit = full.units();
        let scaled = cost(
            full,
            off.component_mul(&unit.state),
            force.component_mul(&unit.force),
        );
        assert!((scaled / cost(model, off, force) - 1.0).abs() < 1e-12);
        // 70 times as long: metres count 4900 times less, newtons (70³)² times
        assert!((full.state_weights()[0] * 4900.0 / 0.05 - 1.0).abs() < 1e-12);
        assert!((full.force_weights()[0] * 343e3 * 343e3 / 0.1 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_ship_of_another_length_has_other_forces() {
        for kind in VesselKind::ALL {
            let length = kind.length();
            for (factor, alike) in [
                (1.0, true),
                (1.49, true),
                (0.67, true),
                (1.51, false),
                (0.66, false),
            ] {
                assert_eq!(kind.is_alike(factor * length), alike, "{factor}");
            }
            assert!(!kind.is_alike(f64::NAN));
        }
    }
}
