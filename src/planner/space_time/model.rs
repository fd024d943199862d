//! The refinement's view of one manoeuvre: cost with gradient and Gauss-Newton Hessian, and the
//! contact rows, all in the free lengths.

use super::hazard::Hazard;
use super::quadratic::{Constraint, MAX_VARIABLES, Matrix, Row};
use super::route::Route;
use super::template::{Ending, Owner, Point, Sailed, Template};
use crate::frame::{Vector, to_port};
use crate::obstacle::HalfSpace;
use crate::planner::Problem;
use crate::planner::cost::{GAUSS_2, GAUSS_4, space_time_error};
use crate::trajectory::Segment;

/// Metres. Approaches closer than this become rows.
const NEAR_M: f64 = 60.0;

/// Radians. Longest arc that one chord stands for when a minimum is sought.
const CHORD_RAD: f64 = 0.2;

/// Metres kept from every set while refining, so that the exact test afterwards passes.
const MARGIN_M: f64 = 0.02;

/// Three Gauss-Legendre points on [0, 1], for short arcs.
const GAUSS_3: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 0.277_777_777_777_777_8),
    (0.5, 0.444_444_444_444_444_4),
    (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
];

/// What stays the same for every manoeuvre of a problem.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Scene<'a> {
    pub problem: &'a Problem<'a>,
    pub route: &'a Route,
    pub hazards: &'a [Hazard<'a>],
}

/// One manoeuvre, evaluated.
#[derive(Debug, Clone)]
pub(crate) struct Model {
    pub sailed: Sailed,
    pub cost: f64,
    pub gradient: Row,
    pub hessian: Matrix,
    /// Contact rows and the signs of the solved slots, linearised: `row . step >= bound`.
    pub rows: Vec<Constraint>,
    /// The largest missing slack, metres; zero when clear with the margin. Not their sum: an approach that
    /// splits in two must not make the merit jump.
    pub violation: f64,
    /// Least slack of all contact rows, metres.
    pub least_slack: f64,
}

/// A local minimum of the slack along a manoeuvre.
#[derive(Debug, Clone, Copy)]
struct Approach {
    leg: usize,
    fraction: f64,
    slack: f64,
    faces: [(usize, f64); 2],
}

impl Scene<'_> {
    /// Sails and evaluates; `None` when the manoeuvre's ending does not fit.
    pub(crate) fn model(&self, template: &Template, lengths: &Row) -> Option<Model> {
        let sailed = template.sail(self.problem, self.route, lengths)?;
        let (all, free) = (template.all(), template.free());
        let mut full = Full {
            cost: 0.0,
            gradient: [0.0; MAX_VARIABLES],
            hessian: [[0.0; MAX_VARIABLES]; MAX_VARIABLES],
        };
        for leg in 0..sailed.tail {
            self.add_leg(&sailed, leg, &mut full);
        }
        if !matches!(template.ending, Ending::Goal { .. }) {
            self.add_tail(&sailed, all, &mut full);
        }
        let mut rows = Vec::with_capacity(8);
        let (mut violation, mut least_slack) = (0.0_f64, f64::INFINITY);
        for hazard in self.hazards {
            for approach in approaches(hazard, &sailed) {
                let missing = MARGIN_M - approach.slack;
                violation = missing.max(violation);
                least_slack = least_slack.min(approach.slack);
                let coefficients = self.approach_row(hazard, &sailed, &approach, all);
                rows.push(Constraint {
                    coefficients: reduce(&coefficients, &sailed, free, all),
                    bound: missing,
                });
            }
        }
        for k in 0..all - free {
            let coefficients = sailed.solved_rates[k];
            rows.push(Constraint {
                coefficients,
                bound: -sailed.solved[k],
            });
        }
        let gradient = reduce(&full.gradient, &sailed, free, all);
        let hessian = reduce_matrix(&full.hessian, &sailed, free, all);
        Some(Model {
            sailed,
            cost: full.cost,
            gradient,
            hessian,
            rows,
            violation,
            least_slack,
        })
    }

    /// Adds a leg's cost: the squared residuals at Gauss points, their rates, and the rate of the
    /// leg's own duration.
    fn add_leg(&self, sailed: &Sailed, leg: usize, full: &mut Full) {
        let Owner::Slot { index, from, to } = sailed.legs[leg].owner else {
            return;
        };
        let segment = sailed.legs[leg].segment;
        let desired = self.problem.desired;
        let q = self.problem.time_weight;
        let per_time = 1.0 / desired.duration();
        let turn = segment.turn_rate.abs() * segment.duration;
        let nodes: &[(f64, f64)] = match turn {
            t if t == 0.0 => &GAUSS_2,
            t if t < 1.0 => &GAUSS_3,
            _ => &GAUSS_4,
        };
        let growth = (to - from) / segment.speed * per_time;
        if segment.duration <= 0.0 {
            let point = desired.nearest(segment.start.position, segment.start_time, q);
            full.gradient[index] += growth * point.error;
            return;
        }
        for (fraction, share) in nodes {
            let point = sailed.point(leg, *fraction);
            let nearest = desired.nearest(point.position, point.time, q);
            full.cost += segment.duration * per_time * share * nearest.error;
            full.gradient[index] += growth * share * nearest.error;
            self.add_residuals(
                &point,
                nearest.leg,
                nearest.distance,
                segment.duration * per_time * share,
                full,
            );
        }
    }

    fn add_residuals(
        &self,
        point: &Point,
        leg: usize,
        distance: f64,
        weight: f64,
        full: &mut Full,
    ) {
        let l = &self.problem.desired.legs()[leg];
        let q = self.problem.time_weight;
        let sigma = distance - l.start_distance;
        let n = point.slots;
        let mut row = [0.0; MAX_VARIABLES];
        let normal = to_port(l.direction);
        let offset = point.position - l.start;
        let mut add = |residual: f64, of: &dyn Fn(f64, f64, f64) -> f64| {
            for (i, r) in row.iter_mut().enumerate().take(n) {
                *r = of(point.east[i], point.north[i], point.clock[i]);
            }
            full.add(&row, residual, weight, n);
        };
        add(normal.dot(&offset), &|e, n, _| normal.x * e + normal.y * n);
        let behind = l.direction.dot(&offset) - sigma;
        let late = point.time - l.start_time - sigma / l.speed;
        if sigma > 0.0 && sigma < l.length {
            let scale = (q / (q + l.speed * l.speed)).sqrt();
            let lag = l.speed * late - behind;
            add(scale * lag, &|e, n, t| {
                scale * (l.speed * t - l.direction.x * e - l.direction.y * n)
            });
        } else {
            let root = q.sqrt();
            add(behind, &|e, n, _| l.direction.x * e + l.direction.y * n);
            add(root * late, &|_, _, t| root * t);
        }
    }

    /// Cost of following the route from a place at a time, m².
    fn tail_cost(&self, distance: f64, time: f64) -> f64 {
        let mut segments = Vec::with_capacity(4);
        self.route.follow(distance, time, &mut segments);
        segments
            .iter()
            .map(|s| space_time_error(self.problem.desired, s, self.problem.time_weight))
            .sum()
    }

    /// Adds the tail's cost, by differences in the place and time at which it begins.
    fn add_tail(&self, sailed: &Sailed, all: usize, full: &mut Full) {
        let (s, t) = sailed.joined;
        let (ds, dt) = (0.05, 0.01);
        let here = self.tail_cost(s, t);
        let (earlier, later) = (self.tail_cost(s, t - dt), self.tail_cost(s, t + dt));
        let (back, on) = (self.tail_cost(s - ds, t), self.tail_cost(s + ds, t));
        let by_time = (later - earlier) / (2.0 * dt);
        let by_distance = (on - back) / (2.0 * ds);
        let bend = ((later + earlier - 2.0 * here) / (dt * dt)).max(0.0);
        full.cost += here;
        let (distance, clock) = sailed.joining_rates(sailed.joining_heading());
        let slowness = (self.route.due_at(s + ds) - self.route.due_at(s)) / ds;
        let mut lateness = [0.0; MAX_VARIABLES];
        for i in 0..all {
            full.gradient[i] += by_time * clock[i] + by_distance * distance[i];
            lateness[i] = clock[i] - slowness * distance[i];
        }
        for i in 0..all {
            for k in 0..=i {
                full.hessian[i][k] += bend * lateness[i] * lateness[k];
            }
        }
    }

    /// Rates of the slack at an approach.
    fn approach_row(
        &self,
        hazard: &Hazard,
        sailed: &Sailed,
        approach: &Approach,
        all: usize,
    ) -> Row {
        let faces = hazard.body.faces();
        let point = match sailed.legs[approach.leg].owner {
            Owner::Slot { .. } => sailed.point(approach.leg, approach.fraction),
            Owner::Tail { index } => self.tail_point(sailed, index, approach, all),
        };
        let mut row = [0.0; MAX_VARIABLES];
        for (face, weight) in approach.faces {
            let HalfSpace {
                normal,
                velocity_support,
                ..
            } = faces[face];
            for (i, r) in row.iter_mut().enumerate().take(point.slots) {
                *r += weight
                    * (normal.x * point.east[i] + normal.y * point.north[i]
                        - velocity_support * point.clock[i]);
            }
        }
        row
    }

    /// A point of the tail with its rates, by differences in the place and time of joining.
    fn tail_point(&self, sailed: &Sailed, index: usize, approach: &Approach, all: usize) -> Point {
        let (s, t) = sailed.joined;
        let (ds, dt) = (0.05, 0.01);
        let at = |distance: f64, time: f64| -> Option<(Vector, f64)> {
            let mut segments = Vec::with_capacity(4);
            self.route.follow(distance, time, &mut segments);
            let segment: &Segment = segments.get(index)?;
            let elapsed = segment.duration * approach.fraction;
            Some((
                segment.pose_after(elapsed).position,
                segment.start_time + elapsed,
            ))
        };
        let here = at(s, t).unwrap_or_default();
        let by_distance = at(s + ds, t).unwrap_or(here);
        let by_time = at(s, t + dt).unwrap_or(here);
        let (distance, clock) = sailed.joining_rates(sailed.joining_heading());
        let mut point = Point {
            position: here.0,
            time: here.1,
            slots: all,
            east: [0.0; MAX_VARIABLES],
            north: [0.0; MAX_VARIABLES],
            clock: [0.0; MAX_VARIABLES],
        };
        let (place_s, clock_s) = ((by_distance.0 - here.0) / ds, (by_distance.1 - here.1) / ds);
        let (place_t, clock_t) = ((by_time.0 - here.0) / dt, (by_time.1 - here.1) / dt);
        for i in 0..all {
            point.east[i] = place_s.x * distance[i] + place_t.x * clock[i];
            point.north[i] = place_s.y * distance[i] + place_t.y * clock[i];
            point.clock[i] = clock_s * distance[i] + clock_t * clock[i];
        }
        point
    }
}

/// Cost and rates in all slots; the lower triangle of the Hessian.
struct Full {
    cost: f64,
    gradient: Row,
    hessian: Matrix,
}

impl Full {
    fn add(&mut self, row: &Row, residual: f64, weight: f64, n: usize) {
        let scale = 2.0 * weight;
        for i in 0..n {
            let r = scale * row[i];
            self.gradient[i] += residual * r;
            for (h, c) in self.hessian[i].iter_mut().zip(row).take(i + 1) {
                *h += r * c;
            }
        }
    }
}

/// A row in all slots as a row in the free ones.
fn reduce(row: &Row, sailed: &Sailed, free: usize, all: usize) -> Row {
    let mut reduced = [0.0; MAX_VARIABLES];
    for i in 0..free {
        reduced[i] = row[i]
            + (0..all - free)
                .map(|k| row[free + k] * sailed.solved_rates[k][i])
                .sum::<f64>();
    }
    reduced
}

fn reduce_matrix(lower: &Matrix, sailed: &Sailed, free: usize, all: usize) -> Matrix {
    let mut half: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
    for i in 0..all {
        let mut row = [0.0; MAX_VARIABLES];
        for k in 0..all {
            row[k] = if k <= i { lower[i][k] } else { lower[k][i] };
        }
        half[i] = reduce(&row, sailed, free, all);
    }
    let mut reduced: Matrix = [[0.0; MAX_VARIABLES]; MAX_VARIABLES];
    for i in 0..free {
        for k in 0..free {
            reduced[i][k] = half[i][k]
                + (0..all - free)
                    .map(|d| sailed.solved_rates[d][i] * half[free + d][k])
                    .sum::<f64>();
        }
    }
    reduced
}

/// The local minima of a hazard's slack along a manoeuvre, below [`NEAR_M`].
fn approaches(hazard: &Hazard, sailed: &Sailed) -> Vec<Approach> {
    let mut chords: Vec<(Approach, f64, f64)> = Vec::with_capacity(32);
    let mut found: Vec<Approach> = Vec::new();
    let flush = |chords: &mut Vec<(Approach, f64, f64)>, found: &mut Vec<Approach>| {
        for i in 0..chords.len() {
            let here = chords[i].0;
            let before = if i > 0 {
                chords[i - 1].0.slack
            } else {
                f64::INFINITY
            };
            let after = chords.get(i + 1).map_or(f64::INFINITY, |c| c.0.slack);
            if here.slack < before && here.slack <= after && here.slack < NEAR_M {
                let mut row = here;
                // at a joint the two sides share the instant: its rows are one falling, one rising
                let next = chords.get(i + 1).filter(|c| c.0.slack - here.slack < 1e-9);
                if let Some((rising, _, rate)) = next
                    && here.faces[1].1 == 0.0
                    && chords[i].1 < 0.0
                    && *rate > 0.0
                {
                    let (falling, face) = (chords[i].1, rising.faces[0].0);
                    let weight = rate / (rate - falling);
                    row.faces = [(here.faces[0].0, weight), (face, 1.0 - weight)];
                }
                found.push(row);
            }
        }
        chords.clear();
    };
    for (leg, l) in sailed.legs.iter().enumerate() {
        let segment = &l.segment;
        if segment.duration <= 0.0 {
            continue;
        }
        if hazard.clearance_bound(segment) > NEAR_M {
            flush(&mut chords, &mut found);
            continue;
        }
        let count = (segment.turn_rate.abs() * segment.duration / CHORD_RAD)
            .ceil()
            .max(1.0);
        for k in 0..count as usize {
            let (from, to) = (k as f64 / count, (k + 1) as f64 / count);
            chords.push(least_on(hazard, segment, leg, from, to));
        }
    }
    flush(&mut chords, &mut found);
    found
}

/// The minimum over part of a segment, with the slack's rates at its start side and end side of that
/// instant (zero weight on the second face at an end of the part).
fn least_on(
    hazard: &Hazard,
    segment: &Segment,
    leg: usize,
    from: f64,
    to: f64,
) -> (Approach, f64, f64) {
    let (mut low, mut high) = (from, to);
    let faces = hazard.body.faces();
    let passes = if segment.is_arc() { 3 } else { 1 };
    let mut best = (
        Approach {
            leg,
            fraction: from,
            slack: f64::INFINITY,
            faces: [(0, 1.0), (0, 0.0)],
        },
        0.0,
        0.0,
    );
    for _ in 0..passes {
        let at = |f: f64| {
            let elapsed = segment.duration * f;
            (
                segment.pose_after(elapsed).position,
                segment.start_time + elapsed,
            )
        };
        let ((pa, ta), (pb, tb)) = (at(low), at(high));
        let width = (tb - ta).max(1e-12);
        let velocity = (pb - pa) / width;
        let rate = |face: usize| faces[face].normal.dot(&velocity) - faces[face].velocity_support;
        let slack = |s: f64| hazard.body.slack(pa + velocity * s, ta + s);
        let (mut a, mut b) = ((0.0, slack(0.0)), (width, slack(width)));
        let mut least = if rate(a.1.face) >= 0.0 {
            (a, [(a.1.face, 1.0), (a.1.face, 0.0)])
        } else if rate(b.1.face) <= 0.0 {
            (b, [(b.1.face, 1.0), (b.1.face, 0.0)])
        } else {
            // a convex piecewise linear function between a falling and a rising face
            let mut least = (a, [(a.1.face, 1.0), (b.1.face, 0.0)]);
            for _ in 0..30 {
                let (fall, rise) = (rate(a.1.face), rate(b.1.face));
                let s = (a.0 + (b.1.value - a.1.value - rise * (b.0 - a.0)) / (fall - rise))
                    .clamp(a.0, b.0);
                let g = slack(s);
                let weight = rise / (rise - fall);
                least = ((s, g), [(a.1.face, weight), (b.1.face, 1.0 - weight)]);
                if g.face == a.1.face || g.face == b.1.face || !(s > a.0 && s < b.0) {
                    break;
                }
                if rate(g.face) < 0.0 {
                    a = (s, g)
                } else {
                    b = (s, g)
                }
            }
            least
        };
        let fraction = low + (high - low) * least.0.0 / width;
        if passes > 1 {
            let (p, t) = at(fraction);
            let exact = hazard.body.slack(p, t);
            least.0.1 = exact;
            if least.1[1].1 == 0.0 {
                least.1 = [(exact.face, 1.0), (exact.face, 0.0)];
            }
        }
        let ends = (rate(least.1[0].0), rate(least.1[0].0));
        best = (
            Approach {
                leg,
                fraction,
                slack: least.0.1.value,
                faces: least.1,
            },
            ends.0,
            ends.1,
        );
        let reach = (high - low) / 6.0;
        (low, high) = ((fraction - reach).max(from), (fraction + reach).min(to));
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::frame::{Pose, Side};
    use crate::geometry::outer_disc;
    use crate::obstacle::PolytopeObstacle;
    use crate::planner::SearchKind;
    use crate::planner::space_time::seeds::{Canonical, Conflict};
    use crate::planner::space_time::template::Slot;
    use crate::trajectory::DesiredTrajectory;
    use crate::vessel::{Hull, OwnShip};

    /// Every rate against central differences, at a manoeuvre with all slots open and a near target.
    #[test]
    fn rates_match_differences() {
        let own = OwnShip {
            pose: Pose::new(Vector::new(0.0, 0.0), 0.0),
            speed: 5.0,
            hull: Hull {
                length: 30.0,
                beam: 8.0,
            },
            turning_radius: 100.0,
            speeds: vec![2.5, 5.0, 6.0],
            safety_margin: 20.0,
        };
        let points = [(0.0, 0.0), (2500.0, 0.0)].map(|(x, y)| Vector::new(x, y));
        let desired = DesiredTrajectory::new(&points, &[5.0]).expect("valid");
        let velocity = crate::geometry::ConvexPolygon::hull(&[
            Vector::new(-4.0, 0.3),
            Vector::new(-5.0, -0.4),
        ]);
        let obstacles = [PolytopeObstacle::new(
            "x",
            outer_disc(60.0, 0.1).translated(Vector::new(1300.0, -10.0)),
            velocity.expect("finite"),
        )];
        let problem = Problem {
            own: &own,
            desired: &desired,
            obstacles: &obstacles,
            horizon: 900.0,
            time_weight: 25.0,
            search: SearchKind::AStar,
            deadline: std::time::Duration::from_secs(5),
        };
        let route = Route::new(&problem).expect("a route");
        let hazards = [Hazard::new(&obstacles[0])];
        let scene = Scene {
            problem: &problem,
            route: &route,
            hazards: &hazards,
        };
        let canonical = Canonical {
            turn: 0.7,
            lead: 0.9,
            reach: 1.0,
            slow: false,
        };
        let conflict = Conflict {
            from: 140.0,
            to: 180.0,
            offsets: [80.0, 90.0],
        };
        for (side, goal) in [
            (Side::Starboard, false),
            (Side::Port, false),
            (Side::Port, true),
        ] {
            let mut seed = canonical
                .seed(&problem, &route, side, &conflict, 0)
                .expect("a seed");
            if goal {
                seed.template.ending = Ending::Goal { side, speed: 6.0 };
            }
            for (i, slot) in seed.template.slots.iter().enumerate() {
                seed.lengths[i] += if matches!(slot, Slot::Arc { .. }) {
                    7.0
                } else {
                    11.0
                } + i as f64;
            }
            let here = scene.model(&seed.template, &seed.lengths).expect("fits");
            let contact_rows = here.rows.len() - 2;
            assert!(contact_rows > 0);
            let step = 1e-4;
            for i in 0..seed.template.free() {
                let at = |d: f64| {
                    let mut lengths = seed.lengths;
                    lengths[i] += d;
                    scene.model(&seed.template, &lengths).expect("fits")
                };
                let (less, more) = (at(-step), at(step));
                let rate = (more.cost - less.cost) / (2.0 * step);
                let scale = 1.0 + rate.abs();
                assert!(
                    (here.gradient[i] - rate).abs() < 2e-4 * scale,
                    "slot {i}: {} {rate}",
                    here.gradient[i]
                );
                for k in 0..here.rows.len() {
                    let rate = (less.rows[k].bound - more.rows[k].bound) / (2.0 * step);
                    let found = here.rows[k].coefficients[i];
                    assert!(
                        (found - rate).abs() < 2e-3 * (1.0 + rate.abs()),
                        "{side} row {k} slot {i}: {found} {rate}"
                    );
                }
            }
        }
    }
}
