//! Own ship's alteration in a few words: its greatest departure from the desired course, or where
//! there is none from the desired speed.

use std::f64::consts::{PI, TAU};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::PlanDocument;
use super::motions::STILL_MPS;
use crate::parts::SampleDocument;
use searoom_geometry::frame::{
    Side, Vector, cross, deg_from_radians, heading_from_course_deg, heading_of, wrap,
};
use searoom_input::text::{Times, knots, significant};
use searoom_model::trajectory::{DesiredLeg, DesiredTrajectory};

/// Degrees: a smaller departure from the desired course is none.
pub const LEAST_DEG: f64 = 5.0;

/// Seconds: a shorter departure that was sailed is none.
const LEAST_S: f64 = 3.0;

/// Hysteresis: a departure ends below this course error, degrees, so that a course near [`LEAST_DEG`] is one
/// departure.
const LEAVES_DEG: f64 = 3.0;

/// Fraction of the turning radius. Own ship is on its path where it is less far from it.
const ON_PATH: f64 = 0.1;

/// Fraction of the desired speed. A smaller departure from it is none.
const SPEED: f64 = 0.02;

/// Radians: a course farther from that of the leg is about opposite to it.
const OPPOSITE_RAD: f64 = 0.75 * PI;

/// Weight of time beside place, as a fraction of the desired speed. It decides between legs that
/// cover the same ground.
const TIME_WEIGHT: f64 = 0.1;

/// Radians between two samples. A smaller change of course is no turn.
const TURN_RAD: f64 = 1e-4;

/// Fraction by which a turn between two samples may seem faster than the turning radius allows.
const FASTER: f64 = 0.05;

/// Degrees that decide how a turn is judged: the least turn of a manoeuvre, and a large one.
const LIMITS_DEG: [f64; 2] = [30.0, 90.0];

/// Whole degrees, with a tenth where they would hide that a turn is below a limit.
pub(crate) fn turn_figure(degrees: f64) -> String {
    let hides = |limit: f64| degrees.round() == limit && degrees < limit - 0.05;
    let digits = usize::from(degrees < 0.5 || LIMITS_DEG.into_iter().any(hides));
    format!("{degrees:.digits$}")
}

/// Greatest departure of a motion from the desired course, or else from the desired speed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Departure {
    /// The greatest one of 5° or more that does not begin toward the path, and the start of the
    /// turn to it.
    Course {
        side: Side,
        turn_deg: f64,
        from_s: f64,
    },
    /// The longest wait, and the distance sailed before it.
    Waits {
        for_s: f64,
        at_m: f64,
        #[serde(default)]
        from_s: f64,
    },
    /// Speed farthest from the desired one, and since when it is lower or higher.
    Speed {
        slower: bool,
        speed_mps: f64,
        from_s: f64,
    },
}

/// A departure as it was sailed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SailedManoeuvreDocument {
    #[serde(flatten)]
    pub departure: Departure,
    /// When own ship begins to turn back to its path; null where it has not come back, and where
    /// only the speed departs.
    pub returns_s: Option<f64>,
}

impl Departure {
    /// When it begins, seconds.
    pub fn begins_s(&self) -> f64 {
        match *self {
            Self::Course { from_s, .. }
            | Self::Speed { from_s, .. }
            | Self::Waits { from_s, .. } => from_s,
        }
    }

    /// Side and degrees, with a wait its duration, or the speed.
    pub fn brief(&self) -> String {
        match *self {
            Self::Course { side, turn_deg, .. } => format!("{side} {}°", turn_figure(turn_deg)),
            Self::Waits { for_s, .. } => format!("waits {for_s:.0} s"),
            Self::Speed {
                slower, speed_mps, ..
            } => {
                let verb = if slower { "slows" } else { "speeds up" };
                format!("{verb} to {}", knots(speed_mps))
            }
        }
    }

    /// [`Departure::brief`], and when or where.
    pub fn words(&self, times: Times) -> String {
        let place = match *self {
            Self::Course { from_s, .. } | Self::Speed { from_s, .. } => {
                format!("from {}", times.at(from_s, 0))
            }
            Self::Waits { at_m, .. } => format!("at {} m", significant(at_m)),
        };
        format!("{} {place}", self.brief())
    }
}

impl std::fmt::Display for Departure {
    /// [`Departure::brief`], and when or where.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.words(Times::Seconds))
    }
}

impl PlanDocument {
    /// The plan's departure from its mission; `None` without a plan, or where it has none.
    pub fn departure_of_motion(&self) -> Option<Departure> {
        let points = self.mission.waypoints.iter().map(|point| point.point());
        let points: Vec<Vector> = points.collect();
        let desired = DesiredTrajectory::new(&points, &self.mission.leg_speeds_mps).ok()?;
        let radius = self.own_ship.turning_radius_m;
        let samples = &self.trajectory.as_ref()?.samples;
        let samples = match (&self.optimal_control, &self.cost) {
            (Some(_), Some(cost)) => until(samples, cost.space_time_error_until_s),
            _ => samples,
        };
        departure(samples, &desired, radius, self.path_time.is_some())
    }
}

/// Samples of a motion under forces while its space-time error is counted. Afterwards own ship drifts
/// about the last waypoint, on any course.
pub fn until(samples: &[SampleDocument], end_s: f64) -> &[SampleDocument] {
    &samples[..samples.partition_point(|sample| sample.t_s <= end_s)]
}

/// Departure of a sampled motion from the desired trajectory. At a corner, every course between
/// those of its legs is a desired one: within two turning `radius` in metres. A departure toward the
/// desired path is the return from a manoeuvre. A motion along given paths departs in speed alone,
/// and one of no duration not at all.
pub fn departure(
    samples: &[SampleDocument],
    desired: &DesiredTrajectory,
    radius: f64,
    is_along_path: bool,
) -> Option<Departure> {
    let (first, last) = samples.first().zip(samples.last())?;
    if last.t_s <= first.t_s {
        return None;
    }
    let turns = match is_along_path {
        true => Vec::new(),
        false => turns(samples, desired, radius),
    };
    let greatest = turns
        .iter()
        .rev()
        .max_by(|a, b| a.degrees.total_cmp(&b.degrees));
    (greatest.map(Turn::departure))
        .or_else(|| wait(samples))
        .or_else(|| change(samples, desired))
}

/// Manoeuvres of a motion that was sailed, in order of time: every departure from the desired
/// course, or else the one of [`departure`].
pub fn manoeuvres(
    samples: &[SampleDocument],
    desired: &DesiredTrajectory,
    radius: f64,
    is_along_path: bool,
) -> Vec<SailedManoeuvreDocument> {
    let only = departure(samples, desired, radius, is_along_path);
    if let Some(Departure::Course { .. }) = only {
        let turns = turns(samples, desired, radius).into_iter();
        let lasts = |turn: &Turn| {
            turn.returns
                .is_none_or(|returns| returns > turn.from + LEAST_S)
        };
        let sailed = turns.filter(lasts).map(|turn| SailedManoeuvreDocument {
            departure: turn.departure(),
            returns_s: turn.returns,
        });
        return sailed.collect();
    }
    let departs = |departure| SailedManoeuvreDocument {
        departure,
        returns_s: None,
    };
    only.map(departs).into_iter().collect()
}

/// Index of the desired leg at a sample.
fn leg_at(desired: &DesiredTrajectory, sample: &SampleDocument) -> usize {
    let place = Vector::new(sample.east_m, sample.north_m);
    let weight = TIME_WEIGHT * desired.legs()[0].speed;
    desired.nearest(place, sample.t_s, weight * weight).leg
}

/// Metres along a leg, and metres from it, positive to port.
fn place_on(leg: &DesiredLeg, sample: &SampleDocument) -> (f64, f64) {
    let offset = Vector::new(sample.east_m, sample.north_m) - leg.start;
    let along = leg.direction.dot(&offset).clamp(0.0, leg.length);
    let off = (offset - leg.direction * along).norm();
    (along, off.copysign(cross(leg.direction, offset)))
}

/// A turn away from the desired course.
struct Turn {
    side: Side,
    /// Greatest departure.
    degrees: f64,
    /// Seconds: its start, and those of the turns back to the desired course and to the path.
    from: f64,
    resumes: Option<f64>,
    returns: Option<f64>,
}

impl Turn {
    fn departure(&self) -> Departure {
        Departure::Course {
            side: self.side,
            // beyond the opposite course the departure is less again
            turn_deg: self.degrees.min(180.0),
            from_s: self.from,
        }
    }
}

/// All turns away, in order of time.
fn turns(samples: &[SampleDocument], desired: &DesiredTrajectory, radius: f64) -> Vec<Turn> {
    let legs = desired.legs();
    let mut turns: Vec<Turn> = Vec::new();
    // the side of the present departure, and whether it is a return
    let mut current: Option<(Side, bool)> = None;
    let moving: Vec<&SampleDocument> = (samples.iter())
        .filter(|sample| sample.speed_mps > STILL_MPS)
        .collect();
    for (at, sample) in moving.iter().enumerate() {
        let index = leg_at(desired, sample);
        let (along, off) = place_on(&legs[index], sample);
        let heading = heading_from_course_deg(sample.course_deg);
        let from = |leg: &DesiredLeg| wrap(heading - heading_of(leg.direction));
        let leg = &legs[index];
        let mut turned = from(leg);
        let before = index.checked_sub(1).filter(|_| along < 2.0 * radius);
        let after = (leg.length - along < 2.0 * radius).then_some(index + 1);
        for other in [before, after]
            .into_iter()
            .flatten()
            .filter_map(|i| legs.get(i))
        {
            let (this, that) = (from(leg), from(other));
            let corner = wrap(heading_of(other.direction) - heading_of(leg.direction));
            let is_between = this.abs() + that.abs() <= corner.abs() + 1e-6;
            let least = if that.abs() < turned.abs() {
                that
            } else {
                turned
            };
            turned = if is_between { 0.0 } else { least };
        }
        let last = current.map(|(side, _)| side);
        // about opposite to the leg, a turn goes on to the side to which it began
        if let Some(sign) = last.map(Side::turn_sign)
            && turned * sign < -OPPOSITE_RAD
        {
            turned += sign * TAU;
        }
        let degrees = deg_from_radians(turned.abs());
        let turned_to = Side::of_turn(turned);
        let goes_on = turned_to.is_some() && turned_to == last;
        let least = if goes_on { LEAVES_DEG } else { LEAST_DEG };
        let side = turned_to.filter(|_| degrees >= least);
        let is_on_path = off.abs() <= ON_PATH * radius;
        if side != last {
            let begin = |side| begin(&moving[..=at], side, radius);
            let returns = side.is_some() && !is_on_path && off * turned < 0.0;
            match (current, turns.last_mut()) {
                (Some((last, false)), Some(turn)) => {
                    turn.resumes = Some(begin(last.opposite()));
                    turn.returns = turn.resumes.filter(|_| returns);
                }
                (None, Some(turn)) if returns => turn.returns = turn.returns.or(side.map(begin)),
                _ => {}
            }
            current = side.map(|side| (side, returns));
            if let Some((side, false)) = current {
                turns.push(Turn {
                    side,
                    degrees,
                    from: begin(side),
                    resumes: None,
                    returns: None,
                });
            }
        }
        if let (Some((_, false)), Some(turn)) = (current, turns.last_mut()) {
            turn.degrees = turn.degrees.max(degrees);
        }
        // a small departure needs no turn to the path
        if let (None, true, Some(turn)) = (current, is_on_path, turns.last_mut()) {
            turn.returns = turn.returns.or(turn.resumes);
        }
    }
    turns
}

/// Start of the turn to a side that leads to the last sample: back over the samples between which
/// own ship turned to this side, within its turning radius in metres.
fn begin(samples: &[&SampleDocument], side: Side, radius: f64) -> f64 {
    let heading = |sample: &SampleDocument| heading_from_course_deg(sample.course_deg);
    let turns = |pair: &[&SampleDocument]| {
        let turned = side.turn_sign() * wrap(heading(pair[1]) - heading(pair[0]));
        let most = pair[0].speed_mps * (pair[1].t_s - pair[0].t_s) / radius;
        turned > TURN_RAD && turned <= most * (1.0 + FASTER)
    };
    let last = samples.len() - 1;
    let back = samples.windows(2).rev().take_while(|pair| turns(pair));
    samples[last - back.count()].t_s
}

fn wait(samples: &[SampleDocument]) -> Option<Departure> {
    let mut longest: Option<(f64, f64, f64)> = None;
    let (mut sailed, mut waited) = (0.0, 0.0);
    for pair in samples.windows(2) {
        let (here, next) = (&pair[0], &pair[1]);
        let lasts = next.t_s - here.t_s;
        if here.speed_mps > STILL_MPS {
            sailed += here.speed_mps * lasts;
            waited = 0.0;
        } else {
            waited += lasts;
            if longest.is_none_or(|(most, ..)| waited > most) {
                longest = Some((waited, sailed, next.t_s - waited));
            }
        }
    }
    longest.map(|(for_s, at_m, from_s)| Departure::Waits {
        for_s,
        at_m,
        from_s,
    })
}

fn change(samples: &[SampleDocument], desired: &DesiredTrajectory) -> Option<Departure> {
    let mut greatest: Option<(f64, Departure)> = None;
    let mut current: Option<(bool, f64)> = None;
    // the speed of a sample holds from then on, so that of the last does not matter
    for sample in samples.iter().take(samples.len().saturating_sub(1)) {
        let ratio = sample.speed_mps / desired.legs()[leg_at(desired, sample)].speed;
        let slower = ratio < 1.0;
        if (ratio - 1.0).abs() <= SPEED {
            current = None;
            continue;
        }
        let from_s = match current {
            Some((same, from_s)) if same == slower => from_s,
            _ => sample.t_s,
        };
        current = Some((slower, from_s));
        let size = ratio.ln().abs();
        if greatest.is_none_or(|(most, _)| size > most * (1.0 + SPEED)) {
            let speed_mps = sample.speed_mps;
            let change = Departure::Speed {
                slower,
                speed_mps,
                from_s,
            };
            greatest = Some((size, change));
        }
    }
    greatest.map(|(_, change)| change)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples of a motion from the origin: seconds, course in degrees, and speed, each until the
    /// next.
    fn sailed(parts: &[(u32, f64, f64)]) -> Vec<SampleDocument> {
        let mut place = Vector::zeros();
        let mut samples = Vec::new();
        for (seconds, course_deg, speed_mps) in parts {
            for _ in 0..*seconds {
                samples.push(SampleDocument {
                    t_s: samples.len() as f64,
                    east_m: place.x,
                    north_m: place.y,
                    course_deg: *course_deg,
                    speed_mps: *speed_mps,
                    node: None,
                });
                place += searoom_geometry::frame::direction(heading_from_course_deg(*course_deg))
                    * *speed_mps;
            }
        }
        samples
    }

    fn found(points: &[(f64, f64)], parts: &[(u32, f64, f64)]) -> String {
        let points: Vec<Vector> = points.iter().map(|(x, y)| Vector::new(*x, *y)).collect();
        let speeds = vec![5.0; points.len() - 1];
        let desired = DesiredTrajectory::new(&points, &speeds).expect("a path");
        let found = departure(&sailed(parts), &desired, 30.0, false);
        found.map_or("none".to_owned(), |found| found.to_string())
    }

    #[test]
    fn a_turn_below_a_limit_is_not_shown_as_one_at_it() {
        let figures = [89.73, 89.98, 90.4, 88.7, 29.6, 0.4].map(turn_figure);
        assert_eq!(figures, ["89.7", "90", "90", "89", "29.6", "0.4"]);
    }

    /// A full circle departs by no more than the opposite course, and what a motion does after its
    /// end is no departure.
    #[test]
    fn a_circle_is_a_departure_of_half_a_turn_until_the_end() {
        let circle = (1..36).map(|k| (2, f64::from(90 + 10 * k) % 360.0, 5.0));
        let parts: Vec<_> = std::iter::once((100, 90.0, 5.0)).chain(circle).collect();
        let all = sailed(&parts);
        let points = [(0.0, 0.0), (2000.0, 0.0)].map(|(x, y)| Vector::new(x, y));
        let desired = DesiredTrajectory::new(&points, &[5.0]).expect("a path");
        let brief = |samples| departure(samples, &desired, 30.0, false).map(|found| found.brief());
        assert_eq!(brief(&all), Some("starboard 180°".to_owned()));
        assert_eq!(brief(until(&all, 99.0)), None);
    }

    #[test]
    fn a_motion_of_no_duration_departs_from_nothing() {
        let north = [(0.0, 0.0), (0.0, 1000.0)];
        assert_eq!(found(&north, &[(1, 60.0, 5.0)]), "none");
        assert_ne!(found(&north, &[(30, 60.0, 5.0)]), "none");
    }

    #[test]
    fn the_greatest_departure_of_a_manoeuvre_counts_and_its_return_does_not() {
        let east = [(0.0, 0.0), (2000.0, 0.0)];
        for (parts, expected) in [
            (vec![(100, 90.0, 5.0)], "none"),
            (vec![(50, 90.0, 5.0), (50, 93.0, 5.0)], "none"),
            // one degree to port first, and a return by more than the manoeuvre
            (
                vec![
                    (9, 89.0, 5.0),
                    (20, 120.0, 5.0),
                    (9, 90.0, 5.0),
                    (9, 20.0, 5.0),
                ],
                "starboard 30° from 9 s",
            ),
            // a smaller manoeuvre to port before
            (
                vec![
                    (5, 80.0, 5.0),
                    (5, 100.0, 5.0),
                    (9, 90.0, 5.0),
                    (30, 172.0, 5.0),
                ],
                "starboard 82° from 19 s",
            ),
            (
                vec![(80, 90.0, 5.0), (30, 90.0, 2.5), (9, 90.0, 5.0)],
                "slows to 4.9 kn from 80 s",
            ),
            (
                vec![(40, 90.0, 5.0), (30, 90.0, 7.5), (9, 90.0, 5.0)],
                "speeds up to 14.6 kn from 40 s",
            ),
            (
                vec![(100, 90.0, 5.0), (104, 90.0, 0.0), (9, 90.0, 5.0)],
                "waits 104 s at 500 m",
            ),
        ] {
            assert_eq!(found(&east, &parts), expected);
        }
    }

    /// A course a little beyond the opposite of the path's is no turn to the other side.
    #[test]
    fn a_turn_about_is_one_departure() {
        let turning = (1..30).map(|k| (1, 90.0 + 6.0 * f64::from(k), 5.0));
        let about = [269.8, 270.3, 269.9].map(|course| (9, course, 5.0));
        let parts: Vec<_> = std::iter::once((10, 90.0, 5.0))
            .chain(turning)
            .chain(about)
            .collect();
        assert_eq!(
            found(&[(0.0, 0.0), (2000.0, 0.0)], &parts),
            "starboard 180° from 9 s"
        );
    }

    /// The turn back to the path counts, not the one to the desired course before it. Beside the path
    /// own ship has not come back.
    #[test]
    fn every_turn_away_has_its_turn_back() {
        let parts = [
            (10, 90.0, 5.0),
            (20, 120.0, 5.0),
            (30, 90.0, 5.0),
            (20, 60.0, 5.0),
            (10, 90.0, 5.0),
            (10, 110.0, 5.0),
            (20, 88.0, 5.0),
        ];
        let points = [(0.0, 0.0), (2000.0, 0.0)].map(|(x, y)| Vector::new(x, y));
        let desired = DesiredTrajectory::new(&points, &[5.0]).expect("a path");
        let sailed = manoeuvres(&sailed(&parts), &desired, 30.0, false);
        let sailed = sailed
            .iter()
            .map(|m| (m.departure.to_string(), m.returns_s));
        let expected = [("30° from 10 s", Some(60.0)), ("20° from 90 s", None)];
        let expected = expected.map(|(turn, returns)| (format!("starboard {turn}"), returns));
        assert_eq!(sailed.collect::<Vec<_>>(), expected);
    }

    /// A small departure needs no turn to the path; a course about 5° is one departure.
    #[test]
    fn a_departure_ends_on_the_path_and_well_below_its_least_course() {
        let points = [(0.0, 0.0), (2000.0, 0.0)].map(|(x, y)| Vector::new(x, y));
        let desired = DesiredTrajectory::new(&points, &[5.0]).expect("a path");
        let of = |parts: &[(u32, f64, f64)]| -> Vec<_> {
            let all = manoeuvres(&sailed(parts), &desired, 100.0, false);
            all.iter()
                .map(|m| (m.departure.begins_s(), m.returns_s))
                .collect()
        };
        let small = [(10, 90.0, 5.0), (10, 98.0, 5.0), (10, 90.0, 5.0)];
        assert_eq!(of(&small), [(10.0, Some(20.0))]);
        let near = [96.0, 94.5, 96.0, 94.5].map(|course| (20, course, 5.0));
        assert_eq!(of(&near), [(0.0, None)]);
        let across = [(10, 90.0, 5.0), (20, 120.0, 5.0), (20, 60.0, 5.0)];
        assert_eq!(of(&across), [(10.0, Some(30.0))]);
        let waits = [(100, 90.0, 5.0), (30, 90.0, 0.0), (9, 90.0, 5.0)];
        assert_eq!(of(&waits), [(100.0, None)]);
    }

    /// 5° are reached two seconds after the turn has begun.
    #[test]
    fn a_departure_begins_with_its_turn() {
        let arc = (1..=10).map(|k| (1, 90.0 + 3.0 * f64::from(k), 5.0));
        let parts: Vec<_> = std::iter::once((13, 90.0, 5.0)).chain(arc).collect();
        let east = [(0.0, 0.0), (2000.0, 0.0)];
        assert_eq!(found(&east, &parts), "starboard 30° from 12 s");
    }

    #[test]
    fn a_corner_of_the_mission_is_no_departure() {
        let corner = [(0.0, 0.0), (500.0, 0.0), (500.0, -500.0)];
        let around = [(95, 90.0, 5.0), (7, 135.0, 5.0), (60, 180.0, 5.0)];
        assert_eq!(found(&corner, &around), "none");
        let wide = [(95, 90.0, 5.0), (7, 135.0, 5.0), (60, 210.0, 5.0)];
        assert_eq!(found(&corner, &wide), "starboard 30° from 102 s");
        // out and back
        let back = [(0.0, 0.0), (500.0, 0.0), (0.0, 1.0)];
        assert_eq!(found(&back, &[(50, 120.0, 5.0)]), "starboard 30° from 0 s");
        let turned_on_the_way_back = [(100, 90.0, 5.0), (40, 270.0, 5.0), (20, 291.0, 5.0)];
        let expected = "starboard 21° from 140 s";
        assert_eq!(found(&back, &turned_on_the_way_back), expected);
    }
}
