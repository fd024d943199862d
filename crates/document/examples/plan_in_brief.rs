//! Reads a plan document and prints its verdict, its manoeuvre, its phases and its encounters.
//! Without an argument it reads a shipped one.
//!
//! ```text
//! cargo run -p searoom-document --example plan_in_brief -- plan.json
//! ```

use std::error::Error;
use std::path::PathBuf;

use searoom_document::{PLAN_MEBIBYTES, PlanDocument};
use searoom_input::read_text;

fn main() -> Result<(), Box<dyn Error>> {
    let shipped = concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../verification/examples/head-on.json"
    );
    let file = std::env::args_os()
        .nth(1)
        .map_or(PathBuf::from(shipped), PathBuf::from);
    let text = read_text(&file, PLAN_MEBIBYTES, "a plan document")?;
    let plan: PlanDocument = serde_json::from_str(&text)?;
    let safety = if plan.is_safe() { "safe" } else { "not safe" };
    println!("{}: {} ({safety})", plan.scenario, plan.verdict);
    match plan.departure_of_motion() {
        Some(departure) => println!("manoeuvre: {departure}"),
        None => println!("no manoeuvre"),
    }
    for phase in plan.phases_of_motion() {
        let (from, until) = (phase.from_s, phase.until_s);
        println!("{}: {from:.0} to {until:.0} s", phase.phase.word());
    }
    for leg in plan.motions() {
        let (at, course, length) = (leg.motion.start_time, leg.course_deg(), leg.motion.length());
        println!("from {at:.0} s: {length:.0} m, course {course:.0}° at its end");
    }
    for encounter in &plan.encounters {
        let (target, role) = (&encounter.target, &encounter.role);
        match encounter.dcpa_m.zip(encounter.tcpa_s) {
            Some((least, time)) => println!("'{target}' ({role}): {least:.0} m at {time:.0} s"),
            None => println!("'{target}' ({role})"),
        }
    }
    Ok(())
}
