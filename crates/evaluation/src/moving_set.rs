//! Moving set of the checker: sections from matched vertices, faces from supports.

use crate::piece::Piece;
use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::{Vector, to_starboard};

/// Disc that contains the section at every time. Its centre is in the section.
#[derive(Debug, Clone, Copy)]
pub(crate) struct MovingDisc {
    /// Centre at t = 0, metres, and its velocity, m/s.
    pub center: MovingVertex,
    /// Radius at t = 0, metres.
    pub radius: f64,
    /// Rate of the radius, m/s.
    pub growth: f64,
}

impl MovingDisc {
    fn around(vertices: &[MovingVertex]) -> Self {
        let share = 1.0 / vertices.len() as f64;
        let center = MovingVertex {
            initial: vertices.iter().map(|v| v.initial * share).sum(),
            velocity: vertices.iter().map(|v| v.velocity * share).sum(),
        };
        let most = |of: fn(&MovingVertex) -> Vector| {
            let off = vertices.iter().map(|v| (of(v) - of(&center)).norm());
            off.fold(0.0, f64::max)
        };
        Self {
            center,
            radius: most(|v| v.initial),
            growth: most(|v| v.velocity),
        }
    }

    /// Lower bound of the distance of the position of a piece within `half` seconds of `time`: that
    /// on the tangent, from which the position deviates by at most half of its acceleration times
    /// the time squared. NaN, no bound, where a square overflows.
    pub fn least_distance(&self, piece: &impl Piece, [time, half]: [f64; 2]) -> f64 {
        let offset = piece.pose_at(time).position - self.center.at(time);
        let relative = piece.velocity_at(time) - self.center.velocity;
        let square = relative.norm_squared();
        let closest = match square {
            0.0 => 0.0,
            _ if square.is_finite() => (-offset.dot(&relative) / square).clamp(-half, half),
            _ => f64::NAN,
        };
        let bend = 0.5 * piece.bounds().acceleration * half * half;
        let apart = (offset + relative * closest).norm() - bend;
        apart - self.radius - self.growth * (time + half)
    }
}

/// Vertex of the section: `initial + t velocity`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct MovingVertex {
    /// Position at t = 0, metres.
    pub initial: Vector,
    /// Velocity, m/s.
    pub velocity: Vector,
}

impl MovingVertex {
    /// Position at `time`.
    pub fn at(&self, time: f64) -> Vector {
        self.initial + self.velocity * time
    }
}

/// Face of the section: `normal . x <= initial + t rate`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Face {
    /// Outward unit normal.
    pub normal: Vector,
    /// Offset at t = 0, metres.
    pub initial: f64,
    /// Outward speed, m/s.
    pub rate: f64,
}

impl Face {
    /// Offset along the normal at `time`.
    pub fn support(&self, time: f64) -> f64 {
        self.initial + self.rate * time
    }
}

/// `O_0 + t V`, prepared for distances. For `t > 0`, each vertex of the section is one vertex of
/// `O_0` that moves with one vertex of `V`, and each face moves along its normal.
#[derive(Debug, Clone)]
pub(crate) struct MovingSet {
    initial: ConvexPolygon,
    velocity: ConvexPolygon,
    /// Vertices, counter-clockwise.
    pub vertices: Vec<MovingVertex>,
    /// Faces, sorted by the angle of their normals.
    pub faces: Vec<Face>,
    pub disc: MovingDisc,
}

impl MovingSet {
    /// Matches the vertices of both sets by their extreme points between each two neighbouring
    /// normals. O((n + m) log (n + m)).
    pub fn new(initial: &ConvexPolygon, velocity: &ConvexPolygon) -> Self {
        let normals = initial.normals().into_iter().chain(velocity.normals());
        let mut normals: Vec<(f64, Vector)> = normals.map(|n| (n.y.atan2(n.x), n)).collect();
        normals.sort_by(|a, b| a.0.total_cmp(&b.0));
        let normals: Vec<Vector> = normals.into_iter().map(|(_, normal)| normal).collect();
        let next = normals.iter().cycle().skip(1);
        let gaps: Vec<Vector> = (normals.iter().zip(next))
            .map(|(a, b)| between(*a, *b))
            .collect();
        let faces: Vec<Face> = (initial.extremes(&normals))
            .zip(velocity.extremes(&normals))
            .zip(&normals)
            .map(|((initial, velocity), normal)| Face {
                normal: *normal,
                initial: normal.dot(&initial),
                rate: normal.dot(&velocity),
            })
            .collect();
        let mut vertices: Vec<MovingVertex> = (initial.extremes(&gaps))
            .zip(velocity.extremes(&gaps))
            .map(|(initial, velocity)| MovingVertex { initial, velocity })
            .collect();
        vertices.dedup();
        while vertices.len() > 1 && vertices[0] == vertices[vertices.len() - 1] {
            vertices.pop();
        }
        Self {
            initial: initial.clone(),
            velocity: velocity.clone(),
            disc: MovingDisc::around(&vertices),
            vertices,
            faces,
        }
    }

    /// The section at a time.
    pub fn section_at(&self, time: f64) -> ConvexPolygon {
        self.initial.minkowski_sum(&self.velocity.scaled(time))
    }

    /// The section at a time, as a fixed set.
    pub fn still_at(&self, time: f64) -> Self {
        Self::new(
            &self.section_at(time),
            &ConvexPolygon::point(Vector::zeros()),
        )
    }

    /// Returns the supporting line in any unit direction.
    pub fn face(&self, normal: Vector) -> Face {
        Face {
            normal,
            initial: self.initial.support(normal),
            rate: self.velocity.support(normal),
        }
    }

    /// Speed of the fastest vertex, m/s.
    pub fn fastest(&self) -> f64 {
        self.velocity.reach()
    }

    /// Returns false when the sections are points or segments at every time.
    pub fn has_interior(&self) -> bool {
        self.vertices.len() > 2
    }
}

/// Returns the direction of the bisector of the counter-clockwise gap between two unit vectors, at
/// most half a turn. The first term vanishes for opposite vectors, the second for equal ones.
fn between(a: Vector, b: Vector) -> Vector {
    (a + b) + to_starboard(b - a)
}
