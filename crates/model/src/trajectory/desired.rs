//! The desired trajectory: a polyline run leg by leg at given speeds.

use super::TrajectoryError;
use searoom_geometry::frame::{Vector, cross};
use searoom_geometry::tolerance;

/// Relative bound of the rounding of a squared distance.
const ROUNDING: f64 = 1e-12;

/// Shortest remainder of a desired trajectory, metres: a path is needed to end on.
const LAST_STRETCH_M: f64 = 1.0;

/// One leg of the desired trajectory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DesiredLeg {
    /// First end, metres.
    pub start: Vector,
    /// Unit vector along the leg.
    pub direction: Vector,
    /// Length, metres, positive.
    pub length: f64,
    /// Speed, m/s, positive.
    pub speed: f64,
    /// Start time, seconds.
    pub start_time: f64,
    /// Distance along the path at the start, metres.
    pub start_distance: f64,
}

impl DesiredLeg {
    /// End time, seconds.
    pub fn end_time(&self) -> f64 {
        self.start_time + self.length / self.speed
    }

    /// Second end, metres.
    fn end(&self) -> Vector {
        self.start + self.direction * self.length
    }

    /// Squared space-time distance to the nearest point, m², and its distance along the leg,
    /// metres.
    fn nearest(&self, position: Vector, time: f64, q: f64) -> (f64, f64) {
        let offset = position - self.start;
        let (along, across) = (self.direction.dot(&offset), cross(self.direction, offset));
        let elapsed = time - self.start_time;
        let slowness = 1.0 / self.speed;
        let sigma = ((along + q * elapsed * slowness) / (1.0 + q * slowness * slowness))
            .clamp(0.0, self.length);
        let (behind, late) = (along - sigma, elapsed - sigma * slowness);
        (across * across + behind * behind + q * late * late, sigma)
    }
}

/// The point of the desired trajectory nearest in space-time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// Squared space-time distance, m².
    pub error: f64,
    /// Metres along the path.
    pub distance: f64,
    /// Index of the leg.
    pub leg: usize,
}

impl Nearest {
    /// Takes over a leg's candidate `(error, metres along the leg)` if it is nearer, or as near and
    /// on an earlier leg.
    fn offer(&mut self, index: usize, leg: &DesiredLeg, (error, along): (f64, f64)) {
        if error < self.error || error == self.error && index < self.leg {
            *self = Self {
                error,
                distance: leg.start_distance + along,
                leg: index,
            };
        }
    }
}

/// The desired position as a function of time: a polyline that starts at the first waypoint at t =
/// 0.
#[derive(Debug, Clone, PartialEq)]
pub struct DesiredTrajectory {
    legs: Vec<DesiredLeg>,
}

impl DesiredTrajectory {
    /// From at least two waypoints (metres) and one speed (m/s) per leg.
    pub fn new(waypoints: &[Vector], leg_speeds: &[f64]) -> Result<Self, TrajectoryError> {
        if waypoints.len() < 2 {
            return Err(TrajectoryError::TooFewWaypoints);
        }
        let (mut time, mut distance) = (0.0, 0.0);
        let mut legs = Vec::with_capacity(waypoints.len() - 1);
        for (index, pair) in waypoints.windows(2).enumerate() {
            let step = pair[1] - pair[0];
            let length = step.norm();
            let speed = leg_speeds.get(index).copied().unwrap_or(f64::NAN);
            if !(length > 0.0 && speed > 0.0 && length.is_finite() && speed.is_finite()) {
                return Err(TrajectoryError::EmptyLeg { index });
            }
            legs.push(DesiredLeg {
                start: pair[0],
                direction: step / length,
                length,
                speed,
                start_time: time,
                start_distance: distance,
            });
            time += length / speed;
            distance += length;
        }
        Ok(Self { legs })
    }

    /// The legs, in order.
    pub fn legs(&self) -> &[DesiredLeg] {
        &self.legs
    }

    /// Every waypoint, in order.
    pub fn waypoints(&self) -> Vec<Vector> {
        let mut points: Vec<Vector> = self.legs.iter().map(|l| l.start).collect();
        points.push(self.end());
        points
    }

    /// `T_d`: duration, seconds.
    pub fn duration(&self) -> f64 {
        self.legs[self.legs.len() - 1].end_time()
    }

    /// Length of the path, metres.
    pub fn length(&self) -> f64 {
        let last = &self.legs[self.legs.len() - 1];
        last.start_distance + last.length
    }

    /// The last waypoint.
    pub fn end(&self) -> Vector {
        self.legs[self.legs.len() - 1].end()
    }

    /// True where the path passes a point before its end, to [`tolerance::ARRIVAL_M`]. A round trip
    /// passes its end at its start.
    pub fn comes_by(&self, place: Vector) -> bool {
        self.legs.iter().any(|leg| {
            let along = leg
                .direction
                .dot(&(place - leg.start))
                .clamp(0.0, leg.length);
            let off = (leg.start + leg.direction * along - place).norm();
            let left = self.length() - leg.start_distance - along;
            off <= tolerance::ARRIVAL_M && left > 2.0 * tolerance::ARRIVAL_M
        })
    }

    /// Desired position at `time`; the end points before the start and after the end.
    pub fn position_at(&self, time: f64) -> Vector {
        let index = self
            .legs
            .partition_point(|l| l.end_time() <= time)
            .min(self.legs.len() - 1);
        let leg = &self.legs[index];
        leg.start + leg.direction * ((time - leg.start_time) * leg.speed).clamp(0.0, leg.length)
    }

    /// The remainder from `time` on, with a clock that starts then. At least `LAST_STRETCH_M` at
    /// the end of the path remain.
    pub fn remaining(&self, time: f64) -> Self {
        self.remaining_stretch(time, LAST_STRETCH_M)
    }

    /// [`Self::remaining`] with another shortest remainder, metres.
    pub fn remaining_stretch(&self, time: f64, shortest: f64) -> Self {
        let last = &self.legs[self.legs.len() - 1];
        let latest = self.duration() - shortest.min(last.length) / last.speed;
        let time = if time > 0.0 { time.min(latest) } else { 0.0 };
        let left = || self.legs.iter().filter(|leg| leg.end_time() > time);
        let mut waypoints = vec![self.position_at(time)];
        waypoints.extend(left().map(DesiredLeg::end));
        let speeds: Vec<f64> = left().map(|leg| leg.speed).collect();
        Self::new(&waypoints, &speeds).unwrap_or_else(|_| self.clone())
    }

    /// Metres from a place to the nearest point of the path, and from there along it to its end; none
    /// within [`tolerance::ARRIVAL_M`] of the end. `sailed` is the length of the motion that ends at
    /// the place, metres. Where the path comes by it more than once, as a round trip does, it tells
    /// which of the points that are as near (to that tolerance) own ship has come to.
    pub fn left_from(&self, place: Vector, sailed: f64) -> f64 {
        let at_end = (self.end() - place).norm() <= tolerance::ARRIVAL_M;
        if at_end && (sailed > tolerance::ARRIVAL_M || !self.comes_by(place)) {
            return 0.0;
        }
        let off = self.nearest(place, 0.0, 0.0).error.sqrt();
        let near = self.legs.iter().filter_map(|leg| {
            let (error, along) = leg.nearest(place, 0.0, 0.0);
            let is_near = error.sqrt() <= off + tolerance::ARRIVAL_M;
            is_near.then_some(leg.start_distance + along)
        });
        let away = |along: &f64| (along - sailed).abs();
        let on = near.min_by(|a, b| away(a).total_cmp(&away(b)));
        self.length() - on.unwrap_or(0.0) + off
    }

    /// This motion without its last `length` metres; `None` where nothing is left.
    pub fn shortened(&self, length: f64) -> Option<Self> {
        let end = self.length() - length;
        let kept: Vec<&DesiredLeg> = (self.legs.iter())
            .take_while(|leg| leg.start_distance < end - tolerance::LENGTH_M)
            .collect();
        let last = kept.last()?;
        let mut waypoints: Vec<Vector> = kept.iter().map(|leg| leg.start).collect();
        let on_last = (end - last.start_distance).min(last.length);
        waypoints.push(last.start + last.direction * on_last);
        let speeds: Vec<f64> = kept.iter().map(|leg| leg.speed).collect();
        Self::new(&waypoints, &speeds).ok()
    }

    /// This motion, beginning at another place.
    pub fn from(&self, start: Vector) -> Self {
        let moved = start - self.legs[0].start;
        let legs = self.legs.iter().map(|leg| DesiredLeg {
            start: leg.start + moved,
            ..*leg
        });
        Self {
            legs: legs.collect(),
        }
    }

    /// The motion with fewer legs. O(legs²) at worst.
    ///
    /// Omits waypoints within [`tolerance::LENGTH_M`] of the line between retained ones, if the
    /// path meets them in order and at one speed.
    pub fn straightened(&self) -> Self {
        let mut waypoints = vec![self.legs[0].start];
        let mut speeds = Vec::new();
        let mut first = 0;
        while first < self.legs.len() {
            let mut last = first;
            while self.is_one_leg(first, last + 1) {
                last += 1;
            }
            waypoints.push(self.legs.get(last + 1).map_or(self.end(), |l| l.start));
            speeds.push(self.legs[first].speed);
            first = last + 1;
        }
        Self::new(&waypoints, &speeds).unwrap_or_else(|_| self.clone())
    }

    /// True when the legs from `first` to `last` are equivalent to one.
    fn is_one_leg(&self, first: usize, last: usize) -> bool {
        let Some(legs) = self.legs.get(first..=last) else {
            return false;
        };
        let start = legs[0].start;
        let chord = (legs[legs.len() - 1].end() - start).normalize();
        legs.iter().all(|leg| {
            leg.speed == legs[0].speed
                && leg.direction.dot(&chord) > 0.0
                && cross(chord, leg.start - start).abs() <= tolerance::LENGTH_M
        })
    }

    /// [`DesiredTrajectory::nearest`] on some of the legs.
    pub fn nearest_of(&self, legs: &[usize], position: Vector, time: f64, q: f64) -> Nearest {
        let mut best = Nearest {
            error: f64::INFINITY,
            distance: 0.0,
            leg: 0,
        };
        for index in legs {
            let leg = &self.legs[*index];
            best.offer(*index, leg, leg.nearest(position, time, q));
        }
        best
    }

    /// The nearest point in space-time: `min over sigma of |x - x_d(sigma)|² + q (t -
    /// t_d(sigma))²`, docs/reference/theory.md section 7.
    ///
    /// In closed form per leg, with `q` in m²/s²; the earlier of equal legs. Starts at the leg of
    /// that time and proceeds to later and earlier legs until their time difference alone excludes
    /// them. O(legs) at worst, and for `q = 0`.
    pub fn nearest(&self, position: Vector, time: f64, q: f64) -> Nearest {
        let mut best = Nearest {
            error: f64::INFINITY,
            distance: 0.0,
            leg: 0,
        };
        if let [leg] = &self.legs[..] {
            best.offer(0, leg, leg.nearest(position, time, q));
            return best;
        }
        let begun = self.legs.partition_point(|l| l.start_time <= time);
        let now = begun.saturating_sub(1);
        let too_far = |seconds: f64, best: &Nearest| {
            seconds > 0.0 && q * seconds * seconds > best.error * (1.0 + ROUNDING)
        };
        for (index, leg) in self.legs.iter().enumerate().skip(now) {
            if too_far(leg.start_time - time, &best) {
                break;
            }
            best.offer(index, leg, leg.nearest(position, time, q));
        }
        for (index, leg) in self.legs[..now].iter().enumerate().rev() {
            if too_far(time - leg.end_time(), &best) {
                break;
            }
            best.offer(index, leg, leg.nearest(position, time, q));
        }
        best
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_fixtures::desired;

    #[test]
    fn the_nearest_point_matches_a_dense_scan() {
        let points = [(0.0, 0.0), (400.0, 0.0), (600.0, 300.0), (500.0, 320.0)];
        let desired = desired(&points, &[5.0, 4.0, 3.0]);
        let q = 25.0;
        for i in 0..200 {
            let k = f64::from(i);
            let x = Vector::new(700.0 * (k * 0.7).sin(), 300.0 * (k * 1.3).cos());
            let t = k * 1.1 - 10.0;
            let found = desired.nearest(x, t, q).error;
            let scan = (0..=40_000)
                .map(|j| {
                    let td = desired.duration() * f64::from(j) / 40_000.0;
                    (x - desired.position_at(td)).norm_squared() + q * (t - td) * (t - td)
                })
                .fold(f64::INFINITY, f64::min);
            assert!(
                found <= scan + 1e-9 && scan - found < 1e-2 * (1.0 + scan.sqrt()),
                "{found} {scan}"
            );
        }
    }

    /// The search from the leg of the time finds what a search of all legs finds, also among equal
    /// legs.
    #[test]
    fn no_leg_that_is_left_out_is_nearer() {
        // back and forth on one line, so that legs tie
        let points: Vec<Vector> = (0..40)
            .map(|i| Vector::new(f64::from(i % 4 * 100), f64::from(i / 8 * 30)))
            .collect();
        let speeds: Vec<f64> = (0..39).map(|i| 1.0 + f64::from(i % 3)).collect();
        let desired = DesiredTrajectory::new(&points, &speeds).expect("valid");
        for (i, q) in (0..4000).zip([0.0, 0.01, 1.0, 25.0, 1e6].into_iter().cycle()) {
            let k = f64::from(i);
            let x = Vector::new((300.0 * (k * 0.7).sin()).round(), 150.0 * (k * 1.3).cos());
            let t = desired.duration() * (0.5 + 0.7 * (k * 0.37).sin());
            let found = desired.nearest(x, t, q);
            let mut all = Nearest {
                error: f64::INFINITY,
                distance: 0.0,
                leg: 0,
            };
            for (index, leg) in desired.legs().iter().enumerate() {
                all.offer(index, leg, leg.nearest(x, t, q));
            }
            assert_eq!(found, all, "{x:?} {t} {q}");
        }
    }

    #[test]
    fn what_is_left_of_a_round_trip_depends_on_what_was_sailed() {
        let trip = desired(&[(0.0, 0.0), (300.0, 0.0), (0.0, 0.0)], &[5.0; 2]);
        let left = |x: f64, y: f64, sailed: f64| trip.left_from(Vector::new(x, y), sailed);
        assert_eq!(left(0.0, 0.0, 0.0), 600.0);
        assert_eq!(left(100.0, 7.0, 0.0), 507.0);
        assert_eq!(left(300.0, 0.0, 0.0), 300.0);
        assert_eq!(left(100.0, 7.0, 480.0), 107.0);
        assert_eq!(left(100.0, 0.0, 505.0), 100.0);
        assert_eq!(left(100.0, 0.0, 103.0), 500.0);
        // a triangle ends where it starts, by rounding a little nearer to the one or the other
        let corners = [(0.0, 0.0), (500.0, 500.0), (400.0, 0.0), (1e-8, 1e-8)];
        let triangle = desired(&corners, &[5.0; 3]);
        for shift in [0.0, 1e-8] {
            let place = Vector::new(shift, shift);
            assert!((triangle.left_from(place, 0.0) - triangle.length()).abs() < 1e-6);
        }
        assert!(triangle.left_from(Vector::new(1e-8, 1e-8), 1500.0) < 1e-6);
    }

    #[test]
    fn waypoints_on_a_line_are_left_out_and_others_are_not() {
        let legs = |at: &[(f64, f64)], speeds: &[f64]| {
            let desired = desired(at, speeds);
            let straight = desired.straightened();
            assert_eq!(straight.end(), desired.end());
            assert!((straight.duration() - desired.duration()).abs() < 1e-9);
            for i in 0..=100 {
                let time = desired.duration() * f64::from(i) / 100.0;
                let apart = straight.position_at(time) - desired.position_at(time);
                assert!(apart.norm() < 1e-8, "{time} {apart:?}");
            }
            straight.legs().len()
        };
        let slanted: Vec<(f64, f64)> = (0..100)
            .map(|i| (0.3 * f64::from(i) + 17.0, 0.7 * f64::from(i)))
            .collect();
        assert_eq!(legs(&slanted, &[4.0; 99]), 1);
        let line = [(0.0, 0.0), (100.0, 0.0), (250.0, 0.0), (400.0, 0.0)];
        assert_eq!(legs(&line, &[5.0, 5.0, 5.0]), 1);
        assert_eq!(legs(&line, &[5.0, 4.0, 4.0]), 2);
        // there and back, a bend of a micrometre, and a bend after a line
        assert_eq!(legs(&[(0.0, 0.0), (100.0, 0.0), (50.0, 0.0)], &[5.0; 2]), 2);
        assert_eq!(
            legs(&[(0.0, 0.0), (100.0, 1e-6), (200.0, 0.0)], &[5.0; 2]),
            2
        );
        let bent = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (2.0, 5.0), (2.0, 9.0)];
        assert_eq!(legs(&bent, &[5.0; 4]), 2);
    }

    #[test]
    fn bad_waypoints_are_named() {
        let p = Vector::new(0.0, 0.0);
        assert!(matches!(
            DesiredTrajectory::new(&[p], &[]),
            Err(TrajectoryError::TooFewWaypoints)
        ));
        assert!(matches!(
            DesiredTrajectory::new(&[p, p], &[1.0]),
            Err(TrajectoryError::EmptyLeg { index: 0 })
        ));
        assert!(DesiredTrajectory::new(&[p, Vector::new(f64::NAN, 0.0)], &[1.0]).is_err());
    }
}
