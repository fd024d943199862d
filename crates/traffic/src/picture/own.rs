//! Own ship, from its own sentences or from reports of it.

use searoom_geometry::frame::{Geographic, Georeference, Pose, Vector, direction};

use super::{PictureSettings, Taken, ship};
use crate::fields::metres;
use crate::report::{
    Directions, Fix, HullSet, Identity, Interval, Name, Note, PositionSet, Report, VelocitySet,
};

/// Own ship at a time, on a plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OwnPosition {
    /// The middle of where it is, moved on by its velocity; its course, or below a knot its heading.
    pub pose: Pose,
    /// m/s.
    pub speed: f64,
    /// Metres by which it may be elsewhere.
    pub radius_m: f64,
    /// Seconds since the fix, at most.
    pub age_s: f64,
    /// Its largest length and beam, metres, where it sends its size; the position is then that of the middle
    /// of its hull, and else that of the antenna.
    pub size_m: Option<[f64; 2]>,
}

/// What is known of own ship, each with its time.
#[derive(Debug, Clone)]
pub(super) struct OwnShip {
    /// Whose reports are own ship's.
    given: Option<Identity>,
    identities: Vec<Identity>,
    place: Option<(Interval, PositionSet)>,
    velocity: Option<(f64, VelocitySet)>,
    heading: Option<(f64, Directions)>,
    hull: Option<HullSet>,
    name: Option<Name>,
}

/// How far from own ship's place a report of it may be, metres, and faster than any ship, m/s.
const NEAR_M: f64 = 1000.0;
const FASTEST_MPS: f64 = 30.0;

/// Seconds for which a position of own ship excludes another one.
const FRESH_S: f64 = 10.0;

/// Most identities of own ship that are kept.
const MOST_IDENTITIES: usize = 4;

impl OwnShip {
    pub fn new(given: Option<Identity>) -> Self {
        Self {
            given,
            identities: given.into_iter().collect(),
            place: None,
            velocity: None,
            heading: None,
            hull: None,
            name: None,
        }
    }

    pub fn identities(&self) -> &[Identity] {
        &self.identities
    }

    pub fn name(&self) -> Option<&Name> {
        self.name.as_ref()
    }

    pub fn place(&self) -> Option<Geographic> {
        self.place.map(|(_, place)| place.at)
    }

    /// What a report is to own ship; `None` for one of another ship.
    pub fn take(&mut self, report: &Report, fix: Option<Fix>) -> Option<Taken> {
        let first = self.identities.first();
        let is_first = first == Some(&report.identity);
        if !report.is_own {
            return match self.given {
                Some(given) if given == report.identity && self.may_be_at(fix) => {
                    self.learn(report, fix);
                    Some(Taken::Own)
                }
                // another ship may have the same number
                _ if is_first && self.may_be_at(fix) => Some(Taken::Echo),
                _ => None,
            };
        }
        if let Identity::Mmsi(_) = report.identity
            && !is_first
        {
            let is_second = first.is_some();
            if !self.identities.contains(&report.identity)
                && self.identities.len() < MOST_IDENTITIES
            {
                self.identities.push(report.identity);
            }
            if is_second {
                // another ship, whatever it says
                return None;
            }
        }
        let is_fresh = |then: f64| fix.is_some_and(|fix| fix.time.most - then <= FRESH_S);
        if !self.may_be_at(fix) && self.place.is_some_and(|(then, _)| is_fresh(then.most)) {
            return Some(Taken::OwnElsewhere);
        }
        self.learn(report, fix);
        Some(Taken::Own)
    }

    /// True for a fix that is not far from where own ship is known to be.
    fn may_be_at(&self, fix: Option<Fix>) -> bool {
        let place = fix.and_then(|fix| Some((fix.time.most, fix.position?.at)));
        match (place, &self.place) {
            (Some((time, at)), Some((then, own))) => {
                let way = FASTEST_MPS * (time - then.most).abs();
                metres(own.at, at).norm() <= NEAR_M + own.radius_m + way
            }
            _ => true,
        }
    }

    /// Forgets what is dated after a time.
    pub fn set_back(&mut self, time: f64) {
        self.place = self.place.filter(|(then, _)| then.least <= time);
        self.velocity = self.velocity.filter(|(then, _)| *then <= time);
        self.heading = self.heading.filter(|(then, _)| *then <= time);
    }

    fn learn(&mut self, report: &Report, fix: Option<Fix>) {
        let sized = report.hull.filter(|_| !report.notes.has(Note::NoSize));
        self.hull = sized.or(self.hull);
        self.name = report.name.or(self.name);
        let Some(fix) = fix else { return };
        let time = fix.time.most;
        if let Some(position) = fix.position
            && self.place.is_none_or(|(then, _)| time >= then.most)
        {
            self.place = Some((fix.time, position));
        }
        if fix.velocity.speed.most.is_finite() && self.velocity.is_none_or(|(then, _)| time >= then)
        {
            self.velocity = Some((time, fix.velocity));
        }
        if fix.heading != Directions::ALL && self.heading.is_none_or(|(then, _)| time >= then) {
            self.heading = Some((time, fix.heading));
        }
    }

    /// Own ship at a time; `None` where its position is too old, or its direction is not known.
    pub fn at(
        &self,
        time: f64,
        plane: &Georeference,
        settings: &PictureSettings,
    ) -> Option<OwnPosition> {
        let (fixed, place) = self.place?;
        let age_s = time - fixed.least;
        if !(age_s <= settings.own_stale_s) {
            return None;
        }
        let is_fresh = |then: f64| time - then <= settings.own_stale_s;
        let (_, velocity) = self.velocity.filter(|(then, _)| is_fresh(*then))?;
        let heading = self.heading.filter(|(then, _)| is_fresh(*then));
        let heading = heading.map(|(_, heading)| heading);
        let is_under_way = velocity.course.half < std::f64::consts::FRAC_PI_2;
        let ahead = match (is_under_way, heading) {
            (true, _) => velocity.course,
            (false, heading) => heading?,
        };
        let heading = ahead.middle + ship::convergence(plane, place.at);
        let speed = 0.5 * (velocity.speed.least + velocity.speed.most);
        let middle_age = (time - 0.5 * (fixed.least + fixed.most)).max(0.0);
        let moved = match is_under_way {
            true => direction(heading) * (speed * middle_age),
            false => Vector::zeros(),
        };
        let uncertain_speed = 0.5 * (velocity.speed.most - velocity.speed.least);
        let across = match is_under_way {
            true => 2.0 * velocity.speed.most * (0.5 * velocity.course.half).sin(),
            false => velocity.speed.most,
        };
        let spread = 0.5 * (fixed.most - fixed.least).max(0.0);
        let [acceleration, _] = settings.acceleration_mps2;
        let radius_m = place.half_cell_m.norm()
            + place.radius_m
            + (uncertain_speed + across) * age_s.max(0.0)
            + speed * spread
            + 0.5 * acceleration * age_s * age_s;
        let antenna = plane.to_near_plane(place.at)? + moved;
        let (middle, beside) = match &self.hull {
            // the antenna may be anywhere on the hull
            None => (Vector::zeros(), settings.own_reach_m),
            Some(hull) => {
                let lies = self.heading.filter(|(then, _)| is_fresh(*then));
                let lies = lies.map_or(ahead, |(_, heading)| heading);
                let turned = Directions {
                    middle: lies.middle + ship::convergence(plane, place.at),
                    ..lies
                };
                let centres = ship::centres(hull, &turned);
                let middle = centres.centroid();
                (middle, centres.translated(-middle).reach())
            }
        };
        Some(OwnPosition {
            pose: Pose::new(antenna + middle, heading),
            speed,
            radius_m: radius_m + beside,
            age_s,
            size_m: self.hull.map(|hull| [hull.length.most, hull.beam.most]),
        })
    }
}
