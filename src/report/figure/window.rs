//! Visible part of a panel's plane.

use crate::frame::Vector;

/// Rectangle in the units of the panel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlotWindow {
    /// Corner with the least coordinates.
    pub low: Vector,
    /// Corner with the greatest coordinates.
    pub high: Vector,
}

impl PlotWindow {
    /// The rectangle between two corners.
    pub fn new(low: Vector, high: Vector) -> Self {
        Self { low, high }
    }

    /// Bounding box of points, with a margin of `share` of its longer side. Without finite points,
    /// a window of size 1 around the origin.
    pub fn around(points: impl IntoIterator<Item = Vector>, share: f64) -> Self {
        let mut low = Vector::repeat(f64::INFINITY);
        let mut high = Vector::repeat(f64::NEG_INFINITY);
        for p in points {
            low = low.inf(&p);
            high = high.sup(&p);
        }
        if !((high - low).norm().is_finite()) {
            (low, high) = (Vector::repeat(-0.5), Vector::repeat(0.5));
        }
        let side = (high - low).max();
        let margin = Vector::repeat(if side > 0.0 { share * side } else { 0.5 });
        Self {
            low: low - margin,
            high: high + margin,
        }
    }

    /// Size, `high - low`.
    pub fn size(&self) -> Vector {
        self.high - self.low
    }

    /// True for a point inside the rectangle; false for NaN.
    pub fn contains(&self, p: Vector) -> bool {
        p.x >= self.low.x && p.x <= self.high.x && p.y >= self.low.y && p.y <= self.high.y
    }

    /// Widens the window about its centre until width over height is `ratio`.
    pub fn with_ratio(&self, ratio: f64) -> Self {
        let (middle, size) = ((self.low + self.high) * 0.5, self.size());
        let half = Vector::new(size.x.max(size.y * ratio), size.y.max(size.x / ratio)) * 0.5;
        Self {
            low: middle - half,
            high: middle + half,
        }
    }
}
