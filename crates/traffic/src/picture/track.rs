//! The last fix of a ship at one place, and since when it has been lying there.

use searoom_geometry::frame::Geographic;

use crate::fields::metres;
use crate::report::{Directions, Fix, Notes, PositionSet, VelocitySet};

/// Seconds for which a velocity or a heading counts for a fix without one.
const CARRIED_S: f64 = 10.0;

/// True where nothing is known of a velocity.
fn is_unknown(velocity: &VelocitySet) -> bool {
    *velocity == VelocitySet::UNKNOWN
}

/// Half of a cell from which on a position is coarse, metres: that of a long-range report is 93 m.
const COARSE_M: f64 = 50.0;

#[derive(Debug, Clone)]
pub(super) struct Track {
    /// Which place of the identity it is, from 1 on.
    pub number: u32,
    pub fix: Fix,
    pub position: PositionSet,
    pub notes: Notes,
    /// When the fix's velocity and heading were measured, seconds: not always with the position.
    pub velocity_at: f64,
    heading_at: f64,
    /// The first of the fixes at which the ship has been at rest since.
    rest: Option<(f64, Geographic)>,
}

impl Track {
    pub fn new(fix: Fix, position: PositionSet, notes: Notes) -> Self {
        Self {
            number: 1,
            velocity_at: fix.time.most,
            heading_at: fix.time.most,
            fix,
            position,
            notes,
            rest: None,
        }
    }

    pub fn is_coarse(&self) -> bool {
        !(self.position.half_cell_m.norm() <= COARSE_M)
    }

    /// Distance from the middle of the position to its farthest corner, metres.
    pub fn reach(&self) -> f64 {
        self.position.half_cell_m.norm() + self.position.radius_m
    }

    /// Metres by which a ship of a greatest speed cannot have come from the other fix to this one, or back.
    pub fn apart(&self, other: &Self, fastest: f64) -> f64 {
        let [a, b] = [&self.fix, &other.fix];
        let time = (a.time.most - b.time.least).max(b.time.most - a.time.least);
        let said = |fix: &Fix| match fix.velocity.speed.most.is_finite() {
            true => fix.velocity.speed.most,
            false => 0.0,
        };
        let speed = fastest.max(said(a)).max(said(b));
        let between = metres(self.position.at, other.position.at).norm();
        between - self.reach() - other.reach() - speed * time
    }

    /// Goes on with a newer fix.
    pub fn follow(&mut self, new: Self, rest_mps: f64) {
        let may_rest = new.may_rest(rest_mps);
        let begun = self.rest.unwrap_or((self.fix.time.least, self.position.at));
        let moved = metres(begun.1, new.position.at).norm();
        let rest = (may_rest && self.may_rest(rest_mps) && moved <= self.reach() + new.reach())
            .then_some(begun);
        let before = std::mem::replace(self, Self { rest, ..new });
        self.number = before.number;
        let now = self.fix.time.most;
        if is_unknown(&self.fix.velocity) && now - before.velocity_at <= CARRIED_S {
            (self.fix.velocity, self.velocity_at) = (before.fix.velocity, before.velocity_at);
        }
        if self.fix.heading == Directions::ALL && now - before.heading_at <= CARRIED_S {
            (self.fix.heading, self.heading_at) = (before.fix.heading, before.heading_at);
        }
    }

    /// Takes over what a report without a place says of the motion.
    pub fn steady(&mut self, fix: &Fix) {
        let time = fix.time.most;
        if !is_unknown(&fix.velocity) && time > self.velocity_at {
            (self.fix.velocity, self.velocity_at) = (fix.velocity, time);
        }
        if fix.heading != Directions::ALL && time > self.heading_at {
            (self.fix.heading, self.heading_at) = (fix.heading, time);
        }
    }

    /// Seconds between the position and the velocity, where they were not measured at once.
    pub fn velocity_apart(&self) -> f64 {
        match self.fix.time.contains(self.velocity_at) {
            true => 0.0,
            false => (self.velocity_at - self.fix.time.most).abs(),
        }
    }

    /// True where a speed that was sent does not contradict a ship at rest. A speed that is not known
    /// contradicts nothing.
    fn may_rest(&self, rest_mps: f64) -> bool {
        let speed = self.fix.velocity.speed;
        match speed.most.is_finite() {
            true => speed.most <= rest_mps,
            false => speed.least == 0.0,
        }
    }

    /// Bound of the mean speed of a ship at rest since it came to rest, m/s.
    pub fn lying_mps(&self) -> f64 {
        self.rest.map_or(f64::INFINITY, |(since, first)| {
            let moved = metres(first, self.position.at).norm();
            (moved + 2.0 * self.reach()) / (self.fix.time.most - since)
        })
    }

    /// True where the ship has been at one place for a time in seconds. Two fixes apart in time show that,
    /// because some units send a speed of 0 where they know none.
    pub fn is_lying(&self, rest_mps: f64, lying_s: f64) -> bool {
        let since = self.rest.map(|(since, _)| self.fix.time.most - since);
        since.is_some_and(|lasts| lasts >= lying_s && 2.0 * self.reach() <= rest_mps * lasts)
    }
}
