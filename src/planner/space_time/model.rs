//! The refinement's view of one manoeuvre: cost with gradient and Gauss-Newton Hessian, and the
//! contact rows, all in the free lengths.

use super::approach::{Approach, NEAR_M, approaches};
use super::ashore;
use super::hazard::Hazard;
use super::moments::{Moments, Residuals, reduce, reduce_matrix};
use super::quadratic::{Constraint, MAX_VARIABLES, Matrix, Row};
use super::route::Route;
use super::template::{Ending, Owner, Place, Sailed, Template};
use crate::frame::to_port;
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
    /// The land, block by block.
    pub blocks: &'a [Hazard<'a>],
    /// Radians, see [`approaches`].
    pub chord: f64,
}

/// One manoeuvre, evaluated.
#[derive(Debug)]
pub(crate) struct Model {
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
            moments: Moments::new(),
        };
        for leg in 0..sailed.tail {
            self.add_leg(&sailed, leg, &mut full);
        }
        let motors = sailed.motors(self.problem.own.pose.position);
        full.moments
            .finish(&motors, &mut full.gradient, &mut full.hessian);
        let joining = sailed.joining_rates();
        if !matches!(template.ending, Ending::Goal { .. }) {
            self.add_tail(&sailed, &joining, all, &mut full);
        }
        let solved = &sailed.solved_rates[..all - free];
        let mut rows = Vec::with_capacity(8);
        let (mut violation, mut least_slack) = (0.0_f64, f64::INFINITY);
        let sails = sailed.legs.iter().map(|l| &l.segment);
        let blocks = ashore::near(self.problem.coast, sails, NEAR_M);
        let land = blocks.into_iter().map(|b| &self.blocks[b]);
        for hazard in self.hazards.iter().chain(land) {
            for approach in approaches(hazard, &sailed, self.chord) {
                let missing = MARGIN_M - approach.slack;
                violation = missing.max(violation);
                least_slack = least_slack.min(approach.slack);
                let coefficients = self.approach_row(&sailed, &approach, &joining);
                rows.push(Constraint {
                    coefficients: reduce(&coefficients, solved, free),
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
            let coefficients = reduce(&joining.0, solved, free).map(|c| -c);
            rows.push(Constraint {
                coefficients,
                bound: ROOM_M.min(room) - room,
            });
        }
        let gradient = reduce(&full.gradient, solved, free);
        let hessian = reduce_matrix(&full.hessian, solved, free);
        Some(Model {
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
            let Some(place) = sailed.place(leg, *fraction) else {
                continue;
            };
            let nearest = desired.nearest(place.position, place.time, q);
            let weight = segment.duration * per_time * share;
            full.cost += weight * nearest.error;
            full.gradient[index] += growth * share * nearest.error;
            let residuals = self.residuals(&place, nearest.leg, nearest.distance, weight);
            if index < sailed.runs {
                let mut rates = [[0.0; 3]; MAX_VARIABLES];
                for (i, rate) in rates.iter_mut().enumerate().take(index + 1) {
                    *rate = sailed.own_rate(&place, i);
                }
                Moments::add_directly(
                    &rates[..=index],
                    &residuals,
                    &mut full.gradient,
                    &mut full.hessian,
                );
            } else {
                let at = place.position - self.problem.own.pose.position;
                let own = sailed.own_rate(&place, index);
                full.moments.add(index, [at.x, at.y], own, &residuals);
            }
        }
    }

    /// The residuals of a point whose nearest desired place is `distance` along the path, on `leg`.
    fn residuals(&self, place: &Place, leg: usize, distance: f64, weight: f64) -> Residuals {
        let l = &self.problem.desired.legs()[leg];
        let q = self.problem.time_weight;
        let sigma = distance - l.start_distance;
        let (ahead, normal) = (l.direction, to_port(l.direction));
        let offset = place.position - l.start;
        let behind = ahead.dot(&offset) - sigma;
        let late = place.time - l.start_time - sigma / l.speed;
        let mut residuals = Residuals::default();
        let scale = 2.0 * weight;
        residuals.add(scale, normal.dot(&offset), [normal.x, normal.y, 0.0]);
        if sigma > 0.0 && sigma < l.length {
            let share = (q / (q + l.speed * l.speed)).sqrt();
            let lag = share * (l.speed * late - behind);
            let rates = [-share * ahead.x, -share * ahead.y, share * l.speed];
            residuals.add(scale, lag, rates);
        } else {
            let root = q.sqrt();
            residuals.add(scale, behind, [ahead.x, ahead.y, 0.0]);
            residuals.add(scale, root * late, [0.0, 0.0, root]);
        }
        residuals
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
    fn add_tail(&self, sailed: &Sailed, joining: &(Row, Row), all: usize, full: &mut Full) {
        let (s, t) = sailed.joined;
        let tail = self
            .straight_tail(s, t)
            .unwrap_or_else(|| self.any_tail(s, t));
        full.cost += tail.cost;
        let (distance, clock) = joining;
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
    fn approach_row(&self, sailed: &Sailed, approach: &Approach, joining: &(Row, Row)) -> Row {
        let of = approach.rates;
        let leg = &sailed.legs[approach.leg];
        match (sailed.place(approach.leg, approach.fraction), leg.owner) {
            (Some(place), _) => sailed.rates(&place, of),
            (None, Owner::Tail { index }) => self.tail_row(sailed, index, approach, of, joining),
            (None, Owner::Slot { .. }) => [0.0; MAX_VARIABLES],
        }
    }

    /// Rates of `of . (east, north, clock)` of a point of the tail, by differences in the place and time
    /// of joining.
    fn tail_row(
        &self,
        sailed: &Sailed,
        index: usize,
        approach: &Approach,
        of: [f64; 3],
        joining: &(Row, Row),
    ) -> Row {
        let (s, t) = sailed.joined;
        let (ds, dt) = (0.05, 0.01);
        let at = |distance: f64, time: f64| -> Option<f64> {
            let mut segments = Vec::with_capacity(4);
            self.route.follow(distance, time, &mut segments);
            let segment: &Segment = segments.get(index)?;
            let elapsed = segment.duration * approach.fraction;
            let position = segment.pose_after(elapsed).position;
            Some(of[0] * position.x + of[1] * position.y + of[2] * (segment.start_time + elapsed))
        };
        let here = at(s, t).unwrap_or_default();
        let by_distance = (at(s + ds, t).unwrap_or(here) - here) / ds;
        let by_time = (at(s, t + dt).unwrap_or(here) - here) / dt;
        let mut row = [0.0; MAX_VARIABLES];
        for (to, (distance, clock)) in row.iter_mut().zip(joining.0.iter().zip(&joining.1)) {
            *to = by_distance * distance + by_time * clock;
        }
        row
    }
}

/// Cost and rates in all slots; the lower triangle of the Hessian.
struct Full {
    cost: f64,
    gradient: Row,
    hessian: Matrix,
    moments: Moments,
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
    use super::super::approach::FINE_CHORD_RAD;
    use super::*;
    use crate::frame::{Pose, Side, Vector};
    use crate::geometry::outer_disc;
    use crate::obstacle::{Coast, PolytopeObstacle};
    use crate::planner::SearchKind;
    use crate::planner::space_time::part::parts;
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
        )
        .into()];
        let problem = Problem {
            own: &own,
            desired: &desired,
            obstacles: &obstacles,
            coast: Coast::none(),
            horizon: 900.0,
            time_weight: 25.0,
            search: SearchKind::AStar,
            deadline: std::time::Duration::from_secs(5),
        };
        let route = Route::new(&problem).expect("a route");
        let parts = parts(&obstacles, problem.horizon);
        let hazards = [Hazard::new(&parts[0])];
        let scene = Scene {
            problem: &problem,
            route: &route,
            hazards: &hazards,
            blocks: &[],
            chord: FINE_CHORD_RAD,
        };
        let canonical = Canonical {
            turn: 0.7,
            lead: 0.9,
            reach: 1.0,
            slow: false,
            rush: 0.0,
        };
        let conflict = Conflict {
            from: 140.0,
            to: 180.0,
            through: 200.0,
            offsets: [80.0, 90.0],
            astern: (90.0, 160.0),
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
