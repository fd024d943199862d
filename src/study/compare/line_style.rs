//! Line style of each method in figures and recordings.

use super::Method;
use crate::planner::{PlannerKind, SearchKind};
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

impl LineStyle {
    /// Returns the style of a method, independent of the other methods shown.
    pub fn of(method: Method) -> Self {
        let (colour, width, dashed) = match method {
            Method::Planner {
                kind,
                search,
                representation,
            } => {
                let ellipsoid = representation == Some(Representation::Ellipsoid);
                match (kind, search) {
                    (PlannerKind::SpaceTime, SearchKind::AStar) if ellipsoid => {
                        ("#12ad81", THIN, false)
                    }
                    (PlannerKind::SpaceTime, SearchKind::AStar) => ("#0072b2", STRONG, false),
                    (PlannerKind::SpaceTime, SearchKind::Dijkstra) if ellipsoid => {
                        ("#a6dba0", WIDE, false)
                    }
                    (PlannerKind::SpaceTime, SearchKind::Dijkstra) => ("#56b4e9", WIDE, false),
                    (PlannerKind::PathTime, _) if ellipsoid => ("#e69f00", THIN, false),
                    (PlannerKind::PathTime, _) => ("#d55e00", THIN, false),
                    (PlannerKind::OptimalControl, _) => ("#e29ac3", STRONG, false),
                }
            }
            Method::HoldCourse => ("#cc5de8", THIN, true),
            Method::ConstantVelocity => ("#8c6d31", THIN, true),
        };
        Self {
            colour,
            width,
            dashed,
        }
    }

    /// True for a line that is often covered by another one.
    #[cfg(feature = "recording")]
    pub fn is_wide(&self) -> bool {
        self.width >= WIDE
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
