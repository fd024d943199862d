//! Curves over time: clearance, margin, risk, speed, course.

use rerun::components::{AggregationPolicy, InterpolationMode};
use rerun::{EntityPath, RecordingStreamResult, Scalars, SeriesLines, TimeColumn};

use crate::frame::{course_deg_from_heading, deg_from_radians, heading_of, knots_from_mps, wrap};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::recording::canvas::{Canvas, ShownMotion, ViewModel, desired_leg, style};
use crate::recording::write::Recorder;
use crate::recording::{TIMELINE, path};
use crate::target::Target;
use crate::tolerance;

/// Distance between the hulls, for each target.
pub const CLEARANCE: &str = "curves/clearance_m";
/// Distance of own ship's centre from the nearest set.
pub const MARGIN: &str = "curves/margin_m";
/// Risk, for each target.
pub const RISK: &str = "curves/risk";
/// Speed through the water.
pub const SPEED: &str = "curves/speed_kn";
/// Course, continuous: it may leave 0..360 rather than jump.
pub const COURSE: &str = "curves/course_deg";

/// The curves that the layout needs, too, at every sample.
pub struct Curves {
    /// One per target, and the safety margin last.
    clearances: Vec<Series>,
    /// The first is that of the hard sets; empty without sets.
    margins: Vec<Series>,
    /// Own ship's course, degrees, continuous.
    courses: Vec<f64>,
}

impl Curves {
    pub fn of(model: &ViewModel) -> Self {
        let is_met = !model.sets.is_empty();
        Self {
            clearances: clearance_curves(model),
            margins: if is_met {
                margin_curves(model)
            } else {
                Vec::new()
            },
            courses: courses(model),
        }
    }

    /// The greatest of the targets' least clearances, metres; 0 without targets.
    pub fn farthest_passage(&self) -> f64 {
        let targets = self.clearances.split_last().map_or(&[][..], |(_, of)| of);
        targets.iter().map(Series::least).fold(0.0, f64::max)
    }

    /// Least distance from the hard sets, metres; infinite without sets.
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

/// Logs all curves.
pub fn log_curves(
    rec: &mut Recorder,
    model: &ViewModel,
    curves: &Curves,
) -> RecordingStreamResult<()> {
    let (samples, between) = (&model.samples, InterpolationMode::Linear);
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
    log_risks(rec, model)?;
    log_speed(rec, model)?;
    log_course(rec, model, &curves.courses)
}

/// One curve of a plot.
pub struct Series {
    /// The name in the legend.
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

/// Logs all curves of a plot as one entity. Every row has a number for each of them, so the plot
/// ends with the shortest.
pub fn log_plot(
    rec: &mut Recorder,
    entity: EntityPath,
    times: &[f64],
    between: InterpolationMode,
    series: &[Series],
) -> RecordingStreamResult<()> {
    let rows = series.iter().map(|s| s.values.len()).min().unwrap_or(0);
    let times = &times[..rows.min(times.len())];
    let style = SeriesLines::new()
        .with_names(series.iter().map(|s| s.name.as_str()))
        .with_colors(series.iter().map(|s| s.color))
        .with_widths(series.iter().map(|s| s.width))
        .with_interpolation_mode(between)
        // averaging neighbours would show speeds and depths that are not there
        .with_aggregation_policy(AggregationPolicy::Off);
    let values = (0..times.len()).flat_map(|row| series.iter().map(move |s| s.values[row]));
    let columns = Scalars::update_fields()
        .with_scalars(values)
        .columns(vec![series.len(); times.len()])?;
    let times = TimeColumn::new_duration_secs(TIMELINE, times.iter().copied());
    rec.log_moving(entity, times, &style, columns)
}

fn clearance_curves(model: &ViewModel) -> Vec<Series> {
    let targets = model.scenario.targets.iter().enumerate();
    let mut series: Vec<Series> = targets
        .map(|(index, target)| Series {
            name: target.name.clone(),
            color: style::target(index),
            width: 2.0,
            values: clearances(model, &model.motion, target),
        })
        .collect();
    series.push(safety_margin(model));
    series
}

/// The required distance between the hulls, at every sample.
pub fn safety_margin(canvas: &Canvas) -> Series {
    Series {
        name: "safety margin".to_owned(),
        color: style::alarm(),
        width: 1.0,
        values: vec![canvas.scenario.own_ship.safety_margin; canvas.samples.len()],
    }
}

/// Metres between own hull and the target's expected hull, at every sample until arrival; negative
/// in overlap. For a target that is a set: from own ship's centre, as the set includes its hull.
pub fn clearances(canvas: &Canvas, motion: &ShownMotion, target: &Target) -> Vec<f64> {
    let own = &canvas.scenario.own_ship.hull;
    let at = |&time: &f64| {
        let pose = motion.pose_at(time);
        match (target.ship(), target.outer_set_at(time)) {
            (Some(ship), _) => {
                let hull = ship.hull.polygon(&ship.pose_at(time));
                own.polygon(&pose).separation(&hull)
            }
            (None, Some(set)) => set.signed_distance(pose.position),
            // a target is a ship or a set
            (None, None) => f64::NAN,
        }
    };
    motion
        .until_arrival(&canvas.samples)
        .iter()
        .map(at)
        .collect()
}

/// Margins to the hard sets, to those with ship domains, and to those that were planned against
/// where they are neither.
pub fn margin_curves(model: &ViewModel) -> Vec<Series> {
    let sets = &model.sets;
    let hard: Vec<&Obstacle> = sets.iter().map(|s| &s.hard).collect();
    let with_domain: Vec<&Obstacle> = (sets.iter())
        .map(|s| model.with_domain(s).unwrap_or(&s.hard))
        .collect();
    let mut series = vec![Series {
        name: "hard sets".to_owned(),
        color: style::own_ship(),
        width: 2.0,
        values: margins(model, &hard),
    }];
    if hard != with_domain {
        series.push(Series {
            name: "sets with domains".to_owned(),
            color: style::SpeedClass::Slow.color(),
            width: 2.0,
            values: margins(model, &with_domain),
        });
    }
    // level sets of an accepted risk, or ellipsoids around the others
    let avoided: Vec<&Obstacle> = model.run.obstacles().collect();
    if avoided != hard && avoided != with_domain {
        series.push(Series {
            name: "sets kept out of".to_owned(),
            color: style::SpeedClass::Fast.color(),
            width: 2.0,
            values: margins(model, &avoided),
        });
    }
    series.push(Series {
        name: "contact".to_owned(),
        color: style::alarm(),
        width: 1.0,
        values: vec![0.0; model.samples.len()],
    });
    series
}

/// Metres from own ship's centre to the nearest of the sets, at every sample until arrival;
/// negative inside.
pub fn margins(model: &ViewModel, sets: &[&Obstacle]) -> Vec<f64> {
    let at = |&time: &f64| {
        let own = model.motion.pose_at(time).position;
        let margins = sets.iter().map(|s| s.signed_distance(own, time).distance);
        margins.fold(f64::INFINITY, f64::min)
    };
    let times = model.motion.until_arrival(&model.samples);
    times.iter().map(at).collect()
}

fn log_risks(rec: &mut Recorder, model: &ViewModel) -> RecordingStreamResult<()> {
    let times = risk_times(model);
    let series = risk_curves(model, &times);
    log_plot(
        rec,
        path(&[RISK]),
        &times,
        InterpolationMode::Linear,
        &series,
    )
}

/// The risks against the sets that were planned against, as the plan document reports them, and
/// those against the hard sets where these differ.
pub fn risk_curves(model: &ViewModel, times: &[f64]) -> Vec<Series> {
    let mut series = Vec::new();
    for (index, target) in model.run.targets.iter().enumerate() {
        let (avoided, sets) = (&target.whole, &target.sets);
        let name = sets.hard.name();
        let curve = |name: String, width: f32, set: &Obstacle| Series {
            name,
            color: style::target(index),
            width,
            values: risks(model, set, times),
        };
        if *avoided == sets.hard {
            series.push(curve(name.to_owned(), 2.0, avoided));
        } else {
            series.push(curve(format!("{name}, with domain"), 2.0, avoided));
            series.push(curve(format!("{name}, hard set"), 1.0, &sets.hard));
        }
    }
    series.push(Series {
        name: "accepted".to_owned(),
        color: style::alarm(),
        width: 1.0,
        values: vec![model.run.max_risk; times.len()],
    });
    series
}

/// The samples and the times of the largest risks, so that the curves reach the reported values.
pub fn risk_times(model: &ViewModel) -> Vec<f64> {
    let mut times = model.samples.clone();
    times.extend(model.run.risks().into_iter().map(|peak| peak.time));
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// The risk of a set at own ship's centre, at every one of the times until arrival. As in the
/// document, it is 0 where own ship is not deeper in the set than [`tolerance::DEPTH_M`].
fn risks(model: &ViewModel, set: &Obstacle, times: &[f64]) -> Vec<f64> {
    let at = |&time: &f64| {
        let own = model.motion.pose_at(time).position;
        let clear = set.signed_distance(own, time).distance >= -tolerance::DEPTH_M;
        if clear { 0.0 } else { set.risk(own, time) }
    };
    let times = model.motion.until_arrival(times);
    times.iter().map(at).collect()
}

fn log_speed(rec: &mut Recorder, model: &ViewModel) -> RecordingStreamResult<()> {
    let wanted = ShownMotion::Nominal(&model.scenario.desired);
    let mut shown = vec![(wanted, "desired", style::desired(), 1.0)];
    if model.motion.is_planned() {
        shown.push((model.motion, "own ship", style::own_ship(), 2.0));
    }
    let times = step_times(model, shown.iter().map(|(motion, ..)| motion));
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

/// Times at which one of the speeds changes or ends, seconds.
pub fn step_times<'a>(
    canvas: &Canvas,
    motions: impl Iterator<Item = &'a ShownMotion<'a>>,
) -> Vec<f64> {
    let mut times: Vec<f64> = motions
        .flat_map(|motion| [motion.speed_changes(), vec![motion.end()]].concat())
        .collect();
    times.retain(|&t| t <= canvas.end);
    times.push(canvas.end);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier < tolerance::TIME_S);
    times
}

/// Speeds at every one of the times, knots; 0 where the motion has ended and own ship is at rest.
pub fn speeds(motion: &ShownMotion, times: &[f64]) -> Vec<f64> {
    let last = times.last().copied().unwrap_or(0.0);
    let end = motion.end();
    // a motion that lasts as long as the plot keeps its speed
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

fn log_course(rec: &mut Recorder, model: &ViewModel, own: &[f64]) -> RecordingStreamResult<()> {
    let desired = &model.scenario.desired;
    let wanted = model
        .samples
        .iter()
        .map(|&t| heading_of(desired_leg(desired, t).direction));
    let mut series = vec![Series {
        name: "desired".to_owned(),
        color: style::desired(),
        width: 1.0,
        values: continuous_courses(start_course(model), wanted),
    }];
    if model.motion.is_planned() {
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
        &model.samples,
        InterpolationMode::Linear,
        &series,
    )
}

/// Own ship's course at every sample, degrees, continuous.
fn courses(model: &ViewModel) -> Vec<f64> {
    let headings = model
        .samples
        .iter()
        .map(|&t| model.motion.pose_at(t).heading);
    continuous_courses(start_course(model), headings)
}

fn start_course(model: &ViewModel) -> f64 {
    course_deg_from_heading(model.motion.pose_at(0.0).heading)
}

/// Courses in degrees without jumps at north, the first within half a circle of `near`.
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
