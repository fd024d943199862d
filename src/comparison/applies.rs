//! Which methods a scenario can be sailed with.

use super::Method;
use crate::planner::{PlannerKind, SearchKind};
use crate::scenario::Scenario;
use crate::target::{Motion, Representation, Target};

/// Own length over that of the ship whose forces are known, or the other way round, at most.
const ALIKE: f64 = 1.5;

/// A method that a scenario has no use for.
#[derive(Debug, Clone, PartialEq)]
pub struct Inapplicable {
    /// Which.
    pub method: Method,
    /// In words.
    pub reason: String,
}

/// What applies, in the order of the rows, and what does not.
#[derive(Debug, Clone, PartialEq)]
pub struct Methods {
    /// These can be run.
    pub methods: Vec<Method>,
    /// These cannot, and why.
    pub inapplicable: Vec<Inapplicable>,
}

/// Every method, as it applies to a scenario. Polytopes and ellipsoids are two methods where a target can be given as either;
/// optimal control applies where the scenario asks for it, or where own ship is as long as the ship whose forces
/// it would plan.
pub fn methods(scenario: &Scenario) -> Methods {
    let representations: &[Option<Representation>] = if scenario.targets.iter().any(has_choice) {
        &[
            Some(Representation::Polytope),
            Some(Representation::Ellipsoid),
        ]
    } else {
        &[None]
    };
    let planner = |kind, search, representation| Method::Planner {
        kind,
        search,
        representation,
    };
    let mut all = Vec::new();
    for &representation in representations {
        for search in [SearchKind::AStar, SearchKind::Dijkstra] {
            all.push(planner(PlannerKind::SpaceTime, search, representation));
        }
    }
    for &representation in representations {
        all.push(planner(
            PlannerKind::PathTime,
            SearchKind::AStar,
            representation,
        ));
    }
    // its sets are ellipsoids, whatever they are made from
    all.push(planner(
        PlannerKind::OptimalControl,
        SearchKind::AStar,
        None,
    ));
    all.extend([Method::HoldCourse, Method::ConstantVelocity]);
    let mut found = Methods {
        methods: Vec::new(),
        inapplicable: Vec::new(),
    };
    for method in all {
        match reason_against(method, scenario) {
            None => found.methods.push(method),
            Some(reason) => found.inapplicable.push(Inapplicable { method, reason }),
        }
    }
    found
}

/// True for what is neither given as ellipses nor in several sets.
fn has_choice(target: &Target) -> bool {
    match &target.motion {
        Motion::Ship(ship) => ship.turn_rate == 0.0,
        Motion::Sets { .. } => true,
        Motion::Ellipses { .. } | Motion::Spells { .. } => false,
    }
}

fn reason_against(method: Method, scenario: &Scenario) -> Option<String> {
    let Method::Planner { kind, .. } = method else {
        return None;
    };
    let faults = method.asked(scenario).unfit();
    if !faults.is_empty() {
        let faults: Vec<String> = faults
            .iter()
            .map(|fault| format!("{}: {}", fault.path, fault.found))
            .collect();
        return Some(faults.join("; "));
    }
    let vessel = scenario.control.vessel;
    let ratio = scenario.own_ship.hull.length / vessel.length();
    let alike = (ALIKE.recip()..=ALIKE).contains(&ratio);
    let forced = kind == PlannerKind::OptimalControl && scenario.planner != kind;
    (forced && !alike).then(|| {
        format!(
            "own ship is {} m long, {}, whose forces are known, {:.3} m (planner.optimal_control.vessel)",
            scenario.own_ship.hull.length,
            vessel.word(),
            vessel.length()
        )
    })
}
