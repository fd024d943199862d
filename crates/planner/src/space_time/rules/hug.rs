//! Hugging: the least hold after which a turn and a line are clear.
//!
//! Own ship holds its course for `h` seconds, turns, and goes on straight. The vertex `o + v t` of a
//! body is then passed at a distance that is linear in `h`: with the place `A` and the time `t_A` after
//! a turn that is begun at once, and the velocities `w` and `b` relative to the vertex on the line and
//! during the hold, the line passes exactly through the vertex for
//!
//! ```text
//! h = − w × (A − o − v t_A) / (w × b)
//! ```
//!
//! So a line that is clear of a body from one hold on touches it there: these holds are tried in
//! order, and no search is needed (docs/reference/rules.md, "Hugging").

use searoom_geometry::frame::{Pose, Vector, cross};
use searoom_model::trajectory::Segment;
use searoom_sets::MovingVertex;

/// Seconds beyond a hold that touches a body.
const BEYOND_S: [f64; 5] = [2.0, 6.0, 14.0, 30.0, 60.0];

/// Seconds to which a hold is found where none touches: among many manoeuvres, and for one.
pub(super) const COARSE_S: f64 = 0.5;
pub(super) const FINE_S: f64 = 0.05;

/// A turn and a line after a hold.
#[derive(Debug, Clone, Copy)]
pub(super) struct HeldTurn {
    /// Where the hold begins.
    pub pose: Pose,
    /// Seconds at which it begins.
    pub time: f64,
    /// Speed during the hold, m/s.
    pub held_speed: f64,
    /// Turn in radians, to port positive, and the speed during and after it, m/s.
    pub turn: f64,
    pub speed: f64,
    /// Turning radius, metres.
    pub radius: f64,
}

impl HeldTurn {
    /// Pose and time after the turn, begun at once.
    fn turned(&self) -> (Pose, f64) {
        let seconds = self.radius * self.turn.abs() / self.speed;
        // without a turn the rate has no meaning
        let rate = if seconds > 0.0 {
            self.turn / seconds
        } else {
            0.0
        };
        let arc = Segment::new(self.pose, self.time, seconds, self.speed, rate);
        (arc.end(), self.time + seconds)
    }

    /// For each body the greatest hold between `least` and `most` after which the line touches a vertex
    /// of it ahead, seconds. After a longer hold a body that has one velocity is on one hand of the line.
    /// A body is given by its vertices and the start of its clock.
    pub(super) fn touching<'b>(
        &self,
        bodies: impl Iterator<Item = (&'b [MovingVertex], f64)>,
        (least, most): (f64, f64),
    ) -> Vec<f64> {
        let (after, at) = self.turned();
        let along = after.ahead() * self.speed;
        let held = self.pose.ahead() * self.held_speed;
        let mut holds = Vec::new();
        for (vertices, start) in bodies {
            let mut farthest = least;
            for vertex in vertices {
                let (line, hold) = (along - vertex.velocity, held - vertex.velocity);
                let moved = vertex.velocity * (at - start);
                let off: Vector = after.position - vertex.origin - moved;
                let touches = -cross(line, off) / cross(line, hold);
                // behind the turn it is not met, and a NaN touches nothing
                let ahead = -(off + hold * touches).dot(&line);
                if touches > farthest && touches < most && ahead >= 0.0 {
                    farthest = touches;
                }
            }
            if farthest > least {
                holds.push(farthest);
            }
        }
        holds
    }
}

/// What a hold leads to.
pub(super) enum Held<T> {
    Clear(T),
    /// Own ship meets something, cannot return, or breaks a rule.
    Blocked,
    /// It is clear and costs too much, as every longer hold does.
    TooDear,
}

impl<T> From<Option<T>> for Held<T> {
    fn from(found: Option<T>) -> Self {
        found.map_or(Self::Blocked, Self::Clear)
    }
}

/// What a trial gives for the least clear hold of `least` to `most` seconds, to `close` seconds, in units
/// of `unit`; nothing where that one is too dear.
///
/// Tried are the least hold, those that touch, and some beyond each before the next, because there may be
/// gaps. Where the turn meets what the line does not, or the line ends before it would touch, a shorter one is
/// found by bisection.
pub(super) fn least_clear<T>(
    (least, most): (f64, f64),
    mut touching: Vec<f64>,
    (unit, close): (f64, f64),
    mut trial: impl FnMut(f64) -> Held<T>,
) -> Option<T> {
    // a NaN has no hold
    if !(least <= most) {
        return None;
    }
    touching.retain(|hold| *hold > least && *hold < most);
    touching.sort_by(f64::total_cmp);
    let close = close * unit;
    match trial(least) {
        Held::Clear(found) => return Some(found),
        Held::TooDear => return None,
        Held::Blocked => {}
    }
    touching.insert(0, least);
    let mut blocked = least;
    for (index, &from) in touching.iter().enumerate() {
        let next = touching.get(index + 1).copied().unwrap_or(most);
        // the least one has been tried
        let here = (index > 0).then_some(from).into_iter();
        let beyond = BEYOND_S.map(|beyond| from + beyond * unit);
        for hold in here.chain(beyond).take_while(|hold| *hold < next) {
            match trial(hold) {
                Held::Blocked => blocked = hold,
                clear => return sooner(blocked, (hold, clear), close, trial),
            }
        }
        blocked = blocked.max(from);
    }
    None
}

/// What the least clear hold leads to after one that is blocked and at most at one that is clear: that one
/// where a little sooner is blocked, as before a line that touches, else by bisection. Nothing where it is
/// too dear.
fn sooner<T>(
    mut blocked: f64,
    mut clear: (f64, Held<T>),
    close: f64,
    mut trial: impl FnMut(f64) -> Held<T>,
) -> Option<T> {
    let mut next = clear.0 - close;
    while clear.0 - blocked > close {
        match trial(next) {
            Held::Blocked => blocked = next,
            found => clear = (next, found),
        }
        next = 0.5 * (blocked + clear.0);
    }
    match clear.1 {
        Held::Clear(found) => Some(found),
        Held::Blocked | Held::TooDear => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::random_vector;
    use rand::{Rng, SeedableRng};
    use searoom_geometry::ConvexPolygon;
    use searoom_geometry::tolerance::TOUCH_M;
    use searoom_sets::{PolytopeObstacle, contact};

    /// Own ship on the line after a hold and a turn, for ten minutes.
    fn line(turn: &HeldTurn, hold: f64) -> Segment {
        let held = Segment::straight(turn.pose, turn.time, hold, turn.held_speed);
        let after = HeldTurn {
            pose: held.end(),
            time: turn.time + hold,
            ..*turn
        };
        let (pose, time) = after.turned();
        Segment::straight(pose, time, 600.0, turn.speed)
    }

    #[test]
    fn a_line_touches_after_the_hold_that_is_found_and_meets_sooner() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(57);
        let (mut found, mut meets_sooner) = (0, 0);
        for _ in 0..6_000 {
            let centre = random_vector(&mut rng, 1_500.0);
            let drift = random_vector(&mut rng, 4.0);
            let mut near = |at: Vector, most: f64| {
                let points: Vec<Vector> =
                    (0..5).map(|_| at + random_vector(&mut rng, most)).collect();
                ConvexPolygon::hull(&points).expect("finite")
            };
            let body = PolytopeObstacle::new("", near(centre, 120.0), near(drift, 0.6));
            let start = rng.random_range(0.0..50.0);
            let turn = HeldTurn {
                pose: Pose::new(Vector::zeros(), rng.random_range(-3.0..3.0)),
                time: start + rng.random_range(0.0..100.0),
                held_speed: 5.0,
                turn: rng.random_range(-2.0..2.0),
                speed: 6.0,
                radius: 100.0,
            };
            let bodies = std::iter::once((body.moving_vertices(), start));
            for hold in turn.touching(bodies, (0.0, f64::INFINITY)) {
                let local = |hold: f64| Segment {
                    start_time: line(&turn, hold).start_time - start,
                    ..line(&turn, hold)
                };
                found += 1;
                let after = local(hold);
                // some vertex is on the line
                let apart = body.moving_vertices().iter().map(|vertex| {
                    let relative = after.velocity_at(after.start_time) - vertex.velocity;
                    let at = vertex.origin + vertex.velocity * after.start_time;
                    cross(relative, after.start.position - at).abs() / relative.norm()
                });
                assert!(apart.fold(f64::INFINITY, f64::min) < 1e-6);
                // a set of velocities may be on both hands of the line
                if contact::meets(&body, &after, TOUCH_M) {
                    continue;
                }
                meets_sooner += usize::from(contact::meets(&body, &local(hold - 0.5), TOUCH_M));
            }
        }
        assert!(found > 500, "{found}");
        assert!(meets_sooner * 2 > found, "{meets_sooner} of {found}");
    }

    #[test]
    fn the_least_clear_hold_is_that_of_a_dense_scan() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(58);
        for case in 0..500 {
            // each body blocks the holds between two, and one blocks a little beyond the last
            let mut blocks: Vec<[f64; 2]> = Vec::new();
            for _ in 0..rng.random_range(0..4) {
                let from = rng.random_range(-50.0..100.0);
                blocks.push([from, from + rng.random_range(1.0..80.0)]);
            }
            let touching: Vec<f64> = blocks.iter().map(|block| block[1]).collect();
            let arc = rng.random_range(0.0..1.0) < 0.3;
            let more = if arc {
                rng.random_range(0.1..20.0)
            } else {
                0.0
            };
            let last = touching.iter().copied().fold(0.0, f64::max);
            let blocked = |hold: f64| {
                blocks
                    .iter()
                    .any(|block| hold > block[0] && hold < block[1])
                    || more > 0.0 && hold > last - 1.0 && hold < last + more
            };
            let close = [FINE_S, COARSE_S][case % 3 % 2];
            let trial = |hold: f64| Held::from((!blocked(hold)).then_some(hold));
            let again = touching.clone();
            let found = least_clear((3.0, 400.0), touching, (1.0, close), trial);
            let found = found.expect("all is clear in the end");
            assert!(found >= 3.0 && !blocked(found));
            let scanned = (0..40_000).map(|k| 3.0 + f64::from(k) * 0.01);
            let least = scanned
                .into_iter()
                .find(|hold| !blocked(*hold))
                .expect("clear");
            assert!(
                found < least + close + 0.02,
                "{found} {least} {blocks:?} {more}"
            );
            // from a hold on it is too dear
            let below = rng.random_range(3.0..200.0);
            let trial = |hold: f64| match blocked(hold) {
                true => Held::Blocked,
                false if hold < below => Held::Clear(hold),
                false => Held::TooDear,
            };
            let cheap = least_clear((3.0, 400.0), again, (1.0, close), trial);
            assert_eq!(cheap, Some(found).filter(|found| *found < below));
        }
    }
}
