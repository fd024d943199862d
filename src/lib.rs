//! Searoom plans how a ship keeps clear of others when nobody knows exactly what they will do.
//!
//! # The problem
//!
//! A target is known by two convex sets: `O_0`, every place where own ship's centre would be too near to
//! her at t = 0, and `V`, every velocity that she may take. At time `t` own ship has to be outside
//!
//! ```text
//! O_t = O_0 ⊕ t V                                    (⊕: every sum of a point of one and a point of the other)
//! ```
//!
//! Because `V` is convex, `O_t` holds whatever she does with a velocity that stays in `V`, changing or
//! not. Own ship is meant to follow the desired trajectory, at `x_d` when it is `t_d`, for `T_d` seconds. A
//! plan is a motion `x(t)` of lines and of arcs with her turning radius, at speeds of a finite set, from
//! her pose at t = 0 to the last waypoint at `T`, or along given paths at any speed up to her greatest. It costs its space-time error
//!
//! ```text
//! J = 1/T_d ∫ min over σ of ( |x(t) - x_d(σ)|² + q (t - t_d(σ))² ) dt          m², t from 0 to T
//! ```
//!
//! and has to satisfy, for every target,
//!
//! ```text
//! x(t) ∉ int O_t    for all 0 <= t <= T,    T <= horizon
//! ```
//!
//! Sets are closed and touching is allowed: planners go at most 1e-7 m deep, the independent check rejects
//! a depth over 1e-6 m ([`tolerance::DEPTH_M`]). Of the candidates that the planner makes, the cheapest
//! clear one wins; that no cheaper plan exists is not claimed.
//!
//! The sets, the graph and the numbers of equations come from A. B. Martinsen and A. M. Lekkas, "Two
//! Space-Time Obstacle Representations Based on Ellipsoids and Polytopes" (2022).
//!
//! # Conventions
//!
//! - Plane: east, north, metres. Headings in radians, counter-clockwise from east. Time in seconds from
//!   the scenario's start, speeds in m/s. Courses (degrees clockwise from true north) and knots exist in
//!   files and reports only; [`frame`] converts.
//! - Port and starboard are [`frame::Side`], never a sign.
//! - Approximations say which way they err: `outer_…` contains what it stands for. Safety rests on these.
//! - Comparisons fail closed: a NaN is a collision.
//! - "No plan" is an [`planner::Outcome`], not an error.
//! - The same input gives the same result. The clock is read for the deadline and for the time taken.
//!
//! # Modules
//!
//! ```text
//! file ─► scenario ─► target ─► obstacle ─► planner ─► trajectory ─► evaluation ─► Run ─► report
//!                    (+ colregs)                                                    └──► recording
//! ```
//!
//! | module | what it holds |
//! | --- | --- |
//! | [`frame`] | the plane, poses, headings; the border to degrees, knots, latitudes and longitudes |
//! | [`tolerance`] | every tolerance with its unit and its reason |
//! | [`geometry`] | convex polygons and ellipses, points and segments included; any polygon, cut into convex pieces |
//! | [`map`] | land from GeoJSON, cut into convex pieces, indexed |
//! | [`search`] | A* and Dijkstra over a graph given by its successors |
//! | [`trajectory`] | lines and arcs in time; the desired trajectory |
//! | [`vessel`] | own ship and her limits; Dubins paths |
//! | [`target`] | a tracked ship and what is not known of her |
//! | [`colregs`] | roles by the rules of the road; the shapes that answer them |
//! | [`obstacle`] | space-time sets: polytopes, ellipsoids, slabs; contact, risk, closest approach, velocity obstacles |
//! | [`planner`] | problem, plan, outcome; the space-time, the path-time and the optimal-control planner |
//! | [`evaluation`] | judges any trajectory, without the sets and contact tests of the planner |
//! | [`verification`] | checks a plan document alone, without scenario and planner |
//! | [`input`] | reading of files: bounded text, values with their places, every fault at once |
//! | [`scenario`] | scenario files; [`scenario::import`]: files of other programs |
//! | [`pipeline`] | scenario → sets → plan → judgement, in one place |
//! | [`simulation`] | random encounters, and targets that do anything their sets allow |
//! | [`study`] | [`study::assess`]: risk and closest approach without a plan; [`study::compare`]: every planner and two baselines on one scenario; [`study::lint`]: faults of a scenario |
//! | [`document`] | the published documents: the one description of a result |
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
//! let evaluation = run.evaluation.as_ref().expect("every plan is judged");
//! assert!(evaluation.verified());
//! // the hulls keep the safety margin, by default one own length, whatever the ferry does within her sets
//! assert!(evaluation.min_clearance >= run.scenario.own_ship.safety_margin);
//! assert!((plan.trajectory.end().position - run.scenario.desired.end()).norm() < 1e-5);
//! ```

#![warn(missing_docs)]

pub mod colregs;
pub mod document;
pub mod evaluation;
pub mod frame;
pub mod geometry;
pub mod input;
pub mod map;
pub mod obstacle;
mod output;
pub mod pipeline;
pub mod planner;
#[cfg(feature = "recording")]
pub mod recording;
pub mod report;
pub mod scenario;
pub mod search;
pub mod simulation;
pub mod study;
pub mod target;
mod text;
pub mod tolerance;
pub mod trajectory;
pub mod verification;
pub mod vessel;
