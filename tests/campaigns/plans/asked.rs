//! Plans for requests and for stricter ones: ship domains, the rules, larger sets, less risk. A plan
//! for the stricter one is also one for the other.

use rayon::prelude::*;
use searoom::obstacle::SpaceTimeObstacle;
use searoom::pipeline::{self, RelaxationLevel, Run};
use searoom::planner::SearchKind;
use searoom::scenario::{Compliance, Scenario};
use searoom::target::Representation;
use searoom::tolerance::TOUCH_M;

use super::invariance;
use crate::campaigns::{Report, Seeds};

/// Relative difference of costs that is significant.
const SIGNIFICANT: f64 = 1e-3;

/// A request.
#[derive(Debug, Clone, Copy)]
struct Asked {
    compliance: Compliance,
    representation: Representation,
    max_risk: f64,
    /// Factor of the safety margin.
    margin: f64,
}

const LEAST: Asked = Asked {
    compliance: Compliance::None,
    representation: Representation::Polytope,
    max_risk: 0.0,
    margin: 1.0,
};

const SHAPE: Asked = Asked {
    compliance: Compliance::Shape,
    ..LEAST
};

/// Pairs: name, request, stricter request, and whether the thorough search promises that the
/// stricter one is not cheaper.
const STEPS: [(&str, Asked, Asked, bool); 7] = [
    ("none, shape", LEAST, SHAPE, true),
    (
        "shape, rules",
        SHAPE,
        Asked {
            compliance: Compliance::Rules,
            ..LEAST
        },
        true,
    ),
    (
        "polytope, its outer ellipse",
        LEAST,
        Asked {
            representation: Representation::Ellipsoid,
            ..LEAST
        },
        true,
    ),
    (
        "the same under shape",
        SHAPE,
        Asked {
            representation: Representation::Ellipsoid,
            ..SHAPE
        },
        true,
    ),
    (
        "risk 0.2, none",
        Asked {
            max_risk: 0.2,
            ..LEAST
        },
        LEAST,
        true,
    ),
    (
        "risk 0.3, 0.1",
        Asked {
            max_risk: 0.3,
            ..LEAST
        },
        Asked {
            max_risk: 0.1,
            ..LEAST
        },
        false,
    ),
    (
        "margin, 1.3 times as large",
        LEAST,
        Asked {
            margin: 1.3,
            ..LEAST
        },
        false,
    ),
];

/// The run of a scene with all that is asked of it; `None` without one.
fn planned(seed: u64, asked: Asked, search: SearchKind) -> Option<Run> {
    let mut scene = Scenario {
        compliance: asked.compliance,
        max_risk: asked.max_risk,
        search,
        ..invariance::scene(seed)
    };
    scene.own_ship.safety_margin *= asked.margin;
    for target in &mut scene.targets {
        target.representation = asked.representation;
    }
    let run = pipeline::run(scene);
    let judged = run.evaluation.as_ref()?;
    assert!(judged.verified(), "{seed}: {:?}", judged.violations);
    (run.level == RelaxationLevel::Compliant).then_some(run)
}

/// Cost of the stricter request over that of the other. `None` without both plans, and where the
/// stricter plan enters a set of the other: by the rules domains of ships that give way are not kept.
fn ratio(seed: u64, less: Asked, more: Asked, search: SearchKind) -> Option<f64> {
    let (less, more) = (planned(seed, less, search)?, planned(seed, more, search)?);
    let [plan, dearer] = [&less, &more].map(|run| run.planned.outcome.plan());
    let segments = dearer?.trajectory.segments();
    let sets = less.targets.iter().map(|target| &target.obstacle);
    let mut met = sets.flat_map(|set| segments.iter().map(move |s| set.first_contact(s, TOUCH_M)));
    let is_clear = !met.any(|contact| contact.is_some());
    let cost = |cost: f64| cost.max(invariance::LEAST_COST);
    is_clear.then_some(cost(dearer?.cost) / cost(plan?.cost))
}

/// Prints a table: in how many scenes of several targets the stricter request is cheaper, for A* and
/// the thorough search. Requires none of the thorough search where it promises that.
pub fn run(seeds: Seeds) -> Report {
    let mut report = Report::default();
    println!(
        "| request, stricter one | search | scenes with both | stricter is cheaper | least ratio of J |"
    );
    println!("| --- | --- | --- | --- | --- |");
    for search in [SearchKind::AStar, SearchKind::Thorough] {
        for (name, less, more, is_promised) in STEPS {
            let several = seeds.clone().filter(|seed| seed % 4 != 0);
            let scenes = several.collect::<Vec<_>>().into_par_iter();
            let ratios: Vec<(u64, f64)> = scenes
                .filter_map(|seed| Some((seed, ratio(seed, less, more, search)?)))
                .collect();
            let least = ratios.iter().map(|r| r.1).fold(f64::INFINITY, f64::min);
            let cheaper: Vec<u64> = (ratios.iter())
                .filter(|(_, ratio)| *ratio < 1.0 - SIGNIFICANT)
                .map(|(seed, _)| *seed)
                .collect();
            let all = ratios.len();
            println!(
                "| {name} | {search:?} | {all} | {} | {least:.3} |",
                cheaper.len()
            );
            let is_promised = is_promised && search == SearchKind::Thorough;
            report.require(!is_promised || cheaper.is_empty(), || {
                format!("{name}: cheaper in scenes {cheaper:?}")
            });
            report.require(2 * all > seeds.clone().count(), || {
                format!("{name}: only {all} scenes have both plans")
            });
        }
    }
    report
}
