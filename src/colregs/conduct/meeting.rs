//! Two ships that meet, sight after sight: all that the judges see.

use super::super::role::SteadyShip;
use crate::frame::{Vector, relative_bearing, to_port};
use crate::target::ShipTrack;
use crate::trajectory::Trajectory;
use crate::vessel::Hull;

/// Seconds between two sights; the joints of a trajectory are sights, too.
const STEP_S: f64 = 1.0;

/// Steps at most: those of a longer trajectory are longer.
const MOST_SIGHTS: u32 = 20_000;

/// m/s. Below this relative speed two ships keep their distance.
const NO_RELATIVE_SPEED: f64 = 1e-9;

/// Both ships at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// Seconds.
    pub time: f64,
    /// Own ship.
    pub own: SteadyShip,
    /// The target.
    pub target: SteadyShip,
    /// Between the hulls, metres, negative in overlap.
    pub apart: f64,
    /// Seconds until the hulls meet if both hold course and speed; infinite where they never do.
    pub meets_in: f64,
}

/// Where two ships that hold course and speed will be nearest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ahead {
    /// Metres between the centres.
    pub distance: f64,
    /// Seconds from now; negative when it is past, 0 when the distance does not change.
    pub time: f64,
}

impl Sight {
    fn offset(&self) -> Vector {
        self.target.pose.position - self.own.pose.position
    }

    /// Metres between the centres.
    pub fn range(&self) -> f64 {
        self.offset().norm()
    }

    /// How fast the range grows, m/s; a NaN where the centres coincide.
    pub fn opening(&self) -> f64 {
        let relative = self.target.velocity() - self.own.velocity();
        self.offset().dot(&relative) / self.range()
    }

    /// Of the target from own ship, radians clockwise from ahead.
    pub fn bearing(&self) -> f64 {
        relative_bearing(&self.own.pose, self.target.pose.position)
    }

    /// Of own ship from the target, radians clockwise from ahead.
    pub fn aspect(&self) -> f64 {
        relative_bearing(&self.target.pose, self.own.pose.position)
    }

    /// If both hold course and speed.
    pub fn ahead(&self) -> Ahead {
        let relative = self.own.velocity() - self.target.velocity();
        let square = relative.norm_squared();
        if !(square > NO_RELATIVE_SPEED * NO_RELATIVE_SPEED) {
            return Ahead {
                distance: self.range(),
                time: 0.0,
            };
        }
        let time = self.offset().dot(&relative) / square;
        Ahead {
            distance: (self.offset() - relative * time.max(0.0)).norm(),
            time,
        }
    }

    /// Own ship from the target: metres ahead of her, and to port.
    pub fn seen_from_target(&self) -> Vector {
        self.target.pose.body_coordinates(self.own.pose.position)
    }
}

/// All sights of own ship and one target, in order of time.
///
/// # Examples
///
/// ```
/// use searoom::colregs::conduct::Meeting;
/// use searoom::study::compare;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let ferry = scenario.targets[0].ship().expect("a ship");
/// let held = compare::hold_course(&scenario).trajectory;
/// let meeting = Meeting::along(&held, scenario.own_ship.hull, ferry);
/// assert_eq!((meeting.length(), meeting.target_length()), (60.0, 60.0), "metres: the longer ship is hers");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Meeting {
    sights: Vec<Sight>,
    own: Hull,
    target: Hull,
}

impl Meeting {
    /// From the start of a trajectory to its end, the target on her nominal track. O(duration). Own ship's heading is
    /// taken for her course: a drift is not seen.
    pub fn along(trajectory: &Trajectory, own: Hull, target: &ShipTrack) -> Self {
        OwnTrack::along(trajectory, own).meeting(target, f64::INFINITY)
    }

    /// In order of time, at least one.
    pub(crate) fn sights(&self) -> &[Sight] {
        &self.sights
    }

    /// Of the longer ship, metres.
    pub fn length(&self) -> f64 {
        self.own.length.max(self.target.length)
    }

    /// Of the target, metres.
    pub fn target_length(&self) -> f64 {
        self.target.length
    }
}

/// Own ship at the instants of its sights: one for all targets.
#[derive(Debug, Clone)]
pub(crate) struct OwnTrack {
    ships: Vec<(f64, SteadyShip)>,
    hull: Hull,
    /// m/s; infinite where it is not known.
    greatest_speed: f64,
}

impl OwnTrack {
    pub(crate) fn along(trajectory: &Trajectory, hull: Hull) -> Self {
        let at = |time: f64| SteadyShip {
            pose: trajectory.pose_at(time),
            speed: trajectory.speed_at(time),
        };
        let times = trajectory.sample_times(STEP_S, MOST_SIGHTS).into_iter();
        let ships: Vec<_> = times.map(|time| (time, at(time))).collect();
        let speeds = ships.iter().map(|(_, ship)| ship.speed);
        // between two sights one under forces may be faster
        let greatest_speed = match trajectory.steered() {
            Some(_) => f64::INFINITY,
            None => speeds.fold(0.0, f64::max),
        };
        Self {
            greatest_speed,
            ships,
            hull,
        }
    }

    pub(crate) fn hull(&self) -> Hull {
        self.hull
    }

    /// The greatest speed of own ship and a target toward each other, m/s.
    pub(crate) fn closing(&self, target: &ShipTrack) -> f64 {
        self.greatest_speed + target.speed
    }

    /// All sights of a target; of one whose hull never comes within `far` metres the nearest sight alone.
    pub(crate) fn meeting(&self, target: &ShipTrack, far: f64) -> Meeting {
        let nearest = far.is_finite().then(|| self.nearest(target)).flatten();
        let sights = match nearest {
            Some(sight) if sight.apart > far => vec![sight],
            _ => (0..self.ships.len())
                .map(|index| self.sight(index, target))
                .collect(),
        };
        Meeting {
            sights,
            own: self.hull,
            target: target.hull,
        }
    }

    fn sight(&self, index: usize, track: &ShipTrack) -> Sight {
        let (time, own) = self.ships[index];
        let target = SteadyShip {
            pose: track.pose_at(time),
            speed: track.speed,
        };
        let between = Between::of(&self.hull, &own, &track.hull, &target);
        let apart = between.distance();
        let closing = own.velocity() - target.velocity();
        // negated on purpose: a NaN is a meeting
        let meets_in = if !(apart > 0.0) {
            0.0
        } else {
            between.seconds_to(closing)
        };
        Sight {
            time,
            own,
            target,
            apart,
            meets_in,
        }
    }

    /// The first sight of the least distance between the hulls, by branch and bound: between two sights, ships come no closer than
    /// their speeds let them. `None` of what is no number.
    fn nearest(&self, target: &ShipTrack) -> Option<Sight> {
        // turning hulls come closer than their centres
        let swing = self.hull.half_diagonal() + target.hull.half_diagonal();
        let closing = self.closing(target);
        let range = |index: usize| {
            let (time, own) = &self.ships[index];
            (target.pose_at(*time).position - own.pose.position).norm()
        };
        let mut best = self.sight(0, target);
        let mut open = vec![(0, self.ships.len() - 1)];
        while let Some((from, until)) = open.pop() {
            let last = self.sight(until, target);
            if last.apart < best.apart || last.apart == best.apart && last.time < best.time {
                best = last;
            }
            let lasts = self.ships[until].0 - self.ships[from].0;
            let least = 0.5 * (range(from) + range(until) - closing * lasts) - swing;
            // negated on purpose: a NaN is looked at
            if until > from + 1 && !(least > best.apart) {
                let middle = from + (until - from) / 2;
                open.push((middle, until));
                open.push((from, middle));
            }
        }
        best.apart.is_finite().then_some(best)
    }
}

/// Two hulls: where own ship's centre meets the target's hull, about the target's centre less own ship's. A sum of two rectangles, and
/// so the points between four pairs of lines.
struct Between {
    offset: Vector,
    /// Half of own length and beam, and of the target's, each along its axis.
    halves: [(Vector, f64); 4],
}

impl Between {
    fn of(own: &Hull, a: &SteadyShip, target: &Hull, b: &SteadyShip) -> Self {
        let axes = |hull: &Hull, ship: &SteadyShip| {
            let ahead = ship.pose.ahead();
            [
                (ahead, 0.5 * hull.length),
                (to_port(ahead), 0.5 * hull.beam),
            ]
        };
        let ([a1, a2], [b1, b2]) = (axes(own, a), axes(target, b));
        Self {
            offset: b.pose.position - a.pose.position,
            halves: [a1, a2, b1, b2],
        }
    }

    /// The half-width of the sum along a normal.
    fn half(&self, normal: &Vector) -> f64 {
        self.halves
            .iter()
            .map(|(axis, half)| half * normal.dot(axis).abs())
            .sum()
    }

    /// Metres between the hulls, negative in overlap.
    fn distance(&self) -> f64 {
        let beyond = self
            .halves
            .iter()
            .map(|(n, _)| n.dot(&self.offset).abs() - self.half(n));
        let most = beyond.fold(f64::NEG_INFINITY, |most, next| {
            // negated on purpose: a NaN is taken over and stays
            if next <= most || most.is_nan() {
                most
            } else {
                next
            }
        });
        if !(most > 0.0) {
            return most;
        }
        // the nearest points are a corner of one and a point of the other
        let [a, b] = [&self.halves[..2], &self.halves[2..]];
        let corners = |of: &[(Vector, f64)]| {
            let (ahead, aside) = (of[0].0 * of[0].1, of[1].0 * of[1].1);
            [ahead + aside, ahead - aside, aside - ahead, -ahead - aside]
        };
        let away = |of: &[(Vector, f64)], point: Vector| {
            let beyond = |(axis, half): &(Vector, f64)| (axis.dot(&point).abs() - half).max(0.0);
            beyond(&of[0]).hypot(beyond(&of[1]))
        };
        let theirs = corners(b).map(|corner| away(a, self.offset + corner));
        let ours = corners(a).map(|corner| away(b, corner - self.offset));
        theirs.into_iter().chain(ours).fold(f64::INFINITY, f64::min)
    }

    /// Seconds until a point that leaves the origin at a velocity is in the sum; infinite where it never is.
    fn seconds_to(&self, velocity: Vector) -> f64 {
        let (mut from, mut until) = (0.0_f64, f64::INFINITY);
        for (axis, _) in &self.halves {
            for normal in [*axis, -axis] {
                let rate = normal.dot(&velocity);
                let room = normal.dot(&self.offset) + self.half(axis);
                if rate > 0.0 {
                    until = until.min(room / rate);
                } else if rate < 0.0 {
                    from = from.max(room / rate);
                } else if room < 0.0 {
                    return f64::INFINITY;
                }
            }
        }
        if from > until { f64::INFINITY } else { from }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{planned, standard};
    use super::super::{Conduct, Meeting};
    use super::*;
    use crate::frame::Pose;
    use crate::target::DomainKind;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    fn ship(rng: &mut ChaCha8Rng, range: f64) -> SteadyShip {
        let mut within = |r: f64| rng.random_range(-r..r);
        SteadyShip {
            pose: Pose::new(Vector::new(within(range), within(range)), within(3.1)),
            speed: 5.0 + within(4.0),
        }
    }

    /// Against sums of polygons, overlapping, close and far.
    #[test]
    fn the_distance_of_two_hulls_is_that_of_their_polygons() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let (mut met, mut meeting) = (0, 0);
        for case in 0..4000 {
            let range = [30.0, 100.0, 1000.0][case % 3];
            let hull = |rng: &mut ChaCha8Rng| Hull {
                length: rng.random_range(10.0..90.0),
                beam: rng.random_range(3.0..20.0),
            };
            let (own, other) = (hull(&mut rng), hull(&mut rng));
            let (a, b) = (ship(&mut rng, range), ship(&mut rng, range));
            let sum = (other.polygon(&b.pose)).minkowski_sum(&own.polygon(&a.pose).negated());
            let between = Between::of(&own, &a, &other, &b);
            let exact = sum.signed_distance(Vector::zeros());
            assert!((between.distance() - exact).abs() < 1e-9, "{exact}");
            met += usize::from(exact < 0.0);
            let velocity = a.velocity() - b.velocity();
            let after = between.seconds_to(velocity);
            if exact > 0.0 && after.is_finite() {
                meeting += 1;
                assert!(sum.signed_distance(velocity * after).abs() < 1e-6);
            } else if exact > 0.0 {
                let nearest = (0..4000).map(|k| sum.signed_distance(velocity * f64::from(k)));
                assert!(nearest.fold(f64::INFINITY, f64::min) > -1e-6);
            }
        }
        assert!(met > 300 && meeting > 300, "{met} {meeting}");
    }

    /// Judged by the nearest sight alone, a target that stays far away is judged as by all sights.
    #[test]
    fn a_far_target_is_judged_by_its_nearest_sight() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let own = planned(&[(0.0, 240.0), (0.7, 120.0), (-0.9, 300.0)], 6.0);
        let hull = Hull {
            length: 50.0,
            beam: 10.0,
        };
        let track = OwnTrack::along(&own, hull);
        let (mut few, mut all) = (0, 0);
        for case in 0..300 {
            let SteadyShip { pose, speed } = ship(&mut rng, [9e3, 3e4][case % 2]);
            let target = ShipTrack {
                pose,
                speed,
                hull,
                position_std: 0.0,
                speed_spread: 0.0,
                course_spread: 0.0,
                turn_rate: 0.0,
                domain: DomainKind::Hull,
            };
            let whole = Meeting::along(&own, hull, &target);
            let found = Conduct::along(&track, &target, standard());
            assert_eq!(found, Conduct::judge(&whole, standard()));
            match track.meeting(&target, 12e3).sights().len() {
                1 => few += 1,
                _ => all += 1,
            }
        }
        assert!(few > 30 && all > 30, "{few} {all}");
    }
}
