//! One Kalman filter per target, and the set of positions and velocities that a plan is made for.

use nalgebra::{Matrix2, Matrix4, SymmetricEigen, Vector4};

use super::sensor::{Report, velocity_covariance};
use crate::colregs::{Sectors, SteadyShip};
use crate::frame::{Pose, Vector, heading_of, to_port, wrap};
use crate::scenario::Sensor;
use crate::target::ShipTrack;
use crate::tolerance::SIGMAS;

/// Standard deviation of a velocity before any measurement, m/s: three of them hold every ship.
const ANY_VELOCITY: f64 = 15.0;

/// Least standard deviation of a measured position, metres: keeps the filter's matrices regular.
const LEAST_STD_M: f64 = 1e-3;

/// A velocity within this factor of the spreads widens them; another one begins the set anew. A
/// target that swings to 1.5 times its spreads then has its set widened once, and keeps to it.
const WIDENED: f64 = 2.0;

/// A target has settled on a course and a speed after this time in seconds. A plan for a target
/// that still turns would be for velocities that it is about to leave.
const SETTLED_S: f64 = 5.0;

/// Fraction of the spreads within which a settled target stays.
const SETTLED: f64 = 0.25;

/// A turn has ended where the target has settled for this time in seconds. The estimate of a filter
/// lags behind a turn, so this is longer than [`SETTLED_S`].
const TURN_ENDED_S: f64 = 20.0;

/// Square of the distance, in standard deviations, between two estimates above which they are not of
/// the same motion: 5. Two normal numbers exceed it with a probability of 4e-6, four with 5e-5.
const ANOTHER_MOTION: f64 = 25.0;

/// Fraction of the spread from the middle at which a target that turns as it may is held: it may turn
/// on, and a target that swings within its spread may turn back.
const HELD: f64 = 0.5;

/// m/s and radians: rounding of velocities.
const ROUNDING: f64 = 1e-9;

/// Motion at constant velocity with white noise of acceleration: position and velocity.
/// Y. Bar-Shalom, X.-R. Li, T. Kirubarajan, "Estimation with Applications to Tracking and
/// Navigation", 2001, section 6.2.2.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Filter {
    time: f64,
    state: Vector4<f64>,
    covariance: Matrix4<f64>,
    /// Spectral density of the acceleration, m²/s³.
    density: f64,
}

impl Filter {
    /// From a position and a velocity with their covariances.
    pub fn new(
        time: f64,
        (position, position_covariance): (Vector, Matrix2<f64>),
        (velocity, velocity_covariance): (Vector, Matrix2<f64>),
        density: f64,
    ) -> Self {
        let mut covariance = Matrix4::zeros();
        covariance
            .fixed_view_mut::<2, 2>(0, 0)
            .copy_from(&position_covariance);
        covariance
            .fixed_view_mut::<2, 2>(2, 2)
            .copy_from(&velocity_covariance);
        Self {
            time,
            state: Vector4::new(position.x, position.y, velocity.x, velocity.y),
            covariance,
            density,
        }
    }

    /// Moves the estimate on to `time`, seconds.
    pub fn predict(&mut self, time: f64) {
        let dt = time - self.time;
        let mut motion = Matrix4::identity();
        (motion[(0, 2)], motion[(1, 3)]) = (dt, dt);
        let mut noise = Matrix4::zeros();
        for axis in 0..2 {
            noise[(axis, axis)] = dt * dt * dt / 3.0;
            noise[(axis, axis + 2)] = dt * dt / 2.0;
            noise[(axis + 2, axis)] = dt * dt / 2.0;
            noise[(axis + 2, axis + 2)] = dt;
        }
        self.state = motion * self.state;
        self.covariance = motion * self.covariance * motion.transpose() + noise * self.density;
        self.time = time;
    }

    /// Takes in a measured position, or velocity if `first` is 2, in Joseph's form.
    pub fn update(&mut self, first: usize, measured: Vector, covariance: Matrix2<f64>) {
        let rows = self.covariance.fixed_rows::<2>(first).into_owned();
        let innovation = rows.fixed_columns::<2>(first) + covariance;
        // a singular sum measures nothing
        let Some(inverse) = innovation.try_inverse() else {
            return;
        };
        let gain = rows.transpose() * inverse;
        let off = measured - self.state.fixed_rows::<2>(first);
        self.state += gain * off;
        let mut rest = Matrix4::identity();
        let mut columns = rest.fixed_columns_mut::<2>(first);
        columns -= gain;
        self.covariance =
            rest * self.covariance * rest.transpose() + gain * covariance * gain.transpose();
    }

    fn position(&self) -> Vector {
        self.state.fixed_rows::<2>(0).into_owned()
    }

    fn velocity(&self) -> Vector {
        self.state.fixed_rows::<2>(2).into_owned()
    }

    /// Standard deviation of the position along its worst axis, metres.
    fn position_std(&self) -> f64 {
        let block: Matrix2<f64> = self.covariance.fixed_view::<2, 2>(0, 0).into_owned();
        SymmetricEigen::new(block).eigenvalues.max().max(0.0).sqrt()
    }

    fn velocity_variance(&self) -> Matrix2<f64> {
        self.covariance.fixed_view::<2, 2>(2, 2).into_owned()
    }

    /// The greatest speed within three standard deviations, m/s.
    fn greatest_speed(&self) -> f64 {
        let variance = SymmetricEigen::new(self.velocity_variance());
        let std = variance.eigenvalues.max().max(0.0).sqrt();
        self.velocity().norm() + SIGMAS * std
    }

    /// True where a measured velocity is likely.
    fn explains(&self, velocity: Vector, covariance: Matrix2<f64>) -> bool {
        let off = velocity - self.velocity();
        let inverse = (self.velocity_variance() + covariance).try_inverse();
        inverse.is_some_and(|inverse| off.dot(&(inverse * off)) <= ANOTHER_MOTION)
    }

    /// True where another estimate of the same motion at the same time is likely, by the covariance
    /// of this one.
    fn agrees_with(&self, other: &Self) -> bool {
        let off = self.state - other.state;
        let inverse = self.covariance.try_inverse();
        inverse.is_some_and(|inverse| off.dot(&(inverse * off)) <= ANOTHER_MOTION)
    }
}

/// Estimate of a target at the time of its last report.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Estimate {
    pub time: f64,
    pub position: Vector,
    /// Metres, along the worst axis.
    pub position_std: f64,
    pub heading: f64,
    pub speed: f64,
    /// Radians and m/s.
    pub heading_std: f64,
    pub speed_std: f64,
}

impl Estimate {
    /// The true state, with the standard deviations in the file.
    fn exact(time: f64, ship: &SteadyShip, file: &ShipTrack) -> Self {
        Self {
            time,
            position: ship.pose.position,
            position_std: file.position_std,
            heading: ship.pose.heading,
            speed: ship.speed,
            heading_std: file.course_std,
            speed_std: file.speed_std,
        }
    }
}

/// The middle and the half-widths of the velocities that plans are made for.
#[derive(Debug, Clone, Copy, PartialEq)]
struct AssumedVelocities {
    /// When the heading was the middle, seconds.
    time: f64,
    heading: f64,
    speed: f64,
    heading_spread: f64,
    speed_spread: f64,
    /// How much farther to starboard the heading may be.
    starboard_turn: f64,
    /// Radians per second by which the middle may turn.
    turn_rate: f64,
}

impl AssumedVelocities {
    /// The spreads of the behaviour and of the estimate about the estimate.
    fn at(estimate: &Estimate, file: &ShipTrack) -> Self {
        Self {
            time: estimate.time,
            heading: estimate.heading,
            speed: estimate.speed,
            heading_spread: file.course_spread + SIGMAS * estimate.heading_std,
            speed_spread: file.speed_spread + SIGMAS * estimate.speed_std,
            starboard_turn: file.starboard_turn,
            turn_rate: file.turn_rate.abs(),
        }
    }

    /// How far the middle may have turned until an estimate, radians.
    fn may_turn(&self, estimate: &Estimate) -> f64 {
        self.turn_rate * (estimate.time - self.time).max(0.0)
    }

    /// The set at the time of an estimate: its middle has turned toward the estimate as far as is
    /// needed to hold it well inside, and no farther than it may. With the same turn rate, all that this set may
    /// come to hold is in the set before.
    fn turned_to(&self, estimate: &Estimate) -> Self {
        let (beyond, _) = self.off(estimate);
        let side = wrap(estimate.heading - self.heading + 0.5 * self.starboard_turn);
        let turned = (beyond - HELD * self.heading_spread).clamp(0.0, self.may_turn(estimate));
        Self {
            time: estimate.time,
            heading: self.heading + turned.copysign(side),
            ..*self
        }
    }

    /// True where every velocity of a set of the same turns is in this one.
    fn contains(&self, other: &Self) -> bool {
        let turned = wrap(other.heading - self.heading).abs() + other.heading_spread;
        let faster = (other.speed - self.speed).abs() + other.speed_spread;
        (turned <= self.heading_spread + ROUNDING || self.heading_spread >= std::f64::consts::PI)
            && faster <= self.speed_spread + ROUNDING
    }

    /// True for an estimate that may be of a velocity in the set of `factor` times the spreads.
    fn holds(&self, estimate: &Estimate, factor: f64) -> bool {
        let (turned, faster) = self.off(estimate);
        let may_turn = self.may_turn(estimate);
        turned <= factor * self.heading_spread + may_turn + SIGMAS * estimate.heading_std + ROUNDING
            && faster <= factor * self.speed_spread + SIGMAS * estimate.speed_std + ROUNDING
    }

    /// How far beyond the middle of the set course and speed are.
    fn off(&self, estimate: &Estimate) -> (f64, f64) {
        let half = 0.5 * self.starboard_turn;
        let turned = wrap(estimate.heading - self.heading + half).abs() - half.abs();
        (turned, (estimate.speed - self.speed).abs())
    }

    /// The course that is expected now, with the spread and the turn of the same set about it: that
    /// of the estimate, where the target has turned as it may.
    fn expected(&self, estimate: &Estimate) -> [f64; 3] {
        let (side, most) = (self.starboard_turn.signum(), self.starboard_turn.abs());
        let turned = (side * wrap(self.heading - estimate.heading)).clamp(0.0, most);
        if turned > self.heading_spread {
            let spread = self.heading_spread + turned.min(most - turned);
            let left = self.starboard_turn - 2.0 * side * turned;
            [self.heading - side * turned, spread, left]
        } else {
            [self.heading, self.heading_spread, self.starboard_turn]
        }
    }

    /// Widens the spreads to hold an estimate.
    fn widen(&mut self, estimate: &Estimate) {
        let (turned, faster) = self.off(estimate);
        self.heading_spread = self.heading_spread.max(turned);
        self.speed_spread = self.speed_spread.max(faster);
    }
}

#[derive(Debug, Clone)]
pub(super) struct Track {
    file: ShipTrack,
    sensor: Sensor,
    filter: Option<Filter>,
    /// The present motion at constant velocity, without any acceleration, since it began.
    steady: Option<Filter>,
    /// True for a ship that the file has at rest, as long as no report contradicts it.
    is_known_at_rest: bool,
    estimate: Estimate,
    velocities: AssumedVelocities,
    /// True where the velocities are those of a ship at rest that is not at rest any more.
    has_left_rest: bool,
    /// True where the velocities began in a turn.
    began_in_turn: bool,
    /// True where the last set does not keep the velocities of the one before.
    is_broken: bool,
    /// True where it does not keep them though the target has not left them.
    has_begun_anew: bool,
    /// The estimate from which the later ones do not differ by much.
    settled: Estimate,
}

impl Track {
    /// A target as the file has it, before any report.
    pub fn new(file: &ShipTrack, sensor: &Sensor) -> Self {
        let estimate = Estimate::exact(0.0, &SteadyShip::new(file.pose, file.speed), file);
        Self {
            velocities: AssumedVelocities::at(&estimate, file),
            file: file.clone(),
            sensor: sensor.clone(),
            filter: None,
            steady: None,
            is_known_at_rest: file.speed + SIGMAS * file.speed_std <= Sectors::STANDARD.at_rest,
            estimate,
            has_left_rest: false,
            began_in_turn: false,
            is_broken: false,
            has_begun_anew: false,
            settled: estimate,
        }
    }

    /// Takes in the true state: the sensor is exact.
    pub fn set_exact(&mut self, time: f64, ship: &SteadyShip) {
        self.estimate = Estimate::exact(time, ship, &self.file);
        self.settle();
    }

    /// Begins to wait anew where the estimate has changed.
    fn settle(&mut self) {
        let still = AssumedVelocities {
            starboard_turn: 0.0,
            turn_rate: 0.0,
            ..AssumedVelocities::at(&self.settled, &self.file)
        };
        if !still.holds(&self.estimate, SETTLED) {
            self.settled = self.estimate;
        }
    }

    /// Takes in a report. One that is older than the last is left out.
    pub fn update(&mut self, report: &Report) {
        let assumed = &self.sensor.assumed;
        let std = assumed.position.max(LEAST_STD_M);
        let position = (report.position, Matrix2::identity() * (std * std));
        let unknown = Matrix2::identity() * (ANY_VELOCITY * ANY_VELOCITY);
        let velocity = (report.velocity).map(|v| (v, velocity_covariance(assumed, v)));
        let taken_in = |mut filter: Filter| {
            filter.predict(report.time);
            filter.update(0, position.0, position.1);
            if let Some((velocity, covariance)) = velocity {
                filter.update(2, velocity, covariance);
            }
            filter
        };
        let begun = |velocity, density| Filter::new(report.time, position, velocity, density);
        let measured = velocity.unwrap_or((Vector::zeros(), unknown));
        if (self.filter.as_ref()).is_some_and(|filter| report.time < filter.time) {
            return;
        }
        let density = self.sensor.acceleration * self.sensor.acceleration;
        let filter = self.filter.take().map(|mut filter| {
            filter.predict(report.time);
            filter
        });
        // a target that has turned since is another motion, behind which the filter would lag
        let filter = filter.filter(|filter| velocity.is_none_or(|(v, c)| filter.explains(v, c)));
        let filter = filter.map_or_else(|| begun(measured, density), taken_in);
        let in_file = match self.is_known_at_rest {
            true => (
                self.file.velocity(),
                Matrix2::identity() * (self.file.speed_std * self.file.speed_std),
            ),
            false => measured,
        };
        let steady = self.steady.take();
        let mut steady = steady.map_or_else(|| begun(in_file, 0.0), taken_in);
        let was_at_rest = self.is_at_rest();
        if !filter.agrees_with(&steady) {
            steady = begun(measured, 0.0);
            self.is_known_at_rest = false;
            self.has_left_rest |= was_at_rest;
        }
        self.estimate = self.estimated(report.time, &filter, &steady);
        (self.filter, self.steady) = (Some(filter), Some(steady));
        self.settle();
    }

    /// The estimate of a filter; of a ship at rest that of its steady motion, which is none.
    fn estimated(&self, time: f64, filter: &Filter, steady: &Filter) -> Estimate {
        let greatest_speed = steady.greatest_speed();
        if greatest_speed <= Sectors::STANDARD.at_rest {
            let (heading, heading_std) = match self.is_known_at_rest {
                true => (self.file.pose.heading, self.file.course_std),
                false => (self.estimate.heading, std::f64::consts::PI),
            };
            return Estimate {
                time,
                position: steady.position(),
                position_std: steady.position_std(),
                heading,
                speed: 0.0,
                heading_std,
                speed_std: greatest_speed / SIGMAS,
            };
        }
        let velocity = filter.velocity();
        let speed = velocity.norm();
        let ahead = velocity.try_normalize(ROUNDING).unwrap_or_else(Vector::x);
        let std_along = |axis: Vector| {
            let variance = axis.dot(&(filter.velocity_variance() * axis));
            variance.max(0.0).sqrt()
        };
        Estimate {
            time,
            position: filter.position(),
            position_std: filter.position_std(),
            heading: heading_of(ahead),
            speed,
            heading_std: (std_along(to_port(ahead)) / speed.max(ROUNDING))
                .min(std::f64::consts::PI),
            speed_std: std_along(ahead),
        }
    }

    /// True where no speed above that of a ship at rest is likely.
    fn is_at_rest(&self) -> bool {
        let steady = self.steady.as_ref();
        steady.is_some_and(|steady| steady.greatest_speed() <= Sectors::STANDARD.at_rest)
    }

    /// Begins the velocity set anew about the present estimate.
    pub fn assume_anew(&mut self) {
        self.velocities = AssumedVelocities::at(&self.estimate, &self.file);
        (self.has_left_rest, self.began_in_turn) = (false, false);
    }

    /// True where the present estimate is outside the velocities that the last plan assumes.
    fn is_outside(&self) -> bool {
        self.has_left_rest || !self.velocities.holds(&self.estimate, 1.0)
    }

    /// True where the target has left the velocities that the last plan assumes and holds on.
    pub fn has_left(&self) -> bool {
        self.is_outside() && self.has_settled(SETTLED_S)
    }

    /// True where the estimate has been about the same for a time in seconds.
    fn has_settled(&self, time: f64) -> bool {
        self.estimate.time - self.settled.time >= time
    }

    /// True where the last set does not keep the velocities of the one before.
    pub fn is_broken(&self) -> bool {
        self.is_broken
    }

    /// True where the last set does not keep the velocities of the one before, which still hold the
    /// target: they were those of a turn that has ended, or of a ship that has come to rest.
    pub fn has_begun_anew(&self) -> bool {
        self.has_begun_anew
    }

    pub fn estimate(&self) -> &Estimate {
        &self.estimate
    }

    /// The set for a plan that starts at `time`. Its velocities stay as they are as long as they
    /// hold the present estimate. A target that does little more than assumed may do so again: its
    /// spreads are widened. One that does much more has turned, and its set begins anew, and once
    /// more when it has settled. So does that of a ship at rest that gets under way, and that of one
    /// that comes to rest. The course turns as the turn rate of the file allows. Its disc
    /// of positions holds every motion since the last report, and during the `delay` of a plan also
    /// in the first one: each set then holds the next one.
    pub fn set_at(&mut self, time: f64, delay: f64) -> ShipTrack {
        self.is_broken = self.is_outside();
        let before = self.velocities;
        let is_new_motion = self.has_left_rest || !before.holds(&self.estimate, WIDENED);
        let has_turned = self.began_in_turn && self.has_settled(TURN_ENDED_S);
        if self.is_broken && is_new_motion {
            self.assume_anew();
            self.began_in_turn = true;
        } else if has_turned || self.is_at_rest() {
            self.assume_anew();
        } else {
            self.velocities = before.turned_to(&self.estimate);
            if self.is_broken {
                self.velocities.widen(&self.estimate);
            }
        }
        self.has_begun_anew = !before.turned_to(&self.estimate).contains(&self.velocities);
        let age = (time - self.estimate.time).max(0.0);
        let elapsed = age.max(delay);
        let turned = self.file.turn_rate * elapsed;
        let [heading, spread, starboard_turn] = self.velocities.expected(&self.estimate);
        let pose = Pose::new(self.estimate.position, heading);
        let mut ship = ShipTrack {
            pose,
            speed: self.velocities.speed,
            position_std: self.estimate.position_std,
            speed_std: 0.0,
            course_std: 0.0,
            speed_spread: self.velocities.speed_spread,
            // it may have turned since
            course_spread: (spread + turned).min(std::f64::consts::PI),
            starboard_turn,
            kept_velocities: None,
            ..self.file.clone()
        };
        let middle = ship.velocity();
        let reach = |v: &Vector| (v - middle).norm();
        // the widest set within the age
        let sets = ship.outer_velocity_sets(ship.turn_rate, elapsed.max(ROUNDING));
        let velocities = sets.iter().find(|set| set.until >= elapsed);
        let widest = velocities.and_then(|set| set.velocities.as_polygon());
        let farthest = widest.map_or(f64::INFINITY, |set| {
            set.vertices().iter().map(reach).fold(0.0, f64::max)
        });
        if elapsed > 0.0 {
            ship.position_std += farthest * elapsed / SIGMAS;
        }
        ship.pose.position += middle * age;
        ship
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::radians_from_deg;
    use crate::scenario::{Noise, SensorKind};
    use crate::simulation::closed_loop::stream::{Purpose, normal, stream};
    use crate::vessel::Hull;
    use nalgebra::{DMatrix, DVector};

    /// A target that gives way and comes back keeps the set; one that turns farther does not.
    #[test]
    fn a_target_keeps_the_set_while_it_turns_as_far_as_it_may() {
        let file = ShipTrack {
            course_spread: radians_from_deg(5.0),
            starboard_turn: radians_from_deg(40.0),
            speed_spread: 0.5,
            ..ShipTrack::exact(Pose::new(Vector::zeros(), 1.0), 5.0, Hull::new(30.0, 8.0))
        };
        let mut track = Track::new(&file, &Sensor::EXACT);
        let first = track.set_at(0.0, 1.0).outer_velocity_set();
        let mut is_broken = |turned: f64| {
            let heading = file.pose.heading - radians_from_deg(turned);
            track.set_exact(
                10.0,
                &SteadyShip::new(Pose::new(Vector::zeros(), heading), 5.0),
            );
            let set = track.set_at(10.0, 1.0);
            if !track.is_broken() {
                // of the turned target the course is the estimate, and the set is the same
                let off = if turned > 5.0 {
                    heading
                } else {
                    file.pose.heading
                };
                assert!(
                    (set.pose.heading - off.max(file.pose.heading - file.starboard_turn)).abs()
                        < 1e-9
                );
                let velocities = set.outer_velocity_set();
                let outside = |v: &Vector| first.signed_distance(*v) > 1e-9;
                assert!(!velocities.vertices().iter().any(outside));
                assert_eq!(velocities.vertices().len(), first.vertices().len());
            }
            track.is_broken()
        };
        for turned in [3.0, 12.0, 30.0, 44.9, 0.0, -4.9] {
            assert!(!is_broken(turned), "{turned}");
        }
        assert!(is_broken(46.0) && is_broken(-20.0));
    }

    /// Without noise of acceleration the filter is the least-squares line through all positions.
    #[test]
    fn the_filter_is_the_least_squares_line_through_all_positions() {
        let mut rng = stream(4, Purpose::Sensor, "filter");
        let std = 7.0;
        let (times, prior) = ([0.0, 3.0, 4.5, 9.0, 15.0, 21.0], ANY_VELOCITY);
        let points: Vec<Vector> = times
            .iter()
            .map(|t| {
                let noise = Vector::new(normal(&mut rng), normal(&mut rng));
                Vector::new(100.0, -40.0) + Vector::new(3.0, 5.0) * *t + noise * std
            })
            .collect();
        let noise = Matrix2::identity() * (std * std);
        let unknown = Matrix2::identity() * (prior * prior);
        let mut filter = Filter::new(0.0, (points[0], noise), (Vector::zeros(), unknown), 0.0);
        for (time, point) in times.iter().zip(&points).skip(1) {
            filter.predict(*time);
            filter.update(0, *point, noise);
        }
        // rows: position at t = 0, velocity; weighted by the standard deviations, and the prior
        let rows = times.len() + 1;
        let last = times[times.len() - 1];
        let line = DMatrix::from_fn(rows, 2, |i, j| match (i < times.len(), j) {
            (true, 0) => 1.0 / std,
            (true, _) => (times[i] - last) / std,
            (false, 0) => 0.0,
            (false, _) => 1.0 / prior,
        });
        for axis in 0..2 {
            let measured =
                DVector::from_fn(rows, |i, _| points.get(i).map_or(0.0, |p| p[axis] / std));
            let normal_matrix = line.transpose() * &line;
            let inverse = normal_matrix.try_inverse().expect("regular");
            let best = &inverse * line.transpose() * measured;
            assert!((filter.state[axis] - best[0]).abs() < 1e-8);
            assert!((filter.state[axis + 2] - best[1]).abs() < 1e-8);
            assert!((filter.covariance[(axis, axis)] - inverse[(0, 0)]).abs() < 1e-8);
            assert!((filter.covariance[(axis, axis + 2)] - inverse[(0, 1)]).abs() < 1e-8);
            assert!((filter.covariance[(axis + 2, axis + 2)] - inverse[(1, 1)]).abs() < 1e-8);
        }
    }

    fn file() -> ShipTrack {
        ShipTrack {
            speed_spread: 0.4,
            course_spread: radians_from_deg(5.0),
            ..ShipTrack::exact(Pose::new(Vector::zeros(), 0.5), 5.0, Hull::new(60.0, 12.0))
        }
    }

    fn sensor() -> Sensor {
        let noise = Noise {
            position: 12.0,
            course: radians_from_deg(6.0),
            speed: 0.5,
        };
        Sensor {
            kind: SensorKind::Ais { class_a: true },
            noise,
            assumed: noise,
            acceleration: 0.02,
            ..Sensor::EXACT
        }
    }

    /// The disc and the velocities hold the true motion, whatever it does within its velocities.
    #[test]
    fn the_set_holds_every_motion_since_the_last_report() {
        let mut track = Track::new(&file(), &Sensor::EXACT);
        track.set_exact(0.0, &SteadyShip::on_track(&file(), 0.0));
        let set = track.set_at(15.0, 1.0);
        assert_eq!((set.speed, set.speed_spread), (5.0, 0.4));
        let reach = SIGMAS * set.position_std;
        for v in file().outer_velocity_set().vertices() {
            assert!((v * 15.0 - set.pose.position).norm() <= reach + 1e-9);
        }
        assert!(reach < 15.0 * 0.7);
        assert_eq!(track.set_at(0.0, 0.0).position_std, 0.0);
        let [now, later] = [0.0, 2.0].map(|time| track.set_at(time, 2.0));
        assert_eq!(now.position_std, later.position_std);
    }

    /// The standard deviations of the file count where the truth is seen, as that of the position
    /// does, and the target does no more than its spreads.
    #[test]
    fn the_standard_deviations_of_the_file_are_in_the_set() {
        let file = ShipTrack {
            speed_std: 0.1,
            course_std: radians_from_deg(1.0),
            ..file()
        };
        let mut track = Track::new(&file, &Sensor::EXACT);
        track.set_exact(0.0, &SteadyShip::on_track(&file, 0.0));
        let set = track.set_at(0.0, 0.0);
        assert!((set.speed_half_width() - file.speed_half_width()).abs() < 1e-12);
        assert!((set.course_half_width() - file.course_half_width()).abs() < 1e-12);
    }

    #[test]
    fn a_small_alteration_keeps_the_velocities_a_larger_one_widens_them_or_begins_them_anew() {
        let mut track = Track::new(&file(), &Sensor::EXACT);
        let mut ship = SteadyShip::on_track(&file(), 0.0);
        ship.pose.heading += radians_from_deg(4.9);
        track.set_exact(20.0, &ship);
        assert_eq!(track.set_at(20.0, 0.0).pose.heading, 0.5);
        assert!(!track.is_broken());
        ship.pose.heading += radians_from_deg(1.0);
        track.set_exact(40.0, &ship);
        let wider = track.set_at(40.0, 0.0);
        assert_eq!(wider.pose.heading, 0.5);
        assert!((wider.course_spread - radians_from_deg(5.9)).abs() < 1e-9);
        assert!(track.is_broken());
        track.set_at(60.0, 0.0);
        assert!(!track.is_broken());
        ship.pose.heading += radians_from_deg(10.0);
        track.set_exact(80.0, &ship);
        let anew = track.set_at(80.0, 0.0);
        assert_eq!(anew.pose.heading, ship.pose.heading);
        assert!((anew.course_spread - radians_from_deg(5.0)).abs() < 1e-9 && track.is_broken());
    }

    #[test]
    fn the_estimate_of_a_steady_ship_settles_and_is_as_good_as_it_says() {
        let (mut inside, mut narrow) = (0, 0);
        for seed in 0..200 {
            let mut rng = stream(seed, Purpose::Sensor, "steady");
            let mut track = Track::new(&file(), &sensor());
            for k in 0..20 {
                let time = f64::from(k) * 4.0;
                let truth = SteadyShip::on_track(&file(), time);
                let noise = &sensor().noise;
                let mut off = |std: f64| std * normal(&mut rng);
                let position =
                    truth.pose.position + Vector::new(off(noise.position), off(noise.position));
                let heading = truth.pose.heading + off(noise.course);
                let velocity = crate::frame::direction(heading) * (truth.speed + off(noise.speed));
                track.update(&Report {
                    time,
                    arrives: time,
                    position,
                    velocity: Some(velocity),
                });
            }
            let (truth, found) = (SteadyShip::on_track(&file(), 76.0), track.estimate());
            let off = (truth.pose.position - found.position).norm();
            let faster = (truth.speed - found.speed).abs();
            inside +=
                usize::from(off <= 3.0 * found.position_std && faster <= 3.0 * found.speed_std);
            narrow += usize::from(found.position_std < 6.0 && found.speed_std < 0.3);
        }
        assert!(inside >= 190 && narrow == 200, "{inside} {narrow}");
    }
}
