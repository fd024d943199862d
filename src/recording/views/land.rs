//! Land: its outlines on the chart, its surface under the space-time volume.

use std::collections::HashMap;

use rerun::{LineStrips2D, Mesh3D, RecordingStreamResult};

use crate::frame::Vector;
use crate::geometry::{Polygon, Window};
use crate::recording::canvas::simplify::simplified;
use crate::recording::canvas::{Canvas, flat, style};
use crate::recording::write::Recorder;
use crate::recording::{MAP, VOLUME, path};

/// Largest error of land outside the bounds, as a fraction of them.
const FAR_TOLERANCE: f64 = 1.0 / 300.0;

/// Logs the land, where there is a map.
pub fn log_land(rec: &mut Recorder, canvas: &Canvas) -> RecordingStreamResult<()> {
    let Some(land) = &canvas.scenario.land else {
        return Ok(());
    };
    let shown = canvas.bounds;
    let (fine, coarse) = (canvas.line_tolerance(), FAR_TOLERANCE * shown.extent());
    let off = |p: &Vector| if shown.contains(p) { fine } else { coarse };
    let rings = land.map.polygons().iter().flat_map(Polygon::rings);
    let strips = rings.map(|ring| {
        let outline: Vec<Vector> = ring.iter().chain(&ring[..1]).copied().collect();
        simplified(&outline, off).into_iter().map(flat)
    });
    rec.log_static(
        path(&[MAP, "land"]),
        &LineStrips2D::new(strips.map(Vec::from_iter))
            .with_colors([style::land()])
            .with_radii([style::points(1.2)]),
    )?;

    let window = Window {
        low: shown.low,
        high: shown.high,
    };
    let mut corners: Vec<[f32; 3]> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    let mut known: HashMap<[u64; 2], u32> = HashMap::new();
    // neighbours share their corners
    let mut surface_corner = |p: Vector| {
        *known
            .entry([p.x.to_bits(), p.y.to_bits()])
            .or_insert_with(|| {
                corners.push(canvas.lifted(p, 0.0));
                corners.len() as u32 - 1
            })
    };
    for piece in land.map.pieces_within(&window) {
        let clipped = window.part_of(piece);
        let ring: Vec<u32> = clipped.iter().map(|p| surface_corner(*p)).collect();
        triangles.extend((2..ring.len()).map(|i| [ring[0], ring[i - 1], ring[i]]));
    }
    if triangles.is_empty() {
        return Ok(());
    }
    let up = vec![[0.0, 0.0, 1.0]; corners.len()];
    let surface = Mesh3D::new(corners)
        .with_vertex_normals(up)
        .with_triangle_indices(triangles)
        .with_albedo_factor(style::land().0);
    rec.log_static(path(&[VOLUME, "land"]), &surface)
}
