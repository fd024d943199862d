use super::*;
use searoom_geometry::frame::{Pose, Vector};

fn dense(desired: &DesiredTrajectory, s: &Segment, q: f64) -> f64 {
    let n = 50_000;
    let sum: f64 = (0..n)
        .map(|i| {
            let t = s.start_time + s.duration * (f64::from(i) + 0.5) / f64::from(n);
            desired.nearest(s.pose_at(t).position, t, q).error
        })
        .sum();
    sum * s.duration / f64::from(n) / desired.duration()
}

#[test]
fn matches_a_dense_sum_on_lines_arcs_corners_and_clamped_ends() {
    let corner = [(0.0, 0.0), (500.0, 0.0), (700.0, 400.0)].map(|(x, y)| Vector::new(x, y));
    let straight = [(0.0, 0.0), (1500.0, 0.0)].map(|(x, y)| Vector::new(x, y));
    for desired in [
        DesiredTrajectory::new(&corner, &[5.0, 4.0]).expect("valid"),
        DesiredTrajectory::new(&straight, &[5.0]).expect("valid"),
    ] {
        for i in 0..60 {
            let k = f64::from(i);
            let segment = Segment::new(
                Pose::new(
                    Vector::new(800.0 * (0.31 * k).sin(), 150.0 * (k * 0.7).cos()),
                    k * 0.41,
                ),
                (k * 3.7) % 90.0,
                20.0 + k,
                [0.0, 2.5, 5.0, 6.0][i as usize % 4],
                [0.0, 0.05, -0.06][i as usize % 3],
            );
            let exact = dense(&desired, &segment, 25.0);
            let found = space_time_error(&desired, &segment, 25.0);
            assert!(
                (found - exact).abs() <= 1e-5 * (1.0 + exact),
                "{found} {exact} {segment:?}"
            );
        }
    }
}

/// Arcs over corners and beyond both ends. The test takes the one of many arcs whose cost in the
/// search is most wrong.
#[test]
fn reported_costs_equal_a_dense_sum() {
    let points = [(0.0, 0.0), (500.0, 0.0), (700.0, 400.0), (660.0, 500.0)];
    let desired = DesiredTrajectory::new(&points.map(|(x, y)| Vector::new(x, y)), &[5.0, 4.0, 2.0])
        .expect("valid");
    let (q, mut most) = (25.0, (0.0, None));
    for i in 0..20_000 {
        let k = f64::from(i);
        let segment = Segment::new(
            Pose::new(
                Vector::new(
                    350.0 + 400.0 * (0.31 * k).sin(),
                    200.0 + 250.0 * (k * 0.7).cos(),
                ),
                k * 0.41,
            ),
            (k * 3.7) % 300.0,
            20.0 + k % 60.0,
            [2.5, 5.0][i as usize % 2],
            [0.004, -0.05, 0.02][i as usize % 3],
        );
        let after = error_after_end(&desired, &segment, q);
        let told = whole_space_time_error(&desired, &[segment], q) - after;
        let off = (told - space_time_error(&desired, &segment, q)).abs() / (1.0 + told);
        if off > most.0 {
            most = (off, Some(segment));
        }
    }
    let segment = most.1.expect("they differ");
    let exact = dense(&desired, &segment, q);
    let off = |found: f64| (found - exact).abs() / (1.0 + exact);
    assert!(
        off(space_time_error(&desired, &segment, q)) > 1e-8,
        "{most:?}"
    );
    // the sum of 50,000 midpoints is itself no better
    // before and after the end of the desired trajectory
    for start_time in [0.0, desired.duration() - 10.0] {
        let segment = Segment {
            start_time,
            ..segment
        };
        let left = (desired.duration() - segment.end_time()).max(0.0);
        assert_eq!(left > 0.0, start_time == 0.0);
        let wait = Segment::straight(segment.end(), segment.end_time(), left, 0.0);
        let exact = dense(&desired, &segment, q) + dense(&desired, &wait, q);
        let found = whole_space_time_error(&desired, &[segment], q);
        assert!((found - exact).abs() <= 1e-7 * (1.0 + exact), "{segment:?}");
    }
}

/// Long and short turns, slow and fast legs, small and large time weights.
#[test]
fn one_leg_in_closed_form_is_the_sum_by_halves() {
    let mut closed = 0;
    for i in 0..4000 {
        let k = f64::from(i);
        let points = [(-40.0, 10.0), (900.0, 300.0)].map(|(x, y)| Vector::new(x, y));
        let desired = DesiredTrajectory::new(&points, &[1.0 + (i % 5) as f64]).expect("valid");
        let segment = Segment::new(
            Pose::new(
                Vector::new(400.0 + 600.0 * (0.31 * k).sin(), 150.0 * (k * 0.7).cos()),
                k * 0.41,
            ),
            (k * 3.7) % 300.0,
            80.0 * (k * 0.19).sin().powi(4),
            [0.0, 2.5, 5.0, 6.0][i as usize % 4],
            [0.0, 0.05, -0.06, 0.003, -1e-7][i as usize % 5],
        );
        let q = [0.5, 25.0, 400.0][i as usize % 3];
        let integrand = Integrand {
            near: None,
            desired: &desired,
            mover: Mover::new(&segment),
            time_weight: q,
            is_arc: segment.is_arc(),
        };
        let pieces = 64;
        let duration = segment.duration / f64::from(pieces);
        let halved: f64 = (0..pieces)
            .map(|k| segment.start_time + duration * f64::from(k))
            .map(|from| integrand.integral(from, duration, 25))
            .sum();
        let Some(found) = SingleLeg::new(&desired.legs()[0], &segment, q).integral() else {
            continue;
        };
        closed += 1;
        assert!(
            (found - halved).abs() <= 1e-8 * (1.0 + halved),
            "{found} {halved} {segment:?}"
        );
    }
    assert!(closed > 2500, "{closed}");
}

/// Round trips, collinear legs, sharp corners, waits, motions on and off the legs.
#[test]
fn lines_near_several_legs_are_the_dense_sum() {
    let mut closed = 0;
    for i in 0..400 {
        let k = f64::from(i);
        let mut points = vec![Vector::new(-40.0, 10.0)];
        for leg in 0..2 + i % 7 {
            let j = f64::from(leg);
            let heading =
                [0.0, 0.8 * (k + j).sin(), 3.0 * (k * 0.3 + j).cos(), PI * j][i as usize % 4];
            let way = 40.0 + 160.0 * (0.7 * k + j).sin().powi(2);
            points.push(points[leg as usize] + searoom_geometry::frame::direction(heading) * way);
        }
        let speeds: Vec<f64> = (0..points.len() - 1)
            .map(|j| 1.0 + ((i as usize + j) % 3) as f64)
            .collect();
        let desired = DesiredTrajectory::new(&points, &speeds).expect("valid");
        let on_path = desired.position_at(0.5 * desired.duration() * (1.0 + (0.31 * k).sin()));
        let aside = if i % 3 == 0 {
            0.0
        } else {
            60.0 * (0.9 * k).cos()
        };
        let segment = Segment::straight(
            Pose::new(on_path + Vector::new(0.3, 1.0) * aside, k * 0.41),
            (k * 3.7) % 200.0,
            120.0 * (k * 0.19).sin().powi(4),
            [0.0, 2.5, 1.0, 6.0][i as usize % 4],
        );
        let q = [0.5, 25.0, 0.0, 400.0][(i as usize / 4) % 4];
        let Some(found) = line_error::integral(&desired, &segment, q) else {
            continue;
        };
        closed += 1;
        let (found, exact) = (found / desired.duration(), dense(&desired, &segment, q));
        assert!(
            (found - exact).abs() <= 1e-7 * (1.0 + exact),
            "{i}: {found} {exact} {segment:?}"
        );
    }
    assert!(closed > 395, "{closed}");
}

/// Along a winding path, the legs that are left out are never nearest.
#[test]
fn legs_left_out_are_never_nearest() {
    let place = |k: usize| {
        let k = k as f64;
        Vector::new(60.0 * (0.7 * k).sin() + 9.0 * k, 60.0 * (1.1 * k).cos())
    };
    let points: Vec<Vector> = (0..40).map(place).collect();
    let desired = DesiredTrajectory::new(&points, &[4.0; 39]).expect("valid");
    for k in 0..200_usize {
        let f = k as f64;
        let segment = Segment::new(
            Pose::new(place(k % 40) + Vector::new(20.0 * f.sin(), 5.0), f),
            3.0 * f,
            5.0 + (k % 7) as f64 * 20.0,
            4.0,
            0.04,
        );
        let pieces = (segment.turn_rate * segment.duration / SEARCH_SUBDIVISION.arc).ceil();
        let integrand = Integrand {
            desired: &desired,
            near: None,
            mover: Mover::new(&segment),
            time_weight: 16.0,
            is_arc: true,
        };
        let duration = segment.duration / pieces;
        let all: f64 = (0..pieces as usize)
            .map(|k| segment.start_time + duration * k as f64)
            .map(|from| integrand.integral(from, duration, MAX_HALVINGS))
            .sum();
        let found = space_time_error(&desired, &segment, 16.0) * desired.duration();
        assert!((found - all).abs() <= 1e-12 * all, "{found} {all}");
    }
}
