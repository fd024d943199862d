//! The obstacles of every target, grown by own ship's footprint.

use super::rules::{judged_path, without_domains_of_give_way_targets};
use crate::colregs::{self, Encounter, Risk, Role, ShipDomain, TargetMemory};
use crate::geometry::{ConvexPolygon, ConvexSet, DISC_SIDES, outer_enclosing_ellipse};
use crate::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle, SpaceTimeObstacle};
use crate::parallel;
use crate::scenario::Scenario;
use crate::target::{Motion, Representation, Target, Uncertainty};

/// The obstacles of one target, grown by own ship's footprint.
#[derive(Debug, Clone)]
pub struct TargetSets {
    /// Hulls, margin and position uncertainty: safety is claimed for this one.
    pub hard: Obstacle,
    /// The hard set with the ship domain around it, used where domains are asked for.
    pub with_domain: Obstacle,
    /// The encounter that the domain is for, judged along the nominal desired trajectory.
    pub encounter: Encounter,
    /// Metres by which the domain is reduced to let own ship start outside.
    pub shape_reduced: f64,
    /// Metres from the hard set to the farthest point of the full domain.
    pub shape_reach: f64,
    /// The domain to be reduced; `None` where the set with domain equals the hard one.
    shapes: Option<ShipDomain>,
}

/// A target's obstacle with a reduced ship domain.
#[derive(Debug, Clone)]
pub(super) struct ScaledDomain {
    pub obstacle: Obstacle,
    /// Largest reduction, metres.
    pub reduction: f64,
}

impl TargetSets {
    /// The set with or without domain.
    pub fn either(&self, with_domain: bool) -> &Obstacle {
        if with_domain {
            &self.with_domain
        } else {
            &self.hard
        }
    }

    /// True where the domain is larger than the hard set.
    pub(super) fn has_domain(&self) -> bool {
        self.shapes.is_some()
    }

    /// Removes the ship domain.
    pub(super) fn remove_domain(&mut self) {
        self.with_domain = self.hard.clone();
        (self.shape_reduced, self.shape_reach) = (0.0, 0.0);
        self.shapes = None;
    }

    /// The set with a domain scale factor from 0, the hard set, to 1, the largest domain that own
    /// ship's start permits.
    pub(super) fn scaled(&self, scale: f64) -> ScaledDomain {
        match &self.shapes {
            Some(shapes) if scale > 0.0 && scale < 1.0 => {
                let initial = shapes.scaled(scale);
                ScaledDomain {
                    reduction: shapes.cut(&initial),
                    obstacle: with_initial(&self.hard, initial),
                }
            }
            Some(_) if scale < 1.0 => ScaledDomain {
                obstacle: self.hard.clone(),
                reduction: self.shape_reach,
            },
            _ => ScaledDomain {
                obstacle: self.with_domain.clone(),
                reduction: self.shape_reduced,
            },
        }
    }
}

/// The obstacles and the encounter of every target, in the scenario's order.
pub fn sets(scenario: &Scenario) -> Vec<TargetSets> {
    let sets = parallel::map(&scenario.targets, |index, target| {
        let mut sets = target_sets(scenario, index, target);
        let passed = |known: &TargetMemory| known.passed && sets.encounter.risk.is_none();
        if scenario.memory.target(index).is_some_and(passed) {
            sets.remove_domain();
        }
        sets
    });
    without_domains_of_give_way_targets(scenario, sets)
}

fn target_sets(scenario: &Scenario, index: usize, target: &Target) -> TargetSets {
    let own = &scenario.own_ship;
    let (desired, horizon) = (&scenario.desired, scenario.horizon);
    let mut encounter = colregs::encounter(own, desired, target, horizon, &scenario.limits);
    if let Some(known) = scenario.memory.target(index) {
        encounter.risk = known
            .role
            .or_else(|| new_role(scenario, target, known, encounter.risk));
        encounter.role = encounter.risk.map_or(Role::None, |risk| risk.role);
    }
    // explicit sets are used unchanged: own ship is a point
    let explicit = |obstacle: Obstacle| TargetSets {
        with_domain: obstacle.clone(),
        hard: obstacle,
        encounter,
        shape_reduced: 0.0,
        shape_reach: 0.0,
        shapes: None,
    };
    match &target.motion {
        Motion::Ship(ship) => {
            let shapes = colregs::ship_domain(own, ship, encounter.risk.as_ref(), horizon);
            let sets = Uncertainty {
                initial: shapes.hard.clone().into(),
                velocities: ship.outer_velocity_sets(ship.turn_rate, horizon),
            };
            let hard = obstacle(target, sets);
            let with_domain = if shapes.with_domain == shapes.hard {
                hard.clone()
            } else {
                with_initial(&hard, shapes.with_domain.clone())
            };
            // the ellipse around a reduced domain may contain own ship again
            let start = own.pose.position;
            if with_domain.contains(start, 0.0) && !hard.contains(start, 0.0) {
                return TargetSets {
                    shape_reduced: shapes.reach,
                    shape_reach: shapes.reach,
                    ..explicit(hard)
                };
            }
            TargetSets {
                hard,
                with_domain,
                encounter,
                shape_reduced: shapes.reduced,
                shape_reach: shapes.reach,
                shapes: (shapes.with_domain != shapes.hard).then_some(shapes),
            }
        }
        Motion::Sets(sets) => explicit(obstacle(target, sets.clone())),
    }
}

/// A role toward a target without one: where there is a risk on the desired course from own place.
/// While a manoeuvre takes own ship off its path, it also keeps clear of a ship that it would meet
/// there, or it would return across that ship's bow.
fn new_role(
    scenario: &Scenario,
    target: &Target,
    known: &TargetMemory,
    on_the_path: Option<Risk>,
) -> Option<Risk> {
    if known.track.is_empty() {
        return on_the_path;
    }
    let own = &scenario.own_ship;
    let path = judged_path(scenario, Some(known));
    let (horizon, limits) = (scenario.horizon, &scenario.limits);
    let keeps_clear = |risk: &Risk| risk.role.duties().keeps_clear;
    let is_off = scenario.memory.under_way.is_some() && !known.passed;
    colregs::first_risk(own, &path, target.ship()?, horizon, limits)
        .or(on_the_path.filter(|risk| is_off && keeps_clear(risk)))
}

/// The obstacle of a target's sets. An ellipsoid around polygons that do not change where the
/// target's representation asks for one.
fn obstacle(target: &Target, sets: Uncertainty) -> Obstacle {
    // should the ends not increase: one polytope with all velocities contains the slabs
    let found = Obstacle::new(target.name.clone(), sets.clone()).unwrap_or_else(|_| {
        let initial = sets.initial.outer_polygon(DISC_SIDES);
        let velocity = sets.outer_velocities_after(f64::NEG_INFINITY);
        PolytopeObstacle::new(target.name.clone(), initial, velocity).into()
    });
    match (target.representation, found.as_polytope()) {
        (Representation::Ellipsoid, Some(polytope)) => EllipsoidObstacle::outer_of(polytope).into(),
        _ => found,
    }
}

/// The obstacle with another set at t = 0, metres.
fn with_initial(known: &Obstacle, initial: ConvexPolygon) -> Obstacle {
    match known.sets().initial {
        ConvexSet::Polygon(_) => known.with_initial(initial),
        ConvexSet::Ellipse(_) => known.with_initial(outer_enclosing_ellipse(&initial)),
    }
}
