//! The diagram of a path-time plan: docs/documents.md.

use serde::{Deserialize, Serialize};

use crate::frame::clockwise_deg;
use crate::obstacle::{PathTime, SpaceTimeObstacle};
use crate::pipeline::Run;
use crate::planner::path_time::PathTimeDiagram;
use crate::report::words;

/// Distance along the path and time; points are `[s_m, t_s]`.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::report::document::{PlanDocument, PathTimeDocument};
///
/// let scenario = Scenario::read("scenarios/harbour/ferry-crossing.toml".as_ref())?;
/// let plan = PlanDocument::of(&pipeline::run(scenario));
/// let diagram: &PathTimeDocument = plan.path_time.as_ref().expect("planned along paths");
/// assert_eq!((diagram.path.as_str(), diagram.legs.len()), ("main", 2));
/// // distance never falls, time grows
/// assert!(diagram.profile.windows(2).all(|w| w[0][0] <= w[1][0] && w[0][1] < w[1][1]));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct PathTimeDocument {
    /// `"main"`, `"alternative 1"` …; where own ship changes, one after another.
    pub path: String,
    pub legs: Vec<PathLegDocument>,
    pub obstacles: Vec<PathObstacleDocument>,
    pub corners: Vec<PathCornerDocument>,
    /// Without a plan the start alone.
    pub profile: Vec<[f64; 2]>,
}

/// A leg that is sailed.
///
/// # Examples
///
/// ```
/// use searoom::report::document::PathLegDocument;
///
/// let text = r#"{ "start_m": 0.0, "end_m": 486.1, "path": "main" }"#;
/// let read: PathLegDocument = serde_json::from_str(text)?;
/// assert!(read.path == "main" && read.end_m > read.start_m);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct PathLegDocument {
    pub start_m: f64,
    pub end_m: f64,
    /// Which path it is of.
    pub path: String,
}

/// An obstacle on a leg, clipped to the leg and the horizon.
///
/// # Examples
///
/// ```
/// use searoom::report::document::PathObstacleDocument;
///
/// let text = r#"{ "target": "trawler", "leg": 0, "vertices": [[253.0, 56.5], [232.5, 58.0], [219.3, 70.0]] }"#;
/// let read: PathObstacleDocument = serde_json::from_str(text)?;
/// // along the path in metres, time in seconds
/// assert_eq!((read.leg, read.vertices[0]), (0, [253.0, 56.5]));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct PathObstacleDocument {
    pub target: String,
    pub leg: usize,
    pub vertices: Vec<[f64; 2]>,
}

/// A corner of the path: exempt from the turning radius, the hull over both headings there.
///
/// # Examples
///
/// ```
/// use searoom::report::document::PathCornerDocument;
///
/// let text = r#"{ "s_m": 486.1, "turn_deg": -11.2 }"#;
/// let read: PathCornerDocument = serde_json::from_str(text)?;
/// // to port
/// assert!(read.turn_deg < 0.0);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct PathCornerDocument {
    pub s_m: f64,
    /// To starboard positive.
    pub turn_deg: f64,
}

/// The diagram of a run.
pub(super) fn path_time_document(run: &Run, diagram: &PathTimeDiagram) -> PathTimeDocument {
    // +0.0 turns a negative zero into zero
    let plain = |p: &PathTime| [p.distance + 0.0, p.time + 0.0];
    PathTimeDocument {
        path: words::paths(diagram),
        legs: diagram
            .legs
            .iter()
            .map(|leg| PathLegDocument {
                start_m: leg.begin,
                end_m: leg.begin + leg.track.length,
                path: words::path(leg.path),
            })
            .collect(),
        obstacles: diagram
            .obstacles
            .iter()
            .map(|seen| PathObstacleDocument {
                target: run.obstacles[seen.obstacle].name().to_owned(),
                leg: seen.leg,
                vertices: seen.corners.iter().map(plain).collect(),
            })
            .collect(),
        corners: diagram
            .corners
            .iter()
            .map(|corner| PathCornerDocument {
                s_m: corner.distance,
                turn_deg: clockwise_deg(corner.turn),
            })
            .collect(),
        profile: diagram.profile.iter().map(plain).collect(),
    }
}
