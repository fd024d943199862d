//! Candidates side by side → one recording: every motion on the chart and in the volume, one colour each, on one cursor.

use std::path::Path;

use rerun::components::InterpolationMode;
use rerun::{
    Color, EntityPath, LineStrips2D, LineStrips3D, MediaType, RecordingStreamResult, TextDocument,
};

use super::chart::{self, Key};
use super::curves::{self, CLEARANCE, SPEED, Series};
use super::explored::log_explored;
use super::movers::{self, OwnShip};
use super::recorder::Recorder;
use super::scene::{Hues, Motion, Stage, flat};
use super::{
    COMPARISON, Logged, MAP, RecordingError, SUMMARY, VOLUME, blueprint, land, path, put,
    space_time, style,
};
use crate::frame::{Vector, knots_from_mps};
use crate::obstacle::SpaceTimeObstacle;
use crate::pipeline::{self, Run, TargetSets};
use crate::scenario::Scenario;
use crate::study::compare::{Entry, EntryResult, LineStyle, Method};

/// The folder of the candidates, on the chart and in the volume.
const METHODS: &str = "methods";

/// Of the sea that is shown: the length of a dash.
const DASH: f64 = 1.0 / 60.0;

/// Points that the graph of one candidate may have.
const POINT_BUDGET: usize = 1200;

/// Keys in a row of the legend: their names are long.
const KEYS: usize = 3;

/// Radius on the screen for one pixel of a figure's line.
const RADIUS: f64 = 0.6;

/// On the screen, of a line that is wide on the chart, because it often lies under another.
const VOLUME_RADIUS: f32 = 0.7;

/// Pixels of a curve, at most: the plots are low.
const WIDEST: f32 = 3.0;

/// Of the colour: what the last risk of a sweep keeps.
const WEAKEST: f32 = 0.45;

/// A comparison of one scenario, with what stands in its recording as text.
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
/// let compared = Compared { scenario: &scenario, entries: &entries, table: "hold course", document: "{}" };
/// write_comparison(&compared, &file)?;
/// assert_eq!(Recorded::read(&file)?.comparison(), Some("{}"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Compared<'a> {
    /// What was asked.
    pub scenario: &'a Scenario,
    /// Who sailed, in the order of the rows.
    pub entries: &'a [Entry],
    /// The rows as markdown, without the time that planning took: recordings of one comparison are alike.
    pub table: &'a str,
    /// The document of the comparison: [`super::Recorded::comparison`] gives it back.
    pub document: &'a str,
}

/// Writes a comparison as one recording, in full or not at all, as [`super::write`] does a run. A candidate makes about
/// 60 kB.
pub fn write_comparison(compared: &Compared, path: &Path) -> Result<(), RecordingError> {
    let title = &compared.scenario.title;
    put(path, title, Some((COMPARISON, compared.document)), || {
        log(compared)
    })
}

/// One motion and what it looks like.
struct Candidate<'a> {
    entry: &'a Entry,
    own: OwnShip<'a>,
    look: LineStyle,
}

fn log(compared: &Compared) -> RecordingStreamResult<Logged> {
    let mut recording = Recorder::of_section(1);
    let rec = &mut recording;
    let Compared {
        scenario, entries, ..
    } = *compared;
    let candidates = candidates(entries);
    let sets = pipeline::sets(scenario);
    let is_plan = |c: &&Candidate| matches!(c.entry.candidate.method, Method::Planner { .. });
    let plans: Vec<Motion> = candidates
        .iter()
        .filter(is_plan)
        .map(|c| c.own.motion)
        .collect();
    // baselines go on to the horizon, and far away
    let end = plans.iter().map(Motion::end).fold(0.0, f64::max);
    let end = end.max(scenario.desired.duration()).min(scenario.horizon);
    let stage = Stage::new(scenario, &sets, &plans, end, Hues::OwnShips);

    let legend = legend(&stage, &candidates, &sets);
    let rows = legend.len().div_ceil(KEYS);
    let own: Vec<OwnShip> = candidates.iter().map(|c| c.own.clone()).collect();
    land::log_land(rec, &stage)?;
    chart::log_waters(rec, &stage)?;
    chart::log_legend(rec, &stage, legend, rows)?;
    movers::log_others(rec, &stage)?;
    movers::log_trails(rec, &stage, &own)?;
    space_time::log_waters(rec, &stage)?;
    space_time::log_now(rec, &stage, &own)?;
    let mut graphs = Vec::new();
    let mut hidden = [Vec::new(), Vec::new()];
    for (index, candidate) in candidates.iter().enumerate() {
        // the first row on top
        let order = (candidates.len() - index) as f32;
        log_way(rec, &stage, candidate, order)?;
        let ship = path(&[MAP, METHODS, &candidate.own.name, "own_ship"]);
        movers::log_own_ship(rec, &stage, ship, &candidate.own, false)?;
        let EntryResult::Planned(run) = &candidate.entry.result else {
            continue;
        };
        let folders =
            [MAP, VOLUME].map(|view| path(&[view, METHODS, &candidate.own.name, "explored"]));
        let folders_of_sets =
            [MAP, VOLUME].map(|view| path(&[view, METHODS, &candidate.own.name, "sets"]));
        log_kept_out_of(rec, &stage, candidate, run, &folders_of_sets)?;
        if !has_sets_of_its_own(run, &sets) {
            for (folders, folder) in hidden.iter_mut().zip(folders_of_sets) {
                folders.push(folder);
            }
        }
        let drawn = log_explored(rec, &stage, run, folders.clone(), POINT_BUDGET)?;
        if drawn.edges > 0 {
            let (name, shown, tested) = (&candidate.own.name, drawn.edges, drawn.tested);
            graphs.push(format!("{name} {shown} of {tested} edges"));
            for (folders, folder) in hidden.iter_mut().zip(folders) {
                folders.push(folder);
            }
        }
    }
    let plots = log_curves(rec, &stage, &candidates)?;
    let text = text(compared.table, &graphs);
    let text = TextDocument::new(text).with_media_type(MediaType::MARKDOWN);
    rec.log_static(SUMMARY, &text)?;
    let layout = blueprint::of_comparison(&stage, rows, &hidden, &plots)?;
    Ok(Logged { recording, layout })
}

/// Those that sail. In a sweep a method keeps its colour, the weaker the more risk it accepts.
fn candidates(entries: &[Entry]) -> Vec<Candidate<'_>> {
    let risks = |method: Method| {
        let of_method = entries.iter().filter(move |e| e.candidate.method == method);
        of_method.map(|e| e.candidate.max_risk)
    };
    let sailing = entries.iter().filter_map(|entry| {
        let motion = Motion::Planned(entry.trajectory()?);
        let candidate = entry.candidate;
        let look = LineStyle::of(candidate.method);
        let all: Vec<f64> = risks(candidate.method).collect();
        let place = all.iter().position(|r| *r == candidate.max_risk);
        let share = place.unwrap_or(0) as f32 / (all.len().max(2) - 1) as f32;
        let [r, g, b] = look.rgb();
        let color = Color::from_rgb(r, g, b);
        let name = if all.len() > 1 {
            format!("{} at risk {}", candidate.method, candidate.max_risk)
        } else {
            candidate.method.to_string()
        };
        let own = OwnShip {
            motion,
            name,
            color: style::toward_background(color, 1.0 - share * (1.0 - WEAKEST)),
        };
        Some(Candidate { entry, own, look })
    });
    sailing.collect()
}

fn radius(look: &LineStyle) -> rerun::Radius {
    style::points((RADIUS * look.width) as f32)
}

/// True where a method keeps out of sets that are neither the hard nor the shaped ones of the scenario: ellipses around them, or
/// level sets of a risk that it accepts.
fn has_sets_of_its_own(run: &Run, sets: &[TargetSets]) -> bool {
    let mut both = run.obstacles.iter().zip(sets);
    both.any(|(kept, sets)| *kept != sets.hard && *kept != sets.shaped)
}

/// The sets that a method keeps out of, in its colour: outlines on the chart, bodies in the volume.
fn log_kept_out_of(
    rec: &mut Recorder,
    stage: &Stage,
    candidate: &Candidate,
    run: &Run,
    [on_chart, in_volume]: &[EntityPath; 2],
) -> RecordingStreamResult<()> {
    let color = style::toward_background(candidate.own.color, SET_STRENGTH);
    for set in &run.obstacles {
        let below = |folder: &EntityPath| folder.join(&path(&["", set.name()]));
        let name = format!("{} keeps out of: {}", candidate.own.name, set.name());
        let look = movers::set_look(color, movers::SHAPED_RADIUS)
            .with_labels([name])
            .with_show_labels(false);
        movers::log_sections(rec, stage, below(on_chart), set, &look)?;
        let look = (candidate.own.color, space_time::SHAPED_ALPHA);
        space_time::log_body(rec, stage, below(in_volume), set, look)?;
    }
    Ok(())
}

/// Of a method's colour: that of the sets it keeps out of.
const SET_STRENGTH: f32 = 0.7;

fn legend(stage: &Stage, candidates: &[Candidate], sets: &[TargetSets]) -> Vec<Key> {
    let mut keys: Vec<Key> = candidates
        .iter()
        .map(|c| (c.own.name.clone(), c.own.color, radius(&c.look)))
        .collect();
    let of_its_own = |c: &Candidate| match &c.entry.result {
        EntryResult::Planned(run) => has_sets_of_its_own(run, sets),
        EntryResult::Baseline(_) | EntryResult::Nothing(_) => false,
    };
    if let Some(first) = candidates.iter().find(|c| of_its_own(c)) {
        let color = style::toward_background(first.own.color, SET_STRENGTH);
        let name = "a method's own sets".to_owned();
        keys.push((name, color, movers::SHAPED_RADIUS));
    }
    keys.push(("desired".into(), style::desired(), style::points(0.8)));
    keys.extend(chart::waters_legend(stage));
    keys
}

/// The motion on the chart and in the volume.
fn log_way(
    rec: &mut Recorder,
    stage: &Stage,
    candidate: &Candidate,
    order: f32,
) -> RecordingStreamResult<()> {
    let Candidate { own, look, .. } = candidate;
    let Motion::Planned(trajectory) = own.motion else {
        return Ok(());
    };
    let mut line: Vec<(Vector, f64)> = Vec::new();
    for (_, strip) in chart::strips(stage, trajectory) {
        let joint = usize::from(!line.is_empty());
        line.extend(strip.into_iter().skip(joint));
    }
    let strips = if look.dashed {
        dashes(stage, &line)
    } else {
        vec![line]
    };
    let on_chart = strips.iter().map(|s| s.iter().map(|&(p, _)| flat(p)));
    let on_chart = LineStrips2D::new(on_chart)
        .with_colors([own.color])
        .with_radii([radius(look)])
        .with_labels([own.name.as_str()])
        .with_show_labels(false)
        .with_draw_order(FIRST_ORDER + order);
    let entity = |view: &str| -> EntityPath { path(&[view, METHODS, &own.name, "way"]) };
    rec.log_static(entity(MAP), &on_chart)?;
    let in_volume = strips
        .iter()
        .map(|s| s.iter().map(|&(p, t)| stage.lifted(p, t)));
    // a wide line would hide the one that it lies under on the chart, from whichever side one looks
    let radius = if look.is_wide() {
        style::points(VOLUME_RADIUS)
    } else {
        radius(look)
    };
    let in_volume = LineStrips3D::new(in_volume)
        .with_colors([own.color])
        .with_radii([radius])
        .with_labels([own.name.as_str()])
        .with_show_labels(false);
    rec.log_static(entity(VOLUME), &in_volume)
}

/// Above sets and tracks.
const FIRST_ORDER: f32 = 30.0;

/// A line in pieces, by its length in the volume: one that waits is broken, too.
fn dashes(stage: &Stage, line: &[(Vector, f64)]) -> Vec<Vec<(Vector, f64)>> {
    let dash = DASH * stage.bounds.extent();
    let mut strips: Vec<Vec<(Vector, f64)>> = vec![line.first().copied().into_iter().collect()];
    let (mut drawn, mut left) = (true, dash);
    for pair in line.windows(2) {
        let [(a, from), (b, to)] = [pair[0], pair[1]];
        let rise = (to - from) * stage.metres_per_second;
        let length = (b - a).norm().hypot(rise);
        let mut along = 0.0;
        while length - along > left {
            along += left;
            let share = along / length;
            let here = (a + (b - a) * share, from + (to - from) * share);
            if drawn {
                strips.last_mut().into_iter().for_each(|s| s.push(here));
            } else {
                strips.push(vec![here]);
            }
            (drawn, left) = (!drawn, dash);
        }
        left -= length - along;
        if drawn {
            strips.last_mut().into_iter().for_each(|s| s.push((b, to)));
        }
    }
    strips.retain(|strip| strip.len() > 1);
    strips
}

/// Distance from the nearest target that keeps course and speed, and the speed; the plots for the layout.
fn log_curves(
    rec: &mut Recorder,
    stage: &Stage,
    candidates: &[Candidate],
) -> RecordingStreamResult<Vec<(&'static str, &'static str, [f64; 2])>> {
    let series = |c: &Candidate, values: Vec<f64>| Series {
        name: c.own.name.clone(),
        color: c.own.color,
        width: (c.look.width as f32).min(WIDEST),
        values,
    };
    let targets = &stage.scenario.targets;
    let mut plots = Vec::new();
    if !targets.is_empty() {
        let nearest = |c: &Candidate| -> Vec<f64> {
            let all = targets
                .iter()
                .map(|t| curves::clearances(stage, &c.own.motion, t));
            let nearer =
                |a: Vec<f64>, b: Vec<f64>| a.iter().zip(&b).map(|(a, b)| a.min(*b)).collect();
            all.reduce(nearer).unwrap_or_default()
        };
        let mut curves: Vec<Series> = candidates.iter().map(|c| series(c, nearest(c))).collect();
        let least = |s: &Series| s.values.iter().copied().fold(f64::INFINITY, f64::min);
        let farthest = curves.iter().map(least).fold(0.0, f64::max);
        curves.push(curves::safety_margin(stage));
        // each ends where its motion does, so each is an entity
        for curve in curves {
            let entity = path(&[CLEARANCE, &curve.name]);
            let (times, between) = (&stage.samples, InterpolationMode::Linear);
            curves::log_plot(rec, entity, times, between, &[curve])?;
        }
        let margin = stage.scenario.own_ship.safety_margin;
        let range = blueprint::near_zero(stage, farthest, margin);
        plots.push(("Distance from the nearest target (m)", CLEARANCE, range));
    }
    let times = curves::step_times(stage, candidates.iter().map(|c| &c.own.motion));
    let speeds: Vec<Series> = candidates
        .iter()
        .map(|c| series(c, curves::speeds(&c.own.motion, &times)))
        .collect();
    curves::log_plot(
        rec,
        path(&[SPEED]),
        &times,
        InterpolationMode::StepAfter,
        &speeds,
    )?;
    let fastest = knots_from_mps(stage.scenario.own_ship.max_speed());
    plots.push(("Speed (kn)", SPEED, [0.0, 1.4 * fastest]));
    Ok(plots)
}

fn text(table: &str, graphs: &[String]) -> String {
    let mut parts = vec![table.to_owned()];
    parts.push(
        "Lines are named where they are pointed at; broken ones are baselines. Grey sets are those of the scenario. The sets that a \
         method keeps out of are under `methods/<method>/sets` on the chart and in the volume, in its colour: switched on where \
         they are neither the hard nor the shaped ones of the scenario (ellipses around them, level sets of an accepted \
         risk), switched off where they are."
            .to_owned(),
    );
    if !graphs.is_empty() {
        parts.push(format!(
            "Explored graphs are hidden, under `methods/…/explored` on the chart and in the volume ({}). A refused edge that is pointed \
             at says what it meets, when, and by which rule or limit.",
            graphs.join("; ")
        ));
    }
    parts.join("\n\n")
}
