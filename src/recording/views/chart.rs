//! Static parts of the chart: grid, desired and planned trajectory, time marks, closest points.

use rerun::{AsComponents, Color};

use super::ships::Ships;
use super::{closest, rules};
use crate::frame::Vector;
use crate::geometry::Window;
use crate::obstacle::SpaceTimeObstacle;
use crate::recording::canvas::style::{self, SpeedClass};
use crate::recording::canvas::{
    Canvas, Labels, Lines, ShownMotion, Strip, ViewModel, desired_leg, flat, labelled, lines,
    points, round_down, round_down_time,
};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, MAP, path};
use crate::target::Target;
use crate::text::clock;
use crate::trajectory::{Cubic, Segment, Trajectory};

/// Turn between two drawn points of an arc, radians.
const ARC_STEP: f64 = std::f64::consts::PI / 60.0;

/// A polyline through `(position, time)`.
pub type TimedLine = Vec<(Vector, f64)>;

/// Logs the chart of a run without its ships, and gives the labels back: names keep off them.
/// `broken` are the rules that own ship breaks, if it is judged.
pub fn log_chart(
    rec: &mut Recorder,
    model: &ViewModel,
    ships: &Ships,
    broken: Option<&[&str]>,
) -> Logged<Labels> {
    let mut labels = labels(model);
    ships.keep_off(&mut labels);
    log_waters(rec, model)?;
    log_planned(rec, model)?;
    log_conflict(rec, model, &mut labels)?;
    log_violations(rec, model, &mut labels)?;
    let passages = model.run.evaluation.iter().flat_map(|e| &e.passages);
    let targets = model.scenario.targets.iter().zip(passages);
    let passages = targets.map(|(target, passage)| (&*target.name, passage.tcpa, passage.dcpa));
    let passages: Vec<_> = passages.collect();
    closest::log_closest(rec, model, &mut labels, ships, &passages)?;
    rules::add_broken(&mut labels, broken);
    log_time_marks(rec, model, &mut labels)?;
    labels.log(rec)?;
    Ok(labels)
}

/// No labels yet, which keep off the arrow to the north.
pub fn labels(canvas: &Canvas) -> Labels {
    let mut labels = Labels::new(canvas);
    let arrow = north(canvas);
    let margin = NORTH_MARGIN * (arrow[1] - arrow[0]).norm();
    labels.reserve(Window::new(arrow[0], arrow[1]).grown(margin));
    labels
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
    let [foot, head] = north(canvas);
    let unit = 0.2 * (head - foot).norm();
    let [left, right] = [-1.0, 1.0].map(|side| head + Vector::new(side * unit, -2.0 * unit));
    lines.add([foot, head].map(flat), style::CHART_TEXT, 1.0);
    lines.add([left, head, right].map(flat), style::CHART_TEXT, 1.0);
    let name = flat(head + Vector::new(0.0, 4.0 * unit));
    let name = labelled([name], style::CHART_TEXT, 0.5, ["N"]);
    let lines = lines.archetype();
    let parts: [&dyn AsComponents; 2] = [&lines, &name];
    rec.log_static(path(&[MAP, "grid"]), &parts)
}

/// Foot and head of the arrow to the north, in the north-western corner.
fn north(canvas: &Canvas) -> [Vector; 2] {
    let view = canvas.view();
    let corner = Vector::new(view.low.x, view.high.y);
    let [foot, head] = NORTH.map(|at| corner + Vector::from(at) * canvas.pixel());
    [foot, head]
}

/// Foot and head of the arrow in pixels from the corner.
const NORTH: [[f64; 2]; 2] = [[20.0, -66.0], [20.0, -32.0]];

/// Lengths of the arrow to the north around it that it and its letter need.
const NORTH_MARGIN: f64 = 0.8;

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
fn log_time_marks(rec: &mut Recorder, model: &ViewModel, labels: &mut Labels) -> Logged {
    let times = multiples(0.0, model.end, mark_step(model)).skip(1);
    let times: Vec<f64> = times.collect();
    // a plan has no positions after arrival
    let times = model.motion.until_arrival(&times);
    let marks = times.iter().map(|t| {
        let place = model.motion.pose_at(*t).position;
        (place, clock(*t))
    });
    log_marks(rec, labels, "time_marks", marks, (style::OWN_SHIP, 3.0))
}

/// Logs marks of one colour and radius, each with its label.
fn log_marks(
    rec: &mut Recorder,
    labels: &mut Labels,
    entity: &str,
    marks: impl Iterator<Item = (Vector, String)>,
    (color, radius): (Color, f32),
) -> Logged {
    let mut places = Vec::new();
    for (place, text) in marks {
        labels.add(&text, place, color);
        places.push(flat(place));
    }
    let marks = points(color, radius).with_positions(places);
    rec.log_static(path(&[MAP, entity]), &marks)
}

/// Logs where a target is expected, with the same time marks.
fn log_track(rec: &mut Recorder, canvas: &Canvas, index: usize, target: &Target) -> Logged {
    let color = style::toward_background(canvas.target_color(index), 0.6);
    let joints = canvas.joints(target).into_iter();
    let way: Vec<_> = joints.map(|t| flat(target.position_at(t))).collect();
    let times = multiples(0.0, canvas.end, mark_step(canvas)).skip(1);
    let marks = times.map(|t| flat(target.position_at(t)));
    let line = lines(color, 0.6).with_strips([way]);
    let marks = points(color, 3.0).with_positions(marks);
    let parts = [&line as &dyn AsComponents, &marks];
    rec.log_static(path(&[MAP, "tracks", &target.name]), &parts)
}

/// Logs, without a plan, where own ship on the desired trajectory first enters a set.
fn log_conflict(rec: &mut Recorder, model: &ViewModel, labels: &mut Labels) -> Logged {
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
    match inside {
        Some(mark) => log_marks(
            rec,
            labels,
            "conflict",
            [mark].into_iter(),
            (style::ALARM, 6.0),
        ),
        None => Ok(()),
    }
}

fn log_violations(rec: &mut Recorder, model: &ViewModel, labels: &mut Labels) -> Logged {
    let violations = match &model.run.evaluation {
        Some(evaluation) if !evaluation.violations.is_empty() => &evaluation.violations,
        _ => return Ok(()),
    };
    let marks = violations.iter().map(|violation| {
        let place = model.motion.pose_at(violation.time).position;
        (place, violation.what.clone())
    });
    log_marks(rec, labels, "violations", marks, (style::ALARM, 7.0))
}
