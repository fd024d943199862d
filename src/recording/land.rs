//! Land: its outlines on the chart, its surface under the space-time volume.

use rerun::{LineStrips2D, LineStrips3D, Mesh3D, RecordingStream, RecordingStreamResult};

use super::scene::{Bounds, Stage, flat};
use super::{MAP, VOLUME, path, style};
use crate::frame::Vector;
use crate::geometry::{Polygon, Window};

/// Of the sea that is shown, how much more is drawn: the views are wider than the sea is high.
const BEYOND: f64 = 0.6;

/// Nothing without land.
pub fn log_land(rec: &RecordingStream, stage: &Stage) -> RecordingStreamResult<()> {
    let Some(land) = &stage.scenario.land else {
        return Ok(());
    };
    let Bounds { low, high } = stage.bounds.grown(BEYOND * stage.bounds.extent());
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

    let shown = stage.bounds;
    let window = Window {
        low: shown.low,
        high: shown.high,
    };
    let mut corners: Vec<[f32; 3]> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for piece in land.map.pieces_within(&window) {
        let clipped = window.part_of(piece);
        let base = corners.len() as u32;
        corners.extend(clipped.iter().map(|p| stage.lifted(*p, 0.0)));
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
        .map(|edge| [edge[0], edge[1]].map(|p| stage.lifted(p, 0.0)));
    let shores = LineStrips3D::new(shores)
        .with_colors([style::land()])
        .with_radii([style::points(0.8)]);
    let parts: [&dyn rerun::AsComponents; 2] = [&surface, &shores];
    rec.log_static(path(&[VOLUME, "land"]), &parts)
}
