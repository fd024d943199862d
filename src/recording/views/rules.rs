//! Own ship's roles over time, the rules that it breaks, and how long it stands on.

use rerun::{Color, Points2D, Points3D, StateChange, StateConfiguration, TimeColumn};

use crate::colregs::Role;
use crate::colregs::compliance::MonitorVerdict;
use crate::document::{
    ConductDocument, EncounterDocument, EscapeDocument, PlanDocument, RoleDocument, chart_role,
    escape_words, has_role, rules_in_words,
};
use crate::frame::Vector;
use crate::recording::canvas::style::{self, SpeedClass};
use crate::recording::canvas::{Canvas, Labels, flat};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, MAP, ROLES, TIMELINE, VOLUME, path};
use crate::text::clock;

/// Strength of a colour behind white letters.
const LANE_STRENGTH: f32 = 0.55;

/// One lane of the view: states from a time on, in order of time; an empty text ends one.
#[derive(Debug, Default)]
pub struct Lane {
    states: Vec<(f64, String)>,
    /// One per state.
    colors: Vec<Color>,
}

impl Lane {
    fn add(&mut self, time: f64, text: String, color: Color) {
        self.states.push((time, text));
        self.colors
            .push(style::toward_background(color, LANE_STRENGTH));
    }

    fn end(&mut self, time: f64) {
        self.add(time, String::new(), style::BACKGROUND);
    }

    /// The text at a time; the last where several begin at once.
    fn at(&self, time: f64) -> &str {
        let begun = self.states.partition_point(|(from, _)| *from <= time);
        self.states[..begun].last().map_or("", |(_, text)| text)
    }
}

/// Own ship's roles toward a target, and how it behaved.
#[derive(Debug)]
pub struct Judged<'a> {
    pub target: &'a str,
    pub color: Color,
    pub roles: Vec<RoleDocument>,
    /// The one on the desired trajectory, or none.
    pub desired: Role,
    /// `None` without a plan.
    pub conduct: Option<&'a ConductDocument>,
}

impl<'a> Judged<'a> {
    /// The targets that a plan judges, or toward which own ship has a role.
    pub fn of_plan(canvas: &Canvas, plan: &'a PlanDocument) -> Vec<Self> {
        let judged = |(index, encounter): (usize, &'a EncounterDocument)| {
            let conduct = encounter.conduct.as_ref();
            let roles = conduct.map(|conduct| conduct.roles.clone());
            let is_met = conduct.is_some() || has_role(encounter.role);
            is_met.then(|| Self {
                target: &encounter.target,
                color: canvas.target_color(index),
                roles: roles.unwrap_or_default(),
                desired: encounter.role,
                conduct,
            })
        };
        plan.encounters
            .iter()
            .enumerate()
            .filter_map(judged)
            .collect()
    }

    /// When own ship violates rules and monitors, and their short names, in order of time.
    fn violated(&self) -> Vec<(f64, String)> {
        let rules = self.conduct.iter().flat_map(|conduct| &conduct.violations);
        let rules = rules.map(|violation| (violation.t_s, violation.rule.to_string()));
        let monitors = self.conduct.iter().flat_map(|conduct| &conduct.monitors);
        let monitors = monitors.filter(|m| m.verdict == MonitorVerdict::Violated);
        let monitors = monitors.map(|m| (m.t_s.unwrap_or(0.0), m.monitor.to_string()));
        let mut all: Vec<(f64, String)> = rules.chain(monitors).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0));
        all
    }

    fn lanes(&self, end: f64) -> impl Iterator<Item = Lane> {
        let name = self.target;
        let mut lanes = Vec::new();
        let mut roles = Lane::default();
        // the recording begins with the plan
        for state in self.roles.iter().filter(|state| state.until_s >= 0.0) {
            let text = format!("{}: own ship to {name}", state.role);
            roles.add(state.from_s.max(0.0), text, self.color);
            roles.end(state.until_s);
        }
        if self.roles.is_empty() && has_role(self.desired) {
            let text = format!("{} (desired): own ship to {name}", self.desired);
            roles.add(0.0, text, self.color);
            roles.end(end);
        }
        lanes.extend((!roles.states.is_empty()).then_some(roles));
        let mut rules: Vec<String> = Vec::new();
        let mut breaks = Lane::default();
        let mut until = end;
        for (time, rule) in self.violated() {
            if !rules.contains(&rule) {
                rules.push(rule);
            }
            let broken = rules_in_words(rules.iter().map(String::as_str));
            let text = format!("{broken} broken by own ship toward {name}");
            breaks.add(time, text, style::ALARM);
            let mut ends = self.roles.iter().map(|state| state.until_s);
            until = ends.find(|end| *end > time).unwrap_or(end);
        }
        if !rules.is_empty() {
            breaks.end(until);
            lanes.push(breaks);
        }
        lanes.into_iter()
    }
}

/// The name of a target with own ship's role toward it: at a time, else the next one or the last,
/// else that on the desired trajectory.
pub fn name_with_role(judged: &[Judged], target: &str, time: f64) -> String {
    let Some(judged) = judged.iter().find(|judged| judged.target == target) else {
        return target.to_owned();
    };
    let coming = judged.roles.iter().find(|role| time < role.until_s);
    let words = match coming.or(judged.roles.last()) {
        None => chart_role(&[], judged.desired),
        Some(role) => {
            let when = match time {
                _ if time < role.from_s => format!(" from {}", clock(role.from_s)),
                _ if time < role.until_s => String::new(),
                _ => format!(" until {}", clock(role.until_s)),
            };
            Some(format!("own ship: {}{when}", role.role))
        }
    };
    words.map_or(target.to_owned(), |words| format!("{target}\n{words}"))
}

/// Writes in a corner of the chart which rules own ship breaks.
pub fn add_broken(labels: &mut Labels, broken: Option<&[&str]>) {
    match broken {
        None => {}
        Some([]) => labels.add_in_corner("breaks no rule", style::CHART_TEXT),
        Some(broken) => {
            let text = format!("breaks {}", rules_in_words(broken.iter().copied()));
            labels.add_in_corner(&text, style::ALARM);
        }
    }
}

/// The lanes of own ship until `end`.
pub fn lanes(judged: &[Judged], escape: Option<&EscapeDocument>, end: f64) -> Vec<Lane> {
    let mut lanes = Vec::new();
    if let Some(escape) = escape {
        let mut lane = Lane::default();
        let held = "own ship holds course and speed".to_owned();
        lane.add(0.0, held, SpeedClass::Slow.color());
        let away = format!("own ship escapes: {}", escape_words(escape));
        lane.add(escape.held_until_s, away, SpeedClass::Fast.color());
        lane.end(end);
        lanes.push(lane);
    }
    lanes.extend(judged.iter().flat_map(|judged| judged.lanes(end)));
    lanes
}

/// Logs the lanes; nothing where no rule applies. A row where a lane changes has a text per lane,
/// empty where nothing holds.
pub fn log_lanes(rec: &mut Recorder, lanes: &[Lane]) -> Logged {
    if lanes.is_empty() {
        return Ok(());
    }
    // the lanes begin with the run
    let mut times = vec![0.0];
    times.extend(lanes.iter().flat_map(|l| l.states.iter().map(|(t, _)| *t)));
    times.sort_by(f64::total_cmp);
    times.dedup();
    let states = lanes
        .iter()
        .flat_map(|lane| lane.states.iter().zip(&lane.colors));
    let known = states.filter(|((_, text), _)| !text.is_empty());
    let known = known.map(|((_, text), color)| (text.as_str(), *color));
    let (values, colors): (Vec<&str>, Vec<Color>) = known.unzip();
    let style = StateConfiguration::update_fields()
        .with_values(values)
        .with_colors(colors);
    let states = times
        .iter()
        .flat_map(|time| lanes.iter().map(|lane| lane.at(*time)));
    let columns = StateChange::update_fields()
        .with_state(states)
        .columns(vec![lanes.len(); times.len()])?;
    let times = TimeColumn::new_duration_secs(TIMELINE, times);
    rec.log_moving(path(&[ROLES]), times, &style, columns)
}

/// A moment on own ship's way. It is named where it is pointed at.
pub struct Mark {
    place: Vector,
    time: f64,
    text: String,
    color: Color,
}

/// Where own ship breaks a rule, and where it stops standing on. `own` is its place at a time.
pub fn marks(
    judged: &[Judged],
    escape: Option<&EscapeDocument>,
    own: impl Fn(f64) -> Vector,
) -> Vec<Mark> {
    let mut marks = Vec::new();
    let mut add = |time: f64, text: String, color: Color| {
        let place = own(time);
        marks.push(Mark {
            place,
            time,
            text,
            color,
        });
    };
    for judged in judged {
        for violation in judged.conduct.iter().flat_map(|c| &c.violations) {
            let (rule, time) = (&violation.rule, violation.t_s);
            let text = format!("{rule} at {}, toward {}", clock(time), judged.target);
            add(time, text, style::ALARM);
        }
    }
    if let Some(escape) = escape {
        let text = format!("holds until {}", clock(escape.held_until_s));
        add(escape.held_until_s, text, SpeedClass::Fast.color());
    }
    marks
}

pub fn log_marks(rec: &mut Recorder, marks: &[Mark]) -> Logged {
    if marks.is_empty() {
        return Ok(());
    }
    let on_chart = Points2D::new(marks.iter().map(|mark| flat(mark.place)))
        .with_colors(marks.iter().map(|mark| mark.color))
        .with_radii([style::points(4.5)])
        .with_labels(marks.iter().map(|mark| mark.text.as_str()))
        .with_show_labels(false)
        .with_draw_order(40.0);
    rec.log_static(path(&[MAP, "rules"]), &on_chart)
}

pub fn log_marks_in_volume(rec: &mut Recorder, canvas: &Canvas, marks: &[Mark]) -> Logged {
    if marks.is_empty() {
        return Ok(());
    }
    let places = marks
        .iter()
        .map(|mark| canvas.lifted(mark.place, mark.time));
    let in_volume = Points3D::new(places)
        .with_colors(marks.iter().map(|mark| mark.color))
        .with_radii([style::points(4.5)])
        .with_labels(marks.iter().map(|mark| mark.text.as_str()))
        .with_show_labels(false);
    rec.log_static(path(&[VOLUME, "rules"]), &in_volume)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colregs::Paragraph;
    use crate::pipeline;
    use crate::recording::canvas::ViewModel;
    use crate::scenario::{Compliance, Scenario};

    /// Tests the lanes of a plan.
    fn stand_on(
        compliance: Compliance,
        test: impl Fn(&ViewModel, &PlanDocument, &[Judged], &[Lane], f64),
    ) {
        let file = "scenarios/colregs/stand-on.toml";
        let mut scenario = Scenario::read(file.as_ref()).expect("valid");
        scenario.compliance = compliance;
        let run = pipeline::run(scenario);
        let plan = PlanDocument::of(&run);
        let model = ViewModel::new(&run);
        let judged = Judged::of_plan(&model, &plan);
        let end = model.motion.end();
        let lanes = lanes(&judged, plan.escape.as_ref(), end);
        test(&model, &plan, &judged, &lanes, end);
    }

    #[test]
    fn a_rule_is_broken_from_its_moment_on() {
        stand_on(Compliance::Shape, |model, plan, judged, lanes, end| {
            let conduct = judged[0].conduct.expect("judged");
            let violation = conduct
                .violations
                .iter()
                .find(|b| b.rule == Paragraph::Rule17C);
            let violation = violation.expect("a turn to port");
            let [roles, broken] = lanes else {
                panic!("two lanes");
            };
            let role = &conduct.roles[0];
            assert_eq!(roles.at(role.from_s), "stand-on: own ship to target");
            assert_eq!(roles.at(end), "");
            assert!(!broken.at(violation.t_s - 1e-6).contains("17(c)"));
            assert!(broken.at(violation.t_s).contains("17(c)"));
            assert_eq!(broken.at(role.until_s), "");
            let named = |time| name_with_role(judged, "target", time);
            assert_eq!(named(role.from_s), "target\nown ship: stand-on");
            let until = clock(role.until_s);
            let past = format!("target\nown ship: stand-on until {until}");
            assert_eq!(named(role.until_s), past);
            let mut later = Judged {
                roles: vec![RoleDocument {
                    from_s: 60.0,
                    ..role.clone()
                }],
                ..Judged::of_plan(model, plan).remove(0)
            };
            let one = |judged: &Judged| name_with_role(std::slice::from_ref(judged), "target", 0.0);
            assert_eq!(one(&later), "target\nown ship: stand-on from 1:00");
            later.roles.clear();
            later.desired = Role::HeadOn;
            assert_eq!(one(&later), "target\nown ship: head-on (desired)");
            let lane = &later.lanes(end).next().expect("a lane");
            assert_eq!(lane.at(0.0), "head-on (desired): own ship to target");
        });
    }

    #[test]
    fn a_hold_ends_at_its_latest_time() {
        stand_on(Compliance::Rules, |_, plan, _, lanes, _| {
            let latest = plan.escape.as_ref().expect("stands on").held_until_s;
            let own = &lanes[0];
            assert_eq!(own.at(0.0), "own ship holds course and speed");
            assert_eq!(own.at(latest - 1e-6), own.at(0.0));
            assert!(own.at(latest).starts_with("own ship escapes: "));
        });
    }
}
