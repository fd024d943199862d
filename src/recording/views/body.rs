//! The body of an obstacle in space-time, as a mesh.

use std::f64::consts::TAU;

use rerun::Mesh3D;

use crate::frame::{Vector, direction};
use crate::obstacle::Obstacle;
use crate::recording::canvas::Canvas;

/// Directions in which the extreme points of a section are corners of the mesh.
const SIDES: usize = 48;

/// Sections between the start and the end, as an ellipsoid does not grow on straight lines.
const STEPS: usize = 8;

/// Times of the sections that the mesh joins, seconds.
fn times(canvas: &Canvas, set: &Obstacle) -> Vec<f64> {
    let step = canvas.end / STEPS as f64;
    let mut times: Vec<f64> = (0..=STEPS).map(|k| step * k as f64).collect();
    if let Obstacle::Slabs(slabs) = set {
        let starts = slabs.slabs().iter().map(|slab| slab.start());
        times.extend(starts.filter(|start| *start < canvas.end));
    }
    times.sort_by(f64::total_cmp);
    times
}

/// The body from t = 0 to the end, with the last section on top.
pub fn mesh(canvas: &Canvas, set: &Obstacle) -> Mesh3D {
    let normals = (0..SIDES).map(|k| direction(TAU * k as f64 / SIDES as f64));
    let normals: Vec<Vector> = normals.collect();
    let times = times(canvas, set);
    let (mut corners, mut shades) = (Vec::new(), Vec::new());
    for &time in &times {
        let section = set.outer_section(time);
        let extreme = |n: &Vector| {
            let points = section.vertices().iter().copied();
            points.max_by(|a, b| n.dot(a).total_cmp(&n.dot(b)))
        };
        let ring = normals.iter().filter_map(extreme);
        corners.extend(ring.map(|point| canvas.lifted(point, time)));
        shades.extend(normals.iter().map(|n| [n.x as f32, n.y as f32, 0.0]));
    }
    let sides = SIDES as u32;
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for base in (1..times.len() as u32).map(|layer| (layer - 1) * sides) {
        for i in 0..sides {
            let (here, next) = (base + i, base + (i + 1) % sides);
            triangles.push([here, next, next + sides]);
            triangles.push([here, next + sides, here + sides]);
        }
    }
    let top = (times.len() as u32 - 1) * sides;
    triangles.extend((2..sides).map(|i| [top, top + i - 1, top + i]));
    Mesh3D::new(corners)
        .with_vertex_normals(shades)
        .with_triangle_indices(triangles)
}
