use super::*;

/// Lattice steps east and north with costs from a hash, some closed cells, and a goal at a corner.
struct Grid {
    size: i32,
    informed: bool,
}

fn grid(informed: bool) -> Grid {
    Grid { size: 7, informed }
}

impl Grid {
    fn weight(x: i32, y: i32) -> f64 {
        1.0 + f64::from((x * 7919 + y * 104_729).rem_euclid(13)) / 13.0
    }
}

impl Space for Grid {
    type State = (i32, i32);
    fn successors(&mut self, &(x, y): &(i32, i32), out: &mut Vec<((i32, i32), f64)>) {
        for (a, b) in [(x + 1, y), (x, y + 1)] {
            if a < self.size && b < self.size {
                out.push(((a, b), Self::weight(a, b)));
            }
        }
    }
    fn bound(&mut self, &(x, y): &(i32, i32)) -> f64 {
        if self.informed {
            f64::from(2 * self.size - 2 - x - y)
        } else {
            0.0
        }
    }
    fn is_goal(&self, &(x, y): &(i32, i32)) -> bool {
        x == self.size - 1 && y == self.size - 1
    }
    fn admits(&mut self, &(x, y): &(i32, i32)) -> bool {
        (x * 31 + y * 17) % 11 != 5
    }
}

fn costs(informed: bool) -> (Vec<f64>, Counts) {
    let mut grid = grid(informed);
    let mut search = Search::new((0, 0));
    let mut found = Vec::new();
    while let Stop::Goal(node) = search.next_goal(&mut grid, usize::MAX) {
        found.push(search.nodes()[node].cost);
        let way = search.way_to(node);
        assert_eq!(way.len(), 13);
        if found.len() == 5 {
            break;
        }
    }
    (found, search.counts())
}

/// Costs of all paths, by plain recursion.
fn all_costs(grid: &mut Grid, at: (i32, i32), cost: f64, out: &mut Vec<f64>) {
    if grid.is_goal(&at) {
        out.push(cost);
        return;
    }
    let mut next = Vec::new();
    grid.successors(&at, &mut next);
    for (state, step) in next {
        if grid.admits(&state) {
            all_costs(grid, state, cost + step, out);
        }
    }
}

#[test]
fn goals_come_in_order_of_cost_and_are_those_of_plain_enumeration() {
    let mut every = Vec::new();
    all_costs(&mut grid(false), (0, 0), 0.0, &mut every);
    every.sort_by(f64::total_cmp);
    let mut expanded = Vec::new();
    for informed in [false, true] {
        let (found, counts) = costs(informed);
        for k in 0..5 {
            assert!((found[k] - every[k]).abs() < 1e-12);
        }
        expanded.push(counts.expanded);
    }
    assert!(expanded[1] < expanded[0], "{expanded:?}");
}

#[test]
fn after_a_budget_weighed_goals_cost_at_most_so_many_times_the_cheapest() {
    let (exact, patient) = costs(true);
    for weight in [1.0, 1.5, 4.0] {
        let mut grid = grid(true);
        let mut search = Search::new((0, 0));
        assert_eq!(search.next_goal(&mut grid, 3), Stop::Budget);
        assert_eq!(search.counts().expanded, 3);
        assert_eq!(search.counts().heuristic_weight, 1.0);
        search.weigh(weight);
        assert_eq!(search.counts().heuristic_weight, weight);
        let Stop::Goal(goal) = search.next_goal(&mut grid, usize::MAX) else {
            panic!("there is a way");
        };
        let cost = search.nodes()[goal].cost;
        assert!(cost <= weight * exact[0] + 1e-12, "{weight}: {cost}");
        assert!(search.counts().expanded <= patient.expanded, "{weight}");
    }
}

struct Broken;
impl Space for Broken {
    type State = u8;
    fn successors(&mut self, _: &u8, out: &mut Vec<(u8, f64)>) {
        out.extend([(1, f64::NAN), (2, -1.0)]);
    }
    fn bound(&mut self, _: &u8) -> f64 {
        0.0
    }
    fn is_goal(&self, state: &u8) -> bool {
        *state > 0
    }
    fn admits(&mut self, _: &u8) -> bool {
        true
    }
}

#[test]
fn costs_that_are_no_numbers_are_no_edges() {
    assert_eq!(Search::new(0).next_goal(&mut Broken, 10), Stop::Exhausted);
}
