//! Reports of a target: their times, their errors, and those that are lost.

use nalgebra::Matrix2;
use rand::Rng;
use rand_chacha::ChaCha8Rng;

use super::INSTANT;
use super::stream::{Purpose, normal, stream};
use crate::colregs::SteadyShip;
use crate::frame::{Vector, direction, knots_from_mps, radians_from_deg, wrap};
use crate::scenario::{Noise, Sensor, SensorKind};

/// A course that changes by more between two reports is an alteration, radians per second.
const ALTERING: f64 = radians_from_deg(0.1);

/// A measurement of a target, at a time in seconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Report {
    pub time: f64,
    pub arrives: f64,
    pub position: Vector,
    /// m/s; `None` for positions alone.
    pub velocity: Option<Vector>,
}

#[derive(Debug, Clone)]
pub(super) struct TargetSensor {
    sensor: Sensor,
    rng: ChaCha8Rng,
    next: f64,
    last_heading: Option<(f64, f64)>,
    /// Begin and end of the present or next drop-out.
    dropout: [f64; 2],
    /// Reports that have not arrived, in order of time.
    coming: Vec<Report>,
}

impl TargetSensor {
    pub fn new(sensor: &Sensor, name: &str, seed: u64) -> Self {
        let mut rng = stream(seed, Purpose::Sensor, name);
        let dropout = dropout_after(sensor, 0.0, &mut rng);
        let first = rng.random::<f64>() * sensor.interval.unwrap_or(2.0);
        Self {
            next: first - sensor.settle,
            sensor: sensor.clone(),
            rng,
            last_heading: None,
            dropout,
            coming: Vec::new(),
        }
    }

    /// Draws anew the errors and the gaps of later reports.
    pub fn reseed(&mut self, name: &str, seed: u64) {
        self.rng = stream(seed, Purpose::Sensor, name);
    }

    /// Measures the target where a report is due at `time`, seconds; returns those that arrive.
    /// The report of a target out of sight is lost.
    pub fn reports(&mut self, time: f64, target: &SteadyShip, in_sight: bool) -> Vec<Report> {
        if self.sensor.interval.is_none() {
            // a ship that gets under way reports before a ship at rest would
            self.next = self.next.min(time + self.interval(target, false));
        }
        if time >= self.next - INSTANT {
            let altering = self.is_altering(time, target);
            self.next = time + self.interval(target, altering);
            let report = self.measure(time, target);
            self.coming.extend(report.filter(|_| in_sight));
        }
        let arrived = self.coming.partition_point(|r| r.arrives <= time + INSTANT);
        self.coming.drain(..arrived).collect()
    }

    /// True where the target has altered its course since the last report.
    fn is_altering(&mut self, time: f64, target: &SteadyShip) -> bool {
        let heading = target.pose.heading;
        let before = self.last_heading.replace((time, heading));
        before.is_some_and(|(then, was)| {
            wrap(heading - was).abs() > ALTERING * (time - then).max(1e-9)
        })
    }

    /// Seconds to the next report. Class A: ITU-R M.1371, annex 1, table 1.
    fn interval(&self, target: &SteadyShip, altering: bool) -> f64 {
        if let Some(interval) = self.sensor.interval {
            return interval;
        }
        let knots = knots_from_mps(target.speed);
        let SensorKind::Ais { class_a } = self.sensor.kind else {
            return 0.0;
        };
        match (class_a, altering) {
            (false, _) if knots > 2.0 => 30.0,
            (true, true) if knots > 14.0 => 2.0,
            (true, true) if knots > 3.0 => 10.0 / 3.0,
            (true, false) if knots > 23.0 => 2.0,
            (true, false) if knots > 14.0 => 6.0,
            (true, false) if knots > 3.0 => 10.0,
            _ => 180.0,
        }
    }

    /// A measurement, unless it is lost. Every report draws the same number of random values.
    fn measure(&mut self, time: f64, target: &SteadyShip) -> Option<Report> {
        let mut drawn = || normal(&mut self.rng);
        let off = Vector::new(drawn(), drawn());
        let (course, speed) = (drawn(), drawn());
        let detected = self.rng.random::<f64>() < self.sensor.detection;
        while time >= self.dropout[1] {
            self.dropout = dropout_after(&self.sensor, self.dropout[1], &mut self.rng);
        }
        let silent = self.sensor.silent.iter().chain([&self.dropout]);
        let received = silent
            .into_iter()
            .all(|[from, until]| !(*from..*until).contains(&time));
        let Noise {
            position,
            course: course_std,
            speed: speed_std,
        } = self.sensor.noise;
        let velocity = direction(target.pose.heading + course * course_std)
            * (target.speed + speed * speed_std).max(0.0);
        (detected && received).then(|| Report {
            time,
            arrives: time + self.sensor.latency,
            position: target.pose.position + off * position,
            velocity: matches!(self.sensor.kind, SensorKind::Ais { .. }).then_some(velocity),
        })
    }
}

/// The next drop-out: exponential times between and during drop-outs.
fn dropout_after(sensor: &Sensor, time: f64, rng: &mut ChaCha8Rng) -> [f64; 2] {
    if !sensor.dropout_every.is_finite() {
        return [f64::INFINITY; 2];
    }
    let mut lasts = |mean: f64| -mean * (1.0 - rng.random::<f64>()).ln();
    let from = time + lasts(sensor.dropout_every);
    [from, from + lasts(sensor.dropout_lasts)]
}

/// Covariance of a measured velocity, (m/s)²: along the course, and across it.
pub(super) fn velocity_covariance(noise: &Noise, velocity: Vector) -> Matrix2<f64> {
    let speed = velocity.norm();
    let (along, across) = (noise.speed, noise.course * speed.max(noise.speed));
    let ahead = velocity.try_normalize(1e-9).unwrap_or_else(Vector::x);
    let port = crate::frame::to_port(ahead);
    let floor = Matrix2::identity() * 1e-6;
    ahead * ahead.transpose() * (along * along)
        + port * port.transpose() * (across * across)
        + floor
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Pose, mps_from_knots};

    fn target(knots: f64) -> SteadyShip {
        let pose = Pose::new(Vector::new(1000.0, 0.0), 0.4);
        SteadyShip::new(pose, mps_from_knots(knots))
    }

    fn ais() -> Sensor {
        Sensor {
            kind: SensorKind::Ais { class_a: true },
            ..Sensor::EXACT
        }
    }

    fn times(sensor: Sensor, knots: f64) -> Vec<f64> {
        let mut sensor = TargetSensor::new(&sensor, "a", 1);
        let reports =
            (0..1200).flat_map(|k| sensor.reports(f64::from(k) * 0.5, &target(knots), true));
        reports.map(|r| r.time).collect()
    }

    #[test]
    fn class_a_reports_at_the_intervals_of_its_table() {
        for (knots, interval) in [(2.0, 180.0), (10.0, 10.0), (18.0, 6.0), (25.0, 2.0)] {
            let found = times(ais(), knots);
            let mut steps = found.windows(2).map(|t| t[1] - t[0]);
            let regular = steps.all(|s| (s - interval).abs() < 1e-9);
            assert!(regular, "{knots}");
        }
        let mut sensor = TargetSensor::new(&ais(), "a", 1);
        let mut turning = target(10.0);
        let mut found = Vec::new();
        for k in 0..200 {
            turning.pose.heading += 0.01;
            let reports = sensor
                .reports(f64::from(k) / 3.0, &turning, true)
                .into_iter();
            found.extend(reports.map(|r| r.time));
        }
        let mut steps = found.windows(2).skip(1).map(|t| t[1] - t[0]);
        assert!(steps.all(|step| (step - 10.0 / 3.0).abs() < 1e-6));
    }

    #[test]
    fn silence_and_drop_outs_lose_reports_and_latency_delays_them() {
        let silent = Sensor {
            interval: Some(1.0),
            silent: vec![[100.0, 200.0]],
            latency: 4.0,
            ..ais()
        };
        let found = times(silent, 10.0);
        let heard = found.iter().any(|t| (100.0..200.0).contains(t));
        assert!(!heard, "{found:?}");
        assert!(found.len() > 450 && *found.last().expect("some") <= 596.0);
        let lossy = Sensor {
            interval: Some(1.0),
            dropout_every: 60.0,
            dropout_lasts: 30.0,
            detection: 0.9,
            ..ais()
        };
        let share = times(lossy, 10.0).len() as f64 / 600.0;
        assert!((0.3..0.85).contains(&share), "{share}");
    }

    #[test]
    fn measurements_have_the_errors_that_were_asked_for() {
        let sensor = Sensor {
            interval: Some(0.5),
            noise: Noise {
                position: 12.0,
                course: 0.1,
                speed: 0.5,
            },
            ..ais()
        };
        let mut sensor = TargetSensor::new(&sensor, "a", 1);
        let ship = target(10.0);
        let all: Vec<Report> = (0..8000)
            .flat_map(|k| sensor.reports(f64::from(k) * 0.5, &ship, true))
            .collect();
        let std = |of: &dyn Fn(&Report) -> f64| {
            (all.iter().map(|r| of(r).powi(2)).sum::<f64>() / all.len() as f64).sqrt()
        };
        assert!((std(&|r| r.position.x - 1000.0) - 12.0).abs() < 0.5);
        let velocity = |r: &Report| r.velocity.expect("measured");
        assert!((std(&|r| velocity(r).norm() - ship.speed) - 0.5).abs() < 0.02);
        let turned = |r: &Report| wrap(crate::frame::heading_of(velocity(r)) - 0.4);
        assert!((std(&turned) - 0.1).abs() < 0.005);
    }
}
