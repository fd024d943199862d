//! Membership, risk, contact and closest approach of one obstacle, and how they grow with its
//! vertices. Every bench asserts the answer, then times it.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::Matrix2;
use searoom::frame::{Pose, Vector, direction};
use searoom::geometry::{ConvexPolygon, Ellipse, outer_enclosing_ellipse};
use searoom::obstacle::contact::line_contact;
use searoom::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use searoom::target::{TimedVelocitySet, Uncertainty};
use searoom::trajectory::Segment;

/// A regular polygon whose edges are not parallel to those of another phase.
fn polygon(vertices: usize, radius: f64, center: Vector, phase: f64) -> ConvexPolygon {
    let points: Vec<Vector> = (0..vertices)
        .map(|i| phase + std::f64::consts::TAU * i as f64 / vertices as f64)
        .map(|angle| center + direction(angle) * radius)
        .collect();
    ConvexPolygon::hull(&points).expect("finite")
}

/// `n + n` vertices: 20 m about the origin, moving east at 1 m/s with half a metre a second to
/// spare.
fn polytope(n: usize) -> PolytopeObstacle {
    PolytopeObstacle::new(
        "polytope",
        polygon(n, 20.0, Vector::zeros(), 0.1),
        polygon(n, 0.5, Vector::new(1.0, 0.0), 0.3),
    )
}

/// Figure 2 of the paper, eqs. (20)-(21).
fn ellipsoid() -> EllipsoidObstacle {
    let ellipse =
        |center, a, b| Ellipse::new(center, Matrix2::new(a, 0.0, 0.0, b)).expect("a shape");
    EllipsoidObstacle::new(
        "ellipsoid",
        ellipse(Vector::zeros(), 100.0, 25.0),
        ellipse(Vector::new(1.0, 0.0), 0.04, 0.0625),
    )
}

fn line(from: Vector, heading: f64) -> Segment {
    Segment::straight(Pose::new(from, heading), 0.0, 100.0, 5.0)
}

const SIZES: [usize; 5] = [4, 8, 16, 32, 64];

fn membership(criterion: &mut Criterion) {
    for n in SIZES {
        let o = polytope(n);
        for (name, north, inside) in [("inside", 20.0, true), ("outside", 90.0, false)] {
            let x = Vector::new(60.0, north);
            assert_eq!(o.contains(x, 60.0), inside);
            criterion.bench_function(&format!("membership/polytope {n} + {n}/{name}"), |b| {
                b.iter(|| o.contains(black_box(x), black_box(60.0)))
            });
        }
    }
    let o = ellipsoid();
    let x = Vector::new(60.0, 5.0);
    assert!(o.contains(x, 60.0));
    criterion.bench_function("membership/ellipsoid", |b| {
        b.iter(|| o.contains(black_box(x), black_box(60.0)))
    });
}

fn risk(criterion: &mut Criterion) {
    let x = Vector::new(60.0, 30.0);
    for n in SIZES {
        let o = polytope(n);
        let found = o.risk(x, 60.0);
        assert!(found > 0.0 && found < 1.0, "{found}");
        criterion.bench_function(&format!("risk/polytope {n} + {n}"), |b| {
            b.iter(|| o.risk(black_box(x), black_box(60.0)))
        });
    }
    let o = ellipsoid();
    let x = Vector::new(60.0, 10.0);
    let found = o.risk(x, 60.0);
    assert!(found > 0.0 && found < 1.0, "{found}");
    criterion.bench_function("risk/ellipsoid", |b| {
        b.iter(|| o.risk(black_box(x), black_box(60.0)))
    });
}

/// 500 by 500 points about the section at 60 s.
fn risk_field(criterion: &mut Criterion) {
    let field = |o: &dyn SpaceTimeObstacle| {
        let mut sum = 0.0;
        for i in 0..500 {
            for j in 0..500 {
                let x = Vector::new(f64::from(i) * 0.24, f64::from(j) * 0.24 - 60.0);
                sum += o.risk(x, 60.0);
            }
        }
        sum
    };
    let (p, e) = (polytope(4), ellipsoid());
    for (name, o) in [
        ("polytope 4 + 4", &p as &dyn SpaceTimeObstacle),
        ("ellipsoid", &e),
    ] {
        assert!(field(o) > 1000.0);
        criterion.bench_function(&format!("risk field, 500 x 500/{name}"), |b| {
            b.iter(|| field(black_box(o)))
        });
    }
}

fn contact(criterion: &mut Criterion) {
    let south = line(Vector::new(30.0, 200.0), -std::f64::consts::FRAC_PI_2);
    let east = line(Vector::new(30.0, 200.0), 0.0);
    for n in SIZES {
        let o = polytope(n);
        for (name, line, meets) in [("meets", south, true), ("clear", east, false)] {
            assert_eq!(line_contact(&o, &line, 0.0).is_some(), meets);
            criterion.bench_function(&format!("line contact/polytope {n} + {n}/{name}"), |b| {
                b.iter(|| line_contact(black_box(&o), black_box(&line), 0.0))
            });
        }
    }
    let o = ellipsoid();
    let arc = |turn_rate| Segment { turn_rate, ..south };
    for (name, segment, meets) in [
        ("line, meets", south, true),
        ("line, clear", east, false),
        ("arc, meets", arc(0.004), true),
        ("arc, clear", arc(0.02), false),
    ] {
        assert_eq!(o.first_contact(&segment, 0.0).is_some(), meets, "{name}");
        criterion.bench_function(&format!("contact/ellipsoid/{name}"), |b| {
            b.iter(|| o.first_contact(black_box(&segment), 0.0))
        });
    }
}

fn approach(criterion: &mut Criterion) {
    let (x, v) = (Vector::new(-100.0, 300.0), Vector::new(4.0, -2.0));
    let time = |criterion: &mut Criterion, id: &str, o: &dyn SpaceTimeObstacle, horizon: f64| {
        let found = o.closest_approach(x, v, horizon);
        assert!(found.distance > 1.0 && found.time > 1.0, "{found:?}");
        criterion.bench_function(id, |b| {
            b.iter(|| o.closest_approach(black_box(x), black_box(v), black_box(horizon)))
        });
    };
    for n in SIZES {
        let o = polytope(n);
        time(
            criterion,
            &format!("closest approach/polytope {n} + {n}/no horizon"),
            &o,
            f64::INFINITY,
        );
        time(
            criterion,
            &format!("closest approach/polytope {n} + {n}/200 s"),
            &o,
            200.0,
        );
    }
    let o = ellipsoid();
    time(
        criterion,
        "closest approach/ellipsoid/no horizon",
        &o,
        f64::INFINITY,
    );
    time(criterion, "closest approach/ellipsoid/200 s", &o, 200.0);
}

fn velocity_obstacle(criterion: &mut Criterion) {
    let x = Vector::new(-100.0, 300.0);
    let v = Vector::new(2.7, -4.5);
    for n in SIZES {
        let o = polytope(n);
        let region = o.velocity_obstacle(x, 200.0);
        assert!(region.contains(v) && o.in_velocity_obstacle(x, v, 200.0));
        criterion.bench_function(&format!("velocity obstacle/build {n} + {n}"), |b| {
            b.iter(|| o.velocity_obstacle(black_box(x), black_box(200.0)))
        });
        criterion.bench_function(&format!("velocity obstacle/test {n} + {n}"), |b| {
            b.iter(|| region.contains(black_box(v)))
        });
    }
}

/// The tangents of a picture.
fn ellipsoid_velocity_obstacle(criterion: &mut Criterion) {
    let (x, v) = (Vector::new(-100.0, 300.0), Vector::new(2.2, -4.5));
    let o = ellipsoid();
    let region = o.outer_velocities_within(x, 200.0, 0.0);
    assert!(region.contains(v) && !region.contains(-v));
    criterion.bench_function("velocity obstacle/ellipsoid/build", |b| {
        b.iter(|| black_box(&o).outer_velocities_within(black_box(x), 200.0, 0.0))
    });
}

fn largest_risk(criterion: &mut Criterion) {
    let south = |east| line(Vector::new(east, 200.0), -std::f64::consts::FRAC_PI_2);
    for (name, o, east) in [
        (
            "polytope 4 + 4",
            &polytope(4) as &dyn SpaceTimeObstacle,
            65.0,
        ),
        ("polytope 64 + 64", &polytope(64), 65.0),
        ("ellipsoid", &ellipsoid(), 52.0),
    ] {
        let line = south(east);
        let arc = Segment {
            turn_rate: 0.001,
            ..line
        };
        for (kind, segment) in [("line", line), ("arc", arc)] {
            let found = o.peak_risk(&segment).risk;
            assert!(found > 0.0 && found < 1.0, "{name} {kind} {found}");
            criterion.bench_function(&format!("largest risk/{name}/{kind}"), |b| {
                b.iter(|| o.peak_risk(black_box(&segment)))
            });
        }
    }
}

/// A ship that may turn: ten sets, one after another.
fn slabs(criterion: &mut Criterion) {
    let timed = (1..=10).map(f64::from).map(|k| {
        let velocities = polygon(8, 0.1 * k, Vector::new(1.0, 0.0), 0.3);
        TimedVelocitySet::new(10.0 * k, velocities)
    });
    let initial = polygon(8, 20.0, Vector::zeros(), 0.1);
    let sets = Uncertainty::new(initial, timed.collect());
    let o = Obstacle::new("slabs", sets).expect("increasing");
    let x = Vector::new(60.0, 36.0);
    assert!(o.contains(x, 60.0) && o.risk(x, 60.0) > 0.0);
    criterion.bench_function("slabs, 10 of 8 + 8/membership", |b| {
        b.iter(|| o.contains(black_box(x), black_box(60.0)))
    });
    criterion.bench_function("slabs, 10 of 8 + 8/risk", |b| {
        b.iter(|| o.risk(black_box(x), black_box(60.0)))
    });
    let (x, v) = (Vector::new(-100.0, 300.0), Vector::new(4.0, -1.0));
    assert!(o.closest_approach(x, v, 100.0).distance > 1.0);
    criterion.bench_function("slabs, 10 of 8 + 8/closest approach, 100 s", |b| {
        b.iter(|| o.closest_approach(black_box(x), black_box(v), 100.0))
    });
}

fn build(criterion: &mut Criterion) {
    for n in SIZES {
        let o = polytope(n);
        let (initial, velocity) = (o.initial().clone(), o.velocity().clone());
        let make =
            |i: &ConvexPolygon, v: &ConvexPolygon| PolytopeObstacle::new("x", i.clone(), v.clone());
        assert_eq!(make(&initial, &velocity), {
            PolytopeObstacle::new("x", initial.clone(), velocity.clone())
        });
        criterion.bench_function(&format!("build/polytope {n} + {n}"), |b| {
            b.iter(|| make(black_box(&initial), black_box(&velocity)))
        });
        let enclosing = outer_enclosing_ellipse(&initial);
        assert!((enclosing.semi_axes()[0].norm() - 20.0).abs() < 1e-6);
        criterion.bench_function(&format!("build/enclosing ellipse of {n}"), |b| {
            b.iter(|| outer_enclosing_ellipse(black_box(&initial)))
        });
    }
}

criterion_group!(
    benches,
    membership,
    risk,
    risk_field,
    contact,
    approach,
    velocity_obstacle,
    ellipsoid_velocity_obstacle,
    largest_risk,
    slabs,
    build
);
criterion_main!(benches);
