//! Tests of the least alteration against a dense search and required relations.

use std::f64::consts::PI;

use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::select;
use searoom::document::AssessedSets;
use searoom::frame::{Pose, Vector, direction};
use searoom::geometry::{ConvexPolygon, ConvexSet, Ellipse};
use searoom::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use searoom::study::assess::{
    Alteration, OwnSituation, Query, SpaceTimePoint, assess, least_alteration,
};
use searoom::target::{TimedVelocitySet, Uncertainty};
use searoom::tolerance::EDGE_M;

use super::generators::{Counter, angle, check, hull, obstacle, slabs, vector};

/// Number of headings per half turn, and of speeds, in the dense search.
const STEPS: usize = 4000;

fn polygon(center: Vector, points: &[Vector], reach: f64) -> ConvexPolygon {
    let points: Vec<Vector> = points.iter().map(|p| center + p * reach).collect();
    hull(&points)
}

fn ellipse(center: Vector, points: &[Vector], reach: f64) -> Ellipse {
    let columns = [points[0] * reach, points[points.len() - 1] * reach];
    let f = nalgebra::Matrix2::from_columns(&columns);
    Ellipse::new(center, f * f.transpose()).expect("a shape")
}

/// Obstacle of any kind; some meet own ship.
fn approaching() -> impl Strategy<Value = Obstacle> {
    let meeting = (angle(), 100.0..1500.0, 50.0..400.0, vector(4.0));
    let shapes = vec(vec(vector(1.0), 1..7), 4);
    (0..3, meeting, shapes).prop_map(|(kind, (bearing, range, time, off), shapes)| {
        let place: Vector = direction(bearing) * range;
        let way = -place / time + off;
        let [first, second, third, fourth] = &shapes[..] else {
            unreachable!("four shapes");
        };
        match kind {
            0 => {
                let velocity = polygon(way, second, 1.0);
                PolytopeObstacle::new("p", polygon(place, first, 80.0), velocity).into()
            }
            1 => {
                let velocity = ellipse(way, second, 0.7);
                EllipsoidObstacle::new("e", ellipse(place, first, 60.0), velocity).into()
            }
            _ => {
                let ends = [(60.0, second), (130.0, third), (f64::INFINITY, fourth)];
                let timed = ends
                    .map(|(until, shape)| TimedVelocitySet::new(until, polygon(way, shape, 1.5)));
                let sets = Uncertainty::new(polygon(place, first, 60.0), timed.to_vec());
                Obstacle::new("s", sets).expect("increasing")
            }
        }
    })
}

/// Heading, speed and horizon of own ship.
fn motion() -> impl Strategy<Value = (f64, f64, f64)> {
    (
        angle(),
        1.0..8.0,
        select(std::vec![300.0, 300.0, 300.0, 300.0, f64::INFINITY]),
    )
}

fn situation(
    (heading, speed, horizon): (f64, f64, f64),
    obstacles: &[Obstacle],
) -> OwnSituation<'_> {
    OwnSituation {
        pose: Pose::new(Vector::zeros(), heading),
        speed,
        max_speed: 9.0,
        horizon,
        obstacles,
    }
}

fn is_free(s: &OwnSituation, heading: f64, speed: f64) -> bool {
    let velocity = direction(heading) * speed;
    let away = |o: &Obstacle| {
        o.closest_approach(s.pose.position, velocity, s.horizon)
            .distance
    };
    // on the edge of a set it is not free
    s.obstacles.iter().all(|o| away(o) > EDGE_M)
}

/// First free sample.
fn sampled(step: f64, last: f64, free: impl Fn(f64) -> bool) -> Option<f64> {
    let count = (last / step).floor() as usize;
    (0..=count).map(|i| i as f64 * step).find(|x| free(*x))
}

/// Checks that the closed form is free, not later than the samples, and that smaller values are not
/// free.
fn holds(
    exact: Option<f64>,
    sampled: Option<f64>,
    step: f64,
    free: impl Fn(f64) -> bool,
    what: &str,
) {
    match (exact, sampled) {
        (Some(exact), sampled) => {
            assert!(free(exact), "{what}: {exact} is not free");
            assert!(exact >= 0.0);
            if let Some(sampled) = sampled {
                assert!(
                    exact <= sampled + 1e-8,
                    "{what}: {exact}, sampled {sampled}"
                );
            }
            for i in 0..((exact - 1e-8) / step).max(0.0) as usize {
                assert!(!free(i as f64 * step), "{what}: {i} before {exact}");
            }
            // up to the boundary itself
            let before = exact - 1e-6;
            assert!(
                before <= 0.0 || !free(before),
                "{what}: {exact} is not the first"
            );
        }
        (None, Some(sampled)) => panic!("{what}: none, sampled {sampled}"),
        (None, None) => {}
    }
}

/// Checks the turns to both sides by `steps` samples of a half turn each.
fn turns_hold(s: &OwnSituation, found: &Alteration, steps: usize, turned: &Counter) {
    let step = PI / steps as f64;
    for (side, sign, exact) in [
        ("starboard", -1.0, found.starboard),
        ("port", 1.0, found.port),
    ] {
        let free = |turn: f64| is_free(s, s.pose.heading + sign * turn, s.speed);
        holds(exact, sampled(step, PI, free), step, free, side);
        turned.add(exact.is_some_and(|t| t > 0.0));
    }
}

#[test]
fn the_least_alteration_is_that_of_a_dense_search() {
    let [turned, none, changed] = [(); 3].map(|()| Counter::default());
    check(
        1,
        400,
        (vec(approaching(), 1..5), motion()),
        |(obstacles, motion)| {
            let s = situation(motion, &obstacles);
            let found = least_alteration(&s);
            turns_hold(&s, &found, STEPS, &turned);
            none.add(found.starboard.is_none());
            let step = s.max_speed / STEPS as f64;
            let free = |change: f64| is_free(&s, s.pose.heading, s.speed + change);
            let slower = |change: f64| free(-change);
            let down = sampled(step, s.speed, slower);
            let up = sampled(step, s.max_speed - s.speed, free);
            let what = "speed";
            match found.speed {
                Some(change) if change < 0.0 => {
                    holds(Some(-change), down, step, slower, what);
                    assert!(up.is_none_or(|up| up >= -change - 1e-8), "{what}");
                }
                Some(change) => {
                    holds(Some(change), up, step, free, what);
                    assert!(down.is_none_or(|down| down >= change - 1e-8), "{what}");
                }
                None => assert!(down.is_none() && up.is_none(), "{what}"),
            }
            changed.add(found.speed.is_some_and(|c| c != 0.0));
        },
    );
    turned.assert_above(100);
    none.assert_above(5);
    changed.assert_above(50);
}

#[test]
fn own_ship_inside_a_set_is_helped_by_nothing_and_far_away_by_none_needed() {
    let around = |center: Vector| ConvexPolygon::rectangle(center, 10.0, 5.0);
    let at = |center: Vector, velocity: Vector| -> Obstacle {
        PolytopeObstacle::new("p", around(center), ConvexPolygon::point(velocity)).into()
    };
    let still = |obstacles: &[Obstacle], speed: f64| {
        least_alteration(&OwnSituation {
            pose: Pose::new(Vector::zeros(), 0.0),
            speed,
            max_speed: 6.0,
            horizon: 400.0,
            obstacles,
        })
    };
    let nothing = Alteration {
        starboard: None,
        port: None,
        speed: None,
    };
    let held = Alteration {
        starboard: Some(0.0),
        port: Some(0.0),
        speed: Some(0.0),
    };
    assert_eq!(still(&[at(Vector::zeros(), Vector::zeros())], 5.0), nothing);
    assert_eq!(
        still(&[at(Vector::new(0.0, 900.0), Vector::zeros())], 5.0),
        held
    );
    assert_eq!(still(&[], 5.0), held);
    // at rest with an approaching target: turning does not help, speed does
    let stopped = still(&[at(Vector::new(0.0, 400.0), Vector::new(0.0, -2.0))], 0.0);
    assert_eq!((stopped.starboard, stopped.port), (None, None));
    assert!((stopped.speed.expect("ahead of it") - 10.0 / 197.5).abs() < 1e-6);
    // tangents to a box at rest dead ahead, through its near corners
    let ahead = still(&[at(Vector::new(410.0, 0.0), Vector::zeros())], 5.0);
    let tangent = (5.0_f64).atan2(400.0);
    assert!((ahead.starboard.expect("a turn") - tangent).abs() < 1e-8);
    assert!((ahead.port.expect("a turn") - tangent).abs() < 1e-8);
    // 400 m away, reached only after the horizon of 400 s at 1 m/s or less
    assert!((ahead.speed.expect("slower") + 4.0).abs() < 1e-8);
}

#[test]
fn the_answers_are_those_of_the_obstacles() {
    let cases = ([approaching(), approaching()], motion(), vector(8.0));
    check(
        3,
        100,
        cases,
        |(obstacles, (heading, speed, _), velocity)| {
            let s = situation((heading, speed, 300.0), &obstacles);
            let query = Query {
                velocities: std::vec![s.velocity(), velocity],
                ..Query::default()
            };
            let answer = assess("Random", AssessedSets::Hard, &s, &query);
            let all = answer.hold_course.targets.iter();
            for (held, same) in all.zip(&answer.velocities[0].targets) {
                assert_eq!((held.dcpa_m, held.tcpa_s), (same.dcpa_m, same.tcpa_s));
                assert!((0.0..=1.0).contains(&held.max_risk));
                if held.dcpa_m > 1e-9 {
                    assert!(!same.in_velocity_obstacle);
                    assert!(held.max_risk <= 1e-11, "{}", held.max_risk);
                }
            }
        },
    );
}

/// Tests points, segments, needles and repeated vertices, near and far: the answer is free, and no
/// smaller sample is.
#[test]
fn degenerate_sets_are_left_too() {
    let turned = Counter::default();
    let far = select(std::vec![1.0, 100.0, 1e4]);
    let cases = (vec(obstacle(), 1..4), motion(), far, vector(150.0));
    check(4, 600, cases, |(obstacles, motion, far, place)| {
        let mut s = situation(motion, &obstacles);
        s.pose.position = place * far;
        s.horizon *= far;
        // usually directly toward one of them
        if let ConvexSet::Polygon(section) = obstacles[0].section(100.0 * far) {
            let relative = section.vertices()[0] - s.pose.position;
            s.pose.heading = relative.y.atan2(relative.x);
            s.speed = (relative.norm() / (100.0 * far)).clamp(0.1, 9.0);
        }
        let found = least_alteration(&s);
        turns_hold(&s, &found, 500, &turned);
        if let Some(change) = found.speed {
            assert!(is_free(&s, s.pose.heading, s.speed + change), "{change}");
        }
    });
    turned.assert_above(100);
}

#[test]
fn the_regions_of_slabs_are_their_velocity_obstacle() {
    let [inside, outside] = [(); 2].map(|()| Counter::default());
    let horizons = select(std::vec![20.0, 90.0, f64::INFINITY]);
    let cases = (slabs(), vector(200.0), horizons, vec(vector(6.0), 200));
    check(5, 300, cases, |(slabs, position, horizon, velocities)| {
        let regions = slabs.outer_velocity_obstacles(position, horizon);
        for v in velocities {
            let beyond = regions
                .iter()
                .map(|r| {
                    let planes = r.half_planes().iter();
                    let most = planes.map(|h| h.normal.dot(&v) - h.offset);
                    most.fold(f64::NEG_INFINITY, f64::max)
                })
                .fold(f64::INFINITY, f64::min);
            let meets = slabs.in_velocity_obstacle(position, v, horizon);
            if beyond.abs() > 1e-9 {
                assert_eq!(meets, beyond < 0.0, "{v:?} {beyond}");
            }
            inside.add(meets);
            outside.add(!meets);
        }
    });
    inside.assert_above(1000);
    outside.assert_above(1000);
}

/// Places on the edge of a section, with the rounding of their coordinates.
fn on_the_edge(section: &ConvexSet) -> Vec<Vector> {
    match section {
        ConvexSet::Polygon(polygon) => {
            let corners = polygon.vertices();
            let sides = (0..corners.len()).map(|k| (corners[k], corners[(k + 1) % corners.len()]));
            sides
                .flat_map(|(a, b)| [0.0, 0.3, 0.77].map(|share| a + (b - a) * share))
                .collect()
        }
        ConvexSet::Ellipse(ellipse) => {
            let [a, b] = ellipse.semi_axes();
            let around = (0..8).map(|k| direction(0.7 * f64::from(k)));
            around
                .map(|z| ellipse.center() + a * z.x + b * z.y)
                .collect()
        }
    }
}

/// The last velocity in the velocity obstacle on the way to one outside, and the first one outside.
fn touching(s: &OwnSituation, inside: Vector, outside: Vector) -> Option<[Vector; 2]> {
    let meets = |v: Vector| s.obstacles[0].in_velocity_obstacle(s.pose.position, v, s.horizon);
    if !meets(inside) || meets(outside) {
        return None;
    }
    let (mut inside, mut outside) = (inside, outside);
    for _ in 0..80 {
        let middle = (inside + outside) * 0.5;
        match meets(middle) {
            true => inside = middle,
            false => outside = middle,
        }
    }
    Some([inside, outside])
}

/// Points on edges are inside, and touching velocities are in the velocity obstacle, in every key of
/// an answer alike, on whichever side of the edge the last digit is.
#[test]
fn the_edge_of_a_set_belongs_to_it_in_every_key() {
    let [beyond, outside, touched] = [(); 3].map(|()| Counter::default());
    let origin = select(std::vec![Vector::zeros(), Vector::new(5.1e5, 7.03e6)]);
    let cases = (approaching(), motion(), 1.0..300.0, angle(), origin);
    check(
        6,
        300,
        cases,
        |(obstacle, (heading, speed, _), time, way, origin)| {
            let moved = obstacle.sets().initial.translated(origin);
            let obstacles = [obstacle.with_initial(moved)];
            let mut s = situation((heading, speed, 300.0), &obstacles);
            s.pose.position = origin;
            let section = obstacles[0].section(time);
            let places = on_the_edge(&section);
            let off = |p: &Vector| p + obstacles[0].signed_distance(*p, time).normal * 1e-6;
            let all = places.iter().copied().chain(places.iter().map(off));
            let points = all
                .map(|position| SpaceTimePoint { position, time })
                .collect();
            let answer = assess(
                "Edge",
                AssessedSets::Hard,
                &s,
                &Query {
                    points,
                    ..Query::default()
                },
            );
            for (index, point) in answer.points.iter().enumerate() {
                let found = &point.targets[0];
                let position = Vector::new(point.east_m, point.north_m);
                if index < places.len() {
                    assert!(found.inside, "{position}: {found:?}");
                    beyond.add(!obstacles[0].contains(position, time));
                }
                let alpha = found.alpha.unwrap_or(f64::INFINITY);
                assert_eq!(found.inside, alpha <= 1.0, "{found:?}");
                assert_eq!(found.risk, (1.0 - alpha).max(0.0), "{found:?}");
                outside.add(!found.inside);
            }
            let toward = (section.center() - origin) / time;
            let Some(velocities) = touching(&s, toward, toward + direction(way) * 60.0) else {
                return;
            };
            for velocity in velocities {
                s.pose.heading = velocity.y.atan2(velocity.x);
                s.speed = velocity.norm();
                let query = Query {
                    velocities: std::vec![velocity],
                    ..Query::default()
                };
                let answer = assess("Touch", AssessedSets::Hard, &s, &query);
                let (found, held) = (
                    &answer.velocities[0].targets[0],
                    &answer.hold_course.targets[0],
                );
                assert!(
                    found.in_velocity_obstacle && found.dcpa_m == 0.0,
                    "{found:?}"
                );
                assert_eq!(held.dcpa_m, 0.0, "{held:?}");
                let there = SpaceTimePoint {
                    position: origin + velocity * found.tcpa_s,
                    time: found.tcpa_s,
                };
                let at_contact = Query {
                    points: std::vec![there],
                    ..Query::default()
                };
                let at_contact = assess("Contact", AssessedSets::Hard, &s, &at_contact);
                assert!(at_contact.points[0].targets[0].inside, "{at_contact:?}");
                touched.add(true);
                // what leaves every velocity obstacle is in none
                let alterations = [
                    answer
                        .alteration
                        .starboard_deg
                        .map(|turn| (-turn.to_radians(), 0.0)),
                    answer
                        .alteration
                        .port_deg
                        .map(|turn| (turn.to_radians(), 0.0)),
                    answer.alteration.speed_mps.map(|change| (0.0, change)),
                ];
                for (turn, change) in alterations.into_iter().flatten() {
                    assert!(turn != 0.0 || change != 0.0, "{answer:?}");
                    let mut altered = s;
                    altered.pose.heading += turn;
                    altered.speed += change;
                    let free = assess("Altered", AssessedSets::Hard, &altered, &Query::default());
                    let held = &free.hold_course.targets[0];
                    assert!(held.dcpa_m > 0.0 && held.max_risk == 0.0, "{held:?}");
                }
            }
        },
    );
    beyond.assert_above(100);
    outside.assert_above(300);
    touched.assert_above(200);
}
