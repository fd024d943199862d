//! The built-in ship models, by their names in files.

use super::{CyberShip2, ForceVector, FroudeScaled, Manoeuvring, Scales, StateVector};

/// Length of CyberShip II, metres.
const MODEL_LENGTH: f64 = 1.255;

/// Force limits of CyberShip II: newtons, newtons, newton metres.
const MODEL_FORCE_LIMITS: ForceVector = ForceVector::new(2.0, 1.5, 1.5);

/// Default stage-cost weights for CyberShip II.
///
/// A metre off the path costs as much per second as 0.7 N of each force; the heading has no cost.
const MODEL_STATE_WEIGHTS: StateVector = StateVector::new(0.05, 0.05, 0.0, 1.0, 1.0, 1.0);
const MODEL_FORCE_WEIGHTS: ForceVector = ForceVector::new(0.1, 0.1, 0.1);

/// A manoeuvring model. Froude's law scales it to a ship of any length.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum VesselKind {
    /// CyberShip II, 1.255 m long.
    CyberShip2,
}

impl VesselKind {
    /// All models.
    pub const ALL: [Self; 1] = [Self::CyberShip2];

    /// Words for a model in files. The second one names the full-size ship of CyberShip II, the
    /// same ship by Froude's law.
    pub const WORDS: [(&'static str, Self); 2] = [
        ("cybership2", Self::CyberShip2),
        ("cybership2-full", Self::CyberShip2),
    ];

    /// The word in documents.
    pub fn word(self) -> &'static str {
        match self {
            Self::CyberShip2 => "cybership2",
        }
    }

    /// Length of the model, metres.
    pub fn length(self) -> f64 {
        match self {
            Self::CyberShip2 => MODEL_LENGTH,
        }
    }

    /// The unsmoothed published model for a ship of this length, metres, with which plans are
    /// checked.
    pub fn exact(self, length: f64) -> Box<dyn Manoeuvring> {
        match self {
            Self::CyberShip2 => Box::new(CyberShip2::EXACT.at_length(length)),
        }
    }

    /// Force limits of a ship of this length: newtons, newtons, newton metres.
    pub fn force_limits(self, length: f64) -> ForceVector {
        MODEL_FORCE_LIMITS.component_mul(&self.units(length).force)
    }

    /// Stage-cost weights of the states for a ship of this length, per squared unit of
    /// [`StateVector`] and second.
    ///
    /// Scaled by Froude's law, so that ships of every size follow the same plan.
    pub fn state_weights(self, length: f64) -> StateVector {
        let unit = self.units(length).state;
        MODEL_STATE_WEIGHTS.component_div(&unit.component_mul(&unit))
    }

    /// Stage-cost weights of the forces, per squared unit of [`ForceVector`] and second.
    pub fn force_weights(self, length: f64) -> ForceVector {
        let unit = self.units(length).force;
        MODEL_FORCE_WEIGHTS.component_div(&unit.component_mul(&unit))
    }

    /// Units of the model's components for a ship of this length.
    fn units(self, length: f64) -> Scales {
        self.exact(length).scales()
    }
}

impl CyberShip2 {
    /// The model scaled to a length in metres.
    pub fn at_length(self, length: f64) -> FroudeScaled<Self> {
        FroudeScaled::new(self, length / MODEL_LENGTH)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stage_cost_of_the_same_plan_is_the_same_at_any_size() {
        let vessel = VesselKind::CyberShip2;
        let (model, full) = (MODEL_LENGTH, 70.0 * MODEL_LENGTH);
        let off = StateVector::new(0.3, -0.2, 0.1, 0.05, 0.02, -0.01);
        let force = ForceVector::new(1.2, -0.4, 0.7);
        let cost = |length: f64, off: StateVector, force: ForceVector| {
            off.component_mul(&off).dot(&vessel.state_weights(length))
                + force
                    .component_mul(&force)
                    .dot(&vessel.force_weights(length))
        };
        let unit = vessel.units(full);
        let scaled = cost(
            full,
            off.component_mul(&unit.state),
            force.component_mul(&unit.force),
        );
        assert!((scaled / cost(model, off, force) - 1.0).abs() < 1e-12);
        // 70 times as long: metres count 4900 times less, newtons (70³)² times
        assert!((vessel.state_weights(full)[0] * 4900.0 / 0.05 - 1.0).abs() < 1e-12);
        assert!((vessel.force_weights(full)[0] * 343e3 * 343e3 / 0.1 - 1.0).abs() < 1e-12);
        let limits = vessel.force_limits(full);
        assert!((limits[0] / (2.0 * 343e3) - 1.0).abs() < 1e-12);
        assert!((limits[2] / (1.5 * 343e3 * 70.0) - 1.0).abs() < 1e-12);
    }
}
