//! The body of a polytope obstacle in space-time, as a mesh.

use rerun::Mesh3D;

use super::scene::Scene;
use crate::frame::{Vector, direction, heading_of, wrap_positive};
use crate::geometry::ConvexPolygon;
use crate::obstacle::PolytopeObstacle;

/// A vertex of the section as it moves: `place + time * velocity`. These lines are the edges of the
/// space-time polytope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingVertex {
    /// Where it is at t = 0, metres.
    pub place: Vector,
    /// m/s.
    pub velocity: Vector,
}

impl MovingVertex {
    pub fn at(&self, time: f64) -> Vector {
        self.place + self.velocity * time
    }
}

/// The moving vertex between each face and the next. Between two neighbouring normals one vertex of
/// each of the two sets is extreme, so this is exact. O((n + m)²).
pub fn moving_vertices(set: &PolytopeObstacle) -> Vec<MovingVertex> {
    let faces = set.faces();
    (0..faces.len())
        .map(|i| {
            let here = heading_of(faces[i].normal);
            let next = heading_of(faces[(i + 1) % faces.len()].normal);
            let between = direction(here + wrap_positive(next - here) / 2.0);
            MovingVertex {
                place: extreme(set.initial(), between),
                velocity: extreme(set.velocity(), between),
            }
        })
        .collect()
}

fn extreme(set: &ConvexPolygon, along: Vector) -> Vector {
    set.vertices()
        .iter()
        .copied()
        .max_by(|a, b| along.dot(a).total_cmp(&along.dot(b)))
        .unwrap_or_else(Vector::zeros)
}

/// The body from t = 0 to the scene's end: one flat side per face, and the last section on top. Every
/// side has its own corners, so that its normal is flat.
pub fn mesh(scene: &Scene, set: &PolytopeObstacle) -> Mesh3D {
    let vertices = moving_vertices(set);
    let count = vertices.len();
    let mut corners: Vec<[f32; 3]> = Vec::new();
    let mut normals: Vec<[f32; 3]> = Vec::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for (i, face) in set.faces().iter().enumerate() {
        let ends = [vertices[(i + count - 1) % count], vertices[i]];
        let base = corners.len() as u32;
        for time in [0.0, scene.end] {
            corners.extend(ends.map(|v| scene.lifted(v.at(time), time)));
        }
        let rise = -face.velocity_support / scene.metres_per_second;
        let length = (1.0 + rise * rise).sqrt();
        let normal = [face.normal.x, face.normal.y, rise].map(|n| (n / length) as f32);
        normals.extend([normal; 4]);
        triangles.extend([[base, base + 1, base + 3], [base, base + 3, base + 2]]);
    }
    let base = corners.len() as u32;
    corners.extend(
        vertices
            .iter()
            .map(|v| scene.lifted(v.at(scene.end), scene.end)),
    );
    normals.extend(std::iter::repeat_n([0.0, 0.0, 1.0], count));
    triangles.extend((2..count as u32).map(|i| [base, base + i - 1, base + i]));
    Mesh3D::new(corners)
        .with_vertex_normals(normals)
        .with_triangle_indices(triangles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moving_vertices_are_the_vertices_of_every_section() {
        let square = [(0.0, 0.0), (40.0, 0.0), (40.0, 10.0), (0.0, 10.0)];
        let wedge = [(4.0, -0.5), (5.0, -0.6), (5.0, 0.6), (4.0, 0.5)];
        let polygon = |points: &[(f64, f64)]| {
            let points: Vec<Vector> = points.iter().map(|&(x, y)| Vector::new(x, y)).collect();
            ConvexPolygon::hull(&points).expect("finite")
        };
        let point = ConvexPolygon::point(Vector::new(3.0, 1.0));
        for (initial, velocity) in [
            (polygon(&square), polygon(&wedge)),
            (polygon(&square), point.clone()),
            (point.clone(), polygon(&wedge)),
            (polygon(&square[..2]), polygon(&wedge)),
            (point.clone(), point),
        ] {
            let set = PolytopeObstacle::new("t", initial, velocity);
            for time in [0.0, 1.0, 60.0] {
                let moved: Vec<Vector> = moving_vertices(&set).iter().map(|v| v.at(time)).collect();
                let hull = ConvexPolygon::hull(&moved).expect("finite");
                let section = set.section(time);
                for face in set.faces() {
                    let gap = hull.support(face.normal) - section.support(face.normal);
                    assert!(gap.abs() < 1e-9, "{gap}");
                }
                assert_eq!(hull.vertices().len(), section.vertices().len());
            }
        }
    }
}
