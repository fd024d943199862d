//! Curves over time: clearance, margin, speed, course.

use rerun::components::{AggregationPolicy, InterpolationMode};
use rerun::{EntityPath, RecordingStreamResult, Scalars, SeriesLines, TimeColumn};

use super::columns::log_columns;
use super::recorder::Recorder;
use super::scene::{Motion, Scene, Stage, desired_leg};
use super::{TIMELINE, path, style};
use crate::frame::{course_deg_from_heading, deg_from_radians, heading_of, knots_from_mps, wrap};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::target::Target;
use crate::tolerance;

/// Distances between hulls, per target.
pub const CLEARANCE: &str = "curves/clearance_m";
/// Distances of own ship's centre to the nearest set.
pub const MARGIN: &str = "curves/margin_m";
/// Risks, per target.
pub const RISK: &str = "curves/risk";
/// Speed through the water.
pub const SPEED: &str = "curves/speed_kn";
/// Course, continuous: it may leave 0..360 rather than jump.
pub const COURSE: &str = "curves/course_deg";

/// Of the range of a curve: how far it may be drawn from its samples, half a pixel of a plot 500 high.
const OFF: f64 = 1e-3;

/// Metres, degrees, shares: what varies by less is drawn as if it did not vary.
const LEAST_RANGE: f64 = 1e-3;

/// What the layout has to know of, too, at every sample.
pub struct Curves {
    /// Per target; the last is what is asked for.
    clearances: Vec<Series>,
    /// The first is that of the hard sets; none without sets.
    margins: Vec<Series>,
    /// Own ship's, degrees, continuous.
    courses: Vec<f64>,
}

impl Curves {
    pub fn of(scene: &Scene) -> Self {
        let is_met = !scene.sets.is_empty();
        Self {
            clearances: clearance_curves(scene),
            margins: if is_met {
                margin_curves(scene)
            } else {
                Vec::new()
            },
            courses: courses(scene),
        }
    }

    /// The greatest of the targets' least clearances, metres; 0 without targets.
    pub fn farthest_passage(&self) -> f64 {
        let targets = self.clearances.split_last().map_or(&[][..], |(_, of)| of);
        targets.iter().map(Series::least).fold(0.0, f64::max)
    }

    /// Metres from the hard sets; infinite without sets.
    pub fn least_margin(&self) -> f64 {
        self.margins.first().map_or(f64::INFINITY, Series::least)
    }

    /// Least and greatest course, degrees.
    pub fn course_range(&self) -> [f64; 2] {
        let all = || self.courses.iter().copied();
        let (low, high) = (f64::INFINITY, f64::NEG_INFINITY);
        [all().fold(low, f64::min), all().fold(high, f64::max)]
    }
}

/// All curves, at most some hundred samples each.
pub fn log_curves(rec: &mut Recorder, scene: &Scene, curves: &Curves) -> RecordingStreamResult<()> {
    let (samples, between) = (&scene.samples, InterpolationMode::Linear);
    log_plot(
        rec,
        path(&[CLEARANCE]),
        samples,
        between,
        &curves.clearances,
    )?;
    if !curves.margins.is_empty() {
        log_plot(rec, path(&[MARGIN]), samples, between, &curves.margins)?;
    }
    log_risks(rec, scene)?;
    log_speed(rec, scene)?;
    log_course(rec, scene, &curves.courses)
}

/// One curve of a plot.
pub struct Series {
    /// As the legend has it.
    pub name: String,
    pub color: rerun::Color,
    pub width: f32,
    /// One per time.
    pub values: Vec<f64>,
}

impl Series {
    fn least(&self) -> f64 {
        self.values.iter().copied().fold(f64::INFINITY, f64::min)
    }
}

/// All curves of a plot in one entity: a recording pays for entities, not for values. Every row has all of them, and
/// each is a number: one that is none equals nothing, itself neither, and no two recordings would be alike.
pub fn log_plot(
    rec: &mut Recorder,
    entity: EntityPath,
    times: &[f64],
    between: InterpolationMode,
    series: &[Series],
) -> RecordingStreamResult<()> {
    let shortest = series.iter().map(|s| s.values.len()).min().unwrap_or(0);
    let times = &times[..shortest.min(times.len())];
    let look = SeriesLines::new()
        .with_names(series.iter().map(|s| s.name.as_str()))
        .with_colors(series.iter().map(|s| s.color))
        .with_widths(series.iter().map(|s| s.width))
        .with_interpolation_mode(between)
        // averaging neighbours would show speeds and depths that are not there
        .with_aggregation_policy(AggregationPolicy::Off);
    let rows = if between == InterpolationMode::Linear {
        bends(times, series)
    } else {
        (0..times.len()).collect()
    };
    let values = rows
        .iter()
        .flat_map(|&row| series.iter().map(move |s| s.values[row]));
    let columns = Scalars::update_fields()
        .with_scalars(values)
        .columns(vec![series.len(); rows.len()])?;
    let times = TimeColumn::new_duration_secs(TIMELINE, rows.iter().map(|&row| times[row]));
    log_columns(rec, entity, times, &look, columns)
}

/// The rows that draw the same curves: the first and the last, those of least and greatest values, and as many between
/// them that no curve is off by more than [`OFF`] of its range. O(rows log rows) as a rule.
fn bends(times: &[f64], series: &[Series]) -> Vec<usize> {
    let Some(last) = times.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut kept = vec![0, last];
    let mut allowed = Vec::new();
    for curve in series {
        let by_value = |a: &usize, b: &usize| curve.values[*a].total_cmp(&curve.values[*b]);
        let (low, high) = ((0..=last).min_by(by_value), (0..=last).max_by(by_value));
        let (low, high) = (low.unwrap_or(0), high.unwrap_or(0));
        kept.extend([low, high]);
        let range = curve.values[high] - curve.values[low];
        allowed.push(OFF * range.max(LEAST_RANGE));
    }
    kept.sort_unstable();
    kept.dedup();
    let mut stretches: Vec<(usize, usize)> = kept.windows(2).map(|w| (w[0], w[1])).collect();
    while let Some((from, to)) = stretches.pop() {
        let worst = (from + 1..to)
            .map(|row| {
                let share = (times[row] - times[from]) / (times[to] - times[from]);
                let off = series.iter().zip(&allowed).map(|(curve, allowed)| {
                    let v = &curve.values;
                    let off = (v[from] + share * (v[to] - v[from]) - v[row]).abs();
                    if off > *allowed {
                        off / allowed.max(f64::MIN_POSITIVE)
                    } else {
                        0.0
                    }
                });
                (row, off.fold(0.0, f64::max))
            })
            .max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((row, _)) = worst.filter(|w| w.1 > 0.0) {
            kept.push(row);
            stretches.extend([(from, row), (row, to)]);
        }
    }
    kept.sort_unstable();
    kept
}

fn clearance_curves(scene: &Scene) -> Vec<Series> {
    let targets = scene.scenario.targets.iter().enumerate();
    let mut series: Vec<Series> = targets
        .map(|(index, target)| Series {
            name: target.name.clone(),
            color: style::target(index),
            width: 2.0,
            values: clearances(scene, &scene.motion, target),
        })
        .collect();
    series.push(safety_margin(scene));
    series
}

/// What is asked for between the hulls, at every sample.
pub fn safety_margin(stage: &Stage) -> Series {
    Series {
        name: "safety margin".to_owned(),
        color: style::alarm(),
        width: 1.0,
        values: vec![stage.scenario.own_ship.safety_margin; stage.samples.len()],
    }
}

/// Metres between own hull and the target's expected hull, or between own ship's centre and the target's set
/// where that is given (it has her hull in it), at every sample until arrival; negative in overlap.
pub fn clearances(stage: &Stage, motion: &Motion, target: &Target) -> Vec<f64> {
    let own = &stage.scenario.own_ship.hull;
    let at = |&time: &f64| {
        let pose = motion.pose_at(time);
        match (target.ship(), target.outer_set_at(time)) {
            (Some(ship), _) => {
                let hull = ship.hull.polygon(&ship.pose_at(time));
                own.polygon(&pose).separation(&hull)
            }
            (None, Some(set)) => set.signed_distance(pose.position),
            // a ship or a set: nothing else is a target
            (None, None) => f64::NAN,
        }
    };
    motion
        .until_arrival(&stage.samples)
        .iter()
        .map(at)
        .collect()
}

/// Of the hard and the shaped sets, and of those that were kept out of where they are neither.
pub fn margin_curves(scene: &Scene) -> Vec<Series> {
    let sets = &scene.sets;
    let hard: Vec<&Obstacle> = sets.iter().map(|s| &s.hard).collect();
    let shaped: Vec<&Obstacle> = (sets.iter())
        .map(|s| scene.shaped(s).unwrap_or(&s.hard))
        .collect();
    let mut series = vec![Series {
        name: "hard sets".to_owned(),
        color: style::own_ship(),
        width: 2.0,
        values: margins(scene, &hard),
    }];
    if hard != shaped {
        series.push(Series {
            name: "shaped sets".to_owned(),
            color: style::Pace::Slow.color(),
            width: 2.0,
            values: margins(scene, &shaped),
        });
    }
    // level sets of an accepted risk, or ellipsoids around the others
    let kept_out_of: Vec<&Obstacle> = scene.run.obstacles.iter().collect();
    if kept_out_of != hard && kept_out_of != shaped {
        series.push(Series {
            name: "sets kept out of".to_owned(),
            color: style::Pace::Fast.color(),
            width: 2.0,
            values: margins(scene, &kept_out_of),
        });
    }
    series.push(Series {
        name: "contact".to_owned(),
        color: style::alarm(),
        width: 1.0,
        values: vec![0.0; scene.samples.len()],
    });
    series
}

/// Metres from own ship's centre to the nearest of the sets at every sample until arrival; negative inside.
pub fn margins(scene: &Scene, sets: &[&Obstacle]) -> Vec<f64> {
    let at = |&time: &f64| {
        let own = scene.motion.pose_at(time).position;
        let margins = sets.iter().map(|s| s.signed_distance(own, time).distance);
        margins.fold(f64::INFINITY, f64::min)
    };
    let times = scene.motion.until_arrival(&scene.samples);
    times.iter().map(at).collect()
}

fn log_risks(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    let times = risk_times(scene);
    let series = risk_curves(scene, &times);
    log_plot(
        rec,
        path(&[RISK]),
        &times,
        InterpolationMode::Linear,
        &series,
    )
}

/// The risks that the plan document reports, against the sets that were planned against; beside them those against the
/// hard sets where these differ.
pub fn risk_curves(scene: &Scene, times: &[f64]) -> Vec<Series> {
    let both = scene.run.whole.iter().zip(scene.sets).enumerate();
    let mut series = Vec::new();
    for (index, (kept_out_of, sets)) in both {
        let name = sets.hard.name();
        let curve = |name: String, width: f32, set: &Obstacle| Series {
            name,
            color: style::target(index),
            width,
            values: risks(scene, set, times),
        };
        if *kept_out_of == sets.hard {
            series.push(curve(name.to_owned(), 2.0, kept_out_of));
        } else {
            series.push(curve(format!("{name}, shaped set"), 2.0, kept_out_of));
            series.push(curve(format!("{name}, hard set"), 1.0, &sets.hard));
        }
    }
    series.push(Series {
        name: "accepted".to_owned(),
        color: style::alarm(),
        width: 1.0,
        values: vec![scene.run.max_risk; times.len()],
    });
    series
}

/// The samples, and the instants of the largest risks, so that the curves reach what is reported.
pub fn risk_times(scene: &Scene) -> Vec<f64> {
    let mut times = scene.samples.clone();
    times.extend(scene.run.risks.iter().map(|peak| peak.time));
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// The risk of a set at own ship's centre at every one of the times until arrival. As in the report, a
/// place that is not deeper than [`tolerance::DEPTH_M`] in the set is at none.
fn risks(scene: &Scene, set: &Obstacle, times: &[f64]) -> Vec<f64> {
    let at = |&time: &f64| {
        let own = scene.motion.pose_at(time).position;
        let clear = set.signed_distance(own, time).distance >= -tolerance::DEPTH_M;
        if clear { 0.0 } else { set.risk(own, time) }
    };
    let times = scene.motion.until_arrival(times);
    times.iter().map(at).collect()
}

fn log_speed(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    let wanted = Motion::Undisturbed(&scene.scenario.desired);
    let mut shown = vec![(wanted, "desired", style::desired(), 1.0)];
    if scene.motion.is_planned() {
        shown.push((scene.motion, "own ship", style::own_ship(), 2.0));
    }
    let times = step_times(scene, shown.iter().map(|(motion, ..)| motion));
    let series = shown
        .into_iter()
        .map(|(motion, name, color, width)| Series {
            name: name.to_owned(),
            color,
            width,
            values: speeds(&motion, &times),
        });
    let series: Vec<Series> = series.collect();
    log_plot(
        rec,
        path(&[SPEED]),
        &times,
        InterpolationMode::StepAfter,
        &series,
    )
}

/// Speeds are steps: a row where one begins, and where one ends for good; seconds.
pub fn step_times<'a>(stage: &Stage, motions: impl Iterator<Item = &'a Motion<'a>>) -> Vec<f64> {
    let mut times: Vec<f64> = motions.flat_map(Motion::steps).collect();
    times.retain(|&t| t <= stage.end);
    times.push(stage.end);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier < tolerance::TIME_S);
    times
}

/// Knots, at every one of the times; 0 where the motion has ended and the pictures show her at rest.
pub fn speeds(motion: &Motion, times: &[f64]) -> Vec<f64> {
    let last = times.last().copied().unwrap_or(0.0);
    let end = motion.end();
    // where the plot ends with the motion, it ends with its speed
    let lasts = end > last - tolerance::TIME_S;
    let at = |&time: &f64| {
        if lasts || time < end - tolerance::TIME_S {
            knots_from_mps(motion.speed_at(time))
        } else {
            0.0
        }
    };
    times.iter().map(at).collect()
}

fn log_course(rec: &mut Recorder, scene: &Scene, own: &[f64]) -> RecordingStreamResult<()> {
    let desired = &scene.scenario.desired;
    let wanted = scene
        .samples
        .iter()
        .map(|&t| heading_of(desired_leg(desired, t).direction));
    let mut series = vec![Series {
        name: "desired".to_owned(),
        color: style::desired(),
        width: 1.0,
        values: continuous_courses(start_course(scene), wanted),
    }];
    if scene.motion.is_planned() {
        series.push(Series {
            name: "own ship".to_owned(),
            color: style::own_ship(),
            width: 2.0,
            values: own.to_vec(),
        });
    }
    log_plot(
        rec,
        path(&[COURSE]),
        &scene.samples,
        InterpolationMode::Linear,
        &series,
    )
}

/// Own ship's course at every sample, degrees, continuous.
fn courses(scene: &Scene) -> Vec<f64> {
    let headings = scene
        .samples
        .iter()
        .map(|&t| scene.motion.pose_at(t).heading);
    continuous_courses(start_course(scene), headings)
}

fn start_course(scene: &Scene) -> f64 {
    course_deg_from_heading(scene.motion.pose_at(0.0).heading)
}

/// Courses in degrees without jumps at north, the first one within half a circle of `near`.
fn continuous_courses(near: f64, headings: impl Iterator<Item = f64>) -> Vec<f64> {
    headings
        .scan(near, |last, heading| {
            let before = crate::frame::heading_from_course_deg(*last);
            *last -= deg_from_radians(wrap(heading - before));
            Some(*last)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::heading_from_course_deg;

    #[test]
    fn a_course_through_north_does_not_jump() {
        let courses = [350.0, 355.0, 0.0, 5.0, 358.0];
        let found = continuous_courses(350.0, courses.map(heading_from_course_deg).into_iter());
        let expected = [350.0, 355.0, 360.0, 365.0, 358.0];
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - expected).abs() < 1e-9, "{found} {expected}");
        }
    }
}
