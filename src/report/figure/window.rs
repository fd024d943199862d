//! Visible part of a panel's plane.

use crate::frame::Vector;
use crate::geometry::Window;

/// Bounding box of points, with a margin of `share` of its longer side. Without finite points, a
/// window of size 1 around the origin.
pub(super) fn window_around(points: impl IntoIterator<Item = Vector>, share: f64) -> Window {
    let points: Vec<Vector> = points.into_iter().collect();
    let finite = Window::around(&points).filter(|window| window.size().norm().is_finite());
    let window = finite.unwrap_or_else(|| Window::at(Vector::zeros()).grown(0.5));
    let side = window.size().max();
    window.grown(if side > 0.0 { share * side } else { 0.5 })
}

/// Widens a window about its centre until width over height is `ratio`.
pub(super) fn with_ratio(window: Window, ratio: f64) -> Window {
    let size = window.size();
    let half = Vector::new(size.x.max(size.y * ratio), size.y.max(size.x / ratio)) * 0.5;
    let middle = window.center();
    Window::new(middle - half, middle + half)
}
