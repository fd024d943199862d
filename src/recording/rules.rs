//! The rules of the road: own ship's roles over time, what she breaks and when, and how long a ship that stands on holds.

use rerun::{
    AsComponents, Color, Points2D, Points3D, RecordingStreamResult, StateChange,
    StateConfiguration, TimeColumn,
};

use super::chart::Lines;
use super::columns::log_columns;
use super::recorder::Recorder;
use super::scene::{Scene, flat};
use super::style::{self, Pace};
use super::{MAP, TIMELINE, VOLUME, path};
use crate::colregs::compliance::{ComplianceReport, Measure, MonitorResult, Verdict};
use crate::frame::{Side, Vector, clockwise_deg, deg_from_radians, knots_from_mps};
use crate::planner::Escape;

/// The lanes: a row where one changes, in it a text per lane, empty where nothing holds.
pub const ROLES: &str = "rules/roles";

/// Of a colour behind white letters.
const LANE: f32 = 0.55;

/// One lane of the view: what holds from a time on, in order of time; an empty text ends it.
struct Lane {
    spells: Vec<(f64, String)>,
    /// One per spell.
    colors: Vec<Color>,
}

impl Lane {
    fn new() -> Self {
        Self {
            spells: Vec::new(),
            colors: Vec::new(),
        }
    }

    fn add(&mut self, time: f64, text: String, color: Color) {
        self.spells.push((time, text));
        self.colors.push(style::toward_background(color, LANE));
    }

    fn end(&mut self, time: f64) {
        self.add(time, String::new(), style::background());
    }

    /// Of several at one time the last.
    fn at(&self, time: f64) -> &str {
        let begun = self.spells.partition_point(|(from, _)| *from <= time);
        self.spells[..begun].last().map_or("", |(_, text)| text)
    }
}

/// A rule that is broken, or a monitor that is violated.
struct Broken {
    time: f64,
    /// Short.
    rule: String,
    what: String,
}

fn broken(conduct: &ComplianceReport) -> Vec<Broken> {
    let breaches = conduct.violations.iter().map(|breach| Broken {
        time: breach.time,
        rule: breach.rule.to_owned(),
        what: format!("{} at {:.0} s: {}", breach.rule, breach.time, breach.what),
    });
    let is_violated = |f: &&MonitorResult| f.verdict == Verdict::Violated;
    let monitors = conduct.monitors.iter().filter(is_violated).map(|finding| {
        let time = finding.time.unwrap_or(0.0);
        // a difference has no negative zero
        let short = 0.0 - finding.robustness.unwrap_or(0.0);
        let short = match finding.measure {
            Measure::Distance => format!("{short:.1} m"),
            Measure::Angle => format!("{:.0}°", deg_from_radians(short)),
            Measure::Time => format!("{short:.0} s"),
        };
        let rule = format!("monitor {}", finding.monitor);
        Broken {
            time,
            what: format!("{rule} at {time:.0} s, by {short}"),
            rule,
        }
    });
    let mut all: Vec<Broken> = breaches.chain(monitors).collect();
    all.sort_by(|a, b| a.time.total_cmp(&b.time));
    all
}

/// The targets toward whom own ship has a role or breaks a rule, with their place in the scenario.
fn judged<'a>(scene: &'a Scene) -> impl Iterator<Item = (usize, &'a str, &'a ComplianceReport)> {
    let both = scene.scenario.targets.iter().zip(&scene.conduct);
    both.enumerate().filter_map(|(index, (target, conduct))| {
        let conduct = conduct.as_ref()?;
        let silent = conduct.roles.is_empty() && broken(conduct).is_empty();
        (!silent).then_some((index, target.name.as_str(), conduct))
    })
}

fn lanes(scene: &Scene) -> Vec<Lane> {
    let end = scene.motion.end().min(scene.end);
    let mut lanes = Vec::new();
    if let Some(escape) = scene.run.planned.escape {
        let mut lane = Lane::new();
        let held = "own ship holds course and speed".to_owned();
        lane.add(0.0, held, Pace::Slow.color());
        let away = format!("own ship escapes: {}", manoeuvre(&escape));
        lane.add(escape.latest, away, Pace::Fast.color());
        lane.end(end);
        lanes.push(lane);
    }
    for (index, name, conduct) in judged(scene) {
        let mut roles = Lane::new();
        for spell in &conduct.roles {
            let text = format!("{name}: {}", spell.role.name());
            roles.add(spell.from, text, style::target(index));
            roles.end(spell.until);
        }
        lanes.extend((!conduct.roles.is_empty()).then_some(roles));
        let mut rules: Vec<String> = Vec::new();
        let mut breaks = Lane::new();
        for each in broken(conduct) {
            if !rules.contains(&each.rule) {
                rules.push(each.rule);
            }
            let text = format!("{name}: breaks {}", rules.join(", "));
            breaks.add(each.time, text, style::alarm());
        }
        if !rules.is_empty() {
            breaks.end(end);
            lanes.push(breaks);
        }
    }
    lanes
}

/// How many lanes the view has.
pub fn height(scene: &Scene) -> usize {
    lanes(scene).len()
}

/// The lanes, and the moments on the chart and in the volume; nothing where no rule asks anything.
pub fn log_rules(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    let lanes = lanes(scene);
    if lanes.is_empty() {
        return Ok(());
    }
    // a row at the very beginning: the look has to hold from then on
    let mut times = vec![0.0];
    times.extend(lanes.iter().flat_map(|l| l.spells.iter().map(|(t, _)| *t)));
    times.sort_by(f64::total_cmp);
    times.dedup();
    let known = lanes
        .iter()
        .flat_map(|lane| lane.spells.iter().zip(&lane.colors))
        .filter(|((_, text), _)| !text.is_empty());
    let (values, colors): (Vec<&str>, Vec<Color>) = known
        .map(|((_, text), color)| (text.as_str(), *color))
        .unzip();
    let look = StateConfiguration::update_fields()
        .with_values(values)
        .with_colors(colors);
    let states = times
        .iter()
        .flat_map(|time| lanes.iter().map(|lane| lane.at(*time)));
    let columns = StateChange::update_fields()
        .with_state(states)
        .columns(vec![lanes.len(); times.len()])?;
    let times = TimeColumn::new_duration_secs(TIMELINE, times);
    log_columns(rec, path(&[ROLES]), times, &look, columns)?;
    log_moments(rec, scene)
}

/// Of the sea that is shown: between two names of moments.
const ABOVE: f64 = 1.0 / 22.0;

/// Where own ship is when she breaks a rule, and where her hold ends.
fn log_moments(rec: &mut Recorder, scene: &Scene) -> RecordingStreamResult<()> {
    let several = judged(scene).count() > 1;
    let mut marks: Vec<(f64, String, Color)> = Vec::new();
    for (_, name, conduct) in judged(scene) {
        for each in conduct.violations.iter() {
            let toward = if several {
                format!(", toward {name}")
            } else {
                String::new()
            };
            let text = format!("{} at {:.0} s{toward}", each.rule, each.time);
            marks.push((each.time, text, style::alarm()));
        }
    }
    if let Some(escape) = scene.run.planned.escape {
        let text = format!("holds until {:.0} s", escape.latest);
        marks.push((escape.latest, text, Pace::Fast.color()));
    }
    if marks.is_empty() {
        return Ok(());
    }
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    // several at one moment are one mark
    marks.dedup_by(|later, earlier| {
        let one = later.0 == earlier.0;
        if one {
            earlier.1 = format!("{}\n{}", earlier.1, later.1);
        }
        one
    });
    let place = |time: f64| scene.motion.pose_at(time).position;
    let colors: Vec<Color> = marks.iter().map(|m| m.2).collect();
    let labels: Vec<&str> = marks.iter().map(|m| m.1.as_str()).collect();
    // the names of ships and of time marks are near the track: these stand off it, one above another
    let off = ABOVE * scene.bounds.extent();
    let above = |(k, m): (usize, &(f64, String, Color))| {
        place(m.0) + Vector::new(0.0, off * (2.0 + k as f64))
    };
    let mut leaders = Lines::default();
    for (k, mark) in marks.iter().enumerate() {
        let ends = [place(mark.0), above((k, mark))];
        leaders.add(ends.map(flat).to_vec(), mark.2, style::points(0.5));
    }
    let leaders = leaders.archetype();
    let spots = marks.iter().map(|m| flat(place(m.0)));
    let names = marks.iter().enumerate().map(|mark| flat(above(mark)));
    // labels are of the first points: the marks themselves have none
    let radii = names.clone().map(|_| style::points(0.0));
    let radii = radii.chain(spots.clone().map(|_| style::points(4.5)));
    let on_chart = Points2D::new(names.chain(spots))
        .with_colors([&colors[..], &colors[..]].concat())
        .with_radii(radii)
        .with_labels(labels.iter().copied().chain(labels.iter().map(|_| "")))
        .with_show_labels(true)
        .with_draw_order(40.0);
    let parts: [&dyn AsComponents; 2] = [&leaders, &on_chart];
    rec.log_static(path(&[MAP, "rules"]), &parts)?;
    let in_volume = Points3D::new(marks.iter().map(|m| scene.lifted(place(m.0), m.0)))
        .with_colors(colors)
        .with_radii([style::points(4.5)])
        .with_labels(labels)
        .with_show_labels(false);
    rec.log_static(path(&[VOLUME, "rules"]), &in_volume)
}

fn manoeuvre(escape: &Escape) -> String {
    let speed = knots_from_mps(escape.speed);
    match Side::of_turn(escape.turn) {
        Some(side) => format!(
            "{:.0}° to {side} at {speed:.1} kn",
            clockwise_deg(escape.turn).abs()
        ),
        None => format!("{speed:.1} kn"),
    }
}

/// Roles, scores and broken rules as a table, and the hold in words; empty where no rule asks anything.
pub fn text(scene: &Scene) -> String {
    let mut parts = Vec::new();
    if let Some(escape) = scene.run.planned.escape {
        parts.push(format!(
            "**Own ship stands on:** she holds course and speed until {:.1} s, the latest time from which an escape is known to be \
             clear, and escapes then: {}.",
            escape.latest,
            manoeuvre(&escape)
        ));
    }
    let rows: Vec<String> = judged(scene)
        .map(|(_, name, conduct)| {
            let roles = conduct
                .roles
                .iter()
                .map(|s| format!("{} {:.0} to {:.0} s", s.role.name(), s.from, s.until));
            let scores = conduct.scores.by_name().into_iter();
            let scores =
                scores.map(|(rule, score)| format!("{} {score:.2}", rule.replace('_', " ")));
            let broken = broken(conduct);
            let broken: Vec<&str> = broken.iter().map(|b| b.what.as_str()).collect();
            let said = if broken.is_empty() {
                "nothing".to_owned()
            } else {
                format!("**{}**", broken.join("; "))
            };
            let [roles, scores] =
                [roles.collect::<Vec<_>>(), scores.collect()].map(|l| l.join(", "));
            format!("| {name} | {roles} | {scores} | {said} |")
        })
        .collect();
    if !rows.is_empty() {
        parts.push(format!(
            "| rules: toward | own ship is | scores | breaks |\n|---|---|---|---|\n{}",
            rows.join("\n")
        ));
    }
    parts.join("\n\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline;
    use crate::scenario::{Compliance, Scenario};

    fn stand_on(compliance: Compliance) -> pipeline::Run {
        let file = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
        let file = file.join("scenarios/colregs/stand-on.toml");
        let mut scenario = Scenario::read(&file).expect("valid");
        scenario.compliance = compliance;
        pipeline::run(scenario)
    }

    #[test]
    fn a_rule_is_broken_from_its_moment_on() {
        let run = stand_on(Compliance::Shape);
        let scene = Scene::new(&run);
        let conduct = scene.conduct[0].as_ref().expect("a ship");
        let breach = conduct.violations.iter().find(|b| b.rule == "17(c)");
        let breach = breach.expect("a turn to port");
        let [roles, broken] = &lanes(&scene)[..] else {
            panic!("two lanes");
        };
        assert_eq!(roles.at(conduct.roles[0].from), "target: stand-on");
        assert_eq!(roles.at(scene.motion.end()), "");
        assert!(!broken.at(breach.time - 1e-6).contains("17(c)"));
        assert!(broken.at(breach.time).contains("17(c)"));
        assert_eq!(broken.at(scene.motion.end()), "");
        let said = text(&scene);
        let expected = format!("17(c) at {:.0} s: ", breach.time);
        assert!(
            said.contains(&expected) && said.contains("rule 17"),
            "{said}"
        );
    }

    #[test]
    fn a_hold_ends_at_its_latest_time() {
        let run = stand_on(Compliance::Rules);
        let scene = Scene::new(&run);
        let latest = run.planned.escape.expect("stands on").latest;
        let own = &lanes(&scene)[0];
        assert_eq!(own.at(0.0), "own ship holds course and speed");
        assert_eq!(own.at(latest - 1e-6), own.at(0.0));
        assert!(own.at(latest).starts_with("own ship escapes: "));
        assert!(text(&scene).contains("**Own ship stands on:**"));
    }
}
