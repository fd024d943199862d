//! Why own ship alters course or speed: the set that it would enter if it held on.

use searoom_document::{
    LEAST_DEPARTURE_DEG, ObstacleDocument, PlanDocument, PlannedLeg, PositionDocument,
};

use crate::document::encounter::has_role;
use crate::frame::{Pose, Vector, deg_from_radians, heading_of, wrap};
use crate::geometry::{ConvexPolygon, Window};
use crate::obstacle::{LAND, LandObstacle, Obstacle, SpaceTimeObstacle};
use crate::target::Uncertainty;
use crate::tolerance;
use crate::trajectory::Segment;
use crate::vessel::Hull;

/// Metres. Plans run along the edges of sets: what is no deeper in a set does not enter it.
const DEPTH_M: f64 = 0.01;

/// Radians. A smaller departure from the mission's course is none.
const COURSE_RAD: f64 = 0.01;

/// Degrees. The least turn of a manoeuvre by the rules, and one that needs a word.
const LEAST_TURN_DEG: f64 = 30.0;
const LARGE_TURN_DEG: f64 = 90.0;

/// Speeds that differ by a smaller fraction are one.
const SPEED: f64 = 0.01;

/// Leg of the mission, the way along it, and its distance from a place in metres.
struct NearestLeg {
    index: usize,
    along: Vector,
    off: f64,
}

/// Own ship before an alteration: the last leg, or its course and speed at the present.
pub(super) struct Before {
    pub heading: f64,
    pub speed: f64,
}

/// The reason why a leg alters course or speed: the target whose set own ship would enter first if
/// it went on as `before`, or [`LAND`]. `legs` begins with this leg.
///
/// `None` where the leg alters nothing, or comes back to the mission's course or speed, or
/// where nothing would be entered. Along a path own ship would keep to the path, and to the mission
/// where it is on it. The sets are those that the plan keeps out of. O(sets × legs).
pub(super) fn reason<'a>(
    plan: &'a PlanDocument,
    before: &Before,
    legs: &[PlannedLeg],
) -> Option<&'a str> {
    let leg = &legs[0].motion;
    let (course, speed) = desired_at(plan, leg.start.position)?;
    let off = |heading: f64| wrap(heading - course).abs();
    let turns = off(leg.end().heading) > off(before.heading) + COURSE_RAD;
    let differs = |a: f64, b: f64| (a - b).abs() > SPEED * a.max(b);
    let changes_speed = differs(leg.speed, before.speed)
        && (leg.speed - speed).abs() > (before.speed - speed).abs();
    let is_along_path = plan.path_time.is_some();
    if !(before.speed > 0.0 && (changes_speed || turns && !is_along_path)) {
        return None;
    }
    let held: Vec<Segment> = if is_along_path {
        at_one_speed(legs, before.speed)
    } else {
        going_on(plan, leg, before)
    };
    entered(plan, &held)
}

/// True for a turn of the mission itself: own ship is on the mission before it, and on a later leg
/// after it.
pub(super) fn follows_mission(plan: &PlanDocument, before: &Before, leg: &Segment) -> bool {
    let on = |place: Vector, heading: f64| {
        let near = nearest_leg(plan, place)?;
        let turned = deg_from_radians(wrap(heading - heading_of(near.along)).abs());
        let is_on = turned < LEAST_DEPARTURE_DEG && near.off <= plan.own_ship.length_m;
        is_on.then_some(near.index)
    };
    let end = leg.end();
    let [from, to] = [
        on(leg.start.position, before.heading),
        on(end.position, end.heading),
    ];
    leg.is_arc() && from.is_some() && to > from
}

/// Own ship's motion if it did not alter at the start of a leg: along the mission to its end
/// where it is on it, else straight on until the horizon.
fn going_on(plan: &PlanDocument, leg: &Segment, before: &Before) -> Vec<Segment> {
    let mut at = Pose::new(leg.start.position, before.heading);
    let mut time = leg.start_time;
    let straight = |at, time| {
        let left = plan.horizon_s - time;
        vec![Segment::straight(at, time, left, before.speed)]
    };
    let Some(near) = nearest_leg(plan, at.position) else {
        return straight(at, time);
    };
    let turned = wrap(before.heading - heading_of(near.along)).abs();
    if turned > COURSE_RAD || near.off > plan.own_ship.length_m {
        return straight(at, time);
    }
    let ahead = plan.mission.waypoints.iter().skip(near.index + 1);
    let segment = |to: &PositionDocument| {
        let way = to.point() - at.position;
        let start = Pose::new(at.position, heading_of(way));
        let duration = way.norm() / before.speed;
        let segment = Segment::straight(start, time, duration, before.speed);
        (at, time) = (segment.end(), segment.end_time());
        segment
    };
    ahead.map(segment).filter(|s| s.duration > 0.0).collect()
}

/// Target that delays the return on leg `index` to the mission's course or speed, or [`LAND`]: the first set
/// entered if the rest of the plan began at the start of the straight leg, or of the wait, before it.
/// O(sets × legs).
pub(super) fn waited_for<'a>(
    plan: &'a PlanDocument,
    legs: &[PlannedLeg],
    index: usize,
) -> Option<&'a str> {
    let rest = &legs[index..];
    let (last, leg) = (&legs[index.checked_sub(1)?].motion, &rest[0].motion);
    let (course, speed) = desired_at(plan, leg.start.position)?;
    let off = |heading: f64| wrap(heading - course).abs();
    let is_along_path = plan.path_time.is_some();
    let turns_back = off(leg.end().heading) < off(last.end().heading) - COURSE_RAD;
    let resumes =
        (leg.speed - speed).abs() < (last.speed - speed).abs() - SPEED * leg.speed.max(speed);
    if last.is_arc() || !(resumes || turns_back && !is_along_path) {
        return None;
    }
    // along a path own ship comes back where it does, but with the speed after it so far
    let (mut held, way) = match is_along_path {
        true => (
            at_one_speed(&legs[index - 1..index], leg.speed),
            Vector::zeros(),
        ),
        false => (Vec::new(), last.start.position - leg.start.position),
    };
    let begins = held.last().map_or(last.start_time, Segment::end_time);
    let moved = |rest: &PlannedLeg| {
        let mut motion = rest.motion;
        motion.start.position += way;
        motion.start_time += begins - leg.start_time;
        motion
    };
    held.extend(rest.iter().map(moved));
    entered(plan, &held)
}

/// Why a large turn of a manoeuvre by the rules is no smaller: the turns, in whole 5° from
/// [`LEAST_TURN_DEG`] on, after which own ship would enter a set on its new course before the
/// manoeuvre is over. `None` for other turns, and where most smaller ones are clear: then the
/// mission was cheaper to reach after the large one.
pub(super) fn lesser_turns(plan: &PlanDocument, leg: &PlannedLeg) -> Option<String> {
    let (whole, start) = (leg.turn_deg().abs(), leg.motion.start_time);
    let begins = |begins: f64| (begins - start).abs() < tolerance::TIME_S;
    let manoeuvre = plan.manoeuvres.iter().find(|m| begins(m.begins_s))?;
    if whole < LARGE_TURN_DEG {
        return None;
    }
    let met = |turn: f64| {
        let until = start + leg.motion.duration * turn / whole;
        let arc = leg.motion.between(start, until);
        let left = manoeuvre.returns_s - until;
        let on = Segment::straight(arc.end(), until, left, arc.speed);
        Some((turn, entered(plan, &[arc, on])?))
    };
    let turns = (0..).map(|k| LEAST_TURN_DEG + 5.0 * f64::from(k));
    let turns = turns.take_while(|turn| *turn < whole);
    let met: Vec<(f64, &str)> = turns.map_while(met).collect();
    let (most, name) = *met.last()?;
    let is_one = met.iter().all(|(_, other)| *other == name);
    let what = match name {
        LAND if is_one => "land".to_owned(),
        _ if is_one => format!("the set of '{name}'"),
        _ if met.iter().any(|(_, other)| *other == LAND) => "a set or land".to_owned(),
        _ => "a set".to_owned(),
    };
    (most >= 0.5 * whole)
        .then(|| format!("a turn of {LEAST_TURN_DEG} to {most}° would enter {what}"))
}

/// Direction and speed of the mission's nearest leg.
fn desired_at(plan: &PlanDocument, place: Vector) -> Option<(f64, f64)> {
    let near = nearest_leg(plan, place)?;
    let speed = plan.mission.leg_speeds_mps.get(near.index)?;
    Some((heading_of(near.along), *speed))
}

fn nearest_leg(plan: &PlanDocument, place: Vector) -> Option<NearestLeg> {
    let points = plan.mission.waypoints.iter().map(PositionDocument::point);
    let points: Vec<Vector> = points.collect();
    let near = points.windows(2).enumerate().map(|(index, ends)| {
        let along = ends[1] - ends[0];
        let part = ((place - ends[0]).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
        let off = (ends[0] + along * part - place).norm();
        NearestLeg { index, along, off }
    });
    near.min_by(|a, b| a.off.total_cmp(&b.off))
}

/// The target whose set a motion enters first, or [`LAND`]. In a manoeuvre by the rules, which is
/// for the ships with a role, those without one come last.
fn entered<'a>(plan: &'a PlanDocument, held: &[Segment]) -> Option<&'a str> {
    let begins = held.first()?.start_time;
    let is_by_rules = (plan.manoeuvres.iter())
        .any(|m| (m.begins_s - tolerance::TIME_S..m.returns_s).contains(&begins));
    let is_last = |set: &&ObstacleDocument| {
        let mut encounters = plan.encounters.iter();
        is_by_rules && encounters.any(|e| e.target == set.name && !has_role(e.role))
    };
    let (last, first): (Vec<_>, Vec<_>) = plan.obstacles.iter().partition(is_last);
    let ashore = ashore(plan, held).map(|time| (time, LAND));
    let first = first_entered(held, first).into_iter().chain(ashore);
    let first = first.min_by(|a, b| a.0.total_cmp(&b.0));
    Some(first.or_else(|| first_entered(held, last))?.1)
}

/// When a motion first comes too near to land.
fn ashore(plan: &PlanDocument, held: &[Segment]) -> Option<f64> {
    let own = &plan.own_ship;
    let radius = Hull::new(own.length_m, own.beam_m).half_diagonal() + own.land_margin_m;
    let swept = swept(held)?;
    let pieces = plan.land.iter().filter_map(|piece| {
        let vertices: Vec<Vector> = piece.iter().map(|[x, y]| Vector::new(*x, *y)).collect();
        let near = Window::around(&vertices)?.grown(radius).meets(&swept);
        near.then(|| ConvexPolygon::hull(&vertices).ok())?
    });
    let pieces: Vec<ConvexPolygon> = pieces.collect();
    let land = LandObstacle::around(&pieces, radius);
    held.iter().find_map(|s| land.first_contact(s, DEPTH_M))
}

/// The first of these sets that a motion enters, and when. Only what is before a contact is tested
/// against the next set.
fn first_entered<'a>(held: &[Segment], sets: Vec<&'a ObstacleDocument>) -> Option<(f64, &'a str)> {
    let mut held = held.to_vec();
    let mut first = None;
    for set in sets {
        if let Some(time) = enters(&held, set)
            && first.is_none_or(|(before, _)| time < before)
        {
            first = Some((time, set.name.as_str()));
            held.retain(|s| s.start_time < time);
            if let Some(last) = held.last_mut() {
                *last = last.between(last.start_time, time);
            }
        }
    }
    first
}

/// When a motion enters a set.
fn enters(held: &[Segment], set: &ObstacleDocument) -> Option<f64> {
    let [from, until] = set.valid_s;
    let (place, reach) = set.initial_set.disc();
    let (drift, spread) = set.velocity_set.disc();
    let parts = held
        .iter()
        .filter(|s| s.start_time <= until && s.end_time() >= from);
    let parts = parts.map(|s| s.part(s.start_time.max(from), s.end_time().min(until), from));
    // by discs around the set, and around an arc
    let is_near = |part: &Segment| {
        let (at, way, beside) = match part.is_arc() {
            true => (part.middle().position, Vector::zeros(), 0.5 * part.length()),
            false => (part.start.position, part.velocity_at(part.start_time), 0.0),
        };
        let off = at - place - drift * part.start_time;
        let closing = way - drift;
        let nearest = -off.dot(&closing) / closing.norm_squared();
        let nearest = nearest.max(0.0).min(part.duration);
        let apart = (off + closing * nearest).norm();
        // negated on purpose: a NaN is near
        !(apart > reach + spread * part.end_time() + beside)
    };
    let near: Vec<Segment> = parts.filter(is_near).collect();
    if near.is_empty() {
        return None;
    }
    let (initial, velocity) = (set.initial_set.set().ok()?, set.velocity_set.set().ok()?);
    let obstacle = Obstacle::new("", Uncertainty::constant(initial, velocity)).ok()?;
    let contact = |part: &Segment| obstacle.first_contact(part, DEPTH_M);
    Some(from + near.iter().find_map(contact)?)
}

/// A box around a motion.
fn swept(motion: &[Segment]) -> Option<Window> {
    let ends = motion
        .iter()
        .flat_map(|s| [s.start.position, s.end().position]);
    let ends: Vec<Vector> = ends.collect();
    // an arc is within its own length of its ends
    let arcs = motion.iter().filter(|s| s.is_arc()).map(Segment::length);
    Some(Window::around(&ends)?.grown(arcs.fold(0.0, f64::max)))
}

/// The motion of legs without their waits and with one speed, m/s.
fn at_one_speed(legs: &[PlannedLeg], speed: f64) -> Vec<Segment> {
    let mut time = legs[0].motion.start_time;
    let moving = legs.iter().filter(|leg| !leg.waits());
    let at_speed = moving.map(|leg| {
        let motion = &leg.motion;
        let duration = motion.length() / speed;
        let turned = motion.turn_rate * motion.duration;
        let segment = Segment::new(motion.start, time, duration, speed, turned / duration);
        time += duration;
        segment
    });
    at_speed.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::planned_legs;
    use crate::pipeline;
    use crate::scenario::Scenario;

    const CORNER: &str = "{ east_m = 600.0, north_m = 0.0 }, { east_m = 600.0, north_m = 3000.0 }]";

    fn planned(name: &str) -> PlanDocument {
        let file = format!("scenarios/{name}.toml");
        let scenario = Scenario::read(file.as_ref()).expect("valid");
        PlanDocument::of(&pipeline::run(scenario))
    }

    /// The first of the sets in which a place at each half second is, by their sections.
    fn scanned(plan: &PlanDocument, held: &Segment) -> Option<String> {
        let steps = (held.duration / 0.5) as u32;
        let times = (0..=steps).map(|k| held.start_time + 0.5 * f64::from(k));
        let mut times = times.filter(|time| *time <= plan.horizon_s);
        times.find_map(|time| {
            let place = held.pose_at(time).position;
            let mut sets = plan.obstacles.iter();
            let inside = sets.find(|set| {
                let [from, until] = set.valid_s;
                let initial = set.initial_set.set().expect("convex");
                let velocity = set.velocity_set.set().expect("convex");
                let sets = Uncertainty::constant(initial, velocity);
                (from..=until).contains(&time)
                    && sets.outer_section(time - from).signed_distance(place) < -DEPTH_M
            });
            Some(inside?.name.clone())
        })
    }

    /// Against the definition: sections of all sets, every half second.
    #[test]
    fn an_alteration_is_for_the_set_that_would_be_entered_first() {
        let mut found = 0;
        let mut without = 0;
        for name in [
            "colregs/give-way",
            "colregs/head-on",
            "colregs/overtaking",
            "colregs/stand-on",
            "uncertainty/turning",
        ] {
            let plan = planned(name);
            let mut before = Before {
                heading: crate::frame::heading_from_course_deg(plan.own_ship.course_deg),
                speed: plan.own_ship.speed_mps,
            };
            let legs = plan.motions();
            for (index, leg) in legs.iter().enumerate() {
                let start = Pose::new(leg.motion.start.position, before.heading);
                let left = plan.horizon_s - leg.motion.start_time;
                let held = Segment::straight(start, leg.motion.start_time, left, before.speed);
                match reason(&plan, &before, &legs[index..]) {
                    Some(target) => {
                        found += 1;
                        assert_eq!(Some(target), scanned(&plan, &held).as_deref(), "{name}");
                    }
                    None => without += 1,
                }
                before = Before {
                    heading: leg.motion.end().heading,
                    speed: leg.motion.speed,
                };
            }
        }
        assert!(found >= 5 && without >= 15, "{found} {without}");
    }

    #[test]
    fn the_first_alteration_has_its_target_and_the_return_has_none() {
        let plan = planned("colregs/head-on");
        let legs = planned_legs(&plan);
        let because: Vec<Option<&str>> = legs.iter().map(|l| l.because_of.as_deref()).collect();
        assert_eq!(because[1], Some("target"), "{because:?}");
        assert_eq!(because.iter().flatten().count(), 1, "{because:?}");
        assert_eq!(legs[1].events[0], "turns for 'target'");
        let events: Vec<&str> = legs
            .iter()
            .flat_map(|l| &l.events)
            .map(String::as_str)
            .collect();
        assert!(events.contains(&"turns back after 'target'"), "{events:?}");
        // it would be free to return, but the rules ask for the other to be past
        let legs = planned_legs(&planned("harbour/munkholmen"));
        assert_eq!(legs[3].events, ["returns after 'ferry'"], "{legs:?}");
    }

    /// Against sections of the sets, every half second.
    #[test]
    fn a_large_turn_says_after_which_a_set_would_be_entered() {
        let plan = planned("uncertainty/known-route");
        let turn = &planned_legs(&plan)[1];
        let told = "a turn of 30 to 85° would enter the set of 'ferry'";
        assert_eq!(turn.events[1], told, "{turn:?}");
        let (motion, back) = (&turn.motion, plan.manoeuvres[0].returns_s);
        let enters = |degrees: f64| {
            let until = motion.start_time + motion.duration * degrees / turn.turn_deg();
            let arc = motion.between(motion.start_time, until);
            let on = Segment::straight(arc.end(), until, back - until, arc.speed);
            [arc, on].iter().any(|part| scanned(&plan, part).is_some())
        };
        assert!((30..=85).all(|degrees| enters(f64::from(degrees))));
        assert!(!enters(turn.turn_deg()));
        let small = planned_legs(&planned("colregs/give-way"));
        assert_eq!(small[1].events.len(), 2, "{small:?}");
    }

    /// Straight on there is land, but the mission turns before it.
    #[test]
    fn who_does_not_alter_goes_on_along_the_mission() {
        let legs = planned_legs(&planned("closed-loop/harbour-ferries"));
        assert_eq!(legs[3].events[0], "turns for 'fast ferry'", "{legs:?}");
        assert_eq!(legs[7].events, ["returns after 'fast ferry'"], "{legs:?}");
    }

    /// Own ship would meet the tug on the second leg, long after the corner.
    #[test]
    fn a_turn_at_a_corner_follows_the_mission() {
        let text = include_str!("../../../scenarios/colregs/give-way.toml");
        let text = (text.replace("{ east_m = 1500.0, north_m = 0.0 }]", CORNER))
            .replace(
                "{ east_m = 750.0, north_m = -750.0 }",
                "{ east_m = 3000, north_m = 1800 }",
            )
            .replace("course_deg = 0.0 ", "course_deg = 270.0 ")
            .replace("horizon_s = 400.0", "horizon_s = 900.0");
        let legs = planned_legs(&PlanDocument::of(&pipeline::run(
            Scenario::parse(&text).expect("valid"),
        )));
        let events: Vec<&str> = (legs.iter().take(4))
            .map(|leg| leg.events.first().map_or("", |event| event))
            .collect();
        let expected = ["", "follows the mission", "", "turns for 'target'"];
        assert_eq!(events, expected, "{legs:?}");
    }

    /// Own ship would enter the set of 'slow' first, which passes beyond the CPA limit: as own ship
    /// alters for it, it has a role.
    #[test]
    fn a_manoeuvre_by_the_rules_is_for_the_ship_that_is_met_first() {
        let text = r#"title = "crossing"
            horizon_s = 1500
            own_ship = { position = { east_m = 0, north_m = 0 }, course_deg = 0, speed_kn = 12,
                length_m = 70, beam_m = 12, turning_radius_m = 220, speeds_kn = [6, 9, 12] }
            mission = { waypoints = [{ east_m = 0, north_m = 0 }, { east_m = 0, north_m = 5566 }] }
            targets = [{ name = "slow", position = { east_m = 256, north_m = 1113 }, course_deg = 0,
                speed_kn = 5, length_m = 60, beam_m = 11, position_std_m = 10,
                speed_spread_kn = 0.5, course_spread_deg = 5 },
                { name = "crossing", position = { east_m = 3197, north_m = 2783 }, course_deg = 270,
                speed_kn = 13, length_m = 120, beam_m = 20, position_std_m = 10,
                speed_spread_kn = 0.5, course_spread_deg = 3 }]"#;
        let plan = PlanDocument::of(&pipeline::run(Scenario::parse(text).expect("valid")));
        let turn = &planned_legs(&plan)[1];
        assert_eq!(turn.because_of.as_deref(), Some("slow"), "{turn:?}");
        let held = going_on(
            &plan,
            &turn.motion,
            &Before {
                heading: turn.motion.start.heading,
                speed: turn.motion.speed,
            },
        );
        assert_eq!(scanned(&plan, &held[0]).as_deref(), Some("slow"));
    }

    #[test]
    fn along_a_path_own_ship_slows_for_the_ship_that_it_would_meet() {
        for (name, target) in [
            ("harbour/ferry-crossing", "trawler"),
            ("harbour/ferry-crossing-slowest", "sailing boat"),
        ] {
            let legs = planned_legs(&planned(name));
            let because = legs.iter().filter_map(|l| l.because_of.as_deref());
            assert_eq!(because.collect::<Vec<_>>(), [target], "{legs:?}");
        }
    }
}
