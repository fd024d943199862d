//! Land: its outlines on the chart, its surface under the space-time volume.

use rerun::{LineStrips2D, Mesh3D};

use crate::geometry::{Polygon, Window};
use crate::recording::canvas::{Canvas, flat, style};
use crate::recording::write::Recorder;
use crate::recording::{Logged, MAP, VOLUME, path};

pub fn log_land(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    log_outlines(rec, canvas)?;
    log_surface(rec, canvas)
}

pub fn log_outlines(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    let Some(land) = &canvas.scenario.land else {
        return Ok(());
    };
    let rings = land.map.polygons().iter().flat_map(Polygon::rings);
    let strips = rings.map(|ring| ring.iter().chain(&ring[..1]).map(|p| flat(*p)));
    rec.log_static(
        path(&[MAP, "land"]),
        &LineStrips2D::new(strips.map(Vec::from_iter))
            .with_colors([style::LAND])
            .with_radii([style::points(1.2)]),
    )
}

fn log_surface(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    let Some(land) = &canvas.scenario.land else {
        return Ok(());
    };
    let window = Window::new(canvas.bounds.low, canvas.bounds.high);
    let mut corners: Vec<[f32; 3]> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for piece in land.map.pieces_within(&window) {
        let base = corners.len() as u32;
        let clipped = window.part_of(piece);
        corners.extend(clipped.iter().map(|p| canvas.lifted(*p, 0.0)));
        let fan = 2..clipped.len() as u32;
        triangles.extend(fan.map(|i| [base, base + i - 1, base + i]));
    }
    if triangles.is_empty() {
        return Ok(());
    }
    let up = vec![[0.0, 0.0, 1.0]; corners.len()];
    let surface = Mesh3D::new(corners)
        .with_vertex_normals(up)
        .with_triangle_indices(triangles)
        .with_albedo_factor(style::LAND.0);
    rec.log_static(path(&[VOLUME, "land"]), &surface)
}
