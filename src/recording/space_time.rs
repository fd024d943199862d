//! The space-time volume: east, north and, upward, time.

use rerun::{
    AsComponents, Color, LineStrips3D, Points3D, Radius, RecordingStreamResult, Transform3D,
    ViewCoordinates,
};

use super::body::{mesh, stretches};
use super::chart::{grid_spacing, mark_step, multiples, planned_strips};
use super::columns::log_columns;
use super::movers::OwnShip;
use super::recorder::Recorder;
use super::scene::{Bounds, Scene, Stage};
use super::{VOLUME, path, style};
use crate::frame::{Vector, to_port};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};

/// Strength of the shadow of a plan on the sea.
const SHADOW: f32 = 0.35;

/// Of the sides of a shaped body.
pub const SHAPED_ALPHA: u8 = 16;
/// Of the sides of a hard body.
const HARD_ALPHA: u8 = 36;

/// Lines in space-time, each with its look.
#[derive(Debug, Default)]
struct Lines {
    strips: Vec<Vec<[f32; 3]>>,
    colors: Vec<Color>,
    radii: Vec<Radius>,
}

impl Lines {
    fn add(&mut self, strip: Vec<[f32; 3]>, color: Color, radius: f32) {
        self.strips.push(strip);
        self.colors.push(color);
        self.radii.push(style::points(radius));
    }

    fn archetype(self) -> LineStrips3D {
        LineStrips3D::new(self.strips)
            .with_colors(self.colors)
            .with_radii(self.radii)
    }
}

/// The whole volume.
pub fn log_volume(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    log_waters(rec, scene)?;
    log_planned(rec, scene)?;
    let own = OwnShip {
        motion: scene.motion,
        name: "Own ship".to_owned(),
        color: style::own_ship(),
    };
    log_now(rec, scene, &[own])
}

/// What is there whoever sails: the axes, the sets, the desired motion and those of the targets.
pub fn log_waters(rec: &mut Recorder, stage: &Stage) -> RecordingStreamResult<()> {
    rec.log_static(VOLUME, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
    log_axes(rec, stage)?;
    for (index, sets) in stage.sets.iter().enumerate() {
        let name = sets.hard.name();
        if let Some(shaped) = stage.shaped(sets) {
            let entity = path(&[VOLUME, "shaped_sets", name]);
            let look = (stage.target_color(index), SHAPED_ALPHA);
            log_body(rec, stage, entity, shaped, look)?;
        }
        let entity = path(&[VOLUME, "hard_sets", name]);
        let look = (stage.target_color(index), HARD_ALPHA);
        log_body(rec, stage, entity, &sets.hard, look)?;
    }
    log_expected(rec, stage)
}

/// The sea at t = 0 as a grid, the time axis with its ticks.
fn log_axes(rec: &mut Recorder, stage: &Stage) -> RecordingStreamResult<()> {
    let Bounds { low, high } = stage.bounds;
    let spacing = grid_spacing(stage);
    let mut lines = Lines::default();
    let ground = |east: f64, north: f64| stage.lifted(Vector::new(east, north), 0.0);
    for east in multiples(low.x, high.x, spacing) {
        lines.add(
            vec![ground(east, low.y), ground(east, high.y)],
            style::grid(),
            0.5,
        );
    }
    for north in multiples(low.y, high.y, spacing) {
        lines.add(
            vec![ground(low.x, north), ground(high.x, north)],
            style::grid(),
            0.5,
        );
    }
    let text = style::chart_text();
    let axis = axis_corner(stage);
    let axis_line = [0.0, stage.end].map(|t| stage.lifted(axis, t));
    lines.add(axis_line.to_vec(), text, 1.0);
    let mut places = Vec::new();
    let mut labels = Vec::new();
    for time in multiples(0.0, stage.end, 2.0 * mark_step(stage)) {
        places.push(stage.lifted(axis, time));
        labels.push(if time == 0.0 {
            "t = 0 s".to_owned()
        } else {
            format!("{time:.0} s")
        });
    }
    let middle = stage.bounds.center();
    for (place, name) in [
        (Vector::new(high.x, middle.y), "E"),
        (Vector::new(middle.x, high.y), "N"),
    ] {
        places.push(stage.lifted(place, 0.0));
        labels.push(name.to_owned());
    }
    let ticks = Points3D::new(places)
        .with_colors([text])
        .with_radii([style::points(2.0)])
        .with_labels(labels)
        .with_show_labels(true);
    let lines = lines.archetype();
    let parts: [&dyn AsComponents; 2] = [&lines, &ticks];
    rec.log_static(path(&[VOLUME, "axes"]), &parts)
}

/// Where the time axis stands: on the far side as the eye sees it, at the end where own ship starts.
fn axis_corner(stage: &Stage) -> Vector {
    let Bounds { low, high } = stage.bounds;
    let ahead = stage.ahead();
    let beside = to_port(ahead) - ahead;
    let corner = |along: f64, low: f64, high: f64| if along < 0.0 { low } else { high };
    Vector::new(
        corner(beside.x, low.x, high.x),
        corner(beside.y, low.y, high.y),
    )
}

/// The translucent body, its edges and its last section.
pub fn log_body(
    rec: &mut Recorder,
    stage: &Stage,
    entity: rerun::EntityPath,
    set: &Obstacle,
    (color, alpha): (Color, u8),
) -> RecordingStreamResult<()> {
    let stretches = stretches(stage, set);
    let body = mesh(stage, &stretches).with_albedo_factor(style::translucent(color, alpha).0);
    let strength = 0.3 + f32::from(alpha) / 100.0;
    let faint = style::toward_background(color, strength);
    let mut lines = Lines::default();
    for time in [0.0, 0.25, 0.5, 0.75, 1.0].map(|f| f * stage.end) {
        if let Some(stretch) = stretches.iter().find(|s| s.contains(time)) {
            lines.add(stretch.ring(stage, time), faint, 0.6);
        }
    }
    let lines = lines.archetype();
    let parts: [&dyn AsComponents; 2] = [&body, &lines];
    rec.log_static(entity, &parts)
}

/// The plan, and its shadow on the sea.
fn log_planned(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    if !scene.motion.is_planned() {
        return Ok(());
    }
    let mut lines = Lines::default();
    let shadow = style::toward_background(style::own_ship(), SHADOW);
    for (pace, points) in planned_strips(scene) {
        let risen = points.iter().map(|&(p, t)| scene.lifted(p, t)).collect();
        lines.add(risen, pace.color(), 2.0);
        let fallen = points.iter().map(|&(p, _)| scene.lifted(p, 0.0)).collect();
        lines.add(fallen, shadow, 0.8);
    }
    rec.log_static(path(&[VOLUME, "planned"]), &lines.archetype())
}

/// Desired and expected motions.
fn log_expected(rec: &mut Recorder, stage: &Stage) -> RecordingStreamResult<()> {
    let desired = &stage.scenario.desired;
    let mut lines = Lines::default();
    let mut strip: Vec<_> = desired
        .legs()
        .iter()
        .map(|l| stage.lifted(l.start, l.start_time))
        .collect();
    strip.push(stage.lifted(desired.end(), desired.duration()));
    lines.add(strip, style::desired(), 0.9);
    rec.log_static(path(&[VOLUME, "desired"]), &lines.archetype())?;
    if stage.scenario.targets.is_empty() {
        return Ok(());
    }
    let mut lines = Lines::default();
    for (index, target) in stage.scenario.targets.iter().enumerate() {
        let mut times = vec![0.0];
        times.extend(target.changes().into_iter().filter(|&t| t < stage.end));
        times.push(stage.end);
        let places = times.iter();
        let strip = places.map(|&t| stage.lifted(target.position_at(t), t));
        lines.add(strip.collect(), stage.target_color(index), 1.0);
    }
    rec.log_static(path(&[VOLUME, "targets"]), &lines.archetype())
}

/// The plane of the cursor, and where the ships are in it.
pub fn log_now(rec: &mut Recorder, stage: &Stage, own: &[OwnShip]) -> RecordingStreamResult<()> {
    let Bounds { low, high } = stage.bounds;
    let frame = [
        [low.x, low.y],
        [high.x, low.y],
        [high.x, high.y],
        [low.x, high.y],
        [low.x, low.y],
    ]
    .map(|[east, north]| stage.lifted(Vector::new(east, north), 0.0));
    let frame = LineStrips3D::new([frame])
        .with_colors([style::toward_background(style::own_ship(), 0.5)])
        .with_radii([style::points(0.6)]);
    let targets = &stage.scenario.targets;
    let others = (0..targets.len()).map(|index| stage.target_color(index));
    let colors = own.iter().map(|o| o.color).chain(others);
    let others = targets.iter().map(|t| t.name.as_str());
    let names = own.iter().map(|o| o.name.as_str()).chain(others);
    let ships = Points3D::update_fields()
        .with_colors(colors)
        .with_radii([style::points(5.0)])
        .with_labels(names)
        // names of several own ships would lie on one another: they are shown when one is pointed at
        .with_show_labels(own.len() <= 1);
    let entity = path(&[VOLUME, "now"]);
    let look: [&dyn AsComponents; 2] = [&frame, &ships];

    let plane = |time: f64| stage.lifted(Vector::zeros(), time);
    let rises = Transform3D::update_fields()
        .with_many_translation(stage.moments.iter().map(|&t| plane(t)))
        .columns_of_unit_batches()?;
    let mut places = Vec::new();
    for &time in &stage.moments {
        let own = own.iter().map(|o| o.motion.pose_at(time).position);
        let all = own.chain(targets.iter().map(|t| t.position_at(time)));
        places.extend(all.map(|p| stage.lifted(p, 0.0)));
    }
    let lengths = vec![own.len() + targets.len(); stage.moments.len()];
    let moves = Points3D::update_fields()
        .with_positions(places)
        .columns(lengths)?;
    let columns = rises.chain(moves);
    log_columns(rec, entity, stage.moment_column(), &look, columns)
}
