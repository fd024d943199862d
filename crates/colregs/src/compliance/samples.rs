//! Samples of an encounter of own ship and one target: the only input of the assessment.

use crate::between_hulls::BetweenHulls;
use crate::encounter::{NO_RELATIVE_SPEED, state_at};
use crate::{Risk, SteadyShip, TargetMemory, Thresholds};
use searoom_geometry::frame::{Pose, Vector, relative_bearing, wrap};
use searoom_geometry::tolerance;
use searoom_model::target::ShipTrack;
use searoom_model::trajectory::{GroundSegment, Segment, Trajectory};
use searoom_model::vessel::{Hull, OwnShip};

/// Seconds between two samples; the joints of a trajectory are samples too.
const STEP_S: f64 = 1.0;

/// Most steps; a longer trajectory has longer steps.
const MOST_SAMPLES: u32 = 5_000;

/// Both ships at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EncounterSample {
    /// Seconds.
    pub time: f64,
    /// Own ship.
    pub own: SteadyShip,
    /// The target.
    pub target: SteadyShip,
    /// Distance of the hulls, metres, negative in overlap.
    pub apart: f64,
    /// Seconds until the hulls meet if both hold course and speed; infinite if they never do.
    pub meets_in: f64,
    /// Own velocity less the target's, m/s.
    closing: Vector,
}

/// Closest approach of two ships that hold course and speed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ahead {
    /// Metres between the centres.
    pub distance: f64,
    /// Seconds from now; negative if it is past, 0 if the distance does not change.
    pub time: f64,
}

impl EncounterSample {
    fn offset(&self) -> Vector {
        self.target.pose.position - self.own.pose.position
    }

    /// This sample with own ship at another speed, m/s.
    pub fn at_speed(&self, speed: f64) -> Self {
        self.with_own(SteadyShip { speed, ..self.own })
    }

    fn with_own(&self, own: SteadyShip) -> Self {
        self.with_ships(own, self.target)
    }

    /// This sample with both ships elsewhere. `apart` and `meets_in` stay as they are.
    pub(super) fn with_ships(&self, own: SteadyShip, target: SteadyShip) -> Self {
        Self {
            own,
            target,
            closing: own.velocity() - target.velocity(),
            ..*self
        }
    }

    /// True if own ship, on its first course and at its first speed again, would have the target
    /// behind: the closest approach is over.
    pub fn is_past(&self, first: &SteadyShip) -> bool {
        let own = SteadyShip::new(
            Pose::new(self.own.pose.position, first.pose.heading),
            first.speed,
        );
        self.with_own(own).ahead().time <= 0.0
    }

    /// Metres between the centres.
    pub fn range(&self) -> f64 {
        self.offset().norm()
    }

    /// Rate at which the range grows, m/s; a NaN if the centres coincide.
    pub fn opening(&self) -> f64 {
        -self.offset().dot(&self.closing) / self.range()
    }

    /// Bearing of the target from own ship, radians clockwise from ahead.
    pub fn bearing(&self) -> f64 {
        relative_bearing(&self.own.pose, self.target.pose.position)
    }

    /// Bearing of own ship from the target, radians clockwise from ahead.
    pub fn aspect(&self) -> f64 {
        relative_bearing(&self.target.pose, self.own.pose.position)
    }

    /// Closest approach if both hold course and speed.
    pub fn ahead(&self) -> Ahead {
        let square = self.closing.norm_squared();
        if !(square > NO_RELATIVE_SPEED * NO_RELATIVE_SPEED) {
            return Ahead {
                distance: self.range(),
                time: 0.0,
            };
        }
        let time = self.offset().dot(&self.closing) / square;
        Ahead {
            distance: (self.offset() - self.closing * time.max(0.0)).norm(),
            time,
        }
    }

    /// Own ship in the frame of the target: metres ahead, and to port.
    pub fn seen_from_target(&self) -> Vector {
        self.target.pose.body_coordinates(self.own.pose.position)
    }
}

/// All samples of own ship and one target, in order of time.
#[derive(Debug, Clone, PartialEq)]
pub struct EncounterSamples {
    samples: Vec<EncounterSample>,
    known_role: Option<Risk>,
    own: Hull,
    safety_margin: f64,
    ordered_speed: f64,
    target: Hull,
    /// Metres: [`ShipTrack::risk_distance`].
    target_risk_distance: f64,
}

impl EncounterSamples {
    /// Samples from the start of a trajectory to its end, the target on its nominal track. Own
    /// ship's heading is taken for its course: drift is not seen. Its `speed` is that before any
    /// manoeuvre, also where the trajectory changes it at once. O(duration).
    pub fn along(trajectory: &Trajectory, own: &OwnShip, target: &ShipTrack) -> Self {
        OwnSamples::along(&[], trajectory, own).encounter(target, None, f64::INFINITY)
    }

    /// Samples of a motion that was sailed, and of a target that kept course and speed from each of
    /// these states to the next; times in seconds, the first not after the motion's start. Own ship's
    /// heading counts as its course.
    pub fn of_tracks<S: Copy + Into<GroundSegment>>(
        sailed: &[S],
        own: &OwnShip,
        target: &[(f64, SteadyShip)],
        hull: Hull,
    ) -> Self {
        let own = OwnSamples::new(sampled(sailed), f64::INFINITY, own);
        let sample = |index: usize| {
            let there = state_at(target, own.ships[index].0)?;
            Some(own.sample(index, &hull, there, there.pose.ahead()))
        };
        Self {
            samples: (0..own.ships.len()).filter_map(sample).collect(),
            known_role: None,
            own: own.hull,
            safety_margin: own.safety_margin,
            ordered_speed: own.ordered_speed,
            target: hull,
            target_risk_distance: 0.0,
        }
    }

    /// The samples in order of time, at least one.
    pub fn samples(&self) -> &[EncounterSample] {
        &self.samples
    }

    /// The role that own ship has had since before some sample, and both ships when it began.
    pub fn known_role(&self) -> Option<&Risk> {
        self.known_role.as_ref()
    }

    /// Length of the longer ship, metres.
    pub fn length(&self) -> f64 {
        self.own.length.max(self.target.length)
    }

    /// Greatest distance of the centres at a closest approach with risk, metres.
    pub(crate) fn risk_distance(&self, thresholds: &Thresholds) -> f64 {
        (thresholds.risk)
            .distance(&self.own, self.safety_margin, &self.target)
            .max(self.target_risk_distance)
    }

    /// Length of own ship, metres.
    pub fn own_length(&self) -> f64 {
        self.own.length
    }

    /// Own ship's speed before any manoeuvre, m/s.
    pub fn ordered_speed(&self) -> f64 {
        self.ordered_speed
    }

    /// Length of the target, metres.
    pub fn target_length(&self) -> f64 {
        self.target.length
    }
}

/// Samples of own ship, common to all targets.
#[derive(Debug, Clone)]
pub struct OwnSamples {
    ships: Vec<(f64, SteadyShip)>,
    /// Unit vector ahead of own ship at each sample.
    ahead: Vec<Vector>,
    hull: Hull,
    safety_margin: f64,
    ordered_speed: f64,
    /// m/s; infinite if unknown.
    greatest_speed: f64,
}

impl OwnSamples {
    /// Along the motion so far, whose times are negative, and a trajectory from t = 0 on.
    pub fn along(sailed: &[Segment], trajectory: &Trajectory, own: &OwnShip) -> Self {
        let at = |time: f64| SteadyShip::new(trajectory.pose_at(time), trajectory.speed_at(time));
        let mut ships = sampled(sailed);
        let times = trajectory.sample_times(STEP_S, MOST_SAMPLES).into_iter();
        ships.extend(times.map(|time| (time, at(time))));
        let speeds = ships.iter().map(|(_, ship)| ship.speed);
        // a trajectory under forces may be faster between two samples
        let greatest_speed = match trajectory.steered() {
            Some(_) => f64::INFINITY,
            None => speeds.fold(0.0, f64::max),
        };
        Self::new(ships, greatest_speed, own)
    }

    /// The motion so far alone, and own ship at its end.
    pub fn of_past(sailed: &[Segment], now: SteadyShip, own: &OwnShip) -> Self {
        let mut ships = sampled(sailed);
        ships.push((0.0, now));
        Self::new(ships, f64::INFINITY, own)
    }

    fn new(ships: Vec<(f64, SteadyShip)>, greatest_speed: f64, own: &OwnShip) -> Self {
        Self {
            ahead: ships.iter().map(|(_, ship)| ship.pose.ahead()).collect(),
            ships,
            hull: own.hull,
            safety_margin: own.safety_margin,
            ordered_speed: own.speed,
            greatest_speed,
        }
    }

    /// Greatest distance of the centres at a closest approach with risk, metres.
    pub(crate) fn risk_distance(&self, target: &ShipTrack, thresholds: &Thresholds) -> f64 {
        (thresholds.risk)
            .distance(&self.hull, self.safety_margin, &target.hull)
            .max(target.risk_distance)
    }

    pub(crate) fn hull(&self) -> Hull {
        self.hull
    }

    /// Greatest closing speed of own ship and a target, m/s.
    pub(crate) fn closing(&self, target: &ShipTrack) -> f64 {
        self.greatest_speed + target.greatest_speed()
    }

    /// All samples of a target, or the nearest sample alone if the hulls are never within `far`
    /// metres. With a memory, all samples from its first state on.
    pub(crate) fn encounter(
        &self,
        target: &ShipTrack,
        memory: Option<&TargetMemory>,
        far: f64,
    ) -> EncounterSamples {
        // as `moved`, with the direction taken once
        let now = SteadyShip::on_track(target, 0.0);
        let (ahead, velocity) = (now.pose.ahead(), now.velocity());
        let nominal = |time: f64| {
            if target.route.is_empty() {
                let place = now.pose.position + velocity * time;
                let there = SteadyShip::new(Pose::new(place, now.pose.heading), now.speed);
                return (there, ahead);
            }
            let there = SteadyShip::on_track(target, time);
            (there, there.pose.ahead())
        };
        let at = |index: usize, (there, ahead)| self.sample(index, &target.hull, there, ahead);
        let near = || match memory {
            None if far.is_finite() && target.route.is_empty() => self.nearest(target),
            _ => None,
        };
        let samples = match near() {
            Some((index, apart)) if apart > far => {
                vec![at(index, nominal(self.ships[index].0))]
            }
            _ => {
                let known = memory.and_then(TargetMemory::known_from).unwrap_or(0.0);
                let known = (0..self.ships.len()).filter(|index| self.ships[*index].0 >= known);
                known
                    .map(|index| {
                        let time = self.ships[index].0;
                        let past = memory.and_then(|memory| memory.at(time));
                        let past = past.map(|there| (there, there.pose.ahead()));
                        at(index, past.unwrap_or_else(|| nominal(time)))
                    })
                    .collect()
            }
        };
        EncounterSamples {
            samples,
            known_role: memory.and_then(|memory| memory.role),
            own: self.hull,
            safety_margin: self.safety_margin,
            ordered_speed: self.ordered_speed,
            target: target.hull,
            target_risk_distance: target.risk_distance,
        }
    }

    fn sample(
        &self,
        index: usize,
        hull: &Hull,
        target: SteadyShip,
        target_ahead: Vector,
    ) -> EncounterSample {
        let ((time, own), ahead) = (self.ships[index], self.ahead[index]);
        let offset = target.pose.position - own.pose.position;
        let between = BetweenHulls::new(offset, (&self.hull, ahead), (hull, target_ahead));
        let apart = between.distance();
        let closing = ahead * own.speed - target_ahead * target.speed;
        // negated on purpose: a NaN is a meeting
        let meets_in = if !(apart > 0.0) {
            0.0
        } else {
            between.seconds_to(closing)
        };
        EncounterSample {
            time,
            own,
            target,
            apart,
            meets_in,
            closing,
        }
    }

    /// Index of the first sample of the least distance of the hulls, and that distance, by branch
    /// and bound. `None` if the distance is not finite.
    ///
    /// Between two samples own ship is within half of `sqrt(way² - chord²)` of the uniform motion
    /// along the chord, where `way` is the most that it can move: by Stewart's theorem for the
    /// triangle of both samples and its position.
    fn nearest(&self, target: &ShipTrack) -> Option<(usize, f64)> {
        // turning hulls come closer than their centres
        let swing = self.hull.half_diagonal() + target.hull.half_diagonal();
        let position = |index: usize| self.ships[index].1.pose.position;
        let offset = |index: usize| target.pose_at(self.ships[index].0).position - position(index);
        let apart = |index: usize| {
            let (time, own) = &self.ships[index];
            let there = target.pose_at(*time);
            let offset = there.position - own.pose.position;
            let own = (&self.hull, self.ahead[index]);
            BetweenHulls::new(offset, own, (&target.hull, there.ahead())).distance()
        };
        let mut best = (0, apart(0));
        let mut open = vec![(0, self.ships.len() - 1)];
        while let Some((from, until)) = open.pop() {
            let last = apart(until);
            if last < best.1 || last == best.1 && until < best.0 {
                best = (until, last);
            }
            let way = self.greatest_speed * (self.ships[until].0 - self.ships[from].0);
            // shortened by more than the difference of the squares is rounded
            let chord = (position(until) - position(from)).norm() * (1.0 - tolerance::LIMIT);
            let (here, change) = (offset(from), offset(until) - offset(from));
            let closest = (-here.dot(&change) / change.norm_squared()).clamp(0.0, 1.0);
            let beside = 0.5 * (way * way - chord * chord).max(0.0).sqrt();
            let least = (here + change * closest).norm() - beside - swing;
            // negated on purpose: a NaN is searched
            if until > from + 1 && !(least > best.1) {
                let middle = from + (until - from) / 2;
                open.push((middle, until));
                open.push((from, middle));
            }
        }
        best.1.is_finite().then_some(best)
    }
}

/// Samples of the motion so far: its joints, and every second from each.
fn sampled<S: Copy + Into<GroundSegment>>(sailed: &[S]) -> Vec<(f64, SteadyShip)> {
    let sailed = sailed.iter().map(|s| (*s).into());
    let samples = sailed.flat_map(|s: GroundSegment| {
        let steps = (s.track.duration / STEP_S)
            .ceil()
            .max(1.0)
            .min(f64::from(MOST_SAMPLES));
        (0..steps as usize).map(move |k| {
            let time = s.track.start_time + STEP_S * k as f64;
            let ship = SteadyShip::new(s.pose_at(time), s.track.speed);
            (time, ship)
        })
    });
    samples.collect()
}

/// An uninterrupted turn to one side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CourseChange {
    /// Seconds.
    pub from: f64,
    /// Seconds.
    pub until: f64,
    /// Radians, to port positive.
    pub turn: f64,
}

/// Turns faster than `least_rate` (rad/s) of more than `least_turn` in total (radians), in order of
/// time.
pub fn alterations(
    samples: &[EncounterSample],
    least_rate: f64,
    least_turn: f64,
) -> Vec<CourseChange> {
    let mut found: Vec<CourseChange> = Vec::new();
    for pair in samples.windows(2) {
        let (from, until) = (pair[0].time, pair[1].time);
        let turn = wrap(pair[1].own.pose.heading - pair[0].own.pose.heading);
        if !(turn.abs() > least_rate * (until - from)) {
            continue;
        }
        match found.last_mut() {
            Some(last) if last.until == from && last.turn * turn > 0.0 => {
                last.until = until;
                last.turn += turn;
            }
            _ => found.push(CourseChange { from, until, turn }),
        }
    }
    found.retain(|a| a.turn.abs() > least_turn);
    found
}

/// Time of the first sample at which the speed differs by more than a fraction of another.
pub fn speed_changed(samples: &[EncounterSample], from: f64, fraction: f64) -> Option<f64> {
    let changed = |s: &&EncounterSample| (s.own.speed - from).abs() > fraction * from;
    samples.iter().find(changed).map(|s| s.time)
}

/// Changes of speed by more than `least` (m/s) from `ordered_speed` on: a slow change counts once.
pub fn speed_changes(samples: &[EncounterSample], ordered_speed: f64, least: f64) -> Vec<f64> {
    let mut changes: Vec<f64> = Vec::new();
    let (mut last, mut going) = (ordered_speed, false);
    for sample in samples {
        let change = sample.own.speed - last;
        last = sample.own.speed;
        match changes.last_mut() {
            _ if change == 0.0 => going = false,
            Some(before) if going && *before * change > 0.0 => *before += change,
            _ => {
                changes.push(change);
                going = true;
            }
        }
    }
    changes.retain(|change| change.abs() > least);
    changes
}

#[cfg(test)]
mod tests {
    use super::super::tests::{LENGTH, own_ship, planned, standard, steady};
    use super::super::{ComplianceReport, EncounterSamples};
    use super::*;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use searoom_geometry::frame::Pose;

    fn ship(rng: &mut ChaCha8Rng, range: f64) -> SteadyShip {
        let mut within = |r: f64| rng.random_range(-r..r);
        SteadyShip::new(
            Pose::new(Vector::new(within(range), within(range)), within(3.1)),
            5.0 + within(4.0),
        )
    }

    /// Against sums of polygons, overlapping, close and far.
    #[test]
    fn the_distance_of_two_hulls_is_that_of_their_polygons() {
        let mut rng = ChaCha8Rng::seed_from_u64(3);
        let (mut met, mut meeting) = (0, 0);
        for case in 0..4000 {
            let range = [30.0, 100.0, 1000.0][case % 3];
            let hull = |rng: &mut ChaCha8Rng| {
                Hull::new(rng.random_range(10.0..90.0), rng.random_range(3.0..20.0))
            };
            let (own, other) = (hull(&mut rng), hull(&mut rng));
            let (a, b) = (ship(&mut rng, range), ship(&mut rng, range));
            let sum = (other.polygon(&b.pose)).minkowski_sum(&own.polygon(&a.pose).negated());
            let offset = b.pose.position - a.pose.position;
            let between =
                BetweenHulls::new(offset, (&own, a.pose.ahead()), (&other, b.pose.ahead()));
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

    /// A target that stays far away is assessed by its nearest sample as by all samples.
    #[test]
    fn a_far_target_is_judged_by_its_nearest_sight() {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let own = planned(&[(0.0, 240.0), (0.7, 120.0), (-0.9, 300.0)], 6.0);
        let ours = own_ship();
        let hull = ours.hull;
        let track = OwnSamples::along(&[], &own, &ours);
        let (mut few, mut all) = (0, 0);
        for case in 0..300 {
            let SteadyShip { pose, speed } = ship(&mut rng, [9e3, 3e4][case % 2]);
            let target = ShipTrack::exact(pose, speed, hull);
            let whole = EncounterSamples::along(&own, &ours, &target);
            let samples = ComplianceReport::samples(&track, &target, None, standard());
            let found = ComplianceReport::judge(&samples, standard());
            assert_eq!(found, ComplianceReport::judge(&whole, standard()));
            match track.encounter(&target, None, 12e3).samples().len() {
                1 => few += 1,
                _ => all += 1,
            }
        }
        assert!(few > 30 && all > 30, "{few} {all}");
    }

    #[test]
    fn a_turn_out_and_back_are_two_alterations_with_their_angles() {
        let own = planned(&[(0.0, 40.0), (-0.6, 30.0), (0.6, 60.0)], 6.0);
        let meeting = steady(&own, 1440.0, 0.0, std::f64::consts::PI, 6.0);
        let found = alterations(meeting.samples(), 0.005, 0.03);
        let turns: Vec<f64> = found.iter().map(|a| a.turn).collect();
        assert_eq!(turns.len(), 2, "{found:?}");
        assert!((turns[0] + 0.6).abs() < 1e-9 && (turns[1] - 0.6).abs() < 1e-9);
        assert!((found[0].from - 40.0).abs() < 1e-9);
        // an arc of 2.5 lengths
        let arc = 0.6 * 2.5 * LENGTH / 6.0;
        assert!((found[0].until - 40.0 - arc).abs() < 1e-9);
        assert!(alterations(meeting.samples(), 0.005, 0.7).is_empty());
        assert_eq!(speed_changed(meeting.samples(), 6.0, 0.2), None);
    }
}
