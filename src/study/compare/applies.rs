//! The methods that apply to a scenario.

use super::Method;
use crate::planner::{PlannerKind, SearchKind};
use crate::scenario::Scenario;
use crate::target::{Motion, Representation, Target};

/// A method that does not apply.
#[derive(Debug, Clone, PartialEq)]
pub struct Inapplicable {
    /// Which.
    pub method: Method,
    /// In words.
    pub reason: String,
}

/// The methods of a scenario, in the order of the rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Methods {
    /// These can be run.
    pub methods: Vec<Method>,
    /// These cannot, and why.
    pub inapplicable: Vec<Inapplicable>,
}

/// Sorts every method into those that apply and those that do not. Polytopes and ellipsoids are two
/// methods where a target can be given as either.
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

/// True for targets that are given neither as ellipses nor by several velocity sets.
fn has_choice(target: &Target) -> bool {
    match &target.motion {
        Motion::Ship(ship) => ship.turn_rate == 0.0,
        Motion::Sets { .. } => true,
        Motion::Ellipses { .. } | Motion::Spells { .. } => false,
    }
}

fn reason_against(method: Method, scenario: &Scenario) -> Option<String> {
    let Method::Planner { .. } = method else {
        return None;
    };
    let faults = method.asked(scenario).unfit();
    let faults: Vec<String> = faults
        .iter()
        .map(|fault| format!("{}: {}", fault.path, fault.found))
        .collect();
    (!faults.is_empty()).then(|| faults.join("; "))
}
