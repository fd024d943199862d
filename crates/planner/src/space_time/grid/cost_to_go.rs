//! Cost-to-go grid over east, north and time: where the end can still be reached, and at what cost.
//!
//! The grid guides a search and proves nothing. In it own ship is a point that turns instantly, and
//! sets are sampled at cell centres and discrete instants. Own ship is at its greatest speed along
//! the axes only; between them the grid is slower, by 29 % at worst.

use std::ops::Range;

use crate::Problem;
use crate::clock::Clock;
use crate::space_time::proxy::Proxy;
use searoom_geometry::ConvexPolygon;
use searoom_geometry::frame::Vector;

/// Cells along either axis.
const CELLS: usize = 80;

/// Cells that own ship travels per time step at its greatest speed.
const REACH: i32 = 2;

/// Cells beside those that own ship can have reached which a search may ask for.
const BESIDE: f64 = 4.0;

/// Cells of a padded row. Nothing can be reached from the padding beyond the edges.
const WIDE: usize = CELLS + 2 * REACH as usize;

/// Cost to go, m², from cell centres at evenly spaced instants.
#[derive(Debug)]
pub(crate) struct CostToGoGrid {
    corner: Vector,
    /// Cell size, metres.
    pub cell: f64,
    /// Time step, seconds.
    pub step: f64,
    layers: usize,
    to_go: Vec<f32>,
}

impl CostToGoGrid {
    /// Backward recursion from the horizon over all positions that lie on some path within the
    /// horizon. O(cells x instants x (moves + legs)); some milliseconds. `None` where the time is up
    /// before. `smaller` is by how many cells the sets are smaller.
    pub(crate) fn of(
        problem: &Problem,
        proxies: &[Proxy],
        smaller: f64,
        clock: Clock,
    ) -> Option<Self> {
        let (start, end) = (problem.own.pose.position, problem.desired.end());
        let top = problem.own.max_speed();
        let half = 0.5 * top * problem.horizon;
        let cell = Self::cell_size(problem);
        let step = f64::from(REACH) * cell / top;
        let layers = (problem.horizon / step).floor() as usize + 1;
        // negated on purpose: a NaN has no grid
        if !(cell > 0.0 && step > 0.0 && cell.is_finite()) {
            return None;
        }
        let middle = (start + end) * 0.5;
        let mut grid = Self {
            corner: middle - Vector::new(half, half),
            cell,
            step,
            layers,
            to_go: vec![f32::INFINITY; WIDE * WIDE * layers],
        };
        let on_land: Vec<bool> = (0..CELLS * CELLS)
            .map(|k| {
                let depth = problem.land_obstacle.depth(grid.middle(k));
                depth.is_some_and(|depth| depth > 0.0)
            })
            .collect();
        let moves: Vec<isize> = disc(REACH)
            .map(|(dx, dy)| (dy * WIDE as i32 + dx) as isize)
            .collect();
        let per_second = 1.0 / problem.desired.duration();
        let mut later = [f32::INFINITY; CELLS];
        for layer in (0..layers).rev() {
            if clock.is_up() {
                return None;
            }
            let time = step * layer as f64;
            let mut blocked = on_land.clone();
            for proxy in proxies {
                grid.block(&mut blocked, proxy, time, smaller * cell);
            }
            for row in 0..CELLS {
                let within = grid.reached(start, layer, row);
                if within.is_empty() {
                    continue;
                }
                if layer + 1 < layers {
                    grid.best_after(layer, row, &moves, &mut later);
                }
                let first = row * CELLS;
                // most cells lead nowhere and are far from the end
                let is_beside = (grid.middle(first).y - end.y).abs() <= cell;
                for column in within {
                    let later = later[column];
                    if !(later.is_finite() || is_beside) || blocked[first + column] {
                        continue;
                    }
                    let at = grid.index(layer, column, row);
                    let here = grid.middle(first + column);
                    if is_beside && (here - end).norm() <= cell {
                        grid.to_go[at] = 0.0;
                    } else if later.is_finite() {
                        let nearest = problem.desired.nearest(here, time, problem.time_weight);
                        let error = nearest.error * step * per_second;
                        grid.to_go[at] = later + error as f32;
                    }
                }
            }
        }
        Some(grid)
    }

    /// Cell size of the grid for a problem, metres.
    fn cell_size(problem: &Problem) -> f64 {
        problem.own.max_speed() * problem.horizon / (CELLS as f64 - 1.0)
    }

    /// Columns of a row that own ship can have reached from its start.
    fn reached(&self, start: Vector, layer: usize, row: usize) -> Range<usize> {
        let place = (start - self.corner) / self.cell;
        let reach = f64::from(REACH) * layer as f64 + BESIDE;
        let aside = place.y - row as f64;
        let half = (reach * reach - aside * aside).sqrt();
        // a NaN is no column
        let column = |at: f64| at.clamp(0.0, CELLS as f64) as usize;
        column((place.x - half).ceil())..column((place.x + half).floor() + 1.0)
    }

    fn middle(&self, k: usize) -> Vector {
        let (column, row) = ((k % CELLS) as f64, (k / CELLS) as f64);
        self.corner + Vector::new(column, row) * self.cell
    }

    fn index(&self, layer: usize, column: usize, row: usize) -> usize {
        let edge = REACH as usize;
        (layer * WIDE + row + edge) * WIDE + column + edge
    }

    /// Least cost to go one time step later over the moves from each cell of a row.
    fn best_after(&self, layer: usize, row: usize, moves: &[isize], least: &mut [f32; CELLS]) {
        least.fill(f32::INFINITY);
        for by in moves {
            let first = self.index(layer + 1, 0, row).saturating_add_signed(*by);
            for (least, there) in least.iter_mut().zip(&self.to_go[first..first + CELLS]) {
                // one instruction, unlike `f32::min`; a NaN is unreachable
                *least = if *there < *least { *there } else { *least };
            }
        }
    }

    /// Marks the cells whose centres are in a set, deeper than `depth` metres.
    fn block(&self, blocked: &mut [bool], proxy: &Proxy, time: f64, depth: f64) {
        if let Some(window) = &proxy.window
            && !(time >= window.start && time <= window.end)
        {
            return;
        }
        let section: ConvexPolygon = proxy.body.section(time - proxy.start());
        let range = |along: Vector, corner: f64| {
            let (low, high) = (-section.support(-along), section.support(along));
            let low = ((low - corner) / self.cell).ceil().max(0.0) as usize;
            let high = ((high - corner) / self.cell).floor();
            low..(high + 1.0).clamp(0.0, CELLS as f64) as usize
        };
        for row in range(Vector::new(0.0, 1.0), self.corner.y) {
            let mut within = range(Vector::new(1.0, 0.0), self.corner.x);
            let inside = |column: &usize| {
                let distance = section.signed_distance(self.middle(row * CELLS + column));
                // negated on purpose: a NaN is inside
                !(distance > -depth)
            };
            // a convex set is one run of cells in a row
            if let Some(first) = within.find(inside) {
                let last = within.rfind(inside).unwrap_or(first);
                blocked[row * CELLS + first..=row * CELLS + last].fill(true);
            }
        }
    }

    /// Cheapest path over the grid from a position at time 0 to the end: times and cell centres,
    /// seconds and metres. Empty where the end is out of reach.
    pub(crate) fn path_from(&self, place: Vector, end: Vector) -> Vec<(f64, Vector)> {
        let cell = (place - self.corner) / self.cell;
        let (mut column, mut row) = (cell.x.round(), cell.y.round());
        let mut path = Vec::new();
        for layer in 0..self.layers {
            // the nearest cell may be blocked, a neighbour free
            let reach = if layer == 0 { 1 } else { REACH };
            let mut least = f32::INFINITY;
            let mut to = (column, row);
            for (dx, dy) in disc(reach) {
                let (x, y) = (column + f64::from(dx), row + f64::from(dy));
                let within = |v: f64| v >= 0.0 && v < CELLS as f64;
                if within(x) && within(y) {
                    let there = self.to_go[self.index(layer, x as usize, y as usize)];
                    if there < least {
                        (least, to) = (there, (x, y));
                    }
                }
            }
            if least == f32::INFINITY {
                return Vec::new();
            }
            (column, row) = to;
            let position = self.corner + Vector::new(column, row) * self.cell;
            path.push((self.step * layer as f64, position));
            if (position - end).norm() <= self.cell {
                return path;
            }
        }
        Vec::new()
    }

    /// Cost to go from a position and time, m²; infinite where the end is out of reach.
    pub(crate) fn from(&self, place: Vector, time: f64) -> f64 {
        let at = (place - self.corner) / self.cell;
        let layer = (time / self.step).floor();
        let mut least = f32::INFINITY;
        for dx in [0.0, 1.0] {
            for dy in [0.0, 1.0] {
                for dt in [0.0, 1.0] {
                    let (x, y, t) = (at.x.floor() + dx, at.y.floor() + dy, layer + dt);
                    let within = |v: f64, most: usize| v >= 0.0 && v < most as f64;
                    if within(x, CELLS) && within(y, CELLS) && within(t, self.layers) {
                        let at = self.index(t as usize, x as usize, y as usize);
                        least = least.min(self.to_go[at]);
                    }
                }
            }
        }
        f64::from(least)
    }
}

/// Offsets in cells within a radius.
fn disc(radius: i32) -> impl Iterator<Item = (i32, i32)> {
    (-radius..=radius)
        .flat_map(move |dx| (-radius..=radius).map(move |dy| (dx, dy)))
        .filter(move |(dx, dy)| dx * dx + dy * dy <= radius * radius)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ship_fixtures::own_ship;
    use crate::space_time::piece::pieces;
    use crate::space_time::proxy::within_reach;
    use searoom_model::trajectory::DesiredTrajectory;
    use searoom_sets::PolytopeObstacle;
    use std::time::Duration;

    #[test]
    fn the_grid_is_made_while_there_is_time() {
        let points = [Vector::zeros(), Vector::new(1000.0, 0.0)];
        let desired = DesiredTrajectory::new(&points, &[5.0]).expect("valid");
        let own = own_ship(&[5.0]);
        let problem = Problem::new(&own, &desired, &[], 400.0);
        let within = |time| CostToGoGrid::of(&problem, &[], 0.0, Clock::new(time));
        assert!(within(Duration::ZERO).is_none());
        let grid = within(Duration::from_secs(60)).expect("a grid");
        assert!(grid.from(Vector::zeros(), 0.0).is_finite());
    }

    #[test]
    fn a_path_of_the_grid_goes_round_a_set_and_nowhere_out_of_reach() {
        let end = Vector::new(1000.0, 0.0);
        let desired = DesiredTrajectory::new(&[Vector::zeros(), end], &[5.0]).expect("valid");
        let own = own_ship(&[5.0]);
        // a square of 200 m at rest on the route
        let square = [
            (400.0, -100.0),
            (600.0, -100.0),
            (600.0, 100.0),
            (400.0, 100.0),
        ];
        let square = square.map(|(east, north)| Vector::new(east, north));
        let still = ConvexPolygon::from_vertices(&[Vector::zeros()]).expect("a point");
        let body = PolytopeObstacle::new(
            "square",
            ConvexPolygon::from_vertices(&square).expect("convex"),
            still,
        );
        let obstacles = [body.into()];
        let problem = Problem::new(&own, &desired, &obstacles, 400.0);
        let pieces = pieces(&obstacles, 400.0);
        let proxies = within_reach(&problem, &pieces);
        let clock = Clock::new(Duration::from_secs(60));
        let grid = CostToGoGrid::of(&problem, &proxies, 0.0, clock).expect("a grid");
        let path = grid.path_from(Vector::zeros(), end);
        let (time, last) = path[path.len() - 1];
        assert!((last - end).norm() <= grid.cell && time < 300.0, "{time} s");
        let inside = |p: &Vector| (p.x - 500.0).abs() < 99.0 && p.y.abs() < 99.0;
        assert!(path.iter().all(|(_, p)| !inside(p)), "{path:?}");
        let aside = path.iter().map(|(_, p)| p.y.abs()).fold(0.0, f64::max);
        assert!((100.0..150.0).contains(&aside), "{aside} m");
        // around a smaller square the way is cheaper, but none leads through it
        let around = CostToGoGrid::of(&problem, &proxies, 1.0, clock).expect("a grid");
        let [cheaper, cost] = [&around, &grid].map(|grid| grid.from(Vector::zeros(), 0.0));
        assert!(cheaper < 0.9 * cost, "{cheaper} {cost}");
        let path = around.path_from(Vector::zeros(), end);
        let deep = |p: &Vector| 100.0 - (p.x - 500.0).abs().max(p.y.abs());
        assert!(path.iter().all(|(_, p)| deep(p) <= grid.cell), "{path:?}");
        for far in [Vector::new(5e3, 0.0), Vector::new(1e12, f64::NAN)] {
            assert!(grid.path_from(far, end).is_empty(), "{far}");
        }
    }
}
