//! The thorough search: the best of many plans, also of plans for stricter requests.

use super::relaxation::{Attempt, RelaxationLevel, Relaxer, out_of_time};
use super::sets;
use crate::obstacle::{SpaceTimeObstacle, level_sets};
use crate::planner::{Improvement, Outcome, Plan, PlanMethod, Planned, SearchKind};
use crate::scenario::{Compliance, Scenario};
use crate::target::{Motion, Representation};
use crate::tolerance::TOUCH_M;

/// Cost of a plan that no search can improve on, m²: its root mean square error is a millimetre.
const NOTHING_M2: f64 = 1e-6;

impl Relaxer<'_> {
    /// Best of: A*, a search with larger budgets, and plans for stricter requests (with ship domains, by the
    /// rules, around outer ellipses of polytopes) that are clear of the sets of this request, too.
    ///
    /// The answers are compared whole: a cheaper plan at one level may lead to more relaxation at
    /// another. Candidates compete at the first level only, and not with the remainder of the last
    /// plan, which is kept for other reasons than its cost.
    pub(super) fn thorough_answer(&self) -> Attempt {
        let is_late = |of: &Attempt| matches!(of.planned.outcome, Outcome::Deadline(_));
        let quick = with_search(self.scenario, SearchKind::AStar);
        let mut best = self.of(&quick, self.sets).answer_of_one_search();
        self.record(&mut best);
        let costs_nothing = |plan: &Plan| plan.cost < NOTHING_M2;
        let is_free = best.planned.outcome.plan().is_some_and(costs_nothing);
        if is_late(&best) || is_free && best.level == RelaxationLevel::Compliant {
            return best;
        }
        let larger = self.answer_of_one_search();
        let mut late = is_late(&larger);
        if !best.is_better_than(&larger) {
            self.replace(&mut best, larger);
        }
        let others = match best.planned.is_remainder() {
            true => Vec::new(),
            false => stricter(self.scenario),
        };
        for other in others {
            late |= self.time_left().is_zero();
            if late {
                break;
            }
            if let Some(found) = self.candidate(&other)
                && found.is_better_than(&best)
            {
                self.replace(&mut best, found);
            }
        }
        let plan = best.planned.outcome.plan_mut();
        if let Some(plan) = plan.filter(|plan| plan.method.is_by_search()) {
            plan.method = PlanMethod::Thorough;
        }
        match late || self.time_left().is_zero() {
            true => out_of_time(best),
            false => best,
        }
    }

    /// Replaces the best answer. The improvements begin anew where less is relaxed.
    fn replace(&self, best: &mut Attempt, mut better: Attempt) {
        // a manoeuvre for stricter sets may come from no graph: the search among all is reported
        better.planned.stats = better.planned.stats.or(best.planned.stats);
        if better.relaxation_cmp(best).is_eq() {
            better.planned.improvements = std::mem::take(&mut best.planned.improvements);
        }
        *best = better;
        self.record(best);
    }

    /// Records the cost of the best answer if it changed. That of a plan that does not arrive is
    /// against another mission.
    fn record(&self, best: &mut Attempt) {
        let plan = best.planned.outcome.plan().filter(|plan| plan.arrives());
        let Some(cost) = plan.map(|plan| plan.cost) else {
            return;
        };
        let recorded = &mut best.planned.improvements;
        if recorded.last().is_none_or(|last| last.cost != cost) {
            let after = self.begun.elapsed();
            recorded.push(Improvement { after, cost });
        }
    }

    /// The plan of another scenario, if it is clear of the sets of the first level.
    fn candidate(&self, other: &Scenario) -> Option<Attempt> {
        let sets = sets::sets(other);
        let planned = self.of(other, &sets).first().planned;
        let plan = planned.outcome.plan()?.clone();
        let risk = self.scenario.max_risk;
        let (whole, reductions) = self.first_sets();
        let obstacles = level_sets(&whole, risk);
        let motion = plan.trajectory.segments();
        if obstacles.iter().any(|set| set.is_entered(motion, TOUCH_M)) {
            return None;
        }
        let planned = Planned {
            stats: planned.stats,
            explored: planned.explored,
            // the cost on the graph is that of other sets
            ..Planned::of(Outcome::Solved(Plan {
                method: PlanMethod::Thorough,
                graph_cost: None,
                ..plan
            }))
        };
        let level = RelaxationLevel::Compliant;
        Some(Attempt::of(
            level, whole, reductions, obstacles, risk, planned,
        ))
    }
}

fn with_search(scenario: &Scenario, search: SearchKind) -> Scenario {
    Scenario {
        search,
        ..scenario.clone()
    }
}

/// The scenario by Dijkstra's algorithm, and stricter ones by every search; none under the rules.
fn stricter(scenario: &Scenario) -> Vec<Scenario> {
    let asked = scenario.compliance;
    let levels = match asked {
        Compliance::None => &[Compliance::None, Compliance::Shape, Compliance::Rules][..],
        Compliance::Shape => &[Compliance::Shape, Compliance::Rules],
        Compliance::Rules => return Vec::new(),
    };
    let mut all = vec![with_search(scenario, SearchKind::Dijkstra)];
    for compliance in levels {
        let strict = Scenario {
            compliance: *compliance,
            ..scenario.clone()
        };
        let around = with_outer_ellipses(&strict);
        let strict = (*compliance != asked).then_some(strict);
        for scenario in strict.into_iter().chain(around) {
            let searches = [
                SearchKind::AStar,
                SearchKind::Dijkstra,
                SearchKind::Thorough,
            ];
            all.extend(searches.map(|search| with_search(&scenario, search)));
        }
    }
    all
}

/// The scenario with ellipses around polytopes; `None` where there is none that has one.
fn with_outer_ellipses(scenario: &Scenario) -> Option<Scenario> {
    let mut around = scenario.clone();
    let mut is_another = false;
    for target in &mut around.targets {
        if let Motion::Ship(ship) = &target.motion
            && ship.turn_rate == 0.0
            && ship.route.is_empty()
            && target.representation != Representation::Ellipsoid
        {
            target.representation = Representation::Ellipsoid;
            is_another = true;
        }
    }
    is_another.then_some(around)
}
