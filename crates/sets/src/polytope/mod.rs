//! The polytope obstacle `O = {(x, t) : t >= 0, x in O_0 + t V}`, paper eqs. (2)-(9), in support
//! form.

use std::sync::{Arc, OnceLock};

use crate::risk::FaceSpread;
use crate::{Support, VelocityObstacle};
use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::Vector;

/// One face of the space-time body: `normal . x - velocity_support t <= initial_support`, with a
/// unit normal in the plane.
///
/// docs/reference/theory.md section 1; the corrected eq. (9) is a positive multiple of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpace {
    /// Outward unit normal `n`.
    pub normal: Vector,
    /// `h_V(n)`, m/s: how fast the face moves outward.
    pub velocity_support: f64,
    /// `h_O0(n)`, metres: where the face is at t = 0.
    pub initial_support: f64,
}

impl HalfSpace {
    /// Signed distance of the point from the face's line at `time`, metres; positive outside.
    pub fn slack(&self, position: Vector, time: f64) -> f64 {
        self.normal.dot(&position) - self.velocity_support * time - self.initial_support
    }
}

/// How far a point is outside, and the face that decides.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slack {
    /// `g(x, t)`, metres. Inside `g <= 0` and `-g` is the depth; outside `g` is a lower bound of
    /// the distance.
    pub value: f64,
    /// Index of the deciding face.
    pub face: usize,
}

/// A vertex of the sections `O_t`. It moves in a straight line, which is an edge of the space-time
/// body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovingVertex {
    /// Indices of the vertices of `O_0` and of `V`.
    pub indices: (usize, usize),
    /// Position at t = 0, metres.
    pub origin: Vector,
    /// Velocity, m/s.
    pub velocity: Vector,
}

/// Every position that a target may reach: `O_t = O_0 + t V` for `0 <= t`, convex in space-time.
///
/// `V` is convex, so `O_t` also contains every position reached with a velocity that varies in time
/// and stays in `V`.
#[derive(Debug, Clone)]
pub struct PolytopeObstacle {
    shared: Arc<Shared>,
}

/// Shared by all clones.
#[derive(Debug, Clone)]
struct Shared {
    name: String,
    initial: ConvexPolygon,
    velocity: ConvexPolygon,
    faces: Vec<HalfSpace>,
    spreads: Vec<FaceSpread>,
    /// Computed on demand: level sets that are only tested never need them.
    moving: OnceLock<Vec<MovingVertex>>,
}

impl PartialEq for PolytopeObstacle {
    fn eq(&self, other: &Self) -> bool {
        // everything else follows from these
        self.shared.name == other.shared.name
            && self.shared.initial == other.shared.initial
            && self.shared.velocity == other.shared.velocity
    }
}

impl PolytopeObstacle {
    /// From the two sets, in O((n + m) log (n + m)).
    ///
    /// Faces are computed once, moving vertices on demand. Points and segments are exact.
    pub fn new(name: impl Into<String>, initial: ConvexPolygon, velocity: ConvexPolygon) -> Self {
        let with_angle = |n: Vector| (n.y.atan2(n.x), n);
        let mut normals: Vec<(f64, Vector)> = [initial.normals(), velocity.normals()]
            .into_iter()
            .flatten()
            .map(with_angle)
            .collect();
        normals.sort_by(|a, b| a.0.total_cmp(&b.0));
        normals.dedup_by(|a, b| (a.1 - b.1).norm() < 1e-12);
        // due west at both ends of the range of angles
        if let [first, .., last] = normals[..]
            && (first.1 - last.1).norm() < 1e-12
        {
            normals.pop();
        }
        let normals: Vec<Vector> = normals.into_iter().map(|(_, normal)| normal).collect();
        let supports = (initial.extremes(&normals)).zip(velocity.extremes(&normals));
        let faces: Vec<HalfSpace> = (normals.iter().zip(supports))
            .map(|(normal, (initial, velocity))| HalfSpace {
                normal: *normal,
                velocity_support: normal.dot(&velocity),
                initial_support: normal.dot(&initial),
            })
            .collect();
        let centroid = velocity.centroid();
        Self {
            shared: Arc::new(Shared {
                name: name.into(),
                spreads: faces.iter().map(|f| FaceSpread::of(f, centroid)).collect(),
                moving: OnceLock::new(),
                initial,
                velocity,
                faces,
            }),
        }
    }

    /// The target's name.
    pub fn name(&self) -> &str {
        &self.shared.name
    }

    /// `O_0`, metres.
    pub fn initial(&self) -> &ConvexPolygon {
        &self.shared.initial
    }

    /// `V`, m/s.
    pub fn velocity(&self) -> &ConvexPolygon {
        &self.shared.velocity
    }

    /// The faces, sorted by the angle of their normals.
    pub fn faces(&self) -> &[HalfSpace] {
        &self.shared.faces
    }

    /// How the velocities lie behind each face.
    pub(crate) fn spreads(&self) -> &[FaceSpread] {
        &self.shared.spreads
    }

    /// The vertices of the sections for t > 0, counter-clockwise; at most n + m.
    pub fn moving_vertices(&self) -> &[MovingVertex] {
        (self.shared.moving)
            .get_or_init(|| moving_vertices(self.initial(), self.velocity(), self.faces()))
    }

    /// Replaces the supports of the faces. Contact depends on the faces alone; nothing else of this
    /// polytope is valid afterwards.
    pub(crate) fn move_faces(&mut self, supports: impl Iterator<Item = Support>) {
        let faces = &mut Arc::make_mut(&mut self.shared).faces;
        for (face, support) in faces.iter_mut().zip(supports) {
            (face.initial_support, face.velocity_support) = (support.value, support.rate);
        }
    }

    /// The velocity obstacle as a region of half-planes, for own ship at `position` at t = 0.
    pub fn velocity_obstacle(&self, position: Vector, horizon: f64) -> VelocityObstacle {
        VelocityObstacle::new(self, position, horizon)
    }

    /// The section `O_t` for `t >= 0`, paper eq. (6). O(n + m).
    pub fn section(&self, time: f64) -> ConvexPolygon {
        if time > 0.0 {
            self.shared
                .initial
                .minkowski_sum(&self.shared.velocity.scaled(time))
        } else {
            self.shared.initial.clone()
        }
    }

    /// `g(x, t) = max over faces of the signed distance`, docs/reference/theory.md section 1. NaN
    /// for a NaN. O(n + m).
    pub fn slack(&self, position: Vector, time: f64) -> Slack {
        let mut best = Slack {
            value: f64::NEG_INFINITY,
            face: 0,
        };
        for (face, h) in self.shared.faces.iter().enumerate() {
            let value = h.slack(position, time);
            // negated so that a NaN replaces the best and stays
            if !(value <= best.value) {
                best = Slack { value, face };
                if value.is_nan() {
                    break;
                }
            }
        }
        best
    }

    /// [`Self::slack`] by a local search from a face near the answer, usually in O(1).
    ///
    /// Outside a convex set the slack of the faces, ordered around it, has one maximum: `min over q
    /// in O_t of n . (x - q)` is unimodal in `n` where it is positive, and the faces are a subset
    /// of all `n`. Where the local maximum is not positive, all faces are searched.
    pub fn slack_near(&self, position: Vector, time: f64, face: usize) -> Slack {
        let (faces, count) = (&self.shared.faces, self.shared.faces.len());
        if !(time >= 0.0) || face >= count {
            return self.slack(position, time);
        }
        let (mut face, mut value) = (face, faces[face].slack(position, time));
        for forth in [true, false] {
            loop {
                let next = match (forth, face) {
                    (true, k) if k + 1 == count => 0,
                    (true, k) => k + 1,
                    (false, 0) => count - 1,
                    (false, k) => k - 1,
                };
                let there = faces[next].slack(position, time);
                // a NaN is not greater and leads to the search of all faces
                if !(there > value) {
                    break;
                }
                (face, value) = (next, there);
            }
        }
        if value > 0.0 && value.is_finite() {
            return Slack { value, face };
        }
        self.slack(position, time)
    }

    /// True when `(position, time)` is in the closed body. A NaN is inside; a time before 0 is
    /// outside.
    pub fn contains(&self, position: Vector, time: f64) -> bool {
        // both negated so that a NaN is inside
        !(time < 0.0) && !(self.slack(position, time).value > 0.0)
    }
}

/// Between two neighbouring normals each set has one support vertex.
fn moving_vertices(
    initial: &ConvexPolygon,
    velocity: &ConvexPolygon,
    faces: &[HalfSpace],
) -> Vec<MovingVertex> {
    let next = faces.iter().cycle().skip(1);
    let between: Vec<Vector> = (faces.iter().zip(next))
        .map(|(a, b)| a.normal + b.normal)
        .collect();
    let both = (initial.farthest(&between)).zip(velocity.farthest(&between));
    let mut vertices: Vec<MovingVertex> = both
        .map(|(j, k)| MovingVertex {
            indices: (j, k),
            origin: initial.vertices()[j],
            velocity: velocity.vertices()[k],
        })
        .collect();
    vertices.dedup_by_key(|v| v.indices);
    while vertices.len() > 1 && vertices[0].indices == vertices[vertices.len() - 1].indices {
        vertices.pop();
    }
    vertices
}

#[cfg(test)]
mod tests;
