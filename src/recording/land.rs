//! Land: its outlines on the chart, its surface under the space-time volume.

use rerun::{LineStrips2D, LineStrips3D, Mesh3D, RecordingStream, RecordingStreamResult};

use super::scene::{Bounds, Scene, flat};
use super::{MAP, VOLUME, path, style};
use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Polygon, Window};

/// Of the sea that is shown, how much more is drawn: the views are wider than the sea is high.
const BEYOND: f64 = 0.6;

/// Nothing without land.
pub fn log_land(rec: &RecordingStream, scene: &Scene) -> RecordingStreamResult<()> {
    let Some(land) = &scene.run.scenario.land else {
        return Ok(());
    };
    let Bounds { low, high } = scene.bounds.grown(BEYOND * scene.bounds.extent());
    let rings = land.map.polygons().iter().flat_map(Polygon::rings);
    let outlines: Vec<Vec<Vector>> = rings
        .map(|ring| ring.iter().chain(&ring[..1]).copied().collect())
        .collect();
    let strips = outlines.iter().map(|o| o.iter().map(|p| flat(*p)));
    rec.log_static(
        path(&[MAP, "land"]),
        &LineStrips2D::new(strips.map(Vec::from_iter))
            .with_colors([style::land()])
            .with_radii([style::points(1.2)]),
    )?;

    let shown = scene.bounds;
    let window = Window {
        low: shown.low,
        high: shown.high,
    };
    let mut corners: Vec<[f32; 3]> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for piece in land.map.pieces_within(&window) {
        let clipped = clipped(piece, &window);
        let base = corners.len() as u32;
        corners.extend(clipped.iter().map(|p| scene.lifted(*p, 0.0)));
        triangles.extend((2..clipped.len() as u32).map(|i| [base, base + i - 1, base + i]));
    }
    if triangles.is_empty() {
        return Ok(());
    }
    let up = vec![[0.0, 0.0, 1.0]; corners.len()];
    let surface = Mesh3D::new(corners)
        .with_vertex_normals(up)
        .with_triangle_indices(triangles)
        .with_albedo_factor(style::land().0);
    let near = |p: &Vector| p.x > low.x && p.x < high.x && p.y > low.y && p.y < high.y;
    let shores = outlines
        .iter()
        .flat_map(|o| o.windows(2))
        .filter(|edge| edge.iter().all(near))
        .map(|edge| [edge[0], edge[1]].map(|p| scene.lifted(p, 0.0)));
    let shores = LineStrips3D::new(shores)
        .with_colors([style::land()])
        .with_radii([style::points(0.8)]);
    let parts: [&dyn rerun::AsComponents; 2] = [&surface, &shores];
    rec.log_static(path(&[VOLUME, "land"]), &parts)
}

/// The part of a piece within a window, counter-clockwise: cut side by side (Sutherland & Hodgman).
fn clipped(piece: &ConvexPolygon, window: &Window) -> Vec<Vector> {
    let sides = [
        (Vector::new(1.0, 0.0), window.high.x),
        (Vector::new(-1.0, 0.0), -window.low.x),
        (Vector::new(0.0, 1.0), window.high.y),
        (Vector::new(0.0, -1.0), -window.low.y),
    ];
    let mut kept = piece.vertices().to_vec();
    for (normal, limit) in sides {
        let beyond = |p: &Vector| normal.dot(p) - limit;
        let mut next = Vec::with_capacity(kept.len() + 1);
        for (i, a) in kept.iter().enumerate() {
            let b = &kept[(i + 1) % kept.len()];
            let (fa, fb) = (beyond(a), beyond(b));
            if fa <= 0.0 {
                next.push(*a);
            }
            if (fa <= 0.0) != (fb <= 0.0) {
                next.push(a + (b - a) * (fa / (fa - fb)));
            }
        }
        kept = next;
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_piece_is_cut_at_the_edges_of_what_is_shown() {
        let at = |x: f64, y: f64| Vector::new(x, y);
        let window = Window {
            low: at(0.0, 0.0),
            high: at(10.0, 10.0),
        };
        let hull = |points: &[Vector]| ConvexPolygon::hull(points).expect("finite");
        let across = hull(&[at(5.0, 5.0), at(15.0, 5.0), at(15.0, 15.0), at(5.0, 15.0)]);
        let area = |points: &[Vector]| hull(points).area();
        assert!((area(&clipped(&across, &window)) - 25.0).abs() < 1e-9);
        let around = hull(&[at(-50.0, -50.0), at(50.0, -50.0), at(0.0, 90.0)]);
        assert!((area(&clipped(&around, &window)) - 100.0).abs() < 1e-9);
        let beside = hull(&[at(20.0, 0.0), at(30.0, 0.0), at(30.0, 5.0)]);
        assert!(clipped(&beside, &window).is_empty());
    }
}
