//! Last waypoint covered by sets until the horizon, and the mission shortened to end before them.

use crate::space_time::piece::pieces;
use crate::space_time::proxy::{Proxy, within_reach};
use crate::{NoPlan, Problem};
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance;
use searoom_model::trajectory::DesiredTrajectory;
use searoom_sets::SpaceTimeObstacle;
use searoom_sets::contact::Interval;

/// Distance between two candidate ends along the path, in own lengths, and at least this many
/// metres.
const STEP_LENGTHS: f64 = 0.5;
const STEP_M: f64 = 10.0;

/// Seconds for which sets leave the end uncovered: a manoeuvre on the way makes own ship late.
const HOLD_S: f64 = 300.0;

/// The reason where sets cover the last waypoint from the earliest possible arrival to the horizon:
/// then no motion is clear of them. O(n log n).
pub(crate) fn end_covered(problem: &Problem, proxies: &[Proxy]) -> Option<NoPlan> {
    let (end, horizon) = (problem.desired.end(), problem.horizon);
    let away = (end - problem.own.pose.position).norm();
    let earliest = away / problem.own.max_speed();
    let mut inside = covering(proxies, end, earliest, horizon);
    inside.sort_by(|a, b| a.0.start.total_cmp(&b.0.start));
    let (mut until, mut last) = (earliest, None);
    for (interval, obstacle) in inside {
        if interval.start > until + tolerance::TIME_S {
            break;
        }
        if interval.end > until {
            (until, last) = (interval.end, Some(obstacle));
        }
    }
    // negated on purpose: a NaN is no reason
    if !(until >= horizon - tolerance::TIME_S) {
        return None;
    }
    let target = problem.obstacles[last?].name().to_owned();
    Some(NoPlan::EndCovered { target, earliest })
}

/// The reason why there is no plan to the end, where sets cover it, and the mission cut at the last
/// place ahead that these sets leave free for [`HOLD_S`] from its scheduled time on; where there is
/// none, at that time. Where the schedule is ahead of own ship, places on the way to it count, too.
///
/// Without a mission where no place ahead is free, and own ship is within its turning radius of the
/// path. `None` where the end is not covered, or own ship is farther off.
pub(crate) fn short_of_end(problem: &Problem) -> Option<(NoPlan, Option<DesiredTrajectory>)> {
    let pieces = pieces(problem.obstacles, problem.horizon);
    let proxies = within_reach(problem, &pieces);
    let why = end_covered(problem, &proxies)?;
    let (own, desired, horizon) = (problem.own, problem.desired, problem.horizon);
    let over_end = covering(&proxies, desired.end(), 0.0, horizon);
    let is_over = |proxy: &&Proxy| over_end.iter().any(|(_, k)| *k == proxy.obstacle);
    let over_end: Vec<Proxy> = proxies.iter().filter(is_over).copied().collect();
    let step = (STEP_LENGTHS * own.hull.length).max(STEP_M);
    let on_path = |way: &DesiredTrajectory| way.nearest(own.pose.position, 0.0, 0.0);
    let last_free = |way: &DesiredTrajectory, hold: f64| {
        let here = on_path(way).distance + tolerance::LENGTH_M;
        let mut ends = (1..)
            .map_while(|k| way.shortened(step * f64::from(k)))
            .take_while(|short| short.length() > here);
        ends.find(|short| {
            let time = short.duration();
            let until = (time + hold).min(horizon);
            time <= horizon && covering(&over_end, short.end(), time, until).is_empty()
        })
    };
    let candidates = [Some(desired.clone()), from_own_ship(problem)];
    let mut candidates = candidates.iter().flatten();
    let short = candidates.find_map(|way| last_free(way, HOLD_S).or_else(|| last_free(way, 0.0)));
    let is_near = on_path(desired).error.sqrt() <= own.turning_radius;
    (short.is_some() || is_near).then_some((why, short))
}

/// The desired trajectory after a straight leg from own ship to its start, where that is ahead.
fn from_own_ship(problem: &Problem) -> Option<DesiredTrajectory> {
    let (here, desired) = (problem.own.pose.position, problem.desired);
    let first = desired.legs().first()?;
    if (first.start - here).dot(&first.direction) <= 0.0 {
        return None;
    }
    let waypoints: Vec<Vector> = [here].into_iter().chain(desired.waypoints()).collect();
    let legs = [first].into_iter().chain(desired.legs());
    let speeds: Vec<f64> = legs.map(|leg| leg.speed).collect();
    DesiredTrajectory::new(&waypoints, &speeds).ok()
}

/// When each set covers a place between two times, with the index of its obstacle.
fn covering(proxies: &[Proxy], place: Vector, from: f64, to: f64) -> Vec<(Interval, usize)> {
    let covering = |proxy: &Proxy| Some((proxy.covers(place, from, to)?, proxy.obstacle));
    proxies.iter().filter_map(covering).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_fixtures::own_ship;
    use rand::{Rng, SeedableRng};
    use searoom_geometry::frame::direction;
    use searoom_geometry::{ConvexPolygon, outer_disc};
    use searoom_sets::{Obstacle, PolytopeObstacle};

    const HORIZON_S: f64 = 900.0;

    fn set(place: Vector, radius: f64, velocity: Vector, spread: f64) -> Obstacle {
        let rates = [0.0, 2.1, 4.2].map(|angle| velocity + direction(angle) * spread);
        PolytopeObstacle::new(
            "",
            outer_disc(radius, 0.0).translated(place),
            ConvexPolygon::hull(&rates).expect("finite"),
        )
        .into()
    }

    /// Compares with sampled times, for sets that grow over the end, pass it and end before it.
    #[test]
    fn an_end_is_covered_where_some_set_is_over_it_at_every_time() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let own = own_ship(&[2.5, 5.0, 6.0]);
        let end = Vector::new(1500.0, 0.0);
        let desired = DesiredTrajectory::new(&[Vector::zeros(), end], &[5.0]).expect("valid");
        let (mut covered, mut short) = (0, 0);
        for case in 0..400 {
            let sets: Vec<Obstacle> = (0..3)
                .map(|_| {
                    let place = end + direction(rng.random_range(-3.1..3.1)) * 300.0;
                    let to_end = (end - place) * rng.random_range(-0.001..0.004);
                    let radius = rng.random_range(20.0..320.0);
                    set(place, radius, to_end, rng.random_range(0.0..0.6))
                })
                .collect();
            let problem = Problem::new(&own, &desired, &sets, HORIZON_S);
            let pieces = pieces(&sets, HORIZON_S);
            let found = end_covered(&problem, &within_reach(&problem, &pieces)).is_some();
            let inside = |set: &Obstacle, place: Vector, time: f64| {
                set.signed_distance(place, time).distance < -1e-6
            };
            let at = |k: u32| HORIZON_S * f64::from(k) / 9000.0;
            let free = (2500..=9000).any(|k| !sets.iter().any(|set| inside(set, end, at(k))));
            assert_eq!(found, !free, "case {case}");
            covered += usize::from(found);
            let Some(cut) = short_of_end(&problem).and_then(|(_, short)| short) else {
                continue;
            };
            assert!(found && cut.length() < desired.length());
            let is_over_end = |set: &&Obstacle| (0..=9000).any(|k| inside(set, end, at(k)));
            let mut over_end = sets.iter().filter(is_over_end);
            let met = over_end.any(|set| inside(set, cut.end(), cut.duration()));
            assert!(!met, "case {case}");
            short += 1;
        }
        assert!(
            covered > 50 && covered < 350 && short > 50,
            "{covered} {short}"
        );
    }

    /// 260 m around the end for ever: own ship of 30 m stops at the first step of 15 m before.
    #[test]
    fn the_path_ends_at_the_last_step_before_the_set() {
        let own = own_ship(&[2.5, 5.0, 6.0]);
        let points = [
            Vector::zeros(),
            Vector::new(900.0, 0.0),
            Vector::new(900.0, 600.0),
        ];
        let desired = DesiredTrajectory::new(&points, &[5.0, 4.0]).expect("valid");
        let sets = [set(points[2], 260.0, Vector::zeros(), 0.0)];
        let problem = Problem::new(&own, &desired, &sets, HORIZON_S);
        let step = (STEP_LENGTHS * own.hull.length).max(STEP_M);
        let (_, short) = short_of_end(&problem).expect("a covered end");
        let left = desired.length() - short.expect("a place").length();
        let around = (261.0 / step).ceil() * step;
        assert!(
            (left - around).abs() < 1e-9 || left < around && left > 260.0,
            "{left}"
        );
    }
}
