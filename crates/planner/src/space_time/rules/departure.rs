//! When a manoeuvre begins: in ample time for a ship that keeps clear; for one that stands on, not
//! before it may act, and not after its last escape.

use crate::Problem;
use crate::space_time::rules::manoeuvre::Manoeuvres;
use searoom_colregs::{Encountered, MayAct, Role, SMALL_TURN};
use searoom_geometry::frame::{heading_of, wrap};
use searoom_geometry::tolerance;
use searoom_model::trajectory::Segment;
use searoom_sets::contact;

/// Seconds: more than the step of the judges' samples, so that one of them sees an alteration that
/// is in time.
pub(super) const SAMPLE_S: f64 = 1.5;

impl Manoeuvres<'_, '_> {
    /// Some times of departure until the latest one, the latest first.
    pub(super) fn departures(&self, from: f64, latest: f64) -> Vec<f64> {
        let (window, settings) = (latest - from, self.settings());
        let parts = (window / (settings.departures_apart_s * self.unit)).ceil();
        let parts = (parts as usize)
            .min(settings.most_departures.saturating_sub(1))
            .max(1);
        let share = |part: usize| 1.0 - part as f64 / parts as f64;
        let times = (0..=parts).map(|part| self.tidy_time(from + share(part) * window));
        let mut times: Vec<f64> = times.collect();
        times.dedup();
        times
    }

    /// A time that leaves no short segment before it.
    pub(super) fn tidy_time(&self, time: f64) -> f64 {
        if time < self.from + self.family.least {
            self.from
        } else {
            time
        }
    }

    /// Latest time of the first alteration, seconds. It is in ample time for every target, and a
    /// turn can soon be seen after it.
    pub(super) fn ample_time(&self) -> f64 {
        let (limits, own) = (self.problem().thresholds, self.problem().own);
        let settings = self.settings();
        let ample = limits.ample_time(own.hull.length);
        let soon = limits.time_factor(own.hull.length) * limits.monitor.response();
        let turning = SMALL_TURN * own.turning_radius / self.context.speeds.normal;
        let keeping_clear = self.passing.iter().filter(|p| p.keeps_clear());
        let latest = keeping_clear.map(|p| {
            let e = p.encountered;
            let react = match e.role {
                Role::Overtaking => settings.overtaking_react_s,
                _ => settings.react_s,
            };
            let seen = e.risk_since + (soon - turning - SAMPLE_S).max(react);
            (e.tcpa - ample).max(e.risk_since + react).min(seen)
        });
        latest.fold(f64::INFINITY, f64::min).max(0.0)
    }

    /// First time at which a stand-on ship may act on the nominal motion: Rule 17(a)(ii), or in
    /// extremis, when the hulls would soon meet.
    pub(super) fn may_act(&self) -> f64 {
        let limits = self.problem().thresholds;
        let extremis =
            limits.monitor.manoeuvre * limits.time_factor(self.problem().own.hull.length);
        let times = self.passing.iter().map(|p| {
            let e = p.encountered;
            let meets = |s| contact::first_contact(&p.hulls, s, 0.0);
            let meets = self.nominal_motion.iter().find_map(meets);
            let stage_3 = match e.role.duties().may_act {
                MayAct::BeforeClosestApproach => {
                    e.tcpa - limits.score.overtaken_lengths * self.length(e) / e.own.speed
                }
                MayAct::WithinRange => self.comes_within_of(e, limits.score.stage_3_lengths),
            };
            stage_3.min(meets.map_or(f64::INFINITY, |time| time - extremis))
        });
        // to act for one target excuses toward the others
        times.fold(f64::INFINITY, f64::min).max(0.0)
    }

    fn length(&self, e: &Encountered) -> f64 {
        e.hull.length.max(self.problem().own.hull.length)
    }

    /// Time at which the nominal motion comes within a number of lengths of a target; infinite if
    /// it never does.
    pub(super) fn comes_within(&self, lengths: f64) -> f64 {
        let times = self
            .passing
            .iter()
            .map(|p| self.comes_within_of(p.encountered, lengths));
        times.fold(f64::INFINITY, f64::min)
    }

    fn comes_within_of(&self, e: &Encountered, lengths: f64) -> f64 {
        let range = lengths * self.length(e);
        let near = |s: &Segment| {
            let relative = s.velocity_at(s.start_time) - e.ship.velocity();
            let apart = s.start.position - e.ship.pose.position - e.ship.velocity() * s.start_time;
            let (a, b) = (relative.norm_squared(), apart.dot(&relative));
            let c = apart.norm_squared() - range * range;
            if c <= 0.0 {
                return Some(s.start_time);
            }
            let time = (-b - (b * b - a * c).sqrt()) / a;
            (time >= 0.0 && time <= s.duration).then_some(s.start_time + time)
        };
        let mut segments = self.nominal_motion.iter();
        segments.find_map(near).unwrap_or(f64::INFINITY)
    }

    /// True where own ship starts on the path and can keep the desired speed, but the nominal motion
    /// does not keep it, because the horizon requires an earlier arrival. That is no hold.
    pub(super) fn hurries(&self) -> bool {
        let (own, leg) = (self.problem().own, &self.problem().desired.legs()[0]);
        let off = (own.pose.position - leg.start).norm();
        let turn = wrap(own.pose.heading - heading_of(leg.direction)).abs();
        let first = self.nominal_motion.first();
        !(self.from > 0.0)
            && off <= tolerance::JOINT_M
            && turn <= tolerance::joint_rad(own.turning_radius)
            && can_hold_speed(self.problem())
            && !first.is_some_and(|s| is_desired_speed(self.problem(), s.speed))
    }
}

/// True where the desired speed is one of own ship's. One that is mixed from others is not held.
pub(super) fn can_hold_speed(problem: &Problem) -> bool {
    let mut speeds = problem.own.speeds.iter();
    speeds.any(|speed| is_desired_speed(problem, *speed))
}

fn is_desired_speed(problem: &Problem, speed: f64) -> bool {
    let desired = problem.desired.legs()[0].speed;
    (speed - desired).abs() <= tolerance::FIGURE * desired
}
