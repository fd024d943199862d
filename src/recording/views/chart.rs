//! Static parts of the chart: grid, legend, desired and planned trajectory, closest points.

use rerun::{AsComponents, Color, LineStrips2D, Points2D, Radius, RecordingStreamResult};

use super::ships::{DOMAIN_RADIUS, HARD_RADIUS, domain_color};
use crate::frame::Vector;
use crate::obstacle::SpaceTimeObstacle;
use crate::recording::canvas::style::{self, SpeedClass};
use crate::recording::canvas::{
    Bounds, Canvas, Palette, ShownMotion, ViewModel, desired_leg, flat, round_down,
};
use crate::recording::write::Recorder;
use crate::recording::{MAP, path};
use crate::target::Target;
use crate::tolerance;
use crate::trajectory::{Cubic, Segment, Trajectory};

/// Turn between two drawn points of an arc, radians.
const ARC_STEP: f64 = std::f64::consts::PI / 60.0;

/// A line of the chart.
pub type Strip = Vec<[f32; 2]>;

/// Lines, each with its style.
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

/// Logs everything of the chart that does not move.
pub fn log_chart(rec: &mut Recorder, model: &ViewModel) -> RecordingStreamResult<()> {
    log_waters(rec, model)?;
    log_legend(rec, model, plan_legend(model), 1)?;
    log_planned(rec, model)?;
    log_time_marks(rec, model)?;
    log_closest_points(rec, model)?;
    log_conflict(rec, model)?;
    log_violations(rec, model)
}

/// Logs what does not depend on own ship: the grid, the desired trajectory, the targets' tracks.
pub fn log_waters(rec: &mut Recorder, canvas: &Canvas) -> RecordingStreamResult<()> {
    // views of Rerun are y-down: this turns north up for everything below
    rec.log_static(MAP, &rerun::Transform3D::from_scale([1.0, -1.0, 1.0]))?;
    log_grid(rec, canvas)?;
    log_desired(rec, canvas)?;
    for (index, target) in canvas.scenario.targets.iter().enumerate() {
        log_track(rec, canvas, index, target)?;
    }
    Ok(())
}

/// Logs lines every round number of metres, and the north arrow.
fn log_grid(rec: &mut Recorder, canvas: &Canvas) -> RecordingStreamResult<()> {
    let Bounds { low, high } = canvas.bounds.grown(0.6 * canvas.bounds.extent());
    let spacing = grid_spacing(canvas);
    let mut lines = Lines::default();
    for east in multiples(low.x, high.x, spacing) {
        let ends = [Vector::new(east, low.y), Vector::new(east, high.y)];
        lines.add(ends.map(flat).to_vec(), style::grid(), style::points(0.5));
    }
    for north in multiples(low.y, high.y, spacing) {
        let ends = [Vector::new(low.x, north), Vector::new(high.x, north)];
        lines.add(ends.map(flat).to_vec(), style::grid(), style::points(0.5));
    }

    let unit = canvas.bounds.extent() / 100.0;
    let corner = Vector::new(canvas.bounds.low.x, canvas.bounds.high.y);
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
pub fn grid_spacing(canvas: &Canvas) -> f64 {
    round_down(canvas.bounds.extent() / 4.0)
}

/// Multiples of `step` within the interval.
pub fn multiples(low: f64, high: f64, step: f64) -> impl Iterator<Item = f64> {
    let (first, last) = ((low / step).ceil() as i64, (high / step).floor() as i64);
    (first..=last).map(move |i| step * i as f64)
}

/// The name of a line in the legend, its colour and its width.
pub type Key = (String, Color, Radius);

fn plan_legend(model: &ViewModel) -> Vec<Key> {
    let mut entries = vec![("desired".into(), style::desired(), style::points(0.8))];
    for pace in shown_speeds(model) {
        entries.push((pace.name().into(), pace.color(), pace.radius()));
    }
    entries.extend(waters_legend(model));
    entries
}

/// The keys of the sets, the land and the grid.
pub fn waters_legend(canvas: &Canvas) -> Vec<Key> {
    let mut entries: Vec<Key> = Vec::new();
    // the methods of a comparison may have sets of their own
    let whose = match canvas.palette {
        Palette::Targets => "",
        Palette::OwnShips => " of the scenario",
    };
    if !canvas.sets.is_empty() {
        entries.push((
            format!("hard set{whose}"),
            canvas.target_color(0),
            HARD_RADIUS,
        ));
        if canvas.sets.iter().any(|s| canvas.with_domain(s).is_some()) {
            entries.push((
                format!("set with domain{whose}"),
                domain_color(canvas, 0),
                DOMAIN_RADIUS,
            ));
        }
    }
    if canvas.scenario.land.is_some() {
        entries.push(("land".into(), style::land(), style::points(1.2)));
    }
    entries.push((
        format!("grid {:.0} m", grid_spacing(canvas)),
        style::chart_text(),
        style::points(0.5),
    ));
    entries
}

/// Logs samples of the line styles with their meaning, in rows below the bounds.
pub fn log_legend(
    rec: &mut Recorder,
    canvas: &Canvas,
    entries: Vec<Key>,
    rows: usize,
) -> RecordingStreamResult<()> {
    let bounds = canvas.bounds;
    let columns = entries.len().div_ceil(rows.max(1)).max(1);
    // the view is wider than it is high, so there may be space beside the bounds
    let height = bounds.size().y + legend_height(canvas, rows);
    let whole = bounds.size().x.max(LEGEND_SHAPE * height);
    let width = whole / columns as f64;
    let mut lines = Lines::default();
    let mut labels = Vec::new();
    for (index, (label, color, radius)) in entries.into_iter().enumerate() {
        let (row, column) = (index / columns, index % columns);
        let north = bounds.low.y - (0.25 + LEGEND_ROW * row as f64) * legend_height(canvas, 1);
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

/// Least width of a legend as a multiple of the height of the view.
const LEGEND_SHAPE: f64 = 1.36;

/// Height of each further row of a legend as a fraction of the first.
const LEGEND_ROW: f64 = 0.7;

/// Metres below the bounds for a legend with `rows`.
pub fn legend_height(canvas: &Canvas, rows: usize) -> f64 {
    let further = rows.saturating_sub(1) as f64;
    0.1 * canvas.bounds.extent() * (1.0 + LEGEND_ROW * further)
}

fn shown_speeds(model: &ViewModel) -> Vec<SpeedClass> {
    let all = [SpeedClass::Slow, SpeedClass::Desired, SpeedClass::Fast];
    let used: Vec<SpeedClass> = planned_strips(model).into_iter().map(|(p, _)| p).collect();
    all.into_iter().filter(|pace| used.contains(pace)).collect()
}

/// Logs the desired trajectory, dashed.
fn log_desired(rec: &mut Recorder, canvas: &Canvas) -> RecordingStreamResult<()> {
    let dash = canvas.bounds.extent() / 120.0;
    let mut lines = Lines::default();
    for leg in canvas.scenario.desired.legs() {
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

/// Logs the plan, one line per segment, styled by its speed.
fn log_planned(rec: &mut Recorder, model: &ViewModel) -> RecordingStreamResult<()> {
    if !model.motion.is_planned() {
        return Ok(());
    }
    let mut lines = Lines::default();
    for (pace, points) in planned_strips(model) {
        let strip = points.into_iter().map(|(p, _)| flat(p)).collect();
        lines.add(strip, pace.color(), pace.radius());
    }
    rec.log_static(path(&[MAP, "planned"]), &lines.archetype())
}

/// Lines that a piece of a motion under forces is drawn with.
const PIECE_POINTS: usize = 4;

/// The plan's segments, or pieces, as polylines through `(position, time)`. Empty without a plan.
pub fn planned_strips(model: &ViewModel) -> Vec<(SpeedClass, Vec<(Vector, f64)>)> {
    match model.motion {
        ShownMotion::Planned(trajectory) => strips(model, trajectory),
        ShownMotion::Nominal(_) => Vec::new(),
    }
}

/// The segments, or pieces, of a motion as polylines through `(position, time)`.
pub fn strips(canvas: &Canvas, trajectory: &Trajectory) -> Vec<(SpeedClass, Vec<(Vector, f64)>)> {
    let desired = &canvas.scenario.desired;
    if let Some(motion) = trajectory.steered() {
        let strip = |piece: Cubic| {
            let points = (0..=PIECE_POINTS).map(|k| {
                let part = k as f64 / PIECE_POINTS as f64;
                (
                    piece.position(part),
                    piece.start_time + part * piece.duration,
                )
            });
            let speed = piece.velocity(0.5).norm();
            let wanted = desired_leg(desired, piece.start_time).speed;
            (SpeedClass::of(speed, wanted), points.collect())
        };
        return joined(motion.pieces().map(strip));
    }
    trajectory
        .segments()
        .iter()
        .filter(|segment| segment.duration > 0.0)
        .map(|segment| {
            let desired = desired_leg(desired, segment.start_time).speed;
            (SpeedClass::of(segment.speed, desired), polyline(segment))
        })
        .collect()
}

/// Joins strips of one speed class that follow one another: a strip costs more than a point.
fn joined(
    strips: impl Iterator<Item = (SpeedClass, Vec<(Vector, f64)>)>,
) -> Vec<(SpeedClass, Vec<(Vector, f64)>)> {
    let mut all: Vec<(SpeedClass, Vec<(Vector, f64)>)> = Vec::new();
    for (pace, points) in strips {
        match all.last_mut() {
            Some((before, line)) if *before == pace => line.extend(points.into_iter().skip(1)),
            _ => all.push((pace, points)),
        }
    }
    all
}

/// Points of a segment with their times: an arc every 3° at most.
pub fn polyline(segment: &Segment) -> Vec<(Vector, f64)> {
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
    round_down(canvas.end / 4.0)
}

/// Logs own ship's position every round number of seconds, with the time.
fn log_time_marks(rec: &mut Recorder, model: &ViewModel) -> RecordingStreamResult<()> {
    let times: Vec<f64> = multiples(0.0, model.end, mark_step(model))
        .skip(1)
        .collect();
    // a plan has no positions after arrival
    let times = model.motion.until_arrival(&times);
    let points = times
        .iter()
        .map(|&t| flat(model.motion.pose_at(t).position));
    rec.log_static(
        path(&[MAP, "time_marks"]),
        &Points2D::new(points)
            .with_colors([style::own_ship()])
            .with_radii([style::points(3.0)])
            .with_labels(times.iter().map(|t| format!("{t:.0} s")))
            .with_show_labels(true),
    )
}

/// Logs where a target is expected, with the same time marks.
fn log_track(
    rec: &mut Recorder,
    canvas: &Canvas,
    index: usize,
    target: &Target,
) -> RecordingStreamResult<()> {
    let color = style::toward_background(canvas.target_color(index), 0.6);
    let ends = [0.0, canvas.end].map(|t| flat(target.position_at(t)));
    let marks = multiples(0.0, canvas.end, mark_step(canvas))
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

/// Logs a line between own ship and each target at their closest approach, and the distance and
/// time of the least.
fn log_closest_points(rec: &mut Recorder, model: &ViewModel) -> RecordingStreamResult<()> {
    let Some(evaluation) = &model.run.evaluation else {
        return Ok(());
    };
    let beyond = model.bounds.extent() / 10.0;
    let mut lines = Lines::default();
    let mut nearest: Option<(f64, Vector, String)> = None;
    for (target, passage) in model.scenario.targets.iter().zip(&evaluation.passages) {
        let own = model.motion.pose_at(passage.tcpa).position;
        let other = target.position_at(passage.tcpa);
        lines.add(
            [own, other].map(flat).to_vec(),
            style::chart_text(),
            style::points(0.8),
        );
        if nearest.as_ref().is_none_or(|n| passage.dcpa < n.0) {
            // on the far side of the target: own ship's name and time marks are on the near one
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

/// A closest approach in words: metres between the hulls, negative in overlap, and seconds.
/// Touching is no collision.
fn approach(distance: f64, time: f64) -> String {
    if distance < -tolerance::DEPTH_M {
        format!("collision at {time:.0} s")
    } else {
        format!("{:.0} m at {time:.0} s", distance.max(0.0))
    }
}

/// Logs, without a plan, where own ship on the desired trajectory first enters a set.
fn log_conflict(rec: &mut Recorder, model: &ViewModel) -> RecordingStreamResult<()> {
    if model.motion.is_planned() {
        return Ok(());
    }
    let inside = model.samples.iter().find_map(|&time| {
        let own = model.motion.pose_at(time).position;
        let mut sets = model.run.obstacles();
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

/// Logs where the independent check found a fault.
fn log_violations(rec: &mut Recorder, model: &ViewModel) -> RecordingStreamResult<()> {
    let Some(evaluation) = &model.run.evaluation else {
        return Ok(());
    };
    if evaluation.violations.is_empty() {
        return Ok(());
    }
    let points = evaluation
        .violations
        .iter()
        .map(|v| flat(model.motion.pose_at(v.time).position));
    rec.log_static(
        path(&[MAP, "violations"]),
        &Points2D::new(points)
            .with_colors([style::alarm()])
            .with_radii([style::points(7.0)])
            .with_labels(evaluation.violations.iter().map(|v| v.what.clone()))
            .with_show_labels(true),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn touching_is_no_collision() {
        assert_eq!(approach(-1e-8, 600.0), "0 m at 600 s");
        assert_eq!(approach(-1e-5, 600.0), "collision at 600 s");
        assert_eq!(approach(0.6, 12.0), "1 m at 12 s");
    }
}
