//! The chart that moves with the cursor: ships and the sections of their sets.

use rerun::{
    AsComponents, Color, EntityPath, LineStrips2D, Points2D, Quaternion, Radius,
    RecordingStreamResult, TimeColumn, Transform3D,
};

use super::chart::{Lines, Strip};
use super::columns::{log_columns, sparse};
use super::recorder::Recorder;
use super::scene::{Motion, Scene, Stage, flat, round_down};
use super::thinning::thinned_ring;
use super::{MAP, TIMELINE, TRAILS, path, style};
use crate::frame::{Pose, Vector};
use crate::geometry::ConvexPolygon;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::target::Target;

/// The hard set is drawn strong, the shaped one thin and weak.
pub const HARD_RADIUS: Radius = Radius(rerun::datatypes::Float32(-1.6));
/// See [`HARD_RADIUS`].
pub const SHAPED_RADIUS: Radius = Radius(rerun::datatypes::Float32(-0.7));

/// Colour of the outline of a shaped set.
pub fn shaped_color(stage: &Stage, index: usize) -> Color {
    style::toward_background(stage.target_color(index), 0.75)
}

/// Own ship on one of the motions that are shown.
#[derive(Debug, Clone)]
pub struct OwnShip<'a> {
    pub motion: Motion<'a>,
    /// Beside her on the chart, or where nobody has room for names when she is pointed at.
    pub name: String,
    pub color: Color,
}

/// Where a name is beside a track to the north or the south.
#[derive(Debug, Clone, Copy)]
enum Side {
    West,
    East,
}

/// Everything on the chart that moves.
pub fn log_movers(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    log_others(rec, scene)?;
    let name = if scene.motion.is_planned() {
        "Own ship"
    } else {
        "Own ship (no plan)"
    };
    let own = OwnShip {
        motion: scene.motion,
        name: name.to_owned(),
        color: style::own_ship(),
    };
    log_own_ship(rec, scene, path(&[MAP, "own_ship"]), &own, true)?;
    log_trails(rec, scene, &[own])
}

/// The targets and their sets.
pub fn log_others(rec: &mut Recorder, stage: &Stage) -> RecordingStreamResult<()> {
    for (index, sets) in stage.sets.iter().enumerate() {
        let name = sets.hard.name();
        if let Some(shaped) = stage.shaped(sets) {
            let look = set_look(shaped_color(stage, index), SHAPED_RADIUS);
            let entity = path(&[MAP, "shaped_sets", name]);
            log_sections(rec, stage, entity, shaped, &look)?;
        }
        let look = set_look(stage.target_color(index), HARD_RADIUS);
        let entity = path(&[MAP, "hard_sets", name]);
        log_sections(rec, stage, entity, &sets.hard, &look)?;
    }
    for (index, target) in stage.scenario.targets.iter().enumerate() {
        log_target(rec, stage, index, target)?;
    }
    Ok(())
}

/// What the outline of a set looks like.
pub fn set_look(color: Color, radius: Radius) -> LineStrips2D {
    LineStrips2D::update_fields()
        .with_colors([color])
        .with_radii([radius])
}

/// The outline of the section at every moment.
pub fn log_sections(
    rec: &mut Recorder,
    stage: &Stage,
    entity: rerun::EntityPath,
    set: &Obstacle,
    look: &LineStrips2D,
) -> RecordingStreamResult<()> {
    let outlines = stage
        .moments
        .iter()
        .map(|&t| drawn(&set.outer_section(t), stage.fineness()));
    let columns = LineStrips2D::update_fields()
        .with_strips(outlines)
        .columns_of_unit_batches()?;
    log_columns(rec, entity, stage.moment_column(), look, columns)
}

/// The closed boundary of a polygon, off by so many metres at most.
pub fn drawn(polygon: &ConvexPolygon, off: f64) -> Strip {
    thinned_ring(polygon, off).into_iter().map(flat).collect()
}

/// The closed boundary of a polygon.
fn outline(polygon: &ConvexPolygon) -> Strip {
    let mut strip: Strip = polygon.vertices().iter().copied().map(flat).collect();
    strip.extend(strip.first().copied());
    strip
}

/// A target's hull and speed vector do not turn: they are drawn turned and only move.
fn log_target(
    rec: &mut Recorder,
    stage: &Stage,
    index: usize,
    target: &Target,
) -> RecordingStreamResult<()> {
    let entity = path(&[MAP, "targets", &target.name]);
    let color = stage.target_color(index);
    let mut lines = Lines::default();
    if let Some(ship) = target.ship() {
        let here = Pose::new(Vector::zeros(), ship.pose.heading);
        lines.add(
            outline(&ship.hull.polygon(&here)),
            color,
            style::points(1.0),
        );
        let tip = ship.velocity() * vector_seconds(stage);
        lines.add(vec![[0.0, 0.0], flat(tip)], color, style::points(0.8));
    }
    let lines = lines.archetype();
    let way = target.position_at(stage.end) - target.position_at(0.0);
    let name = label(stage, color, &target.name, way, Side::East);
    let parts: [&dyn AsComponents; 2] = [&lines, &name];
    let places = stage.moments.iter().map(|&t| target.position_at(t));
    log_places(rec, stage, entity, &parts, places)
}

/// Her place and name, and below it her hull and her speed vector; the name is always shown where `named`.
pub fn log_own_ship(
    rec: &mut Recorder,
    stage: &Stage,
    entity: EntityPath,
    own: &OwnShip,
    named: bool,
) -> RecordingStreamResult<()> {
    let name = label(stage, own.color, &own.name, stage.ahead(), Side::West);
    let name = name.with_show_labels(named);
    let places = stage
        .moments
        .iter()
        .map(|&t| own.motion.pose_at(t).position);
    log_places(rec, stage, entity.clone(), &name, places)?;
    log_own_hull(rec, stage, entity.join(&EntityPath::from("hull")), own)
}

fn log_places(
    rec: &mut Recorder,
    stage: &Stage,
    entity: rerun::EntityPath,
    look: &dyn AsComponents,
    places: impl Iterator<Item = Vector>,
) -> RecordingStreamResult<()> {
    let raised = places.map(|p| [p.x as f32, p.y as f32, 0.0]);
    let columns = Transform3D::update_fields()
        .with_many_translation(raised)
        .columns_of_unit_batches()?;
    log_columns(rec, entity, stage.moment_column(), look, columns)
}

/// A dot per ship and moment; the blueprint shows those up to the cursor. The last one marks the ship
/// at any zoom.
pub fn log_trails(rec: &mut Recorder, stage: &Stage, own: &[OwnShip]) -> RecordingStreamResult<()> {
    let targets = &stage.scenario.targets;
    let entity = path(&[TRAILS]);
    let others = (0..targets.len()).map(|index| stage.target_color(index));
    let colors = own.iter().map(|o| o.color).chain(others);
    let look = Points2D::update_fields()
        .with_colors(colors)
        .with_radii([style::points(2.4)]);
    let mut dots = Vec::new();
    for &time in &stage.moments {
        let own = own.iter().map(|o| o.motion.pose_at(time).position);
        let all = own.chain(targets.iter().map(|t| t.position_at(time)));
        dots.extend(all.map(flat));
    }
    let lengths = vec![own.len() + targets.len(); stage.moments.len()];
    let columns = Points2D::update_fields()
        .with_positions(dots)
        .columns(lengths)?;
    log_columns(rec, entity, stage.moment_column(), &look, columns)
}

/// Own ship's hull and speed vector, which turn with her; drawn anew where the speed changes.
fn log_own_hull(
    rec: &mut Recorder,
    stage: &Stage,
    entity: EntityPath,
    own: &OwnShip,
) -> RecordingStreamResult<()> {
    let look = LineStrips2D::update_fields()
        .with_colors([own.color])
        .with_radii([style::points(1.2), style::points(0.8)]);
    let changes = match own.motion {
        Motion::Planned(trajectory) => trajectory.joints(),
        Motion::Undisturbed(desired) => desired.legs().iter().map(|l| l.start_time).collect(),
    };
    let mut times = [&changes[..], &stage.moments].concat();
    times.sort_by(f64::total_cmp);
    times.dedup();
    let hull = stage.scenario.own_ship.hull;
    let hull = outline(&hull.polygon(&Pose::new(Vector::zeros(), 0.0)));
    let mut strips = Vec::new();
    let mut drawn = None;
    let lengths: Vec<Option<usize>> = times
        .iter()
        .map(|&t| {
            let tip = (own.motion.speed_at(t) * vector_seconds(stage)) as f32;
            let is_new = drawn.replace(tip) != Some(tip);
            is_new.then(|| {
                strips.extend([hull.clone(), vec![[0.0, 0.0], [tip, 0.0]]]);
                2
            })
        })
        .collect();
    let drawn = LineStrips2D::update_fields().with_strips(strips);
    let drawn = drawn.as_serialized_batches().into_iter();
    let turns = Transform3D::update_fields()
        .with_many_quaternion(
            times
                .iter()
                .map(|&t| rotation(own.motion.pose_at(t).heading)),
        )
        .columns_of_unit_batches()?;
    let columns = drawn.map(|batch| sparse(batch, &lengths)).chain(turns);
    let times = TimeColumn::new_duration_secs(TIMELINE, times.iter().copied());
    log_columns(rec, entity, times, &look, columns)
}

/// Seconds that a speed vector reaches ahead.
pub fn vector_seconds(stage: &Stage) -> f64 {
    round_down(stage.end / 6.0)
}

/// A name beside the track of a ship that goes a way: north of one to the east or west, the time marks have theirs south of it; on a side
/// of others, farther off, as names are wide.
fn label(stage: &Stage, color: Color, name: &str, way: Vector, side: Side) -> Points2D {
    let extent = stage.bounds.extent();
    let off = match side {
        _ if way.x.abs() >= way.y.abs() => Vector::new(0.0, extent / 22.0),
        Side::West => Vector::new(-extent / 9.0, 0.0),
        Side::East => Vector::new(extent / 9.0, 0.0),
    };
    Points2D::new([flat(off)])
        .with_colors([color])
        .with_radii([style::points(0.0)])
        .with_labels([name])
        .with_show_labels(true)
}

/// About the vertical, counter-clockwise seen from above.
fn rotation(heading: f64) -> Quaternion {
    let (sin, cos) = (heading / 2.0).sin_cos();
    Quaternion::from_xyzw([0.0, 0.0, sin as f32, cos as f32])
}
