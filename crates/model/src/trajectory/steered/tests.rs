use super::*;

fn node(time: f64, x: f64, y: f64, heading: f64) -> ForceNode {
    ForceNode {
        time,
        pose: Pose::new(Vector::new(x, y), heading),
        velocity: Vector::new(0.3 + 0.1 * x, -0.1),
        yaw_rate: 0.2 - 0.1 * heading,
        force: Vector::zeros(),
        moment: 0.0,
    }
}

fn motion() -> Steered {
    Steered::new(vec![
        node(0.0, 0.0, 0.0, 0.0),
        node(2.0, 0.5, 0.3, 0.4),
        node(5.0, 1.5, -0.3, 1.1),
    ])
    .expect("in order")
}

#[test]
fn pieces_meet_with_their_rates_and_stay_within_their_bounds() {
    let motion = motion();
    for (piece, pair) in motion.pieces().zip(motion.nodes().windows(2)) {
        assert!((piece.pose_at(pair[1].time).position - pair[1].pose.position).norm() < 1e-12);
        assert!((piece.velocity(0.0) - pair[0].ground_velocity()).norm() < 1e-12);
        assert!((piece.yaw_rate_at(pair[0].time) - pair[0].yaw_rate).abs() < 1e-12);
        let (from, to) = (piece.start_time + 0.3, piece.start_time + 1.1);
        let cut = piece.between(from, to);
        for time in [from, from + 0.5, to] {
            assert!((cut.pose_at(time).position - piece.pose_at(time).position).norm() < 1e-12);
            assert!((cut.yaw_rate_at(time) - piece.yaw_rate_at(time)).abs() < 1e-12);
        }
        let bounds = piece.bounds();
        for k in 0..200 {
            let t = piece.start_time + piece.duration * f64::from(k) / 200.0;
            let step = 1e-5;
            let velocity = (piece.pose_at(t + step).position - piece.pose_at(t - step).position)
                / (2.0 * step);
            assert!((velocity - piece.velocity(piece.part(t))).norm() < 1e-8);
            let bend = (piece.velocity(piece.part(t + step))
                - piece.velocity(piece.part(t - step)))
                / (2.0 * step);
            assert!(bend.norm() <= bounds.acceleration + 1e-6);
            assert!(velocity.norm() <= bounds.speed + 1e-9);
            assert!(piece.yaw_rate_at(t).abs() <= bounds.yaw_rate + 1e-9);
            let turn = (piece.yaw_rate_at(t + step) - piece.yaw_rate_at(t - step)) / (2.0 * step);
            assert!(turn.abs() <= bounds.yaw_acceleration + 1e-6);
        }
    }
}

#[test]
fn the_length_is_that_of_a_dense_sum() {
    let motion = motion();
    let n = 20_000;
    let at = |k: i32| {
        let t = 5.0 * f64::from(k) / f64::from(n);
        motion.piece_at(t).pose_at(t).position
    };
    let dense: f64 = (0..n).map(|k| (at(k + 1) - at(k)).norm()).sum();
    assert!(
        (motion.length() - dense).abs() < 2e-3 * dense,
        "{} {dense}",
        motion.length()
    );
    assert_eq!(motion.node_at(-1.0).time, 0.0);
    assert_eq!(motion.node_at(2.5).time, 2.0);
    assert_eq!(motion.node_at(9.0).time, 5.0);
}

#[test]
fn disorder_is_refused() {
    assert!(Steered::new(vec![node(0.0, 0.0, 0.0, 0.0)]).is_err());
    assert!(Steered::new(vec![node(1.0, 0.0, 0.0, 0.0), node(1.0, 1.0, 0.0, 0.0)]).is_err());
    assert!(
        Steered::new(vec![
            node(0.0, 0.0, 0.0, 0.0),
            node(1.0, f64::NAN, 0.0, 0.0)
        ])
        .is_err()
    );
}
