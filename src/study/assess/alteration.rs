//! Least alteration of course or speed that leaves every velocity obstacle.
//!
//! Every velocity obstacle covers closed arcs of the circle of velocities at own speed, and closed
//! intervals of the ray of velocities on own course. The algorithm starts at own velocity and
//! follows the first arc or interval that covers it to its end. If another one covers that end, the
//! algorithm follows that one, until nothing covers the current velocity.

use std::f64::consts::{FRAC_PI_8, PI};

use super::OwnSituation;
use crate::frame::{Side, Vector, heading_of, wrap, wrap_positive};
use crate::obstacle::{Obstacle, VelocityObstacle};
use crate::tolerance;

/// Maximum number of arc ends followed; each obstacle has a few.
const MAX_ENDS: usize = 100_000;

/// Least alterations of course and of speed, each alone. All are zero if own velocity lies outside
/// every velocity obstacle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Alteration {
    /// Turn to starboard at own speed, radians, in `[0, pi]`; `None` when no turn helps.
    pub starboard: Option<f64>,
    /// Turn to port at own speed, radians, in `[0, pi]`; `None` when no turn helps.
    pub port: Option<f64>,
    /// Change of speed on own course, m/s; negative is slower. It is the smaller of the two
    /// changes; of equal ones, the slower. The new speed is in `[0, max_speed]`. `None` when no
    /// speed helps.
    pub speed: Option<f64>,
}

/// Computes the least turn to either side at own speed, and the least change of speed on own
/// course, that avoids every obstacle. Own ship moves on a straight line from t = 0 and meets no
/// obstacle within the horizon. Turns and speed changes are instantaneous.
///
/// For half-planes, the solution is the angle or speed at which a boundary is crossed. For
/// ellipses, arcs are bisected: an arc is covered if the convex region contains the corners of a
/// triangle around it. The result lies outside the closed sets, beyond the boundary by
/// [`tolerance::ALTERATION_RAD`] or [`tolerance::ALTERATION_MPS`]; for ellipses, by a few of them;
/// and by more, at most three times what it takes, until own ship passes more than
/// [`tolerance::EDGE_M`] from the set. Narrower gaps are ignored. Cost: O(half-planes) per arc; some hundred membership tests per arc
/// for ellipses.
///
/// Source: velocity obstacles, paper eq. (26).
pub fn least_alteration(situation: &OwnSituation) -> Alteration {
    let covers: Vec<Cover> = situation
        .obstacles
        .iter()
        .map(|target| Cover {
            target,
            regions: target.velocity_obstacles(situation.pose.position, situation.horizon),
        })
        .collect();
    let search = Search { situation, covers };
    Alteration {
        starboard: search.turn(Side::Starboard),
        port: search.turn(Side::Port),
        speed: search.speed_change(),
    }
}

struct Cover<'a> {
    target: &'a Obstacle,
    /// `None` for a single convex region given by its membership test.
    regions: Option<Vec<VelocityObstacle>>,
}

struct Search<'a> {
    situation: &'a OwnSituation<'a>,
    covers: Vec<Cover<'a>>,
}

impl Search<'_> {
    fn covered_by(&self, cover: &Cover, velocity: Vector) -> bool {
        let nearest = self.situation.closest_approach(cover.target, velocity);
        nearest.distance == 0.0
    }

    fn covering(&self, velocity: Vector) -> Option<&Cover<'_>> {
        self.covers.iter().find(|c| self.covered_by(c, velocity))
    }

    fn turn(&self, side: Side) -> Option<f64> {
        let OwnSituation { pose, speed, .. } = *self.situation;
        let sign = side.turn_sign();
        let velocity = |turn: f64| {
            self.situation
                .velocity_on(pose.heading + sign * turn, speed)
        };
        let (mut turn, mut beyond) = (0.0, tolerance::ALTERATION_RAD);
        for _ in 0..MAX_ENDS {
            let Some(cover) = self.covering(velocity(turn)) else {
                return Some(turn);
            };
            let end = match &cover.regions {
                Some(regions) => match regions.iter().find(|r| r.contains(velocity(turn))) {
                    Some(region) => {
                        beyond = tolerance::ALTERATION_RAD;
                        let clockwise = |angle: f64| sign * (angle - pose.heading);
                        turn_out_of(region, clockwise, speed, turn)
                    }
                    // beyond the region, but not yet off the edge of the set
                    None => {
                        beyond *= 2.0;
                        Some(turn)
                    }
                },
                None => {
                    let inside = |v| self.covered_by(cover, v);
                    let on_circle = |at: f64, factor: f64| velocity(at) * factor;
                    first_out(&on_circle, &inside, turn)
                }
            };
            turn = end? + beyond;
            if turn > PI || speed == 0.0 {
                return None;
            }
        }
        None
    }

    fn speed_change(&self) -> Option<f64> {
        let own = self.situation.speed;
        let most = self.situation.max_speed.max(own);
        if self.covering(self.situation.velocity()).is_none() {
            return Some(0.0);
        }
        let slower = self.speed(0.0).map(|speed| own - speed);
        let faster = self.speed(most).map(|speed| speed - own);
        match (slower, faster) {
            (Some(slower), Some(faster)) if faster < slower => Some(faster),
            (Some(slower), _) => Some(-slower),
            (None, faster) => faster,
        }
    }

    /// First free speed from own speed towards `limit`.
    fn speed(&self, limit: f64) -> Option<f64> {
        let OwnSituation { pose, speed, .. } = *self.situation;
        let ahead = pose.ahead();
        let way = if limit < speed { -1.0 } else { 1.0 };
        let (mut at, mut beyond) = (speed, tolerance::ALTERATION_MPS);
        for _ in 0..MAX_ENDS {
            let Some(cover) = self.covering(ahead * at) else {
                return Some(at);
            };
            if at == limit {
                return None;
            }
            let end = match &cover.regions {
                Some(regions) => match regions.iter().find(|r| r.contains(ahead * at)) {
                    Some(region) => {
                        beyond = tolerance::ALTERATION_MPS;
                        speed_out_of(region, ahead, way, at)
                    }
                    None => {
                        beyond *= 2.0;
                        Some(at)
                    }
                },
                None => self.end_of_interval(cover, ahead, at, limit),
            };
            let next = end? + way * beyond;
            // the limit itself may be free
            at = if way * (next - limit) > 0.0 {
                limit
            } else {
                next
            };
        }
        None
    }

    /// End of the interval that contains `at`, towards `limit`. Bisection is exact on the interval
    /// of a convex region.
    fn end_of_interval(&self, cover: &Cover, ahead: Vector, at: f64, limit: f64) -> Option<f64> {
        if self.covered_by(cover, ahead * limit) {
            return None;
        }
        let (mut held, mut free) = (at, limit);
        while (free - held).abs() > tolerance::ALTERATION_MPS {
            let middle = 0.5 * (held + free);
            if self.covered_by(cover, ahead * middle) {
                held = middle;
            } else {
                free = middle;
            }
        }
        Some(free)
    }
}

/// First turn from `turn` on at which one of the half-planes excludes the velocity. `turned` maps a
/// heading to a turn.
fn turn_out_of(
    region: &VelocityObstacle,
    turned: impl Fn(f64) -> f64,
    speed: f64,
    turn: f64,
) -> Option<f64> {
    let mut first: Option<f64> = None;
    for h in region.half_planes() {
        let ratio = h.offset / speed;
        // negated on purpose: a NaN excludes nothing
        if !(ratio < 1.0) {
            continue;
        }
        let half = ratio.max(-1.0).acos();
        let center = turned(heading_of(h.normal));
        let out = if wrap(turn - center).abs() < half + tolerance::DUPLICATE {
            turn
        } else {
            turn + wrap_positive(center - half - turn)
        };
        first = Some(first.map_or(out, |f: f64| f.min(out)));
    }
    first
}

/// First speed from `at` on, upwards or downwards, at which one of the half-planes excludes the
/// velocity.
fn speed_out_of(region: &VelocityObstacle, ahead: Vector, way: f64, at: f64) -> Option<f64> {
    region
        .half_planes()
        .iter()
        .filter(|h| way * h.normal.dot(&ahead) > 0.0)
        .map(|h| way * (way * h.offset / h.normal.dot(&ahead)).max(way * at))
        .min_by(|a, b| (way * a).total_cmp(&(way * b)))
        .filter(|speed| *speed >= 0.0)
}

/// First turn from `turn` on at which the velocity leaves a convex region. `on_circle` returns the
/// scaled velocity after a turn.
fn first_out(
    on_circle: &impl Fn(f64, f64) -> Vector,
    inside: &impl Fn(Vector) -> bool,
    turn: f64,
) -> Option<f64> {
    let end = PI + tolerance::ALTERATION_RAD;
    let mut from = turn;
    while from < end {
        let to = (from + FRAC_PI_8).min(end);
        if let Some(out) = first_out_within(on_circle, inside, from, to) {
            return Some(out);
        }
        from = to;
    }
    None
}

/// [`first_out`] on an arc of less than half a turn. The tangents at its ends meet beyond its
/// middle. The triangle of that corner and the ends contains the arc.
fn first_out_within(
    on_circle: &impl Fn(f64, f64) -> Vector,
    inside: &impl Fn(Vector) -> bool,
    from: f64,
    to: f64,
) -> Option<f64> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let to_inside = inside(on_circle(to, 1.0));
    let corner = on_circle(middle, 1.0 / half.cos());
    if to_inside && inside(on_circle(from, 1.0)) && inside(corner) {
        return None;
    }
    if to - from <= tolerance::ALTERATION_RAD {
        return (!to_inside).then_some(to);
    }
    first_out_within(on_circle, inside, from, middle)
        .or_else(|| first_out_within(on_circle, inside, middle, to))
}
