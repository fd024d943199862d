//! Coarse search among several targets: where own ship may be when, over the whole plane.
//!
//! The other initial guesses leave the route once around one conflict or a few. These follow the
//! cost-to-go grid, or a hybrid A* over it. Their paths in space and time are simplified to a few
//! corners and refined like any other manoeuvre.

use crate::frame::Vector;
use crate::planner::clock::Clock;
use crate::planner::space_time::fallback::cost_to_go::CostToGoGrid;
use crate::planner::space_time::fallback::hybrid_a_star;
use crate::planner::space_time::refinement::Refinement;
use crate::planner::space_time::refinement::trial::Context;
use crate::planner::space_time::selection::conflict_search::{Corner, MAX_CORNERS, through};
use crate::planner::space_time::selection::warm_start::initial_guess_from;
use crate::trajectory::Segment;

/// Refinement steps of a guess.
const STEPS: usize = 24;

/// Corners nearer to the simplified path than this are left out: in cells of the grid, for paths of
/// the grid and of the hybrid A*.
const GRID_TOLERANCE: f64 = 1.0;
const HYBRID_TOLERANCE: f64 = 0.6;

/// Factor of the tolerance while too many corners remain.
const COARSER: f64 = 1.3;

/// Cost of a hybrid A* motion of use, over that of the best candidate: refinement gains about a
/// third.
const OF_USE: f64 = 1.5;

/// Cost below which the grid is too coarse to find a cheaper plan, in squared cells.
const TOO_CHEAP: f64 = 0.01;

/// Coarse search for one problem.
#[derive(Debug)]
pub(crate) struct CoarseSearch<'a> {
    context: Context<'a>,
    nominal_motion: &'a [Segment],
    grid: CostToGoGrid,
}

impl<'a> CoarseSearch<'a> {
    /// A search for a plan cheaper than `least`, m². `None` where the grid is too coarse for that,
    /// or the time is up. About two milliseconds.
    pub(crate) fn new(
        context: Context<'a>,
        nominal_motion: &'a [Segment],
        least: f64,
        clock: Clock,
    ) -> Option<Self> {
        let problem = context.problem;
        if least < TOO_CHEAP * CostToGoGrid::cell_size(problem).powi(2) {
            return None;
        }
        Some(Self {
            context,
            nominal_motion,
            grid: CostToGoGrid::of(problem, context.proxies, clock)?,
        })
    }

    /// Refined manoeuvres along the cheapest path of the grid.
    pub(crate) fn along_grid(&self, clock: Clock) -> Vec<Refinement> {
        let path = self.grid.path_from(self.context.problem.own.pose.position);
        self.along(path, GRID_TOLERANCE, clock)
    }

    /// Motion of a hybrid A* that costs not much more than `least`, m², and the refined manoeuvres
    /// along it. Nothing where no plan is known: wide detours are for the relaxation to choose.
    pub(crate) fn along_hybrid(
        &self,
        least: f64,
        clock: Clock,
    ) -> Option<(Vec<Segment>, Vec<Refinement>)> {
        if !least.is_finite() {
            return None;
        }
        let Context {
            problem,
            proxies,
            route,
            ..
        } = self.context;
        let within = (hybrid_a_star::COARSE, OF_USE * least);
        let motion = hybrid_a_star::searched(problem, proxies, &self.grid, within, clock)?;
        let path = motion.iter().map(|s| (s.start_time, s.start.position));
        let end = motion.last().map(|s| (s.end_time(), s.end().position));
        let mut refined = self.along(path.chain(end).collect(), HYBRID_TOLERANCE, clock);
        let guess = initial_guess_from(problem, route, &motion);
        let fitting = guess.and_then(|guess| Refinement::fitting(&self.context, guess));
        refined.extend(fitting.map(|r| r.run(&self.context, STEPS, clock)));
        Some((motion, refined))
    }

    /// Refined manoeuvres along a path, given by times and positions: one to the last waypoint, and
    /// one back onto the route after the last corner that is off it.
    fn along(&self, mut path: Vec<(f64, Vector)>, cells: f64, clock: Clock) -> Vec<Refinement> {
        let desired = self.context.problem.desired;
        let [first, .., last] = &mut path[..] else {
            return Vec::new();
        };
        (first.1, last.1) = (self.context.problem.own.pose.position, desired.end());
        let mut tolerance = cells * self.grid.cell;
        let mut kept = simplified(&path, tolerance);
        while kept.len() > MAX_CORNERS + 1 {
            tolerance *= COARSER;
            kept = simplified(&path, tolerance);
        }
        let end = kept.len() - 1;
        let corners: Vec<Corner> = kept[..end]
            .iter()
            .map(|&(time, position)| Corner { time, position })
            .collect();
        let off_route = |corner: &Corner| {
            let nearest = desired.nearest(corner.position, corner.time, 0.0);
            nearest.error > tolerance * tolerance
        };
        let last_off = corners.iter().rposition(off_route).unwrap_or(0);
        let mut ways = vec![(&corners[..], true)];
        if last_off > 0 {
            ways.push((&corners[..=last_off], false));
        }
        ways.into_iter()
            .take_while(|_| !clock.is_up())
            .filter_map(|(corners, to_goal)| {
                let fitting = through(&self.context, self.nominal_motion, corners, to_goal)?;
                Some(fitting.run(&self.context, STEPS, clock))
            })
            .collect()
    }
}

/// Points of a path, given by times and positions, between which it is straight and steady within a
/// tolerance in metres (Douglas and Peucker, doi:10.3138/FM57-6770-U75U-7727, with the distance at
/// the same time).
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
