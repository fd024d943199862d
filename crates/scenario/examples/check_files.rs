//! Reads scenario files, and prints what is in each or everything that is wrong with it. Without
//! arguments it reads one that is shipped, and its text with two faults.
//!
//! ```text
//! cargo run -p searoom-scenario --example check_files -- scenarios/colregs/*.toml
//! ```

use std::path::{Path, PathBuf};

use searoom_scenario::{Scenario, ScenarioError};

/// A scenario in one line.
fn content(scenario: &Scenario) -> String {
    let targets = scenario.targets.len();
    let length = scenario.desired.length();
    let planner = scenario.planner.facts().name;
    let unfit = match scenario.unfit().first() {
        None => String::new(),
        Some(first) => format!("; its planner cannot use it: {first}"),
    };
    let title = &scenario.title;
    format!("{title}: {length:.0} m, targets: {targets}, planner: {planner}{unfit}")
}

fn print(read: Result<Scenario, ScenarioError>) {
    match read {
        Ok(scenario) => println!("{}", content(&scenario)),
        Err(error) => println!("{error}"),
    }
}

fn main() -> std::io::Result<()> {
    let files: Vec<PathBuf> = std::env::args_os().skip(1).map(PathBuf::from).collect();
    for file in &files {
        print(Scenario::read(file));
    }
    if files.is_empty() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let shipped = root.join("scenarios/colregs/head-on.toml");
        print(Scenario::read(&shipped));
        let text = std::fs::read_to_string(&shipped)?;
        let faulty =
            text.replacen("beam_m", "baem_m", 1)
                .replacen("speed_mps = 5", "speed_mps = 500", 1);
        let read = Scenario::parse(&faulty);
        print(read.map_err(|faults| ScenarioError::faults(Path::new("with faults"), faults)));
    }
    Ok(())
}
