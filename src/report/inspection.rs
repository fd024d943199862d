//! Table of the entities of a recording.

use super::table::{Display, Grid, plain};
use crate::document::{EntityContents, TimelineContents};

/// Formats a row per entity: its rows, its timelines and its components.
pub fn entities_table(entities: &[EntityContents], display: Display) -> String {
    let rows = entities.iter().map(|entity| {
        let short = |name: &String| name.rsplit(':').next().unwrap_or(name).to_owned();
        let components: Vec<String> = entity.components.iter().map(short).collect();
        vec![
            plain(entity.path.clone()),
            plain(entity.rows.to_string()),
            plain(timelines_text(&entity.timelines, "always")),
            plain(components.join(", ")),
        ]
    });
    Grid::new("entity, rows, times, components", 0..0, rows)
        .breaking("components", 16)
        .breaking("times", 8)
        .text(display)
}

/// The ranges of timelines, or a word for none.
pub fn timelines_text(timelines: &[TimelineContents], none: &str) -> String {
    let texts: Vec<String> = timelines.iter().map(range).collect();
    match texts.is_empty() {
        true => none.to_owned(),
        false => texts.join(", "),
    }
}

fn range(timeline: &TimelineContents) -> String {
    let milliseconds = |time: f64| (time * 1e3).round() / 1e3;
    let [first, last] = [timeline.first, timeline.last].map(milliseconds);
    let text = format!("{} {first} to {last} {}", timeline.name, timeline.unit);
    text.trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wide_table_breaks_between_components() {
        let time = TimelineContents {
            name: "sim_time".to_owned(),
            unit: "s",
            first: 0.0,
            last: 302.4,
        };
        let names = ["Transform3D:translation", "half_sizes", "centers", "colors"];
        let entity = |path: &str, timelines| EntityContents {
            path: path.to_owned(),
            rows: 120,
            components: names.repeat(3).into_iter().map(str::to_owned).collect(),
            timelines,
        };
        let all = [
            entity("/chart/map/own_ship", vec![time]),
            entity("/legs", Vec::new()),
        ];
        for width in [80, 120] {
            let display = Display {
                width: Some(width),
                ..Display::default()
            };
            let text = entities_table(&all, display);
            assert!(text.lines().all(|line| line.chars().count() <= width));
            assert!(text.contains("/chart/map/own_ship  120") && text.contains("always"));
            assert_eq!(text.matches("half_sizes").count(), 6, "{text}");
        }
    }
}
