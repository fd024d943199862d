//! Membership and first contact with one space-time body. Every bench asserts the answer, then
//! times it.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use searoom::frame::{Pose, Vector};
use searoom::geometry::{ConvexPolygon, outer_disc};
use searoom::obstacle::PolytopeObstacle;
use searoom::obstacle::contact::{arc_contacts, first_contact, line_contact};
use searoom::target::ShipTrack;
use searoom::trajectory::Segment;
use searoom::vessel::Hull;

/// A ship from ahead: at 4 m/s west from 1000 m east, with a disc of 80 m about its 60 m hull.
fn body() -> PolytopeObstacle {
    let ship = ShipTrack {
        speed_spread: 0.4,
        course_spread: 0.08,
        ..ShipTrack::exact(
            Pose::new(Vector::new(1000.0, 0.0), std::f64::consts::PI),
            4.0,
            Hull::new(60.0, 12.0),
        )
    };
    let initial = ship
        .hull
        .polygon(&ship.pose)
        .minkowski_sum(&outer_disc(80.0, 0.0));
    PolytopeObstacle::new("from ahead", initial, ship.outer_velocity_set())
}

fn line(north: f64) -> Segment {
    Segment::straight(Pose::new(Vector::new(0.0, north), 0.0), 0.0, 250.0, 5.0)
}

/// Half a circle of 300 m radius to starboard from north to south about `(east, 0)`, at t = 0.
fn arc(east: f64) -> Segment {
    Segment::new(
        Pose::new(Vector::new(east - 300.0, 0.0), std::f64::consts::FRAC_PI_2),
        0.0,
        std::f64::consts::PI * 300.0 / 5.0,
        5.0,
        -5.0 / 300.0,
    )
}

fn membership(criterion: &mut Criterion) {
    let body = body();
    let faces = body.faces().len();
    for (name, east, inside) in [("inside", 600.0, true), ("outside", -500.0, false)] {
        let point = Vector::new(east, 0.0);
        assert_eq!(body.contains(point, 100.0), inside);
        criterion.bench_function(&format!("membership/{name}/{faces} faces"), |b| {
            b.iter(|| body.slack(black_box(point), black_box(100.0)))
        });
    }
}

fn line_contacts(criterion: &mut Criterion) {
    let body = body();
    let faces = body.faces().len();
    for (name, north, meets) in [("meets", 0.0, true), ("clear", 900.0, false)] {
        let line = line(north);
        assert_eq!(line_contact(&body, &line, 0.0).is_some(), meets);
        criterion.bench_function(&format!("line contact/{name}/{faces} faces"), |b| {
            b.iter(|| line_contact(&body, black_box(&line), 0.0))
        });
    }
}

fn arcs(criterion: &mut Criterion) {
    let body = body();
    let faces = body.faces().len();
    for (name, east, meets) in [("meets", -50.0, true), ("clear", -600.0, false)] {
        let arc = arc(east);
        assert_eq!(!arc_contacts(&body, &arc, 0.0).is_empty(), meets);
        assert_eq!(first_contact(&body, &arc, 0.0).is_some(), meets);
        criterion.bench_function(&format!("arc contact, first/{name}/{faces} faces"), |b| {
            b.iter(|| first_contact(&body, black_box(&arc), 0.0))
        });
        criterion.bench_function(&format!("arc contact, all/{name}/{faces} faces"), |b| {
            b.iter(|| arc_contacts(&body, black_box(&arc), 0.0))
        });
    }
}

fn build(criterion: &mut Criterion) {
    let body = body();
    let (initial, velocity) = (body.initial().clone(), body.velocity().clone());
    let (n, m) = (initial.vertices().len(), velocity.vertices().len());
    let make =
        |i: &ConvexPolygon, v: &ConvexPolygon| PolytopeObstacle::new("x", i.clone(), v.clone());
    assert!(make(&initial, &velocity).faces().len() <= n + m);
    criterion.bench_function(&format!("build/{n} + {m} vertices"), |b| {
        b.iter(|| make(black_box(&initial), black_box(&velocity)))
    });
}

criterion_group!(benches, membership, line_contacts, arcs, build);
criterion_main!(benches);
