//! The body of an obstacle in space-time, as a mesh.

use rerun::Mesh3D;

use crate::frame::{Vector, direction, heading_of, wrap_positive};
use crate::geometry::ConvexPolygon;
use crate::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use crate::recording::canvas::Canvas;

/// A moving vertex of a section: `place + time * velocity`. These lines are the edges of the
/// space-time polytope.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeshVertex {
    /// Its position at t = 0, metres.
    pub place: Vector,
    /// m/s.
    pub velocity: Vector,
}

impl MeshVertex {
    pub fn at(&self, time: f64) -> Vector {
        self.place + self.velocity * time
    }
}

/// Sides, and time intervals, of the polytopes that approximate an ellipsoid in views.
const ROUND_SIDES: usize = 24;
const ROUND_PRISMS: usize = 6;

/// A time interval in which the section is a polygon whose vertices move on straight lines.
#[derive(Debug)]
pub struct Prism {
    from: f64,
    to: f64,
    /// Counter-clockwise.
    vertices: Vec<MeshVertex>,
    /// The normal and the outward speed of the side that ends at each vertex.
    sides: Vec<(Vector, f64)>,
    /// The sides are chords of a surface without edges.
    round: bool,
}

impl Prism {
    fn polytope(set: &PolytopeObstacle, from: f64, to: f64) -> Self {
        let from_zero = |v: MeshVertex| MeshVertex {
            place: v.place - v.velocity * from,
            ..v
        };
        let faces = set.faces().iter();
        Self {
            from,
            to,
            vertices: moving_vertices(set).into_iter().map(from_zero).collect(),
            sides: faces.map(|f| (f.normal, f.velocity_support)).collect(),
            round: false,
        }
    }

    /// The clock of the set starts at `zero`.
    fn round(set: &EllipsoidObstacle, zero: f64, from: f64, to: f64) -> Self {
        let step = std::f64::consts::TAU / ROUND_SIDES as f64;
        let (first, last) = (set.outer_section(from - zero), set.outer_section(to - zero));
        let vertices = (0..ROUND_SIDES).map(|k| {
            let normal = direction(step * (k as f64 + 0.5));
            let [a, b] = [&first, &last].map(|e| e.boundary_point(normal));
            let velocity = (b - a) / (to - from).max(f64::MIN_POSITIVE);
            MeshVertex {
                place: a - velocity * from,
                velocity,
            }
        });
        let middle = 0.5 * (from + to) - zero;
        let sides = (0..ROUND_SIDES).map(|k| {
            let normal = direction(step * k as f64);
            (normal, set.support(normal, middle).rate)
        });
        Self {
            from,
            to,
            vertices: vertices.collect(),
            sides: sides.collect(),
            round: true,
        }
    }

    /// The section at a time, closed.
    pub fn ring(&self, canvas: &Canvas, time: f64) -> Vec<[f32; 3]> {
        let lifted = |v: &MeshVertex| canvas.lifted(v.at(time), time);
        let mut ring: Vec<_> = self.vertices.iter().map(lifted).collect();
        ring.extend(ring.first().copied());
        ring
    }

    pub fn contains(&self, time: f64) -> bool {
        (self.from..=self.to).contains(&time)
    }
}

/// The prisms from t = 0 to the end: exact for polytopes, chords of an ellipsoid.
pub fn prisms(canvas: &Canvas, set: &Obstacle) -> Vec<Prism> {
    prisms_between(set, 0.0, canvas.end)
}

/// The prisms between two times of a set whose clock starts at the first of them.
fn prisms_between(set: &Obstacle, from: f64, to: f64) -> Vec<Prism> {
    match set {
        Obstacle::Polytope(o) => vec![Prism::polytope(o, from, to)],
        Obstacle::Ellipsoid(o) => match o.flat() {
            Some(flat) => vec![Prism::polytope(flat, from, to)],
            None => (0..ROUND_PRISMS)
                .map(|k| {
                    let at = |k: usize| from + (to - from) * k as f64 / ROUND_PRISMS as f64;
                    Prism::round(o, from, at(k), at(k + 1))
                })
                .collect(),
        },
        Obstacle::Slabs(o) => {
            let slabs = o.slabs().iter().filter(|slab| slab.start() < to);
            slabs
                .flat_map(|slab| prisms_between(slab.obstacle(), slab.start(), slab.end().min(to)))
                .collect()
        }
    }
}

/// The moving vertex between each face and the next. Between two neighbouring normals one vertex of
/// each of the two sets is extreme, so this is exact. O((n + m)²).
pub fn moving_vertices(set: &PolytopeObstacle) -> Vec<MeshVertex> {
    let faces = set.faces();
    (0..faces.len())
        .map(|i| {
            let here = heading_of(faces[i].normal);
            let next = heading_of(faces[(i + 1) % faces.len()].normal);
            let between = direction(here + wrap_positive(next - here) / 2.0);
            MeshVertex {
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

/// A triangulated surface.
#[derive(Debug, Default)]
struct Surface {
    corners: Vec<[f32; 3]>,
    normals: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
}

impl Surface {
    /// Adds one flat side per face; every side has its own corners.
    fn add_flat(&mut self, canvas: &Canvas, prism: &Prism) {
        let vertices = &prism.vertices;
        let count = vertices.len();
        for (i, side) in prism.sides.iter().enumerate() {
            let ends = [vertices[(i + count - 1) % count], vertices[i]];
            let base = self.corners.len() as u32;
            for time in [prism.from, prism.to] {
                let ends = ends.map(|v| canvas.lifted(v.at(time), time));
                self.corners.extend(ends);
            }
            self.normals.extend([upward(canvas, *side); 4]);
            let sides = [[base, base + 1, base + 3], [base, base + 3, base + 2]];
            self.triangles.extend(sides);
        }
    }

    /// Adds sides that share their corners.
    fn add_round(&mut self, canvas: &Canvas, prism: &Prism) {
        let count = prism.vertices.len();
        let base = self.corners.len() as u32;
        for time in [prism.from, prism.to] {
            for (i, vertex) in prism.vertices.iter().enumerate() {
                self.corners.push(canvas.lifted(vertex.at(time), time));
                let (before, after) = (prism.sides[i], prism.sides[(i + 1) % count]);
                let outward = (before.0 + after.0).normalize();
                let side = (outward, 0.5 * (before.1 + after.1));
                self.normals.push(upward(canvas, side));
            }
        }
        let count = count as u32;
        for i in 0..count {
            let (here, next) = (base + i, base + (i + 1) % count);
            let sides = [
                [here, next, next + count],
                [here, next + count, here + count],
            ];
            self.triangles.extend(sides);
        }
    }

    fn add_top(&mut self, canvas: &Canvas, prism: &Prism) {
        let base = self.corners.len() as u32;
        let top = prism.vertices.iter();
        let top = top.map(|v| canvas.lifted(v.at(prism.to), prism.to));
        self.corners.extend(top);
        let count = prism.vertices.len();
        self.normals
            .extend(std::iter::repeat_n([0.0, 0.0, 1.0], count));
        let fan = (2..count as u32).map(|i| [base, base + i - 1, base + i]);
        self.triangles.extend(fan);
    }
}

/// The normal in the volume of a side that moves outward at `speed`.
fn upward(canvas: &Canvas, (outward, speed): (Vector, f64)) -> [f32; 3] {
    let rise = -speed / canvas.metres_per_second;
    let length = (1.0 + rise * rise).sqrt();
    [outward.x, outward.y, rise].map(|n| (n / length) as f32)
}

/// The body from t = 0 to the end, and the last section on top.
pub fn mesh(canvas: &Canvas, prisms: &[Prism]) -> Mesh3D {
    let mut surface = Surface::default();
    for prism in prisms {
        if prism.round {
            surface.add_round(canvas, prism);
        } else {
            surface.add_flat(canvas, prism);
        }
    }
    if let Some(last) = prisms.last() {
        surface.add_top(canvas, last);
    }
    Mesh3D::new(surface.corners)
        .with_vertex_normals(surface.normals)
        .with_triangle_indices(surface.triangles)
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
