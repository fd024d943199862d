//! A situation as the text of a scenario file: the only way from an imported file to a scenario, so
//! that importing a file and running it directly are the same.

use std::fmt::{Display, Write};

use super::assumed::{Assumed, HORIZON_ROUTES, TURNING_LENGTHS};
use super::situation::{GivenHull, Other, Own, Situation};
use super::track::{Spread, Track};
use crate::frame::{Vector, course_deg_from_heading, deg_from_radians};
use crate::geometry::{ConvexPolygon, outer_disc};
use crate::input::Fault;
use crate::scenario::{Scenario, limits};
use crate::vessel::Hull;

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
        let mut writing = Writing::new(self, assumed);
        writing.situation();
        let Writing {
            text,
            mut notes,
            faults,
            sizeless,
            taken,
            ..
        } = writing;
        if !faults.is_empty() {
            return Err(faults);
        }
        if let Some(Hull { length, beam }) = taken {
            let whose = sizeless.join(", ");
            notes.push(format!(
                "{whose}: no size in the file, {length} × {beam} m taken"
            ));
        }
        let heading: String = notes.iter().map(|note| format!("# {note}\n")).collect();
        let text = format!("{heading}{text}");
        Ok(Imported {
            scenario: Scenario::parse(&text)?,
            text,
            notes,
        })
    }
}

/// The text so far.
struct Writing<'a> {
    situation: &'a Situation,
    assumed: &'a Assumed,
    text: String,
    notes: Vec<String>,
    faults: Vec<Fault>,
    /// Ships with an assumed hull, and this hull.
    sizeless: Vec<String>,
    taken: Option<Hull>,
}

impl<'a> Writing<'a> {
    fn new(situation: &'a Situation, assumed: &'a Assumed) -> Self {
        Self {
            situation,
            assumed,
            text: String::new(),
            notes: situation.notes.clone(),
            faults: Vec::new(),
            sizeless: Vec::new(),
            taken: None,
        }
    }

    fn line(&mut self, line: impl Display) {
        // writing to a string cannot fail
        let _ = writeln!(self.text, "{line}");
    }

    fn situation(&mut self) {
        let situation = self.situation;
        let own = &situation.own;
        let horizon = own.horizon.unwrap_or(HORIZON_ROUTES * own.duration());
        self.line(format_args!("title = {}", quoted(&situation.name)));
        self.line(format_args!("horizon_s = {horizon:?}"));
        if let Some(earth) = situation.earth {
            let origin = earth.origin();
            self.line(format_args!(
                "origin = {{ lat_deg = {:?}, lon_deg = {:?} }}",
                origin.lat_deg, origin.lon_deg
            ));
        }
        let Some(hull) = self.hull("own ship", &own.hull) else {
            return;
        };
        self.own_ship(own, hull);
        for other in &situation.others {
            match other {
                Other::Ship { name, hull, track } => {
                    if let Some(theirs) = self.hull(name, hull) {
                        self.ship(
                            name,
                            theirs,
                            track,
                            hull_clearance(&hull_of(own, self.assumed), self.assumed),
                            horizon,
                        );
                    }
                }
                Other::Fixed {
                    name,
                    shape,
                    ground,
                } => {
                    let own = hull_of(own, self.assumed);
                    let margin = if *ground {
                        0.0
                    } else {
                        self.assumed.safety_margin(own.length)
                    };
                    let disc = outer_disc(own.half_diagonal() + margin, 0.0);
                    self.line(format_args!("\n[[targets]]\nname = {}", quoted(name)));
                    let set = vertices(&shape.minkowski_sum(&disc));
                    self.line(format_args!("initial_set = {{ vertices_m = {set} }}"));
                    self.line("velocity_set = { vertices_mps = [[0.0, 0.0]] }");
                }
            }
        }
    }

    fn own_ship(&mut self, own: &Own, hull: Hull) {
        self.line("\n[own_ship]");
        self.line(format_args!("position = {}", position(own.pose.position)));
        self.line(format_args!(
            "course_deg = {:?}",
            course_deg_from_heading(own.pose.heading)
        ));
        self.line(format_args!("speed_mps = {:?}", own.speed));
        self.line(format_args!(
            "length_m = {:?}\nbeam_m = {:?}",
            hull.length, hull.beam
        ));
        self.line(format_args!(
            "turning_radius_m = {:?}",
            TURNING_LENGTHS * hull.length
        ));
        let margin = self.assumed.safety_margin(hull.length);
        self.line(format_args!("safety_margin_m = {margin:?}"));
        if own.speed == 0.0 {
            // the default speeds of a scenario file are fractions of own speed
            let speeds: Vec<f64> = own
                .leg_speeds
                .iter()
                .flat_map(|v| [0.5 * v, *v, 1.2 * v])
                .collect();
            self.line(format_args!("speeds_mps = {speeds:?}"));
        }
        let route: Vec<String> = own
            .route
            .iter()
            .map(|p| format!("    {},\n", position(*p)))
            .collect();
        self.line(format_args!(
            "\n[mission]\nwaypoints = [\n{}]",
            route.concat()
        ));
        self.line(format_args!("leg_speeds_mps = {:?}", own.leg_speeds));
    }

    /// The given or assumed hull; a fault if there is none.
    fn hull(&mut self, whose: &str, said: &GivenHull) -> Option<Hull> {
        match said {
            GivenHull::Known(hull) => Some(*hull),
            GivenHull::NotInFormat => {
                let hull = self.assumed.usual_hull();
                self.assume(whose, hull);
                Some(hull)
            }
            GivenHull::Missing(path) => match self.assumed.asked_hull() {
                Some(hull) => {
                    self.assume(whose, hull);
                    Some(hull)
                }
                None => {
                    let allowed = "the length and the breadth of the ship; or --length-m and \
                                   --beam-m for those without";
                    self.faults
                        .push(Fault::new(path.as_str(), "nothing", allowed));
                    None
                }
            },
        }
    }

    fn assume(&mut self, whose: &str, hull: Hull) {
        self.sizeless.push(whose.to_owned());
        self.taken = Some(hull);
    }

    fn ship(&mut self, name: &str, hull: Hull, track: &Track, clearance: f64, horizon: f64) {
        let spread = Spread {
            speed: self.assumed.speed_spread(),
            course: self.assumed.course_spread(),
        };
        self.line(format_args!("\n[[targets]]\nname = {}", quoted(name)));
        if let Some(steady) = track.steady(&spread) {
            self.line(format_args!(
                "position = {}",
                position(steady.pose.position)
            ));
            self.line(format_args!(
                "course_deg = {:?}",
                course_deg_from_heading(steady.pose.heading)
            ));
            self.line(format_args!("speed_mps = {:?}", steady.speed));
            self.line(format_args!(
                "length_m = {:?}\nbeam_m = {:?}",
                hull.length, hull.beam
            ));
            self.line(format_args!("speed_spread_mps = {:?}", steady.spread.speed));
            let course_spread =
                deg_from_radians(steady.spread.course).min(limits::COURSE_SPREAD.high);
            self.line(format_args!("course_spread_deg = {course_spread:?}"));
        } else {
            // explicit sets have no hull: the initial set contains both hulls and the margin
            let around = outer_disc(hull.half_diagonal() + clearance, 0.0);
            let initial = vertices(&around.translated(track.start()));
            self.line(format_args!(
                "initial_set = {{ vertices_m = {initial} }}\nvelocity_sets = ["
            ));
            let sets = track.outer_velocity_sets(&spread, horizon, limits::VELOCITY_SETS);
            for (until, velocities) in sets {
                let velocities = vertices(&velocities);
                let until = if until.is_finite() {
                    format!("until_s = {until:?}, ")
                } else {
                    String::new()
                };
                self.line(format_args!(
                    "    {{ {until}vertices_mps = {velocities} }},"
                ));
            }
            self.line("]");
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

fn hull_of(own: &Own, assumed: &Assumed) -> Hull {
    match own.hull {
        GivenHull::Known(hull) => hull,
        GivenHull::NotInFormat | GivenHull::Missing(_) => assumed.usual_hull(),
    }
}

/// Metres between a set and own ship's centre on any heading.
fn hull_clearance(own: &Hull, assumed: &Assumed) -> f64 {
    own.half_diagonal() + assumed.safety_margin(own.length)
}

/// A TOML string: TOML has the escapes of JSON.
fn quoted(text: &str) -> String {
    serde_json::Value::from(text).to_string()
}

fn position(point: Vector) -> String {
    format!(
        "{{ east_m = {:?}, north_m = {:?} }}",
        point.x + 0.0,
        point.y + 0.0
    )
}

fn vertices(polygon: &ConvexPolygon) -> String {
    let points: Vec<[f64; 2]> = polygon
        .vertices()
        .iter()
        .map(|v| [v.x + 0.0, v.y + 0.0])
        .collect();
    format!("{points:?}")
}
