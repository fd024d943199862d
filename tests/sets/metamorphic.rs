//! Metamorphic tests: invariance or known change under translation, rotation, reflection, scaling,
//! current and larger sets.

use super::generators::{check, hull, obstacle, points, segment, vector};
use nalgebra::Matrix2;
use proptest::prelude::*;
use proptest::sample::select;
use searoom::frame::{Pose, Vector, direction, heading_of};
use searoom::geometry::{ConvexSet, Ellipse};
use searoom::obstacle::{Obstacle, PolytopeObstacle, SpaceTimeObstacle};
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
        Segment::new(
            Pose::new(
                self.place(s.start.position),
                heading_of(self.linear * direction(s.start.heading)),
            ),
            s.start_time * self.stretch,
            s.duration * self.stretch,
            s.speed * self.scale / self.stretch,
            s.turn_rate * self.linear.determinant().signum() / self.stretch,
        )
    }

    fn set(&self, set: &ConvexSet, of_velocities: bool) -> ConvexSet {
        let (map, linear): (&dyn Fn(Vector) -> Vector, _) = if of_velocities {
            (&|v| self.velocity(v), self.linear / self.stretch)
        } else {
            (&|x| self.place(x), self.linear)
        };
        match set {
            ConvexSet::Polygon(p) => {
                let mapped: Vec<Vector> = p.vertices().iter().map(|x| map(*x)).collect();
                hull(&mapped).into()
            }
            ConvexSet::Ellipse(e) => {
                let shape = linear * e.shape() * linear.transpose();
                let mapped = Ellipse::new(map(e.center()), shape);
                mapped.expect("a shape").into()
            }
        }
    }

    fn obstacle(&self, o: &Obstacle) -> Obstacle {
        let sets = o.sets();
        let timed = sets.velocities.iter().map(|set| {
            TimedVelocitySet::new(set.until * self.stretch, self.set(&set.velocities, true))
        });
        let sets = Uncertainty::new(self.set(&sets.initial, false), timed.collect());
        Obstacle::new("mapped", sets).expect("increasing")
    }
}

/// A question about a set: a position, a time, a velocity, a horizon and a motion.
type Question = (Vector, f64, Vector, f64, Segment);

fn question() -> impl Strategy<Value = Question> {
    let horizons = select(vec![30.0, 200.0]);
    (vector(150.0), 0.0..50.0, vector(4.0), horizons, segment())
}

/// Compares both answers.
fn compare(o: &Obstacle, map: &Map, (x, t, v, horizon, s): Question) {
    // rounding error of the coordinate change, metres
    let digits = 1e-9 + 1e-14 * map.shift.norm();
    let other = map.obstacle(o);
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
    let p = o.closest_approach(x, v, horizon);
    let q = other.closest_approach(from, going, last);
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

/// One of the maps under which no answer changes.
fn maps() -> impl Strategy<Value = Map> + Clone {
    let made = |linear: Matrix2<f64>| Map {
        linear,
        ..Map::NONE
    };
    let quarters = select(vec![(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)]);
    let quarters = quarters.prop_map(move |(c, s)| made(Matrix2::new(c, -s, s, c)));
    let translations = (vector(1.0), select(vec![1.0, 1e3, 1e6]));
    let currents = vector(5.0).prop_map(|current| Map {
        current,
        ..Map::NONE
    });
    let scales = (select(vec![1e-3, 0.5, 7.0, 1e3]), 0..3_usize);
    prop_oneof![
        3 => translations.prop_map(|(shift, far)| Map { shift: shift * far, ..Map::NONE }),
        2 => (-7.0..7.0).prop_map(Map::rotation),
        1 => quarters,
        1 => Just(made(Matrix2::new(1.0, 0.0, 0.0, -1.0))),
        1 => currents,
        2 => scales.prop_map(|(scale, stretch)| Map {
            linear: Matrix2::identity() * scale,
            scale,
            // lengths and speeds, lengths and times, or times alone
            stretch: [1.0, scale, 0.1][stretch],
            ..Map::NONE
        }),
    ]
}

#[test]
fn no_answer_changes_with_the_frame() {
    // a shape matrix represents the width of a needle only to the square root of the precision
    let wide = |set: &ConvexSet| {
        set.as_ellipse()
            .is_none_or(|e| e.semi_axes()[1].norm() >= 1e-2 * e.semi_axes()[0].norm())
    };
    let wide = obstacle().prop_filter("no needle", move |o| {
        let sets = o.sets();
        wide(&sets.initial) && sets.velocities.iter().all(|set| wide(&set.velocities))
    });
    check(301, 6000, (wide, maps(), question()), |(o, map, asked)| {
        compare(&o, &map, asked)
    });
}

#[test]
fn larger_sets_contain_and_endanger_more() {
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
            let a = small.closest_approach(x, v, 100.0);
            let b = large.closest_approach(x, v, 100.0);
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
