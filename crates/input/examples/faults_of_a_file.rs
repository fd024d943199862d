//! Everything that is wrong with a small TOML file, each fault with its line.
//!
//! ```text
//! cargo run -p searoom-input --example faults_of_a_file
//! ```

use searoom_input::{Faults, Field, Range, from_toml};

const FILE: &str = "\
title = \"Buoys\"

[[buoys]]
name = \"north\"
light = \"quick\"
range_nmi = 3.0

[[buoys]]
name = \"south\"
light = \"blinking\"
range_m = -5.0
colour = \"green\"
";

/// A buoy with a light.
struct Buoy {
    name: String,
    is_quick: bool,
    /// Metres.
    range: f64,
}

/// The buoys of a file, or all of its faults.
fn buoys(text: &str) -> Result<Vec<Buoy>, Faults> {
    let faults = Faults::default();
    let read = || {
        let root = from_toml(text, &faults)?;
        let mut root = Field::root(&root, &faults).table("a table")?;
        root.require("title", "a text")?.line_of_text()?;
        let list = root.require("buoys", "a list of tables")?;
        let mut buoys = Vec::new();
        for field in list.list(1..=100, "tables")? {
            let mut table = field.table("a table")?;
            let name = table
                .require("name", "a name")
                .and_then(|f| f.line_of_text());
            let lights = [("quick", true), ("long", false)];
            let light = table
                .require("light", "a light")
                .and_then(|f| f.choice(&lights));
            let range = table.required_distance("range", Range::between(1.0, 50_000.0));
            table.finish();
            if let (Some(name), Some(is_quick), Some(range)) = (name, light, range) {
                let name = name.to_owned();
                buoys.push(Buoy {
                    name,
                    is_quick,
                    range,
                });
            }
        }
        root.finish();
        Some(buoys)
    };
    match read() {
        Some(buoys) if faults.is_empty() => Ok(buoys),
        _ => Err(faults),
    }
}

fn main() {
    match buoys(FILE) {
        Ok(buoys) => {
            for Buoy {
                name,
                is_quick,
                range,
            } in buoys
            {
                let light = if is_quick { "quick" } else { "long" };
                println!("{name}: {light}, {range} m");
            }
        }
        Err(faults) => {
            for fault in faults.take() {
                println!("{fault}");
            }
        }
    }
}
