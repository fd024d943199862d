//! The folder of a campaign: its index, its parts, and which rows are there.

use std::fs;
use std::io::ErrorKind;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::part::{Header, Part, PartError};
use super::row::{Cell, column, document_digest, is_kept};
use super::specification::{Specification, StratumClass, hex};
use crate::input::{Fault, InputError, read_text};
use crate::output::{WriteError, write_atomically};
use crate::scenario::FILE_MEBIBYTES;

const INDEX: &str = "campaign.json";
const INDEX_FORMAT: &str = "searoom-campaign-index/1";

/// Why a campaign cannot go on.
#[derive(Debug, thiserror::Error)]
pub enum CampaignError {
    /// A file that is wrong, or is not of this campaign.
    #[error(transparent)]
    Input(#[from] InputError),
    /// A file that cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl CampaignError {
    /// A file that is not as it has to be.
    pub(super) fn refused(file: &Path, found: impl Into<String>, allowed: &str) -> Self {
        let fault = Fault::new("", found.into(), allowed);
        Self::Input(InputError::faults(file, vec![fault]))
    }
}

/// Content of `campaign.json`, which describes the campaign of a folder.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Index {
    /// Format of this file.
    pub format: String,
    /// Name of the campaign.
    pub name: String,
    /// Hash of the specification.
    pub hash: String,
    /// Number of rows.
    pub rows: u64,
    /// Names and classes of the strata.
    pub strata: Vec<(String, StratumClass)>,
    /// Text of the specification.
    pub specification: String,
    /// Where the files that it names are, seen from this folder.
    pub folder: PathBuf,
    /// Hash of the keys before `folder`; absent in a folder of an earlier version.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub digest: Option<String>,
}

impl Index {
    /// The index of a specification whose files are in `folder`, as seen from the campaign's.
    fn of(specification: &Specification, folder: PathBuf) -> Self {
        let strata = specification.strata.iter();
        let mut index = Self {
            format: INDEX_FORMAT.to_owned(),
            name: specification.name.clone(),
            hash: specification.hash.clone(),
            rows: specification.rows,
            strata: strata.map(|s| (s.name.clone(), s.class)).collect(),
            specification: specification.text.clone(),
            folder,
            digest: None,
        };
        index.digest = Some(index.digest_of_content());
        index
    }

    /// Hash of what describes the campaign. Where its files are may change.
    fn digest_of_content(&self) -> String {
        // the words, because digests of folders that exist are of them
        let strata = self.strata.iter();
        let strata: Vec<(&str, &str)> = strata
            .map(|(name, class)| (&**name, class.word()))
            .collect();
        let content = (&self.name, &self.hash, self.rows, strata);
        let mut hash = Sha256::new();
        hash.update(format!("{content:?}{}", self.specification));
        hex(hash)
    }
}

/// A folder with an index.
#[derive(Debug, Clone)]
pub struct Folder {
    path: PathBuf,
    /// Its index.
    pub index: Index,
}

/// A part as it was found.
#[derive(Debug)]
pub(super) struct Found {
    pub file: PathBuf,
    /// Its metadata, or why it is damaged.
    pub header: Result<Header, PartError>,
}

impl Folder {
    /// Opens the folder of a campaign.
    pub fn open(path: &Path) -> Result<Self, CampaignError> {
        let file = path.join(INDEX);
        let text = read_text(&file, FILE_MEBIBYTES, "the index of a campaign")?;
        let wrong = |found: String| {
            CampaignError::refused(&file, found, "the index that `campaign run` wrote")
        };
        let index: Index = serde_json::from_str(&text).map_err(|e| wrong(e.to_string()))?;
        if index.format != INDEX_FORMAT {
            return Err(wrong(format!("format {:?}", index.format)));
        }
        let folder = Self {
            path: path.to_owned(),
            index,
        };
        let digest = folder.index.digest_of_content();
        match &folder.index.digest {
            Some(kept) if *kept == digest => Ok(folder),
            Some(kept) => {
                let found = format!(
                    "a specification, or its hash, that has changed since the campaign began: {}",
                    short(&digest)
                );
                let allowed = format!(
                    "the index of {}: put it back, or run the campaign in another folder",
                    short(kept)
                );
                Err(CampaignError::refused(&file, found, &allowed))
            }
            None => folder.refuse_unless_of_its_specification().map(|()| folder),
        }
    }

    /// Compares an index without a digest with the specification that it holds. An error if they
    /// differ, or if the files that the specification names cannot be read.
    fn refuse_unless_of_its_specification(&self) -> Result<(), CampaignError> {
        let specification = self.specification()?;
        let index = Index::of(&specification, self.index.folder.clone());
        let differs = [
            ("name", index.name != self.index.name),
            ("rows", index.rows != self.index.rows),
            ("strata", index.strata != self.index.strata),
        ];
        let Some((key, _)) = differs.into_iter().find(|(_, differs)| *differs) else {
            return Ok(());
        };
        let found = format!("no digest, and `{key}` that is not that of its `specification`");
        let allowed = "the index that `campaign run` wrote: put it back, or run the campaign in \
                       another folder";
        Err(CampaignError::refused(
            &self.path.join(INDEX),
            found,
            allowed,
        ))
    }

    /// Makes the folder, or opens it if it is of the same specification, which is in `file`.
    pub fn of(
        specification: &Specification,
        file: &Path,
        path: &Path,
    ) -> Result<Self, CampaignError> {
        for folder in [path.to_owned(), path.join("parts"), path.join("rows")] {
            fs::create_dir_all(&folder).map_err(|source| WriteError {
                file: folder.clone(),
                source,
            })?;
        }
        if path.join(INDEX).exists() {
            let folder = Self::open(path)?;
            folder.refuse_unless(&specification.hash)?;
            return Ok(folder);
        }
        let beside = crate::output::folder_of(file);
        let absolute = |path: &Path| path.canonicalize().unwrap_or_else(|_| path.to_owned());
        let (from, to) = (absolute(path), absolute(&beside));
        let folder = pathdiff::diff_paths(&to, &from).unwrap_or(to);
        let index = Index::of(specification, folder);
        let text = crate::document::json(&index).unwrap_or_default();
        write_atomically(&path.join(INDEX), text.as_bytes())?;
        Ok(Self {
            path: path.to_owned(),
            index,
        })
    }

    fn refuse_unless(&self, hash: &str) -> Result<(), CampaignError> {
        if self.index.hash == hash {
            return Ok(());
        }
        let found = format!(
            "the campaign {:?} of the specification {}",
            self.index.name,
            short(&self.index.hash)
        );
        let allowed = format!("{}, or another folder for --out", short(hash));
        let file = self.path.join(INDEX);
        Err(CampaignError::refused(&file, found, &allowed))
    }

    /// The specification, read again with the files that it names. An error if these have changed.
    pub fn specification(&self) -> Result<Specification, CampaignError> {
        let beside = self.path.join(&self.index.folder);
        let read = Specification::parse(&self.index.specification, &beside);
        let file = self.path.join(INDEX);
        let specification = read.map_err(|faults| InputError::faults(&file, faults))?;
        if specification.hash != self.index.hash {
            let found = "a specification, or its scenario files, maps or routes, that have changed \
                         since the campaign began";
            let allowed = "those with which it began";
            return Err(CampaignError::refused(&file, found, allowed));
        }
        Ok(specification)
    }

    /// Where the document of a row is kept.
    pub(super) fn row_file(&self, row: u64) -> PathBuf {
        self.path.join(format!("rows/row-{row:010}.json"))
    }

    /// Where a part is kept.
    pub(super) fn part_file(&self, header: &Header) -> PathBuf {
        self.parts().join(header.file_name())
    }

    /// Where the joined parts are kept.
    pub(super) fn joined_file(&self) -> PathBuf {
        self.path.join("campaign.parquet")
    }

    /// The folder of the parts.
    pub(super) fn parts(&self) -> PathBuf {
        self.path.join("parts")
    }

    /// What is wrong with the document of a row: it is not there although it was kept, or it is
    /// another one than was sailed, apart from its timing.
    pub fn document_fault(&self, row: &[Cell]) -> Option<Fault> {
        let Cell::Count(Some(number)) = row[0] else {
            return None;
        };
        let file = self.row_file(number.try_into().ok()?);
        let found = match fs::read(&file) {
            Err(error) if error.kind() != ErrorKind::NotFound => error.to_string(),
            Err(_) if !is_kept(row) => return None,
            Err(_) => "nothing".to_owned(),
            Ok(text) => {
                let document = serde_json::from_slice(&text).ok();
                let digest = document.and_then(|document| document_digest(&document));
                if row[column("document")] == Cell::Word(digest) {
                    return None;
                }
                "another document".to_owned()
            }
        };
        let allowed = format!(
            "the document of the row; `campaign replay --row {number} --json FILE` writes it again"
        );
        Some(Fault::new(file.display().to_string(), found, &allowed))
    }

    /// A row as it is kept in a part, if one has it, whatever the part's name.
    pub fn row(&self, row: u64) -> Result<Option<Vec<Cell>>, CampaignError> {
        match self.row_in(row, Some(row))? {
            None => self.row_in(row, None),
            kept => Ok(kept),
        }
    }

    fn row_in(&self, row: u64, with: Option<u64>) -> Result<Option<Vec<Cell>>, CampaignError> {
        let mut kept = None;
        self.each_part(with, |part| {
            let index = row.checked_sub(part.header.rows.start);
            let index = index.and_then(|index| usize::try_from(index).ok());
            kept = kept
                .take()
                .or(index.and_then(|i| part.rows.get(i)).cloned());
        })?;
        Ok(kept)
    }

    /// Reads every part, or those that have a row by their names, in the order of names, and gives
    /// those that are whole to `take`.
    pub(super) fn each_part(
        &self,
        with: Option<u64>,
        mut take: impl FnMut(&Part),
    ) -> Result<Vec<Found>, CampaignError> {
        let folder = self.parts();
        let unread = |source| InputError::unread(&folder, source);
        let entries = fs::read_dir(&folder).map_err(unread)?;
        let entries = entries.collect::<Result<Vec<_>, _>>().map_err(unread)?;
        let mut files: Vec<PathBuf> = entries.into_iter().map(|entry| entry.path()).collect();
        files.retain(|file| file.extension().is_some_and(|e| e == "parquet"));
        files.retain(|file| with.is_none_or(|row| may_have(file, row)));
        files.sort();
        let found = files.into_iter().map(|file| {
            let header = Part::read(&file).map(|part| {
                take(&part);
                part.header
            });
            Found { file, header }
        });
        Ok(found.collect())
    }

    /// Refuses parts of another specification, and of another build unless these are allowed.
    pub(super) fn refuse_foreign(
        &self,
        found: &[Found],
        other_builds: bool,
    ) -> Result<(), CampaignError> {
        let ours = Header::new(&self.index.hash, 0..0);
        for Found { file, header } in found {
            let header = match header {
                Ok(header) => header,
                Err(PartError::Damaged(_)) => continue,
                Err(PartError::OtherColumns(_)) => {
                    let found = "columns of another version of the program";
                    return Err(CampaignError::refused(file, found, "those of this one"));
                }
            };
            if header.hash != ours.hash {
                let found = format!("rows of the specification {}", short(&header.hash));
                return Err(CampaignError::refused(file, found, short(&ours.hash)));
            }
            if header.build != ours.build && !other_builds {
                let found = format!("rows of searoom {}", header.build);
                let allowed = format!(
                    "rows of searoom {}; `merge` and `summarise` take others with \
                     --allow-other-builds",
                    ours.build
                );
                return Err(CampaignError::refused(file, found, &allowed));
            }
            if header.rows.end > self.index.rows {
                let found = format!("rows up to {}", header.rows.end - 1);
                let allowed = format!("rows below {}", self.index.rows);
                return Err(CampaignError::refused(file, found, &allowed));
            }
        }
        Ok(())
    }
}

/// False where the name of a part says that it does not have a row.
fn may_have(file: &Path, row: u64) -> bool {
    let name = file.file_stem().and_then(|name| name.to_str());
    let mut numbers = name.into_iter().flat_map(|name| name.split('-').skip(1));
    let mut number = || numbers.next().and_then(|number| number.parse::<u64>().ok());
    match (number(), number()) {
        (Some(first), Some(last)) => (first..=last).contains(&row),
        _ => true,
    }
}

/// The beginning of a hash, for messages.
fn short(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

/// The rows of `all` that none of these ranges has, as ranges in order.
pub(super) fn missing(
    all: Range<u64>,
    there: impl IntoIterator<Item = Range<u64>>,
) -> Vec<Range<u64>> {
    let mut there: Vec<Range<u64>> = there.into_iter().collect();
    there.sort_by_key(|rows| rows.start);
    let mut missing = Vec::new();
    let mut next = all.start;
    for rows in there {
        let until = rows.start.min(all.end);
        if until > next {
            missing.push(next..until);
        }
        next = next.max(rows.end);
    }
    if next < all.end {
        missing.push(next..all.end);
    }
    missing
}

#[cfg(test)]
mod tests {
    use super::missing;

    #[test]
    fn rows_that_are_missing_are_found_whatever_is_there() {
        let found = |there: &[(u64, u64)]| -> Vec<(u64, u64)> {
            let there = there.iter().map(|(start, end)| *start..*end);
            let left = missing(3..9, there).into_iter();
            left.map(|rows| (rows.start, rows.end)).collect()
        };
        assert_eq!(found(&[]), [(3, 9)]);
        assert_eq!(found(&[(0, 4), (6, 7)]), [(4, 6), (7, 9)]);
        // out of order, one within another, at the edges, empty
        assert_eq!(found(&[(8, 20), (3, 6), (4, 5), (5, 5)]), [(6, 8)]);
        assert_eq!(found(&[(0, 5), (5, 9)]), []);
        assert!(missing(5..5, []).is_empty());
    }
}
