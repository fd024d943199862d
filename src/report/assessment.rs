//! An assessment as text.

use super::table::{Grid, plain};
use crate::frame::{Vector, course_deg_from_heading, deg_from_radians};
use crate::obstacle::Section;
use crate::study::assess::{Assessment, Situation};

/// The title and the sets, holding course, the least alteration, and a table for every other
/// question.
pub fn assessment_text(
    title: &str,
    shaped: bool,
    situation: &Situation,
    assessment: &Assessment,
) -> String {
    let count = assessment.targets.len();
    let mut blocks = vec![format!(
        "{title}: {count} target{}, {} sets, 0 to {} s",
        if count == 1 { "" } else { "s" },
        if shaped { "shaped" } else { "hard" },
        situation.horizon,
    )];
    if count > 0 {
        blocks.push(held(situation, assessment));
    }
    blocks.push(alteration(situation, assessment));
    for (asked, block) in [
        (assessment.points.len(), points(assessment)),
        (assessment.velocities.len(), velocities(assessment)),
        (sections_asked(assessment), sections(assessment)),
    ] {
        if asked > 0 && count > 0 {
            blocks.push(block);
        }
    }
    blocks.join("\n\n")
}

fn course(heading: f64) -> String {
    // 359.96 would be written as 360
    let tenths = (course_deg_from_heading(heading) * 10.0).round() as u32 % 3600;
    format!("{:03}.{}°", tenths / 10, tenths % 10)
}

fn held(situation: &Situation, assessment: &Assessment) -> String {
    let all = assessment.targets.iter().zip(&assessment.hold_course);
    let rows = all.map(|(target, held)| {
        vec![
            target.name.clone(),
            format!("{:.1}", held.approach.dcpa),
            format!("{:.1}", held.approach.tcpa),
            format!("{:.3}", held.max_risk),
        ]
    });
    let header = ["target", "dCPA\n[m]", "tCPA\n[s]", "largest\nrisk"];
    format!(
        "Holding course {} at {:.2} m/s\n{}",
        course(situation.pose.heading),
        situation.speed,
        table(&header, 1..4, rows)
    )
}

fn alteration(situation: &Situation, assessment: &Assessment) -> String {
    let found = &assessment.alteration;
    if found.speed == Some(0.0) {
        return "Alteration: none needed, own velocity is in no velocity obstacle".to_owned();
    }
    let mut ways = Vec::new();
    for (side, turn) in [("starboard", found.starboard), ("port", found.port)] {
        ways.push(match turn {
            Some(turn) => format!("{:.2}° to {side}", up(deg_from_radians(turn))),
            None => format!("no turn to {side}"),
        });
    }
    ways.push(match found.speed {
        Some(change) if change < 0.0 => format!("{:.2} m/s slower", up(-change)),
        Some(change) => format!("{:.2} m/s faster", up(change)),
        None => "no change of speed".to_owned(),
    });
    let alone = "Alteration that leaves every velocity obstacle, each alone: ";
    if found.starboard.is_none() && found.port.is_none() && found.speed.is_none() {
        let limit = situation.max_speed.max(situation.speed);
        return format!("{alone}none, neither a turn nor a speed up to {limit:.2} m/s");
    }
    format!("{alone}{}", ways.join("; "))
}

/// Rounded up to hundredths, so that the printed value is still clear.
fn up(value: f64) -> f64 {
    (value * 100.0 - 1e-6).ceil() / 100.0
}

fn points(assessment: &Assessment) -> String {
    let header = [
        "target",
        "east\n[m]",
        "north\n[m]",
        "t\n[s]",
        "alpha",
        "risk",
        "inside",
    ];
    let rows = assessment.points.iter().flat_map(|asked| {
        let point = asked.point;
        let all = assessment.targets.iter().zip(&asked.targets);
        all.map(move |(target, risk)| {
            let alpha = Some(risk.alpha).filter(|alpha| alpha.is_finite());
            vec![
                target.name.clone(),
                number(point.position.x),
                number(point.position.y),
                number(point.time),
                alpha.map_or("–".to_owned(), |alpha| format!("{alpha:.3}")),
                format!("{:.3}", risk.risk),
                yes(risk.inside),
            ]
        })
    });
    format!("Points\n{}", table(&header, 1..6, rows))
}

fn velocities(assessment: &Assessment) -> String {
    let header = [
        "target",
        "east\n[m/s]",
        "north\n[m/s]",
        "dCPA\n[m]",
        "tCPA\n[s]",
        "in velocity\nobstacle",
    ];
    let rows = assessment.velocities.iter().flat_map(|asked| {
        let velocity = asked.velocity;
        let all = assessment.targets.iter().zip(&asked.targets);
        all.map(move |(target, approach)| {
            vec![
                target.name.clone(),
                number(velocity.x),
                number(velocity.y),
                format!("{:.1}", approach.dcpa),
                format!("{:.1}", approach.tcpa),
                yes(approach.in_velocity_obstacle),
            ]
        })
    });
    format!("Velocities, from t = 0 on\n{}", table(&header, 1..5, rows))
}

fn sections_asked(assessment: &Assessment) -> usize {
    assessment.targets.first().map_or(0, |t| t.sections.len())
}

fn sections(assessment: &Assessment) -> String {
    let header = [
        "target",
        "t\n[s]",
        "west\n[m]",
        "east\n[m]",
        "south\n[m]",
        "north\n[m]",
        "made of",
    ];
    let rows = assessment.targets.iter().flat_map(|target| {
        target.sections.iter().map(|(time, section)| {
            let reach = |x: f64, y: f64| section.support(Vector::new(x, y));
            vec![
                target.name.clone(),
                number(*time),
                format!("{:.1}", -reach(-1.0, 0.0)),
                format!("{:.1}", reach(1.0, 0.0)),
                format!("{:.1}", -reach(0.0, -1.0)),
                format!("{:.1}", reach(0.0, 1.0)),
                match section {
                    Section::Polygon(polygon) => format!("{} vertices", polygon.vertices().len()),
                    Section::Ellipse(_) => "an ellipse".to_owned(),
                },
            ]
        })
    });
    format!("Extent of the sections\n{}", table(&header, 1..6, rows))
}

/// A table without colours.
fn table(
    header: &[&'static str],
    numbers: std::ops::Range<usize>,
    rows: impl Iterator<Item = Vec<String>>,
) -> String {
    let grid = Grid {
        header: header.to_vec(),
        numbers,
        rows: rows
            .map(|row| row.into_iter().map(plain).collect())
            .collect(),
    };
    grid.text(false)
}

fn yes(value: bool) -> String {
    if value { "yes" } else { "no" }.to_owned()
}

/// Without a negative zero.
fn number(value: f64) -> String {
    (value + 0.0).to_string()
}
