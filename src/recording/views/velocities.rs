//! The plane of velocities at the cursor: own ship's velocity, velocity obstacles of the hard sets.

use rerun::{AsComponents, Points2D, Transform3D};

use super::ships::{HARD, log_strips, outline};
use crate::frame::{Vector, direction};
use crate::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use crate::recording::canvas::{Lines, Strip, ViewModel, flat, labelled, lines, points, style};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, PLANE, path};

/// Longest time ahead that is looked at, seconds.
const LOOK_AHEAD_S: f64 = 300.0;

/// Radians between two points of a circle: 72 of them.
const CIRCLE_STEP: f64 = std::f64::consts::PI / 36.0;

/// Half width of the view, m/s: 1.5 times own ship's greatest speed.
pub fn limit(model: &ViewModel) -> f64 {
    1.5 * model.scenario.own_ship.max_speed()
}

pub fn log_velocities(rec: &mut Recorder, model: &ViewModel) -> Logged {
    // north up, as on the chart
    let turned = Transform3D::from_scale([1.0, -1.0, 1.0]);
    rec.log_static(PLANE, &turned)?;
    log_axes(rec, model)?;
    for (index, sets) in model.sets.iter().enumerate() {
        let entity = path(&[PLANE, "obstacles", sets.hard.name()]);
        let style = lines(style::target(index), HARD.radius);
        log_strips(rec, model, entity, &style, |time| {
            vec![region_outline(model, &sets.hard, time)]
        })?;
    }
    let entity = path(&[PLANE, "own_ship"]);
    let style = points(style::OWN_SHIP, 4.0)
        .with_labels(["Own ship"])
        .with_show_labels(true);
    let own = model.cursor_times.iter().map(|&t| {
        let pose = model.motion.pose_at(t);
        flat(pose.ahead() * model.motion.speed_at(t))
    });
    let columns = Points2D::update_fields()
        .with_positions(own)
        .columns_of_unit_batches()?;
    rec.log_moving(entity, model.cursor_column(), &style, columns)
}

fn log_axes(rec: &mut Recorder, model: &ViewModel) -> Logged {
    let limit = limit(model);
    let mut lines = Lines::default();
    for axis in [Vector::new(limit, 0.0), Vector::new(0.0, limit)] {
        lines.add([-axis, axis].map(flat), style::GRID, 0.5);
    }
    for &speed in &model.scenario.own_ship.speeds {
        let circle = (0..=72).map(|k| flat(direction(f64::from(k) * CIRCLE_STEP) * speed));
        lines.add(circle.collect::<Strip>(), style::GRID, 0.8);
    }
    let ends = [Vector::new(limit, 0.0), Vector::new(0.0, limit)].map(flat);
    let names = labelled(ends, style::CHART_TEXT, 0.0, ["E", "N"]);
    let lines = lines.archetype();
    let parts: [&dyn AsComponents; 2] = [&lines, &names];
    rec.log_static(path(&[PLANE, "axes"]), &parts)
}

/// The closed edge of the velocity obstacle at a time and at own ship's position then, clipped to
/// the view.
///
/// It is exact for a polytope and an outer bound by tangents for an ellipsoid. For several slabs
/// it is that of the hull of all later velocities.
fn region_outline(model: &ViewModel, set: &Obstacle, time: f64) -> Strip {
    let own = model.motion.pose_at(time).position;
    let ahead = LOOK_AHEAD_S.min((model.end - time).max(1.0));
    let limit = limit(model);
    let region = match set.as_ellipsoid() {
        // it grows from any of its sections as from its first
        Some(o) => EllipsoidObstacle::new("", o.outer_section(time), *o.velocity())
            .outer_velocities_within(own, ahead, 0.0),
        None => {
            let velocities = set.sets().outer_velocities_after(time);
            PolytopeObstacle::new("", set.outer_section(time), velocities)
                .velocity_obstacle(own, ahead)
        }
    };
    region
        .clipped(limit)
        .map_or_else(Vec::new, |region| outline(&region))
}
