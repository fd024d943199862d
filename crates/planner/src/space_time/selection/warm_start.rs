//! Warm start: refines an earlier plan against new sets without a new search.

use crate::clock::Clock;
use crate::space_time::context::Context;
use crate::space_time::land;
use crate::space_time::manoeuvre::ending::Ending;
use crate::space_time::manoeuvre::motion::merged;
use crate::space_time::manoeuvre::speeds::ManoeuvreSpeeds;
use crate::space_time::proxy::{Proxy, first_contact};
use crate::space_time::refinement::InitialGuess;
use crate::space_time::refinement::quadratic::MAX_VARIABLES;
use crate::space_time::refinement::structure::SegmentVariable;
use crate::space_time::route::Route;
use crate::space_time::selection::Selection;
use crate::space_time::selection::initial_guess::InitialGuessBuilder;
use crate::space_time::{conflicts_of, plan_normalised};
use crate::{NoPlan, Outcome, Plan, PlanMethod, Planned, Problem};
use searoom_geometry::frame::{Pose, Side, wrap};
use searoom_model::trajectory::{Segment, Trajectory};

/// Distance (metres) and angle (radians) within which a pose is on the route.
const ON_ROUTE_M: f64 = 1e-3;
const ON_ROUTE_RAD: f64 = 1e-6;

/// Number of segment variables besides turns and lines: the runs and the dependent ones.
const RUNS_AND_DEPENDENTS: usize = 5;

/// Plans one problem by a warm start from a plan for other sets, whose order of turns it keeps
/// (numerical continuation).
///
/// The guarantees of [`crate::space_time::plan`] hold. Either function may find a plan
/// where the other finds none. Cost: some milliseconds, without a search. Plans with waits or with
/// very many turns give no initial guess, and then no plan. A duty of own ship is not regarded.
pub fn warm_started(problem: &Problem, from: &Trajectory) -> Planned {
    let clock = Clock::new(problem.deadline);
    plan_normalised(
        problem,
        clock,
        |problem, proxies, similarity| match similarity {
            Some(similarity) => {
                refined(problem, proxies, &similarity.motion(from.segments()), clock)
            }
            None => refined(problem, proxies, from.segments(), clock),
        },
    )
}

fn refined(problem: &Problem, proxies: &[Proxy], motion: &[Segment], clock: Clock) -> Planned {
    let found = Route::new(problem, clock).and_then(|route| {
        let guess = initial_guess_from(problem, &route, motion)?;
        let blocks = land::proxies(problem);
        let follows = route.follow(0.0, 0.0);
        let contact = first_contact(proxies, &follows).map(|(_, at)| at);
        let grounding = land::first_contact(problem.land_obstacle, &follows);
        let first = contact.into_iter().chain(grounding).reduce(f64::min);
        let context = Context::new(problem, &route, proxies, &blocks, first.unwrap_or(0.0));
        // a tidy plan has as many alterations as its conflicts need
        let conflicts = match problem.tidy {
            Some(_) => conflicts_of(problem, proxies, &follows),
            None => Vec::new(),
        };
        let mut selection =
            Selection::new(context, &problem.settings.budgets.warm_start, &conflicts);
        selection.add_initial_guess(guess);
        let timed_out = selection.refine(&[], &[], clock);
        let plan = selection.plan().map(|plan| Plan {
            method: PlanMethod::WarmStart,
            ..plan
        });
        Some((plan, timed_out))
    });
    let outcome = match found {
        Some((plan, true)) => Outcome::Deadline(plan),
        Some((Some(plan), false)) => Outcome::Solved(plan),
        _ => Outcome::Infeasible(NoPlan::NoTrajectory),
    };
    Planned::of(outcome)
}

/// Initial guess from a motion that follows the route, leaves it, and returns to it or to its end.
/// Its rollout is the motion again. Lines get the other speeds, with zero length, while there is
/// room. `None` for any other motion.
pub(crate) fn initial_guess_from(
    problem: &Problem,
    route: &Route,
    motion: &[Segment],
) -> Option<InitialGuess> {
    let motion = merged(motion);
    if motion.iter().any(|s| s.speed <= 0.0) {
        return None;
    }
    let mut run = [0.0; 3];
    let (mut left_at, mut first) = (0.0, 0);
    for s in &motion {
        let to = left_at + s.length();
        let halfway = 0.5 * (left_at + to);
        if !(is_at(route, to, s.end()) && is_at(route, halfway, s.middle())) {
            break;
        }
        let speeds = ManoeuvreSpeeds::at(problem, s.start_time);
        let ordered = route.ordered_speed(halfway);
        run[nearest(s.speed, [ordered, speeds.fast, speeds.slow])] += s.length();
        (left_at, first) = (to, first + 1);
    }
    let (mut back_at, mut join) = (route.length(), motion.len());
    while join > first {
        let from = back_at - motion[join - 1].length();
        if !is_at(route, from, motion[join - 1].start) {
            break;
        }
        (back_at, join) = (from, join - 1);
    }
    let manoeuvre = &motion[first..join];
    let leaves = manoeuvre.first().map_or(0.0, |s| s.start_time);
    let speeds = ManoeuvreSpeeds::at(problem, leaves);
    let (last, before) = manoeuvre.split_last()?;
    let (free, ending) = if join < motion.len() {
        let leg = (0..problem.desired.legs().len()).find(|leg| {
            route
                .stretch(*leg, problem.desired)
                .is_some_and(|s| (s.distance..=s.distance + s.to - s.from).contains(&back_at))
        })?;
        let free = match before.split_last() {
            Some((line, free)) if !line.is_arc() && line.speed == last.speed => free,
            _ => before,
        };
        let speed = last.speed;
        (
            last.is_arc().then_some(free)?,
            Ending::Return { leg, speed },
        )
    } else {
        let (turn, free) = before.split_last()?;
        let side = Side::of_turn(turn.turn_rate)?;
        let ends = !last.is_arc() && turn.speed == last.speed;
        let speed = last.speed;
        (ends.then_some(free)?, Ending::Goal { side, speed })
    };
    let mut room = MAX_VARIABLES.checked_sub(free.len() + RUNS_AND_DEPENDENTS)?;
    let mut builder = InitialGuessBuilder::default();
    builder.runs(&speeds, run[0], run[1], run[2]);
    for lines in free.chunk_by(|a, b| !a.is_arc() && !b.is_arc()) {
        for s in lines {
            let speed = s.speed;
            let variable = Side::of_turn(s.turn_rate)
                .map_or(SegmentVariable::Line { speed }, |side| {
                    SegmentVariable::Arc { side, speed }
                });
            builder.push(variable, s.length());
        }
        let others = [speeds.slow, speeds.normal, speeds.fast].into_iter();
        let others = others.filter(|u| lines.iter().all(|s| !s.is_arc() && s.speed != *u));
        for speed in others.take(room) {
            builder.push(SegmentVariable::Line { speed }, 0.0);
            room -= 1;
        }
    }
    builder.build(ending)
}

fn is_at(route: &Route, distance: f64, pose: Pose) -> bool {
    let there = route.pose_at(distance).0;
    (there.position - pose.position).norm() < ON_ROUTE_M
        && wrap(there.heading - pose.heading).abs() < ON_ROUTE_RAD
}

/// Index of the nearest of three speeds, the first of equals.
fn nearest(speed: f64, speeds: [f64; 3]) -> usize {
    let apart = |k: &usize| (speeds[*k] - speed).abs();
    (0..3)
        .min_by(|a, b| apart(a).total_cmp(&apart(b)))
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    use crate::ship_fixtures::own_ship;
    use crate::space_time::plan;
    use crate::space_time::refinement::structure::FLATTEST_RETURN;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use searoom_geometry::frame::{Vector, direction};
    use searoom_geometry::{ConvexPolygon, outer_disc};
    use searoom_model::trajectory::DesiredTrajectory;
    use searoom_sets::{Obstacle, PolytopeObstacle};

    /// Runs a check on problems with one to three sets that drift toward own ship's route, and their
    /// plans.
    fn at_plans(check: impl Fn(&Problem, &Trajectory, f64)) {
        let mut rng = ChaCha8Rng::seed_from_u64(77);
        let own = own_ship(&[2.5, 5.0, 6.0]);
        let route = [Vector::zeros(), Vector::new(1500.0, 0.0)];
        let desired = DesiredTrajectory::new(&route, &[5.0]).expect("valid");
        for case in 0..36 {
            let sets = (0..case % 3 + 1).map(|_| {
                let velocity = direction(rng.random_range(0.0..TAU)) * rng.random_range(1.0..6.0);
                let met = rng.random_range(60.0..220.0);
                let center = Vector::new(5.0 * met, rng.random_range(-60.0..60.0)) - velocity * met;
                let initial = outer_disc(rng.random_range(40.0..120.0), 0.0).translated(center);
                let spread = ConvexPolygon::rectangle(velocity, 0.3, 0.3);
                Obstacle::from(PolytopeObstacle::new("set", initial, spread))
            });
            let obstacles: Vec<Obstacle> = sets.collect();
            let problem = Problem::new(&own, &desired, &obstacles, 700.0);
            if let Some(found) = plan(&problem).outcome.plan() {
                check(&problem, &found.trajectory, found.cost);
            }
        }
    }

    #[test]
    fn the_initial_guess_of_a_plan_rolls_out_to_it() {
        at_plans(|problem, trajectory, _| {
            let route = Route::new(problem, Clock::new(problem.deadline)).expect("a route");
            let Some(guess) = initial_guess_from(problem, &route, trajectory.segments()) else {
                // it only follows the route, or is a detour of the hybrid A* with too many segments
                let segments = merged(trajectory.segments());
                let room = MAX_VARIABLES - RUNS_AND_DEPENDENTS;
                assert!(segments.len() > room || !segments.iter().any(Segment::is_arc));
                return;
            };
            let rollout = guess.structure.roll_out(problem, &route, &guess.lengths);
            let Some(rollout) = rollout else {
                // the return has the smallest angle, minus a rounding
                let back = trajectory.segments().iter().rev().find(|s| s.is_arc());
                let turn = back.map_or(0.0, |s| (s.turn_rate * s.duration).abs());
                assert!((turn - FLATTEST_RETURN).abs() < 1e-9, "{turn} rad");
                return;
            };
            let again = Trajectory::new(rollout.motion()).expect("valid");
            assert!((again.end_time() - trajectory.end_time()).abs() < 1e-5);
            // before that, the runs along the route may be in another order
            let turn = trajectory.segments().iter().find(|s| s.is_arc());
            let leaves = turn.map_or(0.0, |s| s.start_time);
            for k in 0..=200 {
                let time = leaves + (trajectory.end_time() - leaves) * f64::from(k) / 200.0;
                let apart = again.pose_at(time).position - trajectory.pose_at(time).position;
                assert!(apart.norm() < 1e-4, "{} m at {time} s", apart.norm());
            }
        });
    }
}
