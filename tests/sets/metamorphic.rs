//! Metamorphic tests: invariance or known change under translation, rotation, reflection, scaling,
//! current, time shift, vertex order and larger sets.

use super::generators::{check, ellipsoid, hull, line, points, polytope, segment, slabs, vector};
use nalgebra::Matrix2;
use proptest::prelude::*;
use proptest::sample::select;
use searoom::frame::{Pose, Vector, direction, heading_of};
use searoom::geometry::{ConvexPolygon, ConvexSet, Ellipse, outer_disc};
use searoom::obstacle::{EllipsoidObstacle, PolytopeObstacle, SlabObstacle, SpaceTimeObstacle};
use searoom::target::{TimedVelocitySet, Uncertainty};
use searoom::trajectory::Segment;

/// Map `x' = L x + shift + current t'`, `t' = stretch t`, with `L` a rotation or a reflection times
/// a scale.
#[derive(Debug, Clone, Copy)]
struct Map {
    linear: Matrix2<f64>,
    scale: f64,
    shift: Vector,
    current: Vector,
    stretch: f64,
}

impl Map {
    const NONE: Self = Self {
        linear: Matrix2::new(1.0, 0.0, 0.0, 1.0),
        scale: 1.0,
        shift: Vector::new(0.0, 0.0),
        current: Vector::new(0.0, 0.0),
        stretch: 1.0,
    };

    fn rotation(angle: f64) -> Self {
        let (s, c) = angle.sin_cos();
        Self {
            linear: Matrix2::new(c, -s, s, c),
            ..Self::NONE
        }
    }

    fn place(&self, x: Vector) -> Vector {
        self.linear * x + self.shift
    }

    fn event(&self, x: Vector, t: f64) -> (Vector, f64) {
        let t = t * self.stretch;
        (self.place(x) + self.current * t, t)
    }

    fn velocity(&self, v: Vector) -> Vector {
        self.linear * v / self.stretch + self.current
    }

    /// Maps a segment, without current.
    fn segment(&self, s: &Segment) -> Segment {
        Segment {
            start: Pose::new(
                self.place(s.start.position),
                heading_of(self.linear * direction(s.start.heading)),
            ),
            start_time: s.start_time * self.stretch,
            duration: s.duration * self.stretch,
            speed: s.speed * self.scale / self.stretch,
            turn_rate: s.turn_rate * self.linear.determinant().signum() / self.stretch,
        }
    }

    fn polygon(&self, p: &ConvexPolygon, of_velocities: bool) -> ConvexPolygon {
        let map = |x: &Vector| {
            if of_velocities {
                self.velocity(*x)
            } else {
                self.place(*x)
            }
        };
        let mapped: Vec<Vector> = p.vertices().iter().map(map).collect();
        ConvexPolygon::hull(&mapped).expect("finite")
    }

    fn ellipse(&self, e: &Ellipse, of_velocities: bool) -> Ellipse {
        let (center, linear) = if of_velocities {
            (self.velocity(e.center()), self.linear / self.stretch)
        } else {
            (self.place(e.center()), self.linear)
        };
        Ellipse::new(center, linear * e.shape() * linear.transpose()).expect("a shape")
    }
}

trait Mapped: SpaceTimeObstacle + std::fmt::Debug {
    fn mapped(&self, map: &Map) -> Self;
}

impl Mapped for PolytopeObstacle {
    fn mapped(&self, map: &Map) -> Self {
        let (initial, velocity) = (
            map.polygon(self.initial(), false),
            map.polygon(self.velocity(), true),
        );
        Self::new("mapped", initial, velocity)
    }
}

impl Mapped for EllipsoidObstacle {
    fn mapped(&self, map: &Map) -> Self {
        let (initial, velocity) = (
            map.ellipse(self.initial(), false),
            map.ellipse(self.velocity(), true),
        );
        Self::new("mapped", initial, velocity)
    }
}

impl Mapped for SlabObstacle {
    fn mapped(&self, map: &Map) -> Self {
        let mapped =
            |set: &ConvexSet, moves| map.polygon(set.as_polygon().expect("a polygon"), moves);
        let timed = self.sets().velocities.iter().map(|set| {
            TimedVelocitySet::new(set.until * map.stretch, mapped(&set.velocities, true))
        });
        let sets = Uncertainty::new(mapped(&self.sets().initial, false), timed.collect());
        Self::new("mapped", sets).expect("increasing")
    }
}

/// What is asked of a set: a position, a time, a velocity, a horizon and a motion.
type Question = (Vector, f64, Vector, f64, Segment);

fn question() -> impl Strategy<Value = Question> {
    let horizons = select(vec![30.0, 200.0]);
    (vector(150.0), 0.0..50.0, vector(4.0), horizons, segment())
}

/// Compares both answers; `digits` is the rounding error of the coordinate change in metres.
fn compare<O: Mapped>(o: &O, map: &Map, (x, t, v, horizon, s): Question, digits: f64) {
    let other = o.mapped(map);
    let (mx, mt) = map.event(x, t);
    let (a, b) = (o.signed_distance(x, t), other.signed_distance(mx, mt));
    let off = (a.distance * map.scale - b.distance).abs();
    assert!(off <= digits * (1.0 + map.scale), "{a:?} {b:?}");
    if a.distance.abs() > 1e-4 {
        assert_eq!(o.contains(x, t), other.contains(mx, mt));
        // far from the boundary of a set that is not thin, risks are well conditioned
        if a.distance < -1.0 && t > 5.0 {
            let (a, b) = (o.risk(x, t), other.risk(mx, mt));
            assert!((a - b).abs() <= 1e3 * digits, "{a} {b}");
        }
    }
    let (from, going, last) = (map.place(x), map.velocity(v), horizon * map.stretch);
    let (p, q) = (
        o.closest_approach(x, v, horizon),
        other.closest_approach(from, going, last),
    );
    let slack = 100.0 * digits * (1.0 + map.scale);
    assert!(
        (p.distance * map.scale - q.distance).abs() <= slack,
        "{p:?} {q:?}"
    );
    if p.distance > 1.0 {
        // compare times by their effect: each gives the distance of the other
        let (there, then) = map.event(x + v * p.time, p.time);
        let there = other.signed_distance(there, then).distance;
        assert!((there - q.distance).abs() <= slack, "{p:?} {q:?}");
        assert!(!o.in_velocity_obstacle(x, v, horizon));
        assert!(!other.in_velocity_obstacle(from, going, last));
    }
    if map.current == Vector::zeros() {
        let meet = |depth: f64| {
            let mapped = other.first_contact(&map.segment(&s), depth * map.scale);
            [o.first_contact(&s, depth).is_some(), mapped.is_some()]
        };
        let [a, b] = meet(1.0);
        // grazing contact: at slightly less depth, both have a contact
        assert!(a == b || meet(1.0 - 1e-4) == [true; 2] || meet(1.0 - 1e-4) == [false; 2]);
    }
}

fn all_kinds(seed: u64, count: u32, digits: f64, maps: impl Strategy<Value = Map> + Clone) {
    check(
        seed,
        count,
        (polytope(), maps.clone(), question()),
        |(o, map, asked)| {
            compare(&o, &map, asked, digits);
        },
    );
    check(
        seed,
        count,
        (slabs(), maps.clone(), question()),
        |(o, map, asked)| {
            compare(&o, &map, asked, digits);
        },
    );
    check(
        seed,
        count,
        (ellipsoid(), maps, question()),
        |(o, map, asked)| {
            // a shape matrix represents the width of a needle only to the square root of the precision
            let needle = |e: &Ellipse| e.semi_axes()[1].norm() < 1e-2 * e.semi_axes()[0].norm();
            if !needle(o.initial()) && !needle(o.velocity()) {
                compare(&o, &map, asked, digits);
            }
        },
    );
}

const MIRROR: Map = Map {
    linear: Matrix2::new(1.0, 0.0, 0.0, -1.0),
    ..Map::NONE
};

#[test]
fn relation_1_translation() {
    for far in [1.0, 1e3, 1e6] {
        let maps = vector(1.0).prop_map(move |shift| Map {
            shift: shift * far,
            ..Map::NONE
        });
        all_kinds(301, 200, 1e-9 + 1e-14 * far, maps);
    }
}

#[test]
fn relation_2_rotation() {
    all_kinds(302, 300, 1e-9, (-7.0..7.0).prop_map(Map::rotation));
    let quarters = select(vec![(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]);
    let exact = quarters.prop_map(|(c, s)| Map {
        linear: Matrix2::new(c, -s, s, c),
        ..Map::NONE
    });
    all_kinds(303, 100, 1e-9, exact);
}

#[test]
fn relation_3_time_shift() {
    // properties t after t_0 hold t after the section of t_0
    let cases = (polytope(), 0.0..50.0, vector(200.0), 0.0..50.0, line());
    check(304, 400, cases, |(o, start, x, t, s)| {
        let later = PolytopeObstacle::new("later", o.section(start), o.velocity().clone());
        let (a, b) = (o.signed_distance(x, start + t), later.signed_distance(x, t));
        assert!((a.distance - b.distance).abs() < 1e-8, "{a:?} {b:?}");
        let shifted = Segment {
            start_time: s.start_time + start,
            ..s
        };
        match (
            o.first_contact(&shifted, 1e-3),
            later.first_contact(&s, 1e-3),
        ) {
            (Some(a), Some(b)) => assert!((a - start - b).abs() < 1e-5, "{a} {b}"),
            (None, None) => {}
            // grazing contact
            other => assert!(later.first_contact(&s, 1e-3 + 1e-6).is_none(), "{other:?}"),
        }
    });
}

#[test]
fn relation_4_scaling() {
    let maps = (select(vec![1e-3, 0.5, 7.0, 1e3]), 0..3_usize).prop_map(|(scale, stretch)| Map {
        linear: Matrix2::identity() * scale,
        scale,
        // lengths and speeds, lengths and times, or times alone
        stretch: [1.0, scale, 0.1][stretch],
        ..Map::NONE
    });
    all_kinds(305, 300, 1e-9, maps);
}

#[test]
fn relation_5_current() {
    let maps = vector(5.0).prop_map(|current| Map {
        current,
        ..Map::NONE
    });
    all_kinds(306, 300, 1e-9, maps);
}

#[test]
fn relation_6_mirror() {
    all_kinds(307, 300, 1e-9, Just(MIRROR));
    // exact if only signs change
    let cases = (polytope(), vector(200.0), vector(5.0));
    check(308, 4000, cases, |(o, x, v)| {
        let region = o.velocity_obstacle(x, 90.0);
        let mirrored = o.mapped(&MIRROR).velocity_obstacle(MIRROR.place(x), 90.0);
        let planes = region.half_planes().iter();
        let edge = planes.map(|h| (h.normal.dot(&v) - h.offset).abs());
        if edge.fold(f64::INFINITY, f64::min) > 1e-9 {
            assert_eq!(region.contains(v), mirrored.contains(MIRROR.velocity(v)));
        }
    });
}

/// Points with some repeated, some midpoints added, and in another order.
fn with_repetitions(scale: f64) -> impl Strategy<Value = (Vec<Vector>, Vec<Vector>)> {
    let pairs = proptest::collection::vec(
        (any::<prop::sample::Index>(), any::<prop::sample::Index>()),
        3,
    );
    (points(scale), pairs).prop_flat_map(|(set, pairs)| {
        let mut other = set.clone();
        for (i, j) in pairs {
            other.push(*i.get(&set));
            other.push((i.get(&set) + j.get(&set)) * 0.5);
        }
        (Just(set), Just(other).prop_shuffle())
    })
}

#[test]
fn relation_10_order_repetition_and_collinear_vertices_change_nothing() {
    let sets = (with_repetitions(60.0), with_repetitions(2.0));
    check(
        309,
        500,
        (sets, vector(150.0), 0.0..50.0),
        |((initial, velocity), x, t)| {
            let a = PolytopeObstacle::new("x", hull(&initial.0), hull(&velocity.0));
            let b = PolytopeObstacle::new("x", hull(&initial.1), hull(&velocity.1));
            let (p, q) = (a.signed_distance(x, t), b.signed_distance(x, t));
            assert!((p.distance - q.distance).abs() < 1e-9, "{p:?} {q:?}");
            let approach = |o: &PolytopeObstacle| o.closest_approach(x, x * 0.01, 100.0).distance;
            assert!((approach(&a) - approach(&b)).abs() < 1e-8);
        },
    );
}

#[test]
fn relation_14_larger_sets_contain_and_endanger_more() {
    let sets = (points(60.0), points(2.0), vector(80.0), vector(3.0));
    let cases = (sets, vector(150.0), 0.0..50.0, vector(4.0));
    check(
        310,
        500,
        cases,
        |((mut initial, mut velocity, out, fast), x, t, v)| {
            let made = |initial: &[Vector], velocity: &[Vector]| {
                PolytopeObstacle::new("x", hull(initial), hull(velocity))
            };
            let small = made(&initial, &velocity);
            initial.push(out);
            let wider = made(&initial, &velocity);
            velocity.push(fast);
            let large = made(&initial, &velocity);
            let distance = |o: &PolytopeObstacle| o.signed_distance(x, t).distance;
            assert!(distance(&large) <= distance(&small) + 1e-9);
            let (a, b) = (
                small.closest_approach(x, v, 100.0),
                large.closest_approach(x, v, 100.0),
            );
            assert!(b.distance <= a.distance + 1e-9, "{a:?} {b:?}");
            // the centre of the velocities is fixed if only the positions grow
            assert!(wider.risk(x, t) >= small.risk(x, t) - 1e-9);
            if small.in_velocity_obstacle(x, v, 100.0) && a.distance == 0.0 {
                let deep = small.signed_distance(x + v * a.time, a.time).distance;
                assert!(b.distance == 0.0 || deep > -1e-9);
            }
        },
    );
}

#[test]
fn relation_16_the_area_is_that_of_minkowski() {
    check(311, 300, polytope(), |o| {
        // quadratic in t: |O_0| + 2 t V(O_0, V) + t² |V|
        let area = |t: f64| o.section(t).area();
        let mixed = 0.5 * (area(1.0) - o.initial().area() - o.velocity().area());
        for t in [0.5, 3.0, 40.0] {
            let sum = o.initial().area() + 2.0 * t * mixed + t * t * o.velocity().area();
            assert!((area(t) - sum).abs() < 1e-8 * (1.0 + sum), "{t}");
        }
        // the rows of the corrected eq. (9) between two times are the faces
        for face in o.faces() {
            let h = |t: f64| o.section(t).support(face.normal);
            assert!((h(10.0) - h(4.0) - 6.0 * face.velocity_support).abs() < 1e-8);
            assert!((h(0.0) - face.initial_support).abs() < 1e-9);
        }
    });
}

#[test]
fn relation_21_a_disc_without_spread_is_the_textbook() {
    let disc = (vector(300.0), vector(5.0), 5.0..60.0);
    check(
        312,
        1000,
        (disc, vector(300.0), vector(5.0)),
        |((center, velocity, radius), x, v)| {
            let disc = outer_disc(radius, 0.3).translated(center);
            let polygon = PolytopeObstacle::new("x", disc, ConvexPolygon::point(velocity));
            let circle = Matrix2::identity() * radius * radius;
            let exact = EllipsoidObstacle::new(
                "x",
                Ellipse::new(center, circle).expect("a shape"),
                Ellipse::point(velocity),
            );
            let (apart, relative) = (x - center, v - velocity);
            let time = (-apart.dot(&relative) / relative.norm_squared()).max(0.0);
            let distance = (apart + relative * time).norm() - radius;
            let (p, e) = (
                polygon.closest_approach(x, v, f64::INFINITY),
                exact.closest_approach(x, v, f64::INFINITY),
            );
            assert!(
                (e.distance - distance.max(0.0)).abs() < 1e-9,
                "{e:?} {distance}"
            );
            assert!(p.distance <= e.distance + 1e-9 && p.distance >= e.distance - 0.02 * radius);
            if distance > 1e-6 {
                // accuracy of a flat minimum from the root of its derivative
                assert!((e.time - time).abs() < 1e-6 * (1.0 + time), "{e:?} {time}");
                assert!(!exact.in_velocity_obstacle(x, v, f64::INFINITY));
            } else if distance < -1e-6 {
                assert!(exact.in_velocity_obstacle(x, v, f64::INFINITY));
                assert!(polygon.in_velocity_obstacle(x, v, f64::INFINITY));
                // the quadratic gives the time of entry into the circle
                let (a, b, c) = (
                    relative.norm_squared(),
                    apart.dot(&relative),
                    apart.norm_squared() - radius * radius,
                );
                let entry = if c <= 0.0 {
                    0.0
                } else {
                    (-b - (b * b - a * c).sqrt()) / a
                };
                let at = apart + relative * e.time;
                assert!(
                    (at.norm() - radius).abs() < 1e-7 || entry == 0.0,
                    "{e:?} {entry}"
                );
            }
        },
    );
}

#[test]
fn relation_24_the_same_question_has_the_same_bits() {
    let answers = || {
        let bits = std::cell::RefCell::new(Vec::new());
        let sets = (polytope(), ellipsoid(), slabs());
        check(
            313,
            60,
            (sets, vector(150.0), 0.0..50.0, segment()),
            |((p, e, s), x, t, path)| {
                for o in [&p as &dyn SpaceTimeObstacle, &e, &s] {
                    let approach = o.closest_approach(x, x * 0.01, 100.0);
                    let peak = o.peak_risk(&path);
                    let contact = o.first_contact(&path, 0.0).unwrap_or(-1.0);
                    let found = [
                        o.risk(x, t),
                        approach.distance,
                        approach.time,
                        peak.risk,
                        peak.time,
                        contact,
                    ];
                    bits.borrow_mut().extend(found.map(f64::to_bits));
                }
            },
        );
        bits.into_inner()
    };
    let first = answers();
    let others: Vec<_> = std::thread::scope(|scope| {
        let spawned: Vec<_> = (0..2).map(|_| scope.spawn(answers)).collect();
        spawned
            .into_iter()
            .map(|t| t.join().expect("no panic"))
            .collect()
    });
    assert!(others.iter().all(|o| *o == first));
}
