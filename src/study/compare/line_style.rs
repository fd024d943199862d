//! Line style of each method in figures and recordings.

use super::Method;
use crate::target::Representation;

/// Line style of a method. Any two styles differ in lightness, width or dashes, so they are
/// distinguishable without colour. All are visible on white and on the dark chart of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineStyle {
    /// Colour as `#rrggbb`.
    pub colour: &'static str,
    /// Width in pixels of a figure.
    pub width: f64,
    /// True for baselines.
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

impl LineStyle {
    /// Returns the style of a method, independent of the other methods shown.
    pub fn of(method: Method) -> Self {
        let (colour, width) = match method {
            Method::Planner { .. } => {
                let all = Method::of_planners(&[None, Some(Representation::Ellipsoid)]);
                let same = |known: &Method| known.to_string() == method.to_string();
                STYLES[all.iter().position(same).unwrap_or_default() % STYLES.len()]
            }
            Method::HoldCourse => ("#cc5de8", THIN),
            Method::ConstantVelocity => ("#8c6d31", THIN),
        };
        Self {
            colour,
            width,
            dashed: !matches!(method, Method::Planner { .. }),
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
