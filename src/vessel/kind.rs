//! The ships whose models are in the tree, by their names in files.

use super::{CyberShip2, ForceVector, FroudeScaled, Manoeuvring};

/// Her length over that of the model she was named after.
pub const FULL_SCALE: f64 = 70.0;

/// Metres, of CyberShip II.
const MODEL_LENGTH: f64 = 1.255;

/// A ship that can be planned for by her forces.
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

    /// The largest forces that she can make: newtons, newtons, newton metres.
    pub fn force_limits(self) -> ForceVector {
        let model = ForceVector::new(2.0, 1.5, 1.5);
        match self {
            Self::CyberShip2 => model,
            Self::CyberShip2Full => {
                let unit = FroudeScaled::new(CyberShip2::EXACT, FULL_SCALE)
                    .scales()
                    .force;
                model.component_mul(&unit)
            }
        }
    }
}
