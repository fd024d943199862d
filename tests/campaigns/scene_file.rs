//! Random encounters as scenario files, by which another version or another program plans the same.

use std::fmt::Write;
use std::path::Path;

use searoom::frame::{Pose, Vector, deg_from_radians};
use searoom::planner::SearchKind;
use searoom::scenario::{Compliance, Scenario};

/// The file of a scene of [`super::encounter_generator`]. Panics for one that has more than those.
pub fn text(scenario: &Scenario) -> String {
    let mut text = String::new();
    let mut line = |line: String| writeln!(text, "{line}").expect("text grows");
    let own = &scenario.own_ship;
    line(format!("title = {:?}", scenario.title));
    line(format!("horizon_s = {:?}\n\n[own_ship]", scenario.horizon));
    line(ship(own.pose, own.speed));
    line(format!(
        "length_m = {:?}\nbeam_m = {:?}\nturning_radius_m = {:?}\nspeeds_mps = {:?}\nsafety_margin_m = {:?}",
        own.hull.length, own.hull.beam, own.turning_radius, own.speeds, own.safety_margin
    ));
    let legs = scenario.desired.legs();
    let of_the_generator = legs.len() == 1
        && scenario.land.is_none()
        && scenario.max_risk == 0.0
        && scenario.search == SearchKind::AStar
        && own.tracking_margin == 0.0;
    assert!(of_the_generator, "more than is written");
    let corners = legs.iter().map(|leg| leg.start);
    let corners = corners.chain([scenario.desired.end()]).map(place);
    let corners: Vec<String> = corners.collect();
    line(format!("\n[mission]\nwaypoints = [{}]", corners.join(", ")));
    line(format!("speed_mps = {:?}", legs[0].speed));
    line(format!(
        "\n[planner]\ncompliance = {:?}\ntime_weight_m2_per_s2 = {:?}",
        word(scenario.compliance),
        scenario.time_weight
    ));
    for target in &scenario.targets {
        let track = target.ship().expect("the generator draws ships");
        line(format!("\n[[targets]]\nname = {:?}", target.name));
        line(ship(track.pose, track.speed));
        line(format!(
            "length_m = {:?}\nbeam_m = {:?}\nposition_std_m = {:?}\nspeed_spread_mps = {:?}\ncourse_spread_deg = {:?}",
            track.hull.length,
            track.hull.beam,
            track.position_std,
            track.speed_spread,
            deg_from_radians(track.course_spread)
        ));
    }
    text
}

/// Writes the file of a scene to a folder.
pub fn write(folder: &Path, name: &str, scenario: &Scenario) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    std::fs::write(folder.join(name), text(scenario))
}

fn word(compliance: Compliance) -> &'static str {
    let mut words = Compliance::WORDS.iter();
    let found = words.find(|(_, level)| *level == compliance);
    found.expect("every level has a word").0
}

fn place(at: Vector) -> String {
    format!("{{ east_m = {:?}, north_m = {:?} }}", at.x, at.y)
}

fn ship(pose: Pose, speed: f64) -> String {
    let course = (90.0 - deg_from_radians(pose.heading)).rem_euclid(360.0);
    format!(
        "position = {}\ncourse_deg = {course:?}\nspeed_mps = {speed:?}",
        place(pose.position)
    )
}
