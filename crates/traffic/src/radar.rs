//! Targets of own ship's radar: TTM by range and bearing, TLL by position, TLB for their names.

use std::collections::HashMap;
use std::f64::consts::{FRAC_PI_2, PI};

use searoom_geometry::frame::{
    GEOREFERENCE_REACH_M, Georeference, KNOT_MPS, NAUTICAL_MILE_M, Vector, direction, heading_of,
};

use crate::counts::{Counts, Dropped};
use crate::fields::about;
use crate::own::{self, Own, Reception};
use crate::report::{
    Directions, Fix, Identity, Interval, Kind, Name, Note, Notes, PositionSet, Report, SourceId,
    VelocitySet,
};
use crate::sentence::Fields;
use crate::settings::{RelativeMotion, Settings};
use crate::time;

/// Most names that are kept.
const MOST_NAMES: usize = 1000;

const STATUTE_MILE_M: f64 = 1609.344;

/// Names of radar targets, by source and number.
#[derive(Debug, Default)]
pub(crate) struct Radar {
    names: HashMap<(Option<SourceId>, u16), Name>,
}

/// How far a target is tracked.
enum Tracking {
    Acquiring,
    Tracked,
}

impl Radar {
    /// Reports of a sentence. False for a sentence that is not of a radar.
    pub fn read(
        &mut self,
        formatter: &[u8; 3],
        fields: &Fields,
        reception: Reception,
        (own, settings): (&Own, &Settings),
        counts: &mut Counts,
        mut found: impl FnMut(Report),
    ) -> bool {
        let read = Reading {
            fields,
            reception,
            own,
            settings,
        };
        let report = match formatter {
            b"TTM" => self.target(&read, 12, 11, counts, |notes, tracking| {
                read.ttm(tracking, notes)
            }),
            b"TLL" => self.target(&read, 8, 6, counts, |notes, _| read.tll(notes)),
            b"TLB" => {
                if let Err(why) = self.names(fields, reception, counts, &mut found) {
                    counts.drop(why);
                }
                return true;
            }
            _ => return false,
        };
        match report {
            Ok(report) => found(report),
            Err(why) => counts.drop(why),
        }
        true
    }

    /// The report of a target, whose status and name are in these fields.
    fn target(
        &mut self,
        read: &Reading,
        status: usize,
        name: usize,
        counts: &mut Counts,
        fix: impl FnOnce(&mut Notes, Tracking) -> Result<Fix, Dropped>,
    ) -> Result<Report, Dropped> {
        let Reception { received, source } = read.reception;
        let number = number(read.fields, 1)?;
        let mut notes = Notes::default();
        let tracking = match read.fields.letter(status) {
            Some(b'L') => {
                self.names.remove(&(source, number));
                return Err(Dropped::Lost);
            }
            Some(b'T') => Tracking::Tracked,
            Some(b'Q') | None => {
                notes.add(Note::Acquiring);
                Tracking::Acquiring
            }
            _ => return Err(Dropped::Fields),
        };
        let fix = fix(&mut notes, tracking)?;
        if let Some(name) = Name::of(&String::from_utf8_lossy(read.fields.bytes(name))) {
            self.keep((source, number), name, counts);
        }
        Ok(Report {
            fix: Some(fix),
            name: self.names.get(&(source, number)).copied(),
            notes,
            ..Report::new(
                received,
                source,
                Identity::Radar { source, number },
                Kind::Radar,
            )
        })
    }

    fn keep(&mut self, of: (Option<SourceId>, u16), name: Name, counts: &mut Counts) {
        if self.names.len() < MOST_NAMES || self.names.contains_key(&of) {
            self.names.insert(of, name);
        } else {
            counts.drop(Dropped::TooManyNames);
        }
    }

    /// A report for each pair of number and name. A number without a name loses the one it had.
    fn names(
        &mut self,
        fields: &Fields,
        Reception { received, source }: Reception,
        counts: &mut Counts,
        mut found: impl FnMut(Report),
    ) -> Result<(), Dropped> {
        if fields.len() < 3 {
            return Err(Dropped::Fields);
        }
        for at in (1..fields.len()).step_by(2) {
            if fields.bytes(at).is_empty() && fields.bytes(at + 1).is_empty() {
                continue;
            }
            let number = number(fields, at)?;
            let name = Name::of(&String::from_utf8_lossy(fields.bytes(at + 1)));
            match name {
                Some(name) => self.keep((source, number), name, counts),
                None => {
                    self.names.remove(&(source, number));
                }
            }
            let identity = Identity::Radar { source, number };
            found(Report {
                name,
                ..Report::new(received, source, identity, Kind::Radar)
            });
        }
        Ok(())
    }
}

fn number(fields: &Fields, at: usize) -> Result<u16, Dropped> {
    let number = fields.text(at).parse().ok();
    number
        .filter(|number| *number < 10_000)
        .ok_or(Dropped::Fields)
}

struct Reading<'l> {
    fields: &'l Fields<'l>,
    reception: Reception,
    own: &'l Own,
    settings: &'l Settings,
}

impl Reading<'_> {
    fn time(&self, field: usize) -> Result<Interval, Dropped> {
        let received = self.reception.received;
        let text = self.fields.text(field);
        if text.is_empty() {
            return Ok(Interval::new(
                received - self.settings.radar_age_s,
                received,
            ));
        }
        let of_day = time::of_day(text).ok_or(Dropped::Fields)?;
        let at = time::nearest_day(of_day, received);
        Ok(Interval::new(at, at))
    }

    fn ttm(&self, tracking: Tracking, notes: &mut Notes) -> Result<Fix, Dropped> {
        let (fields, settings) = (self.fields, self.settings);
        let received = self.reception.received;
        // one letter for distance, speed and closest approach
        let (metres, mps) = match fields.letter(10) {
            Some(b'N') => (NAUTICAL_MILE_M, KNOT_MPS),
            Some(b'K') => (1000.0, 1.0 / 3.6),
            Some(b'S') => (STATUTE_MILE_M, STATUTE_MILE_M / 3600.0),
            _ => return Err(Dropped::Fields),
        };
        let (range, range_half) = fields.step(2)?.ok_or(Dropped::Fields)?;
        let (bearing, bearing_half) = fields.step(3)?.ok_or(Dropped::Fields)?;
        let (range, range_half) = (range * metres, range_half * metres);
        if !(0.0..=GEOREFERENCE_REACH_M).contains(&range) || !(0.0..=360.0).contains(&bearing) {
            return Err(Dropped::Fields);
        }
        let own = self.own.position(received, settings);
        let own = own.ok_or(Dropped::NoOwnPosition)?;
        let bearing = about(bearing, bearing_half, settings.bearing_error);
        let bearing = match fields.letter(4) {
            Some(b'T') => bearing,
            Some(b'R') => {
                let heading = self.own.heading(received, settings);
                from_heading(bearing, heading.ok_or(Dropped::NoOwnHeading)?)
            }
            _ => return Err(Dropped::Fields),
        };
        let error = settings.range_error_m.max(settings.range_error * range) + range_half;
        let range = Interval::new((range - error).max(0.0), range + error);
        let velocity = match tracking {
            Tracking::Acquiring => VelocitySet::UNKNOWN,
            Tracking::Tracked => self.velocity(mps, notes)?,
        };
        Ok(Fix {
            time: self.time(14)?,
            position: Some(beyond(&own, range, bearing, settings.radar_offset_m)?),
            velocity,
            heading: Directions::ALL,
            turn_rate: None,
        })
    }

    /// Velocity over ground from speed, course, and what the course is measured from.
    fn velocity(&self, mps: f64, notes: &mut Notes) -> Result<VelocitySet, Dropped> {
        let (fields, settings) = (self.fields, self.settings);
        let Some((speed, half_step)) = fields.step(5)? else {
            notes.add(Note::NoSpeed);
            return Ok(VelocitySet::UNKNOWN);
        };
        if !(speed >= 0.0) {
            return Err(Dropped::Fields);
        }
        let error = settings.target_speed_error_mps.max(0.01 * speed * mps) + half_step * mps;
        let speed = Interval::new((speed * mps - error).max(0.0), speed * mps + error);
        let Some((degrees, half_step)) = fields.step(6)? else {
            notes.add(Note::NoCourse);
            return Ok(self.relative(speed, fields.letter(7)));
        };
        if !(0.0..=360.0).contains(&degrees) {
            return Err(Dropped::Fields);
        }
        let course = about(degrees, half_step, settings.target_course_error);
        let received = self.reception.received;
        let (own, heading) = (
            self.own.velocity(received, settings),
            self.own.heading(received, settings),
        );
        let course = match (fields.letter(7), settings.relative) {
            (Some(b'T'), _) => course,
            (Some(b'R'), RelativeMotion::FromHeading) if let Some(heading) = heading => {
                from_heading(course, heading)
            }
            (Some(b'R'), RelativeMotion::FromMotion) if let Some(own) = own => {
                return Ok(sum(own, VelocitySet { speed, course }));
            }
            (Some(b'R') | None, _) => {
                notes.add(Note::RelativeCourse);
                return Ok(self.relative(speed, fields.letter(7)));
            }
            _ => return Err(Dropped::Fields),
        };
        let course = match speed.least < settings.least_course_mps {
            true => {
                notes.add(Note::SlowCourse);
                Directions::ALL
            }
            false => course,
        };
        Ok(VelocitySet { speed, course })
    }

    /// Every velocity of a speed in any direction, which may be relative to own ship's motion.
    fn relative(&self, speed: Interval, reference: Option<u8>) -> VelocitySet {
        let own = self.own.velocity(self.reception.received, self.settings);
        let own = own.map_or(f64::INFINITY, |own| own.speed.most);
        let speed = match reference {
            Some(b'T') => speed,
            _ => Interval::new(0.0, speed.most + own),
        };
        VelocitySet {
            speed,
            course: Directions::ALL,
        }
    }

    /// A place that the radar made of range, bearing and own ship's position, whose errors it has.
    fn tll(&self, notes: &mut Notes) -> Result<Fix, Dropped> {
        let (fields, settings) = (self.fields, self.settings);
        let own = self.own.position(self.reception.received, settings);
        let position = own::position(fields, 2, 0.0, notes)?;
        let position = position.map(|set| {
            let plane = own.and_then(|own| Georeference::new(own.at));
            let range = plane.and_then(|plane| plane.to_near_plane(set.at));
            let range = range.map_or(settings.farthest_m, |there| there.norm());
            let own = own.map_or(settings.inaccurate_m, |own| {
                own.radius_m + own.half_cell_m.norm()
            });
            let error = settings.range_error_m.max(settings.range_error * range);
            PositionSet {
                radius_m: own + error + settings.bearing_error * range + settings.radar_offset_m,
                ..set
            }
        });
        Ok(Fix {
            time: self.time(7)?,
            position,
            velocity: VelocitySet::UNKNOWN,
            heading: Directions::ALL,
            turn_rate: None,
        })
    }
}

/// Directions that are measured clockwise from a heading, as directions of the plane.
fn from_heading(relative: Directions, heading: Directions) -> Directions {
    Directions {
        // `relative` was made as from north
        middle: heading.middle + relative.middle - FRAC_PI_2,
        half: (heading.half + relative.half).min(PI),
    }
}

/// The places at a range and a bearing from own ship: the box to east and north around that part of a ring.
fn beyond(
    own: &PositionSet,
    range: Interval,
    bearing: Directions,
    offset_m: f64,
) -> Result<PositionSet, Dropped> {
    let [mut least, mut most] = [f64::INFINITY, f64::NEG_INFINITY].map(|of| Vector::new(of, of));
    let mut add = |point: Vector| (least, most) = (least.inf(&point), most.sup(&point));
    for side in [-1.0, 1.0] {
        let along = direction(bearing.middle + side * bearing.half);
        add(along * range.least);
        add(along * range.most);
    }
    for quarter in 0..4 {
        let axis = FRAC_PI_2 * f64::from(quarter);
        if bearing.contains(axis) {
            add(direction(axis) * range.most);
        }
    }
    let plane = Georeference::new(own.at).ok_or(Dropped::NoOwnPosition)?;
    Ok(PositionSet {
        at: plane.to_geographic(0.5 * (least + most)),
        half_cell_m: 0.5 * (most - least) + own.half_cell_m,
        radius_m: own.radius_m + offset_m,
    })
}

/// The sums of two sets of velocities, by a disc around each.
fn sum(a: VelocitySet, b: VelocitySet) -> VelocitySet {
    let disc = |set: VelocitySet| {
        let Interval { least, most } = set.speed;
        if !(set.course.half < FRAC_PI_2) {
            return (Vector::zeros(), most);
        }
        let middle = 0.5 * (least + most);
        let corner =
            |speed: f64| (direction(set.course.half) * speed - Vector::new(middle, 0.0)).norm();
        let radius = corner(least).max(corner(most)).max(most - middle);
        (direction(set.course.middle) * middle, radius)
    };
    let ((at_a, radius_a), (at_b, radius_b)) = (disc(a), disc(b));
    let (at, radius) = (at_a + at_b, radius_a + radius_b);
    let speed = at.norm();
    VelocitySet {
        speed: Interval::new((speed - radius).max(0.0), speed + radius),
        course: match speed > radius {
            true => Directions {
                middle: heading_of(at),
                half: (radius / speed).asin(),
            },
            false => Directions::ALL,
        },
    }
}

#[cfg(test)]
mod tests {
    use searoom_geometry::frame::Geographic;

    use super::*;

    #[test]
    fn a_part_of_a_ring_is_within_its_box() {
        let own = PositionSet {
            at: Geographic::new(-56.5, -179.999),
            half_cell_m: Vector::zeros(),
            radius_m: 0.0,
        };
        let plane = Georeference::new(own.at).expect("a plane");
        let range = Interval::new(9_000.0, 10_000.0);
        for (middle, half) in [(0.1, 0.3), (1.5, 0.2), (3.0, 1.0), (-1.0, 2.0), (2.0, PI)] {
            let bearing = Directions { middle, half };
            let set = beyond(&own, range, bearing, 0.0).expect("a place");
            let at = plane.to_plane(set.at);
            let mut most = Vector::zeros();
            for part in 0..=400 {
                let along = direction(middle + half * (f64::from(part) / 200.0 - 1.0));
                for metres in [range.least, range.most] {
                    let off = (along * metres - at).abs();
                    assert!(
                        (off - set.half_cell_m).max() <= 1e-3,
                        "{middle} {half} {off}"
                    );
                    most = most.sup(&off);
                }
            }
            // and touches it
            assert!((set.half_cell_m - most).amax() < 2.0, "{middle} {half}");
        }
    }
}
