//! A situation as the text of a scenario file: the only way from an imported file to a scenario, so
//! that importing a file and running it directly are the same.

use std::path::Path;

use super::assumed::{ASSUMED_SPEEDS, Assumed, HORIZON_ROUTES, TURNING_LENGTHS};
use super::situation::{GivenHull, Other, Own, OwnRoute, Situation};
use crate::{Scenario, limits};
use searoom_geometry::frame::{
    Geographic, Pose, Vector, course_deg_from_heading, deg_from_radians, heading_of,
};
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_input::Fault;
use searoom_model::target::route::{Spread, Track};
use searoom_model::target::{DomainKind, Motion, Status, Target};
use searoom_model::vessel::Hull;

/// A scenario made from an imported situation.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// The scenario.
    pub scenario: Scenario,
    /// The text of its scenario file.
    pub text: String,
    /// Assumptions and unused parts of the file, in sentences.
    pub notes: Vec<String>,
}

impl Situation {
    /// The scenario with its assumptions. Faults name the field of the imported file, or of the
    /// scenario file if only the whole is wrong.
    pub fn scenario(&self, assumed: &Assumed) -> Result<Imported, Vec<Fault>> {
        self.scenario_beside(assumed, Path::new(""))
    }

    /// [`Self::scenario`] in a folder, where its route file lies.
    pub fn scenario_beside(
        &self,
        assumed: &Assumed,
        folder: &Path,
    ) -> Result<Imported, Vec<Fault>> {
        let mut writing = Writing {
            assumed,
            text: String::new(),
            notes: self.remarks.notes.clone(),
            faults: Vec::new(),
            sizeless: Vec::new(),
            without_role: Vec::new(),
            taken: None,
        };
        writing.situation(self);
        if !writing.faults.is_empty() {
            return Err(writing.faults);
        }
        let mut notes = writing.notes;
        if let Some(Hull { length, beam }) = writing.taken {
            let whose = writing.sizeless.join(", ");
            notes.push(format!(
                "{whose}: no size in the file, {length} × {beam} m taken"
            ));
        }
        let heading: String = notes.iter().map(|note| format!("# {note}\n")).collect();
        let text = heading + &writing.text;
        let scenario = Scenario::parse_beside(&text, folder)?;
        let notes = [scenario.remarks.all(), notes].concat();
        Ok(Imported {
            scenario,
            text,
            notes,
        })
    }
}

struct Writing<'a> {
    assumed: &'a Assumed,
    text: String,
    notes: Vec<String>,
    faults: Vec<Fault>,
    /// Ships with an assumed hull, and this hull.
    sizeless: Vec<String>,
    /// Ships of which only a set is known, in which no rule sees a ship.
    without_role: Vec<String>,
    taken: Option<Hull>,
}

impl Writing<'_> {
    fn situation(&mut self, situation: &Situation) {
        let own = &situation.own;
        let horizon = own.horizon.unwrap_or(HORIZON_ROUTES * own.duration());
        let name = quoted(&situation.name);
        let start = situation.start_utc.as_ref();
        let start = start.map(|start| format!("start_utc = {start}\n"));
        let head =
            format!("title = {name}\nhorizon_s = {horizon:?}\n") + &start.unwrap_or_default();
        self.tables(situation, horizon);
        let mut remarks = situation.remarks.clone();
        if let [first, more @ ..] = &self.without_role[..] {
            let whom = match more {
                [] => format!("'{first}'"),
                _ => format!("{} ships", self.without_role.len()),
            };
            let statement = format_args!(
                "not applied: explicit sets, which have no role, hold the turns and speeds of '{}'",
                self.without_role.join("', '")
            );
            remarks.caution(format_args!("rules for {whom}"), statement);
        }
        let cautions: String = (remarks.cautions.iter())
            .map(|caution| format!("    {},\n", quoted(caution)))
            .collect();
        let cautions = match cautions.is_empty() {
            true => cautions,
            false => format!("cautions = [\n{cautions}]\n"),
        };
        self.text = head + &cautions + &self.text;
    }

    /// All that comes after the keys of the scenario itself.
    fn tables(&mut self, situation: &Situation, horizon: f64) {
        let own = &situation.own;
        if let Some(earth) = situation.earth {
            let Geographic { lat_deg, lon_deg } = earth.origin();
            self.text += &format!("origin = {{ lat_deg = {lat_deg:?}, lon_deg = {lon_deg:?} }}\n");
        }
        let Some(hull) = self.hull("own ship", &own.hull) else {
            return;
        };
        self.own_ship(own, hull);
        let margin = self.assumed.safety_margin(hull.length);
        // from a set to own ship's centre on any heading
        let clearance = |margin: f64| hull.half_diagonal() + margin;
        for other in &situation.others {
            match other {
                Other::Ship {
                    name,
                    hull,
                    track,
                    off,
                    status,
                } => {
                    if let Some(theirs) = self.hull(name, hull) {
                        let clearance = clearance(margin) + off;
                        self.name(name, *status);
                        self.ship(name, theirs, track, (clearance, *off), horizon);
                    }
                }
                Other::Tracked(target) => self.tracked(target),
                Other::Fixed {
                    name,
                    shape,
                    ground,
                } => {
                    let margin = if *ground { 0.0 } else { margin };
                    let disc = outer_disc(clearance(margin), 0.0);
                    let set = vertices(&shape.minkowski_sum(&disc));
                    self.text += &format!(
                        "\n[[targets]]\nname = {}\ninitial_set = {{ vertices_m = {set} }}\n\
                         velocity_set = {{ vertices_mps = [[0.0, 0.0]] }}\n",
                        quoted(name)
                    );
                }
            }
        }
    }

    fn own_ship(&mut self, own: &Own, hull: Hull) {
        let Hull { length, beam } = hull;
        self.text += &format!(
            "\n[own_ship]\n{}length_m = {length:?}\nbeam_m = {beam:?}\n\
             turning_radius_m = {:?}\nsafety_margin_m = {:?}\n",
            under_way(&own.pose, own.speed),
            TURNING_LENGTHS * length,
            self.assumed.safety_margin(length),
        );
        // at rest the speeds of the legs are own speeds
        let moving = [own.speed];
        let given = match &own.route {
            OwnRoute::Points { leg_speeds, .. } if own.speed == 0.0 => &leg_speeds[..],
            OwnRoute::File(_) if own.speed == 0.0 => &self.assumed.own_speed.map_or([1.0], |v| [v]),
            _ => &moving,
        };
        let fractions = given
            .iter()
            .flat_map(|v| ASSUMED_SPEEDS.map(|fraction| fraction * v));
        let mut speeds: Vec<f64> = fractions.collect();
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        self.text += &format!("speeds_mps = {speeds:?}\n");
        self.text += &match &own.route {
            OwnRoute::File(file) => format!(
                "\n[mission]\nroute = {}\nfrom_nearest = true\n",
                quoted(file)
            ),
            OwnRoute::Points { points, leg_speeds } => {
                let places = points.iter();
                let places: String = places.map(|p| format!("    {},\n", position(*p))).collect();
                format!("\n[mission]\nwaypoints = [\n{places}]\nleg_speeds_mps = {leg_speeds:?}\n")
            }
        };
    }

    /// The given or assumed hull; a fault if there is none.
    fn hull(&mut self, whose: &str, said: &GivenHull) -> Option<Hull> {
        let hull = match said {
            GivenHull::Known(hull) => return Some(*hull),
            GivenHull::NotInFormat => self.assumed.usual_hull(),
            GivenHull::Unknown { length, beam } => {
                let hull = self.assumed.large_hull(*length, *beam);
                let Hull { length, beam } = hull;
                self.notes.push(format!(
                    "{whose}: size unknown, 0 in the file; {length} × {beam} m taken, which \
                     --length-m and --beam-m change"
                ));
                return Some(hull);
            }
            GivenHull::Missing(path) => {
                let asked = self.assumed.asked_hull();
                if asked.is_none() {
                    let allowed = "the length and the breadth of the ship; or --length-m and \
                                   --beam-m for those without";
                    self.faults
                        .push(Fault::new(path.as_str(), "nothing", allowed));
                }
                asked?
            }
        };
        self.sizeless.push(whose.to_owned());
        self.taken = Some(hull);
        Some(hull)
    }

    /// A ship with its sets, as they are.
    fn tracked(&mut self, target: &Target) {
        let Motion::Ship(ship) = &target.motion else {
            return;
        };
        self.name(&target.name, target.status);
        let Hull { length, beam } = ship.hull;
        self.text += &format!(
            "{}length_m = {length:?}\nbeam_m = {beam:?}\n",
            under_way(&ship.pose, ship.speed)
        );
        match &ship.kept_positions {
            Some(places) => {
                self.text += &format!("position_set = {{ vertices_m = {} }}\n", vertices(places));
            }
            None => self.text += &format!("position_std_m = {:?}\n", ship.position_std),
        }
        let degrees = |key: &str, angle: f64| match angle == 0.0 {
            true => String::new(),
            false => format!(
                "{key} = {:?}\n",
                deg_from_radians(angle).clamp(-180.0, 180.0)
            ),
        };
        self.text += &format!("speed_spread_mps = {:?}\n", ship.speed_spread);
        self.text += &degrees("course_spread_deg", ship.course_spread);
        self.text += &degrees("starboard_turn_deg", ship.starboard_turn);
        if let Some(spread) = ship.heading_spread {
            let spread = deg_from_radians(spread).min(limits::COURSE_SPREAD.high);
            self.text += &format!("heading_spread_deg = {spread:?}\n");
        }
        if ship.domain == DomainKind::Hull {
            self.text += "domain = \"hull\"\n";
        }
    }

    /// The beginning of a target.
    fn name(&mut self, name: &str, status: Option<Status>) {
        self.text += &format!("\n[[targets]]\nname = {}\n", quoted(name));
        if let Some(status) = status {
            self.text += &format!("status = \"{status}\"\n");
        }
    }

    /// The motion of a target; `clearance` is the distance, metres, from its centre to own ship's in all, `off` how
    /// far it may be off its track.
    fn ship(
        &mut self,
        name: &str,
        hull: Hull,
        track: &Track,
        (clearance, off): (f64, f64),
        horizon: f64,
    ) {
        // the sets hold three standard deviations
        let place = match off > 0.0 {
            true => format!("position_std_m = {:?}\n", off / 3.0),
            false => String::new(),
        };
        let spread = Spread {
            speed: self.assumed.speed_spread,
            course: self.assumed.course_spread,
            time: 0.0,
            place: 0.0,
        };
        if let Some(steady) = track.steady(&spread) {
            let Hull { length, beam } = hull;
            let course_spread =
                deg_from_radians(steady.course_spread).min(limits::COURSE_SPREAD.high);
            self.text += &format!(
                "{}length_m = {length:?}\nbeam_m = {beam:?}\n{place}speed_spread_mps = {:?}\n\
                 course_spread_deg = {course_spread:?}\n",
                under_way(&steady.pose, steady.speed),
                steady.speed_spread
            );
        } else if let Some(legs) = track.known_legs(limits::TARGET_WAYPOINTS, hull.length) {
            let Hull { length, beam } = hull;
            let first = Pose::new(track.start, heading_of(legs[0].to - track.start));
            let places: Vec<String> = legs.iter().map(|leg| position(leg.to)).collect();
            let speeds: Vec<f64> = legs.iter().map(|leg| leg.speed).collect();
            self.text += &format!(
                "{}length_m = {length:?}\nbeam_m = {beam:?}\n{place}speed_spread_mps = {:?}\n\
                 course_spread_deg = {:?}\nwaypoints = [{}]\nleg_speeds_mps = {speeds:?}\n",
                under_way(&first, legs[0].speed),
                spread.speed,
                deg_from_radians(spread.course),
                places.join(", ")
            );
            self.notes
                .push(format!("{name}: a track with changes, as waypoints"));
        } else {
            // explicit sets have no hull: the initial set contains both hulls and the margin
            let around = outer_disc(hull.half_diagonal() + clearance, 0.0);
            let initial = vertices(&around.translated(track.start));
            self.text +=
                &format!("initial_set = {{ vertices_m = {initial} }}\nvelocity_sets = [\n");
            let sets = track.outer_velocity_sets(&spread, horizon, limits::VELOCITY_SETS);
            for (until, velocities) in sets {
                let until = match until {
                    f64::INFINITY => String::new(),
                    until => format!("until_s = {until:?}, "),
                };
                let velocities = vertices(&velocities);
                self.text += &format!("    {{ {until}vertices_mps = {velocities} }},\n");
            }
            self.text += "]\n";
            self.without_role.push(name.to_owned());
            self.notes.push(format!(
                "{name}: a track with changes, as velocity sets one after another; \
                 margin and hulls on any heading are in its set"
            ));
        }
        if track.end() < horizon {
            let (end, horizon) = (track.end(), horizon);
            self.notes.push(format!(
                "{name}: its track ends at {end:.0} s, before the horizon of {horizon:.0} s; \
                 taken to go on as on its last stretch"
            ));
        }
    }
}

/// A TOML string: TOML has the escapes of JSON.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn position(point: Vector) -> String {
    let (east, north) = (point.x + 0.0, point.y + 0.0);
    format!("{{ east_m = {east:?}, north_m = {north:?} }}")
}

/// Position, course and speed, a line each.
fn under_way(pose: &Pose, speed: f64) -> String {
    let course = course_deg_from_heading(pose.heading);
    let position = position(pose.position);
    format!("position = {position}\ncourse_deg = {course:?}\nspeed_mps = {speed:?}\n")
}

fn vertices(polygon: &ConvexPolygon) -> String {
    let points = polygon.vertices().iter();
    let points: Vec<[f64; 2]> = points.map(|v| [v.x + 0.0, v.y + 0.0]).collect();
    format!("{points:?}")
}
