//! Limits of the numbers in a scenario file. They are far beyond any voyage, and squares, quotients
//! and products with the horizon are still finite; lower limits above zero keep quotients finite.

use searoom_geometry::frame::LARGEST_ORIGIN_LAT_DEG;
use searoom_input::Range;

/// Maximum size of a scenario file in mebibytes.
pub const FILE_MEBIBYTES: u64 = 16;

/// Waypoints of a ship of an imported file: each leg of a target adds a velocity set.
pub(super) const ROUTE_POINTS: usize = 200;
pub(super) const TRACK_POINTS: usize = 20_000;
pub(super) const SHIPS: usize = 1000;

/// Waypoints of a mission: the cost of a plan grows with their square.
pub(super) const WAYPOINTS: usize = 100;
/// Waypoints of a target's known route: each adds up to four velocity sets.
pub(super) const TARGET_WAYPOINTS: usize = 12;
/// Seconds by which a target turns earlier or later.
pub(super) const TIME_SPREAD: Range = Range::between(0.0, 86_400.0);
/// Metres between two waypoints of a mission: on a plane a longer leg is most likely a slip.
pub(super) const LEG_M: f64 = 5e6;
/// Alternatives of a mission: the points that paths share are found pair by pair.
pub(super) const ALTERNATIVES: usize = 20;
/// Speeds of the finite set: the graph grows with the square of their number.
pub(super) const SPEEDS: usize = 20;

/// Metres east or north of the origin.
pub(super) const COORDINATE: Range = Range::within(1e7);
/// Degrees north of the equator.
pub(super) const LATITUDE: Range = Range::within(90.0);
/// Degrees north of the origin: at a pole no direction is north.
pub(super) const ORIGIN_LATITUDE: Range = Range::within(LARGEST_ORIGIN_LAT_DEG);
/// Degrees east of Greenwich.
pub(super) const LONGITUDE: Range = Range::within(180.0);
/// Metres: lengths, beams, turning radii, legs.
pub(super) const LENGTH: Range = Range::between(1e-3, 1e6);
/// Metres: margins, domains, standard deviations.
pub(super) const DISTANCE: Range = Range::between(0.0, 1e6);
/// Size of a ship in an imported file: no ship is longer than half a kilometre, no tow than two.
pub(super) const SHIP_LENGTH: Range = Range::between(0.1, 2000.0).in_unit("m");
/// Speed of a ship in an imported file: nearly 100 knots, beyond every ship.
pub(super) const SHIP_SPEED: Range = Range::between(0.0, 50.0).in_unit("m/s");
/// [`SHIP_SPEED`] of a ship that makes way.
pub(super) const SHIP_WAY: Range = Range::between(1e-3, 50.0).in_unit("m/s");
/// Seconds: horizon, deadline.
pub(super) const DURATION: Range = Range::between(1e-3, 1e6);
/// Seconds at a speed between two changes.
pub(super) const SPEED_TIME: Range = Range::between(0.0, 86_400.0);
/// Seconds before the closest approach.
pub(super) const BEFORE_CPA: Range = Range::between(0.0, 86_400.0);
/// Seconds on the clock of a file: also those of the year 2200 since 1970.
pub(super) const CLOCK: Range = Range::between(0.0, 1e10);
/// Seconds on that clock, not in the future.
pub(super) fn until(now: f64) -> Range {
    Range::between(CLOCK.low, now).in_unit("(the present, 'time_s')")
}
/// Seconds on that clock, up to the end of the longest horizon.
pub(super) const STAY: Range = Range::between(0.0, 1.0001e10);
/// Seconds after arrival.
pub(super) const HOLD: Range = Range::between(0.0, 1e6);
/// m/s on a leg.
pub(super) const WAY: Range = Range::between(1e-3, 100.0);
/// m/s, or standing still.
pub(super) const SPEED: Range = Range::between(0.0, 100.0);
/// m/s of the finite set: standing still, or a speed that makes way.
pub(super) const CHOSEN_SPEED: Range = Range::between(1e-3, 100.0).or_zero();
/// m/s, one component of a vertex of a velocity set.
pub(super) const VELOCITY: Range = Range::within(100.0);
/// Degrees; a course below 0 or above 360 is the one a full circle away.
pub(super) const COURSE: Range = Range::within(360.0);
/// m/s².
pub(super) const ACCELERATION: Range = Range::between(1e-4, 100.0);
/// Degrees, half a full circle to either side.
pub(super) const COURSE_SPREAD: Range = Range::between(0.0, 180.0);
/// Degrees to starboard, to port where negative.
pub(super) const STARBOARD_TURN: Range = Range::within(180.0);
/// Degrees per second.
pub(super) const TURN_RATE: Range = Range::between(0.0, 90.0);
/// Accepted risk: with 1 a plan would keep clear of nothing but the nominal target.
pub(super) const RISK: Range = Range::between(0.0, 0.999_999);
/// m² and m²/s², the entries of a shape matrix.
pub(super) const AREA: Range = Range::within(1e14);
/// See [`AREA`].
pub(super) const VELOCITY_AREA: Range = Range::within(1e4);
/// Velocity sets of one target: each has the edges of all before it.
pub(super) const VELOCITY_SETS: usize = 50;
/// m²/s², the weight of time.
pub(super) const TIME_WEIGHT: Range = Range::between(0.0, 1e6);

/// Newtons, newton metres: far below the forces of a model, far above those of a ship.
pub(super) const FORCE: Range = Range::between(1e-6, 1e12);
/// Weight of a state in the stage cost; 0 leaves the state free.
pub(super) const STATE_WEIGHT: Range = Range::between(0.0, 1e9);
/// Weight of a force in the stage cost: with 0 the force would not be determined.
pub(super) const FORCE_WEIGHT: Range = Range::between(1e-24, 1e9);
pub(super) const INTERVALS: Range = Range::between(1.0, 2000.0);
