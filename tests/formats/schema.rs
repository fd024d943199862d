//! The schema of scenario files against the reader: the same keys, words, limits and counts.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use searoom::scenario::{Fault, Scenario, scenario_schema};
use serde_json::{Map, Value, json};

/// Suffixes of one quantity, of which a file gives one.
const UNITS: [&str; 5] = ["_mps", "_kn", "_m", "_nmi", "_cbl"];

/// Files that have every table between them. They need no sense, and are on a late clock, because
/// no time may lie behind the present.
fn files() -> Vec<Value> {
    let position = json!({ "east_m": 0.0, "north_m": 0.0 });
    let circle = json!([[1.0, 0.0], [0.0, 1.0]]);
    let ship = json!({
        "name": "ship", "position": position, "course_deg": 0.0, "speed_mps": 1.0,
        "length_m": 10.0, "beam_m": 2.0, "role": "give-way", "not_reported": ["size"],
        "seen_from_s": 1.0, "position_set": { "vertices_m": [[0.0, 0.0]] }, "status": "moored",
        "domain": { "fore_m": 1.0, "aft_m": 1.0, "port_m": 1.0, "starboard_m": 1.0 },
    });
    let with = |table: &Value, key: &str, value: Value| {
        let mut table = table.clone();
        table[key] = value;
        table
    };
    let sets = json!({
        "name": "sets",
        "initial_set": { "center_m": [0.0, 0.0], "shape_m2": circle },
        "velocity_sets": [
            { "until_s": 9.0, "center_mps": [0.0, 0.0], "shape_m2_per_s2": circle },
            { "vertices_mps": [[0.0, 0.0]] },
        ],
    });
    let set = json!({ "vertices_mps": [[0.0, 0.0]] });
    let mut base = json!({
        "title": "all", "horizon_s": 100.0, "time_s": 1e10,
        "origin": { "lat_deg": 59.0, "lon_deg": 10.0 },
        "map": { "file": "none.geojson", "point_radius_m": 1.0 },
        "own_ship": {
            "position": position, "course_deg": 0.0, "speed_mps": 1.0, "length_m": 10.0,
            "beam_m": 2.0, "turning_radius_m": 9.0, "speeds_mps": [0.0, 1.0],
        },
        "mission": {
            "waypoints": [position, { "lat_deg": 59.0, "lon_deg": 10.1 }],
            "leg_speeds_mps": [1.0], "stay_until_s": 1e10,
            "alternatives": [[position, position]],
        },
        "planner": {
            "kind": "path-time", "objective": "length-risk", "risk_weight_m": 1.0, "tidy": true,
            "optimal_control": {
                "force_limits": { "surge_n": 1.0, "sway_n": 1.0, "yaw_nm": 1.0 },
                "state_weights": [1.0, 1.0, 1.0, 1.0, 1.0, 1.0], "control_weights": [1.0, 1.0, 1.0],
            },
        },
        "targets": [ship, sets, with(&ship, "domain", json!("hull"))],
        "simulation": { "current": {}, "vessel": {}, "sensor": {} },
    });
    base["targets"][0]["velocity_set"] = set.clone();
    base["targets"][1]["velocity_sets"][0]["vertices_mps"] = json!([[0.0, 0.0]]);
    base["targets"][1]["initial_set"]["vertices_m"] = json!([[0.0, 0.0]]);
    let point = json!({ "t_s": 1.0, "position": position });
    let mut behaviours: Vec<Value> = [
        "constant",
        "random",
        "extremes",
        "pursuit",
        "gives-way",
        "mutual",
    ]
    .map(|kind| json!({ "kind": kind }))
    .to_vec();
    behaviours.push(json!({ "kind": "track", "points": [point] }));
    let vessels = ["kinematic", "first-order", "nomoto"].map(|kind| json!({ "kind": kind }));
    let sensors = ["exact", "ais", "radar"].map(|kind| {
        json!({
            "kind": kind, "assumed": {}, "silent_s": [[0.0, 1.0]],
            "dropout": { "every_s": 1.0, "lasts_s": 1.0 },
        })
    });
    (behaviours.into_iter().enumerate())
        .map(|(index, behaviour)| {
            let mut file = base.clone();
            if index < 2 {
                let degrees = json!({ "lat_deg": 59.0, "lon_deg": 10.1 });
                file["targets"][2]["waypoints"] = json!([position, degrees]);
                file["targets"][2]["leg_speeds_mps"] = json!([1.0, 1.0]);
            }
            if index == 0 {
                for (table, stem) in [
                    ("/own_ship", "speeds"),
                    ("/mission", "leg_speeds"),
                    ("/targets/2", "leg_speeds"),
                ] {
                    let table = file.pointer_mut(table).and_then(Value::as_object_mut);
                    let table = table.expect("a table");
                    let speeds = table.remove(&format!("{stem}_mps")).expect("speeds");
                    table.insert(format!("{stem}_kn"), speeds);
                }
                file["targets"][1] = json!({
                    "name": "sets", "initial_set": { "vertices_m": [[0.0, 0.0]] },
                    "velocity_set": { "center_mps": [0.0, 0.0], "shape_m2_per_s2": circle },
                });
            }
            file["targets"][2]["behaviour"] = behaviour;
            file["simulation"]["vessel"] = vessels[index % 3].clone();
            file["simulation"]["sensor"] = sensors[index % 3].clone();
            file
        })
        .collect()
}

/// A value as TOML on one line.
fn toml_of(value: &Value) -> String {
    let pairs = |table: &Map<String, Value>| {
        let pairs = table
            .iter()
            .map(|(key, value)| format!("{key} = {}", toml_of(value)));
        pairs.collect::<Vec<_>>().join(", ")
    };
    match value {
        Value::Object(table) => format!("{{ {} }}", pairs(table)),
        Value::Array(list) => {
            format!(
                "[{}]",
                list.iter().map(toml_of).collect::<Vec<_>>().join(", ")
            )
        }
        other => other.to_string(),
    }
}

fn faults(file: &Value) -> Vec<Fault> {
    let table = file.as_object().expect("a table");
    let lines: Vec<String> = table
        .iter()
        .map(|(key, value)| format!("{key} = {}", toml_of(value)))
        .collect();
    Scenario::parse(&lines.join("\n")).err().unwrap_or_default()
}

/// What the reader allows at a place of a file.
fn allowed_at(file: &Value, place: &str) -> Option<String> {
    let found = faults(file).into_iter().find(|fault| fault.path == place);
    // a limit that files of other formats share names its unit
    let allowed = found?.allowed;
    let now = " (the present, 'time_s')";
    let allowed = allowed.trim_end_matches(now).trim_end_matches(" m");
    Some(allowed.to_owned())
}

/// The keywords of a value in the schema, as the reader would say them.
fn in_words(schema: &Value) -> Option<String> {
    let number = |key: &str| schema[key].as_f64();
    let limits = |schema: &Value| Some((schema["minimum"].as_f64()?, schema["maximum"].as_f64()?));
    if let Some(words) = schema["enum"].as_array() {
        return Some(
            words
                .iter()
                .map(Value::to_string)
                .collect::<Vec<_>>()
                .join(", "),
        );
    }
    let range = |(low, high): (f64, f64)| match low != 0.0 && low.abs() < 1e-9 {
        true => format!("a number from {low:e} to {high}"),
        false => format!("a number from {low} to {high}"),
    };
    match schema["type"].as_str()? {
        "integer" => Some(format!("a whole {}", &range(limits(schema)?)[2..])),
        // 0, or a range
        "number" if schema["anyOf"].is_array() => {
            Some(format!("0, or {}", range(limits(&schema["anyOf"][1])?)))
        }
        "number" => Some(range((number("minimum")?, number("maximum")?))),
        "boolean" => Some("true, false".to_owned()),
        _ => None,
    }
}

/// Compares the tables of a file with the reader, and collects what was seen of each in the schema.
struct Walk<'a> {
    schema: &'a Value,
    file: &'a Value,
    /// Keys that the reader knows, by the table's place in the schema.
    known: &'a mut BTreeMap<String, BTreeSet<String>>,
    /// Places in the schema whose limits or words the reader has confirmed.
    confirmed: &'a mut BTreeSet<String>,
}

impl Walk<'_> {
    fn resolved(&self, at: &str) -> String {
        let node = self.schema.pointer(at).expect(at);
        match node["$ref"].as_str() {
            Some(target) => target.trim_start_matches('#').to_owned(),
            None => at.to_owned(),
        }
    }

    /// Compares the value at `pointer` of the file, `place` in messages, with the schema at `at`.
    fn value(&mut self, at: &str, pointer: &str, place: &str) {
        let at = self.resolved(at);
        let value = self.file.pointer(pointer).expect(pointer);
        match value {
            Value::Object(table) => {
                match self.schema.pointer(&at).expect("there")["anyOf"][1]["properties"].is_object()
                {
                    true => self.table(&format!("{at}/anyOf/1"), table, pointer, place),
                    false => self.table(&at, table, pointer, place),
                }
            }
            Value::Array(items) => {
                for index in 0..items.len() {
                    let (item, place) = (format!("{pointer}/{index}"), format!("{place}[{index}]"));
                    let at = self.resolved(&format!("{at}/items"));
                    self.leaf(&at, &item, &place);
                    self.value(&at, &item, &place);
                }
            }
            _ => {}
        }
    }

    /// Puts something wrong in the place of a value, and compares what the reader allows there.
    fn leaf(&mut self, at: &str, pointer: &str, place: &str) {
        let schema = self.schema.pointer(at).expect(at);
        let alternative = format!("{at}/anyOf/0");
        let (at, schema) = match schema["anyOf"][0]["enum"].is_array() {
            true => (alternative.as_str(), &schema["anyOf"][0]),
            false => (at, schema),
        };
        let Some(wanted) = in_words(schema) else {
            return;
        };
        let mut file = self.file.clone();
        let (table, key) = pointer.rsplit_once('/').expect("a key");
        match file.pointer_mut(table).expect(table) {
            Value::Array(list) => list[key.parse::<usize>().expect("an index")] = json!("wrong"),
            table => {
                let table = table.as_object_mut().expect("a table");
                let stem = |key: &str| {
                    let unit = UNITS.into_iter().find_map(|unit| key.strip_suffix(unit));
                    unit.unwrap_or(key).to_owned()
                };
                table.retain(|other, _| stem(other) != stem(key));
                table.insert(key.to_owned(), json!("wrong"));
            }
        }
        let allowed = allowed_at(&file, place);
        // without the rest, as of a key that is ruled out by another one
        if allowed.as_ref().is_some_and(|allowed| *allowed == wanted) {
            self.confirmed.insert(at.to_owned());
        } else if let Some(allowed) = allowed {
            let other = ["nothing", "one of", "vertices, or"];
            let is_other = other.iter().any(|word| allowed.starts_with(word));
            assert!(
                is_other,
                "{place}: the reader allows {allowed}, the schema {wanted}"
            );
        }
    }

    fn table(&mut self, at: &str, table: &Map<String, Value>, pointer: &str, place: &str) {
        let schema = self.schema.pointer(at).expect(at).clone();
        assert_eq!(schema["additionalProperties"], json!(false), "{at}");
        let in_table = |key: &str| match place {
            "" => key.to_owned(),
            _ => format!("{place}.{key}"),
        };
        let mut file = self.file.clone();
        file.pointer_mut(pointer).expect("there")["zzz"] = json!(1);
        let known = allowed_at(&file, &in_table("zzz"));
        // a table that another key rules out is not read
        if let Some(keys) = known
            .as_ref()
            .and_then(|known| known.strip_prefix("one of "))
        {
            let keys = keys.split(", ").map(str::to_owned);
            self.known.entry(at.to_owned()).or_default().extend(keys);
            for key in schema["required"].as_array().into_iter().flatten() {
                let key = key.as_str().expect("a key");
                let mut file = self.file.clone();
                let table = file.pointer_mut(pointer).and_then(Value::as_object_mut);
                table.expect("there").remove(key);
                let allowed = allowed_at(&file, &in_table(key));
                let is_required = allowed.is_some_and(|a| a.contains("it is required"));
                assert!(is_required, "{}", in_table(key));
            }
        }
        for key in schema["properties"].as_object().expect(at).keys() {
            let (at, pointer) = (format!("{at}/properties/{key}"), format!("{pointer}/{key}"));
            let at = self.resolved(&at);
            self.leaf(&at, &pointer, &in_table(key));
            if table.contains_key(key) {
                self.value(&at, &pointer, &in_table(key));
            }
        }
    }
}

/// Every place of the schema at which something is to be confirmed.
fn places(schema: &Value, at: String, tables: &mut Vec<String>, leaves: &mut BTreeSet<String>) {
    if schema["properties"].is_object() {
        tables.push(at.clone());
    }
    if in_words(schema).is_some() {
        leaves.insert(at.clone());
        return;
    }
    match schema {
        Value::Object(all) => {
            for (key, value) in all.iter().filter(|(key, _)| *key != "required") {
                places(value, format!("{at}/{key}"), tables, leaves);
            }
        }
        Value::Array(all) => {
            for (index, value) in all.iter().enumerate() {
                places(value, format!("{at}/{index}"), tables, leaves);
            }
        }
        _ => {}
    }
}

#[test]
fn the_schema_has_the_keys_the_words_and_the_limits_of_the_reader() {
    let schema = scenario_schema();
    let (mut known, mut confirmed) = (BTreeMap::new(), BTreeSet::new());
    for file in files() {
        let mut walk = Walk {
            schema: &schema,
            file: &file,
            known: &mut known,
            confirmed: &mut confirmed,
        };
        walk.value("", "", "");
    }
    let (mut tables, mut leaves) = (Vec::new(), BTreeSet::new());
    places(&schema, String::new(), &mut tables, &mut leaves);
    for at in &tables {
        let keys = schema.pointer(at).expect("there")["properties"].as_object();
        let keys: BTreeSet<String> = keys.expect("keys").keys().cloned().collect();
        assert_eq!(known.get(at), Some(&keys), "{at}");
    }
    let missing: Vec<&String> = leaves.difference(&confirmed).collect();
    assert!(
        missing.is_empty(),
        "not confirmed by the reader: {missing:#?}"
    );
}

#[test]
fn every_scenario_of_the_project_fits_the_schema() {
    let validator = jsonschema::validator_for(&scenario_schema()).expect("a schema");
    let mut folders = vec![Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios")];
    let mut count = 0;
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "toml") {
                let text = std::fs::read_to_string(&path).expect("text");
                let file: Value = toml::from_str(&text).expect("TOML");
                let faults = validator.iter_errors(&file);
                let faults: Vec<String> = faults
                    .map(|f| format!("{}: {f}", f.instance_path()))
                    .collect();
                assert!(faults.is_empty(), "{}: {faults:#?}", path.display());
                count += 1;
            }
        }
    }
    assert!(count > 30, "{count}");
}

#[test]
fn a_file_that_lacks_a_key_or_has_a_wrong_one_does_not_fit_the_schema() {
    let validator = jsonschema::validator_for(&scenario_schema()).expect("a schema");
    let text = include_str!("../../scenarios/colregs/head-on.toml");
    for (old, new) in [
        ("title =", "titel ="),
        ("horizon_s = 400.0", "horizon_s = -1"),
        ("course_deg = 90.0", "course_deg = \"east\""),
        ("speed_mps = 5.0", "speed_mps = 500.0"),
        ("name = \"target\"", ""),
    ] {
        assert!(text.contains(old), "{old}");
        let file: Value = toml::from_str(&text.replacen(old, new, 1)).expect("TOML");
        assert!(!validator.is_valid(&file), "{new}");
    }
    // a target on a known route has the course of its first leg
    let mut file: Value = toml::from_str(text).expect("TOML");
    let target = file["targets"][0].as_object_mut().expect("a table");
    target.remove("course_deg");
    assert!(!validator.is_valid(&file));
    file["targets"][0]["waypoints"] = json!([{ "east_m": 0.0, "north_m": 0.0 }]);
    assert!(validator.is_valid(&file));
}
