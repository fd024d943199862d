//! Plans made again and again from own ship's state on the last one, and the sailed motion judged.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom::colregs::{
    SteadyShip, Thresholds,
    compliance::{ComplianceReport, EncounterSamples},
};
use searoom::frame::{Vector, direction};
use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline::{self, Run};
use searoom::planner::PlannedManoeuvre;
use searoom::planner::cost::whole_space_time_error;
use searoom::replanning::{PreviousPlan, remember};
use searoom::scenario::{Memory, Scenario};
use searoom::target::{Motion, ShipTrack};
use searoom::tolerance::{SIGMAS, TOUCH_M};
use searoom::trajectory::Segment;

use crate::campaigns::encounter_generator::{EncounterKind, Meeting};
use crate::campaigns::statistics::{quantiles, share_cells};
use crate::campaigns::{Report, Seeds, meetings};

/// Seconds from one plan to the next.
pub const STEP_S: f64 = 20.0;

/// Least share of sailed motions with which both judges are content, of targets that keep course
/// and speed.
const CONTENT: f64 = 0.98;

/// Seconds after which a run ends.
const LONGEST_S: f64 = 3000.0;

/// Motion of a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Behaviour {
    /// Keeps course and speed
    Constant,
    /// Takes another extreme course and speed within its spreads in each cycle; the scenario has
    /// the middle of them
    Extreme,
    /// Turns 40 degrees to starboard, out of its spread, 120 s after the start
    Turns,
}

impl Behaviour {
    /// Course and speed of a target in the cycle that begins at a time.
    fn moved(self, ship: &ShipTrack, time: f64, rng: &mut ChaCha8Rng) -> (f64, f64) {
        let mut extreme = |spread: f64| {
            if rng.random_bool(0.5) {
                spread
            } else {
                -spread
            }
        };
        let (heading, speed) = (ship.pose.heading, ship.speed);
        match self {
            _ if time == 0.0 => (heading, speed),
            Self::Constant => (heading, speed),
            Self::Extreme => (
                heading + extreme(ship.course_spread),
                (speed + extreme(ship.speed_spread)).max(0.0),
            ),
            Self::Turns if time >= 120.0 => (heading - 40_f64.to_radians(), speed),
            Self::Turns => (heading, speed),
        }
    }
}

/// How the encounters are sailed.
#[derive(Debug, Clone, Copy)]
pub struct How {
    pub behaviour: Behaviour,
    /// Own ship is up to this far off its plan when the next is made: its tracking margin, metres.
    pub off: f64,
    /// True where the targets are measured anywhere within three standard deviations.
    pub noise: bool,
    /// False where every plan begins anew.
    pub memory: bool,
}

impl How {
    /// Own ship on its plan among targets that keep course and speed and are seen as they are.
    pub const STEADY: Self = Self {
        behaviour: Behaviour::Constant,
        off: 0.0,
        noise: false,
        memory: true,
    };
}

/// Result of one encounter.
pub struct Sailed {
    pub seed: u64,
    /// Rules and monitors that the sailed motion breaks.
    pub broken: Vec<&'static str>,
    /// Rules and monitors that the first plan breaks.
    pub broken_by_the_first: usize,
    /// Least distance of the hulls, metres.
    pub apart: f64,
    pub turns: usize,
    pub speed_changes: usize,
    /// Cost of the sailed motion over that of the first plan.
    pub cost: f64,
    pub cycles: usize,
    /// Cycles without a safe plan, and cycles of a plan that is not by the rules.
    pub unsafe_plans: usize,
    pub relaxed: usize,
    /// Cycles after which the plan turns back, though a manoeuvre was under way.
    pub turned_back: usize,
    /// Cycles in which the remainder of the last plan enters a hard set.
    pub lost: usize,
    /// Cycles whose plan is dearer than the remainder of the last one, which is clear, but breaks
    /// more rules by the judges.
    pub dearer: usize,
    pub milliseconds: Vec<f64>,
}

/// The scenario `elapsed` seconds after its beginning, own ship on a plan made `step` before, the
/// target as it is then.
fn later(
    first: &Scenario,
    run: &Run,
    (elapsed, step): (f64, f64),
    now: SteadyShip,
    how: &How,
    rng: &mut ChaCha8Rng,
) -> Option<Scenario> {
    let plan = run.planned.outcome.plan()?;
    let mut scenario = first.clone();
    scenario.time = elapsed;
    scenario.desired = first.desired.remaining(elapsed);
    scenario.own_ship.pose = plan.trajectory.pose_at(step);
    scenario.own_ship.pose.position += within(how.off, rng);
    if let Motion::Ship(ship) = &mut scenario.targets[0].motion {
        ship.pose.position = now.pose.position;
        if how.noise {
            ship.pose.position += within(SIGMAS * ship.position_std, rng);
        }
        if how.behaviour != Behaviour::Extreme {
            (ship.pose.heading, ship.speed) = (now.pose.heading, now.speed);
        }
    }
    if how.memory {
        remember(&PreviousPlan::of(run)?, &mut scenario).expect("it fits");
    }
    Some(scenario)
}

/// A place in the disc of a radius, metres.
fn within(radius: f64, rng: &mut ChaCha8Rng) -> Vector {
    if radius == 0.0 {
        return Vector::zeros();
    }
    let angle = rng.random_range(0.0..std::f64::consts::TAU);
    direction(angle) * radius * rng.random_range(0.0_f64..1.0).sqrt()
}

/// True where the remainder of the last plan enters a hard set.
fn is_lost(run: &Run) -> bool {
    let enters = |s: &Segment| {
        let mut hard = run.targets.iter().map(|target| &target.sets.hard);
        hard.any(|set| set.first_contact(s, TOUCH_M).is_some())
    };
    run.scenario.memory.remainder.iter().any(enters)
}

/// True for a plan that costs more than the remainder of the last plan, though that is clear of the
/// same sets.
fn is_dearer(run: &Run) -> bool {
    let (scenario, remainder) = (&run.scenario, &run.scenario.memory.remainder);
    let enters = |s: &Segment| {
        run.obstacles()
            .any(|o| o.first_contact(s, TOUCH_M).is_some())
    };
    let Some(plan) = run.planned.outcome.plan() else {
        return false;
    };
    let cost = whole_space_time_error(&scenario.desired, remainder, scenario.time_weight);
    !remainder.is_empty() && !remainder.iter().any(enters) && plan.cost > cost * (1.0 + 1e-9) + 1e-6
}

/// Sails one encounter; `None` without a plan.
pub fn sail(first: &Scenario, seed: u64, how: &How) -> Option<Sailed> {
    let mut run = pipeline::run(first.clone());
    let plan = run.planned.outcome.plan()?;
    let first_cost = plan.cost;
    let (own, ship) = (&first.own_ship, first.targets[0].ship().expect("a ship"));
    let judged = |sailed: &[Segment], track: &[(f64, SteadyShip)]| {
        let meeting = EncounterSamples::of_tracks(sailed, own, track, ship.hull);
        ComplianceReport::judge(&meeting, Thresholds::standard())
    };
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let mut now = SteadyShip::new(ship.pose, ship.speed);
    let alone = [(0.0, now)];
    let mut track: Vec<(f64, SteadyShip)> = Vec::new();
    let mut sailed = Sailed {
        seed,
        broken: Vec::new(),
        broken_by_the_first: judged(plan.trajectory.segments(), &alone).broken().count(),
        apart: f64::INFINITY,
        turns: 0,
        speed_changes: 0,
        cost: 0.0,
        cycles: 0,
        unsafe_plans: 0,
        relaxed: 0,
        turned_back: 0,
        lost: 0,
        dearer: 0,
        milliseconds: Vec::new(),
    };
    let mut motion: Vec<Segment> = Vec::new();
    let mut elapsed = 0.0;
    loop {
        let plan = run.planned.outcome.plan()?;
        let end = plan.trajectory.end_time();
        let step = STEP_S.min(end);
        let done = plan.trajectory.segments().iter();
        let done = done.filter(|s| s.start_time < step).map(|s| Segment {
            start_time: s.start_time + elapsed,
            ..s.between(s.start_time, step)
        });
        motion.extend(done);
        // the target alters course and speed where a plan is made
        let (heading, speed) = how.behaviour.moved(ship, elapsed, &mut rng);
        now.pose.heading = heading;
        now.speed = speed;
        track.push((elapsed, now));
        now.pose.position += now.velocity() * step;
        elapsed += step;
        if end <= STEP_S || elapsed >= LONGEST_S {
            break;
        }
        let scenario = later(first, &run, (elapsed, step), now, how, &mut rng)?;
        let begun = scenario.memory.under_way;
        let next = pipeline::run(scenario);
        sailed.cycles += 1;
        sailed.milliseconds.push(next.plan_time.as_secs_f64() * 1e3);
        sailed.unsafe_plans += usize::from(!next.safe());
        sailed.relaxed += usize::from(!next.relaxations.is_empty());
        // a return may end earlier
        let begun = begun.filter(|begun| !begun.is_returning);
        let goes_on = |m: &PlannedManoeuvre| begun.is_none_or(|b| b.begins == m.begins);
        let goes_on = next.planned.manoeuvres.first().is_some_and(goes_on);
        sailed.turned_back += usize::from(begun.is_some() && !goes_on);
        sailed.lost += usize::from(is_lost(&next));
        sailed.dearer += usize::from(is_dearer(&next));
        run = next;
    }
    let cost = whole_space_time_error(&first.desired, &motion, first.time_weight);
    sailed.cost = cost / first_cost.max(1.0);
    let report = judged(&motion, &track);
    sailed.broken = report.broken().collect();
    if let Some(manoeuvre) = report.manoeuvre {
        sailed.turns = manoeuvre.turns;
        sailed.speed_changes = manoeuvre.speed_changes;
    }
    sailed.apart = report.monitors[0].robustness.unwrap_or(f64::INFINITY);
    Some(sailed)
}

/// Encounters with one target: `seeds` of each kind.
pub fn run(seeds: Seeds, meeting: &Meeting, how: &How) -> Report {
    let behaviour = how.behaviour;
    let mut report = Report::default();
    println!("{seeds:?} of each kind, a plan every {STEP_S} s, targets: {behaviour:?}\n");
    println!(
        "| kind | both judges | at least | first plan | least apart, m | turns 50/95 %/most | speeds 50/95 %/most | J / J of the first plan 50/95 % | cycles | unsafe | relaxed | turned back | remainder lost | dearer | plan 50/99 %, ms |"
    );
    println!("|{}", " --- |".repeat(15));
    for kind in EncounterKind::ALL {
        let name = kind.name();
        let all = meetings(kind, seeds.clone(), meeting, |mut scenario, seed| {
            scenario.memory = Memory::default();
            scenario.own_ship.tracking_margin = how.off;
            sail(&scenario, seed, how)
        });
        let lost = all.iter().filter(|(_, s)| s.is_none()).count();
        report.require(lost == 0, || format!("{name}: {lost} without a plan"));
        let all: Vec<Sailed> = all.into_iter().filter_map(|(_, sailed)| sailed).collect();
        let values = |of: &dyn Fn(&Sailed) -> f64| all.iter().map(of).collect::<Vec<f64>>();
        let sum = |of: &dyn Fn(&Sailed) -> usize| all.iter().map(of).sum::<usize>();
        let content = all.iter().filter(|s| s.broken.is_empty()).count();
        let first = all.iter().filter(|s| s.broken_by_the_first == 0).count();
        let times: Vec<f64> = all.iter().flat_map(|s| s.milliseconds.clone()).collect();
        let counts = [
            sum(&|s| s.cycles),
            sum(&|s| s.unsafe_plans),
            sum(&|s| s.relaxed),
            sum(&|s| s.turned_back),
            sum(&|s| s.lost),
            sum(&|s| s.dearer),
        ];
        let [cycles, unsafe_plans, _, turned_back, lost, dearer] = counts;
        let cells = [
            share_cells(content, all.len()),
            first.to_string(),
            quantiles(&values(&|s| s.apart), [0.0], 1),
            quantiles(&values(&|s| s.turns as f64), [0.5, 0.95, 1.0], 0),
            quantiles(&values(&|s| s.speed_changes as f64), [0.5, 0.95, 1.0], 0),
            quantiles(&values(&|s| s.cost), [0.5, 0.95], 2),
            counts.map(|count| count.to_string()).join(" | "),
            quantiles(&times, [0.5, 0.99], 1),
        ];
        println!("| {name} | {} |", cells.join(" | "));
        // noise moves the targets across the limits of the rules
        let is_known = behaviour == Behaviour::Constant && !how.noise;
        if is_known {
            report.content(name, CONTENT, content, all.len());
            report.require(5000 * turned_back <= cycles, || {
                format!("{name}: {turned_back} manoeuvres are begun again")
            });
            report.require(1000 * dearer <= cycles, || {
                format!("{name}: {dearer} plans are dearer than the remainder")
            });
        }
        if behaviour != Behaviour::Turns {
            report.require(lost == 0 || !how.memory, || {
                format!("{name}: {lost} remainders are no longer clear")
            });
            report.require(unsafe_plans == 0, || {
                format!("{name}: {unsafe_plans} unsafe plans")
            });
        }
        let named = all.iter().flat_map(|s| {
            let turned_back = (s.turned_back > 0).then_some("turned back");
            let unsafe_plan = (s.unsafe_plans > 0).then_some("unsafe");
            let broken = s.broken.iter().copied();
            let named = broken.chain(turned_back).chain(unsafe_plan);
            named.map(|what| (what, s.seed))
        });
        Report::print_seeds(name, named);
    }
    println!();
    report
}
