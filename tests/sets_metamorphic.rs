//! Metamorphic tests: invariance or known change under translation, rotation, reflection, scaling,
//! current, time shift, vertex order and larger sets.

mod set_generators;

use nalgebra::Matrix2;
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Pose, Vector, direction, heading_of};
use searoom::geometry::{ConvexPolygon, ConvexSet, Ellipse, outer_disc};
use searoom::obstacle::{EllipsoidObstacle, PolytopeObstacle, SlabObstacle, SpaceTimeObstacle};
use searoom::target::{TimedVelocitySet, Uncertainty};
use searoom::trajectory::Segment;
use set_generators::{ellipsoid, points, polytope, seeded, segment, slabs, vector};

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

/// Compares both answers; `digits` is the rounding error of the coordinate change in metres.
fn compare<O: Mapped>(o: &O, map: &Map, rng: &mut ChaCha8Rng, digits: f64) {
    let other = o.mapped(map);
    let (x, t) = (vector(rng, 150.0), rng.random_range(0.0..50.0));
    let (mx, mt) = map.event(x, t);
    let (a, b) = (o.signed_distance(x, t), other.signed_distance(mx, mt));
    assert!(
        (a.distance * map.scale - b.distance).abs() <= digits * (1.0 + map.scale),
        "{o:?} {map:?} {x:?} {t} {a:?} {b:?}"
    );
    if a.distance.abs() > 1e-4 {
        assert_eq!(
            o.contains(x, t),
            other.contains(mx, mt),
            "{o:?} {map:?} {x:?} {t}"
        );
        // far from the boundary of a set that is not thin, risks are well conditioned
        if o.signed_distance(x, t).distance < -1.0 && t > 5.0 {
            let (a, b) = (o.risk(x, t), other.risk(mx, mt));
            assert!(
                (a - b).abs() <= 1e3 * digits,
                "{o:?} {map:?} {x:?} {t} {a} {b}"
            );
        }
    }
    let v = vector(rng, 4.0);
    let horizon = [30.0, 200.0][rng.random_range(0..2)];
    let (p, q) = (
        o.closest_approach(x, v, horizon),
        other.closest_approach(map.place(x), map.velocity(v), horizon * map.stretch),
    );
    let slack = 100.0 * digits * (1.0 + map.scale);
    assert!(
        (p.distance * map.scale - q.distance).abs() <= slack,
        "{o:?} {map:?} {x:?} {v:?} {p:?} {q:?}"
    );
    if p.distance > 1.0 {
        // compare times by their effect: each gives the distance of the other
        let (there, then) = map.event(x + v * p.time, p.time);
        let there = other.signed_distance(there, then).distance;
        assert!(
            (there - q.distance).abs() <= slack,
            "{o:?} {map:?} {p:?} {q:?}"
        );
        let (from, going) = (map.place(x), map.velocity(v));
        assert!(!o.in_velocity_obstacle(x, v, horizon));
        assert!(!other.in_velocity_obstacle(from, going, horizon * map.stretch));
    }
    if map.current == Vector::zeros() {
        let bent = rng.random_bool(0.5);
        let s = segment(rng, bent);
        let depth = 1.0;
        let (a, b) = (
            o.first_contact(&s, depth),
            other.first_contact(&map.segment(&s), depth * map.scale),
        );
        if a.is_some() != b.is_some() {
            // grazing contact: at slightly less depth, both have a contact
            let (a, b) = (
                o.first_contact(&s, depth - 1e-4),
                other.first_contact(&map.segment(&s), (depth - 1e-4) * map.scale),
            );
            assert_eq!(a.is_some(), b.is_some(), "{o:?} {map:?} {s:?}");
        }
    }
}

fn all_kinds(seed: u64, count: usize, digits: f64, draw: impl Fn(&mut ChaCha8Rng) -> Map) {
    let mut rng = seeded(seed);
    for _ in 0..count {
        let map = draw(&mut rng);
        compare(&polytope(&mut rng), &map, &mut rng, digits);
        compare(&slabs(&mut rng), &map, &mut rng, digits);
        // a shape matrix represents the width of a needle only to the square root of the precision
        let o = ellipsoid(&mut rng);
        let needle = |e: &Ellipse| e.semi_axes()[1].norm() < 1e-2 * e.semi_axes()[0].norm();
        if !needle(o.initial()) && !needle(o.velocity()) {
            compare(&o, &map, &mut rng, digits);
        }
    }
}

#[test]
fn relation_1_translation() {
    for far in [1.0, 1e3, 1e6] {
        all_kinds(301, 200, 1e-9 + 1e-14 * far, |rng| Map {
            shift: vector(rng, 1.0) * far,
            ..Map::NONE
        });
    }
}

#[test]
fn relation_2_rotation() {
    all_kinds(302, 300, 1e-9, |rng| {
        Map::rotation(rng.random_range(-7.0..7.0))
    });
    all_kinds(303, 100, 1e-9, |rng| {
        let turned = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)][rng.random_range(0..4)];
        Map {
            linear: Matrix2::new(turned.0, -turned.1, turned.1, turned.0),
            ..Map::NONE
        }
    });
}

#[test]
fn relation_3_time_shift() {
    // properties t after t_0 hold t after the section of t_0
    let mut rng = seeded(304);
    for _ in 0..400 {
        let o = polytope(&mut rng);
        let start = rng.random_range(0.0..50.0);
        let later = PolytopeObstacle::new("later", o.section(start), o.velocity().clone());
        let (x, t) = (vector(&mut rng, 200.0), rng.random_range(0.0..50.0));
        let (a, b) = (o.signed_distance(x, start + t), later.signed_distance(x, t));
        assert!(
            (a.distance - b.distance).abs() < 1e-8,
            "{o:?} {start} {x:?} {t}"
        );
        let s = segment(&mut rng, false);
        let shifted = Segment {
            start_time: s.start_time + start,
            ..s
        };
        match (
            o.first_contact(&shifted, 1e-3),
            later.first_contact(&s, 1e-3),
        ) {
            (Some(a), Some(b)) => assert!((a - start - b).abs() < 1e-5, "{o:?} {s:?}"),
            (None, None) => {}
            other => {
                // grazing contact
                let deep = later.first_contact(&s, 1e-3 + 1e-6).is_some();
                assert!(!deep, "{o:?} {s:?} {other:?}");
            }
        }
    }
}

#[test]
fn relation_4_scaling() {
    all_kinds(305, 300, 1e-9, |rng| {
        let scale = [1e-3, 0.5, 7.0, 1e3][rng.random_range(0..4)];
        Map {
            linear: Matrix2::identity() * scale,
            scale,
            // lengths and speeds, lengths and times, or times alone
            stretch: [1.0, scale, 0.1][rng.random_range(0..3)],
            ..Map::NONE
        }
    });
}

#[test]
fn relation_5_current() {
    all_kinds(306, 300, 1e-9, |rng| Map {
        current: vector(rng, 5.0),
        ..Map::NONE
    });
}

#[test]
fn relation_6_mirror() {
    all_kinds(307, 300, 1e-9, |_| Map {
        linear: Matrix2::new(1.0, 0.0, 0.0, -1.0),
        ..Map::NONE
    });
    // exact if only signs change
    let mut rng = seeded(308);
    let mirror = Map {
        linear: Matrix2::new(1.0, 0.0, 0.0, -1.0),
        ..Map::NONE
    };
    for _ in 0..200 {
        let o = polytope(&mut rng);
        let m = o.mapped(&mirror);
        let x = vector(&mut rng, 200.0);
        let region = (
            o.velocity_obstacle(x, 90.0),
            m.velocity_obstacle(mirror.place(x), 90.0),
        );
        for _ in 0..20 {
            let v = vector(&mut rng, 5.0);
            let edge = region
                .0
                .half_planes()
                .iter()
                .map(|h| (h.normal.dot(&v) - h.offset).abs());
            if edge.fold(f64::INFINITY, f64::min) > 1e-9 {
                assert_eq!(region.0.contains(v), region.1.contains(mirror.velocity(v)));
            }
        }
    }
}

#[test]
fn relation_10_order_repetition_and_collinear_vertices_change_nothing() {
    let mut rng = seeded(309);
    for _ in 0..500 {
        let (first, second) = (points(&mut rng, 60.0), points(&mut rng, 2.0));
        let mut shuffle = |set: &[Vector]| {
            let mut other = set.to_vec();
            for _ in 0..3 {
                let (i, j) = (
                    rng.random_range(0..set.len()),
                    rng.random_range(0..set.len()),
                );
                other.push(set[i]);
                other.push((set[i] + set[j]) * 0.5);
            }
            for i in (1..other.len()).rev() {
                other.swap(i, rng.random_range(0..=i));
            }
            other
        };
        let made = |initial: &[Vector], velocity: &[Vector]| {
            PolytopeObstacle::new(
                "x",
                ConvexPolygon::hull(initial).expect("finite"),
                ConvexPolygon::hull(velocity).expect("finite"),
            )
        };
        let (a, b) = (
            made(&first, &second),
            made(&shuffle(&first), &shuffle(&second)),
        );
        let (x, t) = (vector(&mut rng, 150.0), rng.random_range(0.0..50.0));
        let (p, q) = (a.signed_distance(x, t), b.signed_distance(x, t));
        assert!((p.distance - q.distance).abs() < 1e-9, "{a:?} {b:?}");
        let (p, q) = (
            a.closest_approach(x, x * 0.01, 100.0),
            b.closest_approach(x, x * 0.01, 100.0),
        );
        assert!(
            (p.distance - q.distance).abs() < 1e-8,
            "{a:?} {b:?} {p:?} {q:?}"
        );
    }
}

#[test]
fn relation_14_larger_sets_contain_and_endanger_more() {
    let mut rng = seeded(310);
    for _ in 0..500 {
        let (mut initial, mut velocity) = (points(&mut rng, 60.0), points(&mut rng, 2.0));
        let hull = |p: &[Vector]| ConvexPolygon::hull(p).expect("finite");
        let small = PolytopeObstacle::new("x", hull(&initial), hull(&velocity));
        initial.push(vector(&mut rng, 80.0));
        let wider = PolytopeObstacle::new("x", hull(&initial), hull(&velocity));
        velocity.push(vector(&mut rng, 3.0));
        let large = PolytopeObstacle::new("x", hull(&initial), hull(&velocity));
        let (x, t) = (vector(&mut rng, 150.0), rng.random_range(0.0..50.0));
        let v = vector(&mut rng, 4.0);
        assert!(
            large.signed_distance(x, t).distance <= small.signed_distance(x, t).distance + 1e-9
        );
        let (a, b) = (
            small.closest_approach(x, v, 100.0),
            large.closest_approach(x, v, 100.0),
        );
        assert!(b.distance <= a.distance + 1e-9, "{small:?} {large:?}");
        // the centre of the velocities is fixed if only the positions grow
        assert!(
            wider.risk(x, t) >= small.risk(x, t) - 1e-9,
            "{small:?} {wider:?} {x:?} {t}"
        );
        if small.in_velocity_obstacle(x, v, 100.0) && a.distance == 0.0 {
            assert!(
                b.distance == 0.0 || small.signed_distance(x + v * a.time, a.time).distance > -1e-9
            );
        }
    }
}

#[test]
fn relation_16_the_area_is_that_of_minkowski() {
    let mut rng = seeded(311);
    for _ in 0..300 {
        let o = polytope(&mut rng);
        // quadratic in t: |O_0| + 2 t V(O_0, V) + t² |V|
        let area = |t: f64| o.section(t).area();
        let mixed = 0.5 * (area(1.0) - o.initial().area() - o.velocity().area());
        for t in [0.5, 3.0, 40.0] {
            let sum = o.initial().area() + 2.0 * t * mixed + t * t * o.velocity().area();
            assert!((area(t) - sum).abs() < 1e-8 * (1.0 + sum), "{o:?} {t}");
        }
        // the rows of the corrected eq. (9) between two times are the faces
        for face in o.faces() {
            let h = |t: f64| o.section(t).support(face.normal);
            assert!((h(10.0) - h(4.0) - 6.0 * face.velocity_support).abs() < 1e-8);
            assert!((h(0.0) - face.initial_support).abs() < 1e-9);
        }
    }
}

#[test]
fn relation_21_a_disc_without_spread_is_the_textbook() {
    let mut rng = seeded(312);
    for _ in 0..1000 {
        let (center, velocity) = (vector(&mut rng, 300.0), vector(&mut rng, 5.0));
        let radius = rng.random_range(5.0..60.0);
        let disc = outer_disc(radius, 0.3).translated(center);
        let polygon = PolytopeObstacle::new("x", disc, ConvexPolygon::point(velocity));
        let circle = Matrix2::identity() * radius * radius;
        let exact = EllipsoidObstacle::new(
            "x",
            Ellipse::new(center, circle).expect("a shape"),
            Ellipse::point(velocity),
        );
        let (x, v) = (vector(&mut rng, 300.0), vector(&mut rng, 5.0));
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
    }
}

#[test]
fn relation_24_the_same_question_has_the_same_bits() {
    let answers = || {
        let mut rng = seeded(313);
        let mut bits = Vec::new();
        for case in 0..60 {
            let (p, e, s) = (polytope(&mut rng), ellipsoid(&mut rng), slabs(&mut rng));
            let (x, t) = (vector(&mut rng, 150.0), rng.random_range(0.0..50.0));
            let path = segment(&mut rng, case % 2 == 0);
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
                bits.extend(found.map(f64::to_bits));
            }
        }
        bits
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
