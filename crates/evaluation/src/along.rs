//! Checks that a chain of segments follows the paths that own ship is restricted to.

use super::Violation;
use searoom_geometry::frame::{Vector, direction, wrap};
use searoom_geometry::tolerance;
use searoom_model::trajectory::Segment;
use searoom_model::vessel::OwnShip;

/// Position on the paths: index of the path and distance along it.
#[derive(Debug, Clone, Copy)]
struct Whereabouts {
    path: usize,
    distance: f64,
}

/// Checks a chain of segments against `paths`.
///
/// - Each segment is a wait, or runs straight along a leg in the direction of its path.
/// - No segment is faster than own ship's greatest speed.
/// - The chain begins at the start of the first path and continues from where it was. It changes to
///   another path only at a place that the two paths share.
/// - Own ship turns on the spot only where it then departs along a leg.
/// - With `arrives`, the chain ends at the end of a path.
///
/// The planner's network is not used. All positions on the paths that are consistent with the
/// motion so far are tracked in parallel.
pub(super) fn check(
    segments: &[Segment],
    own: &OwnShip,
    paths: &[Vec<Vector>],
    arrives: bool,
) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut add = |time: f64, what: String| found.push(Violation { what, time });
    let start = Whereabouts {
        path: 0,
        distance: 0.0,
    };
    let mut here = vec![start];
    for (index, s) in segments.iter().enumerate() {
        let fastest = own.max_speed();
        // Negated on purpose: a NaN speed is too fast.
        if !(s.speed <= fastest * (1.0 + tolerance::LIMIT)) {
            let found = s.speed;
            let what = format!("speed in segment {index}: {found} m/s, allowed 0 to {fastest}");
            add(s.start_time, what);
        }
        if s.turn_rate != 0.0 {
            let found = s.turn_rate;
            let what = format!("turn rate in segment {index}: {found} rad/s, allowed 0");
            add(s.start_time, what);
        }
        if !(s.length() > 0.0) {
            let before = index
                .checked_sub(1)
                .map_or(s.start.heading, |i| segments[i].start.heading);
            let turn = wrap(s.start.heading - before).abs();
            if !(turn <= tolerance::JOINT_RAD) {
                let what = format!("heading of the wait in segment {index}: turned by {turn} rad");
                add(s.start_time, what);
            }
            continue;
        }
        let mut next: Vec<Whereabouts> = Vec::new();
        for from in everywhere(&here, s.start.position, paths) {
            if let Some(distance) = sailed(&paths[from.path], from.distance, s) {
                next.push(Whereabouts { distance, ..from });
            }
        }
        if next.is_empty() {
            let what =
                format!("path: segment {index} does not follow a leg from its start position");
            add(s.start_time, what);
            return found;
        }
        here = next;
    }
    if let (Some(last), true) = (segments.last(), arrives) {
        let end = last.end().position;
        let arrived = everywhere(&here, end, paths).iter().any(|at| {
            let legs = paths[at.path].windows(2);
            let length: f64 = legs.map(|leg| (leg[1] - leg[0]).norm()).sum();
            at.distance >= length - tolerance::ARRIVAL_M
        });
        if !arrived {
            let what = "arrival: short of the end of the path";
            add(last.end_time(), what.to_owned());
        }
    }
    found
}

/// Returns `here`, and the places of other paths at the same position. A path never changes to
/// itself.
fn everywhere(here: &[Whereabouts], position: Vector, paths: &[Vec<Vector>]) -> Vec<Whereabouts> {
    let mut all = here.to_vec();
    for (path, points) in paths.iter().enumerate() {
        if here.iter().any(|h| h.path != path) {
            all.extend(places(points, position).map(|distance| Whereabouts { path, distance }));
        }
    }
    all
}

/// Distances along a path at which `position` lies on it, at most one per leg.
fn places(points: &[Vector], position: Vector) -> impl Iterator<Item = f64> + '_ {
    let mut run = 0.0;
    points.windows(2).filter_map(move |leg| {
        let step = leg[1] - leg[0];
        let length = step.norm();
        let along = (step.dot(&(position - leg[0])) / length).clamp(0.0, length);
        let on = (leg[0] + step * (along / length) - position).norm() <= tolerance::JOINT_M;
        let distance = run + along;
        run += length;
        on.then_some(distance)
    })
}

/// Distance along a path at which a segment ends that starts at distance `from`. `None` if the
/// segment is not along one leg.
fn sailed(points: &[Vector], from: f64, s: &Segment) -> Option<f64> {
    let mut run = 0.0;
    for leg in points.windows(2) {
        let step = leg[1] - leg[0];
        let length = step.norm();
        let along = from - run;
        run += length;
        if along < -tolerance::JOINT_M || along > length - tolerance::JOINT_M * 0.5 {
            continue;
        }
        let ahead = step / length;
        let start = leg[0] + ahead * along;
        let way = s.speed * s.duration;
        let off = (s.start.position - start)
            .norm()
            .max((direction(s.start.heading) - ahead).norm() * way)
            .max(along + way - length);
        return (off <= tolerance::JOINT_M).then_some(from + way);
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry_fixtures::places;
    use crate::ship_fixtures::own_ship;
    use searoom_geometry::frame::{Pose, heading_of};

    fn own() -> OwnShip {
        own_ship(&[2.5, 6.0])
    }

    /// Straight segments between places, all at one speed.
    fn chain(through: &[(f64, f64)], speed: f64) -> Vec<Segment> {
        let (mut time, mut heading) = (0.0, 0.0);
        places(through)
            .windows(2)
            .map(|p| {
                let way = p[1] - p[0];
                let waits = way.norm() == 0.0;
                heading = if waits { heading } else { heading_of(way) };
                let duration = if waits { 10.0 } else { way.norm() / speed };
                let speed = if waits { 0.0 } else { speed };
                time += duration;
                Segment::straight(Pose::new(p[0], heading), time - duration, duration, speed)
            })
            .collect()
    }

    #[test]
    fn what_keeps_to_the_paths_passes_and_what_does_not_is_found() {
        let main = places(&[(0.0, 0.0), (100.0, 0.0), (100.0, 80.0), (0.0, 0.0)]);
        let other = places(&[(40.0, 0.0), (60.0, -20.0), (80.0, 0.0)]);
        let paths = [main, other];
        let found = |through: &[(f64, f64)], speed: f64| {
            check(&chain(through, speed), &own(), &paths, false).len()
        };
        let round = [
            (0.0, 0.0),
            (70.0, 0.0),
            (70.0, 0.0),
            (100.0, 0.0),
            (100.0, 80.0),
            (0.0, 0.0),
        ];
        assert_eq!(found(&round, 3.0), 0);
        assert_eq!(found(&round, 6.1), 4);
        let changed = [
            (0.0, 0.0),
            (40.0, 0.0),
            (60.0, -20.0),
            (80.0, 0.0),
            (100.0, 0.0),
        ];
        assert_eq!(found(&changed, 6.0), 0);
        for wrong in [
            // Off the path, back along it, across a corner, off an alternative, and on a path
            // without having reached it.
            &[(0.0, 0.0), (50.0, 1e-5)][..],
            &[(0.0, 0.0), (70.0, 0.0), (60.0, 0.0)],
            &[(0.0, 0.0), (100.0, 0.0), (90.0, 72.0)],
            &[(0.0, 0.0), (40.0, 0.0), (50.0, -10.0), (80.0, 0.0)],
            &[(100.0, 80.0), (0.0, 0.0)],
            // The last leg before the others, although it begins where the first leg ends.
            &[(0.0, 0.0), (100.0, 80.0)],
        ] {
            assert_eq!(found(wrong, 5.0), 1, "{wrong:?}");
        }
        let mut turned = chain(&round, 3.0);
        turned[1].start.heading = 0.3;
        turned[3].turn_rate = 1e-3;
        assert_eq!(check(&turned, &own(), &paths, false).len(), 2);
        turned[0].speed = f64::NAN;
        assert!(!check(&turned, &own(), &paths, false).is_empty());
    }
}
