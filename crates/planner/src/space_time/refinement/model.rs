//! Local model of one manoeuvre: cost with gradient and Gauss-Newton Hessian, and the contact rows,
//! all in the free lengths.

use crate::space_time::context::Context;
use crate::space_time::refinement::approach::Approach;
use crate::space_time::refinement::gauss_newton::{GaussNewton, Residuals, reduce, reduce_matrix};
use crate::space_time::refinement::quadratic::{Constraint, MAX_VARIABLES, Row};
use crate::space_time::refinement::rollout::{Place, SegmentOrigin};
use crate::space_time::refinement::structure::Structure;
use crate::space_time::refinement::trial::{Trial, WeightedPoint};
use searoom_geometry::frame::to_port;

/// Metres by which dependent segment variables and the leg after the return stay positive.
const ROOM_M: f64 = 1.0;

/// Metres kept from every set during the refinement, so that the exact test afterwards passes.
pub(crate) const REFINEMENT_MARGIN_M: f64 = 0.02;

/// Local model of one manoeuvre.
#[derive(Debug)]
pub(crate) struct Model {
    pub cost: f64,
    pub gradient: Row,
    /// Positive definite Hessian, one row per variable.
    pub hessian: Vec<Row>,
    /// Linearised contact rows and signs of the dependent segment variables: `row . step >= bound`.
    pub rows: Vec<Constraint>,
    /// Largest missing slack, metres; zero when clear with the margin. A sum would make the merit
    /// function jump when one approach splits in two.
    pub violation: f64,
    /// Least slack of all contact rows, metres.
    pub least_slack: f64,
}

/// Regularisation of the Hessian's diagonal as a fraction of the cost per square metre, and the
/// least cost it refers to, m². Gauss-Newton leaves some directions flat.
const REGULARISATION: f64 = 1e-5;
const LEAST_REGULARISED: f64 = 20.0;

/// Model of one manoeuvre in all its segment variables, including the dependent ones.
#[derive(Debug)]
pub(crate) struct UnreducedModel {
    pub trial: Trial,
    pub gradient: Row,
    /// Lower triangle.
    hessian: Vec<Row>,
    pub moments: GaussNewton,
}

impl Context<'_> {
    /// Rolls out and evaluates; `None` when the manoeuvre's ending does not fit.
    pub(crate) fn model(&self, structure: &Structure, lengths: &Row) -> Option<Model> {
        Some(self.completed(structure, self.trial(structure, lengths)?))
    }

    /// Derivatives of an evaluated trial point.
    pub(crate) fn completed(&self, structure: &Structure, trial: Trial) -> Model {
        let unreduced = self.unreduced(structure, trial);
        let trial = &unreduced.trial;
        let (all, free) = (structure.all(), structure.free());
        let solved = &trial.rollout.solved_rates[..all - free];
        let gradient = reduce(&unreduced.gradient, solved, free);
        let mut hessian = reduce_matrix(unreduced.hessian, solved, free);
        for (i, row) in hessian.iter_mut().enumerate() {
            row[i] += REGULARISATION * trial.cost.max(LEAST_REGULARISED);
        }
        Model {
            cost: trial.cost,
            gradient,
            hessian,
            rows: self.rows(structure, trial),
            violation: trial.violation,
            least_slack: trial.least_slack,
        }
    }

    /// Linearised contact rows and signs of the dependent segment variables.
    pub(crate) fn rows(&self, structure: &Structure, trial: &Trial) -> Vec<Constraint> {
        let (all, free) = (structure.all(), structure.free());
        let rollout = &trial.rollout;
        let solved = &rollout.solved_rates[..all - free];
        let mut rows = Vec::with_capacity(trial.approaches.len() + 3);
        for approach in &trial.approaches {
            let coefficients = self.approach_row(trial, approach);
            rows.push(Constraint {
                coefficients: reduce(&coefficients, solved, free),
                bound: REFINEMENT_MARGIN_M - approach.slack,
            });
        }
        for k in 0..all - free {
            let least = self.segment_time * structure.ending.speed();
            let bound = ROOM_M.min(rollout.solved[k]).max(least) - rollout.solved[k];
            rows.push(Constraint {
                coefficients: rollout.solved_rates[k],
                bound,
            });
        }
        if let Some(room) = rollout.room {
            let coefficients = reduce(&trial.joining.0, solved, free).map(|c| -c);
            rows.push(Constraint {
                coefficients,
                bound: ROOM_M.min(room) - room,
            });
        }
        rows
    }

    /// Model before the dependent segment variables are eliminated.
    pub(crate) fn unreduced(&self, structure: &Structure, trial: Trial) -> UnreducedModel {
        let all = structure.all();
        let mut unreduced = UnreducedModel {
            gradient: [0.0; MAX_VARIABLES],
            hessian: vec![[0.0; MAX_VARIABLES]; all],
            moments: GaussNewton::new(all),
            trial,
        };
        let trial = &unreduced.trial;
        let rollout = &trial.rollout;
        let origin = self.problem.own.pose.position;
        for point in &trial.points {
            unreduced.gradient[point.variable] += point.growth;
            let Some(weighed) = &point.weighed else {
                continue;
            };
            let WeightedPoint {
                place,
                nearest,
                weight,
            } = weighed;
            let residuals = self.residuals(place, nearest.leg, nearest.distance, *weight);
            if point.variable < rollout.runs {
                let mut rates = [[0.0; 3]; MAX_VARIABLES];
                for (i, rate) in rates.iter_mut().enumerate().take(point.variable + 1) {
                    *rate = rollout.own_rate(place, i);
                }
                GaussNewton::add_directly(
                    &rates[..=point.variable],
                    &residuals,
                    &mut unreduced.gradient,
                    &mut unreduced.hessian,
                );
            } else {
                let at = place.position - origin;
                let own = rollout.own_rate(place, point.variable);
                unreduced
                    .moments
                    .add(point.variable, [at.x, at.y], own, &residuals);
            }
        }
        let twists = rollout.twists(origin);
        unreduced
            .moments
            .finish(&twists, &mut unreduced.gradient, &mut unreduced.hessian);
        if let Some(return_segments) = &trial.return_segments {
            let (distance, clock) = &trial.joining;
            let mut lateness = [0.0; MAX_VARIABLES];
            for i in 0..all {
                unreduced.gradient[i] +=
                    return_segments.by_time * clock[i] + return_segments.by_distance * distance[i];
                lateness[i] = clock[i] - return_segments.slowness * distance[i];
            }
            for i in 0..all {
                for k in 0..=i {
                    unreduced.hessian[i][k] +=
                        return_segments.curvature_along * lateness[i] * lateness[k];
                }
            }
        }
        unreduced
    }

    /// Residuals of a point whose nearest desired position is `distance` along the path, on `leg`.
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

    /// Rates of the slack at an approach.
    pub(crate) fn approach_row(&self, trial: &Trial, approach: &Approach) -> Row {
        let of = approach.rates;
        let rollout = &trial.rollout;
        match (
            rollout.place(approach.leg, approach.fraction),
            rollout.legs[approach.leg].owner,
        ) {
            (Some(place), _) => rollout.rates(&place, of),
            (None, SegmentOrigin::ReturnSegments { index }) => {
                let (by_distance, by_time) = self.return_segment_rates(rollout, index, approach);
                let mut row = [0.0; MAX_VARIABLES];
                let (distances, clocks) = &trial.joining;
                for (to, (distance, clock)) in row.iter_mut().zip(distances.iter().zip(clocks)) {
                    *to = by_distance * distance + by_time * clock;
                }
                row
            }
            (None, SegmentOrigin::SegmentVariable { .. }) => [0.0; MAX_VARIABLES],
        }
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::Problem;
    use crate::clock::Clock;
    use crate::ship_fixtures::own_ship;
    use crate::space_time::manoeuvre::conflict::Conflict;
    use crate::space_time::manoeuvre::ending::Ending;
    use crate::space_time::piece::pieces;
    use crate::space_time::proxy::Proxy;
    use crate::space_time::refinement::InitialGuess;
    use crate::space_time::refinement::structure::SegmentVariable;
    use crate::space_time::route::Route;
    use crate::space_time::selection::initial_guess::EvasiveManoeuvre;
    use searoom_geometry::frame::{Side, Vector};
    use searoom_geometry::outer_disc;
    use searoom_model::trajectory::DesiredTrajectory;
    use searoom_sets::PolytopeObstacle;

    /// Runs a check on three manoeuvres near a target with all segment variables in use: two that
    /// return and one that ends at the goal.
    pub(crate) fn at_manoeuvres(check: impl Fn(&Context, &InitialGuess)) {
        let points = [(0.0, 0.0), (2500.0, 0.0)].map(|(x, y)| Vector::new(x, y));
        let desired = DesiredTrajectory::new(&points, &[5.0]).expect("valid");
        at_manoeuvres_along(&desired, check);
    }

    /// The same manoeuvres on a desired trajectory along the same line.
    fn at_manoeuvres_along(desired: &DesiredTrajectory, check: impl Fn(&Context, &InitialGuess)) {
        let own = own_ship(&[2.5, 5.0, 6.0]);
        let velocity = searoom_geometry::ConvexPolygon::hull(&[
            Vector::new(-4.0, 0.3),
            Vector::new(-5.0, -0.4),
        ]);
        let obstacles = [PolytopeObstacle::new(
            "x",
            outer_disc(60.0, 0.1).translated(Vector::new(1300.0, -10.0)),
            velocity.expect("finite"),
        )
        .into()];
        let problem = Problem::new(&own, desired, &obstacles, 900.0);
        let route = Route::new(&problem, Clock::new(problem.deadline)).expect("a route");
        let leg = desired.legs().len() - 1;
        let pieces = pieces(&obstacles, problem.horizon);
        let proxies = [Proxy::new(&pieces[0])];
        let context = Context::new(&problem, &route, &proxies, &[], 0.0);
        let canonical = EvasiveManoeuvre::new(0.7, 0.9, 1.0);
        let conflict = Conflict {
            from: 140.0,
            to: 180.0,
            through: 200.0,
            offsets: [80.0, 90.0],
        };
        for (side, goal) in [
            (Side::Starboard, false),
            (Side::Port, false),
            (Side::Port, true),
        ] {
            let mut guess = canonical
                .guess(&problem, &route, side, &conflict, leg)
                .expect("a guess");
            if goal {
                guess.structure.ending = Ending::Goal { side, speed: 6.0 };
            }
            for (i, variable) in guess.structure.variables.iter().enumerate() {
                guess.lengths[i] += if matches!(variable, SegmentVariable::Arc { .. }) {
                    7.0
                } else {
                    11.0
                } + i as f64;
            }
            check(&context, &guess);
        }
    }

    /// Compares every rate with central differences, also where the ordered speed changes on the run
    /// before the manoeuvre.
    #[test]
    fn rates_match_differences() {
        at_manoeuvres(|context, guess| assert!(checked_contacts(context, guess) > 0));
        let points = [0.0, 100.0, 2500.0].map(|x| Vector::new(x, 0.0));
        let desired = DesiredTrajectory::new(&points, &[2.5, 5.0]).expect("valid");
        at_manoeuvres_along(&desired, |context, guess| {
            let mut guess = guess.clone();
            assert!(checked_contacts(context, &guess) > 0);
            let run = &mut guess.structure.variables[0];
            *run = SegmentVariable::Run { speed: run.speed() };
            // at one speed own ship is too early for a contact
            checked_contacts(context, &guess);
        });
    }

    /// Number of contact rows, after every rate was compared.
    fn checked_contacts(context: &Context, guess: &InitialGuess) -> usize {
        let goal = matches!(guess.structure.ending, Ending::Goal { .. });
        let here = context
            .model(&guess.structure, &guess.lengths)
            .expect("fits");
        let contact_rows = here.rows.len() - if goal { 2 } else { 3 };
        let step = 1e-4;
        for i in 0..guess.structure.free() {
            let at = |d: f64| {
                let mut lengths = guess.lengths;
                lengths[i] += d;
                context.model(&guess.structure, &lengths).expect("fits")
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
                    "row {k} variable {i}: {found} {rate}"
                );
            }
        }
        contact_rows
    }
}
