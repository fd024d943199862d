//! Land around a path, and the resulting plan.

use super::*;
use crate::geometry::Polygon;
use crate::map::Map;
use crate::scenario::Land;
use std::sync::Arc;

/// A gap in a wall across the path with this half-width. Own hull, 30 m by 8 m, with its margin of
/// 10 m needs 14 m on course, and 25.6 m at any heading.
#[test]
fn a_gap_that_only_the_whole_disc_closes_is_closed() {
    for (half, open) in [
        (14.5, false),
        (18.0, false),
        (21.0, false),
        (25.0, false),
        (27.0, true),
    ] {
        let mut asked = scenario(track(0.0, 0.0, 0.0, 0.0), Compliance::Shape);
        asked.targets.clear();
        let wall = |from: f64, to: f64| {
            let corners = [(700.0, from), (720.0, from), (720.0, to), (700.0, to)];
            Polygon::new(&[corners.map(|(x, y)| Vector::new(x, y)).to_vec()]).expect("a wall")
        };
        let map = Map::new(vec![wall(half, 300.0), wall(-300.0, -half)]).expect("walls");
        asked.land = Some(Land {
            map: Arc::new(map),
            margin: 10.0,
        });
        let run = run(asked);
        let plan = run.planned.outcome.plan().expect("a way round");
        let evaluation = run.evaluation.as_ref().expect("judged");
        assert!(evaluation.verified(), "{:?}", evaluation.violations);
        let times = plan.trajectory.sample_times(0.5, 10_000);
        let through = times.into_iter().any(|time| {
            let at = plan.trajectory.pose_at(time).position;
            at.x > 700.0 && at.x < 720.0 && at.y.abs() < half
        });
        assert_eq!(through, open, "{half}");
        assert_eq!(plan.cost < 1.0, open, "{half}: {}", plan.cost);
    }
}
