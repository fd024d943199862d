//! Record of the optimal-control solution.

use searoom_document::{
    ControlDocument, ForceLimitsDocument, HomotopyClassDocument, StartAttemptDocument,
    StartVelocityDocument,
};

use crate::frame::clockwise_deg_per_s;
use crate::obstacle::SpaceTimeObstacle;
use crate::pipeline::Run;

/// Builds the record; `None` for other planners.
pub(super) fn control(run: &Run) -> Option<ControlDocument> {
    let report = run.planned.control.as_deref()?;
    let settings = &run.scenario.settings.optimal_control;
    let finite = |value: f64| value.is_finite().then_some(value);
    let limits = settings.force_limits;
    Some(ControlDocument {
        vessel: settings.vessel.word().to_owned(),
        force_limits: ForceLimitsDocument {
            surge_n: limits[0],
            sway_n: limits[1],
            yaw_nm: limits[2],
        },
        state_weights: settings.state_weights.into(),
        control_weights: settings.force_weights.into(),
        start: (run.scenario.memory.warm_start.as_ref()).map(|warm| StartVelocityDocument {
            surge_mps: warm.state[3],
            sway_mps: -warm.state[4] + 0.0,
            yaw_rate_deg_per_s: clockwise_deg_per_s(warm.state[5]),
        }),
        start_intervals: report.start_intervals,
        intervals: report.intervals,
        defect: finite(report.defect),
        enclosed_targets: (run.targets.iter().map(|target| &target.whole))
            .filter(|set| set.as_ellipsoid().is_none())
            .map(|set| set.name().to_owned())
            .collect(),
        starts: report
            .starts
            .iter()
            .map(|start| StartAttemptDocument {
                start: start.start.to_string(),
                status: start.status.to_string(),
                feasible: start.feasible,
                objective: finite(start.objective),
                iterations: start.iterations,
            })
            .collect(),
        homotopy_classes: report
            .classes
            .iter()
            .map(|class| HomotopyClassDocument {
                sides: class.sides.clone(),
                objective: class.objective,
                starts: class.starts,
            })
            .collect(),
    })
}
