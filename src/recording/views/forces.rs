//! Curves of a plan of forces: velocities in the ship's frame, and the forces.

use rerun::components::{AggregationPolicy, InterpolationMode};
use rerun::{RecordingStreamResult, Scalars, SeriesLines, TimeColumn};

use crate::frame::clockwise_deg_per_s;
use crate::recording::canvas::{ShownMotion, ViewModel, style};
use crate::recording::write::Recorder;
use crate::recording::{TIMELINE, path};
use crate::trajectory::{ForceNode, Steered};

/// Surge, sway and yaw rate at the nodes.
pub const STATES: &str = "curves/states";
/// Surge force, sway force and yaw moment, held from node to node.
pub const FORCES: &str = "curves/forces";

/// The motion under forces, where the plan is one.
pub fn steered<'a>(model: &ViewModel<'a>) -> Option<&'a Steered> {
    match model.motion {
        ShownMotion::Planned(trajectory) => trajectory.steered(),
        ShownMotion::Nominal(_) => None,
    }
}

/// Logs both plots; nothing for a plan of lines and arcs.
pub fn log_forces(rec: &mut Recorder, model: &ViewModel) -> RecordingStreamResult<()> {
    let Some(motion) = steered(model) else {
        return Ok(());
    };
    let states = |n: &ForceNode| [n.velocity.x, -n.velocity.y, clockwise_deg_per_s(n.yaw_rate)];
    let names = [
        "surge, m/s",
        "sway to starboard, m/s",
        "yaw rate clockwise, deg/s",
    ];
    log(
        rec,
        STATES,
        names,
        InterpolationMode::Linear,
        motion,
        states,
    )?;
    let forces = |n: &ForceNode| [n.force.x, -n.force.y, -n.moment];
    let names = ["surge, N", "sway to starboard, N", "yaw clockwise, Nm"];
    log(
        rec,
        FORCES,
        names,
        InterpolationMode::StepAfter,
        motion,
        forces,
    )
}

fn log(
    rec: &mut Recorder,
    entity: &str,
    names: [&str; 3],
    between: InterpolationMode,
    motion: &Steered,
    values: impl Fn(&ForceNode) -> [f64; 3],
) -> RecordingStreamResult<()> {
    let style = SeriesLines::new()
        .with_names(names)
        .with_colors([0, 1, 2].map(style::target))
        .with_widths([2.0; 3])
        .with_interpolation_mode(between)
        .with_aggregation_policy(AggregationPolicy::Off);
    let nodes = motion.nodes();
    let times = TimeColumn::new_duration_secs(TIMELINE, nodes.iter().map(|n| n.time));
    let columns = Scalars::update_fields()
        .with_scalars(nodes.iter().flat_map(values))
        .columns(vec![3; nodes.len()])?;
    rec.log_moving(path(&[entity]), times, &style, columns)
}
