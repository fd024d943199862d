//! The closed loop on the chart, and its curves.

use rerun::components::InterpolationMode::Linear;
use rerun::{LineStrips2D, Points2D, TimeColumn};

use super::chart::{self, Strip};
use super::curves::{self, CLEARANCE, Series};
use super::ships::{self, outline};
use crate::colregs::SteadyShip;
use crate::geometry::ConvexPolygon;
use crate::recording::canvas::{AssumedTarget, ClosedLoop, clock, flat, labelled, style};
use crate::recording::write::Recorder;
use crate::recording::{Logged, MAP, TIMELINE, TRAILS, path};

pub const OFF_PLAN: &str = "curves/off_plan_m";
pub const PLANNING: &str = "curves/planning_ms";

pub fn log_chart(rec: &mut Recorder, model: &ClosedLoop) -> Logged {
    chart::log_sea(rec, &model.canvas)?;
    log_plans(rec, model)?;
    log_assumed(rec, model)?;
    log_ships(rec, model)?;
    log_contacts(rec, model)
}

fn log_plans(rec: &mut Recorder, model: &ClosedLoop) -> Logged {
    let (mut lines, mut colors, mut radii) = (Vec::<Strip>::new(), Vec::new(), Vec::new());
    let mut lengths = Vec::new();
    for plan in &model.plans {
        let strips = chart::joined(chart::segment_strips(&model.canvas, &plan.segments));
        lengths.push(strips.len());
        for (pace, points) in strips {
            lines.push(points.into_iter().map(|(place, _)| flat(place)).collect());
            colors.push(pace.color());
            radii.push(style::points(pace.radius()));
        }
    }
    let columns = LineStrips2D::update_fields()
        .with_strips(lines)
        .with_colors(colors)
        .with_radii(radii)
        .columns(lengths)?;
    let times = model.plans.iter().map(|plan| plan.from);
    let times = TimeColumn::new_duration_secs(TIMELINE, times);
    rec.send_columns(path(&[MAP, "planned"]), Some(times), columns)
}

/// Logs the targets as the plan at the cursor assumes them: their hulls and their hard sets.
fn log_assumed(rec: &mut Recorder, model: &ClosedLoop) -> Logged {
    let targets = &model.simulation.targets;
    let names = targets.iter().map(|target| target.name.as_str());
    let colors = (0..targets.len()).map(style::target);
    let sets = ships::set_style(style::CHART_TEXT, ships::HARD_RADIUS)
        .with_colors(colors)
        .with_labels(names.clone())
        .with_show_labels(false);
    let assumed = |at: fn(&AssumedTarget, f64) -> ConvexPolygon| {
        move |time: f64| {
            let plan = model.plan_at(time)?;
            let targets = plan.targets.iter();
            let polygons = targets.map(|target| at(target, time - plan.from));
            Some(polygons.map(|polygon| outline(&polygon)).collect())
        }
    };
    let hard = assumed(AssumedTarget::hard_at);
    log_strips(rec, model, "hard_sets", &sets, hard)?;
    let hulls = ships::set_style(style::DESIRED, 1.0)
        .with_labels(names.map(|name| format!("{name}, estimate")))
        .with_show_labels(false);
    let estimates = assumed(AssumedTarget::hull_at);
    log_strips(rec, model, "estimates", &hulls, estimates)
}

/// Logs the true ships: hulls with speed vectors, names, and a dot per ship and cursor time.
fn log_ships(rec: &mut Recorder, model: &ClosedLoop) -> Logged {
    let (canvas, targets) = (&model.canvas, &model.simulation.targets);
    let colors: Vec<_> = std::iter::once(style::OWN_SHIP)
        .chain((0..targets.len()).map(style::target))
        .collect();
    let ships = |time: f64| -> Option<Vec<(SteadyShip, ConvexPolygon)>> {
        let own = model.own_at(time);
        let hull = canvas.scenario.own_ship.hull.polygon(&own.pose);
        let others = targets.iter().map(|target| {
            let ship = target.at(time)?;
            Some((ship, target.outline(&ship.pose)?))
        });
        std::iter::once(Some((own, hull))).chain(others).collect()
    };
    let style = LineStrips2D::update_fields()
        .with_colors(colors.iter().flat_map(|color| [*color; 2]))
        .with_radii([style::points(1.2), style::points(0.8)].repeat(colors.len()));
    let seconds = ships::vector_seconds(canvas);
    log_strips(rec, model, "ships", &style, |time| {
        let drawn = ships(time)?.into_iter().flat_map(|(ship, outlined)| {
            let tip = ship.pose.position + ship.velocity() * seconds;
            let vector = [ship.pose.position, tip].map(flat);
            [outline(&outlined), vector.to_vec()]
        });
        Some(drawn.collect())
    })?;
    let places = |offset| {
        let ships = canvas
            .cursor_times
            .iter()
            .filter_map(|&time| ships(time))
            .flatten();
        let places = ships.map(move |(ship, _)| flat(ship.pose.position + offset));
        let rows = canvas.cursor_times.len();
        Points2D::update_fields()
            .with_positions(places)
            .columns(vec![colors.len(); rows])
    };
    let names = targets.iter().map(|target| target.name.as_str());
    let names = Points2D::update_fields()
        .with_colors(colors.iter().copied())
        .with_radii([style::points(0.0)])
        .with_labels(std::iter::once("Own ship").chain(names))
        .with_show_labels(true);
    let columns = places(ships::label_offset(canvas))?;
    let times = canvas.cursor_column();
    rec.log_moving(path(&[MAP, "names"]), times, &names, columns)?;
    let dots = Points2D::update_fields()
        .with_colors(colors.iter().copied())
        .with_radii([style::points(2.0)]);
    let columns = places(crate::frame::Vector::zeros())?;
    rec.log_moving(path(&[TRAILS]), canvas.cursor_column(), &dots, columns)
}

fn log_contacts(rec: &mut Recorder, model: &ClosedLoop) -> Logged {
    for target in &model.simulation.targets {
        let Some(time) = target.contact_t_s else {
            continue;
        };
        let place = flat(model.own_at(time).pose.position);
        let label = format!("contact with {} at {}", target.name, clock(time));
        let mark = labelled([place], style::ALARM, 6.0, [label]);
        let times = TimeColumn::new_duration_secs(TIMELINE, [time]);
        let entity = path(&[MAP, "contacts", &target.name]);
        rec.send_columns(entity, Some(times), mark.columns_of_unit_batches()?)?;
    }
    Ok(())
}

/// Logs lines at every cursor time; none where `at` has none.
fn log_strips(
    rec: &mut Recorder,
    model: &ClosedLoop,
    entity: &str,
    style: &LineStrips2D,
    at: impl Fn(f64) -> Option<Vec<Strip>>,
) -> Logged {
    let times = model.canvas.cursor_times.iter();
    let rows: Vec<Vec<Strip>> = times.map(|&time| at(time).unwrap_or_default()).collect();
    let lengths: Vec<usize> = rows.iter().map(Vec::len).collect();
    let columns = LineStrips2D::update_fields()
        .with_strips(rows.into_iter().flatten())
        .columns(lengths)?;
    let times = model.canvas.cursor_column();
    rec.log_moving(path(&[MAP, entity]), times, style, columns)
}

pub fn log_curves(rec: &mut Recorder, model: &ClosedLoop) -> Logged {
    let (canvas, simulation) = (&model.canvas, model.simulation);
    let mut log = |entity: &str, times: &[f64], series: &[Series]| {
        curves::log_plot(rec, path(&[entity]), times, Linear, series)
    };
    let mut series = Vec::new();
    for (index, target) in model.simulation.targets.iter().enumerate() {
        let distances = canvas
            .samples
            .iter()
            .map_while(|&time| model.clearance(target, time));
        let (color, distances) = (style::target(index), distances.collect());
        series.push(Series::new(&target.name, color, 2.0, distances));
    }
    if !series.is_empty() {
        // own ship keeps its margin from hulls, and nothing from explicit sets
        if model.simulation.targets.iter().any(|t| t.set_m.is_none()) {
            series.push(curves::safety_margin(canvas));
        }
        log(CLEARANCE, &canvas.samples, &series)?;
    }
    let off = canvas
        .samples
        .iter()
        .filter_map(|&time| Some((time, model.off_plan(time)?)));
    // below a micrometre it is rounding
    let off = off.map(|(time, metres)| (time, (metres * 1e6).round() / 1e6));
    let (times, off): (Vec<f64>, Vec<f64>) = off.unzip();
    let margin = vec![canvas.scenario.own_ship.tracking_margin; off.len()];
    let off = Series::new("off the plan", style::OWN_SHIP, 2.0, off);
    let margin = Series::new("tracking margin", style::ALARM, 1.0, margin);
    log(OFF_PLAN, &times, &[off, margin])?;
    let times: Vec<f64> = simulation.replans.iter().map(|replan| replan.t_s).collect();
    let milliseconds = simulation.timing.plan_s.iter().map(|s| s * 1e3);
    let planning = Series::new("planning", style::OWN_SHIP, 2.0, milliseconds.collect());
    log(PLANNING, &times, &[planning])
}
