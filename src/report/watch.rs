//! Text of a moment of a watch.

use super::table::{Display, Grid, plain};
use crate::document::{DangerousShipDocument, WatchDocument, WatchPlanDocument};
use crate::frame::knots_from_mps;
use crate::text::{counted, knots, tenths};

/// Metres of a nautical mile.
const MILE_M: f64 = 1852.0;

/// What is not known, or does not happen.
const NONE: &str = "–";

/// Most legs of a plan that are shown: what is to be done now, and then.
const LEGS: usize = 3;

/// Own ship, the ships with risk of collision, and the next legs of the plan.
pub fn watch_text(moment: &WatchDocument, display: Display) -> String {
    let mut lines = vec![headline(moment)];
    lines.extend(
        moment
            .in_no_set
            .iter()
            .map(|caution| format!("  in no set: {caution}")),
    );
    lines.extend(moment.events.iter().map(|event| format!("  {event}")));
    if !moment.dangerous.is_empty() {
        lines.push(table(&moment.dangerous, display));
    }
    if let Some(plan) = &moment.plan {
        lines.extend(legs(plan));
    }
    lines.join("\n")
}

fn headline(moment: &WatchDocument) -> String {
    let ships = counted(moment.ships, "ship");
    let beyond = match moment.beyond {
        0 => String::new(),
        beyond => format!(", {beyond} farther"),
    };
    let Some(own) = &moment.own else {
        return format!(
            "{}: own ship's place is not known; {ships} near{beyond}",
            moment.time
        );
    };
    let danger = match moment.dangerous.len() {
        _ if !moment.risk_computed => "risk is NOT computed".to_owned(),
        0 if !moment.in_no_set.is_empty() => "no risk with the ships in sets".to_owned(),
        0 => "no risk of collision".to_owned(),
        count => format!("risk of collision with {count}"),
    };
    format!(
        "{}: own ship {} {}, ±{:.0} m; {ships} near{beyond}; {danger}",
        moment.time,
        course(own.course_deg),
        knots(own.speed_mps),
        own.radius_m
    )
}

fn course(degrees: f64) -> String {
    format!("{:03}°", (degrees.round() as i64).rem_euclid(360))
}

/// Minutes and seconds.
fn clock(seconds: f64) -> String {
    let whole = seconds.max(0.0).round() as u64;
    format!("{}:{:02}", whole / 60, whole % 60)
}

fn table(ships: &[DangerousShipDocument], display: Display) -> String {
    let rows = ships.iter().map(|ship| {
        let status = ship
            .status
            .map_or(String::new(), |status| status.to_string());
        let row = [
            ship.name.clone(),
            status,
            format!("{:.2}", ship.range_m / MILE_M),
            course(ship.bearing_deg),
            ship.course_deg.map_or(NONE.to_owned(), course),
            (ship.speed_mps).map_or(NONE.to_owned(), |speed| tenths(knots_from_mps(speed))),
            (ship.cpa_m).map_or(NONE.to_owned(), |metres| format!("{:.2}", metres / MILE_M)),
            ship.tcpa_s.map_or(NONE.to_owned(), clock),
            ship.enters_set_s.map_or(NONE.to_owned(), clock),
            format!("{:.2}", ship.risk),
            ship.role.clone(),
            format!("{:.0}", ship.age_s),
        ];
        row.map(plain).to_vec()
    });
    let header = "ship, status, range\n[nm], bearing, course, speed\n[kn], CPA\n[nm], TCPA, in its set\nin, risk, own ship, age\n[s]";
    Grid::new(header, 2..10, rows).text(display)
}

fn legs(plan: &WatchPlanDocument) -> Vec<String> {
    let kept = if plan.keeps_plan { ", goes on" } else { "" };
    let mut lines = vec![format!("plan: {}{kept}", plan.verdict)];
    if !plan.arrives {
        lines.push(format!(
            "  does not arrive: it ends in {}, and nothing is claimed after that",
            clock(plan.ends_s)
        ));
    }
    lines.extend(
        plan.warnings
            .iter()
            .map(|warning| format!("  warning: {warning}")),
    );
    for leg in plan.legs.iter().take(LEGS) {
        let why = leg
            .because_of
            .as_ref()
            .map_or(String::new(), |target| format!(" for '{target}'"));
        lines.push(format!(
            "  {} to {}: {} {}{why}",
            clock(leg.from_s),
            clock(leg.until_s),
            course(leg.course_deg),
            knots(leg.speed_mps)
        ));
    }
    lines
}
