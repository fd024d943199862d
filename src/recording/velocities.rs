//! The plane of velocities at the cursor: own ship's velocity and the velocity obstacles of the hard sets.

use rerun::{AsComponents, LineStrips2D, Points2D, RecordingStreamResult, Transform3D};

use super::chart::{Lines, Strip};
use super::columns::log_columns;
use super::movers::{HARD_RADIUS, drawn};
use super::recorder::Recorder;
use super::scene::{Scene, flat};
use super::thinning;
use super::{PLANE, path, style};
use crate::frame::{Vector, direction};
use crate::geometry::ConvexPolygon;
use crate::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle};

/// Seconds ahead that are looked at, at most.
const LOOK_AHEAD_S: f64 = 300.0;

/// Radians between two points of a circle: 72 of them.
const CIRCLE_STEP: f64 = std::f64::consts::PI / 36.0;

/// Of the view: how far the outline of an ellipsoid's velocity obstacle may be from it.
const FINENESS: f64 = 3e-3;

/// Metres per second, east and north, that the view shows to each side: half as much again as own ship's greatest speed.
pub fn limit(scene: &Scene) -> f64 {
    1.5 * scene.scenario.own_ship.max_speed()
}

/// The whole view.
pub fn log_velocities(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    // north up, as on the chart
    let turned = Transform3D::from_scale([1.0, -1.0, 1.0]);
    rec.log_static(PLANE, &turned)?;
    log_axes(rec, scene)?;
    for (index, sets) in scene.sets.iter().enumerate() {
        let entity = path(&[PLANE, "obstacles", sets.hard.name()]);
        let look = LineStrips2D::update_fields()
            .with_colors([style::target(index)])
            .with_radii([HARD_RADIUS]);
        let outlines = scene
            .moments
            .iter()
            .map(|&t| region_outline(scene, &sets.hard, t));
        let columns = LineStrips2D::update_fields()
            .with_strips(outlines)
            .columns_of_unit_batches()?;
        log_columns(rec, entity, scene.moment_column(), &look, columns)?;
    }
    let entity = path(&[PLANE, "own_ship"]);
    let look = Points2D::update_fields()
        .with_colors([style::own_ship()])
        .with_radii([style::points(4.0)])
        .with_labels(["Own ship"])
        .with_show_labels(true);
    let own = scene.moments.iter().map(|&t| {
        let pose = scene.motion.pose_at(t);
        [flat(pose.ahead() * scene.motion.speed_at(t))]
    });
    let places: Vec<[f32; 2]> = own.flatten().collect();
    let columns = Points2D::update_fields()
        .with_positions(places)
        .columns_of_unit_batches()?;
    log_columns(rec, entity, scene.moment_column(), &look, columns)
}

/// The axes, and a circle for each of own ship's speeds.
fn log_axes(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    let limit = limit(scene);
    let mut lines = Lines::default();
    for axis in [Vector::new(limit, 0.0), Vector::new(0.0, limit)] {
        lines.add(
            vec![flat(-axis), flat(axis)],
            style::grid(),
            style::points(0.5),
        );
    }
    for &speed in &scene.scenario.own_ship.speeds {
        let circle = (0..=72).map(|k| flat(direction(f64::from(k) * CIRCLE_STEP) * speed));
        lines.add(circle.collect(), style::grid(), style::points(0.8));
    }
    let names = Points2D::new([flat(Vector::new(limit, 0.0)), flat(Vector::new(0.0, limit))])
        .with_colors([style::chart_text()])
        .with_radii([style::points(0.0)])
        .with_labels(["E", "N"])
        .with_show_labels(true);
    let lines = lines.archetype();
    let parts: [&dyn AsComponents; 2] = [&lines, &names];
    rec.log_static(path(&[PLANE, "axes"]), &parts)
}

/// The closed edge of the velocity obstacle as it is at a time, own ship being where she is then, clipped to the view: of
/// a polytope exact, of an ellipsoid from outside to [`FINENESS`] of the view, of slabs that of all velocities still to
/// come.
fn region_outline(scene: &Scene, set: &Obstacle, time: f64) -> Strip {
    let own = scene.motion.pose_at(time).position;
    let ahead = LOOK_AHEAD_S.min((scene.end - time).max(1.0));
    let limit = limit(scene);
    let region = match set {
        Obstacle::Polytope(o) => {
            from(set, time, o.velocity().clone()).velocity_obstacle(own, ahead)
        }
        // from any of its sections on it goes on as from its first
        Obstacle::Ellipsoid(o) => EllipsoidObstacle::new("", o.outer_section(time), *o.velocity())
            .velocity_obstacle(own, ahead)
            .outer_half_planes(limit, FINENESS * limit),
        Obstacle::Slabs(o) => {
            let to_come = o.velocity_sets().iter().filter(|s| s.until > time);
            let velocities = hull(to_come.flat_map(|s| s.velocities.vertices().iter().copied()));
            from(set, time, velocities).velocity_obstacle(own, ahead)
        }
    };
    region.clipped(limit).map_or_else(Vec::new, |region| {
        drawn(&region, thinning::FINENESS * limit)
    })
}

/// A set as it is at a time with the velocities that it has from then on, with a clock that starts then.
fn from(set: &Obstacle, time: f64, velocities: ConvexPolygon) -> PolytopeObstacle {
    PolytopeObstacle::new("", set.outer_section(time), velocities)
}

fn hull(points: impl Iterator<Item = Vector>) -> ConvexPolygon {
    let points: Vec<Vector> = points.collect();
    ConvexPolygon::hull(&points).unwrap_or_else(|_| ConvexPolygon::point(Vector::zeros()))
}
