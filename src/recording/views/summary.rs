//! The verdict in words and figures, as markdown.

use std::fmt::Write;

use rerun::{MediaType, RecordingStreamResult, TextDocument};

use super::explored::Drawn;
use super::rules;
use super::ships::vector_seconds;
use crate::evaluation::Evaluation;
use crate::frame::{Side, deg_from_radians, knots_from_mps};
use crate::obstacle::SpaceTimeObstacle;
use crate::pipeline::Relaxation;
use crate::planner::{Objective, Outcome, Plan};
use crate::recording::SUMMARY;
use crate::recording::canvas::{Motion, ViewModel};
use crate::recording::write::Recorder;
use crate::scenario::Compliance;
use crate::tolerance;
use crate::trajectory::{Steered, Trajectory};

/// Logs the text, which holds at all times.
pub fn log_summary(
    rec: &mut Recorder,
    model: &ViewModel,
    drawn: Drawn,
) -> RecordingStreamResult<()> {
    rec.log_static(
        SUMMARY,
        &TextDocument::new(text(model, drawn)).with_media_type(MediaType::MARKDOWN),
    )
}

fn text(model: &ViewModel, drawn: Drawn) -> String {
    let run = model.run;
    let mut parts = vec![format!("# {}", run.headline())];
    match (run.planned.outcome.plan(), &run.evaluation) {
        (Some(plan), evaluation) => {
            parts.push(manoeuvre(model, plan));
            parts.extend(evaluation.iter().flat_map(violations));
        }
        (None, _) => parts.push(reason(&run.planned.outcome)),
    }
    parts.extend(run.relaxations.iter().map(relaxation));
    parts.push(targets_table(model));
    parts.push(rules::text(model));
    if let (Some(plan), Some(evaluation)) = (run.planned.outcome.plan(), &run.evaluation) {
        parts.push(cost_table(plan, run.scenario.objective, evaluation));
    }
    parts.push(search(model, drawn));
    parts.push(claim(model));
    parts.push(key(model));
    parts.retain(|part| !part.is_empty());
    parts.join("\n\n")
}

/// The plan as a navigator would describe it.
fn manoeuvre(model: &ViewModel, plan: &Plan) -> String {
    let trajectory = &plan.trajectory;
    let mut parts = Vec::new();
    match first_turn(trajectory) {
        Some(turn) => parts.push(format!(
            "alters course {:.0}° to {} at {:.0} s",
            deg_from_radians(turn.angle),
            turn.side,
            turn.time
        )),
        None => parts.push("keeps its course".to_owned()),
    }
    let joints = trajectory.joints();
    let speeds = || joints.iter().map(|&time| trajectory.speed_at(time));
    let slowest = speeds().fold(f64::INFINITY, f64::min);
    let fastest = speeds().fold(0.0, f64::max);
    parts.push(if slowest < fastest {
        format!(
            "runs {:.1} to {:.1} kn",
            knots_from_mps(slowest),
            knots_from_mps(fastest)
        )
    } else {
        format!("keeps {:.1} kn", knots_from_mps(fastest))
    });
    let arrival = trajectory.end_time();
    if trajectory.steered().is_some() {
        parts.push(format!("is planned for {arrival:.0} s, all of the horizon"));
        return format!("**Own ship {}.**", parts.join(", "));
    }
    let delay = arrival - model.scenario.desired.duration();
    parts.push(if plan.to_go > 0.0 {
        format!(
            "does not arrive: {:.0} m are left at {arrival:.0} s",
            plan.to_go
        )
    } else if delay.abs() < 0.05 {
        format!("arrives on time at {arrival:.0} s")
    } else {
        let word = if delay > 0.0 { "late" } else { "early" };
        format!("arrives at {arrival:.0} s, {:.1} s {word}", delay.abs())
    });
    format!("**Own ship {}.**", parts.join(", "))
}

/// The first alteration of course.
struct Turn {
    side: Side,
    /// Positive, radians.
    angle: f64,
    /// Seconds.
    time: f64,
}

/// Least alteration of course, radians.
const LEAST_TURN: f64 = 0.01;

/// The first alteration of course. Successive turns to one side are one alteration.
fn first_turn(trajectory: &Trajectory) -> Option<Turn> {
    if let Some(motion) = trajectory.steered() {
        return first_swing(motion);
    }
    let mut turn: Option<Turn> = None;
    for segment in trajectory.segments().iter().filter(|s| s.duration > 0.0) {
        let side = Side::of_turn(segment.turn_rate);
        let over = turn.as_ref().is_some_and(|t| Some(t.side) != side);
        if over && turn.as_ref().is_some_and(|t| t.angle >= LEAST_TURN) {
            return turn;
        }
        let Some(side) = side else {
            turn = None;
            continue;
        };
        let angle = (segment.turn_rate * segment.duration).abs();
        match &mut turn {
            Some(begun) if begun.side == side => begun.angle += angle,
            _ => {
                turn = Some(Turn {
                    side,
                    angle,
                    time: segment.start_time,
                });
            }
        }
    }
    turn.filter(|t| t.angle >= LEAST_TURN)
}

/// The first alteration of course under forces, without corrections of the steering.
fn first_swing(motion: &Steered) -> Option<Turn> {
    let swing = *motion.swings().first()?;
    Some(Turn {
        side: Side::of_turn(swing.turned)?,
        angle: swing.turned.abs(),
        time: swing.start_time,
    })
}

fn reason(outcome: &Outcome) -> String {
    match outcome {
        Outcome::Infeasible(why) => format!(
            "**Why: {why}.** The views show own ship as if it followed the desired trajectory."
        ),
        Outcome::Deadline(None) => {
            "**The deadline passed before a plan was found.** The views show own ship as if it \
             followed the desired trajectory."
                .to_owned()
        }
        Outcome::Solved(_) | Outcome::Deadline(Some(_)) => String::new(),
    }
}

fn violations(evaluation: &Evaluation) -> Vec<String> {
    evaluation
        .violations
        .iter()
        .map(|v| format!("- **Violation at {:.1} s:** {}", v.time, v.what))
        .collect()
}

fn relaxation(relaxation: &Relaxation) -> String {
    match relaxation {
        Relaxation::Domain { target, amount } => format!(
            "- **Relaxed:** the ship domain of {target} was reduced by {amount:.1} m, as own ship \
             starts inside it, or no plan is clear of it."
        ),
        Relaxation::Risk {
            target,
            amount,
            until: None,
        } => format!("- **Enters** the set of {target}, at a risk of up to {amount:.3}."),
        Relaxation::Risk {
            target,
            amount,
            until: Some(time),
        } => format!(
            "- **Enters** the set of {target}, at a risk of up to {amount:.3}; the plan is clear \
             of it only from {time:.1} s on."
        ),
        Relaxation::Arrival { target, amount } => format!(
            "- **Relaxed:** own ship does not arrive, as {target} is in the way; {amount:.0} m are \
             left at the horizon."
        ),
        Relaxation::Compliance { target, role } => format!(
            "- **Relaxed:** no plan complies with the rules as {} to {target}.",
            role.name()
        ),
    }
}

fn targets_table(model: &ViewModel) -> String {
    let run = model.run;
    if run.sets.is_empty() {
        return "No targets.".to_owned();
    }
    let mut table = String::from(
        "| target | own ship is | nominal CPA | planned CPA | passes to | worst-case clearance \
         | margin to set | largest risk |\n|---|---|---|---|---|---|---|---|",
    );
    for (index, sets) in run.sets.iter().enumerate() {
        let encounter = &sets.encounter;
        let _ = write!(
            table,
            "\n| {} | {} | {} |",
            sets.hard.name(),
            encounter.role.name(),
            approach(encounter.undisturbed_dcpa, encounter.undisturbed_tcpa)
        );
        let passage = run.evaluation.as_ref().and_then(|e| e.passages.get(index));
        let _ = match passage {
            Some(p) => write!(
                table,
                " {} | {} | {:.1} m | {:.1} m |",
                approach(p.dcpa, p.tcpa),
                p.passing_side,
                tenths(p.min_clearance),
                tenths(p.min_margin)
            ),
            None => write!(table, " – | – | – | – |"),
        };
        let _ = match run.risks.get(index) {
            Some(peak) if peak.risk > 0.0 => {
                write!(table, " {:.3} at {:.0} s |", peak.risk, peak.time)
            }
            Some(_) => write!(table, " 0 |"),
            None => write!(table, " – |"),
        };
    }
    table
}

/// A closest approach in words: metres between the hulls, negative in overlap, and seconds.
/// Touching is no collision.
pub fn approach(distance: f64, time: f64) -> String {
    if distance < -tolerance::DEPTH_M {
        format!("collision at {time:.0} s")
    } else {
        format!("{:.0} m at {time:.0} s", distance.max(0.0))
    }
}

/// Rounds to one decimal, without a negative zero.
fn tenths(value: f64) -> f64 {
    (value * 10.0).round() / 10.0 + 0.0
}

fn cost_table(plan: &Plan, objective: Objective, evaluation: &Evaluation) -> String {
    let graph = plan.graph_cost.map_or("–".to_owned(), |cost| {
        format!("{cost:.1} {}", objective.unit())
    });
    let delay = if evaluation.delay.is_finite() {
        format!("{:+.1} s", tenths(evaluation.delay))
    } else {
        "–".to_owned()
    };
    format!(
        "| J, space-time error | graph alone | over arc length | delay | duration | length \
         | worst-case clearance |\n|---|---|---|---|---|---|---|\n\
         | {:.1} m² | {graph} | {:.1} m² | {delay} | {:.1} s | {:.0} m | {:.1} m |",
        evaluation.space_time_error,
        evaluation.arc_length_error,
        evaluation.duration,
        evaluation.length,
        tenths(evaluation.min_clearance),
    )
}

fn search(model: &ViewModel, drawn: Drawn) -> String {
    let stats = model.run.planned.stats;
    let graph = if drawn.edges < drawn.tested {
        format!("{} of {} are in the recording", drawn.edges, drawn.tested)
    } else {
        format!("all {} that take time are in the recording", drawn.tested)
    };
    format!(
        "Search: {} nodes expanded, {} generated, {} edges tested; {graph} under `explored`, \
         hidden on the chart.",
        stats.expanded, stats.generated, stats.edges_checked
    )
}

/// Claims of the plan, with their assumptions.
fn claim(model: &ViewModel) -> String {
    let run = model.run;
    let judged = run.evaluation.as_ref().is_some_and(Evaluation::verified);
    let Motion::Planned(trajectory) = model.motion else {
        return String::new();
    };
    if !judged {
        return "Nothing is claimed.".to_owned();
    }
    if run.greatest_risk() > 0.0 || !run.safe() {
        let safe = if run.safe() { "safe" } else { "not safe" };
        return format!(
            "The plan is {safe}, and enters sets: nothing more is claimed about these than above."
        );
    }
    let sets = match run.scenario.compliance {
        Compliance::Shape | Compliance::Rules => "hard sets and those with ship domains",
        Compliance::None => "hard sets",
    };
    let ships = run.scenario.targets.iter().filter(|t| t.ship().is_some());
    let margin = format!(
        "so at least {:.0} m remain between the hulls, ",
        run.scenario.own_ship.safety_margin
    );
    let hulls = match ships.count() {
        0 => String::new(),
        n if n == run.scenario.targets.len() => margin,
        _ => format!("{margin}except of targets whose sets are given, "),
    };
    format!(
        "**Claimed** until arrival at {:.0} s: own ship's centre stays out of all {sets}, \
         {hulls}wherever in its initial set a target starts and however its velocity varies within \
         its velocity set. **Not claimed:** anything after arrival, or about a target that leaves \
         its sets.",
        trajectory.end_time(),
    )
}

/// How to read the chart.
fn key(model: &ViewModel) -> String {
    format!(
        "Chart: own ship is white; thin lines ahead of ships are speed vectors of {:.0} s; dots on \
         the tracks are every {:.0} s. Sets apply to own ship's centre: they include its hull and \
         the margin.",
        vector_seconds(model),
        super::chart::mark_step(model)
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn touching_is_no_collision_and_zero_has_no_sign() {
        assert_eq!(approach(-1e-8, 600.0), "0 m at 600 s");
        assert_eq!(approach(-1e-5, 600.0), "collision at 600 s");
        assert_eq!(approach(0.6, 12.0), "1 m at 12 s");
        assert_eq!(format!("{:.1}", tenths(-0.04)), "0.0");
        assert_eq!(format!("{:+.1}", tenths(-0.04)), "+0.0");
        assert_eq!(format!("{:.1}", tenths(-0.06)), "-0.1");
    }
}
