//! The chart that moves with the cursor: ships and the sections of their sets.

use rerun::{
    AsComponents, Color, EntityPath, LineStrips2D, Points2D, Quaternion, Radius, RecordingStream,
    RecordingStreamResult, TimeColumn, Transform3D,
};

use super::chart::{Lines, Strip};
use super::scene::{Motion, Scene, Stage, flat, round_down};
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

/// Everything on the chart that moves.
pub fn log_movers(rec: &RecordingStream, scene: &Scene) -> RecordingStreamResult<()> {
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
pub fn log_others(rec: &RecordingStream, stage: &Stage) -> RecordingStreamResult<()> {
    for (index, sets) in stage.sets.iter().enumerate() {
        let name = sets.hard.name();
        if sets.shaped != sets.hard {
            let look = (shaped_color(stage, index), SHAPED_RADIUS);
            log_sections(
                rec,
                stage,
                path(&[MAP, "shaped_sets", name]),
                &sets.shaped,
                look,
            )?;
        }
        let look = (stage.target_color(index), HARD_RADIUS);
        log_sections(
            rec,
            stage,
            path(&[MAP, "hard_sets", name]),
            &sets.hard,
            look,
        )?;
    }
    for (index, target) in stage.scenario.targets.iter().enumerate() {
        log_target(rec, stage, index, target)?;
    }
    Ok(())
}

/// The outline of the section at every moment.
fn log_sections(
    rec: &RecordingStream,
    stage: &Stage,
    entity: rerun::EntityPath,
    set: &Obstacle,
    (color, radius): (Color, Radius),
) -> RecordingStreamResult<()> {
    let look = LineStrips2D::update_fields()
        .with_colors([color])
        .with_radii([radius]);
    rec.log_static(entity.clone(), &look)?;
    let outlines = stage
        .moments
        .iter()
        .map(|&t| outline(&set.outer_section(t)));
    let columns = LineStrips2D::update_fields()
        .with_strips(outlines)
        .columns_of_unit_batches()?;
    rec.send_columns(entity, [stage.moment_column()], columns)
}

/// The closed boundary of a polygon.
pub fn outline(polygon: &ConvexPolygon) -> Strip {
    let mut strip: Strip = polygon.vertices().iter().copied().map(flat).collect();
    strip.extend(strip.first().copied());
    strip
}

/// A target's hull and speed vector do not turn: they are drawn turned and only move.
fn log_target(
    rec: &RecordingStream,
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
    let parts: [&dyn AsComponents; 2] = [&lines, &label(stage, color, &target.name)];
    rec.log_static(entity.clone(), &parts)?;
    let places = stage.moments.iter().map(|&t| target.position_at(t));
    log_places(rec, stage, entity, places)
}

/// Her place and name, and below it her hull and her speed vector; the name is always shown where `named`.
pub fn log_own_ship(
    rec: &RecordingStream,
    stage: &Stage,
    entity: EntityPath,
    own: &OwnShip,
    named: bool,
) -> RecordingStreamResult<()> {
    let name = label(stage, own.color, &own.name).with_show_labels(named);
    rec.log_static(entity.clone(), &name)?;
    let poses = stage.moments.iter().map(|&t| own.motion.pose_at(t));
    log_places(
        rec,
        stage,
        entity.clone(),
        poses.clone().map(|p| p.position),
    )?;

    let hull = entity.join(&EntityPath::from("hull"));
    let turns = Transform3D::update_fields()
        .with_many_quaternion(poses.map(|p| rotation(p.heading)))
        .columns_of_unit_batches()?;
    rec.send_columns(hull.clone(), [stage.moment_column()], turns)?;
    log_own_outline(rec, stage, hull, own)
}

fn log_places(
    rec: &RecordingStream,
    stage: &Stage,
    entity: rerun::EntityPath,
    places: impl Iterator<Item = Vector>,
) -> RecordingStreamResult<()> {
    let raised = places.map(|p| [p.x as f32, p.y as f32, 0.0]);
    let columns = Transform3D::update_fields()
        .with_many_translation(raised)
        .columns_of_unit_batches()?;
    rec.send_columns(entity, [stage.moment_column()], columns)
}

/// A dot per ship and moment; the blueprint shows those up to the cursor. The last one marks the ship
/// at any zoom.
pub fn log_trails(
    rec: &RecordingStream,
    stage: &Stage,
    own: &[OwnShip],
) -> RecordingStreamResult<()> {
    let targets = &stage.scenario.targets;
    let entity = path(&[TRAILS]);
    let others = (0..targets.len()).map(|index| stage.target_color(index));
    let colors = own.iter().map(|o| o.color).chain(others);
    let look = Points2D::update_fields()
        .with_colors(colors)
        .with_radii([style::points(2.4)]);
    rec.log_static(entity.clone(), &look)?;
    let mut dots = Vec::new();
    for &time in &stage.moments {
        let own = own.iter().map(|o| o.motion.pose_at(time).position);
        let all = own.chain(targets.iter().map(|t| t.position_at(time)));
        dots.extend(all.map(flat));
    }
    let lengths = vec![own.len() + targets.len(); stage.moments.len()];
    rec.send_columns(
        entity,
        [stage.moment_column()],
        Points2D::update_fields()
            .with_positions(dots)
            .columns(lengths)?,
    )
}

/// Own ship's hull and speed vector in her own frame, logged where the speed changes.
fn log_own_outline(
    rec: &RecordingStream,
    stage: &Stage,
    entity: EntityPath,
    own: &OwnShip,
) -> RecordingStreamResult<()> {
    let look = LineStrips2D::update_fields()
        .with_colors([own.color])
        .with_radii([style::points(1.2), style::points(0.8)]);
    rec.log_static(entity.clone(), &look)?;
    let mut times = match own.motion {
        Motion::Planned(trajectory) => trajectory.joints(),
        Motion::Undisturbed(desired) => desired.legs().iter().map(|l| l.start_time).collect(),
    };
    dedup_increasing(&mut times);
    let hull = stage.scenario.own_ship.hull;
    let hull = outline(&hull.polygon(&Pose::new(Vector::zeros(), 0.0)));
    let strips = times.iter().flat_map(|&t| {
        let tip = own.motion.speed_at(t) * vector_seconds(stage);
        [hull.clone(), vec![[0.0, 0.0], [tip as f32, 0.0]]]
    });
    let columns = LineStrips2D::update_fields()
        .with_strips(strips)
        .columns(vec![2; times.len()])?;
    rec.send_columns(
        entity,
        [TimeColumn::new_duration_secs(
            TIMELINE,
            times.iter().copied(),
        )],
        columns,
    )
}

/// Segments of no duration share their start with the next.
fn dedup_increasing(times: &mut Vec<f64>) {
    times.dedup_by(|later, earlier| *later <= *earlier);
}

/// Seconds that a speed vector reaches ahead.
pub fn vector_seconds(stage: &Stage) -> f64 {
    round_down(stage.end / 6.0)
}

/// A name north of the ship: the time marks have theirs south of the track.
fn label(stage: &Stage, color: Color, name: &str) -> Points2D {
    let off = stage.bounds.extent() / 22.0;
    Points2D::new([[0.0, off as f32]])
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
