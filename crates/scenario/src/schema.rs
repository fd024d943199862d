//! The JSON schema of scenario files, from the limits and words of the reader.

use serde_json::{Value, json};

use super::check::{CAUTIONS, DEFAULT_ARRIVAL_HOLD, DEFAULT_DEADLINE, FROM_WAYPOINT};
use super::land::POINT_RADIUS;
use super::limits::*;
use super::simulation::*;
use super::{BehaviourKind, Compliance, SensorType};
use searoom_colregs::Role;
use searoom_input::Range;
use searoom_input::schema::{Schema, choice, having, line_of_text, list, number, or, whole_number};
use searoom_model::SailedVessel;
use searoom_model::target::Representation;
use searoom_model::target::Status;
use searoom_model::vessel::VesselKind;
use searoom_planner::{DEFAULT_PLANNER, ObjectiveKind, SearchKind, planner_words};

/// A table of the schema with more keys, a row each: how it is read, its name, its value. The
/// comment above it is its meaning.
macro_rules! keys {
    ($table:expr; $($(#[doc = $meaning:literal])* $method:ident $key:ident = $value:expr;)*) => {
        $table$(.$method(stringify!($key), $value, concat!($($meaning),*).trim()))*
    };
}

/// The JSON schema (draft 7) of a scenario file, for editors. It says what the reader accepts, key
/// by key; what one key says of another is left to the reader.
pub fn scenario_schema() -> Value {
    let about = "A scenario file of Searoom (docs/reference/scenario.md). `searoom check` tells \
                 what a schema cannot";
    let any_velocity = velocities("Every velocity that the target may take, m/s");
    let corners = list(1.., list(2..=2, number(COORDINATE)));
    let meaning = "Corners of a convex set, [east, north] in metres, in any order";
    let any_place = Schema::table("Every place of the hull's centre about a ship's position")
        .require("vertices_m", corners, meaning);
    let definitions = json!({
        "position": position().finish(),
        "position_set": any_place.finish(),
        "velocity_set": any_velocity.finish(),
    });
    let table = Schema::table(about)
        .with("$schema", "http://json-schema.org/draft-07/schema#")
        .with("title", "Searoom scenario")
        .with("definitions", definitions);
    let table = keys! { table;
        /// Title of the scenario
        require title = line_of_text();
        /// Latest arrival, seconds after the present
        require horizon_s = number(DURATION);
        /// The present on the clock of the file
        optional time_s = or(0, number(CLOCK));
        /// Date and time at 0 on the clock of the file, for routes and tables of legs
        optional start_utc = json!({ "type": "string", "format": "date-time" });
        /// Time after arrival over which the clearance of own ship at rest is reported
        optional arrival_hold_s = or(DEFAULT_ARRIVAL_HOLD, number(HOLD));
        /// The place of east 0, north 0; required with a map, a route or positions in degrees
        optional origin = origin();
        /// Input on safety that the program which wrote this file has left out, a line each
        optional cautions = list(0..=CAUTIONS, line_of_text());
        /// A GeoJSON file of land, relative to this file
        optional map = json!({ "anyOf": [text(), map().finish()] });
        require own_ship = own_ship();
        require mission = mission();
        optional planner = planner();
        /// The targets
        optional targets = list(0.., target());
        optional simulation = simulation();
    };
    table.finish()
}

fn text() -> Value {
    json!({ "type": "string" })
}

fn defined(name: &str) -> Value {
    json!({ "$ref": format!("#/definitions/{name}") })
}

fn words<const N: usize>(words: [&str; N]) -> Value {
    choice(&words.map(|word| (word, ())))
}

fn map() -> Schema {
    keys! { Schema::table("");
        /// The GeoJSON file, relative to this file
        require file = text();
        /// Radius of points and half the width of lines; without it they are skipped
        optional point_radius_m = number(POINT_RADIUS);
    }
}

fn origin() -> Schema {
    keys! { Schema::table("");
        /// Degrees north
        require lat_deg = number(ORIGIN_LATITUDE);
        /// Degrees east
        require lon_deg = number(LONGITUDE);
    }
}

fn position() -> Schema {
    let about = "A place: metres from the origin, or degrees (WGS84) where the file has an origin";
    let pairs = having(&[&["east_m", "north_m"], &["lat_deg", "lon_deg"]]);
    keys! { Schema::table(about).with("oneOf", pairs);
        /// Metres east of the origin
        optional east_m = number(COORDINATE);
        /// Metres north of the origin
        optional north_m = number(COORDINATE);
        /// Degrees north
        optional lat_deg = number(LATITUDE);
        /// Degrees east
        optional lon_deg = number(LONGITUDE);
    }
}

fn own_ship() -> Schema {
    keys! { Schema::table("Own ship at the present");
        require position = defined("position");
        /// Heading, clockwise from true north
        require course_deg = number(COURSE);
        /// Speed
        required_speed speed = SPEED;
        /// Length of the hull, a rectangle
        require length_m = number(LENGTH);
        /// Beam of the hull
        require beam_m = number(LENGTH);
        /// Least radius of a turn at every speed
        required_distance turning_radius = LENGTH;
        /// Speeds that own ship may use, 0 to be able to stop; by default half of its speed, its
        /// speed, and the speeds of the mission
        distinct_speeds speeds = CHOSEN_SPEED;
        /// Distance kept between the hulls; own length by default
        distance safety_margin = DISTANCE;
        /// Part of the safety margin that own ship may use to be off its plan; 0 by default
        distance tracking_margin = DISTANCE;
        /// How fast own ship changes its speed
        optional acceleration_mps2 = number(ACCELERATION);
        /// Distance kept between own hull and land; 0 by default
        distance land_margin = DISTANCE;
    }
}

fn mission() -> Schema {
    let ways = having(&[&["waypoints"], &["route"]]);
    let path = list(2..=WAYPOINTS, defined("position"));
    keys! { Schema::table("The desired trajectory").with("oneOf", ways);
        /// Beginning of the mission on the clock of the file; time_s by default
        optional start_s = number(CLOCK);
        /// Waypoints, from the first to the last; one where own ship stays there
        optional waypoints = list(1..=WAYPOINTS, defined("position"));
        /// Time on the clock of the file until which own ship lies at the last waypoint after its
        /// arrival, at most the end of the horizon; that end by default for one waypoint
        optional stay_until_s = number(STAY);
        /// A route file (RTZ 1.0 to 1.2) in place of waypoints, relative to this file
        optional route = text();
        /// Name or id of the schedule of the route; the first one by default
        optional schedule = line_of_text();
        /// Waypoint of the route at which the mission begins, counted from 1
        optional from_waypoint = whole_number(FROM_WAYPOINT);
        /// Begins at the place of the route nearest to own ship, in place of from_waypoint
        optional from_nearest = json!({ "type": "boolean" });
        /// Speed on every leg; own ship's by default
        speed speed = WAY;
        /// One speed per leg, in place of one speed
        speeds leg_speeds = WAY;
        /// Other paths for the path-time planner
        optional alternatives = list(1..=ALTERNATIVES, path);
    }
}

fn planner() -> Schema {
    use ObjectiveKind::{Length, LengthRisk, SpaceTimeError, Time};
    let objectives = [SpaceTimeError, Time, Length, LengthRisk].map(ObjectiveKind::word);
    keys! { Schema::table("The planner and its settings");
        /// The planner
        optional kind = or(DEFAULT_PLANNER.facts().name, choice(&planner_words()));
        /// The search of the graph
        optional search = or(SearchKind::AStar.word(), choice(SearchKind::WORDS));
        /// What the path-time planner minimises
        optional objective = or(objectives[0], words(objectives));
        /// Metres of detour worth avoiding a risk of 1; only with length-risk
        optional risk_weight_m = number(DISTANCE);
        /// Hard sets alone, ship domains, or ship domains and manoeuvres by the rules
        optional compliance = choice(Compliance::WORDS);
        /// Restricted: Rule 19 in place of Rules 13 to 17
        optional visibility = or("good", words(["good", "restricted"]));
        /// A ship is at risk of collision where it is nearest within this time
        optional tcpa_limit_s = number(BEFORE_CPA);
        /// and within this distance
        distance cpa_limit = DISTANCE;
        /// Own ship alters course at least this long before the closest approach
        optional ample_time_s = number(BEFORE_CPA);
        /// Few turns and changes of speed; true by default under the rules
        optional tidy = json!({ "type": "boolean" });
        /// Least time at a speed between two changes in a tidy plan
        optional min_speed_time_s = number(SPEED_TIME);
        /// Weight of a second of delay against metres
        optional time_weight_m2_per_s2 = number(TIME_WEIGHT);
        /// Accepted risk
        optional max_risk = or(0, number(RISK));
        /// Wall clock for one plan
        optional deadline_s = or(DEFAULT_DEADLINE, number(DURATION));
        optional optimal_control = optimal_control();
    }
}

fn optimal_control() -> Schema {
    let forces = keys! { Schema::table("Largest forces in both directions");
        /// Surge force, newtons
        require surge_n = number(FORCE);
        /// Sway force, newtons
        require sway_n = number(FORCE);
        /// Yaw moment, newton metres
        require yaw_nm = number(FORCE);
    };
    keys! { Schema::table("Settings of the optimal-control planner");
        /// The ship under forces
        optional vessel = or(VesselKind::CyberShip2.word(), choice(&VesselKind::WORDS));
        optional force_limits = forces;
        /// Intervals of the horizon
        optional intervals = or(50, whole_number(INTERVALS));
        /// Weights on the errors in east, north, heading, surge, sway and yaw rate
        optional state_weights = list(6..=6, number(STATE_WEIGHT));
        /// Weights on surge force, sway force and yaw moment
        optional control_weights = list(3..=3, number(FORCE_WEIGHT));
    }
}

fn target() -> Schema {
    let about = "A tracked ship, or explicit sets of positions and velocities";
    let ship = json!({
        "required": ["position", "length_m", "beam_m"],
        "allOf": [
            { "anyOf": having(&[&["course_deg"], &["waypoints"]]) },
            { "anyOf": having(&[&["speed_mps"], &["speed_kn"]]) },
        ],
    });
    let sets = json!({
        "required": ["initial_set"],
        "anyOf": having(&[&["velocity_set"], &["velocity_sets"]]),
    });
    let initial = "Explicit set of positions at the start, in place of a ship";
    let initial = set(
        initial,
        ["vertices_m", "center_m", "shape_m2"],
        COORDINATE,
        AREA,
    );
    let timed = keys! { velocities("");
        /// Seconds after the start at which the set ends
        optional until_s = number(DURATION);
    };
    let roles: Vec<_> = Role::with_rule().collect();
    keys! { Schema::table(about).with("anyOf", json!([ship, sets]));
        /// Name, different from every other target's
        require name = line_of_text();
        optional position = defined("position");
        /// Estimated course, clockwise from true north; by default that of the first leg of
        /// waypoints
        optional course_deg = number(COURSE);
        /// Estimated speed
        speed speed = SPEED;
        /// Length of the hull
        optional length_m = number(LENGTH);
        /// Beam of the hull
        optional beam_m = number(LENGTH);
        /// Standard deviation of the position, per axis; the sets hold three of them
        optional position_std_m = or(0, number(DISTANCE));
        /// Every place of the hull's centre, in metres east and north of the position
        optional position_set = defined("position_set");
        /// How far the hull may be turned from course_deg to either side; by default as far as the
        /// course may be
        optional heading_spread_deg = number(COURSE_SPREAD);
        /// Standard deviation of the measured speed
        speed speed_std = SPEED;
        /// Standard deviation of the measured course
        optional course_std_deg = or(0, number(COURSE_SPREAD));
        /// How much the target may change its speed
        speed speed_spread = SPEED;
        /// How much it may change its course to either side
        optional course_spread_deg = or(0, number(COURSE_SPREAD));
        /// The known route after the position
        optional waypoints = list(1..=TARGET_WAYPOINTS, defined("position"));
        /// One speed for each waypoint
        speeds leg_speeds = WAY;
        /// How much earlier or later it may alter course at a waypoint
        optional time_spread_s = or(0, number(TIME_SPREAD));
        /// How much farther to starboard it may steer at any time; negative to port
        optional starboard_turn_deg = or(0, number(STARBOARD_TURN));
        /// Fastest turn to either side
        optional turn_rate_deg_per_s = or(0, number(TURN_RATE));
        /// The ship domain: a name, or the sides of a box from the hull's edges
        optional domain = or("colregs", domain());
        /// Own ship's role toward this target from before; by default it follows from the geometry
        optional role = choice(&roles);
        /// When that role began, on the clock of the file
        optional role_since_s = number(CLOCK);
        /// Own ship's course then
        optional first_course_deg = number(COURSE);
        /// Polygons, or the smallest ellipses around them
        optional representation = or("polytope", choice(Representation::WORDS));
        /// Navigational status; no plan follows from it
        optional status = choice(Status::WORDS);
        optional initial_set = initial;
        optional velocity_set = defined("velocity_set");
        /// Explicit velocities one after another; the last has no until_s
        optional velocity_sets = list(1..=VELOCITY_SETS, timed);
        optional behaviour = behaviour();
        /// What the target's AIS reports leave out in a simulation
        optional not_reported = list(0..=2, words(["heading", "size"]));
        /// Seconds after the start from which own ship can see the target in a simulation; plans
        /// do not use it
        optional seen_from_s = or(0, number(HOLD));
    }
}

fn domain() -> Value {
    let sides = keys! { Schema::table("Sides of a box, from the hull's edges");
        /// Ahead
        required_distance fore = DISTANCE;
        /// Astern
        required_distance aft = DISTANCE;
        /// To port
        required_distance port = DISTANCE;
        /// To starboard
        required_distance starboard = DISTANCE;
    };
    json!({ "anyOf": [words(["colregs", "paper", "hull"]), sides.finish()] })
}

/// A polygon or an ellipse with these keys of its vertices, its centre and its shape.
fn set(about: &str, [vertices, center, shape]: [&str; 3], range: Range, areas: Range) -> Schema {
    let pair = |range| list(2..=2, number(range));
    let corners = "Corners of a convex set, [east, north], in any order";
    let matrix =
        "Shape matrix [[a, b], [b, c]] of the ellipse, symmetric and positive semidefinite";
    Schema::table(about)
        .with("oneOf", having(&[&[vertices], &[center, shape]]))
        .optional(vertices, list(1.., pair(range)), corners)
        .optional(center, pair(range), "Centre of an ellipse, [east, north]")
        .optional(shape, list(2..=2, pair(areas)), matrix)
}

fn velocities(about: &str) -> Schema {
    let keys = ["vertices_mps", "center_mps", "shape_m2_per_s2"];
    set(about, keys, VELOCITY, VELOCITY_AREA)
}

fn behaviour() -> Schema {
    let about = "How the target moves in a simulation; plans do not use it";
    let point = keys! { Schema::table("");
        /// Seconds after the start, increasing
        require t_s = number(DURATION);
        require position = defined("position");
    };
    keys! { Schema::table(about);
        /// The motion
        require kind = choice(BehaviourKind::WORDS);
        /// Seconds from one change to the next: 20 by default, 5 with pursuit
        optional every_s = number(TIME_CONSTANT);
        /// Times the spreads of the target; above 1 breaks the assumption of the plans
        optional factor = or(1, number(FACTOR));
        /// Turn of a target that gives way, positive to starboard
        optional turn_deg = or(40, number(TURN_DEG));
        /// Seconds before the closest approach at which it turns
        optional before_cpa_s = or(240, number(DURATION));
        /// Probability that it gives way
        optional probability = or(1, number(PROBABILITY));
        /// Rate of that turn
        optional turn_rate_deg_per_s = or(2, number(TURN_RATE));
        /// Places and times of a track
        optional points = list(1.., point);
    }
}

fn simulation() -> Schema {
    let about = "How `searoom simulate` sails the scenario; plans do not use it";
    let default = SimulationSettings::default();
    keys! { Schema::table(about);
        /// Longest step
        optional step_s = or(default.step, number(STEP));
        /// Time from plan to plan
        optional replan_s = or(default.replan, number(DURATION));
        /// When to plan again: after replan_s alone, or also on events
        optional replan = or("period", words(["period", "events"]));
        /// Time from the data of a plan to its start
        optional delay_s = or(default.delay, number(DELAY));
        /// End of the simulation; horizon_s by default
        optional duration_s = number(DURATION);
        /// Seed of all random numbers
        optional seed = or(default.seed, whole_number(SEED));
        optional vessel = vessel();
        optional current = current();
        optional sensor = sensor();
    }
}

fn vessel() -> Schema {
    use SailedVessel::{FirstOrder, Kinematic, Nomoto};
    let kinds = [Kinematic, FirstOrder, Nomoto].map(SailedVessel::word);
    keys! { Schema::table("Own ship's true motion");
        /// The model
        require kind = or(kinds[0], words(kinds));
        /// Time constant of the turn rate
        optional course_time_s = or(3, number(TIME_CONSTANT));
        /// Time constant of the speed
        optional speed_time_s = or(5, number(TIME_CONSTANT));
        /// K' of Nomoto's model
        optional gain = or(1, number(NOMOTO));
        /// T' of Nomoto's model
        optional time = or(1, number(NOMOTO));
        /// Largest rudder angle
        optional rudder_deg = or(35, number(RUDDER_DEG));
        /// Largest rate of the rudder
        optional rudder_rate_deg_per_s = or(5, number(RUDDER_DEG));
    }
}

fn current() -> Schema {
    keys! { Schema::table("Motion of the water");
        /// Constant part
        speed speed = CURRENT;
        /// Direction into which it flows
        optional toward_deg = or(0, number(COURSE));
        /// Standard deviation of the random part
        optional std_mps = or(0, number(CURRENT));
        /// Time constant of the random part
        optional time_s = or(600, number(TIME_CONSTANT));
        /// Whether own ship steers for it
        optional known = or("no", words(["yes", "no"]));
    }
}

fn noise(about: &str) -> Schema {
    keys! { Schema::table(about);
        /// Error of a position, per axis
        optional position_std_m = number(DISTANCE);
        /// Error of the course
        optional course_std_deg = number(ANGLE_STD_DEG);
        /// Error of the speed
        optional speed_std_mps = number(SPEED);
    }
}

fn sensor() -> Schema {
    let hull = Sensor::EXACT.default_hull;
    let assumed = "Errors that the tracker assumes; the true ones by default";
    let dropout = keys! { Schema::table("Random drop-outs, per target");
        /// Mean time between them
        require every_s = number(TIME_CONSTANT);
        /// Mean time of one
        require lasts_s = number(TIME_CONSTANT);
    };
    keys! { noise("How own ship sees the targets");
        /// The sensor
        require kind = or(SensorType::Exact.word(), choice(SensorType::WORDS));
        /// Distance of the centres beyond which no target is seen; without limit by default
        optional range_m = number(LENGTH);
        /// Class of the AIS reports
        optional class = or("a", words(["a", "b"]));
        /// Time between reports; by default that of the class, 3 for radar
        optional interval_s = number(TIME_CONSTANT);
        optional assumed = noise(assumed);
        /// Root of the spectral density of the acceleration that the tracker assumes, m/s^1.5
        optional acceleration = or(0.02, number(CURRENT));
        /// Time from a measurement to its arrival
        optional latency_s = or(0, number(DELAY));
        /// Probability that a report arrives
        optional detection = or(1, number(DETECTION));
        /// Times without any report, [from, until]
        optional silent_s = list(0..=SILENT_TIMES, list(2..=2, number(HOLD)));
        optional dropout = dropout;
        /// Length of a target that does not report its size
        optional default_length_m = or(hull.length, number(SHIP_LENGTH));
        /// Beam of such a target
        optional default_beam_m = or(hull.beam, number(SHIP_LENGTH));
        /// Time of reports before the start
        optional settle_s = or(60, number(DELAY));
        /// A target that is silent for longer is named by an alarm
        optional stale_s = or(180, number(TIME_CONSTANT));
    }
}
