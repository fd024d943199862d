//! Text of the summary of a campaign.

use super::plan::monitors_key;
use super::table::{Display, Grid, Tone, or_dash, plain};
use crate::document::{
    CampaignDocument, GroupDocument, RareContactDocument, ShareDocument, WorstRowDocument,
    rules_in_words,
};
use crate::text::{broken, counted, tenths};

/// Caption of the table of [`clearances`].
pub(super) const CLEARANCES: &str =
    "Least clearance of the rows in metres: the smallest, and the quantiles at 1, 5 and 50 %.";

/// Formats the counts of all rows, of classes with several strata and of strata, then the bounds,
/// and the rows with the least clearance.
pub fn campaign_text(summary: &CampaignDocument, display: Display) -> String {
    let groups = groups(summary);
    let confidence = 100.0 * summary.confidence;
    let mut blocks = vec![
        format!(
            "{}: {} of {} rows, {:.0} s of processor time",
            summary.campaign, summary.rows_there, summary.rows, summary.timing.cpu_s
        ),
        counts(&groups).text(display),
        CLEARANCES.to_owned(),
        clearances(&groups).text(display),
        format!(
            "Probabilities in percent, {confidence:.0} % confidence; \"anytime\" holds for a run that \
             is watched."
        ),
        bounds(&groups, &EVENTS).text(display),
    ];
    let mut lines = Vec::new();
    if !summary.all.breaks.is_empty() {
        lines.push("Rows that break a rule, those with the least clearance first:".to_owned());
        lines.extend(breaks(summary));
        let names = summary.all.breaks.keys().map(String::as_str);
        lines.extend(monitors_key(names));
    }
    if !summary.worst.is_empty() {
        let worst = summary.worst.iter();
        let worst = worst.map(|row| match row.contact {
            true => format!("{} (CONTACT)", row.row),
            false => format!("{} ({} m)", row.row, tenths(row.clearance_m)),
        });
        let worst: Vec<String> = worst.collect();
        lines.push(format!("Least clearance in rows: {}", worst.join(", ")));
        lines.push("`searoom campaign replay` sails a row again.".to_owned());
    }
    if summary.all.faults > 0 {
        lines.push(format!(
            "NOT COUNTED: {} at which the program failed",
            counted(summary.all.faults as usize, "row")
        ));
    }
    if !lines.is_empty() {
        blocks.push(lines.join("\n"));
    }
    blocks.join("\n\n")
}

/// A line for each rule or monitor that rows break: how many do, and a few of them.
fn breaks(summary: &CampaignDocument) -> impl Iterator<Item = String> {
    summary.all.breaks.iter().map(|(name, count)| {
        let rows = summary
            .worst_breaks
            .get(name)
            .map_or(&[][..], Vec::as_slice);
        let mut named: Vec<String> = rows.iter().map(u64::to_string).collect();
        if rows.len() as u64 != *count {
            named.push("…".to_owned());
        }
        let count = counted(*count as usize, "row");
        let name = rules_in_words([name.as_str()]);
        format!("  {name} in {count}: {}", named.join(", "))
    })
}

/// Groups with their names, without classes of one stratum.
pub(super) fn groups(summary: &CampaignDocument) -> Vec<(String, &GroupDocument)> {
    let all = std::iter::once(("all".to_owned(), &summary.all));
    let has_several = |class: &&GroupDocument| {
        let mut own = summary.strata.iter().filter(|g| g.class == class.class);
        own.nth(1).is_some()
    };
    let classes = summary.classes.iter().filter(has_several);
    let classes = classes.map(|g| (format!("all of class {}", g.name), g));
    let strata = summary.strata.iter().map(|g| (g.name.clone(), g));
    all.chain(classes).chain(strata).collect()
}

pub(super) fn counts(groups: &[(String, &GroupDocument)]) -> Grid {
    let count = |share: &ShareDocument, tone| {
        let tone = if share.count > 0 { tone } else { Tone::Plain };
        (share.count.to_string(), tone)
    };
    let rows = groups.iter().map(|(name, group)| {
        vec![
            plain(name.clone()),
            plain(group.rows.to_string()),
            count(&group.contact, Tone::Bad),
            count(&group.no_plan, Tone::Bad),
            count(&group.unsafe_plan, Tone::Bad),
            count(&group.outside_sets, Tone::Fair),
            count(&group.measured_outside, Tone::Fair),
            count(&group.rule_broken, Tone::Fair),
            count(&group.timing.late, Tone::Fair),
        ]
    });
    let header = "stratum, rows, contact, no\nplan, unsafe\nplan, left\nset, measured\noutside, \
                  rule\nbroken, late";
    Grid::new(header, 1..9, rows).breaking("stratum", 16)
}

pub(super) fn clearances(groups: &[(String, &GroupDocument)]) -> Grid {
    let rows = groups.iter().map(|(name, group)| {
        let quantiles = group.clearance_m.as_ref();
        let quantiles =
            quantiles.map(|q| [q.least, q.percent_1, q.percent_5, q.median].map(tenths));
        let quantiles = quantiles.map_or([None, None, None, None], |all| all.map(Some));
        let cells = quantiles.map(or_dash).into_iter();
        std::iter::once(plain(name.clone())).chain(cells).collect()
    });
    Grid::new("stratum, smallest, 1 %, 5 %, 50 %", 1..5, rows).breaking("stratum", 20)
}

/// An event of rows: its name, and how many have it.
type Event = (&'static str, fn(&GroupDocument) -> &ShareDocument);

/// All events; the last one is of the machine.
pub(super) const EVENTS: [Event; 7] = [
    ("contact", |group| &group.contact),
    ("no plan", |group| &group.no_plan),
    ("unsafe plan", |group| &group.unsafe_plan),
    ("left set", |group| &group.outside_sets),
    ("measured outside", |group| &group.measured_outside),
    ("rule broken", |group| &group.rule_broken),
    ("late", |group| &group.timing.late),
];

/// Characters of a line of events, at most.
const LISTED: usize = 19;

/// The bounds of each event. Events of a group with equal counts have equal bounds, and one line.
pub(super) fn bounds(groups: &[(String, &GroupDocument)], events: &[Event]) -> Grid {
    let interval = |[low, high]: [f64; 2]| {
        let (low, high) = (percent(low, f64::floor), percent(high, f64::ceil));
        plain(format!("{low} to {high}"))
    };
    let mut rows = Vec::new();
    for (name, group) in groups {
        let mut alike: Vec<(&ShareDocument, String)> = Vec::new();
        for (event, of) in events {
            // lines are broken between events alone
            let (share, event) = (of(group), event.replace(' ', "\u{a0}"));
            match alike
                .iter_mut()
                .find(|(other, _)| other.count == share.count)
            {
                Some((_, names)) => *names += &format!(", {event}"),
                None => alike.push((share, event)),
            }
        }
        rows.extend(alike.into_iter().map(|(share, events)| {
            vec![
                plain(name.clone()),
                plain(broken(&events, LISTED, "")),
                plain(share.count.to_string()),
                interval(share.exact),
                interval(share.anytime),
            ]
        }));
    }
    Grid::new("stratum, event, rows, exact, anytime", 2..5, rows).breaking("stratum", 12)
}

/// A probability in percent, rounded to three digits.
fn percent(share: f64, round: fn(f64) -> f64) -> f64 {
    let percent = 100.0 * share;
    let scale = 10_f64.powi(2 - percent.max(1e-12).log10().floor() as i32);
    round(percent * scale) / scale
}

/// The rows with the least clearance, each with the command that sails it again.
pub(super) fn worst_grid(worst: &[WorstRowDocument], folder: &str) -> Grid {
    let rows = worst.iter().map(|row| {
        let clearance = match row.contact {
            true => ("CONTACT".to_owned(), Tone::Bad),
            false => plain(tenths(row.clearance_m)),
        };
        let number = row.row;
        let again = format!("searoom campaign replay {folder} --row {number} --rrd {number}.rrd");
        vec![
            plain(number.to_string()),
            plain(row.stratum.clone()),
            clearance,
            plain(again),
        ]
    });
    Grid::new("row, stratum, clearance [m], command", 2..3, rows)
}

/// Formats the probability, the levels, and what it cost.
pub fn rare_contacts_text(found: &RareContactDocument, display: Display) -> String {
    let confidence = 100.0 * found.confidence;
    let [low, high] = found.interval;
    // the bound without a contact is that of the first level
    let is_unknown = found.contact == 0.0 && high == 1.0;
    let estimate = match is_unknown {
        true => "no contact; nothing is known of its probability".to_owned(),
        false => format!(
            "P(contact) = {}, {confidence:.0} % confidence: {} to {}",
            probability(found.contact),
            probability(low),
            probability(high)
        ),
    };
    let replicas = found.replicas.len();
    let spent = found.pilot_s + found.replicas_s;
    let thousands = |seconds: f64| format!("{:.1} thousand simulated seconds", seconds / 1e3);
    let levels = found.levels.iter().map(|level| {
        let percent = level.fraction.map(|f| format!("{:.2}", 100.0 * f));
        let distance = match level.distance_m > 0.0 {
            true => tenths(level.distance_m),
            false => "contact".to_owned(),
        };
        vec![plain(distance), or_dash(percent)]
    });
    let mut remarks = match (found.plain_rows, found.plain_s) {
        (Some(rows), Some(seconds)) => format!(
            "Plain rows for the same standard error: {rows:.0}, {}: {:.1} times as many.",
            thousands(seconds),
            seconds / spent
        ),
        _ if is_unknown => "No replica had a contact, and all trajectories reach the first level: \
             from 0 to 1 every probability is possible. Splitting does not help where the start \
             decides; `campaign run` counts rows."
            .to_owned(),
        _ if found.contact == 0.0 => {
            "No replica had a contact: the upper end is that of the first level.".to_owned()
        }
        _ => "All replicas have the same result.".to_owned(),
    };
    if found.standard_error * (replicas as f64).sqrt() > found.contact {
        remarks += "\nReplicas differ by more than their mean: the interval may be too narrow, and \
                       more trajectories are needed.";
    }
    [
        format!("{}, {}: {estimate}", found.campaign, found.stratum),
        Grid::new("distance [m], reached [%]", 0..2, levels).text(display),
        format!(
            "{} of {} trajectories from each level; {}, of which {:.1} for the levels.\n{remarks}",
            counted(replicas, "replica"),
            found.trajectories,
            thousands(spent),
            found.pilot_s / 1e3,
        ),
    ]
    .join("\n\n")
}

fn probability(value: f64) -> String {
    match value {
        0.0 => "0".to_owned(),
        _ if value >= 0.01 => format!("{value:.3}"),
        _ => format!("{value:.1e}"),
    }
}
