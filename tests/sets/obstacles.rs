//! Tests of the common obstacle interface against slow definitions, for all implementors.

use std::fmt::Debug;

use proptest::prelude::*;
use proptest::sample::select;
use searoom::frame::{Vector, heading_of};
use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline;
use searoom::scenario::Scenario;
use searoom::target::Representation;
use searoom::trajectory::Segment;

use super::generators::{
    Counter, arc, check, directions, ellipsoid, line, obstacle, polytope, round_slabs, segment,
    slabs, vector,
};

/// Obstacle, and a point near its section at a time that is sometimes 0.
fn event<O: SpaceTimeObstacle + Debug>(
    obstacles: impl Strategy<Value = O>,
) -> impl Strategy<Value = (O, Vector, f64)> {
    let time = prop_oneof![3 => Just(0.0), 17 => 0.0..60.0];
    let shares = (-1.0..1.0, -1.0..1.0);
    (obstacles, time, -3.2..3.2, shares).prop_map(|(o, time, heading, shares)| {
        let n: Vector = searoom::frame::direction(heading);
        let within = |n: Vector, share: f64| {
            let (far, near) = (o.support(n, time).value, -o.support(-n, time).value);
            n * (0.5 * (far + near) + share * (far - near + 5.0))
        };
        let x = within(n, shares.0) + within(Vector::new(-n.y, n.x), shares.1);
        (o, x, time)
    })
}

trait Set: SpaceTimeObstacle + Debug {}
impl<O: SpaceTimeObstacle + Debug> Set for O {}

/// Definition: the largest signed distance from a supporting line, found by sampling and
/// refinement.
fn searched_distance<O: SpaceTimeObstacle>(o: &O, x: Vector, t: f64) -> f64 {
    let at = |n: Vector| n.dot(&x) - o.support(n, t).value;
    let turned = |n: Vector, by: f64| searoom::frame::direction(heading_of(n) + by);
    let mut normals: Vec<Vector> = directions(360).collect();
    normals.sort_by(|a, b| at(*b).total_cmp(&at(*a)));
    normals[..6]
        .iter()
        .map(|n| {
            let (mut best, mut step) = (*n, 0.02);
            while step > 1e-12 {
                let next = [turned(best, step), turned(best, -step)]
                    .into_iter()
                    .max_by(|a, b| at(*a).total_cmp(&at(*b)))
                    .expect("two");
                if at(next) > at(best) {
                    best = next;
                } else {
                    step *= 0.5;
                }
            }
            at(best)
        })
        .fold(f64::NEG_INFINITY, f64::max)
}

fn distance_is_the_best_supporting_line<O: Set>(draw: impl Strategy<Value = O>) {
    let inside = Counter::default();
    check(101, 1500, event(draw), |(o, x, t)| {
        let found = o.signed_distance(x, t);
        // the search may miss a narrow peak, but never exceeds the true value
        let slow = searched_distance(&o, x, t);
        assert!(found.distance >= slow - 1e-7, "{slow} {found:?}");
        let n = found.normal;
        assert!((n.norm() - 1.0).abs() < 1e-9);
        let attained = n.dot(&x) - o.support(n, t).value;
        assert!(
            (attained - found.distance).abs() < 1e-7,
            "{found:?} {attained}"
        );
        if found.distance.abs() > 1e-7 {
            assert_eq!(o.contains(x, t), found.distance < 0.0);
        }
        inside.add(found.distance < 0.0);
        let (now, later) = (o.support(n, t), o.support(n, t + 1e-6));
        if now.rate.is_finite() && t > 1.0 {
            let slope = (later.value - now.value) / 1e-6;
            assert!((slope - now.rate).abs() < 1e-3, "{slope} {}", now.rate);
        }
    });
    inside.assert_above(100);
}

/// Definition: the least alpha whose set contains the point, found by bisection.
fn searched_alpha<O: SpaceTimeObstacle>(o: &O, x: Vector, t: f64) -> Option<f64> {
    let contains = |alpha: f64| o.at_risk(1.0 - alpha).contains(x, t);
    if !contains(1.0) {
        return None;
    }
    let (mut out, mut within) = (0.0, 1.0);
    if contains(0.0) {
        return Some(0.0);
    }
    for _ in 0..50 {
        let middle = 0.5 * (out + within);
        if contains(middle) {
            within = middle;
        } else {
            out = middle;
        }
    }
    Some(within)
}

fn alpha_is_the_least_scaling<O: Set>(draw: impl Strategy<Value = O>) {
    let between = Counter::default();
    check(102, 1500, event(draw), |(o, x, t)| {
        let (alpha, depth) = (o.alpha(x, t), o.signed_distance(x, t).distance);
        // a set without interior has no margin for rounding
        if depth.abs() < 1e-6 {
            return;
        }
        assert_eq!(alpha <= 1.0, o.contains(x, t), "{alpha}");
        if let Some(slow) = searched_alpha(&o, x, t) {
            assert!((alpha - slow).abs() < 1e-6, "{alpha} {slow}");
            assert!((o.risk(x, t) - (1.0 - slow)).abs() < 1e-6);
            between.add(alpha > 1e-6);
        } else {
            assert_eq!(o.risk(x, t), 0.0);
        }
        assert_eq!((o.risk(x, -1.0), o.alpha(x, -1.0)), (0.0, f64::INFINITY));
    });
    between.assert_above(60);
}

fn contact_is_the_first_instant_inside<O: Set>(draw: impl Strategy<Value = O>) {
    let met = [Counter::default(), Counter::default()];
    let depths = select(vec![0.0, 0.0, 1e-3, 2.0]);
    check(103, 900, (draw, segment(), depths), |(o, s, depth)| {
        let found = o.first_contact(&s, depth);
        let step = s.duration / 2000.0;
        let at = |t: f64| o.signed_distance(s.pose_at(t).position, t).distance + depth;
        let dense = (0..=2000)
            .map(|i| s.start_time + step * f64::from(i))
            .find(|t| at(*t) <= -1e-6);
        if let Some(t) = dense {
            assert!(
                found.is_some_and(|found| found <= t + 1e-9),
                "{found:?} {t}"
            );
            met[usize::from(s.is_arc())].add(true);
        }
        if let Some(t) = found {
            assert!(t >= s.start_time && t <= s.end_time() + 1e-9);
            // inside from this time on, and not before
            assert!(at(t) <= 1e-6, "{t} {}", at(t));
            let before = |i: i32| s.start_time + (t - s.start_time) * f64::from(i) / 200.0;
            let begins = t <= s.start_time.max(0.0) + 1e-9;
            assert!(begins || (0..200).all(|i| at(before(i)) > -1e-6), "{t}");
        }
    });
    met.iter().for_each(|met| met.assert_above(30));
}

fn peak_risk_is_the_largest_sample<O: Set>(draw: impl Strategy<Value = O>) {
    let between = Counter::default();
    let segments = prop_oneof![1 => arc().boxed(), 2 => line().boxed()];
    check(104, 600, (draw, segments), |(o, s)| {
        let peak = o.peak_risk(&s);
        let at = |t: f64| o.risk(s.pose_at(t).position, t);
        let step = s.duration / 4000.0;
        let sampled = (0..=4000)
            .map(|i| at(s.start_time + step * f64::from(i)))
            .fold(0.0, f64::max);
        assert!(sampled <= peak.risk + 1e-9, "{sampled} {peak:?}");
        // attained nearby, if the sets have an interior
        let near = directions(8)
            .map(|d| o.risk(s.pose_at(peak.time).position + d * 1e-6, peak.time))
            .fold(at(peak.time), f64::max);
        let level = o.at_risk(peak.risk);
        let width =
            |n: Vector| level.support(n, peak.time).value + level.support(-n, peak.time).value;
        if peak.time > 1.0 && directions(720).all(|n| width(n) > 2.0) {
            assert!(near >= peak.risk - 1e-4, "{peak:?} {near}");
        }
        between.add(peak.risk > 0.01 && peak.risk < 0.99);
    });
    between.assert_above(20);
}

fn approach_is_the_least_sample<O: Set>(draw: impl Strategy<Value = O>) {
    let apart = Counter::default();
    let horizons = select(vec![10.0, 60.0, 300.0, f64::INFINITY]);
    let cases = (draw, vector(300.0), vector(4.0), horizons);
    check(105, 800, cases, |(o, x, v, horizon)| {
        let found = o.closest_approach(x, v, horizon);
        let at = |t: f64| o.signed_distance(x + v * t, t).distance.max(0.0);
        let until = f64::min(horizon, 400.0);
        let dense: Vec<(f64, f64)> = (0..=4000)
            .map(|i| until * f64::from(i) / 4000.0)
            .map(|t| (t, at(t)))
            .collect();
        let least = dense.iter().map(|d| d.1).fold(f64::INFINITY, f64::min);
        assert!(found.distance <= least + 1e-7, "{found:?} {least}");
        if found.attained {
            assert!(found.time >= 0.0 && found.time <= horizon);
            let off = (at(found.time) - found.distance).abs();
            assert!(off < 1e-6 * (1.0 + 1e-3 * found.time), "{found:?} {off}");
            // no earlier sample is as near
            for (t, d) in dense.iter().filter(|(t, _)| *t < found.time - 1e-6) {
                assert!(*d > found.distance - 1e-7, "{t} {d} {found:?}");
            }
        }
        let meets = o.in_velocity_obstacle(x, v, horizon);
        assert_eq!(meets, found.distance == 0.0, "{found:?}");
        apart.add(!meets && found.time > 0.0 && found.time < horizon);
    });
    apart.assert_above(100);
}

fn risk_levels_are_nested<O: Set>(draw: impl Strategy<Value = O>) {
    let cases = (draw, 0.0..0.5, 0.5..=1.0, 0.0..50.0);
    check(106, 500, cases, |(o, low, high, t)| {
        for n in directions(32) {
            let [all, more, less] = [0.0, low, high].map(|r| o.at_risk(r).support(n, t).value);
            assert!(less <= more + 1e-9 && more <= all + 1e-9);
            assert!((all - o.support(n, t).value).abs() < 1e-9);
        }
        // an invalid level accepts no risk
        let all = o.support(Vector::new(1.0, 0.0), t).value;
        for odd in [f64::NAN, -1.0, 2.0] {
            assert_eq!(o.at_risk(odd).support(Vector::new(1.0, 0.0), t).value, all);
        }
    });
}

fn what_is_no_number_is_in_contact<O: Set>(draw: impl Strategy<Value = O>) {
    check(107, 50, (draw, line()), |(o, s)| {
        let far = Vector::new(1e7, 1e7);
        for bad in [f64::NAN, f64::INFINITY] {
            let lost = Vector::new(bad, 0.0);
            assert!(o.closest_approach(lost, far, 10.0).distance == 0.0);
            assert!(o.closest_approach(far, lost, 10.0).distance == 0.0);
            assert!(o.in_velocity_obstacle(lost, far, 10.0));
            let mut s = s;
            s.start.position = far;
            s.speed = bad;
            assert!(o.first_contact(&s, 0.0).is_some());
            assert_eq!(o.peak_risk(&s).risk, 1.0);
        }
        let lost = Vector::new(f64::NAN, 0.0);
        assert!(o.contains(lost, 1.0) && o.contains(far, f64::NAN));
        assert!(o.signed_distance(lost, 1.0).distance.is_nan());
        assert_eq!((o.risk(far, f64::NAN), o.risk(lost, 1.0)), (1.0, 1.0));
        assert!(o.first_contact(&s, f64::NAN).is_some());
        assert!(!o.contains(far, 1.0) && !o.contains(o_center(&o), -1.0));
        let past = Segment {
            start_time: -50.0,
            duration: 40.0,
            ..s
        };
        assert_eq!(o.first_contact(&past, 0.0), None);
        assert_eq!(o.peak_risk(&past).risk, 0.0);
    });
}

fn o_center<O: SpaceTimeObstacle>(o: &O) -> Vector {
    let middle = |n: Vector| 0.5 * (o.support(n, 0.0).value - o.support(-n, 0.0).value);
    Vector::new(middle(Vector::x()), middle(Vector::y()))
}

macro_rules! suite {
    ($room:ident, $draw:expr, $($test:ident)*) => {
        mod $room {
            use super::*;

            $(
                #[test]
                fn $test() {
                    super::$test($draw);
                }
            )*
        }
    };
    ($room:ident, $draw:expr) => {
        suite!($room, $draw,
            distance_is_the_best_supporting_line
            alpha_is_the_least_scaling
            contact_is_the_first_instant_inside
            peak_risk_is_the_largest_sample
            approach_is_the_least_sample
            risk_levels_are_nested
            what_is_no_number_is_in_contact
        );
    };
}

suite!(of_polytopes, polytope());
suite!(of_ellipsoids, ellipsoid());
suite!(of_slabs, slabs());
suite!(of_round_slabs, round_slabs());

/// Tests the remainder of a set from a time on, with a clock that starts then. A polygon is exact.
/// An ellipse is exact at first and never smaller.
#[test]
fn what_remains_of_a_set_goes_on_from_its_section() {
    let any = prop_oneof![3 => obstacle(), 1 => round_slabs()];
    let cases = (any, 0.5..100.0, 0.0..20.0, 20.0..90.0);
    check(506, 600, cases, |(o, time, soon, late)| {
        let rest = o.remainder(time);
        for later in [0.0, soon, late] {
            for n in directions(24) {
                let was = o.support(n, time + later).value;
                let is = rest.support(n, later).value;
                let equal = later == 0.0 || o.representation() == Representation::Polytope;
                assert!(
                    is > was - 1e-6 && (!equal || is < was + 1e-6),
                    "{later} {was} {is}"
                );
            }
        }
    });
}

/// Between 3999.9999999999995 s and the horizon lies one rounding; less 853.1 s they are one
/// number.
#[test]
fn what_remains_of_a_set_has_moved_also_where_its_changes_round_to_one_time() {
    let scenario = "title = \"slow turn\"\nhorizon_s = 4000\n[own_ship]\n\
                    position = { east_m = 0, north_m = 0 }\ncourse_deg = 90\nspeed_mps = 2\n\
                    length_m = 100\nbeam_m = 25\nturning_radius_m = 600\n\
                    safety_margin_m = 100\n[mission]\nwaypoints = [{ east_m = 0, north_m = 0 }, \
                    { east_m = 4000, north_m = 0 }]\n[[targets]]\nname = \"t\"\n\
                    position = { east_m = 4049.33, north_m = -159.6 }\ncourse_deg = 288.67\n\
                    speed_mps = 1.2\nlength_m = 100\nbeam_m = 10\nspeed_spread_mps = 0.04\n\
                    course_spread_deg = 3\nturn_rate_deg_per_s = 0.02\ndomain = \"hull\"\n";
    let scenario = Scenario::parse(scenario).expect("a scenario");
    let set = &pipeline::sets(&scenario)[0].hard;
    let time = 853.128_591_496_340_7;
    let rest = set.remainder(time);
    for n in directions(8) {
        let (was, is) = (
            set.support(n, 1100.0).value,
            rest.support(n, 1100.0 - time).value,
        );
        assert!((was - is).abs() < 1e-6, "{was} {is}");
    }
}
