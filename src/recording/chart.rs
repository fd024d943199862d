//! The chart that stands still: grid, legend, desired and planned trajectory, closest points.

use rerun::{AsComponents, Color, LineStrips2D, Points2D, Radius, RecordingStreamResult};

use super::recorder::Recorder;
use super::scene::{Bounds, Hues, Motion, Scene, Stage, desired_leg, flat, round_down};
use super::style::{self, Pace};
use super::summary::approach;
use super::{MAP, path};
use crate::frame::Vector;
use crate::obstacle::SpaceTimeObstacle;
use crate::target::Target;
use crate::trajectory::Trajectory;

/// Degrees of turn between two drawn points of an arc, radians.
const ARC_STEP: f64 = std::f64::consts::PI / 60.0;

/// A line of the chart.
pub type Strip = Vec<[f32; 2]>;

/// Lines, each with its look.
#[derive(Debug, Default)]
pub struct Lines {
    strips: Vec<Strip>,
    colors: Vec<Color>,
    radii: Vec<Radius>,
}

impl Lines {
    pub fn add(&mut self, strip: Strip, color: Color, radius: Radius) {
        self.strips.push(strip);
        self.colors.push(color);
        self.radii.push(radius);
    }

    pub fn archetype(self) -> LineStrips2D {
        LineStrips2D::new(self.strips)
            .with_colors(self.colors)
            .with_radii(self.radii)
    }
}

/// Everything of the chart that does not move.
pub fn log_chart(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    log_waters(rec, scene)?;
    log_legend(rec, scene, plan_legend(scene), 1)?;
    log_planned(rec, scene)?;
    log_time_marks(rec, scene)?;
    log_closest_points(rec, scene)?;
    log_conflict(rec, scene)?;
    log_violations(rec, scene)
}

/// What is there whoever sails: the grid, the desired trajectory, the targets' tracks.
pub fn log_waters(rec: &mut Recorder, stage: &Stage) -> RecordingStreamResult<()> {
    // views of Rerun are y-down: this turns north up for everything below
    rec.log_static(MAP, &rerun::Transform3D::from_scale([1.0, -1.0, 1.0]))?;
    log_grid(rec, stage)?;
    log_desired(rec, stage)?;
    for (index, target) in stage.scenario.targets.iter().enumerate() {
        log_track(rec, stage, index, target)?;
    }
    Ok(())
}

/// Lines every round number of metres, the scale named at one of them, and north.
fn log_grid(rec: &mut Recorder, stage: &Stage) -> RecordingStreamResult<()> {
    let Bounds { low, high } = stage.bounds.grown(0.6 * stage.bounds.extent());
    let spacing = grid_spacing(stage);
    let mut lines = Lines::default();
    for east in multiples(low.x, high.x, spacing) {
        let ends = [Vector::new(east, low.y), Vector::new(east, high.y)];
        lines.add(ends.map(flat).to_vec(), style::grid(), style::points(0.5));
    }
    for north in multiples(low.y, high.y, spacing) {
        let ends = [Vector::new(low.x, north), Vector::new(high.x, north)];
        lines.add(ends.map(flat).to_vec(), style::grid(), style::points(0.5));
    }

    let unit = stage.bounds.extent() / 100.0;
    let corner = Vector::new(stage.bounds.low.x, stage.bounds.high.y);
    let foot = corner + Vector::new(2.5, -9.0) * unit;
    let head = foot + Vector::new(0.0, 5.0 * unit);
    let barbs = [-1.0, 1.0].map(|side| head + Vector::new(side * unit, -2.0 * unit));
    for strip in [vec![foot, head], vec![barbs[0], head, barbs[1]]] {
        lines.add(
            strip.into_iter().map(flat).collect(),
            style::chart_text(),
            style::points(1.0),
        );
    }
    let name = Points2D::new([flat(head + Vector::new(0.0, 4.0 * unit))])
        .with_colors([style::chart_text()])
        .with_radii([style::points(0.5)])
        .with_labels(["N"])
        .with_show_labels(true);
    rec.log_static(
        path(&[MAP, "grid"]),
        &[&lines.archetype() as &dyn AsComponents, &name],
    )
}

/// Metres between two lines of the grid.
pub fn grid_spacing(stage: &Stage) -> f64 {
    round_down(stage.bounds.extent() / 4.0)
}

/// Multiples of `step` within the interval.
pub fn multiples(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(move |i| step * i as f64)
}

/// A line of the chart and what it means.
pub type Key = (String, Color, Radius);

fn plan_legend(scene: &Scene) -> Vec<Key> {
    let mut entries = vec![("desired".into(), style::desired(), style::points(0.8))];
    for pace in shown_paces(scene) {
        entries.push((pace.name().into(), pace.color(), pace.radius()));
    }
    entries.extend(waters_legend(scene));
    entries
}

/// The sets, the land and the grid.
pub fn waters_legend(stage: &Stage) -> Vec<Key> {
    let mut entries: Vec<Key> = Vec::new();
    // those who sail may each keep out of sets of their own
    let whose = match stage.hues {
        Hues::Targets => "",
        Hues::OwnShips => " of the scenario",
    };
    if !stage.sets.is_empty() {
        entries.push((
            format!("hard set{whose}"),
            stage.target_color(0),
            super::movers::HARD_RADIUS,
        ));
        if stage.sets.iter().any(|s| stage.shaped(s).is_some()) {
            entries.push((
                format!("shaped set{whose}"),
                super::movers::shaped_color(stage, 0),
                super::movers::SHAPED_RADIUS,
            ));
        }
    }
    if stage.scenario.land.is_some() {
        entries.push(("land".into(), style::land(), style::points(1.2)));
    }
    entries.push((
        format!("grid {:.0} m", grid_spacing(stage)),
        style::chart_text(),
        style::points(0.5),
    ));
    entries
}

/// Samples of the line styles with their meaning, in rows below the sea that is shown.
pub fn log_legend(
    rec: &mut Recorder,
    stage: &Stage,
    entries: Vec<Key>,
    rows: usize,
) -> RecordingStreamResult<()> {
    let bounds = stage.bounds;
    let columns = entries.len().div_ceil(rows.max(1)).max(1);
    // the view is wider than it is high: beside a sea that is not there is room
    let height = bounds.size().y + legend_height(stage, rows);
    let whole = bounds.size().x.max(LEGEND_SHAPE * height);
    let width = whole / columns as f64;
    let mut lines = Lines::default();
    let mut labels = Vec::new();
    for (index, (label, color, radius)) in entries.into_iter().enumerate() {
        let (row, column) = (index / columns, index % columns);
        let north = bounds.low.y - (0.25 + LEGEND_ROW * row as f64) * legend_height(stage, 1);
        let west = bounds.center().x - 0.5 * whole + width * (column as f64 + 0.2);
        let ends = [
            Vector::new(west, north),
            Vector::new(west + 0.6 * width, north),
        ];
        lines.add(ends.map(flat).to_vec(), color, radius);
        labels.push(label);
    }
    rec.log_static(
        path(&[MAP, "legend"]),
        &lines.archetype().with_labels(labels).with_show_labels(true),
    )
}

/// Of the height of the view: the least width of a legend.
const LEGEND_SHAPE: f64 = 1.36;

/// Of the height of a legend of one row: what each further one adds.
const LEGEND_ROW: f64 = 0.7;

/// Metres below the sea that is shown, for a legend of so many rows.
pub fn legend_height(stage: &Stage, rows: usize) -> f64 {
    let further = rows.saturating_sub(1) as f64;
    0.1 * stage.bounds.extent() * (1.0 + LEGEND_ROW * further)
}

fn shown_paces(scene: &Scene) -> Vec<Pace> {
    let all = [Pace::Slow, Pace::Desired, Pace::Fast];
    let used: Vec<Pace> = planned_strips(scene).into_iter().map(|(p, _)| p).collect();
    all.into_iter().filter(|pace| used.contains(pace)).collect()
}

/// Dashed: where own ship is meant to be.
fn log_desired(rec: &mut Recorder, stage: &Stage) -> RecordingStreamResult<()> {
    let dash = stage.bounds.extent() / 120.0;
    let mut lines = Lines::default();
    for leg in stage.scenario.desired.legs() {
        let mut along = 0.0;
        while along < leg.length {
            let ends = [along, (along + dash).min(leg.length)];
            lines.add(
                ends.map(|s| flat(leg.start + leg.direction * s)).to_vec(),
                style::desired(),
                style::points(0.8),
            );
            along += 2.0 * dash;
        }
    }
    rec.log_static(path(&[MAP, "desired"]), &lines.archetype())
}

/// The plan, one line per segment, by its speed against the desired one.
fn log_planned(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    if !scene.motion.is_planned() {
        return Ok(());
    }
    let mut lines = Lines::default();
    for (pace, points) in planned_strips(scene) {
        let strip = points.into_iter().map(|(p, _)| flat(p)).collect();
        lines.add(strip, pace.color(), pace.radius());
    }
    rec.log_static(path(&[MAP, "planned"]), &lines.archetype())
}

/// Points of a piece of a motion under forces, less one.
const PIECE_POINTS: usize = 4;

/// The plan's segments, or pieces, as polylines through `(position, time)`. Empty without a plan.
pub fn planned_strips(scene: &Scene) -> Vec<(Pace, Vec<(Vector, f64)>)> {
    match scene.motion {
        Motion::Planned(trajectory) => strips(scene, trajectory),
        Motion::Undisturbed(_) => Vec::new(),
    }
}

/// The segments, or pieces, of a motion as polylines through `(position, time)`.
pub fn strips(stage: &Stage, trajectory: &Trajectory) -> Vec<(Pace, Vec<(Vector, f64)>)> {
    let desired = &stage.scenario.desired;
    if let Some(motion) = trajectory.steered() {
        let strip = |piece: crate::trajectory::Cubic| {
            let points = (0..=PIECE_POINTS).map(|k| {
                let part = k as f64 / PIECE_POINTS as f64;
                (
                    piece.position(part),
                    piece.start_time + part * piece.duration,
                )
            });
            let speed = piece.velocity(0.5).norm();
            let wanted = desired_leg(desired, piece.start_time).speed;
            (Pace::of(speed, wanted), points.collect())
        };
        return joined(motion.pieces().map(strip));
    }
    trajectory
        .segments()
        .iter()
        .filter(|segment| segment.duration > 0.0)
        .map(|segment| {
            let desired = desired_leg(desired, segment.start_time).speed;
            (Pace::of(segment.speed, desired), polyline(segment))
        })
        .collect()
}

/// Strips of one pace that follow one another as one: a strip costs more than a point.
fn joined(
    strips: impl Iterator<Item = (Pace, Vec<(Vector, f64)>)>,
) -> Vec<(Pace, Vec<(Vector, f64)>)> {
    let mut all: Vec<(Pace, Vec<(Vector, f64)>)> = Vec::new();
    for (pace, points) in strips {
        match all.last_mut() {
            Some((before, line)) if *before == pace => line.extend(points.into_iter().skip(1)),
            _ => all.push((pace, points)),
        }
    }
    all
}

/// Points of a segment with their times: an arc every 3° at most.
pub fn polyline(segment: &crate::trajectory::Segment) -> Vec<(Vector, f64)> {
    let turn = (segment.turn_rate * segment.duration).abs();
    let pieces = (turn / ARC_STEP).ceil().clamp(1.0, 1e3) as usize;
    (0..=pieces)
        .map(|i| {
            let time = segment.start_time + segment.duration * i as f64 / pieces as f64;
            (segment.pose_at(time).position, time)
        })
        .collect()
}

/// Seconds between two time marks on the tracks.
pub fn mark_step(stage: &Stage) -> f64 {
    round_down(stage.end / 4.0)
}

/// Own ship's position every round number of seconds, with the time.
fn log_time_marks(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    let times: Vec<f64> = multiples(0.0, scene.end, mark_step(scene))
        .skip(1)
        .collect();
    // who has arrived has no further places
    let times = scene.motion.until_arrival(&times);
    let points = times
        .iter()
        .map(|&t| flat(scene.motion.pose_at(t).position));
    rec.log_static(
        path(&[MAP, "time_marks"]),
        &Points2D::new(points)
            .with_colors([style::own_ship()])
            .with_radii([style::points(3.0)])
            .with_labels(times.iter().map(|t| format!("{t:.0} s")))
            .with_show_labels(true),
    )
}

/// Where a target is expected, with the same time marks.
fn log_track(
    rec: &mut Recorder,
    stage: &Stage,
    index: usize,
    target: &Target,
) -> RecordingStreamResult<()> {
    let color = style::toward_background(stage.target_color(index), 0.6);
    let ends = [0.0, stage.end].map(|t| flat(target.position_at(t)));
    let marks = multiples(0.0, stage.end, mark_step(stage))
        .skip(1)
        .map(|t| flat(target.position_at(t)));
    let line = LineStrips2D::new([ends])
        .with_colors([color])
        .with_radii([style::points(0.6)]);
    let marks = Points2D::new(marks)
        .with_colors([color])
        .with_radii([style::points(3.0)]);
    rec.log_static(
        path(&[MAP, "tracks", &target.name]),
        &[&line as &dyn AsComponents, &marks],
    )
}

/// A line between own ship and each target at their closest, with distance and time of the least.
fn log_closest_points(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    let Some(evaluation) = &scene.run.evaluation else {
        return Ok(());
    };
    let beyond = scene.bounds.extent() / 10.0;
    let mut lines = Lines::default();
    let mut nearest: Option<(f64, Vector, String)> = None;
    for (target, passage) in scene.scenario.targets.iter().zip(&evaluation.passages) {
        let own = scene.motion.pose_at(passage.tcpa).position;
        let other = target.position_at(passage.tcpa);
        lines.add(
            [own, other].map(flat).to_vec(),
            style::chart_text(),
            style::points(0.8),
        );
        if nearest.as_ref().is_none_or(|n| passage.dcpa < n.0) {
            // on the far side of the target: own ship and her time marks are named on the near side
            let away = (other - own)
                .try_normalize(0.0)
                .unwrap_or_else(Vector::zeros);
            let label = format!("CPA {}", approach(passage.dcpa, passage.tcpa));
            nearest = Some((passage.dcpa, other + away * beyond, label));
        }
    }
    let Some((_, place, label)) = nearest else {
        return Ok(());
    };
    let lines = lines.archetype();
    let name = Points2D::new([flat(place)])
        .with_colors([style::chart_text()])
        .with_radii([style::points(0.0)])
        .with_labels([label])
        .with_show_labels(true);
    let parts: [&dyn AsComponents; 2] = [&lines, &name];
    rec.log_static(path(&[MAP, "closest_points"]), &parts)
}

/// Without a plan: where own ship on the desired trajectory first is in a set.
fn log_conflict(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    if scene.motion.is_planned() {
        return Ok(());
    }
    let inside = scene.samples.iter().find_map(|&time| {
        let own = scene.motion.pose_at(time).position;
        let mut sets = scene.run.obstacles.iter();
        let set = sets.find(|set| set.contains(own, time))?;
        Some((
            own,
            format!("in the set of {} from {time:.0} s", set.name()),
        ))
    });
    let Some((place, label)) = inside else {
        return Ok(());
    };
    rec.log_static(
        path(&[MAP, "conflict"]),
        &Points2D::new([flat(place)])
            .with_colors([style::alarm()])
            .with_radii([style::points(6.0)])
            .with_labels([label])
            .with_show_labels(true),
    )
}

/// Where the independent check found something wrong.
fn log_violations(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    let Some(evaluation) = &scene.run.evaluation else {
        return Ok(());
    };
    if evaluation.violations.is_empty() {
        return Ok(());
    }
    let points = evaluation
        .violations
        .iter()
        .map(|v| flat(scene.motion.pose_at(v.time).position));
    rec.log_static(
        path(&[MAP, "violations"]),
        &Points2D::new(points)
            .with_colors([style::alarm()])
            .with_radii([style::points(7.0)])
            .with_labels(evaluation.violations.iter().map(|v| v.what.clone()))
            .with_show_labels(true),
    )
}
