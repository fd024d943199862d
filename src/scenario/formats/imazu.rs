//! Imazu's encounters as one JSON file: `own_ship` for all of them, `cases` and `variants` of them.

use std::cell::RefCell;

use super::super::fault::Fault;
use super::super::limits;
use super::json::Json;
use super::situation::{Declared, HullSaid, Other, Own, Situation};
use super::track::Track;
use crate::frame::{Pose, Side, Vector, heading_from_course_deg, wrap};

/// Cases of one file.
const CASES: usize = 10_000;

/// Every case, each with its faults alone; an error where nothing can be read at all.
pub(super) fn situations(
    root: &Json,
    faults: &RefCell<Vec<Fault>>,
    variants: bool,
) -> Result<Vec<Result<Situation, Vec<Fault>>>, Vec<Fault>> {
    let own = root
        .require("own_ship", "an object: own ship of every case")
        .and_then(|entry| own(&entry));
    let mut cases = root
        .require("cases", "a list of cases")
        .and_then(|entry| entry.list(1, CASES, "cases"));
    if variants && let Some(entry) = root.take("variants") {
        let more = entry.list(0, CASES, "variants");
        cases = cases.zip(more).map(|(cases, more)| [cases, more].concat());
    }
    let noted = faults.take();
    let (Some(own), Some(cases), true) = (own, cases, noted.is_empty()) else {
        return Err(noted);
    };
    Ok(cases.iter().map(|entry| case(entry, &own)).collect())
}

fn point(entry: &Json, keys: [&str; 2]) -> Option<Vector> {
    let [east, north] = keys.map(|key| entry.required_number(key, limits::COORDINATE, "m"));
    Some(Vector::new(east?, north?))
}

fn course(entry: &Json) -> Option<f64> {
    let course = entry.required_number("course_deg", limits::COURSE, "degrees")?;
    Some(heading_from_course_deg(course))
}

fn own(entry: &Json) -> Option<Own> {
    let start = point(entry, ["east_m", "north_m"]);
    let heading = course(entry);
    let speed = entry.required_number("speed_mps", limits::SHIP_WAY, "m/s");
    let goal = point(entry, ["goal_east_m", "goal_north_m"]);
    let (start, goal, speed) = (start?, goal?, speed?);
    if !((goal - start).norm() >= limits::LENGTH.low) {
        entry.fault("a goal where own ship is", "a goal ahead of her");
        return None;
    }
    Some(Own {
        pose: Pose::new(start, heading?),
        speed,
        hull: HullSaid::Unsaid,
        route: vec![start, goal],
        leg_speeds: vec![speed],
        horizon: None,
    })
}

fn case(entry: &Json, own: &Own) -> Result<Situation, Vec<Fault>> {
    let faults = RefCell::default();
    let entry = entry.noting(&faults);
    let id = entry
        .require("id", "the name of the case")
        .and_then(|id| id.text());
    let others = entry
        .require("targets", "a list of ships")
        .and_then(|list| list.list(0, limits::SHIPS, "ships"))
        .map(|list| {
            let ships = list.iter().enumerate();
            let ships: Vec<_> = ships.map(|(index, entry)| ship(index, entry)).collect();
            ships.into_iter().collect::<Option<Vec<_>>>()
        });
    let (Some(id), Some(Some(others)), true) = (id, others, faults.borrow().is_empty()) else {
        return Err(faults.into_inner());
    };
    Ok(Situation {
        name: id.to_owned(),
        id: Some(id.to_owned()),
        own: own.clone(),
        others,
        earth: None,
        declared: declared(&entry, own),
        notes: Vec::new(),
    })
}

/// How many ships the case has in Imazu's table, and the sides that the bearings give.
fn declared(entry: &Json, own: &Own) -> Declared {
    let said = |entry: &Json, key: &str| entry.take(key).and_then(|value| value.quiet());
    let ships = said(entry, "case").and_then(|case| match case as u32 {
        1..=4 => Some(1),
        5..=11 => Some(2),
        12..=22 => Some(3),
        _ => None,
    });
    let list = entry.take("targets");
    let targets = list.and_then(|list| list.list(0, limits::SHIPS, "ships"));
    let side = |ship: &Json| {
        let bearing = heading_from_course_deg(said(ship, "bearing_deg")?);
        Side::of_turn(wrap(bearing - own.pose.heading))
    };
    Declared {
        ships,
        sides: targets.iter().flatten().map(side).collect(),
    }
}

fn ship(index: usize, entry: &Json) -> Option<Other> {
    let start = point(entry, ["east_m", "north_m"]);
    let heading = course(entry);
    let speed = entry.required_number("speed_mps", limits::SHIP_SPEED, "m/s");
    Some(Other::Ship {
        name: format!("target {}", index + 1),
        hull: HullSaid::Unsaid,
        track: Track::straight(start?, heading?, speed?),
    })
}
