//! The tables of docs/reference/colregs.md that show what the classifier and the judges say.

use std::f64::consts::{FRAC_PI_2, PI};

use searoom::colregs::compliance::{ComplianceReport, EncounterSamples};
use searoom::colregs::{Role, Sectors, SteadyShip, Thresholds, role_within};
use searoom::frame::{Pose, Vector, direction};
use searoom::target::ShipTrack;
use searoom::trajectory::{Segment, Trajectory};
use searoom::vessel::{Hull, OwnShip};

const DOCS: &str = include_str!("../../docs/reference/colregs.md");

/// Both ships of the table of motions: metres, m/s.
const HULL: Hull = Hull::new(50.0, 10.0);
const SPEED: f64 = 6.0;
const RADIUS: f64 = 125.0;

fn own_ship() -> OwnShip {
    OwnShip {
        pose: Pose::new(Vector::zeros(), 0.0),
        speed: SPEED,
        hull: HULL,
        turning_radius: RADIUS,
        speeds: vec![SPEED],
        safety_margin: 0.0,
        tracking_margin: 0.0,
    }
}

fn ship(position: Vector, heading: f64, speed: f64) -> SteadyShip {
    SteadyShip::new(Pose::new(position, heading), speed)
}

fn word(role: Option<Role>) -> &'static str {
    match role {
        Some(Role::HeadOn) => "H",
        Some(Role::GiveWay) => "G",
        Some(Role::StandOn) => "S",
        Some(Role::Overtaking) => "O",
        Some(Role::Overtaken) => "T",
        Some(Role::BothGiveWay) => "B",
        Some(Role::PortToPort) => "P",
        _ => "–",
    }
}

/// The classifier: bearing of the target, its course relative to own, and its speed.
fn table_of_roles() -> String {
    let courses: Vec<i32> = (0..8).map(|k| 45 * k).collect();
    let mut text = String::from("| speed | bearing |");
    for course in &courses {
        text += &format!(" {course:03}° |");
    }
    text += "\n|";
    text += &" --- |".repeat(courses.len() + 2);
    for ratio in [0.5, 1.0, 2.0] {
        for bearing in (0..16).map(|k| 22.5 * f64::from(k)) {
            text += &format!("\n| {ratio} | {bearing:05.1}° |");
            for course in &courses {
                let own = ship(Vector::zeros(), 0.0, SPEED);
                let place = direction(-bearing.to_radians()) * 1000.0;
                let heading = -f64::from(*course).to_radians();
                let target = ship(place, heading, ratio * SPEED);
                let nearing = place.dot(&(own.velocity() - target.velocity())) > 1e-6;
                let role = role_within(&own, &target, &Sectors::STANDARD).filter(|_| nearing);
                text += &format!(" {} |", word(role));
            }
        }
    }
    text
}

/// A time, a turn in degrees to starboard, and the speed from then on.
type Change = (f64, f64, f64);

/// Own motion to the east: turns in degrees to starboard and speeds, each from a time on.
fn motion(changes: &[Change]) -> Trajectory {
    let mut segments: Vec<Segment> = Vec::new();
    let mut add = |duration: f64, speed: f64, turn_rate: f64| {
        let last = segments.last();
        let start = last.map_or(Pose::new(Vector::zeros(), 0.0), Segment::end);
        let time = last.map_or(0.0, Segment::end_time);
        if duration > 0.0 {
            segments.push(Segment::new(start, time, duration, speed, turn_rate));
        }
        time + duration.max(0.0)
    };
    let (mut time, mut speed) = (0.0, SPEED);
    for &(from, turn, next) in changes {
        add(from - time, speed, 0.0);
        speed = next;
        let turn = -turn.to_radians();
        time = add(
            turn.abs() * RADIUS / speed,
            speed,
            turn.signum() * speed / RADIUS,
        );
    }
    add(600.0 - time, speed, 0.0);
    Trajectory::new(segments).expect("a trajectory")
}

/// The judges: motions of own ship in five encounters that would collide after 300 s.
fn table_of_motions() -> String {
    let targets = [
        ("head-on", ship(Vector::new(3600.0, 0.0), PI, 6.0)),
        (
            "give-way",
            ship(Vector::new(1800.0, -1800.0), FRAC_PI_2, 6.0),
        ),
        (
            "stand-on",
            ship(Vector::new(1800.0, 1800.0), -FRAC_PI_2, 6.0),
        ),
        ("overtaking", ship(Vector::new(1080.0, 0.0), 0.0, 2.4)),
        ("overtaken", ship(Vector::new(-1080.0, 0.0), 0.0, 9.6)),
    ];
    let (full, half) = (SPEED, 0.5 * SPEED);
    let motions: [(&str, &[Change]); 12] = [
        ("holds course and speed", &[]),
        (
            "30° to starboard at 30 s, back at 400 s",
            &[(30.0, 30.0, full), (400.0, -30.0, full)],
        ),
        (
            "30° to starboard at 30 s, back at 150 s",
            &[(30.0, 30.0, full), (150.0, -30.0, full)],
        ),
        ("30° to starboard at 130 s", &[(130.0, 30.0, full)]),
        ("60° to starboard at 230 s", &[(230.0, 60.0, full)]),
        ("12° to starboard at 30 s", &[(30.0, 12.0, full)]),
        (
            "10° to starboard at 30, 60 and 90 s",
            &[(30.0, 10.0, full), (60.0, 10.0, full), (90.0, 10.0, full)],
        ),
        ("30° to port at 30 s", &[(30.0, -30.0, full)]),
        ("60° to port at 230 s", &[(230.0, -60.0, full)]),
        ("half speed at 30 s", &[(30.0, 0.0, half)]),
        (
            "half speed from 30 to 50 s",
            &[(30.0, 0.0, half), (50.0, 0.0, full)],
        ),
        (
            "half speed at 30 s, 30° to starboard at 90 s",
            &[(30.0, 0.0, half), (90.0, 30.0, half)],
        ),
    ];
    let mut text = String::from("| motion |");
    for (name, _) in &targets {
        text += &format!(" {name} |");
    }
    text += &format!("\n|{}", " --- |".repeat(targets.len() + 1));
    for (name, changes) in motions {
        let own = motion(changes);
        text += &format!("\n| {name} |");
        for (role, target) in &targets {
            let track = ShipTrack::exact(target.pose, target.speed, HULL);
            let samples = EncounterSamples::along(&own, &own_ship(), &track);
            let report = ComplianceReport::judge(&samples, Thresholds::standard());
            assert_eq!(report.roles[0].role.word(), *role);
            let mut broken: Vec<&str> = report.broken().collect();
            broken.dedup();
            let broken = broken.join(", ");
            text += &format!(" {} |", if broken.is_empty() { "–" } else { &broken });
        }
    }
    text
}

#[test]
fn the_tables_of_the_documentation_are_what_the_program_says() {
    for table in [table_of_roles(), table_of_motions()] {
        assert!(
            DOCS.contains(&format!("\n{table}\n")),
            "docs/reference/colregs.md has another table than this:\n{table}"
        );
    }
}
