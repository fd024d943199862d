//! Own ship, from its own sentences or from reports of it.

use searoom_geometry::frame::{Geographic, Georeference, Pose, Vector, direction};

use super::{PictureSettings, Taken, ship};
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
        let is_given = self.given == Some(report.identity);
        if !report.is_own {
            if is_given {
                self.learn(report, fix);
                return Some(Taken::Own);
            }
            return (self.identities.contains(&report.identity)).then_some(Taken::Echo);
        }
        if let Identity::Mmsi(_) = report.identity
            && !self.identities.contains(&report.identity)
        {
            let is_first = self.identities.is_empty();
            if self.identities.len() < MOST_IDENTITIES {
                self.identities.push(report.identity);
            }
            if !is_first {
                return Some(Taken::SecondOwn);
            }
        } else if matches!(report.identity, Identity::Mmsi(_))
            && self.identities.first() != Some(&report.identity)
        {
            return Some(Taken::SecondOwn);
        }
        self.learn(report, fix);
        Some(Taken::Own)
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
        let run = speed * middle_age;
        let moved = match is_under_way {
            true => direction(heading) * run,
            false => direction(heading) * 0.0,
        };
        let uncertain_speed = 0.5 * (velocity.speed.most - velocity.speed.least);
        let beside = match is_under_way {
            true => 2.0 * velocity.speed.most * (0.5 * velocity.course.half).sin(),
            false => velocity.speed.most,
        };
        let spread = 0.5 * (fixed.most - fixed.least).max(0.0);
        let [acceleration, _] = settings.acceleration_mps2;
        let radius_m = place.half_cell_m.norm()
            + place.radius_m
            + (uncertain_speed + beside) * age_s.max(0.0)
            + speed * spread
            + 0.5 * acceleration * age_s * age_s;
        let antenna = plane.to_near_plane(place.at)? + moved;
        let (middle, beside) = match &self.hull {
            None => (Vector::zeros(), 0.0),
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
