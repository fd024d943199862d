//! The line style of a method, in figures and in recordings.

use super::Method;
use crate::planner::{PlannerKind, SearchKind};
use crate::target::Representation;

/// The line of a method. Any two differ in lightness, in width or in dashes, so that they stay
/// apart without colour. All are visible on white and on the dark chart of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LineStyle {
    /// `#rrggbb`.
    pub colour: &'static str,
    /// Pixels of a figure.
    pub width: f64,
    /// For baselines.
    pub dashed: bool,
}

/// Pixels.
const THIN: f64 = 1.6;

/// Pixels.
const STRONG: f64 = 2.6;

/// Pixels. A line that often lies under another one is wide and pale.
const WIDE: f64 = 6.0;

impl LineStyle {
    /// The same for each method, whatever others are shown.
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

    /// True for a line that often lies under another.
    #[cfg(feature = "recording")]
    pub fn is_wide(&self) -> bool {
        self.width >= WIDE
    }

    /// Red, green and blue.
    #[cfg(feature = "recording")]
    pub fn rgb(&self) -> [u8; 3] {
        [1, 3, 5].map(|at| {
            let digits = self.colour.get(at..at + 2).unwrap_or_default();
            u8::from_str_radix(digits, 16).unwrap_or_default()
        })
    }
}
