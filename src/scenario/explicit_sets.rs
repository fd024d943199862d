//! The explicit sets of a target: polygons, ellipses, velocity sets one after another.

use nalgebra::Matrix2;

use super::file::{Entry, Range};
use super::limits;
use super::section::Section;
use crate::frame::Vector;
use crate::geometry::{ConvexPolygon, Ellipse, GeometryError};
use crate::target::{Motion, VelocitySpell};

/// What a target with explicit sets cannot have beside them.
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

/// A set as it is given; `Faulty` keeps its kind, so that the other one is still compared with it.
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
pub(super) fn motion(section: &mut Section) -> Option<Motion> {
    for key in SHIP_KEYS {
        section.forbid(key, BESIDE_SETS);
    }
    for key in [
        "speed_mps",
        "speed_kn",
        "speed_spread_mps",
        "speed_spread_kn",
    ] {
        section.forbid(key, BESIDE_SETS);
    }
    let shapes = "a table { vertices_m } or { center_m, shape_m2 }";
    let initial = section
        .require("initial_set", shapes)
        .and_then(|entry| set(&entry, &INITIAL));
    if let Some(several) = section.take("velocity_sets") {
        if let Some(one) = section.take("velocity_set") {
            one.fault(
                "velocity_set beside velocity_sets",
                "one of the two, not both",
            );
        }
        let spells = spells(&several);
        if let Some(Given::Ellipse(_)) = initial {
            several.fault(
                "several velocity sets for an initial set that is an ellipse",
                "one velocity_set { center_mps, shape_m2_per_s2 }, or an initial set of vertices",
            );
        }
        return match (initial?, spells?) {
            (Given::Polygon(initial), spells) => Some(Motion::Spells {
                initial: initial?,
                spells,
            }),
            (Given::Ellipse(_), _) => None,
        };
    }
    let entry = section.require(
        "velocity_set",
        "a table { vertices_mps } or { center_mps, shape_m2_per_s2 }",
    )?;
    let velocity = set(&entry, &VELOCITY);
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
            entry.fault(
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

/// Velocity sets one after another: all but the last end, each after the one before.
fn spells(list: &Entry) -> Option<Vec<VelocitySpell>> {
    let entries = list.list(1, "tables")?;
    if entries.len() > limits::VELOCITY_SETS {
        list.fault(
            format_args!("{} velocity sets", entries.len()),
            format_args!("at most {}", limits::VELOCITY_SETS),
        );
        return None;
    }
    let mut spells = Vec::with_capacity(entries.len());
    let mut after = 0.0;
    for (index, entry) in entries.iter().enumerate() {
        let last = index + 1 == entries.len();
        let spell = entry
            .section("a table { until_s, vertices_mps }")
            .map(|mut section| {
                let until = if last {
                    section.forbid("until_s", "nothing: the last velocity set holds for ever");
                    Some(f64::INFINITY)
                } else {
                    let end = section.require("until_s", limits::DURATION);
                    let until = end.as_ref().and_then(|e| e.number(limits::DURATION));
                    match (end, until) {
                        (Some(end), Some(until)) if until <= after => {
                            end.refuse(format_args!("a time after {after} s, when it starts"))
                        }
                        _ => until,
                    }
                };
                let list = section.require(VELOCITY.vertices, "a list of at least 1 [east, north]");
                for key in [VELOCITY.center, VELOCITY.shape] {
                    section.forbid(key, "nothing: velocity sets one after another are polygons");
                }
                section.finish();
                (until, list.and_then(|list| polygon(&list, VELOCITY.range)))
            });
        let spell = spell.and_then(|(until, velocities)| {
            after = until.unwrap_or(after);
            Some(VelocitySpell {
                until: until?,
                velocities: velocities?,
            })
        });
        spells.push(spell);
    }
    spells.into_iter().collect()
}

/// A convex set from its vertices, or an ellipse from its centre and shape matrix.
fn set(entry: &Entry, keys: &SetKeys) -> Option<Given> {
    let allowed = format!(
        "a table {{ {} }} or {{ {}, {} }}",
        keys.vertices, keys.center, keys.shape
    );
    let mut section = entry.section(&allowed)?;
    let round = section.has(keys.center) | section.has(keys.shape);
    if !round {
        let list = section.require(keys.vertices, "a list of at least 1 [east, north]");
        section.finish();
        let polygon = list.and_then(|list| polygon(&list, keys.range));
        return Some(Given::Polygon(polygon));
    }
    section.forbid(
        keys.vertices,
        "vertices, or a centre with a shape matrix, not both",
    );
    let center = section
        .require(keys.center, "[east, north]")
        .and_then(|entry| entry.pair(keys.range));
    let matrix = section.require(keys.shape, "[[a, b], [b, c]], symmetric");
    section.finish();
    let shape = matrix
        .as_ref()
        .and_then(|entry| matrix_of(entry, keys.areas));
    let ellipse = || {
        let (entry, center) = (matrix.as_ref()?, center?);
        match Ellipse::new(center, shape?) {
            Ok(ellipse) => Some(ellipse),
            Err(error) => {
                entry.fault(error, SHAPES);
                None
            }
        }
    };
    Some(Given::Ellipse(ellipse()))
}

/// What a shape matrix may be.
const SHAPES: &str =
    "[[a, b], [b, c]], symmetric and positive semidefinite: a >= 0, c >= 0, a c >= b²";

fn matrix_of(entry: &Entry, range: Range) -> Option<Matrix2<f64>> {
    let rows = entry.list(2, "rows")?;
    let [first, second] = rows.as_slice() else {
        entry.fault(format_args!("{} rows", rows.len()), SHAPES);
        return None;
    };
    let (a, b) = (first.pair(range), second.pair(range));
    let (a, b) = (a?, b?);
    Some(Matrix2::new(a.x, a.y, b.x, b.y))
}

fn polygon(list: &Entry, range: Range) -> Option<ConvexPolygon> {
    let vertices = list.list(1, "[east, north]")?;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planner::PlannerKind;
    use crate::scenario::Scenario;
    use crate::target::{DomainKind, Representation};

    const LEAST: &str = r#"
title = "least"
horizon_s = 400
own_ship = { position = { east_m = 0, north_m = 0 }, course_deg = 90, speed_mps = 5, length_m = 30, beam_m = 8, turning_radius_m = 100 }
mission = { waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 1500, north_m = 0 }] }
[[targets]]
name = "sets"
"#;
    const POLYGON: &str = "initial_set = { vertices_m = [[700, 0], [710, 0], [700, 10]] }\n";
    const ELLIPSE: &str = "initial_set = { center_m = [700, 0], shape_m2 = [[9, 1], [1, 4]] }\n";
    const VELOCITIES: &str = "velocity_set = { vertices_mps = [[1, 0], [0, 1]] }\n";
    const ROUND: &str =
        "velocity_set = { center_mps = [0, 1], shape_m2_per_s2 = [[0.1, 0], [0, 0]] }\n";

    fn read(sets: &[&str]) -> Result<Scenario, Vec<String>> {
        Scenario::parse(&format!("{LEAST}{}", sets.concat())).map_err(|faults| {
            let short = |path: &str| path.replace("targets[0].", "");
            faults.iter().map(|f| short(&f.path)).collect()
        })
    }

    #[test]
    fn every_kind_is_read() {
        let ellipses = read(&[ELLIPSE, ROUND]).expect("valid");
        let Motion::Ellipses { initial, velocity } = &ellipses.targets[0].motion else {
            panic!("ellipses");
        };
        assert!((initial.shape()[(0, 1)] - 1.0).abs() < 1e-12 && velocity.center().y == 1.0);
        assert!(read(&[ELLIPSE, ROUND, "representation = \"ellipsoid\""]).is_ok());
        let around = read(&[POLYGON, VELOCITIES, "representation = \"ellipsoid\""]);
        assert_eq!(
            around.expect("valid").targets[0].representation,
            Representation::Ellipsoid
        );
        let several = "velocity_sets = [{ until_s = 60, vertices_mps = [[1, 0]] }, { vertices_mps = [[0, 0]] }]";
        let several = read(&[POLYGON, several]).expect("valid");
        let Motion::Spells { spells, .. } = &several.targets[0].motion else {
            panic!("spells");
        };
        assert_eq!(spells[0].until, 60.0);
        assert_eq!(several.targets[0].changes()[0], 60.0);
        let at = several.targets[0].position_at(100.0);
        assert!((at.x - (700.0 + 10.0 / 3.0 + 60.0)).abs() < 1e-9);
    }

    #[test]
    fn every_mistake_is_one_fault_with_its_place() {
        for (sets, paths) in [
            (vec![ELLIPSE, VELOCITIES], vec!["velocity_set"]),
            (vec![POLYGON, ROUND], vec!["velocity_set"]),
            (vec![POLYGON], vec!["velocity_set"]),
            (vec![VELOCITIES], vec!["initial_set"]),
            (
                vec![
                    "initial_set = { center_m = [1, 2], shape_m2 = [[9, 1], [2, 4]] }\n",
                    "velocity_set = { center_mps = [0, 1], shape_m2_per_s2 = [[1, 2], [2, 1]] }",
                ],
                vec!["initial_set.shape_m2", "velocity_set.shape_m2_per_s2"],
            ),
            (
                vec![
                    "initial_set = { center_m = [1, inf], shape_m2 = [[9, 1], [2]] }\n",
                    "velocity_set = { center_mps = [0, 1], shape_m2_per_s2 = 4 }",
                ],
                vec![
                    "initial_set.center_m[1]",
                    "initial_set.shape_m2[1]",
                    "velocity_set.shape_m2_per_s2",
                ],
            ),
            (
                vec![
                    "initial_set = { center_m = [1, 2], shape_m2 = [[9]], vertices_m = [[1, 2]] }\n",
                    ROUND,
                ],
                vec!["initial_set.vertices_m", "initial_set.shape_m2"],
            ),
            (
                vec![
                    POLYGON,
                    "velocity_sets = [{ until_s = 60, vertices_mps = [[1, 0]] }, { until_s = 60, vertices_mps = [] }, { until_s = 70, vertices_mps = [[0, 0]] }]",
                ],
                vec![
                    "velocity_sets[1].until_s",
                    "velocity_sets[1].vertices_mps",
                    "velocity_sets[2].until_s",
                ],
            ),
            (
                vec![POLYGON, "velocity_sets = [{ vertices_mps = [[1, 0]] }, {}]"],
                vec!["velocity_sets[0].until_s", "velocity_sets[1].vertices_mps"],
            ),
            (vec![POLYGON, "velocity_sets = []"], vec!["velocity_sets"]),
            (
                vec![ELLIPSE, "velocity_sets = [{ vertices_mps = [[1, 0]] }]"],
                vec!["velocity_sets"],
            ),
            (
                vec![
                    POLYGON,
                    VELOCITIES,
                    "velocity_sets = [{ vertices_mps = [[1, 0]] }]",
                ],
                vec!["velocity_set"],
            ),
            (
                vec![ELLIPSE, ROUND, "representation = \"polytope\""],
                vec!["representation"],
            ),
            (
                vec![
                    POLYGON,
                    "velocity_sets = [{ vertices_mps = [[1, 0]] }]\n",
                    "representation = \"ellipsoid\"",
                ],
                vec!["representation"],
            ),
            (
                vec![POLYGON, VELOCITIES, "turn_rate_deg_per_s = 0"],
                vec!["turn_rate_deg_per_s"],
            ),
        ] {
            let mut found = read(&sets).expect_err("faulty");
            found.sort();
            let mut paths = paths.clone();
            paths.sort();
            assert_eq!(found, paths, "{sets:?}");
        }
    }

    #[test]
    fn a_ship_that_may_turn_is_no_ellipsoid() {
        let ship = "position = { east_m = 900, north_m = 0 }\ncourse_deg = 0\nspeed_mps = 4\nlength_m = 50\nbeam_m = 10\n";
        assert!(read(&[ship, "turn_rate_deg_per_s = 0.1"]).is_ok());
        let both = [
            ship,
            "turn_rate_deg_per_s = 0.1\nrepresentation = \"ellipsoid\"",
        ];
        assert_eq!(read(&both).expect_err("faulty"), ["representation"]);
        assert_eq!(
            read(&[ship, "turn_rate_deg_per_s = -0.1"]).expect_err("faulty"),
            ["turn_rate_deg_per_s"]
        );
    }

    /// Eqs. (10), (11), (20) and (21) are in the files of the paper's figures as they are printed; figure 6 has three greatest speeds,
    /// figure 8 the paper's shape.
    #[test]
    fn the_scenes_of_the_paper_have_its_numbers() {
        let read = |name: &str| {
            let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
            let file = folder.join(format!("scenarios/paper/{name}.toml"));
            Scenario::read(&file).expect(name)
        };
        let polygon = |points: &[(f64, f64)]| {
            let points: Vec<Vector> = points.iter().map(|&(x, y)| Vector::new(x, y)).collect();
            ConvexPolygon::from_vertices(&points).expect("convex")
        };
        let polytope = Motion::Sets {
            initial: polygon(&[(-10.0, -5.0), (-10.0, 5.0), (10.0, 5.0), (10.0, -5.0)]),
            velocity: polygon(&[(0.8, 0.0), (1.0, -0.25), (1.2, 0.0), (1.0, 0.25)]),
        };
        let ellipse = |x: f64, [a, b]: [f64; 2]| {
            let shape = nalgebra::Matrix2::new(a * a, 0.0, 0.0, b * b);
            Ellipse::new(Vector::new(x, 0.0), shape).expect("positive definite")
        };
        let same = |a: &Ellipse, b: &Ellipse| {
            (a.center() - b.center()).norm() < 1e-12 && (a.shape() - b.shape()).amax() < 1e-12
        };
        let is_ellipsoid = |motion: &Motion| match motion {
            Motion::Ellipses { initial, velocity } => {
                same(initial, &ellipse(0.0, [10.0, 5.0]))
                    && same(velocity, &ellipse(1.0, [0.2, 0.25]))
            }
            _ => false,
        };
        for name in ["figure_1", "figure_4", "figure_5"] {
            assert_eq!(read(name).targets[0].motion, polytope, "{name}");
        }
        assert!(is_ellipsoid(&read("figure_2").targets[0].motion));
        let both = read("figure_4");
        assert!(is_ellipsoid(&both.targets[1].motion));
        assert_eq!(both.own_ship.pose.position, Vector::new(50.0, 50.0));
        for (name, speed) in [
            ("figure_6", 5.0),
            ("figure_6_slower", 4.0),
            ("figure_6_slowest", 3.0),
        ] {
            let scene = read(name);
            assert_eq!(
                (scene.planner, scene.own_ship.max_speed()),
                (PlannerKind::PathTime, speed)
            );
            assert_eq!(scene.targets.len(), 3);
        }
        for name in ["7", "8_overtaking", "8_head_on", "8_stand_on", "8_give_way"] {
            let scene = read(&format!("figure_{name}"));
            let ship = scene.targets[0].ship().expect("a ship");
            assert_eq!(ship.domain, DomainKind::Paper, "{name}");
        }
    }
}
