//! Record of the optimal-control solution.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::frame::{clockwise_deg_per_s, radians_from_deg};
use crate::obstacle::SpaceTimeObstacle;
use crate::pipeline::Run;

/// Ship, weights and grid, the result of every initial guess, and the homotopy classes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ControlDocument {
    pub vessel: String,
    pub force_limits: ForceLimitsDocument,
    pub state_weights: [f64; 6],
    pub control_weights: [f64; 3],
    /// Null for a start ahead at own ship's speed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub start: Option<StartVelocityDocument>,
    pub start_intervals: usize,
    pub intervals: usize,
    pub defect: Option<f64>,
    pub enclosed_targets: Vec<String>,
    pub starts: Vec<StartAttemptDocument>,
    pub homotopy_classes: Vec<HomotopyClassDocument>,
}

/// Force limits, symmetric about zero.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ForceLimitsDocument {
    pub surge_n: f64,
    pub sway_n: f64,
    pub yaw_nm: f64,
}

/// Own ship's velocity at the start; starboard and clockwise are positive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartVelocityDocument {
    pub surge_mps: f64,
    pub sway_mps: f64,
    pub yaw_rate_deg_per_s: f64,
}

impl StartVelocityDocument {
    /// Surge, sway to port and yaw rate to port: m/s, m/s, rad/s.
    pub(crate) fn velocity(self) -> [f64; 3] {
        let yaw_rate = radians_from_deg(-self.yaw_rate_deg_per_s);
        [self.surge_mps, -self.sway_mps, yaw_rate]
    }
}

/// Result of one initial guess.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct StartAttemptDocument {
    pub start: String,
    pub status: String,
    pub feasible: bool,
    pub objective: Option<f64>,
    pub iterations: usize,
}

/// Plans that pass every set on the same side.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct HomotopyClassDocument {
    pub sides: Vec<Option<String>>,
    pub objective: f64,
    pub starts: usize,
}

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
                sides: class
                    .sides
                    .iter()
                    .map(|side| side.map(|side| side.to_string()))
                    .collect(),
                objective: class.objective,
                starts: class.starts,
            })
            .collect(),
    })
}
