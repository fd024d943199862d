//! Explicit sets of a target: polygons, ellipses, and timed velocity sets.

use nalgebra::Matrix2;

use super::limits;
use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Ellipse, GeometryError};
use crate::input::{Field, Range, Table};
use crate::target::{Motion, VelocitySpell};

/// Allowed values of the keys of a tracked ship beside explicit sets.
const BESIDE_SETS: &str = "nothing beside the sets: they are taken as they are";

/// Keys of a tracked ship, speeds aside.
const SHIP_KEYS: [&str; 8] = [
    "position",
    "course_deg",
    "length_m",
    "beam_m",
    "position_std_m",
    "course_spread_deg",
    "turn_rate_deg_per_s",
    "domain",
];

/// The keys of an explicit set.
struct SetKeys {
    vertices: &'static str,
    center: &'static str,
    shape: &'static str,
    range: Range,
    areas: Range,
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

/// A set as given; a faulty one keeps its kind, so that the other set is still compared with it.
enum Given {
    Polygon(Option<ConvexPolygon>),
    Ellipse(Option<Ellipse>),
}

impl Given {
    fn kind(&self) -> &'static str {
        match self {
            Self::Polygon(_) => "a polygon",
            Self::Ellipse(_) => "an ellipse",
        }
    }
}

/// The motion of a target that has at least one of the keys of explicit sets.
pub(super) fn motion(table: &mut Table) -> Option<Motion> {
    for key in SHIP_KEYS {
        table.forbid(key, BESIDE_SETS);
    }
    for key in [
        "speed_mps",
        "speed_kn",
        "speed_spread_mps",
        "speed_spread_kn",
    ] {
        table.forbid(key, BESIDE_SETS);
    }
    let shapes = "a table { vertices_m } or { center_m, shape_m2 }";
    let initial = table
        .require("initial_set", shapes)
        .and_then(|field| set(&field, &INITIAL));
    if let Some(several) = table.take("velocity_sets") {
        if let Some(one) = table.take("velocity_set") {
            one.fault(
                "velocity_set beside velocity_sets",
                "one of the two, not both",
            );
        }
        let velocities = timed_velocity_sets(&several);
        if let Some(Given::Ellipse(_)) = initial {
            several.fault(
                "several velocity sets for an initial set that is an ellipse",
                "one velocity_set { center_mps, shape_m2_per_s2 }, or an initial set of vertices",
            );
        }
        return match (initial?, velocities?) {
            (Given::Polygon(initial), spells) => Some(Motion::Spells {
                initial: initial?,
                spells,
            }),
            (Given::Ellipse(_), _) => None,
        };
    }
    let field = table.require(
        "velocity_set",
        "a table { vertices_mps } or { center_mps, shape_m2_per_s2 }",
    )?;
    let velocity = set(&field, &VELOCITY);
    match (initial?, velocity?) {
        (Given::Polygon(initial), Given::Polygon(velocity)) => Some(Motion::Sets {
            initial: initial?,
            velocity: velocity?,
        }),
        (Given::Ellipse(initial), Given::Ellipse(velocity)) => Some(Motion::Ellipses {
            initial: initial?,
            velocity: velocity?,
        }),
        (initial, velocity) => {
            field.fault(
                format_args!(
                    "{} for an initial set that is {}",
                    velocity.kind(),
                    initial.kind()
                ),
                "two sets of one kind",
            );
            None
        }
    }
}

/// Timed velocity sets: all but the last one end, each after the one before.
fn timed_velocity_sets(list: &Field) -> Option<Vec<VelocitySpell>> {
    let fields = list.list(1..=limits::VELOCITY_SETS, "velocity sets")?;
    let mut sets = Vec::with_capacity(fields.len());
    let mut after = 0.0;
    for (index, field) in fields.iter().enumerate() {
        let last = index + 1 == fields.len();
        let set = field
            .table("a table { until_s, vertices_mps }")
            .map(|mut table| {
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
                let list = table.require(VELOCITY.vertices, "a list of at least 1 [east, north]");
                for key in [VELOCITY.center, VELOCITY.shape] {
                    table.forbid(key, "nothing: velocity sets one after another are polygons");
                }
                table.finish();
                (until, list.and_then(|list| polygon(&list, VELOCITY.range)))
            });
        let set = set.and_then(|(until, velocities)| {
            after = until.unwrap_or(after);
            Some(VelocitySpell {
                until: until?,
                velocities: velocities?,
            })
        });
        sets.push(set);
    }
    sets.into_iter().collect()
}

/// A convex set from its vertices, or an ellipse from its centre and shape matrix.
fn set(field: &Field, keys: &SetKeys) -> Option<Given> {
    let allowed = format!(
        "a table {{ {} }} or {{ {}, {} }}",
        keys.vertices, keys.center, keys.shape
    );
    let mut table = field.table(&allowed)?;
    let round = table.has(keys.center) | table.has(keys.shape);
    if !round {
        let list = table.require(keys.vertices, "a list of at least 1 [east, north]");
        table.finish();
        let polygon = list.and_then(|list| polygon(&list, keys.range));
        return Some(Given::Polygon(polygon));
    }
    table.forbid(
        keys.vertices,
        "vertices, or a centre with a shape matrix, not both",
    );
    let center = table
        .require(keys.center, "[east, north]")
        .and_then(|field| field.pair(keys.range));
    let matrix = table.require(keys.shape, "[[a, b], [b, c]], symmetric");
    table.finish();
    let shape = matrix
        .as_ref()
        .and_then(|field| matrix_of(field, keys.areas));
    let ellipse = || {
        let (field, center) = (matrix.as_ref()?, center?);
        match Ellipse::new(center, shape?) {
            Ok(ellipse) => Some(ellipse),
            Err(error) => {
                field.fault(error, SHAPES);
                None
            }
        }
    };
    Some(Given::Ellipse(ellipse()))
}

/// Allowed shape matrices.
const SHAPES: &str =
    "[[a, b], [b, c]], symmetric and positive semidefinite: a >= 0, c >= 0, a c >= b²";

fn matrix_of(field: &Field, range: Range) -> Option<Matrix2<f64>> {
    let rows = field.list(2..=usize::MAX, "rows")?;
    let [first, second] = rows.as_slice() else {
        field.fault(format_args!("{} rows", rows.len()), SHAPES);
        return None;
    };
    let (a, b) = (first.pair(range), second.pair(range));
    let (a, b) = (a?, b?);
    Some(Matrix2::new(a.x, a.y, b.x, b.y))
}

fn polygon(list: &Field, range: Range) -> Option<ConvexPolygon> {
    let vertices = list.list(1..=usize::MAX, "[east, north]")?;
    let points: Vec<Option<Vector>> = vertices.iter().map(|vertex| vertex.pair(range)).collect();
    let points: Vec<Vector> = points.into_iter().collect::<Option<_>>()?;
    match ConvexPolygon::from_vertices(&points) {
        Ok(polygon) => Some(polygon),
        Err(error) => {
            let place = match error {
                GeometryError::NotConvex { index, .. } | GeometryError::NotFinite { index } => {
                    vertices.get(index).unwrap_or(list)
                }
                GeometryError::Empty => list,
            };
            place.fault(
                error,
                "the corners of a convex set, each on its boundary, in any order",
            );
            None
        }
    }
}
