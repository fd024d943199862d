//! Joins the parts of a campaign, and counts their rows.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::PathBuf;

use super::bounds::{anytime, clopper_pearson};
use super::folder::{CampaignError, Folder, Found, missing};
use super::part::{Header, Part, join};
use super::row::{Cell, FAULT, column, happened};
use super::run::word;
use super::specification::StratumClass;
use crate::document::{
    CAMPAIGN_FORMAT, CampaignDocument, CampaignTimingDocument, GroupDocument, GroupTimingDocument,
    QuantilesDocument, ShareDocument, WorstRowDocument,
};
use crate::input::{Fault, InputError};
use crate::text::counted;

pub(super) const CONFIDENCE: f64 = 0.95;

/// Rows that a summary names.
const WORST: usize = 10;

/// Rows that a summary names of each rule or monitor that is broken.
const WORST_BREAKS: usize = 5;

/// Ranges of rows that a message names.
const NAMED: usize = 10;

/// Joins all parts of a campaign as one file in the order of rows, which is returned. Damaged,
/// foreign, missing and double rows are refused; the error names all of them.
pub fn merge(folder: &Folder, other_builds: bool) -> Result<PathBuf, CampaignError> {
    let found = sound(folder, other_builds, |_| ())?;
    let rows = found.iter().map(|(_, header)| header.rows.clone());
    let left = missing(0..folder.index.rows, rows);
    if !left.is_empty() {
        let some: Vec<String> = left.iter().take(NAMED).map(named).collect();
        let more = match left.len().saturating_sub(NAMED) {
            0 => String::new(),
            more => format!(" and {} more", counted(more, "range")),
        };
        let found = format!("no {}{more}", some.join(", "));
        let allowed = "every row once; `campaign run` sails those that are missing";
        return Err(CampaignError::refused(&folder.parts(), found, allowed));
    }
    let mut builds: Vec<&str> = found.iter().map(|(_, header)| &*header.build).collect();
    builds.sort_unstable();
    builds.dedup();
    let header = Header {
        build: builds.join(", "),
        ..Header::new(&folder.index.hash, 0..folder.index.rows)
    };
    let files: Vec<PathBuf> = found.iter().map(|(file, _)| file.clone()).collect();
    let file = folder.joined_file();
    join(&file, &header, &files)?;
    Ok(file)
}

fn named(rows: &Range<u64>) -> String {
    match rows.end - rows.start {
        1 => format!("row {}", rows.start),
        _ => format!("rows {} to {}", rows.start, rows.end - 1),
    }
}

/// The parts in the order of their rows, each of which is given to `take`; an error where one is
/// damaged, foreign or renamed, or has a row that another one has, or whose document was altered.
fn sound(
    folder: &Folder,
    other_builds: bool,
    mut take: impl FnMut(&Part),
) -> Result<Vec<(PathBuf, Header)>, CampaignError> {
    let mut faults = Vec::new();
    let found = folder.each_part(None, |part| {
        faults.extend(
            part.rows
                .iter()
                .filter_map(|row| folder.document_fault(row)),
        );
        take(part);
    })?;
    folder.refuse_foreign(&found, other_builds)?;
    let mut parts = Vec::new();
    for Found { file, header } in found {
        match header {
            Ok(header) => parts.push((file, header)),
            Err(error) => {
                let allowed = "a whole part; `campaign run` sails its rows again";
                faults.push(Fault::new("", error, allowed));
            }
        }
    }
    parts.sort_by_key(|(_, header)| header.rows.start);
    faults.extend(misplaced(&parts));
    if faults.is_empty() {
        return Ok(parts);
    }
    Err(InputError::faults(&folder.parts(), faults).into())
}

/// Rows that two parts have, of parts in the order of their rows, or else the parts whose names are
/// not those of their rows: a run could write another part over one.
pub(super) fn misplaced(parts: &[(PathBuf, Header)]) -> Vec<Fault> {
    let mut faults = Vec::new();
    // the part of all before that reaches farthest
    let mut last: Option<&(PathBuf, Header)> = None;
    for part in parts {
        let (file, Header { rows, .. }) = part;
        if let Some((other, before)) = last
            && rows.start < before.rows.end
        {
            let both = rows.start..rows.end.min(before.rows.end);
            let (file, other) = (file.display(), other.display());
            let found = format!("{} in {other} and in {file}", named(&both));
            let allowed = "every row once; delete one of the two";
            faults.push(Fault::new("", found, allowed));
        }
        if last.is_none_or(|(_, before)| rows.end > before.rows.end) {
            last = Some(part);
        }
    }
    if faults.is_empty() {
        let is_renamed = |(file, header): &&(PathBuf, Header)| !file.ends_with(header.file_name());
        faults.extend(parts.iter().filter(is_renamed).map(|(file, header)| {
            let found = format!("{} in {}", named(&header.rows), file.display());
            Fault::new("", found, header.file_name())
        }));
    }
    faults
}

/// Events of a row: columns of which one is true or above zero.
const EVENTS: [&[&str]; 7] = [
    &["contact"],
    &["no_plan"],
    &["unsafe_plans"],
    &["outside_sets"],
    &["outside_velocities", "outside_places"],
    &["broken"],
    &["late"],
];

/// The rules and monitors that a row breaks.
fn broken(row: &[Cell]) -> impl Iterator<Item = &str> {
    let names = match &row[column("breaks")] {
        Cell::Word(names) => names.as_deref(),
        _ => None,
    };
    names.into_iter().flat_map(|names| names.split(';'))
}

/// Counts over some rows.
#[derive(Debug, Default, Clone)]
struct Tally {
    rows: u64,
    faults: u64,
    events: [u64; EVENTS.len()],
    breaks: BTreeMap<String, u64>,
    clearances: Vec<f64>,
}

impl Tally {
    fn add(&mut self, row: &[Cell]) {
        let cell = |name: &str| &row[column(name)];
        if *cell("outcome") == word(FAULT) {
            self.faults += 1;
            return;
        }
        self.rows += 1;
        for (count, names) in self.events.iter_mut().zip(EVENTS) {
            *count += u64::from(names.iter().any(|name| happened(row, name)));
        }
        for name in broken(row) {
            *self.breaks.entry(name.to_owned()).or_default() += 1;
        }
        if let Cell::Number(Some(clearance)) = cell("clearance_m") {
            self.clearances.push(*clearance);
        }
    }

    fn join(&mut self, other: &Self) {
        self.rows += other.rows;
        self.faults += other.faults;
        for (count, more) in self.events.iter_mut().zip(other.events) {
            *count += more;
        }
        for (name, count) in &other.breaks {
            *self.breaks.entry(name.clone()).or_default() += count;
        }
        self.clearances.extend(&other.clearances);
    }

    fn document(mut self, name: &str, class: Option<StratumClass>) -> GroupDocument {
        let shares = self.events.map(|count| ShareDocument {
            count,
            exact: clopper_pearson(count, self.rows, CONFIDENCE),
            anytime: anytime(count, self.rows, CONFIDENCE),
        });
        let [
            contact,
            no_plan,
            unsafe_plan,
            outside_sets,
            measured_outside,
            rule_broken,
            late,
        ] = shares;
        self.clearances.sort_by(f64::total_cmp);
        let last = self.clearances.len().saturating_sub(1);
        let quantile = |p: f64| {
            let index = (p * last as f64).ceil() as usize;
            self.clearances.get(index).copied()
        };
        let quantiles = || {
            Some(QuantilesDocument {
                least: quantile(0.0)?,
                percent_1: quantile(0.01)?,
                percent_5: quantile(0.05)?,
                median: quantile(0.5)?,
            })
        };
        GroupDocument {
            name: name.to_owned(),
            class: class.map(|class| class.to_string()),
            rows: self.rows,
            faults: self.faults,
            contact,
            no_plan,
            unsafe_plan,
            outside_sets,
            measured_outside,
            rule_broken,
            timing: GroupTimingDocument { late },
            clearance_m: quantiles(),
            breaks: self.breaks,
        }
    }
}

/// Counts the rows that are there, whole or not: the same document for any number of shards.
pub fn summarise(folder: &Folder, other_builds: bool) -> Result<CampaignDocument, CampaignError> {
    let index = &folder.index;
    let mut tallies = vec![Tally::default(); index.strata.len()];
    let mut worst: Vec<WorstRowDocument> = Vec::new();
    let mut breaking: BTreeMap<String, Vec<(f64, u64)>> = BTreeMap::new();
    let mut cpu_s = 0.0;
    sound(folder, other_builds, |part| {
        for row in &part.rows {
            let Cell::Word(Some(stratum)) = &row[column("stratum")] else {
                continue;
            };
            let own = index.strata.iter().position(|(name, _)| name == stratum);
            if let Some(tally) = own.and_then(|own| tallies.get_mut(own)) {
                tally.add(row);
            }
            if let Cell::Number(Some(seconds)) = row[column("cpu_s")] {
                cpu_s += seconds;
            }
            if let (Cell::Number(Some(clearance_m)), Cell::Count(Some(number))) =
                (&row[column("clearance_m")], &row[0])
            {
                worst.push(WorstRowDocument {
                    row: *number as u64,
                    stratum: stratum.clone(),
                    clearance_m: *clearance_m,
                    contact: row[column("contact")] == Cell::Truth(Some(true)),
                });
                for name in broken(row) {
                    let rows = breaking.entry(name.to_owned()).or_default();
                    rows.push((*clearance_m, *number as u64));
                }
            }
        }
        for rows in breaking.values_mut() {
            rows.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            rows.truncate(WORST_BREAKS);
        }
        worst.sort_by(|a, b| (a.clearance_m.total_cmp(&b.clearance_m)).then(a.row.cmp(&b.row)));
        worst.truncate(WORST);
    })?;
    let group = |is_one: &dyn Fn(usize) -> bool, name: &str, class: Option<StratumClass>| {
        let mut sum = Tally::default();
        let own = tallies
            .iter()
            .enumerate()
            .filter(|(index, _)| is_one(*index));
        own.for_each(|(_, tally)| sum.join(tally));
        sum.document(name, class)
    };
    let mut classes: Vec<StratumClass> = Vec::new();
    for (_, class) in &index.strata {
        if !classes.contains(class) {
            classes.push(*class);
        }
    }
    let all = group(&|_| true, "all", None);
    Ok(CampaignDocument {
        format: CAMPAIGN_FORMAT.to_owned(),
        build: super::part::build(),
        campaign: index.name.clone(),
        specification: index.hash.clone(),
        rows: index.rows,
        rows_there: all.rows + all.faults,
        confidence: CONFIDENCE,
        classes: (classes.into_iter())
            .map(|class| group(&|at| index.strata[at].1 == class, class.word(), Some(class)))
            .collect(),
        strata: (index.strata.iter().enumerate())
            .map(|(own, (name, class))| group(&|at| at == own, name, Some(*class)))
            .collect(),
        all,
        worst,
        worst_breaks: (breaking.into_iter())
            .map(|(name, rows)| (name, rows.into_iter().map(|(_, row)| row).collect()))
            .collect(),
        timing: CampaignTimingDocument { cpu_s },
    })
}

/// The finite values of some columns of numbers in each stratum, in order, of rows that were
/// sailed; of two columns, the first over the second.
pub fn distributions(
    folder: &Folder,
    other_builds: bool,
    of: &[(&str, Option<&str>)],
) -> Result<Vec<Vec<Vec<f64>>>, CampaignError> {
    let strata = &folder.index.strata;
    let mut values = vec![vec![Vec::new(); strata.len()]; of.len()];
    sound(folder, other_builds, |part| {
        for row in &part.rows {
            let is_own = |(name, _): &(String, StratumClass)| row[column("stratum")] == word(name);
            let Some(own) = strata.iter().position(is_own) else {
                continue;
            };
            let number = |name: &str| match row[column(name)] {
                Cell::Number(Some(number)) => number,
                _ => f64::NAN,
            };
            for (values, (name, over)) in values.iter_mut().zip(of) {
                let value = number(name) / over.map_or(1.0, number);
                if value.is_finite() {
                    values[own].push(value);
                }
            }
        }
    })?;
    let each = values.iter_mut().flatten();
    each.for_each(|values| values.sort_by(f64::total_cmp));
    Ok(values)
}
