//! The path-time diagram: distance along the path to the right, time upward, own ship at the
//! cursor.

use rerun::{AsComponents, LineStrips2D, Points2D, RecordingStreamResult, Transform3D};

use super::chart::multiples;
use crate::obstacle::{PathTime, SpaceTimeObstacle};
use crate::planner::path_time::PathTimeDiagram;
use crate::recording::canvas::{Lines, ViewModel, labelled, round_down, style};
use crate::recording::write::Recorder;
use crate::recording::{PATH_TIME_PLANE, path};

/// Height of the view as a multiple of its width.
const SHAPE: f64 = 0.3;

/// Time shown after arrival, as a fraction of the time until then.
const AFTER: f64 = 0.15;

/// Least number of grid lines in each direction.
const LINES: f64 = 3.0;

/// Window of the view, and the number of metres that one second is drawn as.
#[derive(Debug, Clone, Copy)]
pub struct Frame {
    /// Metres.
    pub length: f64,
    /// Seconds.
    pub top: f64,
    /// Metres per second.
    pub rise: f64,
}

impl Frame {
    /// Shows the diagram until a while after arrival; without a plan up to the horizon.
    pub fn of(diagram: &PathTimeDiagram) -> Self {
        let length = diagram.length().max(1e-3);
        let arrival = diagram.profile.last().map_or(0.0, |last| last.time);
        let top = if arrival > 0.0 {
            (arrival * (1.0 + AFTER)).min(diagram.horizon)
        } else {
            diagram.horizon
        };
        Self {
            length,
            top,
            rise: SHAPE * length / top,
        }
    }

    fn point(&self, at: &PathTime) -> [f32; 2] {
        [at.distance as f32, (at.time * self.rise) as f32]
    }
}

/// Logs the whole view; nothing without a diagram.
pub fn log_path_time(rec: &mut Recorder, model: &ViewModel) -> RecordingStreamResult<()> {
    let Some(diagram) = model.run.planned.path_time.as_deref() else {
        return Ok(());
    };
    let frame = Frame::of(diagram);
    // time upward
    let turned = Transform3D::from_scale([1.0, -1.0, 1.0]);
    rec.log_static(PATH_TIME_PLANE, &turned)?;
    log_axes(rec, diagram, &frame)?;
    log_obstacles(rec, model, diagram, &frame)?;
    let profile: Vec<[f32; 2]> = diagram.profile.iter().map(|p| frame.point(p)).collect();
    let line = LineStrips2D::new([profile])
        .with_colors([style::OWN_SHIP])
        .with_radii([style::points(2.0)])
        .with_draw_order(20.0);
    rec.log_static(path(&[PATH_TIME_PLANE, "profile"]), &line)?;
    log_now(rec, model, diagram, &frame)
}

/// Logs a grid with its units, and where legs join.
fn log_axes(
    rec: &mut Recorder,
    diagram: &PathTimeDiagram,
    frame: &Frame,
) -> RecordingStreamResult<()> {
    let mut lines = Lines::new();
    let (mut places, mut words) = (Vec::new(), Vec::new());
    let at = |distance: f64, time: f64| frame.point(&PathTime { distance, time });
    for distance in multiples(0.0, frame.length, round_down(frame.length / LINES)) {
        let line = [at(distance, 0.0), at(distance, frame.top)];
        lines.add(line, style::GRID, 0.5);
        places.push(at(distance, -0.03 * frame.top));
        words.push(format!("{distance:.0} m"));
    }
    for time in multiples(0.0, frame.top, round_down(frame.top / LINES)) {
        let line = [at(0.0, time), at(frame.length, time)];
        lines.add(line, style::GRID, 0.5);
        if time > 0.0 {
            places.push(at(-0.03 * frame.length, time));
            words.push(format!("{time:.0} s"));
        }
    }
    for leg in diagram.legs.iter().skip(1) {
        let line = [at(leg.begin, 0.0), at(leg.begin, frame.top)];
        lines.add(line, style::DESIRED, 0.8);
    }
    let words = labelled(places, style::CHART_TEXT, 0.0, words);
    let lines = lines.archetype();
    let parts: [&dyn AsComponents; 2] = [&lines, &words];
    rec.log_static(path(&[PATH_TIME_PLANE, "axes"]), &parts)
}

/// Logs the outlines of each target's polygons, and its name at the first of them.
fn log_obstacles(
    rec: &mut Recorder,
    model: &ViewModel,
    diagram: &PathTimeDiagram,
    frame: &Frame,
) -> RecordingStreamResult<()> {
    for (index, obstacle) in model.run.obstacles().enumerate() {
        let outlines: Vec<Vec<[f32; 2]>> = diagram
            .obstacles
            .iter()
            .filter(|seen| seen.obstacle == index)
            .map(|seen| {
                let first = seen.corners.first();
                let ring = seen.corners.iter().chain(first);
                ring.map(|c| frame.point(c)).collect()
            })
            .collect();
        let Some(first) = outlines.first() else {
            continue;
        };
        let place = first.first().copied();
        let name = labelled(place, style::target(index), 0.0, [obstacle.name()]);
        let lines = LineStrips2D::new(outlines)
            .with_colors([style::target(index)])
            .with_radii([style::points(1.2)]);
        let parts: [&dyn AsComponents; 2] = [&lines, &name];
        let entity = path(&[PATH_TIME_PLANE, "obstacles", obstacle.name()]);
        rec.log_static(entity, &parts)?;
    }
    Ok(())
}

/// Logs own ship in the diagram, and the cursor's time as a line.
fn log_now(
    rec: &mut Recorder,
    model: &ViewModel,
    diagram: &PathTimeDiagram,
    frame: &Frame,
) -> RecordingStreamResult<()> {
    let times: Vec<f64> = model.cursor_times.clone();
    let entity = path(&[PATH_TIME_PLANE, "now"]);
    let style = LineStrips2D::update_fields()
        .with_colors([style::CHART_TEXT])
        .with_radii([style::points(0.8)]);
    let lines = times
        .iter()
        .map(|&time| [0.0, frame.length].map(|distance| frame.point(&PathTime { distance, time })));
    let columns = LineStrips2D::update_fields()
        .with_strips(lines)
        .columns_of_unit_batches()?;
    rec.log_moving(entity, model.cursor_column(), &style, columns)?;
    if diagram.profile.len() < 2 {
        return Ok(());
    }
    let entity = path(&[PATH_TIME_PLANE, "own_ship"]);
    let style = Points2D::update_fields()
        .with_colors([style::OWN_SHIP])
        .with_radii([style::points(5.0)]);
    let places: Vec<[f32; 2]> = times
        .iter()
        .map(|time| frame.point(&on_profile(&diagram.profile, *time)))
        .collect();
    let columns = Points2D::update_fields()
        .with_positions(places)
        .columns_of_unit_batches()?;
    rec.log_moving(entity, model.cursor_column(), &style, columns)
}

/// Where own ship is on its profile; it rests at the end.
fn on_profile(profile: &[PathTime], time: f64) -> PathTime {
    for pair in profile.windows(2) {
        if time <= pair[1].time {
            let share = (time - pair[0].time) / (pair[1].time - pair[0].time);
            let way = pair[1].distance - pair[0].distance;
            return PathTime {
                distance: pair[0].distance + share.clamp(0.0, 1.0) * way,
                time,
            };
        }
    }
    PathTime {
        distance: profile[profile.len() - 1].distance,
        time,
    }
}
