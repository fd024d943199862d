//! Static parts of the chart: grid, desired and planned trajectory, time marks, closest points.

use rerun::{AsComponents, LineStrips2D, Points2D};

use crate::frame::Vector;
use crate::geometry::Window;
use crate::obstacle::SpaceTimeObstacle;
use crate::recording::canvas::style::{self, SpeedClass};
use crate::recording::canvas::{
    Canvas, Lines, ShownMotion, ViewModel, clock, desired_leg, flat, labelled, round_down,
    round_down_time,
};
use crate::recording::write::Recorder;
use crate::recording::{Logged, MAP, path};
use crate::target::Target;
use crate::trajectory::{Cubic, Segment, Trajectory};

/// Turn between two drawn points of an arc, radians.
const ARC_STEP: f64 = std::f64::consts::PI / 60.0;

pub type Strip = Vec<[f32; 2]>;

/// A polyline through `(position, time)`.
pub type TimedLine = Vec<(Vector, f64)>;

pub fn log_chart(rec: &mut Recorder, model: &ViewModel) -> Logged {
    log_waters(rec, model)?;
    log_planned(rec, model)?;
    log_time_marks(rec, model)?;
    log_closest_points(rec, model)?;
    log_conflict(rec, model)?;
    log_violations(rec, model)
}

pub fn log_sea(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    // views of Rerun are y-down: this turns north up for everything below
    rec.log_static(MAP, &rerun::Transform3D::from_scale([1.0, -1.0, 1.0]))?;
    log_grid(rec, canvas)?;
    log_desired(rec, canvas)
}

/// Logs what does not depend on own ship: the grid, the desired trajectory, the targets' tracks.
pub fn log_waters(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    log_sea(rec, canvas)?;
    for (index, target) in canvas.scenario.targets.iter().enumerate() {
        log_track(rec, canvas, index, target)?;
    }
    Ok(())
}

/// Logs lines every round number of metres, and the north arrow.
fn log_grid(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    let window = shown_window(canvas);
    let mut lines = Lines::default();
    for ends in grid_lines(canvas, &window) {
        lines.add(ends.map(flat), style::GRID, 0.5);
    }
    let unit = canvas.bounds.size().max() / 100.0;
    let corner = Vector::new(canvas.bounds.low.x, canvas.bounds.high.y);
    let foot = corner + Vector::new(2.5, -9.0) * unit;
    let head = foot + Vector::new(0.0, 5.0 * unit);
    let [left, right] = [-1.0, 1.0].map(|side| head + Vector::new(side * unit, -2.0 * unit));
    lines.add([foot, head].map(flat), style::CHART_TEXT, 1.0);
    lines.add([left, head, right].map(flat), style::CHART_TEXT, 1.0);
    let name = flat(head + Vector::new(0.0, 4.0 * unit));
    let name = labelled([name], style::CHART_TEXT, 0.5, ["N"]);
    let lines = lines.archetype();
    let parts: [&dyn AsComponents; 2] = [&lines, &name];
    rec.log_static(path(&[MAP, "grid"]), &parts)
}

/// The part of the sea that the chart shows when it is opened, in a view of any usual shape.
pub fn shown_window(canvas: &Canvas) -> Window {
    canvas.bounds.grown(canvas.bounds.size().max())
}

/// Metres between two lines of the grid.
pub fn grid_spacing(canvas: &Canvas) -> f64 {
    round_down(canvas.bounds.size().max() / 4.0)
}

/// The ends of the lines of the grid within a window, those to the north first.
pub fn grid_lines(canvas: &Canvas, window: &Window) -> Vec<[Vector; 2]> {
    let Window { low, high } = window;
    let spacing = grid_spacing(canvas);
    let northward = multiples(low.x, high.x, spacing)
        .map(|east| [low.y, high.y].map(|north| Vector::new(east, north)));
    let eastward = multiples(low.y, high.y, spacing)
        .map(|north| [low.x, high.x].map(|east| Vector::new(east, north)));
    northward.chain(eastward).collect()
}

pub fn multiples(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(move |i| step * i as f64)
}

fn log_desired(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    let dash = canvas.bounds.size().max() / 120.0;
    let mut lines = Lines::default();
    for leg in canvas.scenario.desired.legs() {
        let mut along = 0.0;
        while along < leg.length {
            let ends = [along, (along + dash).min(leg.length)];
            let ends = ends.map(|s| flat(leg.start + leg.direction * s));
            lines.add(ends, style::DESIRED, 0.8);
            along += 2.0 * dash;
        }
    }
    rec.log_static(path(&[MAP, "desired"]), &lines.archetype())
}

/// Logs the plan, one line per segment, styled by its speed.
fn log_planned(rec: &mut Recorder, model: &ViewModel) -> Logged {
    if !model.motion.is_planned() {
        return Ok(());
    }
    let mut lines = Lines::default();
    for (pace, points) in planned_strips(model) {
        let strip: Strip = points.into_iter().map(|(p, _)| flat(p)).collect();
        lines.add(strip, pace.color(), pace.radius());
    }
    rec.log_static(path(&[MAP, "planned"]), &lines.archetype())
}

/// Lines that a piece of a motion under forces is drawn with.
const PIECE_POINTS: usize = 4;

/// The plan's segments, or pieces, as polylines through `(position, time)`. Empty without a plan.
pub fn planned_strips(model: &ViewModel) -> Vec<(SpeedClass, TimedLine)> {
    match model.motion {
        ShownMotion::Planned(trajectory) => strips(model, trajectory),
        ShownMotion::Nominal(_) => Vec::new(),
    }
}

/// The segments, or pieces, of a motion as polylines through `(position, time)`.
pub fn strips(canvas: &Canvas, trajectory: &Trajectory) -> Vec<(SpeedClass, TimedLine)> {
    let desired = &canvas.scenario.desired;
    if let Some(motion) = trajectory.steered() {
        let strip = |piece: Cubic| {
            let points = (0..=PIECE_POINTS).map(|k| {
                let part = k as f64 / PIECE_POINTS as f64;
                let time = piece.start_time + part * piece.duration;
                (piece.position(part), time)
            });
            let speed = piece.velocity(0.5).norm();
            let wanted = desired_leg(desired, piece.start_time).speed;
            (SpeedClass::of(speed, wanted), points.collect())
        };
        return joined(motion.pieces().map(strip));
    }
    segment_strips(canvas, trajectory.segments()).collect()
}

/// A polyline through `(position, time)` for each segment. Times count from the scenario's present.
pub fn segment_strips(
    canvas: &Canvas,
    segments: &[Segment],
) -> impl Iterator<Item = (SpeedClass, TimedLine)> {
    let moving = segments.iter().filter(|segment| segment.duration > 0.0);
    moving.map(|segment| {
        let desired = desired_leg(&canvas.scenario.desired, segment.start_time).speed;
        (SpeedClass::of(segment.speed, desired), polyline(segment))
    })
}

/// Joins strips of one speed class that follow one another: a strip costs more than a point.
pub fn joined(
    strips: impl Iterator<Item = (SpeedClass, TimedLine)>,
) -> Vec<(SpeedClass, TimedLine)> {
    let mut all: Vec<(SpeedClass, TimedLine)> = Vec::new();
    for (pace, points) in strips {
        match all.last_mut() {
            Some((before, line)) if *before == pace => line.extend(points.into_iter().skip(1)),
            _ => all.push((pace, points)),
        }
    }
    all
}

/// Joins lines, each of which begins where the one before ends.
pub fn one_line(lines: impl Iterator<Item = TimedLine>) -> TimedLine {
    let mut all = TimedLine::new();
    for line in lines {
        let joint = usize::from(!all.is_empty());
        all.extend(line.into_iter().skip(joint));
    }
    all
}

/// Points of a segment with their times: an arc every 3° at most.
pub fn polyline(segment: &Segment) -> TimedLine {
    let turn = (segment.turn_rate * segment.duration).abs();
    let pieces = (turn / ARC_STEP).ceil().clamp(1.0, 1e3) as usize;
    (0..=pieces)
        .map(|i| {
            let time = segment.start_time + segment.duration * i as f64 / pieces as f64;
            (segment.pose_at(time).position, time)
        })
        .collect()
}

/// Time between two time marks on the tracks, seconds.
pub fn mark_step(canvas: &Canvas) -> f64 {
    round_down_time(canvas.end / 4.0)
}

/// Logs own ship's position every round number of seconds, with the time.
fn log_time_marks(rec: &mut Recorder, model: &ViewModel) -> Logged {
    let times = multiples(0.0, model.end, mark_step(model)).skip(1);
    let times: Vec<f64> = times.collect();
    // a plan has no positions after arrival
    let times = model.motion.until_arrival(&times);
    let points = times.iter().map(|&t| model.motion.pose_at(t).position);
    let labels = times.iter().map(|t| clock(*t));
    let marks = labelled(points.map(flat), style::OWN_SHIP, 3.0, labels);
    rec.log_static(path(&[MAP, "time_marks"]), &marks)
}

/// Logs where a target is expected, with the same time marks.
fn log_track(rec: &mut Recorder, canvas: &Canvas, index: usize, target: &Target) -> Logged {
    let color = style::toward_background(canvas.target_color(index), 0.6);
    let joints = canvas.joints(target).into_iter();
    let way: Vec<_> = joints.map(|t| flat(target.position_at(t))).collect();
    let times = multiples(0.0, canvas.end, mark_step(canvas)).skip(1);
    let marks = times.map(|t| flat(target.position_at(t)));
    let line = LineStrips2D::new([way])
        .with_colors([color])
        .with_radii([style::points(0.6)]);
    let marks = Points2D::new(marks)
        .with_colors([color])
        .with_radii([style::points(3.0)]);
    let parts = [&line as &dyn AsComponents, &marks];
    rec.log_static(path(&[MAP, "tracks", &target.name]), &parts)
}

/// Logs a line between own ship and each target at their closest approach. Distance and time are
/// shown where a line is pointed at, those of the nearest target in a corner of the chart: near
/// the ships they would lie on other names.
fn log_closest_points(rec: &mut Recorder, model: &ViewModel) -> Logged {
    let Some(evaluation) = &model.run.evaluation else {
        return Ok(());
    };
    let mut lines = Lines::default();
    let mut labels = Vec::new();
    let mut nearest: Option<(f64, String)> = None;
    for (target, passage) in model.scenario.targets.iter().zip(&evaluation.passages) {
        let own = model.motion.pose_at(passage.tcpa).position;
        let other = target.position_at(passage.tcpa);
        lines.add([own, other].map(flat), style::CHART_TEXT, 0.8);
        // adding +0.0 converts a negative zero to zero
        let distance = (passage.dcpa * 10.0).round() / 10.0 + 0.0;
        let label = format!("CPA {distance} m at {}", clock(passage.tcpa));
        if nearest
            .as_ref()
            .is_none_or(|(least, _)| passage.dcpa < *least)
        {
            nearest = Some((passage.dcpa, format!("{label} to {}", target.name)));
        }
        labels.push(label);
    }
    let lines = lines.archetype().with_labels(labels);
    let lines = lines.with_show_labels(false);
    rec.log_static(path(&[MAP, "closest_points"]), &lines)?;
    let Some((_, label)) = nearest else {
        return Ok(());
    };
    let Window { low, high } = model.bounds;
    // the label is below its point
    let north = low.y + (high - low).max() / 11.0;
    let place = Vector::new(0.25 * low.x + 0.75 * high.x, north);
    let name = labelled([flat(place)], style::CHART_TEXT, 0.0, [label]);
    rec.log_static(path(&[MAP, "closest_points", "nearest"]), &name)
}

/// Logs, without a plan, where own ship on the desired trajectory first enters a set.
fn log_conflict(rec: &mut Recorder, model: &ViewModel) -> Logged {
    if model.motion.is_planned() {
        return Ok(());
    }
    let inside = model.samples.iter().find_map(|&time| {
        let own = model.motion.pose_at(time).position;
        let mut sets = model.run.obstacles();
        let set = sets.find(|set| set.contains(own, time))?;
        let name = set.name();
        Some((own, format!("in the set of {name} from {}", clock(time))))
    });
    let Some((place, label)) = inside else {
        return Ok(());
    };
    let mark = labelled([flat(place)], style::ALARM, 6.0, [label]);
    rec.log_static(path(&[MAP, "conflict"]), &mark)
}

fn log_violations(rec: &mut Recorder, model: &ViewModel) -> Logged {
    let violations = match &model.run.evaluation {
        Some(evaluation) if !evaluation.violations.is_empty() => &evaluation.violations,
        _ => return Ok(()),
    };
    let places = violations.iter().map(|v| model.motion.pose_at(v.time));
    let places = places.map(|pose| flat(pose.position));
    let labels = violations.iter().map(|v| v.what.as_str());
    let marks = labelled(places, style::ALARM, 7.0, labels);
    rec.log_static(path(&[MAP, "violations"]), &marks)
}
