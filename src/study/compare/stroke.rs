//! Strokes of curves; each method has the same one in figures and recordings.

use super::Method;
use crate::target::Representation;

/// Stroke of a curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stroke {
    /// Colour as `#rrggbb`.
    pub colour: &'static str,
    /// Width in pixels of a figure.
    pub width: f64,
    /// True for a dashed curve.
    pub dashed: bool,
}

/// Width in pixels.
const THIN: f64 = 1.6;

/// Width in pixels.
const STRONG: f64 = 2.6;

/// Width in pixels of a pale line that is often covered by another one.
const WIDE: f64 = 6.0;

/// Colours and widths of the planners' methods, in the order of [`Method::of_planners`]; a longer
/// list of methods starts again.
const STYLES: [(&str, f64); 9] = [
    ("#0072b2", STRONG),
    ("#56b4e9", WIDE),
    ("#12ad81", THIN),
    ("#a6dba0", WIDE),
    ("#d55e00", THIN),
    ("#e69f00", THIN),
    ("#e29ac3", STRONG),
    ("#b9b227", STRONG),
    ("#7a5195", WIDE),
];

impl Stroke {
    /// Creates a continuous stroke with its width in pixels.
    pub const fn solid(colour: &'static str, width: f64) -> Self {
        Self {
            colour,
            width,
            dashed: false,
        }
    }

    /// Creates a dashed stroke with its width in pixels.
    pub const fn dashed(colour: &'static str, width: f64) -> Self {
        Self {
            dashed: true,
            ..Self::solid(colour, width)
        }
    }

    /// Returns the stroke of a method, independent of the other methods shown; baselines are
    /// dashed. Any two differ in lightness, width or dashes, so they are distinguishable without
    /// colour. All are visible on white and on the dark chart of a recording.
    pub fn of(method: Method) -> Self {
        match method {
            Method::Planner { .. } => {
                let all = Method::of_planners(&[None, Some(Representation::Ellipsoid)]);
                let same = |known: &Method| known.to_string() == method.to_string();
                let index = all.iter().position(same).unwrap_or_default();
                let (colour, width) = STYLES[index % STYLES.len()];
                Self::solid(colour, width)
            }
            Method::HoldCourse => Self::dashed("#cc5de8", THIN),
            Method::ConstantVelocity => Self::dashed("#8c6d31", THIN),
        }
    }

    /// Colour as red, green and blue.
    #[cfg(feature = "recording")]
    pub fn rgb(&self) -> [u8; 3] {
        [1, 3, 5].map(|at| {
            let digits = self.colour.get(at..at + 2).unwrap_or_default();
            u8::from_str_radix(digits, 16).unwrap_or_default()
        })
    }
}
