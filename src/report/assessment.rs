//! An assessment for the eye.

use comfy_table::{Cell, CellAlignment, ContentArrangement, Table, presets};

use crate::frame::{Vector, course_deg_from_heading, deg_from_radians};
use crate::geometry::ConvexSet;
use crate::study::assess::{Assessment, Situation};

/// The title and the sets, holding course, the least alteration, and one table for what else was asked.
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
    let mut table = Tabular::new(&["target", "dCPA\n[m]", "tCPA\n[s]", "largest\nrisk"], 1);
    for (target, held) in assessment.targets.iter().zip(&assessment.hold_course) {
        table.row(vec![
            target.name.clone(),
            format!("{:.1}", held.approach.dcpa),
            format!("{:.1}", held.approach.tcpa),
            format!("{:.3}", held.max_risk),
        ]);
    }
    format!(
        "Holding course {} at {:.2} m/s\n{}",
        course(situation.pose.heading),
        situation.speed,
        table.text()
    )
}

fn alteration(situation: &Situation, assessment: &Assessment) -> String {
    let found = &assessment.alteration;
    if found.speed == Some(0.0) {
        return "Alteration: none needed, her velocity is in no velocity obstacle".to_owned();
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

/// To the next hundredth above: what is read off must still be clear.
fn up(value: f64) -> f64 {
    (value * 100.0 - 1e-6).ceil() / 100.0
}

fn points(assessment: &Assessment) -> String {
    let header = [
        "east\n[m]",
        "north\n[m]",
        "t\n[s]",
        "target",
        "inside",
        "alpha",
        "risk",
    ];
    let mut table = Tabular::new(&header, 0);
    table.left(3);
    for asked in &assessment.points {
        for (target, risk) in assessment.targets.iter().zip(&asked.targets) {
            table.row(vec![
                number(asked.point.position.x),
                number(asked.point.position.y),
                number(asked.point.time),
                target.name.clone(),
                yes(risk.inside),
                if risk.alpha.is_finite() {
                    format!("{:.3}", risk.alpha)
                } else {
                    "–".to_owned()
                },
                format!("{:.3}", risk.risk),
            ]);
        }
    }
    format!("Points\n{}", table.text())
}

fn velocities(assessment: &Assessment) -> String {
    let header = [
        "east\n[m/s]",
        "north\n[m/s]",
        "target",
        "dCPA\n[m]",
        "tCPA\n[s]",
        "in velocity\nobstacle",
    ];
    let mut table = Tabular::new(&header, 0);
    table.left(2);
    for asked in &assessment.velocities {
        for (target, nearest) in assessment.targets.iter().zip(&asked.targets) {
            table.row(vec![
                number(asked.velocity.x),
                number(asked.velocity.y),
                target.name.clone(),
                format!("{:.1}", nearest.dcpa),
                format!("{:.1}", nearest.tcpa),
                yes(nearest.in_velocity_obstacle),
            ]);
        }
    }
    format!("Velocities, from t = 0 on\n{}", table.text())
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
    let mut table = Tabular::new(&header, 1);
    table.left(6);
    for target in &assessment.targets {
        for (time, section) in &target.sections {
            let reach = |x: f64, y: f64| section.support(Vector::new(x, y));
            table.row(vec![
                target.name.clone(),
                number(*time),
                format!("{:.1}", -reach(-1.0, 0.0)),
                format!("{:.1}", reach(1.0, 0.0)),
                format!("{:.1}", -reach(0.0, -1.0)),
                format!("{:.1}", reach(0.0, 1.0)),
                match section {
                    ConvexSet::Polygon(polygon) => format!("{} vertices", polygon.vertices().len()),
                    ConvexSet::Ellipse(_) => "an ellipse".to_owned(),
                },
            ]);
        }
    }
    format!("Sections, how far they reach\n{}", table.text())
}

fn yes(value: bool) -> String {
    if value { "yes" } else { "no" }.to_owned()
}

/// As it was given, without a negative zero.
fn number(value: f64) -> String {
    (value + 0.0).to_string()
}

/// A table without colours: names to the left, numbers to the right.
struct Tabular(Table);

impl Tabular {
    /// The first `names` columns are text.
    fn new(header: &[&str], names: usize) -> Self {
        let mut table = Table::new();
        table
            .load_style(presets::UTF8_HORIZONTAL_ONLY)
            .set_content_arrangement(ContentArrangement::Disabled)
            .set_header(header);
        table.style_mut().row_separator = presets::NOTHING.row_separator;
        table.force_no_tty();
        for index in names..header.len() {
            if let Some(column) = table.column_mut(index) {
                column.set_cell_alignment(CellAlignment::Right);
            }
        }
        Self(table)
    }

    fn left(&mut self, index: usize) {
        if let Some(column) = self.0.column_mut(index) {
            column.set_cell_alignment(CellAlignment::Left);
        }
    }

    fn row(&mut self, cells: Vec<String>) {
        self.0.add_row(cells.into_iter().map(Cell::new));
    }

    fn text(&self) -> String {
        self.0.trim_fmt()
    }
}
