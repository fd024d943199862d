//! Random meetings sailed in the closed loop, against what was asked for.

use searoom::document::SimulationDocument;
use searoom::frame::radians_from_deg;
use searoom::scenario::{
    Behaviour, Compliance, Noise, Scenario, Sensor, SensorKind, SimulationSettings, VesselModel,
};
use searoom::simulation::Simulation;
use searoom::target::Motion;

use crate::campaigns::encounter_generator::{EncounterKind, Meeting};
use crate::campaigns::statistics::{failure_bound, quantiles, share_cells};
use crate::campaigns::{Report, Seeds, meetings};

/// Motion of a target.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Truth {
    /// Keeps course and speed
    Constant,
    /// Another random course and speed within its spreads every 20 s
    Random,
    /// Another extreme course and speed within its spreads every 20 s
    Extremes,
    /// The course and speed within its spreads that come nearest
    Pursuit,
    /// Turns 40 degrees to starboard 300 s before the closest approach
    GivesWay,
    /// Turns 40 degrees to starboard 120 s before
    GivesWayLate,
    /// Turns 40 degrees to port 120 s before
    TurnsToPort,
    /// Plans as own ship does
    Mutual,
}

/// Own ship's sensor.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Seen {
    /// The truth
    Exact,
    /// Every 4 s with 12 m, 6 degrees and 0.5 m/s
    Noise,
    /// AIS class A with drop-outs of 60 s every 300 s
    Ais,
    /// A position every 3 s with 20 m
    Radar,
}

/// How own ship moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Ship {
    /// Exactly on its plan
    Kinematic,
    /// With a time constant
    FirstOrder,
    /// With a rudder
    Nomoto,
}

/// How the meetings are sailed.
#[derive(Debug, Clone, Copy)]
pub struct How {
    pub truth: Truth,
    /// The spreads of extreme and random targets are exceeded by this factor.
    pub factor: f64,
    pub seen: Seen,
    pub ship: Ship,
    /// False where own ship sails its first plan to the end.
    pub replan: bool,
    /// Degrees: how much farther to starboard each target may steer, as own ship assumes.
    pub starboard_turn: f64,
    pub compliance: Compliance,
    /// Seconds of reports before t = 0.
    pub settle: f64,
    /// Root of the spectral density of the acceleration that the tracker assumes, m/s^1.5.
    pub acceleration: f64,
}

impl How {
    /// Targets do what the sets allow, and are seen as they are.
    pub fn keeps_assumption(&self) -> bool {
        let within = matches!(
            self.truth,
            Truth::Constant | Truth::Random | Truth::Extremes | Truth::Pursuit
        );
        let turns = matches!(self.truth, Truth::GivesWay | Truth::GivesWayLate);
        (within || turns && self.starboard_turn >= 40.0)
            && self.factor <= 1.0
            && self.seen == Seen::Exact
            && self.ship == Ship::Kinematic
    }

    fn behaviour(&self) -> Behaviour {
        let factor = self.factor;
        let turns = |degrees: f64, before: f64| Behaviour::GivesWay {
            turn: radians_from_deg(degrees),
            before,
            probability: 1.0,
            turn_rate: radians_from_deg(2.0),
        };
        let every = 20.0;
        match self.truth {
            Truth::Constant => Behaviour::Constant,
            Truth::Random => Behaviour::Random { every, factor },
            Truth::Extremes => Behaviour::Extremes { every, factor },
            Truth::Pursuit => Behaviour::Pursuit { every: 5.0 },
            Truth::GivesWay => turns(40.0, 300.0),
            Truth::GivesWayLate => turns(40.0, 120.0),
            Truth::TurnsToPort => turns(-40.0, 120.0),
            Truth::Mutual => Behaviour::Mutual,
        }
    }

    fn sensor(&self) -> Sensor {
        let noise = |position: f64, course: f64, speed: f64| Noise {
            position,
            course: radians_from_deg(course),
            speed,
        };
        let with = |kind, noise, interval| Sensor {
            kind,
            noise,
            assumed: noise,
            interval,
            acceleration: self.acceleration,
            settle: self.settle,
            stale: 180.0,
            ..Sensor::EXACT
        };
        let ais = SensorKind::Ais { class_a: true };
        match self.seen {
            Seen::Exact => Sensor::EXACT,
            Seen::Noise => with(ais, noise(12.0, 6.0, 0.5), Some(4.0)),
            Seen::Ais => Sensor {
                dropout_every: 300.0,
                dropout_lasts: 60.0,
                ..with(ais, noise(10.0, 2.0, 0.3), None)
            },
            Seen::Radar => with(SensorKind::Radar, noise(20.0, 0.0, 0.0), Some(3.0)),
        }
    }

    fn vessel(&self) -> VesselModel {
        match self.ship {
            Ship::Kinematic => VesselModel::Kinematic,
            Ship::FirstOrder => VesselModel::FirstOrder {
                course_time: 3.0,
                speed_time: 5.0,
            },
            Ship::Nomoto => VesselModel::Nomoto {
                gain: 1.0,
                time: 1.0,
                rudder: radians_from_deg(35.0),
                rudder_rate: radians_from_deg(5.0),
                speed_time: 5.0,
            },
        }
    }

    /// Adds the settings of the loop to a scenario, and for a ship that is steered a margin.
    pub fn equip(&self, scenario: &mut Scenario, seed: u64) {
        scenario.compliance = self.compliance;
        if self.ship != Ship::Kinematic {
            scenario.own_ship.tracking_margin = 0.5 * scenario.own_ship.safety_margin;
        }
        for target in &mut scenario.targets {
            if let Motion::Ship(ship) = &mut target.motion {
                ship.starboard_turn = radians_from_deg(self.starboard_turn);
            }
        }
        scenario.simulation = SimulationSettings {
            seed,
            replan: if self.replan { 20.0 } else { scenario.horizon },
            vessel: Some(self.vessel()),
            sensor: self.sensor(),
            behaviours: vec![self.behaviour(); scenario.targets.len()],
            ..SimulationSettings::default()
        };
    }
}

/// Sails a scenario to its end.
pub fn sail(scenario: Scenario) -> SimulationDocument {
    let mut simulation = Simulation::new(scenario, false).expect("a scenario for the loop");
    while !simulation.finished() {
        simulation.step();
    }
    simulation.record()
}

/// Random meetings of all kinds, `seeds` of each.
pub fn run(seeds: Seeds, meeting: &Meeting, how: &How) -> Report {
    let mut report = Report::default();
    println!("{seeds:?} of each kind, {how:?}\n");
    println!(
        "| kind | contacts | at most | both judges | at least | remainders lost | unsafe plans | without a plan | outside the set | least clearance, m | ≥ 0.5 L | turns 50/95 %/most | speeds 50/95 %/most | replaced | other side | J / J of the first plan 50/95 % | off plan, m | plans | plan 50/99 %/most, ms |"
    );
    println!("|{}", " --- |".repeat(19));
    let mut costs = Vec::new();
    for kind in EncounterKind::ALL {
        let all = meetings(kind, seeds.clone(), meeting, |mut scenario, seed| {
            how.equip(&mut scenario, seed);
            sail(scenario)
        });
        costs.extend(row(kind.name(), &all, how, &mut report));
    }
    let median = quantiles(&costs, [0.5], 2);
    println!("\nJ / J of the first plan, all kinds, 50 %: {median}\n");
    report
}

/// Prints the row of a kind, and returns J of each run over that of its first plan.
fn row(name: &str, all: &[(u64, SimulationDocument)], how: &How, report: &mut Report) -> Vec<f64> {
    let count = |of: &dyn Fn(&SimulationDocument) -> usize| -> usize {
        all.iter().map(|(_, sailed)| of(sailed)).sum()
    };
    let values = |of: &dyn Fn(&SimulationDocument) -> f64| -> Vec<f64> {
        all.iter().map(|(_, sailed)| of(sailed)).collect()
    };
    let contacts = count(&|s| usize::from(s.contact));
    let content = count(&|s| usize::from(s.conduct.breaks.is_empty()));
    let clearance = |s: &SimulationDocument| {
        let targets = s.targets.iter();
        let least = targets.map(|t| t.least_clearance_m.unwrap_or(f64::NEG_INFINITY));
        least.fold(f64::INFINITY, f64::min)
    };
    let wide = count(&|s| {
        let lengths = s.targets.iter().map(|t| t.length_m);
        let length = lengths.fold(s.settings.own_length_m, f64::max);
        usize::from(clearance(s) >= 0.5 * length)
    });
    let lost = count(&|s| s.conduct.lost_remainders);
    let bad = count(&|s| s.conduct.unsafe_plans);
    let without = count(&|s| s.conduct.without_plan);
    let outside = count(&|s| s.targets.iter().map(|t| t.outside_sets).sum());
    let cost = |s: &SimulationDocument| {
        s.conduct.cost_m2 / s.conduct.first_plan_cost_m2.unwrap_or(f64::NAN).max(1.0)
    };
    let costs = values(&cost);
    let later = |s: &SimulationDocument| s.timing.plan_s.iter().skip(1).map(|t| t * 1e3).collect();
    let times: Vec<f64> = all
        .iter()
        .flat_map(|(_, s)| -> Vec<f64> { later(s) })
        .collect();
    let slowest = |s: &SimulationDocument| later(s).into_iter().fold(0.0, f64::max);
    let slowest = (all.iter()).max_by(|a, b| slowest(&a.1).total_cmp(&slowest(&b.1)));
    let speed_changes = values(&|s| s.conduct.speed_changes as f64);
    let bound = 100.0 * failure_bound(contacts, all.len());
    let cells = [
        format!("{contacts}/{} | {bound:.2} %", all.len()),
        share_cells(content, all.len()),
        [lost, bad, without, outside]
            .map(|count| count.to_string())
            .join(" | "),
        quantiles(&values(&clearance), [0.0], 1),
        format!("{:.2} %", 100.0 * wide as f64 / all.len() as f64),
        quantiles(&values(&|s| s.conduct.turns as f64), [0.5, 0.95, 1.0], 0),
        quantiles(&speed_changes, [0.5, 0.95, 1.0], 0),
        count(&|s| s.conduct.replaced_manoeuvres).to_string(),
        count(&|s| s.conduct.side_switches).to_string(),
        quantiles(&costs, [0.5, 0.95], 2),
        quantiles(&values(&|s| s.conduct.largest_off_plan_m), [1.0], 1),
        count(&|s| s.replans.len()).to_string(),
        quantiles(&times, [0.5, 0.99, 1.0], 1),
    ];
    println!("| {name} | {} |", cells.join(" | "));
    if how.keeps_assumption() {
        for (what, found) in [
            ("contacts", contacts),
            ("remainders lost", lost),
            ("unsafe plans", bad),
            ("cycles without a plan", without),
            ("targets outside their sets", outside),
        ] {
            report.require(found == 0, || format!("{name}: {found} {what}"));
        }
    }
    let named = all.iter().flat_map(|(seed, sailed)| {
        let flags = [
            (sailed.contact, "contact"),
            (sailed.conduct.lost_remainders > 0, "remainder lost"),
            (sailed.conduct.unsafe_plans > 0, "unsafe"),
            (sailed.conduct.without_plan > 0, "without a plan"),
            (sailed.conduct.side_switches > 0, "other side"),
            (!sailed.arrived, "not arrived"),
        ];
        let flags = flags
            .into_iter()
            .filter_map(|(is, word)| is.then_some(word));
        let breaks = sailed.conduct.breaks.iter().map(String::as_str);
        flags.chain(breaks).map(|word| (word, *seed))
    });
    let slowest = slowest.map(|(seed, _)| ("slowest plan", *seed));
    Report::print_seeds(name, named.chain(slowest));
    costs
}
