//! The refinement's view of one manoeuvre: cost with gradient and Gauss-Newton Hessian, and the
//! contact rows, all in the free lengths.

use super::approach::{Approach, approaches};
use super::hazard::Hazard;
use super::quadratic::{Constraint, MAX_VARIABLES, Matrix, Row};
use super::reduction::{Full, reduce, reduce_matrix};
use super::route::Route;
use super::template::{Ending, Owner, Point, Sailed, Template};
use crate::frame::{Vector, to_port};
use crate::obstacle::HalfSpace;
use crate::planner::Problem;
use crate::planner::cost::{GAUSS_2, GAUSS_4, space_time_error};
use crate::trajectory::Segment;

/// Metres that solved slots and the leg after the return keep, so that a step does not run out of them.
const ROOM_M: f64 = 1.0;

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
            let bound = ROOM_M.min(sailed.solved[k]) - sailed.solved[k];
            rows.push(Constraint {
                coefficients: sailed.solved_rates[k],
                bound,
            });
        }
        if let Some(room) = sailed.room {
            let (distance, _) = sailed.joining_rates(sailed.joining_heading());
            let coefficients = reduce(&distance, &sailed, free, all).map(|c| -c);
            rows.push(Constraint {
                coefficients,
                bound: ROOM_M.min(room) - room,
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
            t if t < 0.3 => &GAUSS_2,
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
        let (ahead, normal) = (l.direction, to_port(l.direction));
        let offset = point.position - l.start;
        let behind = ahead.dot(&offset) - sigma;
        let late = point.time - l.start_time - sigma / l.speed;
        let row = |of: &[f64; 3]| {
            let mut row = [0.0; MAX_VARIABLES];
            for (i, r) in row[..n].iter_mut().enumerate() {
                *r = of[0] * point.east[i] + of[1] * point.north[i] + of[2] * point.clock[i];
            }
            row
        };
        let across = (normal.dot(&offset), row(&[normal.x, normal.y, 0.0]));
        if sigma > 0.0 && sigma < l.length {
            let scale = (q / (q + l.speed * l.speed)).sqrt();
            let lag = scale * (l.speed * late - behind);
            full.add(
                weight,
                n,
                &across,
                &(
                    lag,
                    row(&[-scale * ahead.x, -scale * ahead.y, scale * l.speed]),
                ),
            );
        } else {
            let none = (0.0, [0.0; MAX_VARIABLES]);
            full.add(weight, n, &across, &none);
            let root = q.sqrt();
            let along = (behind, row(&[ahead.x, ahead.y, 0.0]));
            full.add(weight, n, &along, &(root * late, row(&[0.0, 0.0, root])));
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

    /// Adds the tail's cost.
    fn add_tail(&self, sailed: &Sailed, all: usize, full: &mut Full) {
        let (s, t) = sailed.joined;
        let tail = self
            .straight_tail(s, t)
            .unwrap_or_else(|| self.any_tail(s, t));
        full.cost += tail.cost;
        let (distance, clock) = sailed.joining_rates(sailed.joining_heading());
        let mut lateness = [0.0; MAX_VARIABLES];
        for i in 0..all {
            full.gradient[i] += tail.by_time * clock[i] + tail.by_distance * distance[i];
            lateness[i] = clock[i] - tail.slowness * distance[i];
        }
        for i in 0..all {
            for k in 0..=i {
                full.hessian[i][k] += tail.bend * lateness[i] * lateness[k];
            }
        }
    }

    /// On the last leg, recovering in time at the greatest or the least speed, then on schedule: the lag
    /// shrinks at a constant rate `r`, so the cost is `kappa lag³ / (3 r T_d)`. `None` in any other case.
    fn straight_tail(&self, distance: f64, time: f64) -> Option<Tail> {
        let desired = self.problem.desired;
        let last = desired.legs().len() - 1;
        let leg = &desired.legs()[last];
        let stretch = self
            .route
            .stretch(last, desired)
            .filter(|s| s.distance <= distance)?;
        let own = self.problem.own;
        own.speeds
            .iter()
            .find(|u| (*u - leg.speed).abs() <= 1e-9 * leg.speed)?;
        let along = stretch.from + distance - stretch.distance;
        let lag = leg.speed * (time - leg.start_time) - along;
        let (pace, rate) = if lag >= 0.0 {
            (own.max_speed(), own.max_speed() - leg.speed)
        } else {
            (own.min_speed(), leg.speed - own.min_speed())
        };
        let recovery = lag.abs() / rate;
        let due = self.route.due_at(distance);
        let on_timetable = (due - leg.start_time - along / leg.speed).abs() < 1e-6;
        // negated on purpose: a NaN does not fit
        if !(rate > 1e-9 && along + recovery * pace <= stretch.to && on_timetable) {
            return None;
        }
        let q = self.problem.time_weight;
        let kappa = q / (q + leg.speed * leg.speed) / (rate * desired.duration());
        let by_lag = kappa * lag * lag.abs();
        Some(Tail {
            cost: kappa * lag.abs().powi(3) / 3.0,
            by_time: by_lag * leg.speed,
            by_distance: -by_lag,
            bend: 2.0 * kappa * lag.abs() * leg.speed * leg.speed,
            slowness: 1.0 / leg.speed,
        })
    }

    /// Any tail, by differences in the place and time at which it begins.
    fn any_tail(&self, distance: f64, time: f64) -> Tail {
        let (ds, dt) = (0.05, 0.01);
        let cost = self.tail_cost(distance, time);
        let (earlier, later) = (
            self.tail_cost(distance, time - dt),
            self.tail_cost(distance, time + dt),
        );
        let (back, on) = (
            self.tail_cost(distance - ds, time),
            self.tail_cost(distance + ds, time),
        );
        Tail {
            cost,
            by_time: (later - earlier) / (2.0 * dt),
            by_distance: (on - back) / (2.0 * ds),
            bend: ((later + earlier - 2.0 * cost) / (dt * dt)).max(0.0),
            slowness: (self.route.due_at(distance + ds) - self.route.due_at(distance)) / ds,
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

/// Cost of the route followed from a place at a time, with its rates per second and per metre, its
/// second rate per second, and the timetable's seconds per metre there.
struct Tail {
    cost: f64,
    by_time: f64,
    by_distance: f64,
    bend: f64,
    slowness: f64,
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
            wait: 0.0,
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
            let contact_rows = here.rows.len() - if goal { 2 } else { 3 };
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
