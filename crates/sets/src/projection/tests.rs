use super::*;
use crate::geometry_fixtures::random_polygon;
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom_geometry::ConvexPolygon;

fn random_obstacle(rng: &mut ChaCha8Rng, sizes: [f64; 2]) -> PolytopeObstacle {
    let [initial, velocity] = sizes.map(|size| random_polygon(rng, size));
    PolytopeObstacle::new("x", initial, velocity)
}

/// Paper eq. (29): the diagram's time starts when own ship enters the path.
#[test]
fn the_projection_is_membership_along_the_path() {
    let mut rng = ChaCha8Rng::seed_from_u64(51);
    let (mut met, mut clear) = (0, 0);
    for case in 0..300 {
        let o = random_obstacle(&mut rng, [27.0, 1.0]);
        let [x, y] = [-200.0..0.0, -100.0..100.0].map(|range| rng.random_range(range));
        let track = Track {
            start: Vector::new(x, y),
            direction: searoom_geometry::frame::direction(rng.random_range(-0.6..0.6)),
            length: 400.0,
        };
        let (begins, duration) = ([0.0, 25.0][case % 2], 120.0);
        let corners = along_track(&o, &track, begins, duration).into_iter();
        let points = corners.map(|c| Vector::new(c.distance, c.time));
        let polygon = ConvexPolygon::hull(&points.collect::<Vec<_>>()).ok();
        for _ in 0..200 {
            let (s, t) = (
                rng.random_range(0.0..400.0),
                rng.random_range(0.0..duration),
            );
            let depth = o.slack(track.at(s), begins + t).value;
            let polygon = polygon.as_ref();
            let inside = polygon.is_some_and(|p| p.contains(Vector::new(s, t)));
            if depth < -1e-6 {
                met += 1;
                assert!(inside, "{s} {t} {depth}");
            } else if depth > 1e-6 {
                clear += 1;
                assert!(!inside, "{s} {t} {depth}");
            }
        }
    }
    assert!(met > 1000 && clear > 1000, "{met} {clear}");
}

#[test]
fn the_polygons_of_an_ellipsoid_contain_it_and_hardly_more() {
    let mut rng = ChaCha8Rng::seed_from_u64(52);
    let (mut met, mut most) = (0, 0);
    for _ in 0..300 {
        let o = EllipsoidObstacle::outer_of(&random_obstacle(&mut rng, [27.0, 1.0]));
        let bend = Vector::new(
            rng.random_range(-150.0..50.0),
            rng.random_range(-80.0..80.0),
        );
        let turned = |start: Vector, way: f64| Track {
            start,
            direction: searoom_geometry::frame::direction(way),
            length: 300.0,
        };
        let way = rng.random_range(-0.6..0.6);
        let before = turned(bend - searoom_geometry::frame::direction(way) * 300.0, way);
        let tracks = [before, turned(bend, rng.random_range(-2.0..2.0))];
        let horizon = 120.0;
        let faces = outer_faces_along(&o, &tracks, horizon);
        most = most.max(faces.len());
        for track in &tracks {
            let seen = PathTimeObstacle::new(&faces, 0.0, track, [0.0, horizon], 1e-7);
            for corner in seen.iter().flat_map(|s| s.corners()) {
                let away = o.signed_distance(track.at(corner.distance), corner.time);
                assert!(away.distance <= OUTER_EXCESS_M + 1e-9, "{away:?}");
            }
            for _ in 0..200 {
                let at =
                    PathTime::new(rng.random_range(0.0..300.0), rng.random_range(0.0..horizon));
                let away = o.signed_distance(track.at(at.distance), at.time).distance;
                if away < -1e-6 {
                    met += 1;
                    assert!(seen.as_ref().is_some_and(|s| s.slack(at) < 0.0), "{away}");
                }
                if away > OUTER_EXCESS_M + 1e-6 {
                    assert!(seen.as_ref().is_none_or(|s| s.slack(at) > 0.0), "{away}");
                }
            }
        }
    }
    assert!(met > 1000 && most < 2 * MAX_CUTS, "{met} {most}");
}

/// A line is inside exactly while its points are.
#[test]
fn the_part_of_a_line_inside_is_that_of_its_points() {
    let mut rng = ChaCha8Rng::seed_from_u64(53);
    let mut met = 0;
    for case in 0..2000 {
        let o = random_obstacle(&mut rng, [20.0, 0.7]);
        let start = Vector::new(rng.random_range(-200.0..0.0), rng.random_range(-60.0..60.0));
        let direction = searoom_geometry::frame::direction(rng.random_range(-0.6..0.6));
        let track = Track {
            start,
            direction,
            length: 200.0,
        };
        let times = [10.0, 70.0];
        let seen = PathTimeObstacle::new(o.faces(), 10.0, &track, times, 1e-7);
        // including waits at the ends of the track
        let s = match case % 4 {
            0 => [0.0, 0.0],
            1 => [200.0, 200.0],
            _ => [rng.random_range(0.0..100.0), rng.random_range(100.0..200.0)],
        };
        let t = [rng.random_range(0.0..40.0), rng.random_range(40.0..90.0)];
        let [from, to] = [0, 1].map(|i| PathTime::new(s[i], t[i]));
        let found = seen.as_ref().and_then(|o| o.inside(from, to, 1e-7));
        met += usize::from(found.is_some());
        for i in 0..=400 {
            let share = f64::from(i) / 400.0;
            let (d, t) = (s[0] + (s[1] - s[0]) * share, t[0] + (t[1] - t[0]) * share);
            let slack = o.slack(track.at(d), t - times[0]).value;
            let inside = slack < 0.0 && t > times[0] && t < times[1];
            let within = found.is_some_and(|[a, b]| share > a && share < b);
            let edge =
                found.is_some_and(|[a, b]| (share - a).abs() < 1e-6 || (share - b).abs() < 1e-6);
            if slack.abs() > 1e-5 && !edge {
                assert_eq!(inside, within, "{slack} {t} {found:?}");
            }
        }
    }
    assert!(met > 200, "{met}");
}
