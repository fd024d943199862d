//! Land around a path, and the resulting plan.

use super::*;
use crate::document::{PlanDocument, json};
use crate::frame::direction;
use crate::geometry::{Polygon, Window};
use crate::map::Map;
use crate::scenario::Land;
use crate::verification::verify;
use rand::{Rng, SeedableRng};
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

/// Islands with rough coasts on both sides of the path.
fn archipelago(vertices: usize) -> Map {
    let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(84);
    let mut island = |x: f64, y: f64| {
        let corner = |k: usize| {
            let angle = std::f64::consts::TAU * k as f64 / vertices as f64;
            let radius = 260.0 + 30.0 * (7.0 * angle).sin() + rng.random_range(0.0..0.05);
            Vector::new(x, y) + direction(angle) * radius
        };
        Polygon::new(&[(0..vertices).map(corner).collect()]).expect("an island")
    };
    let places = [0.0, 600.0, 1200.0, 1800.0].map(|x| [(x, 400.0), (x, -400.0)]);
    let islands = places.into_iter().flatten().map(|(x, y)| island(x, y));
    Map::new(islands.collect()).expect("land")
}

/// A map of many pieces: the document holds an outer approximation of them, and says so.
#[test]
fn land_of_many_pieces_is_simplified_outward() {
    let asked = |vertices: usize| {
        let mut asked = scenario(track(0.0, 0.0, 0.0, 0.0), Compliance::Shape);
        asked.targets.clear();
        asked.land = Some(Land {
            map: Arc::new(archipelago(vertices)),
            margin: 5.0,
        });
        asked
    };
    assert_eq!(land_within_reach(&asked(100)).simplified, None);
    let run = run(asked(6_000));
    let land = run.scenario.land.as_ref().expect("land");
    let all = run.land.simplified.expect("simplified");
    let pieces = &run.land.pieces;
    assert!(
        all > 10_000 && pieces.len() <= 10_000,
        "{all} {}",
        pieces.len()
    );
    let corners: usize = pieces.iter().map(|piece| piece.vertices().len()).sum();
    assert!(corners < 50_000, "{corners}");
    let (own, end) = (&run.scenario.own_ship, run.scenario.desired.end());
    let middle = (own.pose.position + end) * 0.5;
    let reach = 0.5 * own.max_speed() * run.scenario.horizon;
    for polygon in land.map.polygons() {
        let vertices = polygon.rings()[0].iter().step_by(97);
        for vertex in vertices.filter(|v| (*v - middle).amax() <= reach) {
            let holds = |piece: &ConvexPolygon| piece.signed_distance(*vertex) <= 1e-6;
            assert!(pieces.iter().any(holds), "{vertex:?}");
        }
    }
    // what is near own ship's way is as it was
    let near = |piece: &&ConvexPolygon| {
        let window = Window::around(piece.vertices()).expect("a piece");
        window.low.y < 40.0 && window.high.y > -40.0
    };
    let own = land.map.pieces();
    assert!(pieces.iter().filter(near).all(|piece| own.contains(piece)));
    let plan = PlanDocument::of(&run);
    assert_eq!(plan.land_outer_of, Some(all));
    let evaluation = run.evaluation.as_ref().expect("a plan");
    assert!(evaluation.verified(), "{:?}", evaluation.violations);
    let text = json(&plan).expect("a document");
    assert!(text.len() < 4 << 20, "{} bytes", text.len());
    let checked = verify(&text).expect("a plan document");
    assert!(checked.violations.is_empty(), "{:?}", checked.violations);
}
