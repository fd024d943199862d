//! Coarse search among several targets: where own ship may be when, over the whole plane.
//!
//! The other initial guesses leave the route once around one conflict or a few. These follow the
//! cost-to-go grid, or a hybrid A* over it. Their paths in space and time are simplified to a few
//! corners and refined like any other manoeuvre.

use crate::clock::Clock;
use crate::space_time::context::Context;
use crate::space_time::grid::cost_to_go::CostToGoGrid;
use crate::space_time::grid::hybrid_a_star;
use crate::space_time::refinement::Refinement;
use crate::space_time::selection::corners::{Corner, Corners, MAX_CORNERS, SHORTEST_M};
use crate::space_time::selection::warm_start::initial_guess_from;
use crate::{Problem, SearchKind};
use searoom_geometry::frame::Vector;
use searoom_model::trajectory::Segment;
use searoom_parallel as parallel;

/// Coarse search for one problem.
#[derive(Debug)]
pub(crate) struct CoarseSearch<'a> {
    context: Context<'a>,
    nominal_motion: &'a [Segment],
    grid: CostToGoGrid,
}

impl<'a> CoarseSearch<'a> {
    /// Makes the grid, in about two milliseconds. `None` where the time is up.
    pub(crate) fn new(
        context: Context<'a>,
        nominal_motion: &'a [Segment],
        clock: Clock,
    ) -> Option<Self> {
        Some(Self {
            context,
            nominal_motion,
            grid: CostToGoGrid::of(context.problem, context.proxies, 0.0, clock)?,
        })
    }

    /// Refined manoeuvres along the cheapest path of the grid.
    pub(crate) fn along_grid(&self, clock: Clock) -> Vec<Refinement> {
        let problem = self.context.problem;
        let start = problem.own.pose.position;
        let path = self.grid.path_from(start, problem.desired.end());
        self.refined(
            self.along(path, problem.settings.grid.grid_tolerance),
            clock,
        )
    }

    /// Motions of a hybrid A* that cost not much more than `least`, m², and the refined manoeuvres
    /// along them. Nothing where no plan is known: wide detours are for the relaxation to choose.
    ///
    /// A thorough search has another grid, with smaller sets: the cells of the first one are too
    /// large for narrow gaps between the sets.
    pub(crate) fn along_hybrid(
        self,
        least: f64,
        clock: Clock,
    ) -> (Vec<Vec<Segment>>, Vec<Refinement>) {
        let mut found = (Vec::new(), Vec::new());
        let settings = &self.context.problem.settings.grid;
        if !least.is_finite() || least < settings.too_cheap * self.grid.cell.powi(2) {
            return found;
        }
        let limit = settings.of_use * least;
        let Context {
            problem, proxies, ..
        } = self.context;
        self.add_along_hybrid(limit, clock, &mut found);
        if problem.search == SearchKind::Thorough
            && let Some(grid) = CostToGoGrid::of(problem, proxies, settings.smaller, clock)
        {
            let smaller = Self { grid, ..self };
            found.1.extend(smaller.along_grid(clock));
            smaller.add_along_hybrid(limit, clock, &mut found);
        }
        found
    }

    fn add_along_hybrid(
        &self,
        limit: f64,
        clock: Clock,
        (motions, refined): &mut (Vec<Vec<Segment>>, Vec<Refinement>),
    ) {
        let Context {
            problem,
            proxies,
            route,
            ..
        } = self.context;
        let within = (hybrid_a_star::COARSE, limit);
        let Some((motion, _)) =
            hybrid_a_star::searched(problem, proxies, &self.grid, within, clock)
        else {
            return;
        };
        let path = motion.iter().map(|s| (s.start_time, s.start.position));
        let end = motion.last().map(|s| (s.end_time(), s.end().position));
        let mut along = self.along(
            path.chain(end).collect(),
            problem.settings.grid.hybrid_tolerance,
        );
        let guess = initial_guess_from(problem, route, &motion);
        along.extend(guess.and_then(|guess| Refinement::fitting(&self.context, guess)));
        motions.push(motion);
        refined.extend(self.refined(along, clock));
    }

    fn refined(&self, mut fitting: Vec<Refinement>, clock: Clock) -> Vec<Refinement> {
        let most = self.context.problem.settings.grid.iterations;
        parallel::each(&mut fitting, |r| r.go_on(&self.context, most, clock));
        fitting
    }

    /// Refinements along a path, given by times and positions. One goes to the last waypoint, one
    /// back onto the route after the last corner that is off it.
    fn along(&self, path: Vec<(f64, Vector)>, cells: f64) -> Vec<Refinement> {
        let tolerance = cells * self.grid.cell;
        let problem = self.context.problem;
        let off = |corner: &Corner, time_weight: f64| {
            let desired = problem.desired;
            let nearest = desired.nearest(corner.position, corner.time, time_weight);
            nearest.error > tolerance * tolerance
        };
        let corners = corners_of(path, problem, tolerance, |c| off(c, problem.time_weight));
        let last_off = corners.iter().rposition(|c| off(c, 0.0)).unwrap_or(0);
        let mut ways = Vec::new();
        // one corner alone is where the path begins
        if corners.len() > 1 {
            ways.push((&corners[..], true));
        }
        if last_off > 0 {
            ways.push((&corners[..=last_off], false));
        }
        ways.into_iter()
            .filter_map(|(corners, to_goal)| {
                let nominal_motion = self.nominal_motion;
                let through = Corners {
                    nominal_motion,
                    corners,
                    to_goal,
                };
                through.refinement(&self.context)
            })
            .collect()
    }
}

/// At most [`MAX_CORNERS`] corners of a path to the last waypoint, without the end. The first is
/// where the path leaves the desired trajectory; a wait ends in one corner.
fn corners_of(
    mut path: Vec<(f64, Vector)>,
    problem: &Problem,
    mut tolerance: f64,
    is_off: impl Fn(&Corner) -> bool,
) -> Vec<Corner> {
    let [first, .., last] = &mut path[..] else {
        return Vec::new();
    };
    (first.1, last.1) = (problem.own.pose.position, problem.desired.end());
    let corner = |&(time, position): &(f64, Vector)| Corner { time, position };
    let Some(leaves) = path.iter().position(|point| is_off(&corner(point))) else {
        return Vec::new();
    };
    let path = &path[leaves.saturating_sub(1)..];
    let mut kept = simplified(path, tolerance);
    while kept.len() > MAX_CORNERS + 1 {
        tolerance *= problem.settings.grid.coarser;
        kept = simplified(path, tolerance);
    }
    kept.pop();
    let mut corners: Vec<Corner> = kept.iter().map(corner).collect();
    corners.dedup_by(|later, earlier| {
        let waits = (later.position - earlier.position).norm() < SHORTEST_M;
        if waits {
            earlier.time = later.time;
        }
        waits
    });
    corners
}

/// Points of a path, given by times and positions, between which it is straight and steady within a
/// tolerance in metres. By Douglas and Peucker, doi:10.3138/FM57-6770-U75U-7727, with the distance
/// at the same time.
fn simplified(path: &[(f64, Vector)], tolerance: f64) -> Vec<(f64, Vector)> {
    let [first, between @ .., last] = path else {
        return path.to_vec();
    };
    let off = |(time, position): &(f64, Vector)| {
        let share = (time - first.0) / (last.0 - first.0);
        (position - (first.1 + (last.1 - first.1) * share)).norm()
    };
    let farthest = between
        .iter()
        .map(off)
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(&b.1));
    match farthest {
        Some((k, off)) if off > tolerance => {
            let mut kept = simplified(&path[..=k + 1], tolerance);
            kept.pop();
            kept.extend(simplified(&path[k + 1..], tolerance));
            kept
        }
        _ => vec![*first, *last],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_fixtures::own_ship;
    use searoom_model::trajectory::DesiredTrajectory;

    #[test]
    fn a_path_has_few_corners_from_where_it_leaves_the_route() {
        let points = [Vector::zeros(), Vector::new(3000.0, 0.0)];
        let desired = DesiredTrajectory::new(&points, &[5.0]).expect("valid");
        let own = own_ship(&[5.0]);
        let problem = Problem::new(&own, &desired, &[], 900.0);
        let corners = |path: Vec<(f64, Vector)>| {
            corners_of(path, &problem, 10.0, |c| c.position.y.abs() > 10.0)
        };
        let at = |time: f64, east: f64, north: f64| (time, Vector::new(east, north));
        let on_route = (0..10).map(|k| at(20.0 * f64::from(k), 100.0 * f64::from(k), 0.0));
        assert!(corners(on_route.clone().collect()).is_empty());
        assert!(corners(vec![at(0.0, 0.0, 0.0)]).is_empty());
        // leaves at 180 s, waits from 220 s to 300 s, and goes to the end
        let detour = [
            at(220.0, 1100.0, 200.0),
            at(300.0, 1100.0, 200.0),
            at(700.0, 2990.0, 0.0),
        ];
        let found = corners(on_route.clone().chain(detour).collect());
        let expected = [at(180.0, 900.0, 0.0), at(300.0, 1100.0, 200.0)];
        assert_eq!(
            found
                .iter()
                .map(|c| (c.time, c.position))
                .collect::<Vec<_>>(),
            expected
        );
        let zigzag = (10..40).map(|k| {
            let side = if k % 2 == 0 { 150.0 } else { -150.0 };
            at(20.0 * f64::from(k), 70.0 * f64::from(k), side)
        });
        assert!(corners(on_route.chain(zigzag).collect()).len() <= MAX_CORNERS);
    }

    #[test]
    fn a_path_keeps_its_corners_and_its_changes_of_speed() {
        let at = |time: f64, east: f64, north: f64| (time, Vector::new(east, north));
        let mut path: Vec<_> = (0..=10)
            .map(|k| at(10.0 * f64::from(k), 0.0, 50.0 * f64::from(k)))
            .collect();
        // slower from 100 s on, then to the east
        path.extend((1..=10).map(|k| {
            at(
                100.0 + 10.0 * f64::from(k),
                0.0,
                500.0 + 20.0 * f64::from(k),
            )
        }));
        path.extend((1..=10).map(|k| at(200.0 + 10.0 * f64::from(k), 50.0 * f64::from(k), 700.0)));
        path[5].1.x = 3.0;
        let corners = [
            at(0.0, 0.0, 0.0),
            at(100.0, 0.0, 500.0),
            at(200.0, 0.0, 700.0),
            at(300.0, 500.0, 700.0),
        ];
        assert_eq!(simplified(&path, 5.0), corners);
        assert_eq!(simplified(&path, 2.0).len(), 7);
        assert_eq!(simplified(&path, 1e3), [corners[0], corners[3]]);
    }
}
