//! A certified lower bound of the space-time error of all motions, not only of those that a planner
//! looks at: docs/reference/theory.md section 13.
//!
//! Time has steps and the plane has square cells. Dynamic programming forward in time gives every
//! cell a cost that no motion to it can be below:
//!
//! - a motion reaches only cells that a point at the greatest speed can reach;
//! - a cell that lies inside an obstacle at a step is left out;
//! - around each step the error is at least that of the nearest point of the cell, less what it can
//!   fall by until half a step before or after.
//!
//! Cells from which no motion can cost less than a known one are left out too.

use std::ops::Range;

use crate::document::LowerBoundDocument;
use crate::frame::{Vector, to_port};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::parallel;
use crate::pipeline::Run;
use crate::scenario::Scenario;

/// Cells that a point at the greatest speed crosses in a step. The more, the less is gained by
/// rounding to cells.
const REACH: i64 = 16;

/// Steps of the desired duration on the coarsest grid. Each grid after it halves step and cells.
const COARSEST_STEPS: f64 = 40.0;

/// No finer grid is begun where it is expected to visit more cells than this, which takes about two
/// seconds. A coarse grid that does gives no bound but 0.
const MOST_CELLS: f64 = 8e7;

/// A halved grid has eight times as many cells, less those that its better bound leaves out.
const GROWTH: f64 = 7.0;

/// A lower bound of `J` over all motions of a point that starts where own ship does, is never
/// faster than own ship's greatest speed, keeps out of the sets that the plan of `run` keeps out of,
/// and arrives by the horizon. Turning circle, lower limits of speed, land and rules are not looked
/// at: they could only raise it.
///
/// `None` without a plan, for a plan that enters sets or does not arrive, and under forces, where
/// the greatest speed is not own ship's. Deterministic. Takes some seconds and, in scenes of many
/// kilometres, more than 100 MB.
pub fn lower_bound(run: &Run) -> Option<LowerBoundDocument> {
    let known = run.evaluation.as_ref()?.space_time_error;
    if !run.arrives() || run.enters() || !known.is_finite() {
        return None;
    }
    let problem = Relaxation::new(&run.scenario, run.obstacles().collect(), known);
    let mut steps = COARSEST_STEPS;
    let (mut bound, mut cells) = problem.on_grid(steps);
    while cells * GROWTH <= MOST_CELLS && bound.space_time_error_m2 < known {
        steps *= 2.0;
        let finer;
        (finer, cells) = problem.on_grid(steps);
        // both hold
        bound = LowerBoundDocument {
            space_time_error_m2: finer.space_time_error_m2.max(bound.space_time_error_m2),
            ..finer
        };
    }
    Some(bound)
}

/// The problem for a point, and the cost of a motion that is known.
struct Relaxation<'a> {
    scenario: &'a Scenario,
    obstacles: Vec<&'a Obstacle>,
    known: f64,
    speed: f64,
    /// The grid's first axis: along the way from the start to the end.
    axis: Vector,
}

/// Step, cells and the rate at which the error changes at most.
#[derive(Clone, Copy)]
struct Grid {
    cell: f64,
    step: f64,
    rate: f64,
}

impl Grid {
    /// No point of a cell is farther from its centre, metres.
    fn radius(&self) -> f64 {
        self.cell * std::f64::consts::FRAC_1_SQRT_2
    }

    /// The least integral of the squared error over half a step, from an error `e` on.
    fn half_step(&self, e: f64) -> f64 {
        self.fallen(e, 0.5 * self.step)
    }

    /// The least integral of the squared error over a time, which falls from `e` at the rate.
    fn fallen(&self, e: f64, time: f64) -> f64 {
        let end = (e - self.rate * time).max(0.0);
        (e.powi(3) - end.powi(3)) / (3.0 * self.rate)
    }
}

/// Costs of the cells of a rectangle at one step; infinite where no motion of interest is.
struct Layer {
    /// Columns and rows of the rectangle.
    columns: Range<i64>,
    rows: Range<i64>,
    costs: Vec<f32>,
}

impl Layer {
    fn width(&self) -> usize {
        (self.columns.end - self.columns.start) as usize
    }

    fn row(&self, row: i64) -> &[f32] {
        let at = (row - self.rows.start) as usize * self.width();
        &self.costs[at..at + self.width()]
    }

    /// Without the rows and columns in which nothing is finite; `None` where nothing is.
    fn trimmed(self) -> Option<Self> {
        let finite = |cost: &f32| cost.is_finite();
        let rows: Vec<i64> = self
            .rows
            .clone()
            .filter(|row| self.row(*row).iter().any(finite))
            .collect();
        let rows = *rows.first()?..rows.last()? + 1;
        let first = |row| self.row(row).iter().position(finite);
        let last = |row| self.row(row).iter().rposition(finite);
        let left = rows.clone().filter_map(first).min()?;
        let right = rows.clone().filter_map(last).max()? + 1;
        let costs = rows.clone().flat_map(|row| &self.row(row)[left..right]);
        Some(Self {
            columns: self.columns.start + left as i64..self.columns.start + right as i64,
            costs: costs.copied().collect(),
            rows,
        })
    }

    /// The least cost of the cells from which a motion may come, for every cell that it may reach.
    fn spread(&self) -> Self {
        let columns = self.columns.start - REACH..self.columns.end + REACH;
        let rows = self.rows.start - REACH..self.rows.end + REACH;
        let width = (columns.end - columns.start) as usize;
        // least costs over 2^k cells, of all rows at once
        let padded: Vec<Vec<Vec<f32>>> = {
            let all: Vec<i64> = self.rows.clone().collect();
            parallel::map(&all, |_, row| windows(self.row(*row)))
        };
        let all: Vec<i64> = rows.clone().collect();
        let found = parallel::map(&all, |_, row| {
            let mut least = vec![f32::INFINITY; width];
            for across in -REACH..=REACH {
                let from = row - across;
                if self.rows.contains(&from) {
                    let windows = &padded[(from - self.rows.start) as usize];
                    lower(&mut least, windows, reach(across) as usize);
                }
            }
            least
        });
        Self {
            columns,
            rows,
            costs: found.concat(),
        }
    }
}

/// The most columns that a motion can cross in a step in which it crosses `across` rows.
///
/// From anywhere in a cell to anywhere in a cell `n` away it goes more than `n - 1` cells, but `n`
/// at least where it goes just `n`; in all it goes [`REACH`] cells at most.
fn reach(across: i64) -> i64 {
    let least = |cells: i64| (cells.abs() - 1).max(0);
    let inside = |along: &i64| least(*along).pow(2) + least(across).pow(2) < REACH * REACH;
    (0..=REACH).take_while(inside).last().unwrap_or(0)
}

/// For each power of two the least cost over so many cells from each cell on, in a row that has
/// [`REACH`] empty cells twice at either end.
fn windows(row: &[f32]) -> Vec<Vec<f32>> {
    let pad = 2 * REACH as usize;
    let mut first = vec![f32::INFINITY; row.len() + 2 * pad];
    first[pad..pad + row.len()].copy_from_slice(row);
    let mut all = vec![first];
    let mut size = 1;
    while 2 * size <= 2 * REACH as usize + 1 {
        let last = &all[all.len() - 1];
        let pairs = last.iter().zip(&last[size..]);
        let mut next: Vec<f32> = pairs.map(|(a, b)| a.min(*b)).collect();
        next.resize(last.len(), f32::INFINITY);
        all.push(next);
        size *= 2;
    }
    all
}

/// Lowers each cost to the least one within `reach` cells of a row, whose `windows` are given.
fn lower(least: &mut [f32], windows: &[Vec<f32>], reach: usize) {
    let level = (2 * reach + 1).ilog2() as usize;
    // cell 0 of `least` is REACH before the row: cell REACH of the windows
    let from = REACH as usize - reach;
    let to = REACH as usize + reach + 1 - (1 << level);
    let windows = &windows[level];
    let pairs = windows[from..].iter().zip(&windows[to..]);
    for (least, (a, b)) in least.iter_mut().zip(pairs) {
        *least = least.min(a.min(*b));
    }
}

impl<'a> Relaxation<'a> {
    fn new(scenario: &'a Scenario, obstacles: Vec<&'a Obstacle>, known: f64) -> Self {
        let way = scenario.desired.end() - scenario.own_ship.pose.position;
        let axis = match way.norm() {
            length if length > 0.0 => way / length,
            _ => Vector::x(),
        };
        Self {
            scenario,
            obstacles,
            known,
            // more than rounding of the motions' speeds
            speed: scenario.own_ship.max_speed() * (1.0 + 1e-9),
            axis,
        }
    }

    /// The bound with this many steps of the desired duration, and the number of cells of all steps.
    fn on_grid(&self, steps: f64) -> (LowerBoundDocument, f64) {
        let duration = self.scenario.desired.duration();
        let step = duration / steps;
        let grid = Grid {
            cell: self.speed * step / REACH as f64,
            step,
            // of the distance in space and time from the desired trajectory
            rate: self.speed.hypot(self.scenario.time_weight.sqrt()),
        };
        // start and end lie in the middles of cells
        let end = self.scenario.desired.end() - self.scenario.own_ship.pose.position;
        let end = Vector::new(self.axis.dot(&end), to_port(self.axis).dot(&end));
        let reached = self.speed * step + 2.0 * grid.radius();
        let mut layer = Layer {
            columns: 0..1,
            rows: 0..1,
            costs: vec![0.0],
        };
        // a motion may arrive before the first step
        let mut least = match end.norm() <= reached {
            true => 0.0,
            false => self.known * duration,
        };
        let (mut cells, mut sums) = (0.0, 0.0);
        for k in 1.. {
            let time = k as f64 * step;
            if time > self.scenario.horizon + step {
                break;
            }
            if cells > MOST_CELLS {
                least = 0.0;
                break;
            }
            let mut next = layer.spread();
            cells += next.costs.len() as f64;
            sums += 1.0;
            let arrived = self.cost(&mut next, grid, time, least, (end, reached));
            least = least.min(arrived);
            layer = match next.trimmed() {
                Some(next) => next,
                None => break,
            };
        }
        // each sum is rounded to single precision
        let exact = 1.0 - sums * f64::from(f32::EPSILON);
        let bound = LowerBoundDocument {
            space_time_error_m2: (least * exact / duration).min(self.known),
            cell_m: grid.cell,
            step_s: step,
        };
        (bound, cells)
    }

    /// Adds the cost around a step to a layer and leaves out what is inside an obstacle or too
    /// dear. Returns the least cost with which a motion may arrive before the next step.
    fn cost(
        &self,
        layer: &mut Layer,
        grid: Grid,
        time: f64,
        least: f64,
        (end, reached): (Vector, f64),
    ) -> f64 {
        let desired = &self.scenario.desired;
        let q = self.scenario.time_weight;
        let columns = layer.columns.clone();
        let width = layer.width();
        let mut rows: Vec<(i64, &mut [f32], f64)> = layer
            .rows
            .clone()
            .zip(layer.costs.chunks_mut(width))
            .map(|(row, costs)| (row, costs, f64::INFINITY))
            .collect();
        parallel::each(&mut rows, |(row, costs, arrived)| {
            // no obstacle covers a cell before this column
            let mut free_until = vec![columns.start; self.obstacles.len()];
            for (column, cost) in columns.clone().zip(costs.iter_mut()) {
                if !cost.is_finite() {
                    continue;
                }
                let local = Vector::new(column as f64, *row as f64) * grid.cell;
                let position = self.scenario.own_ship.pose.position
                    + self.axis * local.x
                    + to_port(self.axis) * local.y;
                let error = desired.nearest(position, time, q).error.sqrt();
                let error = (error - grid.radius()).max(0.0);
                let half = grid.half_step(error);
                let before = f64::from(*cost) + half;
                let away = (local - end).norm();
                // the motion lasts at least as long as the way to the end takes
                let left = ((away - grid.radius()) / self.speed).max(0.0);
                let to_go = grid.fallen(error, left);
                if before + to_go >= least
                    || self.covered(position, time, grid, column, &mut free_until)
                {
                    *cost = f32::INFINITY;
                    continue;
                }
                if away <= reached {
                    *arrived = arrived.min(before);
                }
                *cost = (before + half) as f32;
            }
        });
        let arrived = rows.iter().map(|(_, _, arrived)| *arrived);
        arrived.fold(f64::INFINITY, f64::min)
    }

    /// True where a cell lies inside an obstacle.
    fn covered(
        &self,
        position: Vector,
        time: f64,
        grid: Grid,
        column: i64,
        free_until: &mut [i64],
    ) -> bool {
        let mut all = self.obstacles.iter().zip(free_until);
        all.any(|(obstacle, free_until)| {
            if column < *free_until {
                return false;
            }
            let depth = -obstacle.signed_distance(position, time).distance;
            let covered = depth >= grid.radius();
            if !covered {
                // cells nearer than this are not covered either
                let clear = (grid.radius() - depth) / grid.cell;
                *free_until = column + (clear.ceil() as i64).max(1);
            }
            covered
        })
    }
}

#[cfg(test)]
mod tests {
    use rand::{Rng, SeedableRng};

    use super::*;
    use crate::geometry::ConvexPolygon;
    use crate::obstacle::PolytopeObstacle;
    use crate::pipeline;
    use crate::scenario::Compliance;
    use crate::simulation::{EncounterKind, Placement, random_encounter};

    const ALL: [Compliance; 3] = [Compliance::None, Compliance::Shape, Compliance::Rules];

    fn run_of(kind: EncounterKind, seed: u64, compliance: Compliance) -> Run {
        let drawn = random_encounter(kind, seed, Placement::Random).expect("drawn");
        let mut scenario = drawn.scenario;
        scenario.compliance = compliance;
        pipeline::run(scenario)
    }

    /// Half as much again as the cost of the plan counts as known: too high a bound would show.
    #[test]
    fn no_plan_costs_less_than_the_bound() {
        let mut close = 0;
        for (kind, seed) in EncounterKind::with_seeds(0..2) {
            for compliance in ALL {
                let run = run_of(kind, seed, compliance);
                let Some(evaluation) = &run.evaluation else {
                    continue;
                };
                let known = evaluation.space_time_error;
                let obstacles = run.obstacles().collect();
                let problem = Relaxation::new(&run.scenario, obstacles, 1.5 * known);
                let bound = problem.on_grid(COARSEST_STEPS).0.space_time_error_m2;
                let what = format!("{kind:?} {seed} {compliance:?}: {bound} {known}");
                assert!(bound <= known, "{what}");
                close += usize::from(bound > 0.3 * known);
            }
        }
        assert!(close >= 15, "the bound is idle: {close} of 30");
    }

    /// Random motions of a point that meet no obstacle and end at the last waypoint.
    #[test]
    fn no_random_motion_costs_less_than_the_bound() {
        use crate::planner::cost::space_time_error;
        use crate::trajectory::Segment;
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(5);
        let mut tried = 0;
        let run = run_of(EncounterKind::GiveWay, 1, Compliance::None);
        let scenario = &run.scenario;
        let obstacles: Vec<&Obstacle> = run.obstacles().collect();
        let problem = Relaxation::new(scenario, obstacles.clone(), 3e4);
        let bound = problem.on_grid(COARSEST_STEPS).0.space_time_error_m2;
        let (start, end) = (scenario.own_ship.pose.position, scenario.desired.end());
        let speed = scenario.own_ship.max_speed();
        for _ in 0..200_000 {
            // to a place somewhere beside the way, there at some time, and from there to the end
            let way = end - start;
            let place = start
                + way * rng.random_range(0.2..0.8)
                + to_port(way) * rng.random_range(-0.4..0.4);
            let mut motion = Vec::new();
            let (mut at, mut time) = (start, 0.0);
            for next in [place, end] {
                let pace = speed * rng.random_range(0.6..1.0);
                let heading = crate::frame::heading_of(next - at);
                let pose = crate::frame::Pose::new(at, heading);
                let duration = (next - at).norm() / pace;
                motion.push(Segment::straight(pose, time, duration, pace));
                (at, time) = (next, time + duration);
            }
            let meets = |segment| {
                obstacles
                    .iter()
                    .any(|o| o.first_contact(segment, 0.0).is_some())
            };
            if time <= scenario.horizon && !motion.iter().any(meets) {
                let q = scenario.time_weight;
                let parts = motion
                    .iter()
                    .map(|s| space_time_error(&scenario.desired, s, q));
                let cost: f64 = parts.sum();
                assert!(bound <= cost, "{bound} {cost} {motion:?}");
                tried += 1;
            }
        }
        assert!(tried > 10_000, "{tried}");
        assert!(bound > 1000.0, "{bound}");
    }

    /// Own ship is at the end after 3 s, before a set covers everything for kilometres.
    #[test]
    fn a_motion_may_arrive_before_the_first_step() {
        let mut run = run_of(EncounterKind::GiveWay, 1, Compliance::None);
        run.scenario.own_ship.speeds = vec![500.0];
        let square = |middle: Vector, reach: f64| {
            let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)];
            let corners = corners.map(|(x, y)| middle + Vector::new(x, y) * reach);
            ConvexPolygon::hull(&corners).expect("corners")
        };
        let start = run.scenario.own_ship.pose.position;
        let initial = square(start + Vector::new(1000.0, 1000.0), 100.0);
        let set = PolytopeObstacle::new("grows", initial, square(Vector::zeros(), 450.0));
        let set = Obstacle::from(set);
        let problem = Relaxation::new(&run.scenario, vec![&set], 1e4);
        let bound = problem.on_grid(COARSEST_STEPS).0;
        assert_eq!(bound.space_time_error_m2, 0.0);
    }

    /// The least cost of the cells, by the definition.
    #[test]
    fn spreading_takes_the_least_cost_of_the_cells_from_which_a_motion_may_come() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(3);
        let (columns, rows) = (-7..21, 3..14);
        let cost = |_| match rng.random_bool(0.2) {
            true => rng.random_range(0.0..9.0_f32),
            false => f32::INFINITY,
        };
        let layer = Layer {
            costs: (0..28 * 11).map(cost).collect(),
            columns: columns.clone(),
            rows: rows.clone(),
        };
        let at = |column: i64, row: i64| layer.row(row)[(column + 7) as usize];
        // sampled ends in the two cells
        let reaches = |across: i64, along: i64| {
            let apart = |n: i64| (n as f64 - 0.999_999).max(0.0).min(n as f64);
            let (x, y) = (apart(along.abs()), apart(across.abs()));
            let whole = |n: i64, other: i64| n.abs() == REACH && other == 0;
            x.hypot(y) < REACH as f64 && along.abs().max(across.abs()) <= REACH
                || whole(along, across)
                || whole(across, along)
        };
        let spread = layer.spread();
        for row in spread.rows.clone() {
            for (column, found) in spread.columns.clone().zip(spread.row(row)) {
                let mut least = f32::INFINITY;
                for from in rows.clone() {
                    for before in columns.clone() {
                        if reaches(row - from, column - before) {
                            least = least.min(at(before, from));
                        }
                    }
                }
                assert_eq!(*found, least, "{column} {row}");
            }
        }
    }

    /// Displacements of a random place within [`REACH`] cells cross no more cells than told.
    #[test]
    fn no_motion_crosses_more_cells_than_it_can() {
        let mut rng = rand_chacha::ChaCha8Rng::seed_from_u64(4);
        let mut farthest = 0;
        for _ in 0..1_000_000 {
            let angle = rng.random_range(0.0..std::f64::consts::TAU);
            let length = REACH as f64 * (1.0 - rng.random_range(0.0_f64..0.2).powi(3));
            let start: [f64; 2] = [rng.random_range(0.0..1.0), rng.random_range(0.0..1.0)];
            let x = (start[0] + length * angle.cos()).floor() as i64;
            let y = (start[1] + length * angle.sin()).floor() as i64;
            assert!(y.abs() <= REACH && x.abs() <= reach(y), "{x} {y}");
            farthest = farthest.max(x * x + y * y);
        }
        // some cross more than a point between centres could
        assert!(farthest > REACH * REACH);
    }
}
