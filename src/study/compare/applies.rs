//! Selection of the methods that apply to a scenario.

use super::Method;
use crate::planner::SearchKind;
use crate::scenario::Scenario;
use crate::target::{Motion, Representation, Target};

/// Method that does not apply.
#[derive(Debug, Clone, PartialEq)]
pub struct Inapplicable {
    /// The method.
    pub method: Method,
    /// Reason in words.
    pub reason: String,
}

/// Methods of a scenario, in the order of the rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Methods {
    /// Methods that can be run.
    pub methods: Vec<Method>,
    /// Methods that cannot be run, with the reason.
    pub inapplicable: Vec<Inapplicable>,
}

/// Sorts every method into those that apply and those that do not. If a target can be given as
/// polytopes or ellipsoids, the two representations are separate methods.
pub fn methods(scenario: &Scenario) -> Methods {
    let representations: &[Option<Representation>] = if scenario.targets.iter().any(has_choice) {
        &[
            Some(Representation::Polytope),
            Some(Representation::Ellipsoid),
        ]
    } else {
        &[None]
    };
    let mut all = Method::of_planners(representations);
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

/// True unless a target is given as ellipses or by several velocity sets.
pub(super) fn has_choice(target: &Target) -> bool {
    match &target.motion {
        Motion::Ship(ship) => ship.turn_rate == 0.0 && ship.route.is_empty(),
        Motion::Sets(sets) => sets.initial.as_polygon().is_some() && sets.velocities.len() == 1,
    }
}

fn reason_against(method: Method, scenario: &Scenario) -> Option<String> {
    let Method::Planner { search, .. } = method else {
        return None;
    };
    if search == SearchKind::Thorough && scenario.targets.len() < 2 {
        return Some("with one target it finds no other plan".to_owned());
    }
    let faults = method.asked(scenario).unfit();
    let faults: Vec<String> = faults
        .iter()
        .map(|fault| format!("{}: {}", fault.path, fault.found))
        .collect();
    (!faults.is_empty()).then(|| faults.join("; "))
}
