//! Hulls that turn with their course.

use super::*;
use searoom_geometry::frame::radians_from_deg;
use std::f64::consts::FRAC_PI_2;

/// A ship at rest abeam of own ship's path, nominally parallel to it.
fn lying(course_spread: f64, turn_rate: f64) -> Target {
    let mut lying = ship(60.0, 0.0);
    if let Motion::Ship(track) = &mut lying.motion {
        track.pose = Pose::new(Vector::new(100.0, 60.0), 0.0);
        (track.position_std, track.speed_spread) = (0.0, 0.0);
        (track.course_spread, track.turn_rate) = (course_spread, turn_rate);
    }
    lying
}

/// Straight motion past [`lying`] at 20 s.
fn past() -> Vec<Segment> {
    let mut segments = Vec::new();
    follow(&mut segments, 300.0, 5.0, 0.0);
    segments
}

/// Own side is 4 m off its path. The target is 60 m long and 12 m wide; one of its corners comes
/// nearest.
#[test]
fn the_worst_hull_is_turned_as_far_as_its_course_may_be() {
    let reach = 30.0_f64.hypot(6.0);
    let corner = 6.0_f64.atan2(30.0);
    for spread in [0.0, 0.02, 0.1, 0.5, 1.2, 3.0] {
        let found = judge(&past(), &[], &[lying(spread, 0.0)]);
        let abeam = f64::min(corner + spread, FRAC_PI_2).sin() * reach;
        let least = 56.0 - abeam;
        let off = found.min_clearance - least;
        assert!(off < 1e-6 && off > -1.3e-3 * reach, "{spread}: {off}");
        assert!((found.passages[0].dcpa - 50.0).abs() < 1e-6, "as expected");
    }
    // Within its course spread, the target comes nearer than on its nominal heading: a violation,
    // independent of the sets.
    let mut near = lying(1.2, 0.0);
    if let Motion::Ship(track) = &mut near.motion {
        track.pose.position.y = 30.0;
    }
    let found = judge(&past(), &[], &[near]);
    assert!(found.passages[0].dcpa > 19.0);
    assert_eq!(words(&found), ["arrival:", "hull"]);
}

/// Own ship passes at 20 s. The target's possible turn grows with time: small in the first seconds,
/// full at the passage.
#[test]
fn the_worst_hull_of_a_ship_that_turns_is_that_of_the_time() {
    let rate = 0.02;
    let found = judge(&past(), &[], &[lying(0.0, rate)]);
    let scan = (0..=6000).map(|k| {
        let time = 0.01 * f64::from(k);
        let own = own().hull.polygon(&past()[0].pose_after(time));
        let turned = |k: i32| rate * time * f64::from(k) / 20.0;
        let all = (-20..=20).map(turned).map(|turn| {
            let pose = Pose::new(Vector::new(100.0, 60.0), turn);
            let hull = lying(0.0, rate).ship().expect("a ship").hull;
            own.separation(&hull.polygon(&pose))
        });
        all.fold(f64::INFINITY, f64::min)
    });
    let scan = scan.fold(f64::INFINITY, f64::min);
    // One time interval of its turn covers 5 degrees.
    let off = found.min_clearance - scan;
    assert!(off < 1e-6 && off > -31.0 * radians_from_deg(5.1), "{off}");
}
