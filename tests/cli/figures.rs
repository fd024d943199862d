//! Tests of the figures: deterministic bytes, units on the axes, and only finite coordinates.

use searoom::frame::{Pose, Vector};
use searoom::geometry::{ConvexPolygon, Ellipse};
use searoom::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle};
use searoom::report::figure::{Figure, assessment_figure};
use searoom::study::assess::OwnSituation;
use searoom::target::{TimedVelocitySet, Uncertainty};

/// One target of each kind.
fn targets() -> Vec<Obstacle> {
    let place = Vector::new(400.0, 100.0);
    let velocities = ConvexPolygon::rectangle(Vector::new(-2.0, 0.0), 0.3, 0.2);
    let shape = nalgebra::Matrix2::new(900.0, 0.0, 0.0, 400.0);
    let spread = nalgebra::Matrix2::new(0.04, 0.01, 0.01, 0.09);
    let square = |wide| ConvexPolygon::rectangle(Vector::new(0.0, -1.5), wide, wide);
    let timed = [(60.0, 0.2), (f64::INFINITY, 0.6)]
        .map(|(until, wide)| TimedVelocitySet::new(until, square(wide)));
    let initial = ConvexPolygon::rectangle(Vector::new(200.0, 500.0), 20.0, 20.0);
    let changing = Uncertainty::new(initial, timed.to_vec());
    let ellipse = |center, shape| Ellipse::new(center, shape).expect("a shape");
    let velocity = ellipse(Vector::new(1.0, 0.5), spread);
    let polygon = ConvexPolygon::rectangle(place, 30.0, 12.0);
    vec![
        PolytopeObstacle::new("polygons", polygon, velocities).into(),
        EllipsoidObstacle::new("ellipses", ellipse(-place, shape), velocity).into(),
        Obstacle::new("slabs", changing).expect("increasing"),
    ]
}

fn figure(obstacles: &[Obstacle], speed: f64, times: &[f64]) -> Figure {
    let situation = OwnSituation {
        pose: Pose::new(Vector::zeros(), 0.3),
        speed,
        max_speed: 6.0,
        horizon: 300.0,
        obstacles,
    };
    assessment_figure(&situation, times)
}

#[test]
fn the_same_figure_is_the_same_bytes() {
    let all = targets();
    let drawn = || figure(&all, 5.0, &[0.0, 80.0]);
    let svg = drawn().svg();
    assert_eq!(svg, drawn().svg());
    assert_eq!(drawn().png().expect("drawn"), drawn().png().expect("drawn"));
    let texts = "East [m]; North [m]; East velocity [m/s]; North velocity [m/s]; dCPA [m]; risk; \
        Risk at 80 s; velocity obstacle; own velocity; section at 0 s; polygons; ellipses; slabs";
    for text in texts.split("; ") {
        assert!(svg.contains(text), "{text}");
    }
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

/// Tests that a title is above the panels, and that a long one is truncated visibly.
#[test]
fn a_title_is_drawn_and_fits() {
    let all = targets();
    let titled = |title: &str| figure(&all, 5.0, &[0.0]).titled(title).svg();
    let svg = titled("Three & more");
    assert!(svg.contains("Three &amp; more"));
    let long = titled(&"ahoy ".repeat(40));
    assert!(long.contains("…<") && !long.contains(&"ahoy ".repeat(40)));
    assert!(!figure(&all, 5.0, &[0.0]).svg().contains("Three"));
}

/// Tests one to many panels, and extreme situations.
#[test]
fn every_situation_can_be_drawn() {
    let all = targets();
    let point = ConvexPolygon::point;
    let at_rest = |name: &str, set| -> Obstacle {
        PolytopeObstacle::new(name, set, point(Vector::zeros())).into()
    };
    let still = at_rest("buoy", point(Vector::new(9.0, 9.0)));
    let over = at_rest("over", ConvexPolygon::rectangle(Vector::zeros(), 9.0, 9.0));
    let [place, velocity] = [50.0, -1.0].map(|east| Ellipse::point(Vector::new(east, 0.0)));
    let needle: Obstacle = EllipsoidObstacle::new("needle", place, velocity).into();
    for obstacles in [&[][..], &all[..1], &all[1..], &[still], &[over], &[needle]] {
        for times in [
            &[][..],
            &[0.0],
            &[5.0, 5.0, 2.0],
            &[1e6],
            &[0.0, 1.0, 2.0, 3.0, 4.0],
        ] {
            for speed in [0.0, 5.0, 100.0] {
                let svg = figure(obstacles, speed, times).svg();
                assert!(
                    svg.starts_with("<svg") && !svg.contains("NaN"),
                    "{obstacles:?} {times:?}"
                );
            }
        }
    }
    assert!(Figure::new(2, Vec::new()).svg().starts_with("<svg"));
}
