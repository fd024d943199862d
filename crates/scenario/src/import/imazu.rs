//! Imazu's encounters as one JSON file: `own_ship` for all of them, `cases` and `variants` of them.

use super::situation::{Declared, GivenHull, Other, Own, OwnRoute, Situation};
use crate::limits;
use searoom_geometry::frame::{Pose, Side, Vector, heading_from_course_deg, wrap};
use searoom_input::{Fault, Faults, Field, Remarks, every};
use searoom_model::target::route::Track;

/// Cases of one file.
const CASES: usize = 10_000;

/// Every case, each with its own faults; an error if no case can be read.
pub(super) fn situations(
    root: &Field,
    faults: &Faults,
    variants: bool,
) -> Result<Vec<Result<Situation, Vec<Fault>>>, Vec<Fault>> {
    let own = root
        .require("own_ship", "an object: own ship of every case")
        .and_then(|field| own(&field));
    let mut cases = root
        .require("cases", "a list of cases")
        .and_then(|field| field.list(1..=CASES, "cases"));
    if variants && let Some(field) = root.get("variants") {
        let more = field.list(0..=CASES, "variants");
        cases = cases.zip(more).map(|(cases, more)| [cases, more].concat());
    }
    let noted = faults.take();
    let (Some(own), Some(cases), true) = (own, cases, noted.is_empty()) else {
        return Err(noted);
    };
    Ok(cases.iter().map(|field| case(field, &own)).collect())
}

fn point(field: &Field, keys: [&str; 2]) -> Option<Vector> {
    let [east, north] = keys.map(|key| field.required_number(key, limits::COORDINATE.in_unit("m")));
    Some(Vector::new(east?, north?))
}

fn course(field: &Field) -> Option<f64> {
    let course = field.required_number("course_deg", limits::COURSE.in_unit("degrees"))?;
    Some(heading_from_course_deg(course))
}

fn own(field: &Field) -> Option<Own> {
    let start = point(field, ["east_m", "north_m"]);
    let heading = course(field);
    let speed = field.required_number("speed_mps", limits::SHIP_WAY);
    let goal = point(field, ["goal_east_m", "goal_north_m"]);
    let (start, goal, speed) = (start?, goal?, speed?);
    if !((goal - start).norm() >= limits::LENGTH.low) {
        return field.reject("a goal where own ship is", "a goal ahead of it");
    }
    Some(Own {
        pose: Pose::new(start, heading?),
        speed,
        hull: GivenHull::NotInFormat,
        route: OwnRoute::Points {
            points: vec![start, goal],
            leg_speeds: vec![speed],
        },
        horizon: None,
    })
}

fn case(field: &Field, own: &Own) -> Result<Situation, Vec<Fault>> {
    let faults = Faults::default();
    let field = field.noting(&faults);
    let id = field
        .require("id", "the name of the case")
        .and_then(|id| id.line_of_text());
    let others = field
        .require("targets", "a list of ships")
        .and_then(|list| list.list(0..=limits::SHIPS, "ships"))
        .and_then(|list| every(list.iter().enumerate().map(ship)));
    let (Some(id), Some(others), true) = (id.map(str::trim), others, faults.is_empty()) else {
        return Err(faults.take());
    };
    Ok(Situation {
        name: id.to_owned(),
        id: Some(id.to_owned()),
        start_utc: None,
        own: own.clone(),
        others,
        earth: None,
        declared: declared(&field, own),
        remarks: Remarks::default(),
    })
}

/// Number of ships in Imazu's table, and the sides that the bearings give.
fn declared(field: &Field, own: &Own) -> Declared {
    let number = |field: &Field, key: &str| field.get(key).and_then(|value| value.any_number());
    let ships = number(field, "case").and_then(|case| match case as u32 {
        1..=4 => Some(1),
        5..=11 => Some(2),
        12..=22 => Some(3),
        _ => None,
    });
    let list = field.get("targets");
    let targets = list.and_then(|list| list.list(0..=limits::SHIPS, "ships"));
    let side = |ship: &Field| {
        let bearing = heading_from_course_deg(number(ship, "bearing_deg")?);
        Side::of_turn(wrap(bearing - own.pose.heading))
    };
    Declared {
        ships,
        sides: targets.iter().flatten().map(side).collect(),
    }
}

fn ship((index, field): (usize, &Field)) -> Option<Other> {
    let start = point(field, ["east_m", "north_m"]);
    let heading = course(field);
    let speed = field.required_number("speed_mps", limits::SHIP_SPEED);
    Some(Other::Ship {
        name: format!("target {}", index + 1),
        hull: GivenHull::NotInFormat,
        track: Track::straight(start?, heading?, speed?),
        off: 0.0,
        status: None,
    })
}
