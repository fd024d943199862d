//! The graph that the search made, on the chart and in the volume.

use rerun::{Color, LineStrips2D, LineStrips3D, RecordingStream, RecordingStreamResult};

use super::chart::polyline;
use super::scene::{Scene, flat};
use super::{MAP, VOLUME, path, style};
use crate::frame::Vector;
use crate::planner::{EdgeVerdict, ExploredEdge};

/// Edges that are clear of every set.
const FREE: &str = "free";
/// Edges that meet one.
pub const BLOCKED: &str = "blocked";

/// Points that the edges may have in all: 24 bytes each, in both pictures.
const POINT_BUDGET: usize = 2400;

/// How much of the graph is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Drawn {
    /// Edges in the recording.
    pub edges: usize,
    /// Edges that the search tested, those that take no time left out.
    pub tested: usize,
}

/// Tested edges of one verdict: their polylines through `(position, time)`.
struct Kind {
    name: &'static str,
    color: Color,
    strips: Vec<Vec<(Vector, f64)>>,
}

/// Tested edges, in the order in which they were made, until the budget is used; edges that were never
/// tested are not drawn. The answer says how many that were.
pub fn log_explored(rec: &RecordingStream, scene: &Scene) -> RecordingStreamResult<Drawn> {
    let mut kinds = [
        Kind {
            name: FREE,
            color: style::graph_free(),
            strips: Vec::new(),
        },
        Kind {
            name: BLOCKED,
            color: style::graph_blocked(),
            strips: Vec::new(),
        },
    ];
    let mut drawn = Drawn {
        edges: 0,
        tested: 0,
    };
    let mut points = 0;
    for edge in scene.run.planned.explored.edge_weights() {
        let kind = match edge.verdict {
            EdgeVerdict::Free => &mut kinds[0],
            EdgeVerdict::Blocked { .. } => &mut kinds[1],
            EdgeVerdict::Untested => continue,
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
        }
    }
    for kind in kinds {
        log_kind(rec, scene, kind)?;
    }
    Ok(drawn)
}

/// The whole edge, its arcs coarser than those of the plan.
fn edge_line(edge: &ExploredEdge) -> Vec<(Vector, f64)> {
    let mut line: Vec<(Vector, f64)> = Vec::new();
    for segment in edge.segments.iter().filter(|s| s.duration > 0.0) {
        let fine = polyline(segment);
        let last = fine.len() - 1;
        let kept = fine
            .into_iter()
            .enumerate()
            .filter(|&(i, _)| i == last || i.is_multiple_of(4))
            .map(|(_, point)| point);
        let joint = usize::from(!line.is_empty());
        line.extend(kept.skip(joint));
    }
    line
}

fn log_kind(rec: &RecordingStream, scene: &Scene, kind: Kind) -> RecordingStreamResult<()> {
    if kind.strips.is_empty() {
        return Ok(());
    }
    let on_chart = kind.strips.iter().map(|s| s.iter().map(|&(p, _)| flat(p)));
    let on_chart = LineStrips2D::new(on_chart)
        .with_colors([kind.color])
        .with_radii([style::points(0.5)])
        // below everything but the grid
        .with_draw_order(5.0);
    rec.log_static(path(&[MAP, "explored", kind.name]), &on_chart)?;
    let in_volume = kind
        .strips
        .iter()
        .map(|s| s.iter().map(|&(p, t)| scene.lifted(p, t)));
    let in_volume = LineStrips3D::new(in_volume)
        .with_colors([kind.color])
        .with_radii([style::points(0.4)]);
    rec.log_static(path(&[VOLUME, "explored", kind.name]), &in_volume)
}
