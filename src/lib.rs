//! Collision avoidance for ships among targets with uncertain motion.
//!
//! # The problem
//!
//! Two convex sets describe a target. `O_0` contains every position where own ship's centre would
//! be too near to the target at t = 0. `V` contains every velocity that the target may have. At
//! time `t` own ship must be outside the Minkowski sum
//!
//! ```text
//! O_t = O_0 ⊕ t V
//! ```
//!
//! `V` is convex, so `O_t` holds for every velocity that stays in `V`, constant or not. Own ship
//! should follow the desired trajectory, which is at `x_d` at `t_d` and lasts `T_d` seconds. A plan
//! is a motion `x(t)` of lines and of arcs with the turning radius, at speeds of a finite set, from
//! the pose at t = 0 to the last waypoint at `T`. Alternatively it follows given paths at any speed
//! up to the maximum. Its cost is the space-time error
//!
//! ```text
//! J = 1/T_d ∫ min over σ of ( |x(t) - x_d(σ)|² + q (t - t_d(σ))² ) dt          m², t from 0 to T
//! ```
//!
//! It must satisfy, for every target,
//!
//! ```text
//! x(t) ∉ int O_t    for all 0 <= t <= T,    T <= horizon
//! ```
//!
//! Sets are closed and touching is allowed. Planners go at most 1e-7 m deep; the independent check
//! rejects a depth over 1e-6 m ([`tolerance::DEPTH_M`]). The planner returns the cheapest clear
//! candidate that it found. It does not claim that no cheaper plan exists.
//!
//! The sets, the graph and the numbers of equations come from A. B. Martinsen and A. M. Lekkas,
//! "Two Space-Time Obstacle Representations Based on Ellipsoids and Polytopes" (2022).
//!
//! # Conventions
//!
//! - Plane: east, north, metres. Headings in radians, counter-clockwise from east. Time in seconds
//!   from the scenario's start, speeds in m/s. Courses (degrees clockwise from true north) and
//!   knots exist in files and reports only; [`frame`] converts.
//! - Port and starboard are [`frame::Side`], never a sign.
//! - Names of approximations state the direction of the error: `outer_…` contains the exact set.
//!   Safety relies on these.
//! - Comparisons fail closed: a NaN is a collision.
//! - "No plan" is a [`planner::Outcome`], not an error.
//! - Equal input gives equal results. The clock is read for the deadline and for the time taken.
//!
//! # Modules
//!
//! ```text
//! file ─► scenario ─► target ─► obstacle ─► planner ─► trajectory ─► evaluation ─► Run ─► report
//!                    (+ colregs)                                                    └──► recording
//! ```
//!
//! | module | contents |
//! | --- | --- |
//! | [`frame`] | plane, poses, headings; conversion to degrees, knots, latitudes and longitudes |
//! | [`tolerance`] | every tolerance with its unit and its reason |
//! | [`geometry`] | convex sets (polygon or ellipse); polygons and their decomposition into convex pieces |
//! | [`map`] | land from GeoJSON, cut into convex pieces, indexed |
//! | [`search`] | A* and Dijkstra over a graph defined by its successors |
//! | [`trajectory`] | lines and arcs in time; the desired trajectory |
//! | [`vessel`] | own ship and its limits; Dubins paths; manoeuvring models |
//! | [`target`] | a tracked ship or explicit sets, with their uncertainty |
//! | [`colregs`] | roles under the COLREGs; ship domains |
//! | [`obstacle`] | space-time sets: polytopes, ellipsoids, slabs; contact, risk, closest approach, velocity obstacles |
//! | [`planner`] | problem, plan, outcome; the list of planners: space-time, path-time, optimal control |
//! | [`evaluation`] | independent evaluation of a trajectory, without the planner's sets and contact tests |
//! | [`verification`] | checks a plan document alone, without scenario and planner |
//! | [`input`] | reading of files: bounded text, values with their positions, all faults at once |
//! | [`scenario`] | scenario files; [`scenario::import`]: files of other programs |
//! | [`pipeline`] | scenario → sets → plan → evaluation |
//! | [`traffic`] | AIS and other feeds; the ships around own ship as targets |
//! | [`replanning`] | what a plan leaves to the next one |
//! | [`simulation`] | scenarios sailed in the closed loop |
//! | `campaign` | many random encounters sailed, in parts that are merged and counted (feature `campaign`, on by default) |
//! | [`study`] | [`study::assess`]: risk and closest approach without a plan; [`study::compare`]: every planner and two baselines on one scenario; [`study::lint`]: faults of a scenario |
//! | [`document`] | published documents: the single description of a result |
//! | [`report`] | tables, HTML pages and figures |
//! | `recording` | Rerun recordings (feature `recording`, on by default) |
//!
//! # Example
//!
//! ```
//! use searoom::pipeline;
//! use searoom::report::plan_text;
//! use searoom::scenario::Scenario;
//!
//! let scenario = Scenario::parse(
//!     r#"
//!     title = "Head-on"
//!     horizon_s = 400.0
//!
//!     [own_ship]
//!     position = { east_m = 0.0, north_m = 0.0 }
//!     course_deg = 90.0
//!     speed_mps = 5.0
//!     length_m = 30.0
//!     beam_m = 8.0
//!     turning_radius_m = 100.0
//!
//!     [mission]
//!     waypoints = [{ east_m = 0.0, north_m = 0.0 }, { east_m = 1500.0, north_m = 0.0 }]
//!
//!     [[targets]]
//!     name = "ferry"
//!     position = { east_m = 1500.0, north_m = 0.0 }
//!     course_deg = 270.0
//!     speed_mps = 5.0
//!     length_m = 60.0
//!     beam_m = 12.0
//!     speed_spread_mps = 0.5
//!     course_spread_deg = 5.0
//!     "#,
//! )
//! .expect("no faults");
//!
//! let run = pipeline::run(scenario);
//! println!("{}", plan_text(&run));
//!
//! let plan = run.planned.outcome.plan().expect("there is room");
//! let evaluation = run.evaluation.as_ref().expect("every plan is evaluated");
//! assert!(evaluation.verified());
//! // hulls keep the safety margin, by default one own length, for every motion within the sets
//! assert!(evaluation.min_clearance >= run.scenario.own_ship.safety_margin);
//! assert!((plan.trajectory.end().position - run.scenario.desired.end()).norm() < 1e-5);
//! ```

#![forbid(unsafe_code)]
#![warn(missing_docs)]
#![cfg_attr(
    not(feature = "cli"),
    allow(
        dead_code,
        unused_imports,
        reason = "what figures, campaigns and the program share is not used without them"
    )
)]

// the random encounters of the tests name the crate as its users do
#[cfg(test)]
extern crate self as searoom;

#[cfg(test)]
#[path = "../crates/geometry/src/geometry_fixtures.rs"]
mod geometry_fixtures;
#[cfg(test)]
#[path = "../crates/model/src/ship_fixtures.rs"]
mod ship_fixtures;

#[cfg(feature = "campaign")]
pub mod campaign;
pub mod document;
mod labels;
mod output;
pub mod pipeline;
mod publication;
#[cfg(feature = "recording")]
pub mod recording;
pub mod replanning;
pub mod report;
pub mod simulation;
pub mod study;
pub mod traffic;

// the libraries, by the names of their topics
pub use searoom_colregs as colregs;
pub use searoom_evaluation as evaluation;
pub use searoom_geometry as geometry;
pub use searoom_geometry::{frame, tolerance};
pub use searoom_input as input;
pub use searoom_model::{target, trajectory, vessel};
pub use searoom_planner as planner;
pub use searoom_planner::search;
pub use searoom_scenario as scenario;
pub use searoom_scenario::map;
pub use searoom_sets as obstacle;
pub use searoom_verification as verification;

use searoom_geometry::numerics;
use searoom_input::text;
use searoom_parallel as parallel;
