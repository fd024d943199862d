//! Text of an assessment.

use super::table::{Display, Grid, plain};
use crate::document::{AssessedSets, AssessmentDocument, InitialSetDocument};
use crate::frame::{course_deg_from_heading, knots_from_mps};
use crate::study::assess::OwnSituation;
use crate::text::{counted, knots, tenths};

/// Formats the title and the sets, holding course, the least alteration, and a table for each
/// further question.
pub fn assessment_text(
    situation: &OwnSituation,
    assessment: &AssessmentDocument,
    display: Display,
) -> String {
    let count = assessment.targets.len();
    let AssessmentDocument {
        scenario,
        horizon_s,
        ..
    } = assessment;
    let mut blocks = vec![format!(
        "{scenario}: {}, {}, 0 to {horizon_s} s",
        counted(count, "target"),
        sets(assessment)
    )];
    if count > 0 {
        blocks.push(held(situation, assessment, display));
    }
    blocks.push(alteration(situation, assessment));
    let asked = [
        (!assessment.points.is_empty(), points(assessment, display)),
        (
            !assessment.velocities.is_empty(),
            velocities(assessment, display),
        ),
        (
            assessment.targets.iter().any(|t| !t.sections.is_empty()),
            sections(assessment, display),
        ),
    ];
    let asked = asked.into_iter().filter(|(asked, _)| *asked && count > 0);
    blocks.extend(asked.map(|(_, block)| block));
    blocks.join("\n\n")
}

fn sets(assessment: &AssessmentDocument) -> &'static str {
    match assessment.sets {
        AssessedSets::Domains => "ship domains",
        AssessedSets::Hard => "hard sets",
    }
}

fn course(heading: f64) -> String {
    // 359.96 would round to 360
    let tenths = (course_deg_from_heading(heading) * 10.0).round() as u32 % 3600;
    format!("{:03}.{}°", tenths / 10, tenths % 10)
}

fn held(situation: &OwnSituation, assessment: &AssessmentDocument, display: Display) -> String {
    let rows = assessment.hold_course.targets.iter().map(|held| {
        vec![
            held.name.clone(),
            tenths(held.dcpa_m),
            tenths(held.tcpa_s),
            format!("{:.3}", held.max_risk),
        ]
    });
    let header = "target, dCPA\n[m], tCPA\n[s], largest\nrisk";
    let contact = match assessment
        .hold_course
        .targets
        .iter()
        .any(|t| t.dcpa_m == 0.0)
    {
        true => "; at dCPA 0.0 it enters the set at tCPA",
        false => "",
    };
    format!(
        "Holding course {} at {}: own centre to the {}{contact}\n{}",
        course(situation.pose.heading),
        knots(situation.speed),
        sets(assessment),
        table(header, 1..4, rows, display)
    )
}

fn alteration(situation: &OwnSituation, assessment: &AssessmentDocument) -> String {
    let found = &assessment.alteration;
    if found.speed_mps == Some(0.0) {
        return "Alteration: none needed, own velocity is in no velocity obstacle".to_owned();
    }
    let mut ways = Vec::new();
    for (side, turn) in [("starboard", found.starboard_deg), ("port", found.port_deg)] {
        ways.push(match turn {
            Some(turn) => format!("{:.2}° to {side}", up(turn)),
            None => format!("no turn to {side}"),
        });
    }
    ways.push(match found.speed_mps {
        Some(change) if change < 0.0 => format!("{:.2} kn slower", up(knots_from_mps(-change))),
        Some(change) => format!("{:.2} kn faster", up(knots_from_mps(change))),
        None => "no change of speed".to_owned(),
    });
    let alone = "Alteration that leaves every velocity obstacle, each alone: ";
    if found.starboard_deg.is_none() && found.port_deg.is_none() && found.speed_mps.is_none() {
        let limit = situation.max_speed.max(situation.speed);
        let limit = knots(limit);
        return format!("{alone}none, neither a turn nor a speed up to {limit}");
    }
    format!("{alone}{}", ways.join("; "))
}

/// Rounds up to hundredths, so that the printed value is still clear.
fn up(value: f64) -> f64 {
    (value * 100.0 - 1e-6).ceil() / 100.0
}

fn points(assessment: &AssessmentDocument, display: Display) -> String {
    let header = "target, east\n[m], north\n[m], t\n[s], alpha, risk, inside";
    let rows = assessment.points.iter().flat_map(|point| {
        point.targets.iter().map(|risk| {
            vec![
                risk.name.clone(),
                number(point.east_m),
                number(point.north_m),
                number(point.t_s),
                (risk.alpha).map_or("–".to_owned(), |alpha| format!("{alpha:.3}")),
                format!("{:.3}", risk.risk),
                yes(risk.inside),
            ]
        })
    });
    format!("Points\n{}", table(header, 1..6, rows, display))
}

fn velocities(assessment: &AssessmentDocument, display: Display) -> String {
    let header = "target, east\n[m/s], north\n[m/s], dCPA\n[m], tCPA\n[s], in velocity\nobstacle";
    let rows = assessment.velocities.iter().flat_map(|velocity| {
        velocity.targets.iter().map(|approach| {
            vec![
                approach.name.clone(),
                number(velocity.east_mps),
                number(velocity.north_mps),
                tenths(approach.dcpa_m),
                tenths(approach.tcpa_s),
                yes(approach.in_velocity_obstacle),
            ]
        })
    });
    format!(
        "Velocities, from t = 0 on\n{}",
        table(header, 1..5, rows, display)
    )
}

fn sections(assessment: &AssessmentDocument, display: Display) -> String {
    let header = "target, t\n[s], west\n[m], east\n[m], south\n[m], north\n[m], made of";
    let rows = assessment.targets.iter().flat_map(|target| {
        target.sections.iter().map(|section| {
            let ([x, y], made_of) = extent(&section.set);
            let [west, east, south, north] = [x[0], x[1], y[0], y[1]].map(tenths);
            let name = target.name.clone();
            vec![name, number(section.t_s), west, east, south, north, made_of]
        })
    });
    format!(
        "Sections and their extents\n{}",
        table(header, 1..6, rows, display)
    )
}

/// East and north intervals, and kind of a section.
fn extent(section: &InitialSetDocument) -> ([[f64; 2]; 2], String) {
    match section {
        InitialSetDocument::Polygon { vertices_m } => {
            let interval = |axis: usize| {
                let all = vertices_m.iter().map(|vertex| vertex[axis]);
                all.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                    [low.min(value), high.max(value)]
                })
            };
            let made_of = format!("{} vertices", vertices_m.len());
            ([interval(0), interval(1)], made_of)
        }
        InitialSetDocument::Ellipse { center_m, shape_m2 } => {
            let interval = |axis: usize| {
                let half = shape_m2[axis][axis].sqrt();
                [center_m[axis] - half, center_m[axis] + half]
            };
            ([interval(0), interval(1)], "an ellipse".to_owned())
        }
    }
}

fn yes(value: bool) -> String {
    if value { "yes" } else { "no" }.to_owned()
}

/// Formats a number without a negative zero.
fn number(value: f64) -> String {
    (value + 0.0).to_string()
}

fn table(
    header: &'static str,
    numbers: std::ops::Range<usize>,
    rows: impl Iterator<Item = Vec<String>>,
    display: Display,
) -> String {
    let rows = rows.map(|row| row.into_iter().map(plain).collect());
    Grid::new(header, numbers, rows).text(display)
}
