//! The last moments that are told of, from both sides: a second search finds an escape then, and none a little later.

use super::*;
use crate::frame::radians_from_deg;
use crate::planner::space_time;

/// Seconds for which the hull is looked at after an escape began.
const CLEAR_FOR_S: f64 = 200.0;

/// A turn and a straight line on, at one of own ship's speeds, from where a motion is at a time: clear of every set.
fn escapes(sets: &[Obstacle], held: &[Segment], time: f64, turns: &[f64]) -> bool {
    let own = scenario(track(0.0, 0.0, 0.0, 0.0), Compliance::Shape).own_ship;
    let leg = held.iter().find(|s| time <= s.end_time()).expect("held");
    let start = leg.pose_at(time);
    own.speeds.iter().any(|&speed| {
        turns.iter().any(|&turn| {
            let arc = Segment {
                start,
                start_time: time,
                duration: turn.abs() * own.turning_radius / speed,
                speed,
                turn_rate: turn.signum() * speed / own.turning_radius,
            };
            let line = Segment {
                start: arc.end(),
                start_time: arc.end_time(),
                duration: CLEAR_FOR_S,
                turn_rate: 0.0,
                ..arc
            };
            let met = |set: &Obstacle| {
                [arc, line]
                    .iter()
                    .any(|s| set.first_contact(s, 0.0).is_some())
            };
            !sets.iter().any(met)
        })
    })
}

fn degrees(turns: impl Iterator<Item = i32>) -> Vec<f64> {
    turns
        .map(|turn| 0.5 * radians_from_deg(f64::from(turn)))
        .collect()
}

/// A way out exists at the time that is given. For most encounters none exists 3 s later; the planner may miss a late one.
#[test]
fn until_the_time_of_no_return_there_is_a_way_out_and_then_mostly_none() {
    let mut last = 0;
    for target in [
        track(1500.0, 0.0, PI, 5.0),
        track(1200.0, 40.0, PI, 3.0),
        track(750.0, -750.0, FRAC_PI_2, 5.0),
        track(700.0, 600.0, -FRAC_PI_2, 4.0),
        track(400.0, 0.0, 0.0, 1.5),
    ] {
        let run = run(scenario(target.clone(), Compliance::Shape));
        let Some(NoReturn::At(told)) = run.no_return() else {
            panic!("there is a time: {target:?}");
        };
        let hard: Vec<Obstacle> = run.sets.iter().map(|s| s.hard.clone()).collect();
        let coast = coast(&run.scenario, &run.land);
        let asked = problem(&run.scenario, &hard, &coast);
        let held = space_time::nominal_motion(&asked).expect("a straight path");
        // to either side, every half degree
        let turns = degrees(-360..=360);
        let may_leave = |time: f64| escapes(&hard, &held, time, &turns);
        assert!(may_leave(told), "{told} s: {target:?}");
        last += usize::from(!may_leave(told + 3.0));
    }
    assert!(last >= 3, "{last} of 5");
}

#[test]
fn a_ship_that_stands_on_escapes_at_the_latest_time() {
    let mut found = Vec::new();
    for target in [
        track(750.0, 750.0, -FRAC_PI_2, 5.0),
        track(750.0, 600.0, -FRAC_PI_2, 4.0),
        track(-300.0, 0.0, 0.0, 8.0),
    ] {
        let run = run(scenario(target.clone(), Compliance::Rules));
        let told = run.planned.escape.expect("she stands on").latest;
        let coast = coast(&run.scenario, &run.land);
        let asked = problem(&run.scenario, &run.obstacles, &coast);
        let held = space_time::nominal_motion(&asked).expect("a straight path");
        let mut met = held
            .iter()
            .filter_map(|s| run.obstacles[0].first_contact(s, 0.0));
        let met = met.next().expect("she is in the way");
        // to starboard by what is readily apparent and no more than she turns, every half degree
        let turns = degrees((-240..=-60).rev());
        let before = (0..).map(|k| met - 0.25 * f64::from(k));
        let mut may_leave = before.filter(|time| escapes(&run.obstacles, &held, *time, &turns));
        let latest = may_leave.next().expect("a way out");
        found.push((told, latest));
    }
    for (told, latest) in &found {
        assert!(*told < latest + 0.3 && *told > latest - 6.0, "{found:?}");
    }
}
