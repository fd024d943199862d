//! Land: its outlines on the chart, its surface under the space-time volume.

use std::collections::HashMap;

use rerun::{LineStrips2D, LineStrips3D, Mesh3D, RecordingStream, RecordingStreamResult};

use super::scene::{Stage, flat};
use super::{MAP, VOLUME, path, style};
use crate::frame::Vector;
use crate::geometry::{Polygon, Window};

/// Of the sea that is shown, how much more is drawn in full: the views are wider than the sea is high.
const BEYOND: f64 = 0.6;

/// Of the sea that is shown: steps of the coast beyond, on the chart.
const FAR_STEP: f64 = 0.01;

/// Nothing without land.
pub fn log_land(rec: &RecordingStream, stage: &Stage) -> RecordingStreamResult<()> {
    let Some(land) = &stage.scenario.land else {
        return Ok(());
    };
    let around = stage.bounds.grown(BEYOND * stage.bounds.extent());
    let rings = land.map.polygons().iter().flat_map(Polygon::rings);
    let outlines: Vec<Vec<Vector>> = rings
        .map(|ring| ring.iter().chain(&ring[..1]).copied().collect())
        .collect();
    let step = FAR_STEP * stage.bounds.extent();
    let strips = outlines.iter().map(|o| {
        let line = coarser(o, step, |p| around.contains(p)).into_iter();
        line.map(flat)
    });
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
    let mut known: HashMap<[u64; 2], u32> = HashMap::new();
    // neighbours share their corners
    let mut surface_corner = |p: Vector| {
        *known
            .entry([p.x.to_bits(), p.y.to_bits()])
            .or_insert_with(|| {
                corners.push(stage.lifted(p, 0.0));
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
    let shores = outlines
        .iter()
        .flat_map(|o| o.split(|p| !shown.contains(p)))
        .filter(|line| line.len() > 1)
        .map(|line| line.iter().map(|p| stage.lifted(*p, 0.0)));
    let shores = LineStrips3D::new(shores)
        .with_colors([style::land()])
        .with_radii([style::points(0.8)]);
    let parts: [&dyn rerun::AsComponents; 2] = [&surface, &shores];
    rec.log_static(path(&[VOLUME, "land"]), &parts)
}

/// A line whose points that are not near follow one another at a step at least; its ends stay.
fn coarser(line: &[Vector], step: f64, near: impl Fn(&Vector) -> bool) -> Vec<Vector> {
    let mut kept: Vec<Vector> = Vec::new();
    for (i, p) in line.iter().enumerate() {
        let is_end = i + 1 == line.len();
        let is_new = kept.last().is_none_or(|last| (p - last).norm() >= step);
        if near(p) || is_new || is_end {
            kept.push(*p);
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_far_line_is_coarser_and_keeps_its_ends() {
        let line: Vec<Vector> = (0..=100).map(|x| Vector::new(f64::from(x), 0.0)).collect();
        let near = |p: &Vector| p.x < 20.5;
        let kept = coarser(&line, 10.0, near);
        assert_eq!(&kept[..21], &line[..21]);
        let far: Vec<f64> = kept[21..].iter().map(|p| p.x).collect();
        assert_eq!(far, [30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0]);
        let short = coarser(&line, 1e3, |_| false);
        assert_eq!(short, [line[0], line[100]]);
    }
}
