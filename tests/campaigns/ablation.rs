//! Settings of the space-time planner that a campaign varies: `--set group.name=value`.

use searoom::planner::SpaceTimeSettings;
use toml::{Table, Value};

use super::encounter_generator::SETTINGS;

/// Plans with changed settings from now on. Each change is a line of TOML with a dotted key.
pub fn set(changes: &[String]) -> Result<(), String> {
    let changed = changed(changes)?;
    SETTINGS.set(changed).map_err(|_| "set twice".to_owned())
}

fn changed(changes: &[String]) -> Result<SpaceTimeSettings, String> {
    let mut all = Table::try_from(SpaceTimeSettings::DEFAULT).map_err(|e| e.to_string())?;
    for change in changes {
        let parsed: Table = change
            .parse()
            .map_err(|_| format!("--set {change}: not of the form group.name=value"))?;
        replace(&mut all, parsed);
    }
    if let Some(found) = unbounded(&Value::Table(all.clone())) {
        return Err(format!("--set: {found} is not finite"));
    }
    all.try_into().map_err(|e| format!("--set: {e}"))
}

/// A number that is infinite or none.
fn unbounded(value: &Value) -> Option<f64> {
    match value {
        Value::Float(number) => (!number.is_finite()).then_some(*number),
        Value::Array(values) => values.iter().find_map(unbounded),
        Value::Table(table) => table.values().find_map(unbounded),
        _ => None,
    }
}

/// Replaces values at any depth; a name that is not there is added, and refused afterwards.
fn replace(all: &mut Table, by: Table) {
    for (name, value) in by {
        match (all.get_mut(&name), value) {
            (Some(Value::Table(group)), Value::Table(by)) => replace(group, by),
            (_, value) => {
                all.insert(name, value);
            }
        }
    }
}

#[test]
fn a_setting_is_changed_and_an_unknown_one_is_refused() {
    let with = |change: &str| changed(&[change.to_owned()]);
    let expected = SpaceTimeSettings {
        conflicts: searoom::planner::space_time::settings::ConflictSettings {
            lead_s: 200.0,
            ..SpaceTimeSettings::DEFAULT.conflicts
        },
        ..SpaceTimeSettings::DEFAULT
    };
    assert_eq!(with("conflicts.lead_s = 200"), Ok(expected));
    let budget = with("budgets.one_target.leaders=1").expect("a setting");
    assert_eq!(budget.budgets.one_target.leaders, 1);
    for (change, found) in [
        ("conflicts.led_s=1", "unknown field `led_s`"),
        ("conflicts.lead_s=\"1\"", "invalid type"),
        ("conflicts", "not of the form group.name=value"),
        ("conflicts.lead_s=inf", "inf is not finite"),
    ] {
        let error = with(change).expect_err("refused");
        assert!(error.contains(found), "{error}");
    }
}
