//! Sails the rows of a shard that are not there yet, on all cores.

use std::num::NonZero;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Mutex, PoisonError};

use super::folder::{CampaignError, Folder, Found, missing};
use super::part::{Header, Part};
use super::row::{Cell, FAULT, Row, column};
use super::specification::Specification;
use super::summary::misplaced;
use crate::document::{SimulationDocument, json};
use crate::input::InputError;
use crate::output::{WriteError, write_atomically};
use crate::parallel::{cores, on_threads};

/// Most rows of a part: what a killed run loses, and what is in memory.
const PART_ROWS: u64 = 1000;

/// One of several equal shares of the rows, numbered from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shard {
    /// Its number.
    pub number: NonZero<u64>,
    /// How many there are.
    pub of: NonZero<u64>,
}

impl Shard {
    /// All rows.
    pub const ALL: Self = Self {
        number: NonZero::<u64>::MIN,
        of: NonZero::<u64>::MIN,
    };

    /// Its rows of so many.
    fn rows(self, all: u64) -> Range<u64> {
        let (number, of) = (u128::from(self.number.get()), u128::from(self.of.get()));
        let until = |n: u128| (u128::from(all) * n / of) as u64;
        until(number - 1)..until(number)
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}/{}", self.number, self.of)
    }
}

/// Progress of a run.
#[derive(Debug)]
pub enum Progress {
    /// So many rows are to be sailed, and so many are there.
    Begins(u64, u64),
    /// A row is done.
    Row,
    /// A part that is damaged, and what is done about it.
    Damaged(String),
}

/// Result of a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Done {
    /// Rows that were sailed.
    pub sailed: u64,
    /// Rows that were there.
    pub there: u64,
    /// Rows at which the program failed.
    pub faults: u64,
    /// True where `stop` ended it.
    pub interrupted: bool,
}

/// Sails the rows of a shard that no part in the folder has. Where `stop` is set, rows that are
/// under way are finished and kept.
pub fn run(
    specification: &Specification,
    file: &Path,
    shard: Shard,
    folder: &Path,
    threads: Option<NonZero<usize>>,
    stop: &AtomicBool,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Done, CampaignError> {
    let folder = Folder::of(specification, file, folder)?;
    let found = folder.each_part(None, |_| ())?;
    folder.refuse_foreign(&found, false)?;
    let mut parts = Vec::new();
    for Found { file, header } in found {
        match header {
            Ok(header) => parts.push((file, header)),
            Err(error) => {
                let aside = file.with_extension("damaged");
                std::fs::rename(&file, &aside).map_err(|source| WriteError {
                    file: aside.clone(),
                    source,
                })?;
                let name = aside.display();
                progress(Progress::Damaged(format!(
                    "{error}; kept as {name}, its rows are sailed again"
                )));
            }
        }
    }
    parts.sort_by_key(|(_, header)| header.rows.start);
    let misplaced = misplaced(&parts);
    if !misplaced.is_empty() {
        return Err(InputError::faults(&folder.parts(), misplaced).into());
    }
    let all = shard.rows(specification.rows);
    let there = parts.into_iter().map(|(_, header)| header.rows);
    let gaps = missing(all.clone(), there);
    let left = gaps.iter().map(|gap| gap.end - gap.start).sum::<u64>();
    let mut done = Done {
        sailed: 0,
        there: (all.end - all.start) - left,
        faults: 0,
        interrupted: false,
    };
    progress(Progress::Begins(left, done.there));
    let threads = threads.map_or_else(cores, NonZero::get);
    for gap in gaps {
        let mut next = gap.start;
        while next < gap.end && !done.interrupted {
            let end = gap.end.min(next + PART_ROWS);
            let rows = sail(specification, &folder, next..end, threads, stop, progress)?;
            let reached = next + rows.len() as u64;
            done.interrupted = reached < end;
            if !rows.is_empty() {
                let failed = |row: &&Vec<Cell>| row[column("outcome")] == word(FAULT);
                done.faults += rows.iter().filter(failed).count() as u64;
                done.sailed += rows.len() as u64;
                let header = Header::new(&specification.hash, next..reached);
                let file = folder.part_file(&header);
                Part { header, rows }.write(&file, &shard.to_string())?;
            }
            next = end;
        }
    }
    Ok(done)
}

pub(super) fn word(word: &str) -> Cell {
    Cell::Word(Some(word.to_owned()))
}

/// The first of these rows, in order: all of them, unless `stop` is set.
fn sail(
    specification: &Specification,
    folder: &Folder,
    rows: Range<u64>,
    threads: usize,
    stop: &AtomicBool,
    progress: &(dyn Fn(Progress) + Sync),
) -> Result<Vec<Vec<Cell>>, CampaignError> {
    let next = AtomicU64::new(rows.start);
    let found: Mutex<Vec<(u64, Vec<Cell>)>> = Mutex::new(Vec::new());
    let failed = Mutex::new(None);
    let is_over = AtomicBool::new(false);
    on_threads(threads, || {
        while !stop.load(Ordering::Relaxed) && !is_over.load(Ordering::Relaxed) {
            // rows are begun in order, and each that is begun is finished
            let row = next.fetch_add(1, Ordering::Relaxed);
            if row >= rows.end {
                break;
            }
            let Row { cells, document } = Row::sail(specification, row);
            if let Some(document) = document
                && let Err(error) = write_document(&folder.row_file(row), &document)
            {
                is_over.store(true, Ordering::Relaxed);
                *failed.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                break;
            }
            let mut found = found.lock().unwrap_or_else(PoisonError::into_inner);
            found.push((row, cells));
            progress(Progress::Row);
        }
    });
    if let Some(error) = failed.into_inner().unwrap_or_else(PoisonError::into_inner) {
        return Err(error.into());
    }
    let mut found = found.into_inner().unwrap_or_else(PoisonError::into_inner);
    found.sort_by_key(|(row, _)| *row);
    Ok(found.into_iter().map(|(_, cells)| cells).collect())
}

fn write_document(file: &Path, document: &SimulationDocument) -> Result<(), WriteError> {
    let text = json(document).map_err(|error| WriteError {
        file: file.to_owned(),
        source: error.into(),
    })?;
    write_atomically(file, text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_have_every_row_once() {
        for (rows, of) in [(0, 1), (1, 7), (40, 64), (1_000_000_000, 7), (10, 10)] {
            let of = NonZero::new(of).expect("not zero");
            let mut next = 0;
            for number in 1..=of.get() {
                let number = NonZero::new(number).expect("not zero");
                let own = Shard { number, of }.rows(rows);
                assert_eq!(own.start, next);
                next = own.end;
            }
            assert_eq!(next, rows);
        }
    }
}
