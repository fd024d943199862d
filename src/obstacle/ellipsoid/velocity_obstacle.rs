//! The velocity obstacle of an ellipsoid as a convex region, by its support function: paper eq.
//! (26).

use std::f64::consts::PI;

use crate::frame::{Vector, cross, direction, heading_of, to_port, to_starboard};
use crate::obstacle::{EllipsoidObstacle, HalfPlane, SpaceTimeObstacle, VelocityObstacle};

/// Bisection steps to the last digit of an angle.
const HALVINGS: usize = 64;

/// Bisection depth of the normals between two tangents; deeper beside an unbounded side.
const MAX_CUTS: u32 = 12;
const MAX_CUTS_AT_SIDES: u32 = 48;

/// Every velocity of own ship that comes within `distance` metres of an ellipsoid within the
/// horizon. At distance 0 this is the velocity obstacle.
///
/// Convex, with a smooth boundary, and unbounded away from the target. With `u = 1/t` the
/// velocities that lead into the section of `t` are the ellipse
///
/// ```text
/// p_v + u z + E(0, (r_o u + r_v)(u Q_o / r_o + Q_v / r_v)),    z = p_o - x
/// ```
///
/// so the region's support is `n . p_v + max over u >= 1/T of c u + sqrt((r_o u + r_v)(a u + b))`
/// with `c = n . z + distance`, `a = n' Q_o n / r_o`, `b = n' Q_v n / r_v`. The root is concave in
/// `u`, so the maximum is at the root of a quadratic or at `1/T`. It is infinite unless `n . (O_0 -
/// x) < -distance`.
///
/// The sides are the two tangents from own ship to the widened `O_0`, each moved outward by the
/// support of `V`. The boundary between them is [`Self::boundary_point`]. Exact for a finite
/// horizon, the closure for an infinite one. The obstacle's sections are outer sets of the exact
/// sum, and so is this region.
#[derive(Debug, Clone, Copy)]
pub struct EllipsoidVelocityObstacle<'a> {
    obstacle: &'a EllipsoidObstacle,
    position: Vector,
    horizon: f64,
    distance: f64,
    /// Heading of the normals of the port and the starboard side. The second is greater by less
    /// than half a turn. `None` where every velocity is in the region.
    sides: Option<[f64; 2]>,
}

/// Coefficients of `c u + sqrt((r_o u + r_v)(a u + b))` for one normal.
#[derive(Debug, Clone, Copy)]
struct Reach {
    c: f64,
    still: [f64; 2],
    growing: [f64; 2],
}

/// A tangent line of the region.
#[derive(Debug, Clone, Copy)]
struct Tangent {
    angle: f64,
    half_plane: HalfPlane,
    /// The tangent point; a side has none.
    at: Option<Vector>,
}

impl Reach {
    fn at(&self, u: f64) -> f64 {
        let ([a, b], [ro, rv]) = (self.still, self.growing);
        self.c * u + ((ro * u + rv) * (a * u + b)).max(0.0).sqrt()
    }

    /// The `u >= least` of the largest value; infinite where it is not attained.
    fn largest_at(&self, least: f64) -> f64 {
        let ([a, b], [ro, rv], c) = (self.still, self.growing, -self.c);
        // the root of c u decreases without bound unless this is positive
        let falling = (c - (ro * a).sqrt()) * (c + (ro * a).sqrt());
        if !(c > 0.0 && falling > 0.0) {
            return f64::INFINITY;
        }
        // the greater root of 4 alpha (alpha - c²) u² + 4 beta (alpha - c²) u + beta² - 4 gamma c²
        // = 0, without cancellation where alpha = r_o a is small; beta² - 4 alpha gamma is a square
        let beta = ro * b + rv * a;
        let below = 2.0 * (c * (ro * b - rv * a).abs() * falling.sqrt() + falling * beta);
        let above = beta * beta - 4.0 * rv * b * c * c;
        if below > 0.0 {
            (above / below).max(least)
        } else {
            least
        }
    }

    /// The limit for `u` to infinity, where the decrease of `c u` is just compensated.
    fn limit(&self) -> f64 {
        let ([a, b], [ro, rv]) = (self.still, self.growing);
        let beta = ro * b + rv * a;
        if beta > 0.0 {
            0.5 * beta / (ro * a).sqrt()
        } else {
            (rv * b).sqrt()
        }
    }
}

impl EllipsoidObstacle {
    /// The velocity obstacle of own ship at `position` at t = 0, within `horizon` seconds, which
    /// may be infinite. O(1).
    ///
    /// Contains every velocity where the position is in `O_0` or NaN.
    pub fn velocity_obstacle(
        &self,
        position: Vector,
        horizon: f64,
    ) -> EllipsoidVelocityObstacle<'_> {
        self.velocities_within(position, horizon, 0.0)
    }

    /// The velocities that come within `distance >= 0` metres. O(1).
    pub fn velocities_within(
        &self,
        position: Vector,
        horizon: f64,
        distance: f64,
    ) -> EllipsoidVelocityObstacle<'_> {
        let mut region = EllipsoidVelocityObstacle {
            obstacle: self,
            position,
            horizon: if horizon.is_nan() {
                f64::INFINITY
            } else {
                horizon.max(0.0)
            },
            distance,
            sides: None,
        };
        let away = self.initial().signed_distance(position);
        // negated so that a NaN, like a position inside, meets it with every velocity
        if !(away.distance > distance) {
            return region;
        }
        // the support of the widened set relative to own ship is negative toward own ship, positive
        // away
        let toward = heading_of(away.normal);
        let side = |way: f64| {
            let (mut inner, mut outer) = (0.0, PI);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (inner + outer);
                let n = direction(toward + way * middle);
                if n.dot(&region.toward()) + self.initial().radius(n) + distance < 0.0 {
                    inner = middle;
                } else {
                    outer = middle;
                }
            }
            toward + way * inner
        };
        region.sides = Some([side(-1.0), side(1.0)]);
        region
    }
}

impl EllipsoidVelocityObstacle<'_> {
    /// True when the velocity, m/s, is in the region. NaN is inside. By the cubic at distance 0,
    /// otherwise by the closest approach.
    pub fn contains(&self, velocity: Vector) -> bool {
        // a flat set without interior holds its own centre up to rounding only
        if self.sides.is_none() {
            return true;
        }
        let (x, horizon) = (self.position, self.horizon);
        if self.distance == 0.0 {
            return self.obstacle.in_velocity_obstacle(x, velocity, horizon);
        }
        let nearest = self.obstacle.closest_approach(x, velocity, horizon);
        // negated so that a NaN is inside
        !(nearest.distance > self.distance)
    }

    /// `max over the region of n . v` for a unit vector, m/s; infinite in unbounded directions.
    /// O(1).
    pub fn support(&self, normal: Vector) -> f64 {
        if self.sides.is_none() {
            return f64::INFINITY;
        }
        let reach = self.reach(normal);
        let u = reach.largest_at(1.0 / self.horizon);
        if u.is_finite() {
            normal.dot(&self.obstacle.velocity().center()) + reach.at(u)
        } else {
            f64::INFINITY
        }
    }

    /// The boundary point with this outward unit normal, m/s; `None` where there is none. O(1).
    pub fn boundary_point(&self, normal: Vector) -> Option<Vector> {
        self.sides?;
        let u = self.reach(normal).largest_at(1.0 / self.horizon);
        if !u.is_finite() {
            return None;
        }
        let [ro, rv] = self.obstacle.roots;
        let [still, growing] = self.obstacle.axes;
        let along = |[a, b]: [Vector; 2]| a * normal.dot(&a) + b * normal.dot(&b);
        let shape = (along(still) * u + along(growing)) * (ro * u + rv);
        let root = shape.dot(&normal).max(0.0).sqrt();
        let round = if root > 0.0 {
            shape / root
        } else {
            Vector::zeros()
        };
        let center = self.obstacle.velocity().center() + self.toward() * u;
        Some(center + round + normal * (self.distance * u))
    }

    /// The port and starboard sides: asymptotes of the boundary. `None` where every velocity is in
    /// the region.
    ///
    /// Their normals are those of the tangents from own ship to `O_0`. An offset is infinite where
    /// the boundary diverges from the side, as for a segment seen end on.
    pub fn sides(&self) -> Option<[HalfPlane; 2]> {
        let side = |angle: f64| {
            let normal = direction(angle);
            HalfPlane {
                normal,
                offset: normal.dot(&self.obstacle.velocity().center()) + self.reach(normal).limit(),
            }
        };
        Some(self.sides?.map(side))
    }

    /// An outer set of half-planes, for figures; an empty list means every velocity.
    ///
    /// Within `limit` m/s in both components it exceeds the region by at most `accuracy` m/s. Some
    /// dozens of half-planes.
    pub fn outer_half_planes(&self, limit: f64, accuracy: f64) -> VelocityObstacle {
        let (Some([first, last]), Some(sides)) = (self.sides, self.sides()) else {
            return VelocityObstacle::of(Vec::new());
        };
        let side = |angle: f64, half_plane: HalfPlane| Tangent {
            angle,
            half_plane,
            at: None,
        };
        let view = View { limit, accuracy };
        let mut found = vec![side(first, sides[0])];
        self.cut(found[0], side(last, sides[1]), 0, &view, &mut found);
        let finite = found.iter().map(|t| t.half_plane);
        VelocityObstacle::of(finite.filter(|h| h.offset.is_finite()).collect())
    }

    /// Adds the tangents between two, and the second.
    fn cut(&self, a: Tangent, b: Tangent, cuts: u32, view: &View, found: &mut Vec<Tangent>) {
        let angle = 0.5 * (a.angle + b.angle);
        let normal = direction(angle);
        let most = if a.at.is_some() && b.at.is_some() {
            MAX_CUTS
        } else {
            MAX_CUTS_AT_SIDES
        };
        if cuts < most && !view.is_close(&a, &b) && angle > a.angle && angle < b.angle {
            let at = self.boundary_point(normal);
            let offset = self.support(normal);
            // rounding beside a side: the side alone remains
            if at.is_some() && offset.is_finite() {
                let middle = Tangent {
                    angle,
                    half_plane: HalfPlane { normal, offset },
                    at,
                };
                self.cut(a, middle, cuts + 1, view, found);
                self.cut(middle, b, cuts + 1, view, found);
                return;
            }
        }
        found.push(b);
    }

    /// From own ship to the centre of `O_0`, metres.
    fn toward(&self) -> Vector {
        self.obstacle.initial().center() - self.position
    }

    fn reach(&self, normal: Vector) -> Reach {
        let square = |[a, b]: [Vector; 2]| normal.dot(&a).powi(2) + normal.dot(&b).powi(2);
        let [still, growing] = self.obstacle.axes;
        Reach {
            c: normal.dot(&self.toward()) + self.distance,
            still: [square(still), square(growing)],
            growing: self.obstacle.roots,
        }
    }
}

/// The visible part of a region.
struct View {
    /// m/s.
    limit: f64,
    /// m/s.
    accuracy: f64,
}

impl View {
    /// True when the corner of two tangents exceeds the boundary by at most the accuracy, or is out
    /// of view.
    fn is_close(&self, a: &Tangent, b: &Tangent) -> bool {
        let (n, m) = (a.half_plane.normal, b.half_plane.normal);
        let far = |p: Option<Vector>| p.is_some_and(|p| !(p.amax() < 4.0 * self.limit));
        let turn = cross(n, m);
        let finite = a.half_plane.offset.is_finite() && b.half_plane.offset.is_finite();
        if !(finite && turn > 0.0) {
            return far(a.at) || far(b.at);
        }
        let corner =
            (to_starboard(m) * a.half_plane.offset + to_port(n) * b.half_plane.offset) / turn;
        let away = match (a.at, b.at) {
            (Some(p), Some(q)) => beside(corner, p, (q - p).norm(), q - p),
            // the region extends along its sides without bound
            (Some(p), None) => beside(corner, p, f64::INFINITY, to_port(m)),
            (None, Some(q)) => beside(corner, q, f64::INFINITY, to_starboard(n)),
            (None, None) => f64::INFINITY,
        };
        away <= self.accuracy
    }
}

/// Distance of a point from a segment of a line, or from a ray.
fn beside(point: Vector, from: Vector, length: f64, way: Vector) -> f64 {
    let arm = point - from;
    let norm = way.norm();
    if !(norm > 0.0) {
        return arm.norm();
    }
    let along = (arm.dot(&way) / norm).clamp(0.0, length);
    (arm - way * (along / norm)).norm()
}
