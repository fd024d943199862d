//! Text of a simulation.

use super::table::{Grid, Tone, or_dash, plain};
use crate::document::{SimulatedTargetDocument, SimulationDocument, conduct_breaks};
use crate::text::tenths;

/// Formats the headline, a table of the targets, own ship's conduct, the cycles and the alarms.
pub fn simulation_text(simulation: &SimulationDocument, colour: bool) -> String {
    let mut blocks = vec![headline(simulation)];
    if !simulation.targets.is_empty() {
        blocks.push(targets(&simulation.targets, colour));
    }
    blocks.push(conduct(simulation));
    if !simulation.alarms.is_empty() {
        blocks.push(alarms(simulation));
    }
    blocks.join("\n\n")
}

fn headline(simulation: &SimulationDocument) -> String {
    let met: Vec<&str> = (simulation.targets.iter())
        .filter(|target| target.contact_t_s.is_some())
        .map(|target| target.name.as_str())
        .collect();
    let outcome = match (simulation.contact, simulation.safe) {
        (true, _) => format!("CONTACT with {}", met.join(", ")),
        (false, true) => "no contact, every plan safe".to_owned(),
        (false, false) => "no contact, but NOT SAFE".to_owned(),
    };
    let mut broken = Vec::new();
    if !simulation.conduct.within_tracking_margin {
        broken.push("own ship left its tracking margin".to_owned());
    }
    let left = simulation.targets.iter().filter(|t| t.outside_sets > 0);
    broken.extend(left.map(|target| format!("'{}' left its set", target.name)));
    let broken = match broken.is_empty() {
        true => String::new(),
        false => format!(" ({})", broken.join(", ")),
    };
    let arrived = if simulation.arrived {
        "arrived"
    } else {
        "not arrived"
    };
    format!(
        "{}: {outcome}{broken}; {arrived} after {:.0} s",
        simulation.scenario, simulation.duration_s
    )
}

fn targets(targets: &[SimulatedTargetDocument], colour: bool) -> String {
    let rows = targets.iter().map(|target| {
        let roles: Vec<&str> = target
            .conduct
            .roles
            .iter()
            .map(|r| r.role.as_str())
            .collect();
        let broken = conduct_breaks(&target.conduct);
        let clearance = match (target.least_clearance_m, target.contact_t_s) {
            (Some(metres), None) => plain(tenths(metres)),
            (metres, _) => (metres.map_or("contact".to_owned(), tenths), Tone::Bad),
        };
        let manoeuvre = target.conduct.manoeuvre.as_ref();
        vec![
            plain(target.name.clone()),
            plain(target.behaviour.clone()),
            or_dash((!roles.is_empty()).then(|| roles.join("\n"))),
            clearance,
            plain(format!("{:.0}", target.least_clearance_t_s)),
            or_dash(
                manoeuvre
                    .and_then(|m| m.lead_s)
                    .map(|lead| format!("{lead:.0}")),
            ),
            plain(target.outside_sets.to_string()),
            or_dash((!broken.is_empty()).then(|| broken.join(" "))),
        ]
    });
    Grid {
        header: vec![
            "target",
            "behaviour",
            "role",
            "clearance\n[m]",
            "at\n[s]",
            "acts before\n[s]",
            "outside\nits set",
            "breaks",
        ],
        numbers: 3..7,
        rows: rows.collect(),
    }
    .text(colour)
}

fn conduct(simulation: &SimulationDocument) -> String {
    let (sailed, timing) = (&simulation.conduct, &simulation.timing);
    let first = sailed.first_plan_cost_m2;
    let share = first
        .filter(|first| *first > 0.0)
        .map_or(String::new(), |first| {
            format!(", {:.2} of the first plan's", sailed.cost_m2 / first)
        });
    let breaks = match sailed.breaks.is_empty() {
        true => "nothing".to_owned(),
        false => sailed.breaks.join(" "),
    };
    let plans = simulation.replans.len();
    let kept = simulation.replans.iter().filter(|r| r.keeps_plan).count();
    [
        format!(
            "Sailed: J {:.0} m²{share}; turns {}, changes of speed {}; breaks {breaks}",
            sailed.cost_m2, sailed.turns, sailed.speed_changes
        ),
        format!(
            "Plans: {plans}, {kept} kept from the one before; manoeuvres replaced {}, to the other side {}; \
             remainders lost {}, unsafe {}, without a plan {}",
            sailed.replaced_manoeuvres,
            sailed.side_switches,
            sailed.lost_remainders,
            sailed.unsafe_plans,
            sailed.without_plan
        ),
        format!(
            "Off the plan: at most {:.2} m, at {:.0} s, {} the tracking margin",
            sailed.largest_off_plan_m,
            sailed.largest_off_plan_t_s,
            if sailed.within_tracking_margin { "within" } else { "BEYOND" }
        ),
        format!(
            "Planning: {:.1} ms in the median, {:.1} ms at 99 %, {:.1} ms at most",
            timing.quantile_ms(0.5),
            timing.quantile_ms(0.99),
            timing.quantile_ms(1.0)
        ),
    ]
    .join("\n")
}

/// Alarms that are listed; the others are counted.
const LISTED: usize = 12;

fn alarms(simulation: &SimulationDocument) -> String {
    let mut lines: Vec<String> = (simulation.alarms.iter().take(LISTED))
        .map(|alarm| {
            let target = alarm.target.as_ref();
            let target = target.map_or(String::new(), |target| format!(": {target}"));
            format!("alarm at {:.0} s: {}{target}", alarm.t_s, alarm.alarm)
        })
        .collect();
    if let Some(more) = simulation
        .alarms
        .len()
        .checked_sub(LISTED)
        .filter(|more| *more > 0)
    {
        lines.push(format!("and {more} more"));
    }
    lines.join("\n")
}
