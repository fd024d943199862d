//! The velocity obstacle of polytopes as a set of half-planes: paper eq. (26),
//! docs/reference/theory.md section 5.3.

use super::closest_approach::from_zero;
use super::{HalfSpace, Obstacle, PolytopeObstacle, Slab};
use searoom_geometry::frame::{Vector, cross, to_port, to_starboard};
use searoom_geometry::{ConvexPolygon, clipped};

/// Half-plane `normal . v <= offset` of velocities, with a unit normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlane {
    /// Outward unit normal.
    pub normal: Vector,
    /// m/s.
    pub offset: f64,
}

/// The velocities of own ship that meet the obstacle within the horizon, as an intersection of
/// half-planes.
///
/// Convex: `V ⊕ (O_0 - x) / T ⊕ cone(O_0 - x)`. Exact for a finite horizon `T`. An infinite horizon
/// gives the closure, which adds velocities that come arbitrarily near and never touch. Unbounded
/// away from the target where the horizon is infinite or own ship is near.
#[derive(Debug, Clone, PartialEq)]
pub struct VelocityObstacle {
    half_planes: Vec<HalfPlane>,
}

impl VelocityObstacle {
    /// For own ship at `position` at t = 0, within `horizon` seconds, which may be infinite. O(n +
    /// m).
    ///
    /// Contains every velocity where the position is in `O_0` or NaN.
    pub fn new(obstacle: &PolytopeObstacle, position: Vector, horizon: f64) -> Self {
        let (initial, velocity) = (obstacle.initial(), obstacle.velocity());
        if obstacle.contains(position, 0.0) {
            return Self {
                half_planes: Vec::new(),
            };
        }
        // within half a turn, so that one of two directions is always to starboard of the other
        let mut starboard = initial.vertices()[0] - position;
        let mut port = starboard;
        for vertex in &initial.vertices()[1..] {
            let ray = vertex - position;
            if cross(starboard, ray) < 0.0 {
                starboard = ray;
            }
            if cross(port, ray) > 0.0 {
                port = ray;
            }
        }
        let horizon = from_zero(horizon);
        let half_plane = |face: &HalfSpace| {
            let reach = face.initial_support - face.normal.dot(&position);
            HalfPlane {
                normal: face.normal,
                offset: face.velocity_support + reach / horizon,
            }
        };
        // the support of the two sides is zero by construction for every horizon
        let side = |normal: Vector| HalfPlane {
            normal,
            offset: velocity.support(normal),
        };
        let mut half_planes = vec![
            side(to_starboard(starboard).normalize()),
            side(to_port(port).normalize()),
        ];
        half_planes.extend(
            obstacle
                .faces()
                .iter()
                .filter(|f| f.normal.dot(&starboard) <= 0.0 && f.normal.dot(&port) <= 0.0)
                .map(half_plane),
        );
        Self { half_planes }
    }

    /// The intersection of half-planes.
    pub(super) fn of(half_planes: Vec<HalfPlane>) -> Self {
        Self { half_planes }
    }

    /// The convex hull of velocities; every velocity when one is NaN.
    fn around(velocities: &[Vector]) -> Self {
        let half_planes = ConvexPolygon::hull(velocities).map_or_else(
            |_| Vec::new(),
            |hull| {
                let half_plane = |normal| HalfPlane {
                    normal,
                    offset: hull.support(normal),
                };
                hull.normals().into_iter().map(half_plane).collect()
            },
        );
        Self { half_planes }
    }

    /// The half-planes; an empty list means every velocity.
    pub fn half_planes(&self) -> &[HalfPlane] {
        &self.half_planes
    }

    /// True when the velocity, m/s, is in the region. NaN is inside. O(half-planes).
    pub fn contains(&self, velocity: Vector) -> bool {
        // negated so that a NaN is inside
        !self
            .half_planes
            .iter()
            .any(|h| h.normal.dot(&velocity) > h.offset)
    }

    /// The part of the region with both components within `limit` m/s, for figures; `None` if
    /// empty.
    pub fn clipped(&self, limit: f64) -> Option<ConvexPolygon> {
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
        let square = corners.map(|(x, y)| Vector::new(x * limit, y * limit));
        let planes = self.half_planes.iter();
        let polygon = planes.fold(square.to_vec(), |polygon, h| {
            clipped(&polygon, |v| h.normal.dot(v) - h.offset)
        });
        ConvexPolygon::hull(&polygon).ok()
    }
}

impl Obstacle {
    /// The velocity obstacle as a union of convex regions.
    ///
    /// `None` for ellipsoids that are not flat: their velocity obstacle is one convex region without
    /// corners, [`super::EllipsoidObstacle::outer_velocities_within`].
    pub fn velocity_obstacles(
        &self,
        position: Vector,
        horizon: f64,
    ) -> Option<Vec<VelocityObstacle>> {
        match self.as_ellipsoid() {
            Some(ellipsoid) => {
                let flat = ellipsoid.flat()?;
                Some(vec![flat.velocity_obstacle(position, horizon)])
            }
            None => Some(self.outer_velocity_obstacles(position, horizon)),
        }
    }

    /// The velocity obstacle within `horizon` seconds as a union of convex regions, one per slab.
    /// O(n log n) in the faces of each slab.
    ///
    /// The vertices of `(O_t - x) / t` move in straight lines with `1 / t`. So the region of a slab
    /// that starts after t = 0 is the convex hull of the sets at its two ends. Exact for a finite
    /// horizon and polygons, the closure for an infinite one. For ellipses it is that of
    /// [`Slab::outer_polytope`]. Contains every velocity where the position is in `O_0` or NaN.
    pub fn outer_velocity_obstacles(
        &self,
        position: Vector,
        horizon: f64,
    ) -> Vec<VelocityObstacle> {
        let horizon = from_zero(horizon);
        let within = self.slabs().iter().filter(|slab| slab.start() <= horizon);
        within
            .map(|slab: &Slab| {
                let (start, end) = (slab.start(), slab.end().min(horizon));
                let Some(obstacle) = slab.outer_polytope(end - start) else {
                    return VelocityObstacle::of(Vec::new());
                };
                if start == 0.0 {
                    return obstacle.velocity_obstacle(position, end);
                }
                let reaching = |section: &ConvexPolygon, time: f64| -> Vec<Vector> {
                    let vertices = section.vertices().iter();
                    vertices.map(|p| (p - position) / time).collect()
                };
                let mut velocities = reaching(obstacle.initial(), start);
                if end.is_finite() {
                    velocities.extend(reaching(&obstacle.section(end - start), end));
                } else {
                    velocities.extend(obstacle.velocity().vertices());
                }
                VelocityObstacle::around(&velocities)
            })
            .collect()
    }
}
