//! Land: its outlines on the chart, its surface under the space-time volume.

use std::collections::BTreeMap;

use rerun::{Mesh3D, Radius};

use super::chart::shown_window;
use crate::frame::Vector;
use crate::geometry::{Polygon, Window};
use crate::recording::canvas::{Canvas, flat, lines, style};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, MAP, VOLUME, path};
use crate::tolerance;

pub fn log_land(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    log_on_chart(rec, canvas)?;
    log_surface(rec, canvas)
}

pub fn log_on_chart(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    log_filling(rec, canvas)?;
    log_outlines(rec, canvas)
}

/// Fills the land on the chart. Rerun has no filled polygon in two dimensions: these are lines from
/// west to east that overlap.
fn log_filling(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    let Some(land) = &canvas.scenario.land else {
        return Ok(());
    };
    let size = canvas.bounds.size().max();
    let window = shown_window(canvas);
    let step = size / FILLING_LINES;
    let mut rows: BTreeMap<i64, Vec<[f64; 2]>> = BTreeMap::new();
    for piece in land.map.pieces_within(&window) {
        let corners = window.part_of(piece);
        let Some(extent) = Window::around(&corners) else {
            continue;
        };
        let [first, last] = [extent.low.y, extent.high.y].map(|north| (north / step).ceil() as i64);
        for row in first..last {
            rows.entry(row)
                .or_default()
                .extend(width_at(&corners, row as f64 * step));
        }
    }
    let filling = rows.into_iter().flat_map(|(row, widths)| {
        let north = row as f64 * step;
        let line = move |ends: [f64; 2]| ends.map(|east| flat(Vector::new(east, north)));
        joined(widths).into_iter().map(line)
    });
    let filling: Vec<[[f32; 2]; 2]> = filling.collect();
    if filling.is_empty() {
        return Ok(());
    }
    let filling = lines(style::toward_background(style::LAND, 0.5), 0.0)
        .with_strips(filling)
        // each line covers the soft edges of its neighbours, else these are seen as streaks
        .with_radii([Radius::new_scene_units(step as f32)])
        // below the grid
        .with_draw_order(1.0);
    rec.log_static(path(&[MAP, "land", "filling"]), &filling)
}

/// Lines that fill the land of the bounds.
const FILLING_LINES: f64 = 200.0;

/// West and east end of a convex polygon at a northing; `None` where it is not.
fn width_at(corners: &[Vector], north: f64) -> Option<[f64; 2]> {
    let ends = corners.iter().zip(corners.iter().cycle().skip(1));
    let crossed = ends.filter(|(a, b)| (a.y < north) != (b.y < north));
    let places = crossed.map(|(a, b)| a.x + (b.x - a.x) * (north - a.y) / (b.y - a.y));
    places.fold(None, |width, east| match width {
        None => Some([east, east]),
        Some([west, far]) => Some([east.min(west), east.max(far)]),
    })
}

/// The union of intervals, in order.
fn joined(mut intervals: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    intervals.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut all: Vec<[f64; 2]> = Vec::new();
    for [low, high] in intervals {
        match all.last_mut() {
            Some(last) if low <= last[1] + tolerance::LENGTH_M => last[1] = last[1].max(high),
            _ => all.push([low, high]),
        }
    }
    all
}

fn log_outlines(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    let Some(land) = &canvas.scenario.land else {
        return Ok(());
    };
    let rings = land.map.polygons().iter().flat_map(Polygon::rings);
    let strips = rings.map(|ring| ring.iter().chain(&ring[..1]).map(|p| flat(*p)));
    let outlines = lines(style::LAND, 1.2).with_strips(strips.map(Vec::from_iter));
    rec.log_static(path(&[MAP, "land"]), &outlines)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_convex_pieces_are_joined() {
        let square = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(Vector::from);
        assert_eq!(width_at(&square, 2.0), Some([0.0, 4.0]));
        assert_eq!(width_at(&square, 5.0), None);
        let triangle = [[4.0, 0.0], [8.0, 0.0], [4.0, 4.0]].map(Vector::from);
        let apart = [20.0, 21.0];
        let widths = [
            apart,
            width_at(&triangle, 2.0).expect("crossed"),
            [1.0, 2.0],
            [0.0, 4.0],
        ];
        assert_eq!(joined(widths.to_vec()), [[0.0, 6.0], apart]);
    }
}
