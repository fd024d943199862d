//! A planner of one's own: it holds course at the greatest speed that keeps clear. Searoom makes the
//! sets before it, and the independent check judges its plan.
//!
//! ```text
//! cargo run --release --no-default-features --example custom_planner
//! ```

use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline;
use searoom::planner::{
    Minimises, NoPlan, Outcome, Plan, PlanMethod, PlanRequest, Planned, Planner, PlannerFacts,
};
use searoom::report::plan_text;
use searoom::scenario::{Compliance, Scenario};
use searoom::trajectory::Segment;

struct SlowDown;

impl Planner for SlowDown {
    fn facts(&self) -> &'static PlannerFacts {
        &PlannerFacts {
            name: "slow-down",
            label: "slow down",
            minimises: Minimises::SpaceTimeError,
            follows_paths: false,
            keeps_off_land: false,
            keeps_rules: false,
            uses_ellipses: false,
            relaxes_domains_only: true,
            has_no_return: false,
            searches: &[],
        }
    }

    fn plan(&self, request: &PlanRequest) -> Planned {
        let problem = &request.problem;
        let own = problem.own;
        let way = (problem.desired.end() - own.pose.position).norm();
        let mut speeds = own.speeds.clone();
        speeds.sort_by(|a, b| b.total_cmp(a));
        let straight = speeds.into_iter().map(|speed| Segment {
            start: own.pose,
            start_time: 0.0,
            duration: way / speed,
            speed,
            turn_rate: 0.0,
        });
        let clear = |segment: &Segment| {
            let mut sets = problem.obstacles.iter();
            let meets = sets.any(|set| set.first_contact(segment, 0.0).is_some());
            segment.duration <= problem.horizon && !meets
        };
        let found = straight.into_iter().find(clear);
        let plan =
            found.and_then(|segment| Plan::measured(problem, vec![segment], PlanMethod::Other));
        Planned::of(plan.map_or(Outcome::Infeasible(NoPlan::NoRoute), Outcome::Solved))
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/scenarios/colregs/give-way.toml"
    );
    let mut scenario = Scenario::read(file.as_ref())?;
    scenario.set_planner(&SlowDown);
    scenario.compliance = Compliance::None;
    scenario.horizon = 1200.0;
    let ordered = scenario.own_ship.speed;
    let twentieths = (1..=20).map(|part| f64::from(part) / 20.0 * ordered);
    scenario.own_ship.speeds = twentieths.collect();
    let run = pipeline::run(scenario);
    println!("{}", plan_text(&run));
    Ok(())
}
