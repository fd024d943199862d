//! Every number of a plan document altered, each alone: the check must find each alteration.

use serde_json::{Value, json};

use crate::campaigns::Report;
use crate::campaigns::documents::{documents, is_caught, numbers};

/// True for values that are not altered here. Nothing is proven of search statistics and weights.
/// Another input or set may be sound too; tests/verification/claims.rs alters these.
fn is_said_only(pointer: &str) -> bool {
    [
        "/search_stats",
        "/timing",
        "/escape/",
        "/departure/",
        "/optimal_control/intervals",
        "/optimal_control/start_intervals",
        "/optimal_control/state_weights",
        "/optimal_control/defect",
        "/optimal_control/force_limits",
        "/optimal_control/starts",
        "/optimal_control/homotopy_classes",
        "/path_time/",
        "/mission/alternatives",
        // a mission that begins a millimetre beside own ship
        "/mission/waypoints/0/",
        "/land/",
        "/obstacles/",
        "/targets/",
        "/own_ship/",
        "/horizon_s",
        "/max_risk",
        "/risk_weight_m",
        // clear for a longer hold implies clear for a shorter one
        "/cost/arrival_hold_s",
    ]
    .iter()
    .any(|part| pointer.starts_with(part))
        // the largest risk may persist for a time interval
        || pointer.contains("max_risk_t_s")
        || ["/tcpa_s", "/undisturbed_tcpa_s", "/undisturbed_dcpa_m"]
            .iter()
            .any(|unproven| pointer.ends_with(unproven))
        || ["roles", "scores", "violations", "monitors", "manoeuvre"]
            .iter()
            .any(|judged| pointer.contains(&format!("/{judged}")))
}

/// Alters numbers of the motion, its samples, costs, encounters and mission by a thousandth, about
/// `each` numbers of each document.
pub fn run(each: usize) -> Report {
    let mut report = Report::default();
    for (name, document) in documents() {
        let forces = document["optimal_control"].is_object();
        let is_held = |pointer: &String| {
            // nearer land may lie outside the document
            let one_sided = pointer == "/cost/min_land_distance_m";
            // forces are checked to the tolerance of the dynamics
            let loose = forces
                && ["surge_n", "sway_n", "yaw_nm"]
                    .iter()
                    .any(|k| pointer.ends_with(k));
            // relaxed amount of a ship domain
            let drawn = pointer.strip_suffix("/amount").is_some_and(|given_up| {
                document.pointer(&format!("{given_up}/kind")) != Some(&json!("risk"))
            });
            // a waiting ship has the same position at any time of the interval
            let waiting = pointer.strip_suffix("/t_s").is_some_and(|sample| {
                sample.starts_with("/trajectory/samples/")
                    && document.pointer(&format!("{sample}/speed_mps")) == Some(&json!(0.0))
            });
            // a thousandth of it is less than its accuracy of a centimetre
            let coarse = pointer.starts_with("/cost/waypoint_distances_m/")
                && document.pointer(pointer).and_then(Value::as_f64) < Some(10.0);
            !(is_said_only(pointer) || one_sided || loose || drawn || waiting || coarse)
        };
        let mut pointers = Vec::new();
        numbers(&document, "", &mut pointers);
        pointers.retain(is_held);
        // an odd stride covers every column of the samples
        let stride = (pointers.len() / each) | 1;
        let mut altered = 0;
        for pointer in pointers.iter().step_by(stride) {
            let value = document
                .pointer(pointer)
                .and_then(Value::as_f64)
                .expect("a number");
            // angles of a state under forces are checked to the tolerance of the dynamics
            let angle = forces
                && ["heading_deg", "yaw_rate_deg_per_s"]
                    .iter()
                    .any(|k| pointer.ends_with(k));
            let step = if angle { 0.1 } else { 1e-3 } * value.abs().max(1.0);
            let sign = if altered % 2 == 0 { 1.0 } else { -1.0 };
            let wrong = value + sign * step;
            let mut document = document.clone();
            *document.pointer_mut(pointer).expect("there") = json!(wrong);
            report.require(is_caught(&document), || {
                format!("{name}: {pointer} from {value} to {wrong} is not caught")
            });
            altered += 1;
        }
        let all = pointers.len();
        println!("{name}: {altered} of {all} numbers altered");
        report.require(2 * altered >= each.min(all), || {
            format!("{name}: {altered} altered")
        });
    }
    report
}
