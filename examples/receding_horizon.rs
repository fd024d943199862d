//! Receding-horizon control of CyberShip II among the ellipsoids of figure 9. Every two seconds the
//! plan shifts by one interval and is solved again from the current state. A current disturbs the
//! ship.
//!
//! ```text
//! cargo run --release --no-default-features --example receding_horizon
//! ```

use searoom::pipeline;
use searoom::planner::optimal_control::{
    KeepOut, Measured, RecedingHorizon, Settings, Task, family,
};
use searoom::scenario::Scenario;
use searoom::trajectory::TrajectoryError;
use searoom::vessel::{CyberShip2, ForceVector, Manoeuvring, StateVector};

/// Number of intervals simulated, and integrator steps per interval.
const SAILED: usize = 50;
const STEPS: usize = 20;

/// Current, east and north in m/s, unknown to the planner.
const CURRENT: [f64; 2] = [0.004, -0.003];

fn main() -> Result<(), TrajectoryError> {
    let text = include_str!("../scenarios/paper/figure_9.toml");
    let scenario = Scenario::parse(text).expect("a sound scenario");
    let sets = pipeline::sets(&scenario);
    let keep_outs: Vec<KeepOut> = sets.iter().map(|s| KeepOut::outer_of(&s.hard)).collect();
    let (own, control) = (&scenario.own_ship, &scenario.settings.optimal_control);
    let place = own.pose.position;
    let mut task = Task {
        vessel: &CyberShip2::SMOOTH,
        controls: control.into(),
        desired: &scenario.desired,
        keep_outs: &keep_outs,
        first: StateVector::new(place.x, place.y, own.pose.heading, own.speed, 0.0, 0.0),
        start_time: 0.0,
        duration: scenario.horizon,
        intervals: control.intervals,
    };
    // the last start of the family bends around the sets
    let (_, guess) = family(&task).pop().expect("some starts");
    let mut horizon = RecedingHorizon::new(&task, &guess, Settings::default(), &|| true);
    println!("time  east   north  cost to come  steps  distance to the edge of the nearest set");
    for _ in 0..SAILED {
        let plan = horizon.plan();
        let edge = keep_outs.iter().map(|keep| {
            let section = keep.set().outer_section(task.start_time);
            section
                .signed_distance(task.first.fixed_rows::<2>(0).into_owned())
                .distance
        });
        println!(
            "{:4.0}  {:5.2}  {:5.2}  {:12.3}  {:5}  {:.2} m{}",
            task.start_time,
            task.first[0],
            task.first[1],
            plan.objective,
            plan.iterations,
            edge.fold(f64::INFINITY, f64::min),
            if plan.is_feasible() {
                ""
            } else {
                ", not clear"
            }
        );
        let state = sailed(&task.first, &plan.profile.forces[0], task.step());
        let measured = Measured {
            state,
            keep_outs: &keep_outs,
        };
        task = horizon.step(&task, measured, &|| true);
    }
    Ok(())
}

/// State after `duration` seconds under constant forces with the current (Runge–Kutta, fourth
/// order).
fn sailed(from: &StateVector, force: &ForceVector, duration: f64) -> StateVector {
    let rates = |state: &StateVector| {
        let mut rates = CyberShip2::EXACT.rates(state, force);
        rates[0] += CURRENT[0];
        rates[1] += CURRENT[1];
        rates
    };
    let h = duration / STEPS as f64;
    let mut state = *from;
    for _ in 0..STEPS {
        let a = rates(&state);
        let b = rates(&(state + 0.5 * h * a));
        let c = rates(&(state + 0.5 * h * b));
        let d = rates(&(state + h * c));
        state += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
    state
}
