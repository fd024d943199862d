//! Writes a comparison as one recording: every motion on the chart and in the volume, in one colour
//! each.

use std::path::Path;

use rerun::{Color, EntityPath, LineStrips3D};

use super::{RecordingError, put};
use crate::obstacle::SpaceTimeObstacle;
use crate::pipeline::{self, Run, TargetSets};
use crate::recording::canvas::{Canvas, Palette, ShownMotion, flat, lines, style};
use crate::recording::recorder::Recorder;
use crate::recording::views::chart;
use crate::recording::views::curves::{self, CLEARANCE, Plot, Series};
use crate::recording::views::explored::log_explored;
use crate::recording::views::ships::{self, DrawnShip, Ships};
use crate::recording::views::{land, space_time};
use crate::recording::{COMPARISON, EXPLORED, Logged, MAP, SUMMARY, VOLUME, layout, path};
use crate::scenario::Scenario;
use crate::study::compare::{Entry, Method, Stroke};

const METHODS: &str = "methods";

/// See [`Canvas::pane`].
const PANE: [f64; 2] = [640.0, 425.0];

/// Radius on the screen for one pixel of a figure's line.
const RADIUS: f64 = 0.6;

/// Radius in the volume, where lines lie behind one another.
const VOLUME_RADIUS: f32 = 0.9;

/// Greatest width of a curve, pixels: the plots are low.
const WIDEST: f32 = 3.0;

/// Strength of the colour of the last risk of a sweep, of 1.
const WEAKEST: f32 = 0.45;

/// Strength of a method's colour for the sets that it avoids, of 1.
const SET_STRENGTH: f32 = 0.7;

/// Draw order above sets and tracks.
const FIRST_ORDER: f32 = 30.0;

/// A comparison of one scenario, with the texts of its recording.
#[derive(Debug, Clone, Copy)]
pub struct Compared<'a> {
    /// The scenario.
    pub scenario: &'a Scenario,
    /// The methods and their results, in the order of the rows.
    pub entries: &'a [Entry],
    /// The rows as markdown, without the time that planning took, so that recordings of one
    /// comparison are alike.
    pub table: &'a str,
    /// The document of the comparison: [`crate::recording::Recorded::comparison`] gives it back.
    pub document: &'a str,
}

/// Writes a comparison as one recording, in full or not at all, as [`super::write`] does a run.
///
/// # Examples
///
/// ```
/// use searoom::study::compare::{Candidate, Method};
/// use searoom::recording::{Compared, Recorded, write_comparison};
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// let entries = [Candidate { method: Method::HoldCourse, max_risk: 0.0 }.run(&scenario)];
/// # let folder = tempfile::tempdir()?;
/// let file = folder.path().join("compared.rrd");
/// let (table, document) = ("hold course", "{}");
/// let compared = Compared { scenario: &scenario, entries: &entries, table, document };
/// write_comparison(&compared, &file)?;
/// assert_eq!(Recorded::read(&file)?.comparison().as_deref(), Some("{}"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn write_comparison(compared: &Compared, path: &Path) -> Result<(), RecordingError> {
    let title = &compared.scenario.title;
    put(path, title, (COMPARISON, compared.document), |rec| {
        log(rec, compared)
    })
}

struct Candidate<'a> {
    entry: &'a Entry,
    own: DrawnShip<'a>,
    style: Stroke,
}

fn log(rec: &mut Recorder, compared: &Compared) -> Logged<Recorder> {
    let Compared {
        scenario, entries, ..
    } = *compared;
    let candidates = candidates(entries);
    let sets = pipeline::sets(scenario);
    let is_plan = |c: &&Candidate| matches!(c.entry.candidate.method, Method::Planner { .. });
    let plans: Vec<ShownMotion> = candidates
        .iter()
        .filter(is_plan)
        .map(|c| c.own.motion)
        .collect();
    // baselines go on to the horizon, far away
    let end = plans.iter().map(ShownMotion::end).fold(0.0, f64::max);
    let end = end.max(scenario.desired.duration()).min(scenario.horizon);
    let canvas = Canvas::new(scenario, &sets, &plans, end, (Palette::OwnShips, PANE));

    let own: Vec<DrawnShip> = candidates.iter().map(|c| c.own.clone()).collect();
    let names: Vec<&str> = own.iter().map(|own| own.name.as_str()).collect();
    let ships = &Ships::expected(&canvas, &own);
    land::log_land(rec, &canvas)?;
    chart::log_waters(rec, &canvas)?;
    ships::log_others(rec, &canvas)?;
    ships::log_trails(rec, &canvas, ships, ships::TRAIL_RADIUS)?;
    // names of own ships are shown where they are pointed at
    let labels = chart::labels(&canvas);
    ships::log_names(rec, &canvas, &labels, (own.len(), ships), |index, _| {
        scenario.targets[index - own.len()].name.clone()
    })?;
    space_time::log_waters(rec, &canvas)?;
    space_time::log_now(rec, &canvas, ships, &names)?;
    let mut graphs = Vec::new();
    for (index, candidate) in candidates.iter().enumerate() {
        // the first row on top
        let order = (candidates.len() - index) as f32;
        log_way(rec, &canvas, candidate, order)?;
        let name = candidate.own.name.as_str();
        let ship = path(&[MAP, METHODS, name, "own_ship"]);
        ships::log_own_ship(rec, &canvas, ship, &candidate.own)?;
        let Some(run) = &candidate.entry.run else {
            continue;
        };
        if has_sets_of_its_own(run, &sets) {
            log_kept_out_of(rec, &canvas, candidate, run)?;
        }
        let folders = [path(&[EXPLORED, name]), path(&[VOLUME, "explored", name])];
        let drawn = log_explored(rec, &canvas, run, &folders)?;
        if drawn.edges > 0 {
            graphs.push(format!("{name} {} of {} edges", drawn.edges, drawn.tested));
        }
    }
    let plots = plots(&canvas, &candidates);
    curves::log_plots(rec, &plots)?;
    rec.log_markdown(SUMMARY, text(compared.table, &graphs))?;
    layout::of_comparison(&canvas, &plots)
}

/// The entries with a motion. In a sweep a method keeps its colour, weaker with more risk.
fn candidates(entries: &[Entry]) -> Vec<Candidate<'_>> {
    let risks = |method: Method| {
        let of_method = entries.iter().filter(move |e| e.candidate.method == method);
        of_method.map(|e| e.candidate.max_risk)
    };
    let sailing = entries.iter().filter_map(|entry| {
        let motion = ShownMotion::Planned(entry.trajectory()?);
        let candidate = entry.candidate;
        let style = Stroke::of(candidate.method);
        let all: Vec<f64> = risks(candidate.method).collect();
        let place = all.iter().position(|r| *r == candidate.max_risk);
        let share = place.unwrap_or(0) as f32 / (all.len().max(2) - 1) as f32;
        let [r, g, b] = style.rgb();
        let color = Color::from_rgb(r, g, b);
        let name = if all.len() > 1 {
            format!("{} at risk {}", entry.name(), candidate.max_risk)
        } else {
            entry.name()
        };
        let own = DrawnShip {
            motion,
            name,
            color: style::toward_background(color, 1.0 - share * (1.0 - WEAKEST)),
        };
        Some(Candidate { entry, own, style })
    });
    sailing.collect()
}

/// True where a method avoids sets that are not those of the scenario: ellipses around them, or
/// level sets of a risk that it accepts.
fn has_sets_of_its_own(run: &Run, sets: &[TargetSets]) -> bool {
    let mut both = run.obstacles().zip(sets);
    both.any(|(kept, sets)| *kept != sets.hard && *kept != sets.with_domain)
}

/// Logs the sets that a method avoids, in its colour: outlines on the chart, bodies in the volume.
fn log_kept_out_of(
    rec: &mut Recorder,
    canvas: &Canvas,
    candidate: &Candidate,
    run: &Run,
) -> Logged {
    let DrawnShip { name, color, .. } = &candidate.own;
    let faint = style::toward_background(*color, SET_STRENGTH);
    for set in run.obstacles() {
        let below = |view: &str| path(&[view, METHODS, name, "sets", set.name()]);
        let style = lines(faint, ships::DOMAIN.radius)
            .with_labels([format!("{name} avoids: {}", set.name())])
            .with_show_labels(false);
        ships::log_sections(rec, canvas, below(MAP), set, &style)?;
        let style = (*color, ships::DOMAIN.alpha);
        space_time::log_body(rec, canvas, below(VOLUME), set, style)?;
    }
    Ok(())
}

fn log_way(rec: &mut Recorder, canvas: &Canvas, candidate: &Candidate, order: f32) -> Logged {
    let Candidate { own, style, .. } = candidate;
    let ShownMotion::Planned(trajectory) = own.motion else {
        return Ok(());
    };
    let strips = chart::strips(canvas, trajectory).into_iter();
    let line = chart::one_line(strips.map(|(_, strip)| strip));
    let entity = |view: &str| -> EntityPath { path(&[view, METHODS, &own.name, "way"]) };
    let on_chart = lines(own.color, (RADIUS * style.width) as f32)
        .with_strips([line.iter().map(|&(p, _)| flat(p))])
        .with_labels([own.name.as_str()])
        .with_show_labels(false)
        .with_draw_order(FIRST_ORDER + order);
    rec.log_static(entity(MAP), &on_chart)?;
    let in_volume = LineStrips3D::new([line.iter().map(|&(p, t)| canvas.lifted(p, t))])
        .with_colors([own.color])
        .with_radii([style::points(VOLUME_RADIUS)])
        .with_labels([own.name.as_str()])
        .with_show_labels(false);
    rec.log_static(entity(VOLUME), &in_volume)
}

/// Plots of the distance from the nearest target that keeps course and speed, and of the speed.
fn plots(canvas: &Canvas, candidates: &[Candidate]) -> Vec<Plot> {
    let series = |c: &Candidate, values: Vec<f64>| {
        let width = (c.style.width as f32).min(WIDEST);
        Series::new(&c.own.name, c.own.color, width, values)
    };
    let mut plots = Vec::new();
    let targets = &canvas.scenario.targets;
    if !targets.is_empty() {
        let nearest = |c: &Candidate| -> Vec<f64> {
            let all = targets
                .iter()
                .map(|t| curves::clearances(canvas, &c.own.motion, t));
            let nearer =
                |a: Vec<f64>, b: Vec<f64>| a.iter().zip(&b).map(|(a, b)| a.min(*b)).collect();
            all.reduce(nearer).unwrap_or_default()
        };
        let mut curves: Vec<Series> = candidates.iter().map(|c| series(c, nearest(c))).collect();
        curves.push(curves::safety_margin(canvas));
        let title = "Distance from the nearest target (m)";
        // each ends with its motion
        plots.push(Plot {
            apart: true,
            ..Plot::new(title, CLEARANCE, &canvas.samples, curves)
        });
    }
    let times = curves::step_times(canvas, candidates.iter().map(|c| &c.own.motion));
    let speed = |c: &Candidate| series(c, curves::speeds(&c.own.motion, &times));
    plots.push(Plot::of_speeds(
        &times,
        candidates.iter().map(speed).collect(),
    ));
    plots
}

fn text(table: &str, graphs: &[String]) -> String {
    let key = "The plots name the colours; point at a line for its name. Grey sets are those of \
               the scenario. A method that avoids others (ellipses around them, level sets of an \
               accepted risk) has them in its colour.";
    let mut parts = vec![table.to_owned(), key.to_owned()];
    if !graphs.is_empty() {
        parts.push(format!(
            "Explored graphs are hidden, under `explored` on the chart and in the volume ({}). \
             Point at a blocked edge for what it meets, when, and by which rule or limit.",
            graphs.join("; ")
        ));
    }
    parts.join("\n\n")
}
