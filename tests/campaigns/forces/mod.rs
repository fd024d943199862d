//! The optimal-control planner on random scenes and from random starts.

use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use searoom::evaluation::{Request, SpaceTimeSet, Steering, evaluate_steered};
use searoom::obstacle::Obstacle;
use searoom::pipeline::{self, Run};
use searoom::planner::optimal_control::{
    Controls, KeepOut, Settings, StartAttempt, Task, attempt, plan,
};
use searoom::planner::{ControlSettings, Outcome};
use searoom::scenario::Scenario;
use searoom::vessel::{CyberShip2, Manoeuvring, StateVector, VesselKind};

use super::Report;
use super::statistics::spread;

pub mod scenes;

/// Plans of scenes with three ellipsoids and as many with six, each directed at own ship: the
/// independent check finds the ship's motion, clear between the nodes.
pub fn run_scenes(count: usize) -> Report {
    let mut report = Report::default();
    let desired = scenes::desired();
    let own = scenes::own_ship();
    for ellipsoids in [3, 6] {
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
            let sets = keep_outs.iter().map(|keep| {
                let (set, name) = (keep.set(), "target");
                SpaceTimeSet::constant(name, *set.initial(), *set.velocity())
            });
            let sets: Vec<SpaceTimeSet> = sets.collect();
            let judged = evaluate_steered(
                &Request {
                    sets: &sets,
                    ..Request::new(&[], &own, &desired, scenes::DURATION)
                },
                &Steering {
                    motion: plan.trajectory.steered().expect("forces"),
                    vessel: &CyberShip2::EXACT,
                    force_limits: ControlSettings::of(VesselKind::CyberShip2).force_limits,
                    start_velocity: [own.speed, 0.0, 0.0],
                },
            );
            report.require(judged.verified(), || {
                format!("{ellipsoids} ellipsoids: {:?}", judged.violations)
            });
            most_intervals = most_intervals.max(found.control.expect("forces").intervals);
        }
        println!(
            "{ellipsoids} ellipsoids: {count} scenes, planned and checked on up to {most_intervals} \
             intervals"
        );
        println!("  planning, ms  {}", spread(&times));
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

/// Every scenario in the repository that uses this planner: file and text.
fn shipped() -> impl Iterator<Item = (String, String)> {
    let folders = std::fs::read_dir("scenarios").expect("a folder");
    let files = folders.filter_map(|folder| std::fs::read_dir(folder.ok()?.path()).ok());
    files.flatten().filter_map(|file| {
        let path = file.expect("an entry").path();
        let is_toml = path.extension().is_some_and(|e| e == "toml");
        let text = is_toml.then(|| std::fs::read_to_string(&path).expect("reads"))?;
        let uses_it = text.contains("kind = \"optimal-control\"");
        uses_it.then(|| (path.display().to_string(), text))
    })
}

/// Random starts on the plan's own grid, for every shipped scenario of this planner: none finds a
/// cheaper plan.
pub fn run_starts(starts: usize) -> Report {
    let mut report = Report::default();
    let shipped: Vec<_> = shipped().collect();
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
