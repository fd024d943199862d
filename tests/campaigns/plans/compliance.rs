//! Plans under `compliance = "rules"` over random encounters, counted by both judges from the
//! trajectories alone.

use std::path::Path;

use searoom::colregs::{
    Thresholds,
    compliance::{ComplianceReport, EncounterSamples},
};
use searoom::frame::deg_from_radians;
use searoom::pipeline::{self, Run};

use crate::campaigns::encounter_generator::{EncounterKind, Meeting};
use crate::campaigns::statistics::{quantiles, share_cells};
use crate::campaigns::{Report, Seeds, meetings, scene_file};

/// Least share of plans with which both judges are content, of encounters that begin near. Measured
/// with 3,000 of each kind: 100, 99.4, 99.6, 100 and 100 %.
const CONTENT: f64 = 0.98;

/// Least mean of the least scores of each kind. Measured with 3,000 of each: 0.93, 0.58, 0.35, 0.58
/// and 0.52.
const LEAST_SCORE: [f64; 5] = [0.90, 0.52, 0.33, 0.48, 0.45];

/// Observations of one plan.
struct Seen {
    verified: bool,
    /// Rules and monitors that are broken.
    broken: Vec<&'static str>,
    least_score: f64,
    cost: f64,
    /// The cost, doubled where own ship slows down in place of a turn, m²: what the planner compares.
    price: f64,
    /// The first manoeuvre: seconds of its beginning, its return and its end, and its turn to port in
    /// degrees.
    manoeuvre: [f64; 4],
    milliseconds: f64,
    lead: Option<f64>,
    turns: usize,
    smallest_turn: Option<f64>,
    speed_changes: usize,
    /// Segments of less than three seconds.
    short: usize,
    /// Least distance of the hulls in lengths of the longer ship.
    lengths: f64,
    /// Greatest distance from the path, metres.
    off_path: f64,
}

fn seen(run: &Run) -> Seen {
    let plan = run.planned.outcome.plan().expect("a plan");
    let ship = run.scenario.targets[0].ship().expect("a ship");
    let evaluation = run.evaluation.as_ref().expect("judged");
    let own = &run.scenario.own_ship;
    let meeting = EncounterSamples::along(&plan.trajectory, own, ship);
    let report = ComplianceReport::judge(&meeting, Thresholds::standard());
    let manoeuvre = report.manoeuvre;
    let times = plan.trajectory.sample_times(1.0, u32::MAX);
    let first = run.planned.manoeuvres.first();
    let slows = first.is_some_and(|manoeuvre| manoeuvre.turn == 0.0);
    let numbers = first.map(|m| [m.begins, m.returns, m.joins, deg_from_radians(m.turn)]);
    let off = times.into_iter().map(|time| {
        let pose = plan.trajectory.pose_at(time);
        let weightless = run.scenario.desired.nearest(pose.position, time, 0.0);
        weightless.error.sqrt()
    });
    Seen {
        verified: evaluation.verified(),
        broken: report.broken().collect(),
        least_score: report.scores.least(),
        cost: plan.cost,
        price: plan.cost * if slows { 2.0 } else { 1.0 },
        manoeuvre: numbers.unwrap_or([f64::NAN; 4]),
        milliseconds: run.plan_time.as_secs_f64() * 1e3,
        lead: manoeuvre.and_then(|m| m.lead),
        turns: manoeuvre.map_or(0, |m| m.turns),
        smallest_turn: manoeuvre.and_then(|m| m.smallest_turn),
        speed_changes: manoeuvre.map_or(0, |m| m.speed_changes),
        short: (plan.trajectory.segments().iter())
            .filter(|s| s.duration < 3.0)
            .count(),
        lengths: evaluation.passages[0].dcpa / own.hull.length.max(ship.hull.length),
        off_path: off.fold(0.0, f64::max),
    }
}

/// Encounters with one target: `seeds` of each kind. The plans go to `rows` too, where that is a
/// file: a line of CSV each, by which two versions can be compared scene by scene; the scenes to a `folder`,
/// where that is given, so that another version can plan them.
pub fn run(seeds: Seeds, meeting: &Meeting, rows: Option<&Path>, folder: Option<&Path>) -> Report {
    let mut report = Report::default();
    let mut lines = String::from(
        "kind,seed,price_m2,cost_m2,milliseconds,begins_s,returns_s,joins_s,turn_deg,broken\n",
    );
    let [soon, late] = [meeting.time.start(), meeting.time.end()];
    println!("{seeds:?} of each kind, {soon} to {late} s before the closest approach\n");
    println!(
        "| kind | both judges | at least | least score | J, m² | lead 5/50/95 %, s | turns 50/95 %/most | \
         speeds 50/95 %/most | least turn 5 %, deg | hulls 1/5/50 %, L | off the path 50/95 %, m | short | plan 50/99 %, ms |"
    );
    println!("|{}", " --- |".repeat(13));
    for kind in EncounterKind::ALL {
        one_kind(kind, seeds.clone(), meeting, &mut report, &mut lines);
        if let Some(folder) = folder {
            for seed in seeds.clone() {
                let name = format!("{}-{seed}.toml", kind.name().replace(' ', "-"));
                let scene = crate::campaigns::meeting(kind, seed, meeting);
                report.written(scene_file::write(folder, &name, &scene), folder);
            }
        }
    }
    println!();
    if let Some(file) = rows {
        report.written(std::fs::write(file, lines), file);
    }
    report
}

fn one_kind(
    kind: EncounterKind,
    seeds: Seeds,
    meeting: &Meeting,
    report: &mut Report,
    lines: &mut String,
) {
    let name = kind.name();
    let all = meetings(kind, seeds, meeting, |scenario, _| {
        seen(&pipeline::run(scenario))
    });
    for (seed, s) in &all {
        let (price, cost, ms, broken) = (s.price, s.cost, s.milliseconds, s.broken.join(" "));
        let [begins, returns, joins, turn] = s.manoeuvre;
        lines.push_str(&format!(
            "{name},{seed},{price},{cost},{ms},{begins},{returns},{joins},{turn},{broken}\n"
        ));
    }
    let count = |holds: &dyn Fn(&Seen) -> bool| all.iter().filter(|(_, s)| holds(s)).count();
    let values = |of: &dyn Fn(&Seen) -> Option<f64>| -> Vec<f64> {
        all.iter().filter_map(|(_, s)| of(s)).collect()
    };
    let numbers = |of: &dyn Fn(&Seen) -> usize| values(&|s| Some(of(s) as f64));
    let turns = values(&|s| s.smallest_turn.map(f64::to_degrees));
    let content = count(&|s| s.broken.is_empty());
    let score = all.iter().map(|(_, s)| s.least_score).sum::<f64>() / all.len() as f64;
    let cells = [
        share_cells(content, all.len()),
        format!("{score:.2}"),
        quantiles(&values(&|s| Some(s.cost)), [0.5], 0),
        quantiles(&values(&|s| s.lead), [0.05, 0.5, 0.95], 0),
        quantiles(&numbers(&|s| s.turns), [0.5, 0.95, 1.0], 0),
        quantiles(&numbers(&|s| s.speed_changes), [0.5, 0.95, 1.0], 0),
        quantiles(&turns, [0.05], 0),
        quantiles(&values(&|s| Some(s.lengths)), [0.01, 0.05, 0.5], 1),
        quantiles(&values(&|s| Some(s.off_path)), [0.5, 0.95], 0),
        count(&|s| s.short > 0).to_string(),
        quantiles(&values(&|s| Some(s.milliseconds)), [0.5, 0.99], 1),
    ];
    println!("| {name} | {} |", cells.join(" | "));
    let broken = (all.iter()).flat_map(|(seed, s)| s.broken.iter().map(|rule| (*rule, *seed)));
    Report::print_seeds(name, broken);
    let unverified = all.len() - count(&|s| s.verified);
    report.require(unverified == 0, || {
        format!("{name}: {unverified} not verified")
    });
    report.content(name, CONTENT, content, all.len());
    let least = LEAST_SCORE[kind as usize];
    report.require(score >= least, || {
        format!("{name}: mean score {score:.2} below {least}")
    });
}
