//! The sets of every target, own ship's footprint folded in.

use super::duty::without_shapes_stood_on_for;
use crate::colregs::{self, Encounter, Shapes};
use crate::geometry::ConvexPolygon;
use crate::obstacle::{
    EllipsoidObstacle, Obstacle, PolytopeObstacle, SlabObstacle, SpaceTimeObstacle,
};
use crate::scenario::Scenario;
use crate::target::{Motion, Representation, ShipTrack, Target, VelocitySpell};

/// The sets of one target, own ship's footprint folded in.
#[derive(Debug, Clone)]
pub struct TargetSets {
    /// Hulls, margin and position uncertainty: safety is claimed on this one.
    pub hard: Obstacle,
    /// With the domain's shape around it: what the planner keeps out of when shapes are asked for.
    pub shaped: Obstacle,
    /// The encounter that the shape is for, judged along the undisturbed desired trajectory.
    pub encounter: Encounter,
    /// Metres that the shape was drawn back to let own ship start outside; 0 when it was not.
    pub shape_reduced: f64,
    /// Metres from the hard set to the farthest point of the full shape.
    pub shape_reach: f64,
    /// What can be drawn back; `None` where the shaped set is the hard one.
    shapes: Option<Shapes>,
}

/// What is left of a target's shape.
#[derive(Debug, Clone)]
pub(super) struct Kept {
    pub obstacle: Obstacle,
    /// Metres, the largest cut.
    pub cut: f64,
}

impl TargetSets {
    /// The shaped or the hard set.
    pub fn either(&self, shaped: bool) -> &Obstacle {
        if shaped { &self.shaped } else { &self.hard }
    }

    /// The hard set, of its own.
    pub(super) fn hard_set(&self) -> Obstacle {
        self.hard.clone()
    }

    /// True where the shape is more than the hard set.
    pub(super) fn has_shape(&self) -> bool {
        self.shapes.is_some()
    }

    /// Leaves the hard set alone.
    pub(super) fn give_up_shape(&mut self) {
        self.shaped = self.hard.clone();
        (self.shape_reduced, self.shape_reach) = (0.0, 0.0);
        self.shapes = None;
    }

    /// The set with so much of the shape, from 0 to 1, of what own ship's start lets be.
    pub(super) fn kept(&self, scenario: &Scenario, target: &Target, share: f64) -> Kept {
        match (&self.shapes, &target.motion) {
            (Some(shapes), Motion::Ship(ship)) if share > 0.0 && share < 1.0 => {
                let initial = shapes.drawn_back(share);
                Kept {
                    cut: shapes.cut(&initial),
                    obstacle: with_initial(target, ship, &self.hard, initial, scenario.horizon),
                }
            }
            (Some(_), _) if share < 1.0 => Kept {
                obstacle: self.hard.clone(),
                cut: self.shape_reach,
            },
            _ => Kept {
                obstacle: self.shaped.clone(),
                cut: self.shape_reduced,
            },
        }
    }
}

/// The sets and the encounter of every target, in the scenario's order.
pub fn sets(scenario: &Scenario) -> Vec<TargetSets> {
    let of = |target| target_sets(scenario, target);
    without_shapes_stood_on_for(scenario, scenario.targets.iter().map(of).collect())
}

fn target_sets(scenario: &Scenario, target: &Target) -> TargetSets {
    let own = &scenario.own_ship;
    let (desired, horizon) = (&scenario.desired, scenario.horizon);
    let encounter = colregs::encounter(own, desired, target, horizon);
    // taken as they are: own ship is a point, nothing is added
    let outright = |obstacle: Obstacle| TargetSets {
        shaped: obstacle.clone(),
        hard: obstacle,
        encounter,
        shape_reduced: 0.0,
        shape_reach: 0.0,
        shapes: None,
    };
    match &target.motion {
        Motion::Ship(ship) => {
            let risk = colregs::first_risk(own, desired, ship, horizon);
            let shapes = colregs::shapes(own, ship, risk.as_ref(), horizon);
            let hard = ship_obstacle(target, ship, shapes.hard.clone(), horizon);
            let shaped = if shapes.shaped == shapes.hard {
                hard.clone()
            } else {
                with_initial(target, ship, &hard, shapes.shaped.clone(), horizon)
            };
            // the ellipse around a shape that was drawn back may contain own ship again
            let start = own.pose.position;
            if shaped.contains(start, 0.0) && !hard.contains(start, 0.0) {
                return TargetSets {
                    shape_reduced: shapes.reach,
                    shape_reach: shapes.reach,
                    ..outright(hard)
                };
            }
            TargetSets {
                hard,
                shaped,
                encounter,
                shape_reduced: shapes.reduced,
                shape_reach: shapes.reach,
                shapes: (shapes.shaped != shapes.hard).then_some(shapes),
            }
        }
        Motion::Sets { initial, velocity } => outright(represented(
            target.representation,
            PolytopeObstacle::new(target.name.clone(), initial.clone(), velocity.clone()),
        )),
        Motion::Ellipses { initial, velocity } => {
            outright(EllipsoidObstacle::new(target.name.clone(), *initial, *velocity).into())
        }
        Motion::Spells { initial, spells } => {
            outright(one_after_another(target, initial.clone(), spells.clone()))
        }
    }
}

fn represented(representation: Representation, polytope: PolytopeObstacle) -> Obstacle {
    match representation {
        Representation::Polytope => polytope.into(),
        Representation::Ellipsoid => EllipsoidObstacle::outer_of(&polytope).into(),
    }
}

fn ship_obstacle(
    target: &Target,
    ship: &ShipTrack,
    initial: ConvexPolygon,
    horizon: f64,
) -> Obstacle {
    if ship.turn_rate > 0.0 {
        let spells = ship.outer_velocity_spells(ship.turn_rate, horizon);
        return one_after_another(target, initial, spells);
    }
    let polytope = PolytopeObstacle::new(target.name.clone(), initial, ship.outer_velocity_set());
    represented(target.representation, polytope)
}

/// [`ship_obstacle`] where that for another initial set is known.
fn with_initial(
    target: &Target,
    ship: &ShipTrack,
    known: &Obstacle,
    initial: ConvexPolygon,
    horizon: f64,
) -> Obstacle {
    match known {
        Obstacle::Slabs(o) => o.with_initial(initial).into(),
        Obstacle::Polytope(o) => {
            PolytopeObstacle::new(target.name.clone(), initial, o.velocity().clone()).into()
        }
        Obstacle::Ellipsoid(_) => ship_obstacle(target, ship, initial, horizon),
    }
}

fn one_after_another(
    target: &Target,
    initial: ConvexPolygon,
    spells: Vec<VelocitySpell>,
) -> Obstacle {
    // one polytope of all velocities together contains the slabs: should their ends ever not increase
    let all: Vec<_> = spells
        .iter()
        .flat_map(|s| s.velocities.vertices().iter().copied())
        .collect();
    match SlabObstacle::new(target.name.clone(), initial.clone(), spells) {
        Ok(slabs) => slabs.into(),
        Err(_) => {
            let velocity = ConvexPolygon::hull(&all)
                .unwrap_or_else(|_| ConvexPolygon::point(crate::frame::Vector::zeros()));
            PolytopeObstacle::new(target.name.clone(), initial, velocity).into()
        }
    }
}
