//! The graph that was searched, on the chart and in the volume, with the reasons for blocked edges.

use std::cell::OnceCell;

use rerun::{Color, EntityPath, LineStrips3D};

use super::chart::{TimedLine, one_line, polyline};
use crate::obstacle::{LandObstacle, SpaceTimeObstacle};
use crate::pipeline::{self, Run};
use crate::planner::{EdgeVerdict, ExploredEdge};
use crate::recording::Logged;
use crate::recording::canvas::{Canvas, flat, lines, style};
use crate::recording::recorder::Recorder;
use crate::text::clock;
use crate::tolerance;
use crate::trajectory::Segment;

const FREE: &str = "free";
pub const BLOCKED: &str = "blocked";

/// Most points of all edges of a plan. A point takes 24 bytes in both views together.
const POINT_BUDGET: usize = 5000;

#[derive(Debug, Clone, Copy, Default)]
pub struct DrawnGraph {
    pub edges: usize,
    /// Edges that the search tested, without those that take no time.
    pub tested: usize,
}

/// Tested edges of one verdict: their polylines through `(position, time)`.
struct Kind {
    name: &'static str,
    color: Color,
    strips: Vec<TimedLine>,
    /// One per strip, or empty.
    reasons: Vec<String>,
}

/// Logs tested edges, in the order in which they were made, until [`POINT_BUDGET`] is used.
///
/// They lie below `folders`, on the chart and in the volume. Blocked edges carry the reason as a
/// label, which is shown where one is pointed at. Returns how many edges were drawn.
pub fn log_explored(
    rec: &mut Recorder,
    canvas: &Canvas,
    run: &Run,
    folders: &[EntityPath; 2],
) -> Logged<DrawnGraph> {
    let kind = |name, color| Kind {
        name,
        color,
        strips: Vec::new(),
        reasons: Vec::new(),
    };
    let mut kinds = [
        kind(FREE, style::GRAPH_FREE),
        kind(BLOCKED, style::GRAPH_BLOCKED),
    ];
    let judge = Judge {
        run,
        land_obstacle: OnceCell::new(),
    };
    let mut drawn = DrawnGraph::default();
    let mut points = 0;
    for edge in run.planned.explored.edge_weights() {
        let (kind, obstacle) = match edge.verdict {
            EdgeVerdict::Free => (&mut kinds[0], None),
            EdgeVerdict::Blocked { obstacle } => (&mut kinds[1], Some(obstacle)),
        };
        let strip = edge_line(edge);
        // an edge that takes no time is a point
        if strip.is_empty() {
            continue;
        }
        drawn.tested += 1;
        points += strip.len();
        if points <= POINT_BUDGET {
            drawn.edges += 1;
            kind.strips.push(strip);
            let reason = obstacle.map(|o| judge.reason(&edge.segments, o));
            kind.reasons.extend(reason);
        }
    }
    for kind in kinds {
        log_kind(rec, canvas, kind, folders)?;
    }
    Ok(drawn)
}

struct Judge<'a> {
    run: &'a Run,
    /// Made for the first edge that runs aground.
    land_obstacle: OnceCell<LandObstacle>,
}

impl Judge<'_> {
    /// Obstacle that an edge meets, the time of contact, and the limit that it breaks. `obstacle`
    /// is an index of [`Run::targets`], or behind the last for land.
    fn reason(&self, edge: &[Segment], obstacle: usize) -> String {
        let Some(set) = self.run.obstacles().nth(obstacle) else {
            let land_obstacle = self
                .land_obstacle
                .get_or_init(|| pipeline::land_obstacle(&self.run.scenario, &self.run.land.pieces));
            let depth = tolerance::GRAZE_M;
            let met = edge
                .iter()
                .find_map(|s| land_obstacle.first_contact(s, depth));
            return reason("land", met, "nearer than the hull and the margin allow");
        };
        let enters = |set: &dyn Fn(&Segment) -> Option<f64>| edge.iter().find_map(set);
        // an edge that only just meets the set is found without the depth
        let met = enters(&|s| set.first_contact(s, tolerance::DEPTH_M))
            .or_else(|| enters(&|s| set.first_contact(s, 0.0)));
        reason(set.name(), met, &self.limit(edge, obstacle))
    }

    /// The limit of a target that an edge breaks.
    fn limit(&self, edge: &[Segment], obstacle: usize) -> String {
        let run = self.run;
        let sets = &run.targets[obstacle].sets;
        let is_hard = |s: &Segment| sets.hard.first_contact(s, tolerance::DEPTH_M).is_some();
        let ship = run.scenario.targets[obstacle].ship();
        let limit = if run.targets[obstacle].whole != sets.hard && !edge.iter().any(is_hard) {
            let role = sets.encounter.role;
            let rule = role.rule().map_or(String::new(), |n| format!(", Rule {n}"));
            format!("its ship domain (own ship {}{rule})", role.word())
        } else if ship.is_some() {
            let margin = run.scenario.own_ship.safety_margin;
            format!("hulls and a margin of {margin} m")
        } else {
            "the set that is given".to_owned()
        };
        match run.scenario.max_risk {
            risk if risk > 0.0 => format!("{limit}, at more than the accepted risk {risk}"),
            _ => limit,
        }
    }
}

fn reason(what: &str, met: Option<f64>, limit: &str) -> String {
    match met {
        Some(time) => format!("{what} at {}: {limit}", clock(time)),
        None => format!("{what}: {limit}"),
    }
}

/// The line of an edge through its segments; empty for one that takes no time.
fn edge_line(edge: &ExploredEdge) -> TimedLine {
    let moving = edge.segments.iter().filter(|s| s.duration > 0.0);
    one_line(moving.map(polyline))
}

fn log_kind(rec: &mut Recorder, canvas: &Canvas, kind: Kind, folders: &[EntityPath; 2]) -> Logged {
    if kind.strips.is_empty() {
        return Ok(());
    }
    let [on, over] = folders.each_ref().map(|f| f.join(&kind.name.into()));
    let on_chart = kind.strips.iter().map(|s| s.iter().map(|&(p, _)| flat(p)));
    let mut on_chart = lines(kind.color, 0.5)
        .with_strips(on_chart)
        // below everything but the grid
        .with_draw_order(5.0);
    if !kind.reasons.is_empty() {
        on_chart = on_chart.with_labels(kind.reasons).with_show_labels(false);
    }
    rec.log_static(on, &on_chart)?;
    let in_volume = kind
        .strips
        .iter()
        .map(|s| s.iter().map(|&(p, t)| canvas.lifted(p, t)));
    let in_volume = LineStrips3D::new(in_volume)
        .with_colors([kind.color])
        .with_radii([style::points(0.4)]);
    rec.log_static(over, &in_volume)
}
