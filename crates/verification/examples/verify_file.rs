//! Verifies plan documents given as files, and prints the verdict, the margins to the targets and
//! every violation. Without arguments it verifies a shipped plan, and then a copy whose motion is
//! displaced by a metre.
//!
//! ```text
//! cargo run -p searoom-verification --example verify_file -- plan.json
//! ```

use std::error::Error;
use std::path::Path;

use searoom_document::{PLAN_MEBIBYTES, PlanDocument};
use searoom_input::read_text;
use searoom_verification::{Verification, verify, verify_document};

fn print(name: &str, found: &Verification) {
    let verdict = match (found.verified(), found.safe()) {
        (true, true) => "verified and safe",
        (true, false) => "verified, and not safe",
        (false, _) => "rejected",
    };
    println!("{name}: {}: {verdict}", found.scenario);
    let passages = found.evaluation.iter().flat_map(|found| &found.passages);
    for (target, passage) in found.targets.iter().zip(passages) {
        let (least, time) = (passage.min_margin, passage.min_margin_time);
        println!("  {least:.3} m from the set of '{target}' at {time:.0} s");
    }
    for violation in &found.violations {
        println!("  at {:.1} s: {}", violation.time, violation.what);
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let files: Vec<String> = std::env::args().skip(1).collect();
    for file in &files {
        let text = read_text(Path::new(file), PLAN_MEBIBYTES, "a plan document")?;
        print(file, &verify(&text)?);
    }
    if files.is_empty() {
        let text = include_str!("head-on.json");
        print("head-on.json", &verify(text)?);
        let mut displaced: PlanDocument = serde_json::from_str(text)?;
        let trajectory = displaced.trajectory.as_mut();
        for segment in trajectory
            .and_then(|t| t.segments.as_mut())
            .into_iter()
            .flatten()
        {
            segment.start.north_m += 1.0;
        }
        print("displaced", &verify_document(&displaced)?);
    }
    Ok(())
}
