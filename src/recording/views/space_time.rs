//! The space-time volume: east, north and, upward, time.

use std::f64::consts::TAU;

use rerun::{AsComponents, Color, LineStrips3D, Mesh3D, Points3D, Transform3D, ViewCoordinates};

use super::chart::{grid_lines, mark_step, multiples, planned_strips};
use super::ships::{Ships, shown_sets};
use crate::frame::{Vector, direction, to_port};
use crate::geometry::Window;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::recording::canvas::{Canvas, Lines, ViewModel, style};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, VOLUME, path};
use crate::text::clock;

/// Strength of the shadow of a plan on the sea, of 1.
const SHADOW: f32 = 0.35;

pub fn log_volume(rec: &mut Recorder, model: &ViewModel, ships: &Ships) -> Logged {
    log_waters(rec, model)?;
    log_planned(rec, model)?;
    log_now(rec, model, ships, &["Own ship"])
}

/// Logs what does not depend on own ship: the axes, the sets, the desired motion, the targets.
pub fn log_waters(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    rec.log_static(VOLUME, &ViewCoordinates::RIGHT_HAND_Z_UP())?;
    log_axes(rec, canvas)?;
    for (kind, set, color) in shown_sets(canvas) {
        let entity = path(&[VOLUME, kind.folder, set.name()]);
        log_body(rec, canvas, entity, set, (color, kind.alpha))?;
    }
    log_expected(rec, canvas)
}

/// Logs the sea at t = 0 as a grid, and the time axis with its ticks.
fn log_axes(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    let mut lines = Lines::default();
    for ends in grid_lines(canvas, &canvas.bounds) {
        let ends = ends.map(|end| canvas.lifted(end, 0.0));
        lines.add(ends, style::GRID, 0.5);
    }
    let text = style::CHART_TEXT;
    let axis = axis_corner(canvas);
    let axis_line = [0.0, canvas.end].map(|t| canvas.lifted(axis, t));
    lines.add(axis_line, text, 1.0);
    let mut places = Vec::new();
    let mut labels = Vec::new();
    for time in multiples(0.0, canvas.end, 2.0 * mark_step(canvas)) {
        places.push(canvas.lifted(axis, time));
        labels.push(clock(time));
    }
    let (high, middle) = (canvas.bounds.high, canvas.bounds.center());
    for (place, name) in [
        (Vector::new(high.x, middle.y), "E"),
        (Vector::new(middle.x, high.y), "N"),
    ] {
        places.push(canvas.lifted(place, 0.0));
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

/// Where the time axis is: on the far side as seen by the eye, at the end where own ship starts.
fn axis_corner(canvas: &Canvas) -> Vector {
    let Window { low, high } = canvas.bounds;
    let ahead = canvas.ahead();
    let beside = to_port(ahead) - ahead;
    let corner = |along: f64, low: f64, high: f64| if along < 0.0 { low } else { high };
    Vector::new(
        corner(beside.x, low.x, high.x),
        corner(beside.y, low.y, high.y),
    )
}

/// Logs the translucent body of a set, and some of its sections.
pub fn log_body(
    rec: &mut Recorder,
    canvas: &Canvas,
    entity: rerun::EntityPath,
    set: &Obstacle,
    (color, alpha): (Color, u8),
) -> Logged {
    let body = mesh(canvas, set).with_albedo_factor(style::translucent(color, alpha).0);
    let strength = 0.3 + f32::from(alpha) / 100.0;
    let faint = style::toward_background(color, strength);
    let mut lines = Lines::default();
    for time in [0.0, 0.25, 0.5, 0.75, 1.0].map(|f| f * canvas.end) {
        let section = set.outer_section(time);
        let ring = section.vertices().iter().chain(section.vertices().first());
        let ring = ring.map(|point| canvas.lifted(*point, time));
        lines.add(ring.collect::<Vec<_>>(), faint, 0.6);
    }
    let lines = lines.archetype();
    let parts: [&dyn AsComponents; 2] = [&body, &lines];
    rec.log_static(entity, &parts)
}

/// Directions in which the extreme points of a section are corners of the mesh.
const SIDES: usize = 48;

/// Sections between the start and the end, as an ellipsoid does not grow on straight lines.
const STEPS: usize = 8;

/// Times of the sections that the mesh joins, seconds.
fn times(canvas: &Canvas, set: &Obstacle) -> Vec<f64> {
    let step = canvas.end / STEPS as f64;
    let mut times: Vec<f64> = (0..=STEPS).map(|k| step * k as f64).collect();
    let starts = set.slabs().iter().map(|slab| slab.start());
    times.extend(starts.filter(|start| *start > 0.0 && *start < canvas.end));
    times.sort_by(f64::total_cmp);
    times
}

/// The body from t = 0 to the end, with the last section on top.
fn mesh(canvas: &Canvas, set: &Obstacle) -> Mesh3D {
    let normals = (0..SIDES).map(|k| direction(TAU * k as f64 / SIDES as f64));
    let normals: Vec<Vector> = normals.collect();
    let times = times(canvas, set);
    let (mut corners, mut shades) = (Vec::new(), Vec::new());
    for &time in &times {
        let section = set.outer_section(time);
        let extreme = |n: &Vector| {
            let points = section.vertices().iter().copied();
            points.max_by(|a, b| n.dot(a).total_cmp(&n.dot(b)))
        };
        let ring = normals.iter().filter_map(extreme);
        corners.extend(ring.map(|point| canvas.lifted(point, time)));
        shades.extend(normals.iter().map(|n| [n.x as f32, n.y as f32, 0.0]));
    }
    let sides = SIDES as u32;
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for base in (1..times.len() as u32).map(|layer| (layer - 1) * sides) {
        for i in 0..sides {
            let (here, next) = (base + i, base + (i + 1) % sides);
            triangles.push([here, next, next + sides]);
            triangles.push([here, next + sides, here + sides]);
        }
    }
    let top = (times.len() as u32 - 1) * sides;
    triangles.extend((2..sides).map(|i| [top, top + i - 1, top + i]));
    Mesh3D::new(corners)
        .with_vertex_normals(shades)
        .with_triangle_indices(triangles)
}

fn log_planned(rec: &mut Recorder, model: &ViewModel) -> Logged {
    if !model.motion.is_planned() {
        return Ok(());
    }
    let mut lines = Lines::default();
    let shadow = style::toward_background(style::OWN_SHIP, SHADOW);
    for (pace, points) in planned_strips(model) {
        let risen = points.iter().map(|&(p, t)| model.lifted(p, t));
        lines.add(risen.collect::<Vec<_>>(), pace.color(), 2.0);
        let fallen = points.iter().map(|&(p, _)| model.lifted(p, 0.0));
        lines.add(fallen.collect::<Vec<_>>(), shadow, 0.8);
    }
    rec.log_static(path(&[VOLUME, "planned"]), &lines.archetype())
}

fn log_expected(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    let desired = &canvas.scenario.desired;
    let mut lines = Lines::default();
    let mut strip: Vec<_> = desired
        .legs()
        .iter()
        .map(|l| canvas.lifted(l.start, l.start_time))
        .collect();
    strip.push(canvas.lifted(desired.end(), desired.duration()));
    lines.add(strip, style::DESIRED, 0.9);
    rec.log_static(path(&[VOLUME, "desired"]), &lines.archetype())?;
    if canvas.scenario.targets.is_empty() {
        return Ok(());
    }
    let mut lines = Lines::default();
    for (index, target) in canvas.scenario.targets.iter().enumerate() {
        let times = canvas.joints(target).into_iter();
        let strip = times.map(|t| canvas.lifted(target.position_at(t), t));
        lines.add(strip.collect::<Vec<_>>(), canvas.target_color(index), 1.0);
    }
    rec.log_static(path(&[VOLUME, "targets"]), &lines.archetype())
}

/// Logs the plane of the cursor with the ships in it. `own` are the names of own ships.
pub fn log_now(rec: &mut Recorder, canvas: &Canvas, ships: &Ships, own: &[&str]) -> Logged {
    let Window { low, high } = canvas.bounds;
    let frame = [
        [low.x, low.y],
        [high.x, low.y],
        [high.x, high.y],
        [low.x, high.y],
        [low.x, low.y],
    ]
    .map(|[east, north]| canvas.lifted(Vector::new(east, north), 0.0));
    let frame = LineStrips3D::new([frame])
        .with_colors([style::toward_background(style::OWN_SHIP, 0.5)])
        .with_radii([style::points(0.6)]);
    let others = canvas.scenario.targets.iter().map(|t| t.name.as_str());
    let names = own.iter().copied().chain(others);
    let points = Points3D::update_fields()
        .with_colors(ships.colors.iter().copied())
        .with_radii([style::points(5.0)])
        .with_labels(names)
        // more names would overlap: they are shown when one is pointed at
        .with_show_labels(ships.colors.len() <= 2);
    let entity = path(&[VOLUME, "now"]);
    let style: [&dyn AsComponents; 2] = [&frame, &points];

    let plane = |time: f64| canvas.lifted(Vector::zeros(), time);
    let rises = Transform3D::update_fields()
        .with_many_translation(canvas.cursor_times.iter().map(|&t| plane(t)))
        .columns_of_unit_batches()?;
    let (places, lengths) = ships.places();
    let moves = Points3D::update_fields()
        .with_positions(places.map(|p| canvas.lifted(p, 0.0)))
        .columns(lengths)?;
    let columns = rises.chain(moves);
    rec.log_moving(entity, canvas.cursor_column(), &style, columns)
}
