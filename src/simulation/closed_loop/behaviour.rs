//! True motion of a target: a course and a speed in each step.

use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::INSTANT;
use super::stream::{Purpose, stream};
use crate::colregs::SteadyShip;
use crate::frame::{Pose, Vector, heading_of, wrap};
use crate::scenario::Behaviour;
use crate::target::ShipTrack;
use crate::vessel::Hull;

/// Courses and speeds to each side that a pursuer chooses from.
const PURSUIT_CHOICES: i32 = 4;

/// m/s. A slower ship keeps its heading.
const NO_WAY: f64 = 1e-6;

/// The true motion of a target. Course and speed are constant within a step.
#[derive(Debug, Clone)]
pub(super) struct TrueTarget {
    pub now: SteadyShip,
    pub hull: Hull,
    /// Course and speed in the file, and what else it may do.
    file: ShipTrack,
    behaviour: Behaviour,
    rng: ChaCha8Rng,
    next_change: f64,
    /// True for a ship that will give way.
    will_give_way: bool,
    gives_way: bool,
}

impl TrueTarget {
    pub fn new(name: &str, ship: &ShipTrack, behaviour: Behaviour, seed: u64) -> Self {
        let mut rng = stream(seed, Purpose::Behaviour, name);
        let will_give_way = match &behaviour {
            Behaviour::GivesWay { probability, .. } => rng.random::<f64>() < *probability,
            _ => false,
        };
        Self {
            now: SteadyShip::on_track(ship, 0.0),
            hull: ship.hull,
            file: ship.clone(),
            behaviour,
            rng,
            next_change: 0.0,
            will_give_way,
            gives_way: false,
        }
    }

    /// Draws anew what is chosen from now on.
    pub fn reseed(&mut self, name: &str, seed: u64) {
        self.rng = stream(seed, Purpose::Behaviour, name);
    }

    /// Chooses course and speed from `time` until `time + step`. O(1), or O(log points) on a track.
    pub fn steer(&mut self, time: f64, step: f64, own: &SteadyShip) {
        let (heading, speed) = (self.file.pose.heading, self.file.speed);
        let is_due = time >= self.next_change - INSTANT;
        match &self.behaviour {
            Behaviour::Constant | Behaviour::Mutual => {}
            Behaviour::Random { every, factor } | Behaviour::Extremes { every, factor }
                if is_due =>
            {
                self.next_change = time + every;
                let extreme = matches!(self.behaviour, Behaviour::Extremes { .. });
                let mut off = |spread: f64| {
                    let part = match extreme {
                        true if self.rng.random_bool(0.5) => 1.0,
                        true => -1.0,
                        false => self.rng.random_range(-1.0..=1.0),
                    };
                    factor * spread * part
                };
                self.now.pose.heading = self.file.middle_course() + off(self.file.course_freedom());
                self.now.speed = (speed + off(self.file.speed_spread)).max(0.0);
            }
            Behaviour::Pursuit { every } if is_due => {
                self.next_change = time + every;
                (self.now.pose.heading, self.now.speed) = self.nearest_approach(own);
            }
            Behaviour::Random { .. } | Behaviour::Extremes { .. } | Behaviour::Pursuit { .. } => {}
            Behaviour::Track(points) => {
                let way = position_on(points, self.file.pose.position, time + step)
                    - self.now.pose.position;
                self.now.speed = way.norm() / step;
                if self.now.speed > NO_WAY {
                    self.now.pose.heading = heading_of(way);
                }
            }
            Behaviour::GivesWay {
                turn,
                before,
                turn_rate,
                ..
            } => {
                let at_first = SteadyShip {
                    pose: Pose::new(self.now.pose.position, heading),
                    speed,
                };
                let ahead = seconds_to_cpa(&at_first, own);
                self.gives_way =
                    self.will_give_way && ahead > 0.0 && (self.gives_way || ahead <= *before);
                let wanted = if self.gives_way {
                    heading - turn
                } else {
                    heading
                };
                let left = wrap(wanted - self.now.pose.heading);
                self.now.pose.heading += left.clamp(-turn_rate * step, turn_rate * step);
            }
        }
    }

    /// The ship `ahead` seconds after `time`: present course and speed until the next random draw,
    /// nominal ones after it.
    pub fn expected(&self, time: f64, ahead: f64) -> SteadyShip {
        let draws = matches!(
            self.behaviour,
            Behaviour::Random { .. } | Behaviour::Extremes { .. }
        );
        let until = (self.next_change - time).max(0.0);
        if !draws || ahead <= until {
            return self.now.moved(ahead);
        }
        let mut then = self.now.moved(until);
        then.pose.heading = self.file.middle_course();
        then.speed = self.file.speed;
        then.moved(ahead - until)
    }

    pub fn advance(&mut self, step: f64) {
        self.now.pose.position += self.now.velocity() * step;
    }

    /// Among the courses and speeds within the spreads, those that come nearest to own ship, if it
    /// holds course and speed; the first of equals.
    fn nearest_approach(&self, own: &SteadyShip) -> (f64, f64) {
        let mut best = (f64::INFINITY, self.now.pose.heading, self.now.speed);
        for course in -PURSUIT_CHOICES..=PURSUIT_CHOICES {
            for speed in -PURSUIT_CHOICES..=PURSUIT_CHOICES {
                let part = |k: i32| f64::from(k) / f64::from(PURSUIT_CHOICES);
                let off = part(course) * self.file.course_freedom();
                let heading = self.file.middle_course() + off;
                let speed = self.file.speed + part(speed) * self.file.speed_spread;
                let ship = SteadyShip {
                    pose: Pose::new(self.now.pose.position, heading),
                    speed: speed.max(0.0),
                };
                let apart = own.pose.position - ship.pose.position;
                let closing = own.velocity() - ship.velocity();
                let time = seconds_to_cpa(&ship, own).max(0.0);
                let nearest = (apart + closing * time).norm();
                if nearest < best.0 {
                    best = (nearest, heading, ship.speed);
                }
            }
        }
        (best.1, best.2)
    }
}

/// Seconds to the closest approach of the centres; 0 where the distance does not change.
fn seconds_to_cpa(ship: &SteadyShip, own: &SteadyShip) -> f64 {
    let apart = own.pose.position - ship.pose.position;
    let closing = own.velocity() - ship.velocity();
    let square = closing.norm_squared();
    if square > NO_WAY * NO_WAY {
        -apart.dot(&closing) / square
    } else {
        0.0
    }
}

/// Place at a time on straight lines through points, beginning at t = 0; the motion of the last
/// line goes on.
fn position_on(points: &[(f64, Vector)], start: Vector, time: f64) -> Vector {
    let after = points.partition_point(|(t, _)| *t <= time);
    let index = after.min(points.len() - 1);
    let before = index.checked_sub(1).map_or((0.0, start), |k| points[k]);
    let (t, p) = points[index];
    before.1 + (p - before.1) * ((time - before.0) / (t - before.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::target::DomainKind;

    fn ship() -> ShipTrack {
        let pose = Pose::new(Vector::new(100.0, 50.0), 1.0);
        ShipTrack {
            speed_spread: 0.5,
            course_spread: 0.1,
            domain: DomainKind::Hull,
            ..ShipTrack::exact(pose, 5.0, Hull::new(60.0, 12.0))
        }
    }

    fn sailed(behaviour: Behaviour, steps: usize) -> Vec<SteadyShip> {
        let mut target = TrueTarget::new("a", &ship(), behaviour, 3);
        let own = SteadyShip::new(Pose::new(Vector::new(-800.0, 900.0), 0.0), 5.0);
        (0..steps)
            .map(|k| {
                target.steer(k as f64 * 0.5, 0.5, &own);
                target.advance(0.5);
                target.now
            })
            .collect()
    }

    #[test]
    fn random_extreme_and_pursuing_targets_keep_to_their_velocities_and_breakers_do_not() {
        let set = ship().outer_velocity_set();
        let (every, factor) = (3.0, 1.0);
        for behaviour in [
            Behaviour::Random { every, factor },
            Behaviour::Extremes { every, factor },
            Behaviour::Pursuit { every: 1.0 },
        ] {
            let states = sailed(behaviour.clone(), 400);
            let out = |s: &SteadyShip| set.signed_distance(s.velocity()) > 1e-9;
            assert!(!states.iter().any(out), "{behaviour:?}");
            let last = states[states.len() - 1].velocity();
            let pursues = matches!(behaviour, Behaviour::Pursuit { .. });
            assert!(pursues || states.iter().any(|s| s.velocity() != last));
        }
        let factor = 1.5;
        let breaker = Behaviour::Extremes { every, factor };
        let out = |s: &SteadyShip| set.signed_distance(s.velocity()) > 1e-3;
        assert!(sailed(breaker, 400).iter().all(out));
    }

    #[test]
    fn a_track_is_met_at_its_points_and_continued() {
        let [first, second] = [50.0, 100.0].map(|north| Vector::new(150.0, north));
        let points = vec![(10.0, first), (20.25, second)];
        let states = sailed(Behaviour::Track(points), 100);
        assert!((states[19].pose.position - first).norm() < 1e-9);
        let last = states[99].pose.position;
        let expected = second + (second - first) * (29.75 / 10.25);
        assert!((last - expected).norm() < 1e-9, "{last}");
    }

    #[test]
    fn a_ship_gives_way_in_time_and_returns_to_its_course() {
        let gives_way = |before, probability| Behaviour::GivesWay {
            turn: 0.7,
            before,
            probability,
            turn_rate: 0.05,
        };
        let states = sailed(gives_way(1e6, 1.0), 100);
        assert!((states[99].pose.heading - 0.3).abs() < 1e-9);
        let pairs = states.windows(2);
        let turning = pairs.map(|s| s[0].pose.heading - s[1].pose.heading);
        assert!(turning.fold(0.0, f64::max) < 0.025 + 1e-9);
        for behaviour in [gives_way(1.0, 1.0), gives_way(1e6, 0.0)] {
            assert!((sailed(behaviour, 40)[39].pose.heading - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn a_pursuer_comes_nearer_than_a_ship_that_holds_on() {
        let nearest = |behaviour| {
            let mut target = TrueTarget::new("a", &ship(), behaviour, 3);
            let mut own = SteadyShip::new(Pose::new(Vector::new(560.0, 0.0), 1.9), 5.0);
            let mut least = f64::INFINITY;
            for k in 0..400 {
                target.steer(f64::from(k) * 0.5, 0.5, &own);
                target.advance(0.5);
                own.pose.position += own.velocity() * 0.5;
                let apart = own.pose.position - target.now.pose.position;
                least = least.min(apart.norm());
            }
            least
        };
        let held = nearest(Behaviour::Constant);
        let pursued = nearest(Behaviour::Pursuit { every: 5.0 });
        assert!(pursued < held - 3.0, "{pursued} {held}");
    }
}
