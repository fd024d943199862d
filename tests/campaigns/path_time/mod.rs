//! The path-time planner against a fine grid on random scenes: the least time is exact.
//!
//! A plan that is wrong panics with its seed; the shares are bounds of the report.

use std::time::Duration;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::frame::{Pose, Vector};
use searoom::geometry::ConvexPolygon;
use searoom::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use searoom::planner::{Objective, Outcome, Planned, Problem, SearchKind, path_time};
use searoom::target::{TimedVelocitySet, Uncertainty};
use searoom::trajectory::{DesiredTrajectory, PathNetwork, Segment};
use searoom::vessel::{Hull, OwnShip};

use super::statistics::quantile;
use super::{Report, Seeds};
use grid::{Path, earliest, least_error};

pub mod grid;

/// All four comparisons, one scene a seed: three sevenths for the least time, a seventh for the
/// space-time error, three fourteenths each for ellipsoids and for alternatives.
pub fn run(seeds: Seeds) -> Report {
    let mut report = Report::default();
    let count = seeds.end - seeds.start;
    let first = |share: u64| seeds.start..seeds.start + (count * share).div_ceil(14);
    least_time(first(6), &mut report);
    space_time_error(first(2), &mut report);
    ellipsoids(first(3), &mut report);
    alternatives(first(3), &mut report);
    report
}

/// Kinds of obstacles in a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kinds {
    Exact,
    Ellipsoids,
}

pub struct Drawn {
    pub path: Path,
    pub obstacles: Vec<Obstacle>,
    pub speed: f64,
    pub horizon: f64,
}

impl Drawn {
    /// The path at four fifths of the speed.
    fn desired(&self) -> DesiredTrajectory {
        let legs = vec![self.speed * 0.8; self.path.points.len() - 1];
        DesiredTrajectory::new(&self.path.points, &legs).expect("valid")
    }

    fn earliest_on_grid(&self, cells: usize, shrunk: bool) -> Option<f64> {
        let (path, obstacles) = (&self.path, &self.obstacles);
        earliest(path, obstacles, self.speed, self.horizon, cells, shrunk)
    }
}

pub fn set(rng: &mut ChaCha8Rng, center: Vector, extent: f64) -> ConvexPolygon {
    let count = rng.random_range(1..7);
    let grid = rng.random_bool(0.3);
    let points: Vec<Vector> = (0..count)
        .map(|_| {
            let p = Vector::new(rng.random_range(-1.0..1.0), rng.random_range(-1.0..1.0));
            center + if grid { p.map(f64::round) } else { p } * extent
        })
        .collect();
    ConvexPolygon::hull(&points).expect("finite")
}

pub fn draw(seed: u64, kinds: Kinds) -> Drawn {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut points = vec![Vector::zeros()];
    for _ in 0..rng.random_range(1..5) {
        let from = points[points.len() - 1];
        let heading: f64 = rng.random_range(-2.0..2.0);
        let way = rng.random_range(60.0..400.0);
        let grid = rng.random_bool(0.3);
        let heading = if grid {
            (heading / 0.8).round() * std::f64::consts::FRAC_PI_4
        } else {
            heading
        };
        points.push(from + Vector::new(heading.cos(), heading.sin()) * way);
    }
    let path = Path { points };
    let (speed, length) = (rng.random_range(2.0..8.0), path.length());
    let horizon = length / speed * rng.random_range(1.05..3.0);
    let count = rng.random_range(1..7);
    let obstacles = (0..count)
        .map(|i| {
            // the target meets a random point of the path at a random time
            let meeting = path.at(length * rng.random_range(0.05..1.0)).1;
            let time = horizon * rng.random_range(0.0..0.7);
            let fast = rng.random_range(0.0..8.0);
            let course: f64 = rng.random_range(-4.0..4.0);
            let velocity = Vector::new(course.cos(), course.sin()) * fast;
            let extent = rng.random_range(5.0..70.0);
            let initial = set(&mut rng, meeting - velocity * time, extent);
            let spread = if rng.random_bool(0.3) {
                0.0
            } else {
                rng.random_range(0.0..0.8)
            };
            let velocities = set(&mut rng, velocity, spread);
            let name = format!("target {i}");
            // a grid would pass through an ellipse without interior
            let wide = initial.area() > 1.0;
            if kinds == Kinds::Ellipsoids && wide && rng.random_bool(0.9) {
                let polytope = PolytopeObstacle::new(name, initial, velocities);
                return EllipsoidObstacle::outer_of(&polytope).into();
            }
            if rng.random_bool(0.25) {
                let turned = Vector::new(velocity.y, velocity.x);
                let timed = vec![
                    TimedVelocitySet::new(time * 0.8 + 1.0, velocities.clone()),
                    TimedVelocitySet::new(f64::INFINITY, set(&mut rng, turned, spread)),
                ];
                let sets = Uncertainty::new(initial, timed);
                return Obstacle::new(name, sets).expect("increasing");
            }
            PolytopeObstacle::new(name, initial, velocities).into()
        })
        .collect();
    Drawn {
        path,
        obstacles,
        speed,
        horizon,
    }
}

pub fn own(path: &Path, speed: f64) -> OwnShip {
    let first = path.points[1] - path.points[0];
    OwnShip {
        pose: Pose::new(path.points[0], first.y.atan2(first.x)),
        speed,
        hull: Hull::new(10.0, 3.0),
        turning_radius: 50.0,
        speeds: vec![speed],
        safety_margin: 5.0,
        tracking_margin: 0.0,
    }
}

pub fn plan(drawn: &Drawn, search: SearchKind, objective: Objective) -> Planned {
    plan_within(drawn, search, objective, Duration::from_secs(60))
}

pub fn plan_within(
    drawn: &Drawn,
    search: SearchKind,
    objective: Objective,
    deadline: Duration,
) -> Planned {
    let own = own(&drawn.path, drawn.speed);
    let desired = drawn.desired();
    path_time::plan(&Problem {
        objective,
        time_weight: 25.0,
        search,
        deadline,
        ..Problem::new(&own, &desired, &drawn.obstacles, drawn.horizon)
    })
}

/// Checks that the plan is straight, follows the path in order, respects the speed limit, and is
/// clear of every set.
pub fn assert_sound(drawn: &Drawn, segments: &[Segment], seed: u64) {
    let mut run = 0.0;
    let mut time = 0.0;
    for s in segments {
        let allowed = s.turn_rate == 0.0 && s.speed <= drawn.speed * (1.0 + 1e-9);
        assert!(allowed, "{seed}: {s:?}");
        assert!((s.start_time - time).abs() < 1e-9, "{seed}");
        let begins = (s.start.position - drawn.path.at(run).1).norm();
        run += s.length();
        time = s.end_time();
        let ends = (s.end().position - drawn.path.at(run).1).norm();
        assert!(begins < 1e-6 && ends < 1e-6, "{seed}: {run} {s:?}");
        for o in &drawn.obstacles {
            let meets = o.first_contact(s, 1e-6).is_some();
            assert!(!meets, "{seed}: {} {s:?}", o.name());
        }
    }
    let whole = (run - drawn.path.length()).abs() < 1e-6;
    assert!(whole && time <= drawn.horizon + 1e-9, "{seed}");
}

/// Lists every route through a network that uses no leg twice, as waypoints.
fn ways(network: &PathNetwork) -> Vec<Vec<Vector>> {
    let mut ways = Vec::new();
    let begun = (network.start(), Vec::new(), vec![network.legs()[0].start]);
    let mut open: Vec<(usize, Vec<usize>, Vec<Vector>)> = vec![begun];
    while let Some((at, used, way)) = open.pop() {
        if !used.is_empty() && network.is_end(at) {
            ways.push(way);
            continue;
        }
        for leg in network.onward(at).iter().filter(|leg| !used.contains(leg)) {
            let l = &network.legs()[*leg];
            let place = l.start + l.direction * l.length;
            open.push((
                l.ends[1],
                [&used[..], &[*leg]].concat(),
                [&way[..], &[place]].concat(),
            ));
        }
    }
    ways
}

/// Grid steps by which the best motion on the grid may be later on the mean. Measured: 0.23.
const STEPS_LATER: f64 = 0.35;

/// Nodes that the search of a plan expanded.
fn searched(planned: &Planned) -> usize {
    planned.stats.map_or(0, |stats| stats.expanded)
}

/// The least time is that of a fine grid, and Dijkstra finds it too.
fn least_time(seeds: Seeds, report: &mut Report) {
    let (mut solved, mut waited, mut on_grid, mut gap) = (0, 0, 0_u32, 0.0);
    let count = seeds.clone().count();
    for seed in seeds {
        let drawn = draw(seed, Kinds::Exact);
        let planned = plan(&drawn, SearchKind::AStar, Objective::Time);
        let cells = if seed % 10 == 0 { 600 } else { 150 };
        let grid = |shrunk| drawn.earliest_on_grid(cells, shrunk);
        let step = drawn.path.length() / drawn.speed / cells as f64;
        let Some(found) = planned.outcome.plan() else {
            assert!(matches!(planned.outcome, Outcome::Infeasible(_)));
            assert_eq!(grid(false), None, "{seed}: {:?}", planned.outcome);
            continue;
        };
        solved += 1;
        let arrival = found.trajectory.end_time();
        assert!((found.cost - arrival).abs() < 1e-9);
        assert_sound(&drawn, found.trajectory.segments(), seed);
        let free = drawn.path.length() / drawn.speed;
        assert!(arrival >= free - 1e-9);
        waited += usize::from(arrival > free + 1e-6);
        if let Some(upper) = grid(false) {
            assert!(arrival <= upper + 1e-6, "{seed}: {arrival}, grid {upper}");
            gap += (upper - arrival) / step;
            on_grid += 1;
        }
        let lower = grid(true);
        let above = lower.is_some_and(|l| l <= arrival + step + 1e-6);
        assert!(above, "{seed}: {arrival} {lower:?}");
        let dijkstra = plan(&drawn, SearchKind::Dijkstra, Objective::Time);
        let other = dijkstra.outcome.plan().expect("a plan too");
        let off = (other.trajectory.end_time() - arrival).abs();
        assert!(off < 1e-9, "{seed}: {arrival}, by Dijkstra {off} off");
        assert!(searched(&dijkstra) >= searched(&planned), "{seed}");
    }
    let gap = gap / f64::from(on_grid);
    println!(
        "{count} scenes: {solved} with a plan, {waited} of them late; the grid arrives {gap:.2} of its \
         steps later on the mean"
    );
    report.require(gap <= STEPS_LATER, || {
        format!("the grid arrives {gap:.2} of its steps later")
    });
    let enough = solved * 2 > count && waited * 5 > solved;
    report.require(enough && on_grid as usize * 10 > solved * 9, || {
        format!("{solved} plans, {waited} late, {on_grid} on the grid")
    });
}

/// The least space-time error is about that of a fine grid.
fn space_time_error(seeds: Seeds, report: &mut Report) {
    let count = seeds.clone().count();
    let (mut ratios, mut expanded) = (Vec::new(), [0, 0]);
    for seed in seeds {
        let drawn = draw(seed, Kinds::Exact);
        let planned = plan(&drawn, SearchKind::AStar, Objective::SpaceTimeError);
        let desired = drawn.desired();
        let (path, obstacles) = (&drawn.path, &drawn.obstacles);
        let (speed, horizon) = (drawn.speed, drawn.horizon);
        let grid = least_error(path, obstacles, &desired, 25.0, speed, horizon, 400);
        let Some(found) = planned.outcome.plan() else {
            assert_eq!(grid, None, "{seed}: {:?}", planned.outcome);
            continue;
        };
        assert_sound(&drawn, found.trajectory.segments(), seed);
        let dijkstra = plan(&drawn, SearchKind::Dijkstra, Objective::SpaceTimeError);
        let other = dijkstra.outcome.plan().expect("a plan too").cost;
        let cost = found.cost;
        let same = (other - cost).abs() <= 1e-8 * (1.0 + other);
        assert!(same, "{seed}: {cost}, Dijkstra {other}");
        expanded[0] += searched(&planned);
        expanded[1] += searched(&dijkstra);
        if let Some(grid) = grid {
            // a grid cannot follow the schedule: subtract the cost of the resulting lag
            let piece = path.length() / 400.0;
            ratios.push((found.cost + piece * piece) / (grid + piece * piece));
        }
    }
    let [half, most, worst] = [0.5, 0.95, 1.0].map(|share| quantile(&ratios, share));
    println!(
        "{} scenes: error over that of the grid: median {half:.4}, 95 % {most:.4}, worst {worst:.4}",
        ratios.len(),
    );
    println!(
        "expanded: {} by A*, {} by Dijkstra",
        expanded[0], expanded[1]
    );
    report.require(expanded[0] < expanded[1], || {
        format!("{expanded:?} expanded")
    });
    report.require(ratios.len() * 2 > count, || {
        format!("{} of {count} compared", ratios.len())
    });
    // on one leg the graph contains the best profile; across corners of the path it may not,
    // because the nearest leg changes
    report.require(half < 1.0 && most < 1.001 && worst < 1.1, || {
        format!("error over the grid's: {half} {most} {worst}")
    });
}

/// Positions outside the outer polygons are outside the ellipsoids.
fn ellipsoids(seeds: Seeds, report: &mut Report) {
    let (mut solved, mut compared, mut later) = (0, 0, 0);
    let count = seeds.clone().count();
    for seed in seeds {
        let drawn = draw(seed, Kinds::Ellipsoids);
        let planned = plan(&drawn, SearchKind::AStar, Objective::Time);
        let Some(found) = planned.outcome.plan() else {
            continue;
        };
        solved += 1;
        assert_sound(&drawn, found.trajectory.segments(), seed);
        let grid = |shrunk| drawn.earliest_on_grid(150, shrunk);
        let step = drawn.path.length() / drawn.speed / 150.0;
        let arrival = found.trajectory.end_time();
        let above = grid(true).is_some_and(|l| l <= arrival + step + 1e-6);
        assert!(above, "{seed}");
        if let Some(upper) = grid(false) {
            compared += 1;
            later += usize::from(arrival > upper + 0.1);
        }
    }
    println!(
        "{solved} scenes with a plan: later than the grid among the ellipsoids themselves in \
         {later} of {compared}"
    );
    let few = solved * 3 > count && compared * 10 > solved * 9 && later * 50 <= compared;
    report.require(few, || {
        format!("{solved} solved, {compared} compared, {later} later")
    });
}

/// One search over all paths equals the best result of the single routes.
fn alternatives(seeds: Seeds, report: &mut Report) {
    let (mut switched, mut solved) = (0, 0);
    let count = seeds.clone().count();
    for seed in seeds {
        let mut rng = ChaCha8Rng::seed_from_u64(seed + 9000);
        let mut drawn = draw(seed, Kinds::Exact);
        drawn.path.points = [(0.0, 0.0), (150.0, 0.0), (300.0, 60.0), (450.0, 0.0)]
            .map(|(x, y)| Vector::new(x, y))
            .to_vec();
        // targets also meet alternative paths for which they were not drawn
        let mut aside = |x: f64| Vector::new(x, rng.random_range(-140.0..140.0));
        let main = drawn.path.points.clone();
        let alternatives = vec![
            vec![main[0], aside(70.0), main[1], aside(220.0), main[2]],
            vec![main[1], aside(260.0), aside(340.0), main[3]],
        ];
        drawn.horizon = 500.0 / drawn.speed * rng.random_range(1.1..2.5);
        let network = PathNetwork::new(&main, &alternatives).expect("sound");
        for objective in [Objective::Time, Objective::Length] {
            let measure = |planned: &Planned| {
                let trajectory = &planned.outcome.plan()?.trajectory;
                Some(match objective {
                    Objective::Time => trajectory.end_time(),
                    _ => trajectory.length(),
                })
            };
            let best = ways(&network)
                .into_iter()
                .filter_map(|way| {
                    let alone = Drawn {
                        path: Path { points: way },
                        obstacles: drawn.obstacles.clone(),
                        ..drawn
                    };
                    measure(&plan(&alone, SearchKind::AStar, objective))
                })
                .min_by(f64::total_cmp);
            let own = own(&drawn.path, drawn.speed);
            let desired = DesiredTrajectory::new(&main, &[drawn.speed; 3]).expect("valid");
            let planned = path_time::plan(&Problem {
                alternatives: &alternatives,
                objective,
                ..Problem::new(&own, &desired, &drawn.obstacles, drawn.horizon)
            });
            match (best, measure(&planned)) {
                (Some(best), Some(found)) => {
                    let same = (best - found).abs() < 1e-6;
                    assert!(same, "{seed} {objective:?}: {best} {found}");
                    solved += 1;
                    let legs = &planned.path_time.as_ref().expect("a diagram").legs;
                    switched += usize::from(legs.iter().any(|l| l.path != legs[0].path));
                }
                (best, found) => assert_eq!(best, found, "{seed} {objective:?}"),
            }
        }
    }
    println!("{solved} plans, {switched} of them on several paths");
    report.require(3 * solved > 2 * count && 5 * switched > count, || {
        format!("{solved} plans, {switched} on several paths")
    });
}
