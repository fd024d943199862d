//! Options of a figure: its size, its resolution and the times on its chart.

use super::panel::{AREA, is_small};
use super::{Figure, FigureError};

/// Pixels of a millimetre, as in CSS.
const PIXELS_PER_MM: f64 = 96.0 / 25.4;

/// Smallest area between the axes in pixels that a size may leave.
const LEAST_AREA: [f64; 2] = [100.0, 70.0];

/// Least width in millimetres of a figure with titles; captions of papers say what they would.
const TITLED_MM: f64 = 150.0;

/// Size, resolution and marked times of a figure.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FigureOptions {
    /// Width and height in millimetres; by default as much as the panels need.
    pub size_mm: Option<[f64; 2]>,
    /// Resolution of PNG in dots per inch; 192 by default.
    pub dpi: Option<f64>,
    /// Times in seconds at which the charts mark all ships; round times by default.
    pub times: Vec<f64>,
    /// One chart per time instead of one with all times.
    pub panels: bool,
}

/// Settings of a chart.
#[derive(Debug, Clone)]
pub(in crate::report) struct Style {
    /// Size of the area between the axes in pixels.
    pub area: [f64; 2],
    /// Times to mark; round times if empty.
    pub times: Vec<f64>,
    /// One chart per time.
    pub panels: bool,
}

impl Style {
    /// True for an area without room for details.
    pub fn is_small(&self) -> bool {
        is_small(self.area)
    }
}

impl Default for Style {
    fn default() -> Self {
        Self {
            area: AREA,
            times: Vec::new(),
            panels: false,
        }
    }
}

impl FigureOptions {
    /// Draws a figure at its size, with times from 0 to `end` seconds. Legends and details depend
    /// on the area that they leave, so panels of another size are made again.
    pub(super) fn draw(
        &self,
        end: f64,
        make: impl Fn(&Style) -> Figure,
    ) -> Result<Figure, FigureError> {
        // texts round the end to a tenth; negated so that a NaN is refused
        let last = (end * 10.0).round() / 10.0;
        if let Some(found) = (self.times.iter()).find(|t| !(**t >= 0.0 && **t <= end.max(last))) {
            return Err(FigureError::Time {
                found: *found,
                end: last,
            });
        }
        let mut style = Style {
            times: self.times.iter().map(|time| time.min(end)).collect(),
            panels: self.panels,
            ..Style::default()
        };
        style.times.sort_by(f64::total_cmp);
        style.times.dedup();
        let narrow = self.size_mm.is_some_and(|[width, _]| width < TITLED_MM);
        let make = |style: &Style| {
            let figure = make(style).with_dpi(self.dpi);
            if narrow { figure.untitled() } else { figure }
        };
        let Some(size) = self.size_mm else {
            return Ok(make(&style));
        };
        let pixels = size.map(|mm| mm * PIXELS_PER_MM);
        let most = make(&style).grid()[0];
        let arranged = (1..=most).rev().map(|columns| {
            let mut style = style.clone();
            let mut least = [0.0; 2];
            let mut found = LEAST_AREA;
            for _ in 0..2 {
                let figure = make(&style).in_columns(columns).sized(style.area);
                let (grid, frame) = (figure.grid().map(|count| count as f64), figure.frame());
                let area = |size: [f64; 2], i: usize| {
                    let legend = [0.0, figure.legend_height(size[0])];
                    (size[i] - frame[i] - legend[i]) / grid[i]
                };
                least = [0, 1].map(|i| frame[i] + grid[i] * LEAST_AREA[i]);
                least[1] += figure.legend_height(least[0]);
                found = [0, 1].map(|i| area(pixels, i));
                style.area = [0, 1].map(|i| found[i].max(LEAST_AREA[i]));
            }
            let room = (found[0] / LEAST_AREA[0]).min(found[1] / LEAST_AREA[1]);
            let least = least.map(|pixels| (pixels / PIXELS_PER_MM).ceil());
            (room, columns, style, least)
        });
        // the arrangement with the largest panels
        let arranged: Vec<_> = arranged.collect();
        let best = arranged.iter().max_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, columns, style, _)) = best.filter(|(room, ..)| *room >= 1.0) else {
            let mut least: Vec<_> = arranged.iter().map(|(.., least)| *least).collect();
            least.dedup();
            return Err(FigureError::Size { found: size, least });
        };
        Ok(make(style)
            .in_columns(*columns)
            .with_size(style.area, pixels))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_may_be_the_end_as_it_is_printed() {
        let draws = |time, end| {
            let options = FigureOptions {
                times: vec![time],
                ..FigureOptions::default()
            };
            let make = |style: &Style| {
                assert!(style.times[0] <= end);
                Figure::new(1, Vec::new())
            };
            options.draw(end, make).is_ok()
        };
        assert!(draws(1557.4, 1557.38) && draws(1557.41, 1557.412));
        assert!(!draws(1557.41, 1557.38) && !draws(-0.1, 9.0) && !draws(f64::NAN, 9.0));
    }
}
