//! The closed loop on the chart, and its curves.

use rerun::{LineStrips2D, TimeColumn};

use super::chart;
use super::closest::{self, Passage};
use super::curves::{self, CLEARANCE, Plot, Series};
use super::rules::{self, Judged};
use super::ships::{self, Ships, Sighted, outline};
use crate::geometry::ConvexPolygon;
use crate::recording::canvas::{
    AssumedTarget, ClosedLoop, Strip, flat, labelled, lines, strip_columns, style,
};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, MAP, TIMELINE, path};
use crate::text::{clock, tenths};

pub fn log_chart(rec: &mut Recorder, model: &ClosedLoop, judged: &[Judged]) -> Logged {
    let own = [style::OWN_SHIP];
    let ships = &Ships::new(&model.canvas, own, |time| sighted(model, time));
    chart::log_sea(rec, &model.canvas)?;
    log_plans(rec, model)?;
    log_assumed(rec, model)?;
    log_ships(rec, model, ships)?;
    log_contacts(rec, model)?;
    let mut labels = chart::labels(&model.canvas);
    ships.keep_off(&mut labels);
    closest::log_closest(rec, &model.canvas, &mut labels, ships, &passages(model))?;
    let broken = model.simulation.conduct.breaks.iter();
    let broken: Vec<&str> = broken.map(String::as_str).collect();
    rules::add_broken(&mut labels, (!judged.is_empty()).then_some(&broken[..]));
    let least_until = model.least_until();
    let own = |time: f64| {
        let begun = least_until.partition_point(|(at, _)| *at <= time);
        match least_until[..begun].last() {
            Some((_, least)) => format!("Own ship\nclosest so far {} m", tenths(*least)),
            None => "Own ship".to_owned(),
        }
    };
    ships::log_names_with_roles(rec, &model.canvas, &labels, ships, own, judged)?;
    labels.log(rec)
}

/// The targets with own ship's roles toward them, and what the judges say of what was sailed.
pub fn judged<'a>(model: &ClosedLoop<'a>) -> Vec<Judged<'a>> {
    let targets = model.simulation.targets.iter().enumerate();
    let ships = targets.filter(|(_, target)| target.set_m.is_none());
    let judged = ships.map(|(index, target)| Judged {
        target: &target.name,
        color: style::target(index),
        roles: model.roles(&target.name),
        desired: model.desired_role(&target.name),
        conduct: Some(&target.conduct),
    });
    judged.collect()
}

/// Own ship and the targets at a time, as they were; `None` where one of them has no track.
fn sighted(model: &ClosedLoop, time: f64) -> Option<Vec<Sighted>> {
    let canvas = &model.canvas;
    let own = Sighted::ship(canvas, &canvas.scenario.own_ship.hull, model.own_at(time));
    let targets = model.simulation.targets.iter();
    let targets = targets.map(|target| {
        let ship = target.at(time)?;
        match target.set_m {
            None => Some(Sighted::ship(
                canvas,
                &target.hull(),
                (ship.pose, ship.velocity()),
            )),
            Some(_) => Some(Sighted::set(
                ship.pose.position,
                target.outline(&ship.pose)?,
            )),
        }
    });
    std::iter::once(Some(own)).chain(targets).collect()
}

/// The closest approaches of what was sailed.
fn passages<'a>(model: &ClosedLoop<'a>) -> Vec<Passage<'a>> {
    let targets = model.simulation.targets.iter();
    let passage = targets.map(|target| match target.contact_t_s {
        Some(time) => (&*target.name, time, f64::NAN),
        None => {
            let apart = target.least_clearance_m.unwrap_or(f64::NAN);
            (&*target.name, target.least_clearance_t_s, apart)
        }
    });
    passage.collect()
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
    let sets = lines(style::CHART_TEXT, ships::HARD.radius)
        .with_colors(colors)
        .with_labels(names.clone())
        .with_show_labels(false);
    let assumed = |at: fn(&AssumedTarget, f64) -> ConvexPolygon| {
        move |time: f64| {
            let targets = model.plan_at(time).into_iter().flat_map(|plan| {
                let since = time - plan.from;
                plan.targets.iter().map(move |target| at(target, since))
            });
            targets.map(|polygon| outline(&polygon)).collect()
        }
    };
    let entity = |name: &str| path(&[MAP, name]);
    let hard = assumed(AssumedTarget::hard_at);
    ships::log_strips(rec, &model.canvas, entity("hard_sets"), &sets, hard)?;
    let hulls = lines(style::DESIRED, 1.0)
        .with_labels(names.map(|name| format!("{name}, estimate")))
        .with_show_labels(false);
    let estimates = assumed(AssumedTarget::hull_at);
    ships::log_strips(rec, &model.canvas, entity("estimates"), &hulls, estimates)
}

/// Radius of the dots of trails, points.
const TRAIL_RADIUS: f32 = 2.0;

/// Logs the true ships: speed vectors, hulls and symbols, and their trails.
fn log_ships(rec: &mut Recorder, model: &ClosedLoop, ships: &Ships) -> Logged {
    let drawn = |ship: &Sighted| -> Vec<Strip> {
        std::iter::once(ship.vector())
            .chain(ship.strips())
            .collect()
    };
    let rows = ships.rows.iter();
    let rows: Vec<Vec<Strip>> = rows
        .map(|row| row.iter().flat_map(drawn).collect())
        .collect();
    let colored = ships.colors.iter().zip(ships.rows.iter().flatten());
    let each = colored.flat_map(|(color, ship)| vec![*color; drawn(ship).len()]);
    let style = lines(style::OWN_SHIP, 1.0).with_colors(each);
    let times = model.canvas.cursor_column();
    rec.log_moving(path(&[MAP, "ships"]), times, &style, strip_columns(rows)?)?;
    ships::log_trails(rec, &model.canvas, ships, TRAIL_RADIUS)
}

fn log_contacts(rec: &mut Recorder, model: &ClosedLoop) -> Logged {
    for target in &model.simulation.targets {
        let Some(time) = target.contact_t_s else {
            continue;
        };
        let place = flat(model.own_at(time).0.position);
        let label = format!("contact with {} at {}", target.name, clock(time));
        // the closest approach names it
        let mark = labelled([place], style::ALARM, 6.0, [label]).with_show_labels(false);
        let times = TimeColumn::new_duration_secs(TIMELINE, [time]);
        let entity = path(&[MAP, "contacts", &target.name]);
        rec.send_columns(entity, Some(times), mark.columns_of_unit_batches()?)?;
    }
    Ok(())
}

/// The plots, that of the hulls first if there is a target.
pub fn plots(model: &ClosedLoop) -> Vec<Plot> {
    let (canvas, simulation) = (&model.canvas, model.simulation);
    let mut plots = Vec::new();
    let targets = simulation.targets.iter().enumerate();
    let mut series: Vec<Series> = targets
        .map(|(index, target)| {
            let samples = canvas.samples.iter();
            let distances = samples.map_while(|&time| model.clearance(target, time));
            Series::new(&target.name, style::target(index), 2.0, distances.collect())
        })
        .collect();
    if !series.is_empty() {
        // own ship keeps its margin from hulls, and nothing from explicit sets
        if simulation.targets.iter().any(|t| t.set_m.is_none()) {
            series.push(curves::safety_margin(canvas));
        }
        let range = model.near_clearances();
        let title = range.map(|[_, top]| format!("Distance of the hulls up to {top} m"));
        let title = title.unwrap_or_default();
        plots.push(Plot {
            range,
            ..Plot::new(title, CLEARANCE, &canvas.samples, series)
        });
    }
    let samples = canvas.samples.iter();
    let off = samples.filter_map(|&time| Some((time, model.off_plan(time)?)));
    // below a micrometre it is rounding
    let off = off.map(|(time, metres)| (time, (metres * 1e6).round() / 1e6));
    let (times, off): (Vec<f64>, Vec<f64>) = off.unzip();
    let margin = vec![canvas.scenario.own_ship.tracking_margin; off.len()];
    let off = Series::new("off the plan", style::OWN_SHIP, 2.0, off);
    let margin = Series::new("tracking margin", style::ALARM, 1.0, margin);
    let title = "Distance off the plan (m)";
    plots.push(Plot::new(
        title,
        "curves/off_plan_m",
        &times,
        vec![off, margin],
    ));
    let times: Vec<f64> = simulation.replans.iter().map(|replan| replan.t_s).collect();
    let milliseconds = simulation.timing.plan_s.iter().map(|s| s * 1e3);
    let planning = Series::new("planning", style::OWN_SHIP, 2.0, milliseconds.collect());
    let title = "Time of planning (ms)";
    plots.push(Plot::new(
        title,
        "curves/planning_ms",
        &times,
        vec![planning],
    ));
    plots
}
