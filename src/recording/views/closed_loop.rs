//! The closed loop on the chart, and its curves.

use rerun::components::InterpolationMode::Linear;
use rerun::{Color, LineStrips2D, Points2D, TimeColumn};

use super::chart::{self, Strip};
use super::closest::{self, Approach};
use super::curves::{self, CLEARANCE, Series};
use super::rules::{self, Judged};
use super::ships::{self, Sighted, outline};
use crate::geometry::ConvexPolygon;
use crate::recording::canvas::{AssumedTarget, ClosedLoop, Labels, flat, labelled, style};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, MAP, TIMELINE, TRAILS, path};
use crate::text::{clock, tenths};

pub const OFF_PLAN: &str = "curves/off_plan_m";
pub const PLANNING: &str = "curves/planning_ms";

pub fn log_chart(rec: &mut Recorder, model: &ClosedLoop, judged: &[Judged]) -> Logged {
    chart::log_sea(rec, &model.canvas)?;
    log_plans(rec, model)?;
    log_assumed(rec, model)?;
    log_ships(rec, model)?;
    log_contacts(rec, model)?;
    let mut labels = chart::labels(&model.canvas);
    let times = model.canvas.cursor_times.iter();
    let own = times.clone().map(|&t| model.own_at(t).0.position);
    labels.keep_off_track(model.canvas.scenario.own_ship.hull.beam, own);
    for target in &model.simulation.targets {
        let beam = target.set_m.as_ref().map_or(target.beam_m, |_| 0.0);
        let ships = times.clone().filter_map(|&time| target.at(time));
        labels.keep_off_track(beam, ships.map(|ship| ship.pose.position));
    }
    let ships = |time| sighted(model, time);
    closest::log_closest(rec, &model.canvas, &mut labels, &approaches(model), ships)?;
    let broken = model.simulation.conduct.breaks.iter();
    let broken: Vec<&str> = broken.map(String::as_str).collect();
    rules::add_broken(&mut labels, (!judged.is_empty()).then_some(&broken[..]));
    log_names(rec, model, &labels, judged)?;
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
fn approaches(model: &ClosedLoop) -> Vec<Approach> {
    let targets = model.simulation.targets.iter().enumerate();
    let approach = targets.filter_map(|(index, target)| {
        let time = target.contact_t_s.unwrap_or(target.least_clearance_t_s);
        let ships = sighted(model, time)?;
        let apart = target
            .least_clearance_m
            .filter(|_| target.contact_t_s.is_none());
        let apart = apart.unwrap_or(f64::NAN);
        let pair = [&ships[0], &ships[index + 1]];
        Some(Approach::new(
            &target.name,
            (time, apart),
            pair,
            style::target(index),
        ))
    });
    approach.collect()
}

/// Logs the names of the targets with own ship's roles, and at own ship how close it has come.
fn log_names(rec: &mut Recorder, model: &ClosedLoop, labels: &Labels, judged: &[Judged]) -> Logged {
    let targets = &model.simulation.targets;
    let least_until = model.least_until();
    let own = |time: f64| {
        let begun = least_until.partition_point(|(at, _)| *at <= time);
        match least_until[..begun].last() {
            Some((_, least)) => format!("Own ship\nclosest so far {} m", tenths(*least)),
            None => "Own ship".to_owned(),
        }
    };
    let text = |index: usize, time: f64| match index.checked_sub(1) {
        None => own(time),
        Some(index) => rules::name_with_role(judged, &targets[index].name, time),
    };
    let colors = colors(targets.len());
    let ships = |time| sighted(model, time);
    ships::log_names(rec, &model.canvas, labels, (0, &colors), ships, text)
}

/// The colours of own ship and of the targets.
fn colors(targets: usize) -> Vec<Color> {
    std::iter::once(style::OWN_SHIP)
        .chain((0..targets).map(style::target))
        .collect()
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

/// Logs the true ships: speed vectors, hulls and symbols, and a dot per ship and cursor time.
fn log_ships(rec: &mut Recorder, model: &ClosedLoop) -> Logged {
    let canvas = &model.canvas;
    let drawn = |ship: &Sighted| -> Vec<Strip> {
        std::iter::once(ship.vector())
            .chain(ship.strips())
            .collect()
    };
    let colors = colors(model.simulation.targets.len());
    let lines = sighted(model, 0.0).unwrap_or_default();
    let lines = lines.iter().map(|ship| drawn(ship).len());
    let each = colors
        .iter()
        .zip(lines)
        .flat_map(|(color, lines)| vec![*color; lines]);
    let style = ships::set_style(style::OWN_SHIP, 1.0).with_colors(each);
    log_strips(rec, model, "ships", &style, |time| {
        Some(sighted(model, time)?.iter().flat_map(drawn).collect())
    })?;
    let dots = Points2D::update_fields()
        .with_colors(colors)
        .with_radii([style::points(2.0)]);
    let times = canvas.cursor_times.iter();
    let ships: Vec<Vec<Sighted>> = times
        .map(|&t| sighted(model, t).unwrap_or_default())
        .collect();
    let lengths: Vec<usize> = ships.iter().map(Vec::len).collect();
    let columns = Points2D::update_fields()
        .with_positions(ships.iter().flatten().map(|ship| flat(ship.place)))
        .columns(lengths)?;
    rec.log_moving(path(&[TRAILS]), canvas.cursor_column(), &dots, columns)
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
