//! What a method looks like, in figures and in recordings alike.

use super::Method;
use crate::planner::{PlannerKind, SearchKind};
use crate::target::Representation;

/// The line of a method. Any two differ in lightness, in width or in being dashed, so that they stay apart without colour; all are
/// seen on white and on the dark chart of a recording.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Look {
    /// `#rrggbb`.
    pub colour: &'static str,
    /// Pixels of a figure.
    pub width: f64,
    /// Broken: no planner made it.
    pub dashed: bool,
}

/// Pixels.
const THIN: f64 = 1.6;

/// Pixels. Own ship's planner of the paper.
const STRONG: f64 = 2.6;

/// Pixels. What often lies under another line is wide and pale.
const WIDE: f64 = 6.0;

impl Look {
    /// One for each method, whatever others there are.
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
    #[cfg(any(test, feature = "recording"))]
    pub fn rgb(&self) -> [u8; 3] {
        // a colour that cannot be read would be black: the tests read all of them
        [1, 3, 5].map(|at| {
            let digits = self.colour.get(at..at + 2).unwrap_or_default();
            u8::from_str_radix(digits, 16).unwrap_or_default()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all() -> Vec<Method> {
        let mut all = vec![Method::HoldCourse, Method::ConstantVelocity];
        for representation in [Representation::Polytope, Representation::Ellipsoid] {
            let planner = |kind, search| Method::Planner {
                kind,
                search,
                representation: Some(representation),
            };
            all.extend([
                planner(PlannerKind::SpaceTime, SearchKind::AStar),
                planner(PlannerKind::SpaceTime, SearchKind::Dijkstra),
                planner(PlannerKind::PathTime, SearchKind::AStar),
            ]);
        }
        all.push(Method::Planner {
            kind: PlannerKind::OptimalControl,
            search: SearchKind::AStar,
            representation: None,
        });
        all
    }

    /// Relative luminance, sRGB.
    fn luminance([r, g, b]: [u8; 3]) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 {
                c / 12.92
            } else {
                ((c + 0.055) / 1.055).powf(2.4)
            }
        };
        0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b)
    }

    /// CIE L*, 0 to 100.
    fn lightness(luminance: f64) -> f64 {
        116.0 * luminance.cbrt() - 16.0
    }

    #[test]
    fn two_lines_stay_apart_without_colour() {
        let all = all();
        for (i, a) in all.iter().enumerate() {
            for b in &all[..i] {
                let (x, y) = (Look::of(*a), Look::of(*b));
                let [l, m] = [x, y].map(|look| lightness(luminance(look.rgb())));
                let wider = (x.width / y.width).max(y.width / x.width);
                assert!(
                    x.dashed != y.dashed || wider > 1.5 || (l - m).abs() > 5.0,
                    "{a} and {b}: {x:?} {y:?}, lightness {l:.0} and {m:.0}"
                );
            }
        }
    }

    #[test]
    fn every_line_is_seen_on_white_and_on_the_dark_chart() {
        // the chart's background, with a little light
        let dark = luminance([11, 18, 32]);
        for method in all() {
            let look = Look::of(method);
            let here = luminance(look.rgb());
            let contrast = |a: f64, b: f64| (a.max(b) + 0.05) / (a.min(b) + 0.05);
            assert!(contrast(here, dark) > 3.0, "{method}: {look:?}");
            assert!(contrast(here, 1.0) > 1.5, "{method}: {look:?}");
        }
    }
}
