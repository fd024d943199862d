//! Own ship's roles over time, the rules that it breaks, and how long it stands on.

use rerun::{Color, Points2D, Points3D, StateChange, StateConfiguration, TimeColumn};

use crate::colregs::compliance::{ComplianceReport, MonitorResult, MonitorVerdict};
use crate::frame::{Side, clockwise_deg, knots_from_mps};
use crate::planner::Escape;
use crate::recording::canvas::style::{self, SpeedClass};
use crate::recording::canvas::{ViewModel, clock, flat};
use crate::recording::write::Recorder;
use crate::recording::{Logged, MAP, ROLES, TIMELINE, VOLUME, path};

/// Strength of a colour behind white letters.
const LANE_STRENGTH: f32 = 0.55;

/// One lane of the view: states from a time on, in order of time; an empty text ends one.
#[derive(Default)]
struct Lane {
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

/// When own ship violates rules and monitors, and their short names, in order of time.
fn violated(conduct: &ComplianceReport) -> Vec<(f64, String)> {
    let rules = conduct.violations.iter();
    let rules = rules.map(|violation| (violation.time, violation.rule.to_owned()));
    let is_violated = |f: &&MonitorResult| f.verdict == MonitorVerdict::Violated;
    let monitors = conduct.monitors.iter().filter(is_violated);
    let monitors = monitors.map(|m| (m.time.unwrap_or(0.0), format!("monitor {}", m.monitor)));
    let mut all: Vec<(f64, String)> = rules.chain(monitors).collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    all
}

/// The targets toward which own ship has a role or breaks a rule, with their index and name.
fn judged<'a>(
    model: &'a ViewModel,
) -> impl Iterator<Item = (usize, &'a str, &'a ComplianceReport)> {
    let both = model.scenario.targets.iter().zip(&model.conduct);
    both.enumerate().filter_map(|(index, (target, conduct))| {
        let conduct = conduct.as_ref()?;
        let silent = conduct.roles.is_empty() && violated(conduct).is_empty();
        (!silent).then_some((index, target.name.as_str(), conduct))
    })
}

fn lanes(model: &ViewModel) -> Vec<Lane> {
    let end = model.motion.end().min(model.end);
    let mut lanes = Vec::new();
    if let Some(escape) = model.run.planned.escape {
        let mut lane = Lane::default();
        let held = "own ship holds course and speed".to_owned();
        lane.add(0.0, held, SpeedClass::Slow.color());
        let away = format!("own ship escapes: {}", manoeuvre(&escape));
        lane.add(escape.held_until, away, SpeedClass::Fast.color());
        lane.end(end);
        lanes.push(lane);
    }
    for (index, name, conduct) in judged(model) {
        let mut roles = Lane::default();
        // the recording begins with the plan
        for state in conduct.roles.iter().filter(|state| state.until >= 0.0) {
            let text = format!("own ship to {name}: {}", state.role.word());
            roles.add(state.from.max(0.0), text, style::target(index));
            roles.end(state.until);
        }
        lanes.extend((!conduct.roles.is_empty()).then_some(roles));
        let mut rules: Vec<String> = Vec::new();
        let mut breaks = Lane::default();
        let mut until = end;
        for (time, rule) in violated(conduct) {
            if !rules.contains(&rule) {
                rules.push(rule);
            }
            let text = format!("own ship breaks {} toward {name}", rules.join(", "));
            breaks.add(time, text, style::ALARM);
            let mut ends = conduct.roles.iter().map(|state| state.until);
            until = ends.find(|end| *end > time).unwrap_or(end);
        }
        if !rules.is_empty() {
            breaks.end(until);
            lanes.push(breaks);
        }
    }
    lanes
}

pub fn height(model: &ViewModel) -> usize {
    lanes(model).len()
}

/// Logs the lanes, and the marks on the chart and in the volume; nothing where no rule applies. A
/// row where a lane changes has a text per lane, empty where nothing holds.
pub fn log_rules(rec: &mut Recorder, model: &ViewModel) -> Logged {
    let lanes = lanes(model);
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
    rec.log_moving(path(&[ROLES]), times, &style, columns)?;
    log_marks(rec, model)
}

/// Logs where own ship breaks a rule, and where it stops standing on. A mark is named where it is
/// pointed at.
fn log_marks(rec: &mut Recorder, model: &ViewModel) -> Logged {
    let mut marks: Vec<(f64, String, Color)> = Vec::new();
    for (_, name, conduct) in judged(model) {
        for violation in &conduct.violations {
            let (rule, time) = (violation.rule, violation.time);
            let text = format!("{rule} at {}, toward {name}", clock(time));
            marks.push((time, text, style::ALARM));
        }
    }
    if let Some(escape) = model.run.planned.escape {
        let text = format!("holds until {}", clock(escape.held_until));
        marks.push((escape.held_until, text, SpeedClass::Fast.color()));
    }
    if marks.is_empty() {
        return Ok(());
    }
    let place = |time: f64| model.motion.pose_at(time).position;
    let colors: Vec<Color> = marks.iter().map(|m| m.2).collect();
    let labels: Vec<&str> = marks.iter().map(|m| m.1.as_str()).collect();
    let on_chart = Points2D::new(marks.iter().map(|m| flat(place(m.0))))
        .with_colors(colors.iter().copied())
        .with_radii([style::points(4.5)])
        .with_labels(labels.iter().copied())
        .with_show_labels(false)
        .with_draw_order(40.0);
    rec.log_static(path(&[MAP, "rules"]), &on_chart)?;
    let in_volume = Points3D::new(marks.iter().map(|m| model.lifted(place(m.0), m.0)))
        .with_colors(colors)
        .with_radii([style::points(4.5)])
        .with_labels(labels)
        .with_show_labels(false);
    rec.log_static(path(&[VOLUME, "rules"]), &in_volume)
}

fn manoeuvre(escape: &Escape) -> String {
    let speed = knots_from_mps(escape.speed);
    match Side::of_turn(escape.turn) {
        Some(side) => {
            let degrees = clockwise_deg(escape.turn).abs();
            format!("{degrees:.0}° to {side} at {speed:.1} kn")
        }
        None => format!("{speed:.1} kn"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline;
    use crate::scenario::{Compliance, Scenario};

    fn stand_on(compliance: Compliance) -> pipeline::Run {
        let file = "scenarios/colregs/stand-on.toml";
        let mut scenario = Scenario::read(file.as_ref()).expect("valid");
        scenario.compliance = compliance;
        pipeline::run(scenario)
    }

    #[test]
    fn a_rule_is_broken_from_its_moment_on() {
        let run = stand_on(Compliance::Shape);
        let model = ViewModel::new(&run);
        let conduct = model.conduct[0].as_ref().expect("a ship");
        let violation = conduct.violations.iter().find(|b| b.rule == "17(c)");
        let violation = violation.expect("a turn to port");
        let [roles, broken] = &lanes(&model)[..] else {
            panic!("two lanes");
        };
        assert_eq!(
            roles.at(conduct.roles[0].from),
            "own ship to target: stand-on"
        );
        assert_eq!(roles.at(model.motion.end()), "");
        assert!(!broken.at(violation.time - 1e-6).contains("17(c)"));
        assert!(broken.at(violation.time).contains("17(c)"));
        assert_eq!(broken.at(conduct.roles[0].until), "");
    }

    #[test]
    fn a_hold_ends_at_its_latest_time() {
        let run = stand_on(Compliance::Rules);
        let model = ViewModel::new(&run);
        let latest = run.planned.escape.expect("stands on").held_until;
        let own = &lanes(&model)[0];
        assert_eq!(own.at(0.0), "own ship holds course and speed");
        assert_eq!(own.at(latest - 1e-6), own.at(0.0));
        assert!(own.at(latest).starts_with("own ship escapes: "));
    }
}
