//! Hull of a ship over all headings that the ship may have.

use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::{Vector, direction, heading_of, to_port, wrap};
use searoom_geometry::tolerance;
use searoom_model::target::ShipTrack;
use std::f64::consts::TAU;

/// Number of tangents of a turned hull. A quarter of them are parallel to the sides of a rectangle,
/// and together they extend at most 0.13 % of its half-diagonal beyond the hull.
const TANGENTS: usize = 64;

/// Rectangle about a fixed centre, rotated by every angle up to `spread` to either side: the union,
/// or its convex hull.
#[derive(Debug, Clone, Copy)]
pub struct TurnedHull {
    center: Vector,
    /// Directions of the corners at the mean heading, counter-clockwise, radians.
    corners: [f64; 4],
    /// Distance from the centre to a corner, metres.
    reach: f64,
    /// Largest rotation to either side, radians.
    spread: f64,
}

impl TurnedHull {
    /// Hull of a ship at t = 0, over every heading that it may have until `time`.
    pub fn of(ship: &ShipTrack, time: f64) -> Self {
        let (l, b) = (ship.hull.length, ship.hull.beam);
        let corners = [(l, b), (-l, b), (-l, -b), (l, -b)];
        let (middle, spread) = ship.headings(time);
        Self {
            center: ship.pose.position,
            corners: corners.map(|(x, y)| middle + y.atan2(x)),
            reach: 0.5 * l.hypot(b),
            spread,
        }
    }

    /// Exact support in a direction. The corner that can be rotated nearest to the direction
    /// decides.
    pub fn support(&self, n: Vector) -> f64 {
        let towards = heading_of(n);
        let off = |corner: f64| (wrap(towards - corner).abs() - self.spread).max(0.0);
        let nearest = self.corners.map(off).into_iter().fold(f64::NAN, f64::min);
        n.dot(&self.center) + self.reach * nearest.cos()
    }

    /// Returns points whose convex hull contains the turned hull: the ends of the corner arcs, and
    /// the intersections of tangents at most twice `spacing` radians apart.
    pub fn outer_points(&self, spacing: f64) -> impl Iterator<Item = Vector> + '_ {
        let pieces = (self.spread / spacing).ceil().max(1.0);
        let half = self.spread / pieces;
        let at = move |angle: f64, reach: f64| self.center + direction(angle) * reach;
        self.corners.into_iter().flat_map(move |corner| {
            let ends = [-self.spread, self.spread].map(|turn| at(corner + turn, self.reach));
            let between = (0..pieces as usize).map(move |piece| {
                let middle = corner - self.spread + half * (2 * piece + 1) as f64;
                at(middle, self.reach / half.cos())
            });
            ends.into_iter().chain(between)
        })
    }

    /// Polygon of the tangents at even angles, one of them ahead. Sides shorter than the checker's
    /// tolerance are omitted.
    pub fn outer_polygon(&self) -> ConvexPolygon {
        if self.spread == 0.0 {
            return ConvexPolygon::from_ccw(self.outer_points(1.0).collect());
        }
        let ahead = 0.5 * (self.corners[0] + self.corners[3]);
        let step = TAU / TANGENTS as f64;
        let about = Self {
            center: Vector::zeros(),
            ..*self
        };
        let tangents: Vec<(f64, f64)> = (0..TANGENTS)
            .map(|k| step * k as f64)
            .map(|angle| (angle, about.support(direction(ahead + angle))))
            .collect();
        let side = |k: usize| {
            let [before, here, after] =
                [k + TANGENTS - 1, k, k + 1].map(|k| tangents[k % TANGENTS].1);
            (before + after - 2.0 * here * step.cos()) / step.sin()
        };
        let kept: Vec<(f64, f64)> = (0..TANGENTS)
            .filter(|&k| k % (TANGENTS / 4) == 0 || side(k) > tolerance::MARGIN_M)
            .map(|k| tangents[k])
            .collect();
        let next = kept.iter().cycle().skip(1);
        let meet = |((a, here), (b, there)): (&(f64, f64), &(f64, f64))| {
            let (gap, normal) = ((b - a).rem_euclid(TAU), direction(ahead + a));
            let along = (there - here * gap.cos()) / gap.sin();
            self.center + normal * *here + to_port(normal) * along
        };
        ConvexPolygon::from_ccw(kept.iter().zip(next).map(meet).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use searoom_geometry::frame::Pose;
    use searoom_model::vessel::Hull;

    /// Compares with all headings by brute force. The result is never larger than the hull of the
    /// planners.
    #[test]
    fn a_turned_hull_is_every_heading_and_little_more() {
        let mut rng = ChaCha8Rng::seed_from_u64(23);
        for case in 0..400 {
            let length = 10.0_f64.powf(rng.random_range(0.0..3.0));
            let position = Vector::new(rng.random_range(-2e3..2e3), 300.0);
            let ship = ShipTrack {
                course_spread: match case % 4 {
                    0 => 10.0_f64.powf(rng.random_range(-12.0..-3.0)),
                    _ => rng.random_range(0.0..0.4),
                },
                starboard_turn: [0.0, 0.5][case % 2],
                turn_rate: [0.0, 0.01, 0.2][case % 3],
                ..ShipTrack::exact(
                    Pose::new(position, rng.random_range(-3.0..3.0)),
                    5.0,
                    Hull::new(length, length * rng.random_range(0.01..1.2)),
                )
            };
            let time = rng.random_range(0.0..30.0);
            let hull = TurnedHull::of(&ship, time);
            let (outer, planned) = (hull.outer_polygon(), ship.outer_hull(time));
            let points: Vec<Vector> = hull.outer_points(0.1).collect();
            let spread = ship.course_spread + ship.turn_rate * time;
            let width = 2.0 * spread + ship.starboard_turn;
            let turned = (0..=800).map(|k| spread - width * f64::from(k) / 800.0);
            let turned: Vec<ConvexPolygon> = turned
                .map(|turn| Pose::new(position, ship.pose.heading + turn))
                .map(|pose| ship.hull.polygon(&pose))
                .collect();
            let reach = ship.hull.half_diagonal();
            for k in 0..180 {
                let n = direction(0.035 * f64::from(k));
                let so = turned.iter().map(|hull| hull.support(n));
                let so = so.fold(f64::NEG_INFINITY, f64::max);
                let most = points.iter().map(|p| n.dot(p)).fold(so, f64::max);
                let exact = hull.support(n);
                assert!(exact > so - 1e-9 && exact < so + 1e-4 * reach, "{ship:?}");
                assert!(most > exact - 1e-9 && most < exact + 5.1e-3 * reach);
                let outer = outer.support(n);
                assert!(outer > exact - 1e-9 && outer < exact + 1.3e-3 * reach);
                assert!(outer < planned.support(n) + 1e-7, "{ship:?}");
            }
        }
    }
}
