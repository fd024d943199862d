//! How much of the shapes a plan keeps.

use super::ladder::{Attempt, Ladder, TOUCH_M, level_sets, out_of_time};
use super::rung::Rung;
use super::sets::TargetSets;
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::planner::{Outcome, PlannerKind, space_time};
use crate::scenario::Compliance;
use crate::trajectory::Trajectory;

/// Shares of the shapes that are tried where no plan was found for the shapes, or for the hard sets, alone.
pub(super) const HALF: f64 = 0.5;
const ABOVE_HARD_SETS: [f64; 2] = [1.0, HALF];

/// Halvings of the share of the shapes that a plan keeps, between what one keeps and what none was found for.
const SHARE_HALVINGS: usize = 3;

/// Halvings within which the share of one shape is found that a given plan is clear of.
const KEPT_HALVINGS: usize = 10;

impl Ladder<'_> {
    /// So much of every shape.
    pub(super) fn shares(&self, share: f64) -> Vec<f64> {
        vec![share; self.sets.len()]
    }

    /// The sets with so much of each shape, and metres that each shape is drawn back.
    pub(super) fn kept(&self, shares: &[f64]) -> (Vec<Obstacle>, Vec<f64>) {
        let kept = self.sets.iter().zip(&self.scenario.targets).zip(shares);
        let kept = kept.map(|((sets, target), share)| sets.kept(self.scenario, target, *share));
        kept.map(|k| (k.obstacle, k.cut)).unzip()
    }

    /// A plan that is clear of the hard sets and, where shapes are asked for, of as much of them as was found. `None` where
    /// none was found in time that is left; an attempt without a plan where the time ran out.
    pub(super) fn clear_of_hard_sets(&self, shaped: bool) -> Option<Attempt> {
        if !self.sets.iter().any(TargetSets::has_shape) {
            return None;
        }
        if shaped {
            return self.clear_of_so_much(0.0);
        }
        // along paths what is found for the larger set is found for the smaller one
        if self.is_monotone() {
            return None;
        }
        let found = ABOVE_HARD_SETS
            .into_iter()
            .find_map(|share| self.found(share))?;
        if found.trajectory().is_none() {
            return Some(found);
        }
        Some(self.clear_of(&found, &self.shares(0.0), Rung::Compliant))
    }

    /// The same beginning with half of the shapes: the planner may find a way out of the larger sets that it misses for the smaller.
    pub(super) fn clear_of_half_the_shapes(&self, shaped: bool) -> Option<Attempt> {
        let shapes = shaped && self.sets.iter().any(TargetSets::has_shape);
        (shapes && !self.is_monotone()).then(|| self.clear_of_so_much(HALF))?
    }

    fn is_monotone(&self) -> bool {
        self.scenario.planner == PlannerKind::PathTime
    }

    /// What is planned against a share of the shapes; `None` where there is no plan.
    fn found(&self, share: f64) -> Option<Attempt> {
        let attempt = self.attempt(Rung::Domains, &self.shares(share), self.scenario.max_risk);
        let is_none = matches!(attempt.planned.outcome, Outcome::Infeasible(_));
        (!is_none).then_some(attempt)
    }

    /// What is planned against a share of the shapes, said to be clear of as much of them as it is, or as was found.
    fn clear_of_so_much(&self, share: f64) -> Option<Attempt> {
        let found = self.found(share)?;
        let Some(trajectory) = found.trajectory() else {
            return Some(found);
        };
        let kept = self.kept_along(trajectory, found.risk);
        Some(self.with_more_kept(self.clear_of(&found, &kept, Rung::Domains), &kept))
    }

    /// The same plan, said to be clear of so much of each shape.
    pub(super) fn clear_of(&self, attempt: &Attempt, shares: &[f64], rung: Rung) -> Attempt {
        let (whole, cuts) = self.kept(shares);
        Attempt {
            rung,
            obstacles: level_sets(&whole, attempt.risk),
            whole,
            cuts: match self.scenario.compliance {
                Compliance::Shape | Compliance::Rules => cuts,
                Compliance::None => attempt.cuts.clone(),
            },
            ..attempt.clone()
        }
    }

    /// Share of each shape that a motion is clear of.
    pub(super) fn kept_along(&self, trajectory: &Trajectory, risk: f64) -> Vec<f64> {
        let all = self.sets.iter().zip(&self.scenario.targets);
        all.map(|(sets, target)| {
            let clear = |share: f64| {
                let set = sets.kept(self.scenario, target, share).obstacle;
                let set = if risk > 0.0 { set.at_risk(risk) } else { set };
                let enters = |s| set.first_contact(s, TOUCH_M).is_some();
                !trajectory.segments().iter().any(enters)
            };
            if !sets.has_shape() || clear(1.0) {
                return 1.0;
            }
            let (mut kept, mut entered) = (0.0, 1.0);
            for _ in 0..KEPT_HALVINGS {
                let share = 0.5 * (kept + entered);
                if clear(share) {
                    kept = share;
                } else {
                    entered = share;
                }
            }
            kept
        })
        .collect()
    }

    /// Draws plans out of one another that keep more of the shapes of which least is kept, and no less of the others.
    pub(super) fn with_more_kept(&self, found: Attempt, kept: &[f64]) -> Attempt {
        let least = |kept: &[f64]| kept.iter().copied().fold(1.0, f64::min);
        let (mut best, mut kept) = (found, kept.to_vec());
        let (mut low, mut high) = (least(&kept), 1.0);
        if self.scenario.planner != PlannerKind::SpaceTime {
            return best;
        }
        for _ in 0..SHARE_HALVINGS {
            let share = 0.5 * (low + high);
            let shares: Vec<f64> = kept.iter().map(|k| k.max(share)).collect();
            let obstacles = level_sets(&self.kept(&shares).0, best.risk);
            let Some(from) = best.trajectory() else {
                return best;
            };
            let outcome = space_time::warm_started(&self.problem(&obstacles), from).outcome;
            if matches!(outcome, Outcome::Deadline(_)) {
                return out_of_time(best);
            }
            let Some(plan) = outcome.plan() else {
                high = share;
                continue;
            };
            kept = self.kept_along(&plan.trajectory, best.risk);
            low = least(&kept).max(share);
            best.planned.outcome = outcome;
            best = self.clear_of(&best, &kept, Rung::Domains);
        }
        best
    }
}
