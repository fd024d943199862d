//! What documents are made of: mirrors of what is written, nothing more.

use serde::{Deserialize, Serialize};

use super::conduct::ConductDocument;

/// A point of the plane.
///
/// # Examples
///
/// ```
/// use searoom::report::document::PositionDocument;
///
/// let text = r#"{ "east_m": 10.0, "north_m": -5.0 }"#;
/// let read: PositionDocument = serde_json::from_str(text)?;
/// assert_eq!([read.east_m, read.north_m], [10.0, -5.0]);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct PositionDocument {
    pub east_m: f64,
    pub north_m: f64,
}

/// Own ship and her limits, in the keys of the scenario file.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::report::document::{PlanDocument, OwnShipDocument};
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let plan = PlanDocument::of(&pipeline::run(scenario));
/// let own: &OwnShipDocument = &plan.own_ship;
/// assert_eq!((own.course_deg, own.turning_radius_m, own.safety_margin_m), (90.0, 100.0, 20.0));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct OwnShipDocument {
    pub position: PositionDocument,
    pub course_deg: f64,
    pub speed_mps: f64,
    pub length_m: f64,
    pub beam_m: f64,
    pub turning_radius_m: f64,
    pub speeds_mps: Vec<f64>,
    pub safety_margin_m: f64,
    /// 0 without land.
    pub land_margin_m: f64,
}

/// The desired trajectory.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::report::document::{PlanDocument, MissionDocument};
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let plan = PlanDocument::of(&pipeline::run(scenario));
/// let mission: &MissionDocument = &plan.mission;
/// assert_eq!((mission.length_m, mission.duration_s), (1500.0, 300.0));
/// assert_eq!(mission.leg_speeds_mps, [5.0]);
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct MissionDocument {
    pub waypoints: Vec<PositionDocument>,
    pub leg_speeds_mps: Vec<f64>,
    /// Desired end.
    pub duration_s: f64,
    pub length_m: f64,
    /// Other paths that may be sailed; absent where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub alternatives: Vec<Vec<PositionDocument>>,
}

/// Something that was given up.
///
/// # Examples
///
/// ```
/// use searoom::report::document::RelaxationDocument;
///
/// let text = r#"{ "kind": "domain", "target": "ferry", "amount": 12.5, "unit": "m" }"#;
/// let read: RelaxationDocument = serde_json::from_str(text)?;
/// assert_eq!((read.kind.as_str(), read.amount, read.until_s), ("domain", 12.5, None));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct RelaxationDocument {
    pub kind: String,
    pub target: String,
    pub amount: f64,
    pub unit: String,
    /// Of a set that is entered and left: nothing is claimed before. Absent elsewhere.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until_s: Option<f64>,
}

/// How the hold of a ship that stands on ends.
///
/// # Examples
///
/// ```
/// use searoom::report::document::EscapeDocument;
///
/// let text = r#"{ "policy": "stand-on-hold", "latest_s": 113.0, "first_segment": 1, "turn_deg": 60.0, "speed_mps": 6.0 }"#;
/// let read: EscapeDocument = serde_json::from_str(text)?;
/// // held for 113 s, then 60 degrees to starboard
/// assert_eq!((read.latest_s, read.turn_deg), (113.0, 60.0));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct EscapeDocument {
    pub policy: String,
    pub latest_s: f64,
    pub first_segment: usize,
    pub turn_deg: f64,
    pub speed_mps: f64,
}

/// Something that the independent checker found.
///
/// # Examples
///
/// ```
/// use searoom::report::document::ViolationDocument;
///
/// let text = r#"{ "what": "own hull meets the hull of ferry", "t_s": 129.5 }"#;
/// let read: ViolationDocument = serde_json::from_str(text)?;
/// assert_eq!(read.t_s, Some(129.5));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct ViolationDocument {
    pub what: String,
    pub t_s: Option<f64>,
}

/// The figures of a plan.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::report::document::{PlanDocument, CostDocument};
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let plan = PlanDocument::of(&pipeline::run(scenario));
/// let cost: &CostDocument = plan.cost.as_ref().expect("there is room");
/// assert!(cost.arrived && cost.max_risk == 0.0);
/// assert!(cost.min_clearance_m > Some(20.0) && cost.delay_s < Some(15.0));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct CostDocument {
    pub objective: f64,
    pub space_time_error_m2: f64,
    /// Until when that is counted.
    pub space_time_error_until_s: f64,
    pub space_time_error_arc_length_m2: f64,
    pub arrived: bool,
    pub duration_s: f64,
    pub length_m: f64,
    /// Null for a plan that never arrives.
    pub delay_s: Option<f64>,
    /// Against the sets of which `obstacles` are the level sets.
    pub max_risk: f64,
    /// Null without targets.
    pub min_clearance_m: Option<f64>,
    /// The same over `arrival_hold_s` after the end of the motion, own ship lying where it ends.
    #[serde(default)]
    pub hold_clearance_m: Option<f64>,
    #[serde(default)]
    pub arrival_hold_s: f64,
    /// Least distance between own hull and land; null without land.
    pub min_land_distance_m: Option<f64>,
}

/// What the search did.
///
/// # Examples
///
/// ```
/// use searoom::report::document::SearchStatsDocument;
///
/// let text = r#"{ "expanded": 8, "generated": 59, "edges_checked": 18 }"#;
/// let read: SearchStatsDocument = serde_json::from_str(text)?;
/// assert!(read.expanded <= read.generated);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct SearchStatsDocument {
    pub expanded: usize,
    pub generated: usize,
    pub edges_checked: usize,
}

/// The only figure that differs between two runs.
///
/// # Examples
///
/// ```
/// use searoom::report::document::TimingDocument;
///
/// let text = r#"{ "plan_s": 0.004 }"#;
/// let read: TimingDocument = serde_json::from_str(text)?;
/// assert!(read.plan_s < 0.05, "seconds");
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the name says it")]
pub struct TimingDocument {
    pub plan_s: f64,
}

/// A pose at a time.
///
/// # Examples
///
/// ```
/// use searoom::report::document::StartDocument;
///
/// let text = r#"{ "t_s": 0.0, "east_m": 0.0, "north_m": 0.0, "course_deg": 90.0 }"#;
/// let read: StartDocument = serde_json::from_str(text)?;
/// assert_eq!((read.t_s, read.course_deg), (0.0, 90.0));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct StartDocument {
    pub t_s: f64,
    pub east_m: f64,
    pub north_m: f64,
    pub course_deg: f64,
}

/// A line or an arc; starboard turns are positive.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::report::document::{PlanDocument, SegmentDocument};
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let plan = PlanDocument::of(&pipeline::run(scenario));
/// let trajectory = plan.trajectory.expect("there is room");
/// let segments: Vec<SegmentDocument> = trajectory.segments.expect("lines and arcs");
/// // straight on at first; then to starboard, which is positive here
/// assert_eq!(segments[0].turn_rate_deg_per_s, 0.0);
/// let first_turn = segments.iter().find(|segment| segment.turn_rate_deg_per_s != 0.0);
/// assert!(first_turn.is_some_and(|segment| segment.turn_rate_deg_per_s > 0.0));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct SegmentDocument {
    pub start: StartDocument,
    pub duration_s: f64,
    pub speed_mps: f64,
    pub turn_rate_deg_per_s: f64,
}

/// A pose at a time, with the speed from then on.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::report::document::{PlanDocument, SampleDocument};
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let plan = PlanDocument::of(&pipeline::run(scenario));
/// let trajectory = plan.trajectory.expect("there is room");
/// let second: &SampleDocument = &trajectory.samples[1];
/// assert_eq!((second.t_s, second.east_m, second.speed_mps), (1.0, 5.0, 5.0));
/// assert!(second.node.is_none(), "a plan of forces has them");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct SampleDocument {
    pub t_s: f64,
    pub east_m: f64,
    pub north_m: f64,
    pub course_deg: f64,
    pub speed_mps: f64,
    /// At the nodes of a motion under forces.
    #[serde(flatten, default, skip_serializing_if = "Option::is_none")]
    pub node: Option<NodeDocument>,
}

/// The state at a node, and the forces held until the next one; starboard and clockwise are positive.
///
/// # Examples
///
/// ```
/// use searoom::report::document::NodeDocument;
///
/// let text = r#"{
///     "heading_deg": 90.0, "surge_mps": 0.2, "sway_mps": 0.0, "yaw_rate_deg_per_s": 0.0,
///     "surge_n": 0.25, "sway_n": -0.53, "yaw_nm": -0.23
/// }"#;
/// let read: NodeDocument = serde_json::from_str(text)?;
/// // held until the next node: ahead, to port, and turning to port
/// assert!(read.surge_n > 0.0 && read.sway_n < 0.0 && read.yaw_nm < 0.0);
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names are the units")]
pub struct NodeDocument {
    pub heading_deg: f64,
    pub surge_mps: f64,
    pub sway_mps: f64,
    pub yaw_rate_deg_per_s: f64,
    pub surge_n: f64,
    pub sway_n: f64,
    pub yaw_nm: f64,
}

/// A trajectory, exact and sampled: every second, or every 20,000th part of a longer one, and
/// wherever a segment starts or ends or a node is.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::report::document::{PlanDocument, TrajectoryDocument};
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let plan = PlanDocument::of(&pipeline::run(scenario));
/// let trajectory: TrajectoryDocument = plan.trajectory.expect("there is room");
/// let end = trajectory.samples.last().expect("the last waypoint");
/// assert!((end.east_m - 1500.0).abs() < 1e-3 && trajectory.segments.is_some());
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "the names say it")]
pub struct TrajectoryDocument {
    /// Null for a motion under forces.
    pub segments: Option<Vec<SegmentDocument>>,
    pub samples: Vec<SampleDocument>,
}

/// A convex set of positions.
///
/// # Examples
///
/// ```
/// use searoom::report::document::InitialSetDocument;
///
/// let text = r#"{ "vertices_m": [[0.0, 0.0], [10.0, 0.0], [0.0, 10.0]] }"#;
/// let read: InitialSetDocument = serde_json::from_str(text)?;
/// assert!(matches!(read, InitialSetDocument::Polygon { vertices_m } if vertices_m.len() == 3));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum InitialSetDocument {
    /// Its vertices.
    Polygon {
        /// `[east, north]`, counter-clockwise.
        vertices_m: Vec<[f64; 2]>,
    },
    /// An ellipse.
    Ellipse {
        /// `[east, north]`.
        center_m: [f64; 2],
        /// The rows of the shape matrix.
        shape_m2: [[f64; 2]; 2],
    },
}

/// A convex set of velocities.
///
/// # Examples
///
/// ```
/// use searoom::report::document::VelocitySetDocument;
///
/// let text = r#"{ "center_mps": [5.0, 0.0], "shape_m2_per_s2": [[0.04, 0.0], [0.0, 0.01]] }"#;
/// let read: VelocitySetDocument = serde_json::from_str(text)?;
/// assert!(matches!(read, VelocitySetDocument::Ellipse { center_mps: [5.0, 0.0], .. }));
/// # Ok::<(), serde_json::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum VelocitySetDocument {
    /// Its vertices.
    Polygon {
        /// `[east, north]`, counter-clockwise.
        vertices_mps: Vec<[f64; 2]>,
    },
    /// An ellipse.
    Ellipse {
        /// `[east, north]`.
        center_mps: [f64; 2],
        /// The rows of the shape matrix.
        shape_m2_per_s2: [[f64; 2]; 2],
    },
}

/// A space-time obstacle.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::report::document::{PlanDocument, ObstacleDocument, InitialSetDocument};
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let plan = PlanDocument::of(&pipeline::run(scenario));
/// let ferry: &ObstacleDocument = &plan.obstacles[0];
/// assert_eq!((ferry.name.as_str(), ferry.valid_s), ("target", [0.0, 400.0]));
/// assert!(matches!(ferry.initial_set, InitialSetDocument::Polygon { .. }));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct ObstacleDocument {
    pub name: String,
    pub valid_s: [f64; 2],
    pub initial_set: InitialSetDocument,
    pub velocity_set: VelocitySetDocument,
}

/// A target as it is met. Figures of the plan are null without one.
///
/// # Examples
///
/// ```
/// # use searoom::{pipeline, scenario::Scenario};
/// use searoom::report::document::{PlanDocument, EncounterDocument};
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let plan = PlanDocument::of(&pipeline::run(scenario));
/// let met: &EncounterDocument = &plan.encounters[0];
/// assert_eq!((met.role.as_str(), met.passing_side.as_deref()), ("give-way", Some("port")));
/// assert!(met.dcpa_m > Some(200.0) && met.undisturbed_dcpa_m < Some(0.0));
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(missing_docs, reason = "docs/documents.md says what each key means")]
pub struct EncounterDocument {
    pub target: String,
    pub role: String,
    pub dcpa_m: Option<f64>,
    pub tcpa_s: Option<f64>,
    pub undisturbed_dcpa_m: Option<f64>,
    pub undisturbed_tcpa_s: Option<f64>,
    pub passing_side: Option<String>,
    /// The largest risk along the plan.
    pub max_risk: Option<f64>,
    /// When; null where the risk is 0.
    pub max_risk_t_s: Option<f64>,
    /// What the judges say; absent without a plan and where the target is no ship on a nominal track.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub conduct: Option<ConductDocument>,
}
