//! Tests of the route.

use super::*;
use crate::ship_fixtures::own_ship;
use searoom_geometry::frame::Vector;
use searoom_model::vessel::OwnShip;
use std::time::Duration;

/// A ship that may stop, on a line.
fn line(slowness: f64, length: f64) -> Route {
    Route {
        pieces: vec![RoutePiece {
            start: Pose::new(Vector::zeros(), 0.0),
            distance: 0.0,
            length,
            curvature: 0.0,
            due: 0.0,
            slowness,
            leg: None,
            ordered: 5.0,
            speed: None,
        }],
        least_change: 0.0,
        speed_time: 0.0,
        alternation: [130.0, 17.0, 50.0],
        speeds: vec![0.0, 2.0, 4.0],
    }
}

/// The end is due before the start, or at zero speed.
#[test]
fn stretches_due_before_they_can_be_reached_are_not_waited_for() {
    for (slowness, fastest) in [(-0.1, true), (0.0, true), (f64::INFINITY, false)] {
        let route = line(slowness, 1000.0);
        let (speed, length) = route.speed_and_length(&route.pieces[0], 0.0, 1000.0, 0.0);
        assert_eq!(speed, if fastest { 4.0 } else { 2.0 }, "{slowness}");
        assert!(length >= route.alternation[1], "{slowness}: {length}");
    }
}

/// At a desired speed that is not one of own ship's, microseconds are not made good in steps of a
/// millimetre.
#[test]
fn a_slip_in_the_schedule_adds_few_segments() {
    let route = Route {
        speed_time: 30.0,
        alternation: [400.0, 50.0, 50.0],
        ..line(0.375, 1000.0)
    };
    for late in [-1e-4, -1e-5, 0.0, 1e-5, 1e-4] {
        let motion = route.follow(0.0, late);
        let end = motion.last().expect("a motion").end_time();
        assert!((end - 375.0).abs() < 1.0, "{late}: {end}");
        assert!(motion.len() < 20, "{late}: {}", motion.len());
    }
}

/// On a long way at a desired speed that is not one of own ship's, the speed alternates less often
/// than every 400 m.
#[test]
fn the_speed_alternates_seldom_on_a_long_line() {
    let motion = line(0.3, 1e5).follow(0.0, 0.0);
    assert!(motion.len() < 200, "{}", motion.len());
}

/// A change of speed to be on schedule again lasts for the least time at a speed.
#[test]
fn a_ship_that_is_little_early_keeps_its_speed() {
    let route = Route {
        speed_time: 30.0,
        alternation: [400.0, 50.0, 50.0],
        ..line(0.25, 1000.0)
    };
    let speeds = |early: f64| -> Vec<f64> {
        let motion = route.follow(0.0, -early);
        motion.iter().map(|s| s.speed).collect()
    };
    assert_eq!(speeds(20.0), [4.0]);
    assert_eq!(speeds(40.0), [0.0, 4.0]);
}

/// Out of time, a ship on its path follows it; one that would have to turn right round to join it where
/// it begins takes a shorter way.
#[test]
fn out_of_time_the_route_is_direct_or_short() {
    let ends = [Vector::zeros(), Vector::new(6000.0, 0.0)];
    let desired = DesiredTrajectory::new(&ends, &[4.0]).expect("valid");
    let route = |heading: f64, seconds: u64| {
        let own = OwnShip {
            pose: Pose::new(Vector::zeros(), heading),
            ..own_ship(&[2.0, 4.0])
        };
        let problem = Problem::new(&own, &desired, &[], 3600.0);
        Route::new(&problem, Clock::new(Duration::from_secs(seconds))).expect("a route")
    };
    let on_path = [0, 60].map(|seconds| route(0.0, seconds).follow(0.0, 0.0));
    assert_eq!(on_path[0], on_path[1]);
    let [late, in_time] = [0, 60].map(|seconds| route(1.5, seconds));
    let radius = own_ship(&[2.0]).turning_radius;
    assert!(late.length() < 6000.0 + 2.0 * radius, "{}", late.length());
    assert!(in_time.length() < 6000.0 + 6.0 * radius);
}
