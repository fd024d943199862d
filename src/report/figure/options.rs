//! Options of a figure: its size, its resolution and the times on its chart.

use super::panel::AREA;
use super::{Figure, FigureError};

/// Pixels of a millimetre, as in CSS.
const PIXELS_PER_MM: f64 = 96.0 / 25.4;

/// Smallest area between the axes in pixels that a size may leave.
const LEAST_AREA: [f64; 2] = [150.0, 110.0];

/// Size, resolution and marked times of a figure.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FigureOptions {
    /// Width and height in millimetres; by default as much as the panels need.
    pub size_mm: Option<[f64; 2]>,
    /// Resolution of PNG in dots per inch; 192 by default.
    pub dpi: Option<f64>,
    /// Times in seconds at which the charts mark all ships; round times by default.
    pub times: Vec<f64>,
}

/// What a chart depends on besides its content.
#[derive(Debug, Clone)]
pub(in crate::report) struct Style {
    /// Size of the area between the axes in pixels.
    pub area: [f64; 2],
    /// Times to mark; round times if empty.
    pub times: Vec<f64>,
}

impl Default for Style {
    fn default() -> Self {
        Self {
            area: AREA,
            times: Vec::new(),
        }
    }
}

impl FigureOptions {
    /// Draws a figure at its size, with times from 0 to `end` seconds. The heights of the legends
    /// are known once the panels are made, so panels of another size are made twice.
    pub(super) fn draw(
        &self,
        end: f64,
        make: impl Fn(&Style) -> Figure,
    ) -> Result<Figure, FigureError> {
        // negated so that a NaN is refused
        if let Some(found) = self.times.iter().find(|t| !(**t >= 0.0 && **t <= end)) {
            // never beyond the end
            let end = (end * 10.0).floor() / 10.0;
            return Err(FigureError::Time { found: *found, end });
        }
        let mut style = Style {
            times: self.times.clone(),
            ..Style::default()
        };
        style.times.sort_by(f64::total_cmp);
        style.times.dedup();
        let figure = make(&style).with_dpi(self.dpi);
        let Some(size) = self.size_mm else {
            return Ok(figure);
        };
        let pixels = size.map(|mm| mm * PIXELS_PER_MM);
        let [columns, rows] = figure.grid().map(|count| count as f64);
        let [width, height] = figure.pixels();
        let frame = [width - columns * AREA[0], height - rows * AREA[1]];
        style.area = [
            (pixels[0] - frame[0]) / columns,
            (pixels[1] - frame[1]) / rows,
        ];
        if style.area[0] < LEAST_AREA[0] || style.area[1] < LEAST_AREA[1] {
            let least = [
                frame[0] + columns * LEAST_AREA[0],
                frame[1] + rows * LEAST_AREA[1],
            ];
            let least = least.map(|pixels| (pixels / PIXELS_PER_MM).ceil());
            return Err(FigureError::Size { found: size, least });
        }
        Ok(make(&style)
            .with_dpi(self.dpi)
            .with_size(style.area, pixels))
    }
}
