//! Explicit sets of a target: polygons or ellipses, with one velocity set or several over time.

use nalgebra::Matrix2;

use super::limits;
use searoom_geometry::{ConvexPolygon, ConvexSet, Ellipse, GeometryError};
use searoom_input::{Field, Range, Table, every};
use searoom_model::target::{TimedVelocitySet, Uncertainty};

/// Allowed values of the keys of a tracked ship beside explicit sets.
const BESIDE_SETS: &str = "nothing beside the sets: they are taken as they are";

const SHIP_KEYS: [&str; 22] = [
    "position",
    "course_deg",
    "length_m",
    "beam_m",
    "position_std_m",
    "position_set",
    "heading_spread_deg",
    "speed_std_mps",
    "speed_std_kn",
    "course_std_deg",
    "course_spread_deg",
    "starboard_turn_deg",
    "turn_rate_deg_per_s",
    "domain",
    "speed_mps",
    "speed_kn",
    "speed_spread_mps",
    "speed_spread_kn",
    "waypoints",
    "leg_speeds_mps",
    "leg_speeds_kn",
    "time_spread_s",
];

struct SetKeys {
    vertices: &'static str,
    center: &'static str,
    shape: &'static str,
    range: Range,
    areas: Range,
}

impl SetKeys {
    fn allowed(&self) -> String {
        let Self {
            vertices,
            center,
            shape,
            ..
        } = self;
        format!("a table {{ {vertices} }} or {{ {center}, {shape} }}")
    }
}

const INITIAL: SetKeys = SetKeys {
    vertices: "vertices_m",
    center: "center_m",
    shape: "shape_m2",
    range: limits::COORDINATE,
    areas: limits::AREA,
};

const VELOCITY: SetKeys = SetKeys {
    vertices: "vertices_mps",
    center: "center_mps",
    shape: "shape_m2_per_s2",
    range: limits::VELOCITY,
    areas: limits::VELOCITY_AREA,
};

/// The sets of a target that has at least one of the keys of explicit sets.
pub(super) fn sets(table: &mut Table) -> Option<Uncertainty> {
    for key in SHIP_KEYS {
        table.forbid(key, BESIDE_SETS);
    }
    let initial = table
        .require("initial_set", INITIAL.allowed())
        .and_then(|field| set(&field, &INITIAL));
    let velocities = match table.take("velocity_sets") {
        Some(several) => {
            if let Some(one) = table.take("velocity_set") {
                one.fault(
                    "velocity_set beside velocity_sets",
                    "one of the two, not both",
                );
            }
            timed_velocity_sets(&several, initial.as_ref())
        }
        None => {
            let field = table.require("velocity_set", VELOCITY.allowed())?;
            let velocities = set(&field, &VELOCITY);
            let velocities = velocities.and_then(|set| like(&field, set, initial.as_ref()));
            velocities.map(|set| vec![TimedVelocitySet::new(f64::INFINITY, set)])
        }
    };
    Some(Uncertainty {
        initial: initial?,
        velocities: velocities?,
    })
}

/// A velocity set, if it is of the kind of the initial set.
fn like(field: &Field, velocities: ConvexSet, initial: Option<&ConvexSet>) -> Option<ConvexSet> {
    let found = match (initial, &velocities) {
        (Some(ConvexSet::Polygon(_)), ConvexSet::Ellipse(_)) => {
            "an ellipse for an initial set that is a polygon"
        }
        (Some(ConvexSet::Ellipse(_)), ConvexSet::Polygon(_)) => {
            "a polygon for an initial set that is an ellipse"
        }
        _ => return Some(velocities),
    };
    field.reject(found, "sets of one kind")
}

/// Timed velocity sets: all but the last one end, each after the one before.
fn timed_velocity_sets(list: &Field, initial: Option<&ConvexSet>) -> Option<Vec<TimedVelocitySet>> {
    let fields = list.list(1..=limits::VELOCITY_SETS, "velocity sets")?;
    let mut sets = Vec::with_capacity(fields.len());
    let mut after = 0.0;
    for (index, field) in fields.iter().enumerate() {
        let last = index + 1 == fields.len();
        let timed = field.table(&VELOCITY.allowed()).map(|mut table| {
            let until = if last {
                table.forbid("until_s", "nothing: the last velocity set holds for ever");
                Some(f64::INFINITY)
            } else {
                let end = table.require("until_s", limits::DURATION);
                let until = end.as_ref().and_then(|e| e.number(limits::DURATION));
                match (end, until) {
                    (Some(end), Some(until)) if until <= after => {
                        end.refuse(format_args!("a time after {after} s, when it starts"))
                    }
                    _ => until,
                }
            };
            let set = set_of(&mut table, &VELOCITY);
            table.finish();
            (until, set.and_then(|set| like(field, set, initial)))
        });
        sets.push(timed.and_then(|(until, velocities)| {
            after = until.unwrap_or(after);
            Some(TimedVelocitySet::new(until?, velocities?))
        }));
    }
    sets.into_iter().collect()
}

/// A polygon of positions about a ship's own.
pub(super) fn position_set(field: &Field) -> Option<ConvexPolygon> {
    let mut table = field.table("a table { vertices_m }")?;
    let list = table.require(INITIAL.vertices, "a list of at least 1 [east, north]");
    table.finish();
    polygon(&list?, INITIAL.range)
}

/// A velocity set alone.
pub(super) fn velocity_set(field: &Field) -> Option<ConvexSet> {
    set(field, &VELOCITY)
}

fn set(field: &Field, keys: &SetKeys) -> Option<ConvexSet> {
    let mut table = field.table(&keys.allowed())?;
    let set = set_of(&mut table, keys);
    table.finish();
    set
}

/// A polygon from its vertices, or an ellipse from its centre and shape matrix.
fn set_of(table: &mut Table, keys: &SetKeys) -> Option<ConvexSet> {
    let round = table.has(keys.center) | table.has(keys.shape);
    if !round {
        let list = table.require(keys.vertices, "a list of at least 1 [east, north]")?;
        return polygon(&list, keys.range).map(ConvexSet::Polygon);
    }
    table.forbid(
        keys.vertices,
        "vertices, or a centre with a shape matrix, not both",
    );
    let center = table
        .require(keys.center, "[east, north]")
        .and_then(|field| field.pair(keys.range));
    let matrix = table.require(keys.shape, "[[a, b], [b, c]], symmetric")?;
    let shape = matrix_of(&matrix, keys.areas);
    match Ellipse::new(center?, shape?) {
        Ok(ellipse) => Some(ellipse.into()),
        Err(error) => matrix.reject(error, SHAPES),
    }
}

const SHAPES: &str =
    "[[a, b], [b, c]], symmetric and positive semidefinite: a >= 0, c >= 0, a c >= b²";

fn matrix_of(field: &Field, range: Range) -> Option<Matrix2<f64>> {
    let rows = field.list(2..=usize::MAX, "rows")?;
    let [first, second] = rows.as_slice() else {
        return field.reject(format_args!("{} rows", rows.len()), SHAPES);
    };
    let (a, b) = (first.pair(range), second.pair(range));
    let (a, b) = (a?, b?);
    Some(Matrix2::new(a.x, a.y, b.x, b.y))
}

fn polygon(list: &Field, range: Range) -> Option<ConvexPolygon> {
    let vertices = list.list(1..=usize::MAX, "[east, north]")?;
    let points = every(vertices.iter().map(|vertex| vertex.pair(range)))?;
    match ConvexPolygon::from_vertices(&points) {
        Ok(polygon) => Some(polygon),
        Err(error) => {
            let place = match error {
                GeometryError::NotConvex { index, .. } | GeometryError::NotFinite { index } => {
                    vertices.get(index).unwrap_or(list)
                }
                GeometryError::Empty => list,
            };
            place.reject(
                error,
                "the corners of a convex set, each on its boundary, in any order",
            )
        }
    }
}
