//! Encounters along the desired trajectory, for planning once (docs/reference/colregs.md, section
//! 1.3).

use super::role::{Role, SteadyShip, role_within};
use super::thresholds::{RiskLimits, Thresholds};
use searoom_geometry::frame::{Pose, Vector, cross, heading_of, relative_bearing, wrap};
use searoom_model::target::{Motion, ShipTrack, Target, Uncertainty};
use searoom_model::trajectory::{DesiredLeg, DesiredTrajectory};
use searoom_model::vessel::OwnShip;

/// m/s: below this relative speed the distance of two ships does not change.
pub(super) const NO_RELATIVE_SPEED: f64 = 1e-9;

/// Own ship's role toward a target, and their closest approach on the desired trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Encounter {
    /// Own ship's role.
    pub role: Role,
    /// First instant of risk; `None` without a role.
    pub risk: Option<Risk>,
    /// Least distance of the hulls along the desired trajectory, metres; negative in overlap.
    pub undisturbed_dcpa: f64,
    /// Time of the least distance, seconds.
    pub undisturbed_tcpa: f64,
}

/// First instant of risk of collision by Rule 7.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Risk {
    /// Own ship's role then; [`Role::None`] only at rest.
    pub role: Role,
    /// Seconds.
    pub time: f64,
    /// Own ship then, on the desired trajectory.
    pub own: SteadyShip,
    /// The target then, on its nominal track.
    pub target: SteadyShip,
}

impl Risk {
    /// Seconds at which the centres are closest if both ships hold course and speed.
    pub fn tcpa(&self) -> f64 {
        let relative = self.own.velocity() - self.target.velocity();
        let offset = self.target.pose.position - self.own.pose.position;
        self.time + offset.dot(&relative) / relative.norm_squared()
    }

    /// This risk seen at another time: own ship at a position on its first course, the target
    /// as it is then.
    pub fn with_ships_at(&self, time: f64, own: Vector, target: SteadyShip) -> Self {
        Self {
            time,
            own: SteadyShip {
                pose: Pose::new(own, self.own.pose.heading),
                ..self.own
            },
            target,
            ..*self
        }
    }
}

/// Memory of one target from before the scenario's time.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TargetMemory {
    /// The role that own ship has had since some time, and both ships then.
    pub role: Option<Risk>,
    /// True where the last role has ended: the target is past and clear.
    pub passed: bool,
    /// The target's states at earlier times, in order of time, seconds.
    pub track: Vec<(f64, SteadyShip)>,
}

impl TargetMemory {
    /// The first time at which the target's state is known, seconds.
    pub fn known_from(&self) -> Option<f64> {
        self.track.first().map(|(time, _)| *time)
    }

    /// The target at a time before t = 0, from the last state before; `None` from then on.
    pub fn at(&self, time: f64) -> Option<SteadyShip> {
        (time < 0.0).then(|| state_at(&self.track, time))?
    }
}

/// A ship at a time that keeps course and speed from each state to the next; `None` before the
/// first.
pub(super) fn state_at(track: &[(f64, SteadyShip)], time: f64) -> Option<SteadyShip> {
    let known = track.partition_point(|(t, _)| *t <= time);
    let (then, ship) = track.get(known.checked_sub(1)?)?;
    Some(ship.moved(time - then))
}

/// Metres by which the sweep of a ship domain is scaled: twice the longer ship, or half of own
/// safety margin if that is more (docs/reference/colregs.md, section 3.2).
pub fn sweep_distance(own: &OwnShip, target: &ShipTrack) -> f64 {
    (RiskLimits::STANDARD.lengths * own.hull.length.max(target.hull.length))
        .max(0.5 * own.safety_margin)
}

/// First instant of risk along the desired trajectory against the nominal track
/// (docs/reference/colregs.md 1.3): the distance shrinks, and two ships that hold course and speed
/// will pass within the risk distance and the risk time of the thresholds, or within the target's
/// own risk distance. Searched from 0 to the horizon or the desired arrival, whichever is first. Own
/// ship is on the desired trajectory, wherever it starts. O(legs).
pub fn first_risk(
    own: &OwnShip,
    desired: &DesiredTrajectory,
    target: &ShipTrack,
    horizon: f64,
    thresholds: &Thresholds,
) -> Option<Risk> {
    let risk = &thresholds.risk;
    let allowed = risk.distance(&own.hull, own.safety_margin, &target.hull);
    let allowed = allowed.max(target.risk_distance);
    let mut risks = approaches(own, desired, target, horizon, thresholds);
    risks.find_map(|(risk, distance)| (distance <= allowed).then_some(risk))
}

/// Least distance of the centres, metres, at a closest approach that gives own ship a role if it is
/// a risk: [`first_risk`] without a limit of the distance. `None` where no distance gives a role.
pub fn least_risk_distance(
    own: &OwnShip,
    desired: &DesiredTrajectory,
    target: &ShipTrack,
    horizon: f64,
    thresholds: &Thresholds,
) -> Option<f64> {
    approaches(own, desired, target, horizon, thresholds)
        .filter(|(risk, _)| risk.role.rule().is_some())
        .map(|(_, distance)| distance)
        .min_by(f64::total_cmp)
}

/// The closest approaches that the desired trajectory comes to within the risk time, each as a risk
/// with the distance of the centres, metres.
///
/// Closed form: on a leg the relative velocity is constant, and so is the distance at the closest
/// approach. A leg that is not finite has none: safety rests on the sets, not the role.
fn approaches<'a>(
    own: &OwnShip,
    desired: &'a DesiredTrajectory,
    target: &'a ShipTrack,
    horizon: f64,
    thresholds: &'a Thresholds,
) -> impl Iterator<Item = (Risk, f64)> {
    let soon = thresholds.risk_time(own.hull.length);
    stretches(desired, target, horizon).filter_map(move |(leg, [from, until], theirs)| {
        let theirs = theirs(from);
        let relative = leg.direction * leg.speed - theirs.velocity();
        let speed = relative.norm();
        if !(speed > NO_RELATIVE_SPEED && from < until) {
            return None;
        }
        let offset = theirs.pose.position - steady_on(leg, from).pose.position;
        let closest = from + offset.dot(&relative) / (speed * speed);
        let distance = cross(relative, offset).abs() / speed;
        let time = from.max(closest - soon);
        if !(time < closest && time < until) {
            return None;
        }
        let own = steady_on(leg, time);
        let target = SteadyShip::on_track(target, time);
        role_within(&own, &target, &thresholds.sectors).map(|role| {
            let risk = Risk {
                role,
                time,
                own,
                target,
            };
            (risk, distance)
        })
    })
}

/// The legs of the desired trajectory until the horizon, and the straight runs of the target: each
/// pair with its time interval, and the target's nominal motion in it.
fn stretches<'a>(
    desired: &'a DesiredTrajectory,
    target: &'a ShipTrack,
    horizon: f64,
) -> impl Iterator<Item = (&'a DesiredLeg, [f64; 2], impl Fn(f64) -> SteadyShip)> {
    let ends = target
        .runs()
        .skip(1)
        .map(|run| run.0)
        .chain([f64::INFINITY]);
    let runs: Vec<_> = target.runs().zip(ends).collect();
    desired.legs().iter().flat_map(move |leg| {
        let [start, end] = [leg.start_time, leg.end_time().min(horizon)];
        runs.clone()
            .into_iter()
            .filter_map(move |((begins, pose, speed), ends)| {
                let (from, until) = (start.max(begins), end.min(ends));
                let motion = move |time: f64| SteadyShip::new(pose, speed).moved(time - begins);
                (from <= until).then_some((leg, [from, until], motion))
            })
    })
}

/// Encounter of own ship on the desired trajectory with one target. Explicit sets have no role; the
/// distance is then from own position to the set.
pub fn encounter(
    own: &OwnShip,
    desired: &DesiredTrajectory,
    target: &Target,
    horizon: f64,
    thresholds: &Thresholds,
) -> Encounter {
    let risk = target
        .ship()
        .and_then(|ship| first_risk(own, desired, ship, horizon, thresholds));
    let mut found = Encounter {
        role: risk.map_or(Role::None, |risk| risk.role),
        risk,
        undisturbed_dcpa: f64::INFINITY,
        undisturbed_tcpa: 0.0,
    };
    let mut see = |closest: Closest| {
        if closest.distance < found.undisturbed_dcpa {
            found.undisturbed_dcpa = closest.distance;
            found.undisturbed_tcpa = closest.time;
        }
        found.undisturbed_dcpa
    };
    let mut known = f64::INFINITY;
    match &target.motion {
        Motion::Ship(ship) => {
            for (leg, [from, until], theirs) in stretches(desired, ship, horizon) {
                // the headings are constant: the Minkowski difference of the hulls only translates
                let heading = Pose::new(Vector::zeros(), heading_of(leg.direction));
                let first = theirs(from);
                let other = Pose::new(Vector::zeros(), first.pose.heading);
                let both = ship
                    .hull
                    .polygon(&other)
                    .minkowski_sum(&own.hull.polygon(&heading).negated());
                let closing = leg.speed + first.speed;
                known = see(least([from, until], closing, known, |time| {
                    let ours = leg.start + leg.direction * (leg.speed * (time - leg.start_time));
                    both.signed_distance(ours - theirs(time).pose.position)
                }));
            }
        }
        Motion::Sets(sets) => {
            for leg in desired.legs() {
                let (from, until) = (leg.start_time, leg.end_time().min(horizon));
                if !(from <= until) {
                    break;
                }
                let position = |time: f64| leg.start + leg.direction * (leg.speed * (time - from));
                known = see(closest_to_sets(
                    sets,
                    position,
                    leg.speed,
                    [from, until],
                    known,
                ));
            }
        }
    }
    found
}

/// Closest approach of a point at a constant `speed` (m/s) to the growing set, if it is less than
/// the `known` distance. The distance is convex between two changes of the velocities.
fn closest_to_sets(
    sets: &Uncertainty,
    position: impl Fn(f64) -> Vector,
    speed: f64,
    [from, until]: [f64; 2],
    known: f64,
) -> Closest {
    let mut section = sets.outer_section(from);
    let mut start = from;
    let mut best = Closest {
        distance: known,
        time: from,
    };
    for (end, velocities) in sets.outer_velocities_from(from) {
        let end = end.min(until);
        let at = |time: f64| section.minkowski_sum(&velocities.scaled(time - start));
        let closing = speed + velocities.reach();
        let here = least([start, end], closing, best.distance, |time| {
            at(time).signed_distance(position(time))
        });
        if here.distance < best.distance {
            best = here;
        }
        if !(end < until) {
            break;
        }
        (section, start) = (at(end), end);
    }
    best
}

/// Angle in `[-pi, pi]` of own ship off the target's wake, positive to the target's starboard side.
pub(super) fn offset_from_wake(risk: &Risk) -> f64 {
    let aspect = relative_bearing(&risk.target.pose, risk.own.pose.position);
    -wrap(aspect - std::f64::consts::PI)
}

fn steady_on(leg: &DesiredLeg, time: f64) -> SteadyShip {
    SteadyShip::new(
        Pose::new(
            leg.start + leg.direction * (leg.speed * (time - leg.start_time)),
            heading_of(leg.direction),
        ),
        leg.speed,
    )
}

struct Closest {
    distance: f64,
    time: f64,
}

/// Least distance on an interval by golden section, to about 1e-9 of the interval; among equal
/// values the first one. The distance of two convex sets in steady motion is convex in time,
/// overlap included, and changes by at most `closing` (m/s). Where that bounds it from below by
/// the `known` distance, nothing inside the interval is searched.
fn least(
    [from, until]: [f64; 2],
    closing: f64,
    known: f64,
    distance: impl Fn(f64) -> f64,
) -> Closest {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    const STEPS: usize = 48;
    let at = |time: f64| Closest {
        distance: distance(time),
        time,
    };
    let (first, last) = (at(from), at(until));
    let bound = 0.5 * (first.distance + last.distance - closing * (until - from));
    if bound >= known {
        return first;
    }
    let (mut low, mut high) = (from, until);
    let mut left = at(high - GOLDEN * (high - low));
    let mut right = at(low + GOLDEN * (high - low));
    for _ in 0..STEPS {
        if left.distance <= right.distance {
            high = right.time;
            right = left;
            left = at(high - GOLDEN * (high - low));
        } else {
            low = left.time;
            left = right;
            right = at(low + GOLDEN * (high - low));
        }
    }
    let mut best = first;
    for candidate in [left, right, last] {
        if candidate.distance < best.distance {
            best = candidate;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::super::role::tests::{fixtures as ships, ship};
    use super::*;
    use crate::compliance::{EncounterSamples, roles};
    use crate::ship_fixtures::{self, desired};
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use searoom_geometry::ConvexPolygon;
    use searoom_model::target::{DomainKind, KnownLeg, Representation, Uncertainty};
    use searoom_model::trajectory::{Segment, Trajectory};
    use searoom_model::vessel::Hull;
    use std::f64::consts::PI;

    fn track(s: &SteadyShip, length: f64) -> ShipTrack {
        ShipTrack {
            domain: DomainKind::Colregs,
            ..ShipTrack::exact(s.pose, s.speed, Hull::new(length, 10.0))
        }
    }

    /// A ship within 1500 m, at 1 to 9 m/s.
    fn anywhere(within: &mut impl FnMut(f64) -> f64) -> SteadyShip {
        let (x, y) = (within(1500.0), within(1500.0));
        ship(x, y, within(PI), 5.0 + within(4.0))
    }

    fn own_ship() -> OwnShip {
        OwnShip {
            speed: 6.0,
            hull: Hull::new(50.0, 10.0),
            ..ship_fixtures::own_ship(&[3.0, 6.0])
        }
    }

    /// The encounter with a target on a trajectory at 6 m/s.
    fn met(through: &[(f64, f64)], motion: Motion, horizon: f64) -> Encounter {
        let target = Target {
            name: "other".to_owned(),
            motion,
            representation: Representation::Polytope,
            status: None,
        };
        let desired = desired(through, &vec![6.0; through.len() - 1]);
        let standard = &Thresholds::STANDARD;
        encounter(&own_ship(), &desired, &target, horizon, standard)
    }

    #[test]
    fn the_fixtures_collide_after_120_seconds() {
        for (other, role) in ships() {
            let way = [(0.0, 0.0), (2000.0, 0.0)];
            let found = met(&way, Motion::Ship(track(&other, 50.0)), 400.0);
            assert_eq!(found.role, role);
            // the hulls overlap most when the centres meet
            assert!(found.undisturbed_dcpa <= -10.0 + 1e-6, "{found:?}");
            assert!((found.undisturbed_tcpa - 120.0).abs() < 14.0, "{found:?}");
        }
    }

    #[test]
    fn risk_matches_a_dense_scan_of_its_definition() {
        let mut rng = ChaCha8Rng::seed_from_u64(5);
        let own = own_ship();
        let (mut found_some, mut turning) = (0, 0);
        for _ in 0..1500 {
            let mut within = |r: f64| rng.random_range(-r..r);
            let points = [(0.0, 0.0), (700.0, within(300.0)), (1200.0, within(600.0))];
            let desired = desired(&points, &[6.0; 2]);
            let mut other = track(&anywhere(&mut within), 50.0);
            // every second one turns on its route
            if within(1.0) > 0.0 {
                let place = other.pose.position + other.velocity() * (60.0 + within(50.0));
                let next = place + Vector::new(within(900.0), within(900.0));
                let speeds = [other.speed, 5.0 + within(3.0)];
                let legs = [place, next].into_iter().zip(speeds);
                other = other.with_route(legs.map(|(to, speed)| KnownLeg { to, speed }).collect());
                turning += 1;
            }
            let horizon = 200.0;
            let risk = first_risk(&own, &desired, &other, horizon, &Thresholds::STANDARD);
            let scan = (0..20_000)
                .map(|i| f64::from(i) * 0.01)
                .take_while(|t| *t < desired.duration())
                .find(|t| {
                    let leg = &desired.legs()[usize::from(*t >= desired.legs()[1].start_time)];
                    let x = leg.start + leg.direction * (leg.speed * (t - leg.start_time));
                    let there = SteadyShip::on_track(&other, *t);
                    let r = there.pose.position - x;
                    let w = leg.direction * leg.speed - there.velocity();
                    let tcpa = r.dot(&w) / w.dot(&w);
                    tcpa > 0.0 && tcpa <= 420.0 && (r - w * tcpa).norm() <= 100.0
                });
            match (risk, scan) {
                (None, None) => {}
                (Some(risk), Some(scan)) => {
                    found_some += 1;
                    assert!((risk.time - scan).abs() <= 0.011, "{risk:?} {scan}");
                    let place = desired.position_at(risk.time);
                    assert!((risk.own.pose.position - place).norm() < 1e-9);
                }
                other => panic!("{other:?}"),
            }
        }
        assert!(found_some > 50 && turning > 600, "{found_some} {turning}");
    }

    /// A ship that crosses at 206 m, with hulls that may touch a margin of 185 m, is at risk for the
    /// planner and for the judge; 30 m farther off for neither.
    #[test]
    fn a_ship_that_passes_within_the_safety_margin_is_at_risk() {
        let own = OwnShip {
            safety_margin: 185.0,
            ..own_ship()
        };
        let way = desired(&[(0.0, 0.0), (2000.0, 0.0)], &[6.0]);
        let motion = Segment::straight(Pose::new(Vector::zeros(), 0.0), 0.0, 300.0, 6.0);
        let motion = Trajectory::new(vec![motion]).expect("a trajectory");
        let reach = 185.0 + 2.0 * own.hull.half_diagonal();
        for (off, role) in [(206.0, true), (reach - 0.1, true), (reach + 0.1, false)] {
            // equal speeds at right angles: the centres pass at the offset times sqrt(1/2)
            let other = ship(900.0 + off * 2.0_f64.sqrt(), -900.0, PI / 2.0, 6.0);
            let other = track(&other, 50.0);
            let standard = &Thresholds::STANDARD;
            assert_eq!(
                first_risk(&own, &way, &other, 300.0, standard).is_some(),
                role
            );
            let samples = EncounterSamples::along(&motion, &own, &other);
            assert_eq!(!roles(&samples, standard).is_empty(), role, "{off}");
        }
    }

    #[test]
    fn the_undisturbed_distance_matches_a_dense_scan() {
        let mut rng = ChaCha8Rng::seed_from_u64(6);
        let way = [(0.0, 0.0), (600.0, 100.0), (1200.0, -100.0)];
        let (own, desired) = (own_ship(), desired(&way, &[6.0; 2]));
        for _ in 0..60 {
            let mut within = |r: f64| rng.random_range(-r..r);
            let mut other = track(&anywhere(&mut within), 80.0);
            if within(1.0) > 0.0 {
                let to = other.pose.position + other.velocity() * (50.0 + within(40.0));
                let next = to + Vector::new(within(900.0), within(900.0));
                let legs = [to, next].map(|to| KnownLeg {
                    to,
                    speed: other.speed,
                });
                other = other.with_route(legs.to_vec());
            }
            let found = met(&way, Motion::Ship(other.clone()), 150.0);
            let scan = (0..=15_000)
                .map(|i| {
                    let t = f64::from(i) * 0.01;
                    let leg = &desired.legs()[usize::from(t >= desired.legs()[1].start_time)];
                    let pose = Pose::new(desired.position_at(t), heading_of(leg.direction));
                    let hull = other.hull.polygon(&other.pose_at(t));
                    own.hull.polygon(&pose).separation(&hull)
                })
                .fold(f64::INFINITY, f64::min);
            let more = scan - found.undisturbed_dcpa;
            assert!((-1e-6..0.2).contains(&more), "{found:?} {scan}");
        }
    }

    #[test]
    fn explicit_sets_have_no_role_and_a_distance_to_the_set() {
        let square = |center, half: f64| ConvexPolygon::rectangle(center, half, half);
        let initial = square(Vector::new(300.0, 100.0), 10.0);
        let sets = Uncertainty::constant(initial, square(Vector::zeros(), 0.5));
        let found = met(&[(0.0, 0.0), (600.0, 0.0)], Motion::Sets(sets), 400.0);
        assert_eq!(found.role, Role::None);
        // past its growing corner, which comes nearer still: own way relative to the corner is a
        // line
        let (way, corner) = (Vector::new(5.5, 0.5), Vector::new(310.0, 90.0));
        let exact = cross(way, corner) / way.norm();
        assert!((found.undisturbed_dcpa - exact).abs() < 1e-6, "{found:?}");
    }
}
