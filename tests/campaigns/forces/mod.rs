//! The optimal-control planner on random scenes and from random starts.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use searoom::obstacle::Obstacle;
use searoom::pipeline::{self, Run};
use searoom::planner::optimal_control::{
    Controls, KeepOut, Settings, StartAttempt, Task, attempt, plan,
};
use searoom::planner::{ControlSettings, Outcome};
use searoom::scenario::Scenario;
use searoom::trajectory::{ForceNode, Steered};
use searoom::vessel::{CyberShip2, ForceVector, Manoeuvring, StateVector, VesselKind};

use super::Report;
use super::statistics::spread;

pub mod scenes;

/// Least `g - 1` of any set along the cubics, with the given number of samples per interval.
fn least_margin(motion: &Steered, keep_outs: &[KeepOut]) -> f64 {
    const LOOKS: usize = 300;
    let mut least = f64::INFINITY;
    for piece in motion.pieces() {
        for look in 0..=LOOKS {
            let part = look as f64 / LOOKS as f64;
            let time = piece.start_time + part * piece.duration;
            let place = piece.position(part);
            for keep in keep_outs {
                least = least.min(keep.at(time).level(place) - 1.0);
            }
        }
    }
    least
}

/// Largest defect of any component, in metres, radians, m/s and rad/s. Integrates the ship from
/// every node to the next with the Runge–Kutta method in 500 steps.
fn largest_defect(motion: &Steered) -> f64 {
    const STEPS: usize = 500;
    let ship = CyberShip2::EXACT;
    let state = |n: &ForceNode| {
        let place = n.pose.position;
        let velocity = n.velocity;
        StateVector::new(
            place.x,
            place.y,
            n.pose.heading,
            velocity.x,
            velocity.y,
            n.yaw_rate,
        )
    };
    let mut largest = 0.0_f64;
    for pair in motion.nodes().windows(2) {
        let force = ForceVector::new(pair[0].force.x, pair[0].force.y, pair[0].moment);
        let h = (pair[1].time - pair[0].time) / STEPS as f64;
        let mut x = state(&pair[0]);
        for _ in 0..STEPS {
            let a = ship.rates(&x, &force);
            let b = ship.rates(&(x + 0.5 * h * a), &force);
            let c = ship.rates(&(x + 0.5 * h * b), &force);
            let d = ship.rates(&(x + h * c), &force);
            x += h / 6.0 * (a + 2.0 * b + 2.0 * c + d);
        }
        largest = largest.max((x - state(&pair[1])).amax());
    }
    largest
}

/// Plans of scenes with three ellipsoids and as many with six, each directed at own ship: the
/// motion is the ship's, and clear between the nodes.
pub fn run_scenes(count: usize) -> Report {
    let mut report = Report::default();
    let desired = scenes::desired();
    let own = scenes::own_ship();
    for ellipsoids in [3, 6] {
        let (mut defect, mut margin) = (0.0_f64, f64::INFINITY);
        let (mut most_intervals, mut times) = (0, Vec::new());
        for keep_outs in scenes::random_scenes(count, ellipsoids) {
            let obstacles: Vec<Obstacle> =
                keep_outs.iter().map(|k| k.set().clone().into()).collect();
            let problem = scenes::problem(&own, &desired, &obstacles);
            let begun = std::time::Instant::now();
            let found = plan(&problem, &ControlSettings::of(VesselKind::CyberShip2));
            times.push(begun.elapsed().as_secs_f64() * 1e3);
            let Outcome::Solved(plan) = &found.outcome else {
                report
                    .missed
                    .push(format!("{ellipsoids} ellipsoids: {:?}", found.outcome));
                continue;
            };
            let motion = plan.trajectory.steered().expect("forces");
            defect = defect.max(largest_defect(motion));
            margin = margin.min(least_margin(motion, &keep_outs));
            most_intervals = most_intervals.max(found.control.expect("forces").intervals);
        }
        println!(
            "{ellipsoids} ellipsoids: {count} scenes have a plan; off at the end of an interval by \
             {defect:.1e} at most (m, rad, m/s, rad/s); g - 1 is {margin:.1e} at least between the \
             nodes; up to {most_intervals} intervals"
        );
        println!("  planning, ms  {}", spread(&times));
        report.require(defect <= 1e-4, || {
            format!("{ellipsoids} ellipsoids: defect {defect:e}")
        });
        report.require(margin >= -1e-4, || {
            format!("{ellipsoids} ellipsoids: margin {margin:e}")
        });
    }
    report
}

/// Repeats the problem of a run for the smooth ship model, on the grid of its plan.
fn objectives_of_wandering_starts<V: Manoeuvring>(
    run: &Run,
    vessel: &V,
    starts: usize,
) -> Vec<f64> {
    let (scenario, control) = (&run.scenario, &run.scenario.settings.optimal_control);
    let keep_outs: Vec<KeepOut> = run.obstacles().map(KeepOut::outer_of).collect();
    let own = &scenario.own_ship;
    let (place, heading) = (own.pose.position, own.pose.heading);
    let task = Task {
        vessel,
        controls: Controls::from(control),
        desired: &scenario.desired,
        keep_outs: &keep_outs,
        first: StateVector::new(place.x, place.y, heading, own.speed, 0.0, 0.0),
        start_time: 0.0,
        duration: scenario.horizon,
        intervals: run.planned.control.as_ref().expect("forces").intervals,
    };
    let mut rng = ChaCha8Rng::seed_from_u64(1);
    (0..starts)
        .map(|_| scenes::wandering(&task, &mut rng))
        .map(|guess| attempt(&task, &guess, &Settings::default(), &|| true))
        .filter(StartAttempt::is_feasible)
        .map(|found| found.objective)
        .collect()
}

/// Every scenario in the repository that uses this planner.
fn shipped() -> Vec<(String, String)> {
    let mut folders = vec![std::path::PathBuf::from("scenarios")];
    let mut found = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|e| e == "toml") {
                let text = std::fs::read_to_string(&path).expect("reads");
                if text.contains("kind = \"optimal-control\"") {
                    found.push((path.display().to_string(), text));
                }
            }
        }
    }
    found.sort();
    found
}

/// Random starts on the plan's own grid, for every shipped scenario of this planner: none finds a
/// cheaper plan.
pub fn run_starts(starts: usize) -> Report {
    let mut report = Report::default();
    let shipped = shipped();
    report.require(shipped.len() >= 2, || {
        format!("{} scenarios", shipped.len())
    });
    for (file, text) in shipped {
        let patient = text.replace("[planner]", "[planner]\ndeadline_s = 300.0");
        let run = pipeline::run(Scenario::parse(&patient).expect("valid"));
        let plan = run.planned.outcome.plan().expect("a plan").cost;
        let vessel = CyberShip2::SMOOTH.at_length(run.scenario.own_ship.hull.length);
        let found = objectives_of_wandering_starts(&run, &vessel, starts);
        let best = found.iter().copied().fold(f64::INFINITY, f64::min);
        println!(
            "{file}: stage cost {plan:.6}; {} of {starts} wandering starts lead to a plan, the best of them to {best:.6}",
            found.len()
        );
        report.require(found.len() * 2 > starts, || {
            format!("{file}: {} plans", found.len())
        });
        report.require(plan <= best * (1.0 + 1e-3), || {
            format!("{file}: {plan} {best}")
        });
    }
    report
}
