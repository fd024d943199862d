//! Curves over time: clearance, margin, speed, course.

use rerun::components::{AggregationPolicy, InterpolationMode};
use rerun::{RecordingStream, RecordingStreamResult, Scalars, SeriesLines, TimeColumn};

use super::scene::{Motion, Scene};
use super::{TIMELINE, path, style};
use crate::frame::{course_deg_from_heading, deg_from_radians, heading_of, knots_from_mps, wrap};
use crate::obstacle::PolytopeObstacle;
use crate::target::Target;
use crate::trajectory::DesiredLeg;

/// Distances between hulls, per target.
pub const CLEARANCE: &str = "curves/clearance_m";
/// Distances of own ship's centre to the nearest set.
pub const MARGIN: &str = "curves/margin_m";
/// Speed through the water.
pub const SPEED: &str = "curves/speed_kn";
/// Course, continuous: it may leave 0..360 rather than jump.
pub const COURSE: &str = "curves/course_deg";

/// All curves, at most some hundred samples each.
pub fn log_curves(rec: &RecordingStream, scene: &Scene) -> RecordingStreamResult<()> {
    log_clearances(rec, scene)?;
    log_margins(rec, scene)?;
    log_speed(rec, scene)?;
    log_course(rec, scene)
}

/// Name, colour and width of a curve.
type Look<'a> = (&'a str, rerun::Color, f32);

fn log_curve(
    rec: &RecordingStream,
    entity: rerun::EntityPath,
    (name, color, width): Look,
    times: &[f64],
    values: Vec<f64>,
) -> RecordingStreamResult<()> {
    let look = SeriesLines::new()
        .with_names([name])
        .with_colors([color])
        .with_widths([width])
        // averaging neighbours would show speeds and depths that are not there
        .with_aggregation_policy(AggregationPolicy::Off);
    rec.log_static(entity.clone(), &look)?;
    rec.send_columns(
        entity,
        [TimeColumn::new_duration_secs(
            TIMELINE,
            times.iter().copied(),
        )],
        Scalars::update_fields()
            .with_scalars(values)
            .columns_of_unit_batches()?,
    )
}

fn log_clearances(rec: &RecordingStream, scene: &Scene) -> RecordingStreamResult<()> {
    for (index, target) in scene.run.scenario.targets.iter().enumerate() {
        let values = clearances(scene, target);
        let look = (target.name.as_str(), style::target(index), 2.0);
        let entity = path(&[CLEARANCE, &target.name]);
        log_curve(rec, entity, look, &scene.samples, values)?;
    }
    let margin = scene.run.scenario.own_ship.safety_margin;
    let look = ("safety margin", style::alarm(), 1.0);
    let entity = path(&[CLEARANCE, "safety margin"]);
    log_curve(rec, entity, look, &[0.0, scene.end], vec![margin; 2])
}

/// Metres between own hull and the target's expected hull (or its set, where that is given) at every
/// sample; negative in overlap.
pub fn clearances(scene: &Scene, target: &Target) -> Vec<f64> {
    let own = &scene.run.scenario.own_ship.hull;
    let sets = target_set(target);
    let at = |&time: &f64| {
        let own = own.polygon(&scene.motion.pose_at(time));
        match (target.ship(), &sets) {
            (Some(ship), _) => own.separation(&ship.hull.polygon(&ship.pose_at(time))),
            (None, Some(set)) => own.separation(&set.section(time)),
            (None, None) => f64::NAN,
        }
    };
    scene.samples.iter().map(at).collect()
}

fn target_set(target: &Target) -> Option<PolytopeObstacle> {
    match &target.motion {
        crate::target::Motion::Sets { initial, velocity } => Some(PolytopeObstacle::new(
            target.name.clone(),
            initial.clone(),
            velocity.clone(),
        )),
        crate::target::Motion::Ship(_) => None,
    }
}

fn log_margins(rec: &RecordingStream, scene: &Scene) -> RecordingStreamResult<()> {
    let sets = &scene.run.sets;
    if sets.is_empty() {
        return Ok(());
    }
    let hard: Vec<&PolytopeObstacle> = sets.iter().map(|s| &s.hard).collect();
    let shaped: Vec<&PolytopeObstacle> = sets.iter().map(|s| &s.shaped).collect();
    let look = ("hard sets", style::own_ship(), 2.0);
    let values = margins(scene, &hard);
    log_curve(rec, path(&[MARGIN, "hard"]), look, &scene.samples, values)?;
    if hard != shaped {
        let look = ("shaped sets", style::Pace::Slow.color(), 2.0);
        let values = margins(scene, &shaped);
        log_curve(rec, path(&[MARGIN, "shaped"]), look, &scene.samples, values)?;
    }
    let look = ("contact", style::alarm(), 1.0);
    log_curve(
        rec,
        path(&[MARGIN, "contact"]),
        look,
        &[0.0, scene.end],
        vec![0.0; 2],
    )
}

/// Metres from own ship's centre to the nearest of the sets at every sample; negative inside.
pub fn margins(scene: &Scene, sets: &[&PolytopeObstacle]) -> Vec<f64> {
    let at = |&time: &f64| {
        let own = scene.motion.pose_at(time).position;
        sets.iter()
            .map(|set| set.section(time).signed_distance(own))
            .fold(f64::INFINITY, f64::min)
    };
    scene.samples.iter().map(at).collect()
}

fn log_speed(rec: &RecordingStream, scene: &Scene) -> RecordingStreamResult<()> {
    let steps = leg_steps(scene, |leg| knots_from_mps(leg.speed));
    let (times, values): (Vec<f64>, _) = steps.into_iter().unzip();
    let look = ("desired", style::desired(), 1.0);
    log_steps(rec, path(&[SPEED, "desired"]), look, &times, values)?;
    let Motion::Planned(trajectory) = scene.motion else {
        return Ok(());
    };
    let moving = trajectory.segments().iter().filter(|s| s.duration > 0.0);
    let steps = moving.map(|s| (s.start_time, knots_from_mps(s.speed)));
    let (times, values): (Vec<f64>, _) = held_until(trajectory.end_time(), steps.collect())
        .into_iter()
        .unzip();
    let look = ("own ship", style::own_ship(), 2.0);
    log_steps(rec, path(&[SPEED, "own_ship"]), look, &times, values)
}

/// A value of every leg of the desired trajectory at its start, and the last one at the end.
fn leg_steps(scene: &Scene, value: impl Fn(&DesiredLeg) -> f64) -> Vec<(f64, f64)> {
    let desired = &scene.run.scenario.desired;
    let steps = desired.legs().iter().map(|l| (l.start_time, value(l)));
    held_until(desired.duration(), steps.collect())
}

/// With the last value once more at `end`.
fn held_until(end: f64, mut steps: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let last = steps.last().copied();
    steps.extend(last.map(|(_, value)| (end, value)));
    steps
}

/// A curve that holds every value until the next.
fn log_steps(
    rec: &RecordingStream,
    entity: rerun::EntityPath,
    look: Look,
    times: &[f64],
    values: Vec<f64>,
) -> RecordingStreamResult<()> {
    let held = SeriesLines::update_fields().with_interpolation_mode(InterpolationMode::StepAfter);
    rec.log_static(entity.clone(), &held)?;
    log_curve(rec, entity, look, times, values)
}

fn log_course(rec: &RecordingStream, scene: &Scene) -> RecordingStreamResult<()> {
    let steps = leg_steps(scene, |leg| heading_of(leg.direction));
    let times: Vec<f64> = steps.iter().map(|s| s.0).collect();
    let values = continuous_courses(start_course(scene), steps.iter().map(|s| s.1));
    let look = ("desired", style::desired(), 1.0);
    log_steps(rec, path(&[COURSE, "desired"]), look, &times, values)?;
    if !scene.motion.is_planned() {
        return Ok(());
    }
    let look = ("own ship", style::own_ship(), 2.0);
    log_curve(
        rec,
        path(&[COURSE, "own_ship"]),
        look,
        &scene.samples,
        courses(scene),
    )
}

/// Own ship's course at every sample, degrees, continuous.
pub fn courses(scene: &Scene) -> Vec<f64> {
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
