//! Output files of a command: recordings, figures and plan documents.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use searoom::document::{PlanDocument, ScenarioComparisonDocument, SimulationDocument};
use searoom::pipeline::Run;
use searoom::report::figure::{
    FigureError, FigureFormat, FigureOptions, plan_figure, simulation_figure,
};
use searoom::report::page::{HtmlReport, Subject, link_from};
#[cfg(feature = "recording")]
use searoom::report::simulation_markdown;
use searoom::report::{ResultTable, write_atomically};
use searoom::scenario::Scenario;
use searoom::simulation::Simulation;
use searoom::study::compare::Entry;

use super::super::args::TableFiles;
use super::super::found::{Found, Refused, refuse_clashes, shown};
use super::super::runner::guarded;
use super::super::status::ExitStatus;
use super::{Output, csv, json};

/// The viewer of recordings, of the version of the library that writes them or a later one.
const VIEWER: &str = "(Rerun 0.36.3 or later: pip install rerun-sdk)";

/// Destinations of recordings, figures and plans.
#[derive(Debug)]
pub struct Products {
    /// Names of the results, without endings.
    stems: Vec<String>,
    recordings: Option<Place>,
    figures: Option<Place>,
    drawn: FigureOptions,
    plans: Option<PathBuf>,
    report: Option<PathBuf>,
}

#[derive(Debug, Clone, Default)]
pub struct Wanted<'a> {
    pub recordings: Option<&'a Path>,
    pub figures: Option<&'a Path>,
    pub drawn: FigureOptions,
    pub plans: Option<&'a Path>,
    pub report: Option<&'a Path>,
    /// Other files that the command writes, each with its option.
    pub files: Vec<(&'static str, &'a Path)>,
    /// Files that the command reads beside the scenarios.
    pub read: Vec<&'a Path>,
}

#[derive(Debug)]
enum Place {
    File(PathBuf),
    Folder(PathBuf),
}

impl Products {
    /// Creates the folders before planning. A path is a file if its name has the matching
    /// extension and no trailing slash. A new folder with another extension requires one.
    pub fn prepare(found: &[Found], wanted: Wanted) -> anyhow::Result<Self> {
        let Wanted {
            recordings,
            figures,
            drawn,
            plans,
            report,
            files,
            read,
        } = wanted;
        if recordings.is_some() && !cfg!(feature = "recording") {
            bail!(
                "--rrd: this program was built without recordings; \
                 build it with its default features, `cargo build`"
            );
        }
        figures.map(refuse_undrawn).transpose()?;
        if [recordings, figures, plans, report]
            .iter()
            .any(Option::is_some)
        {
            refuse_clashes(found)?;
        }
        let is_recording = |path: &Path| path.extension().is_some_and(|e| e == "rrd");
        let is_figure = |path: &Path| FigureFormat::of(path).is_some();
        let place = |option, path: &Path, is_file, endings| {
            Place::prepare(option, path, is_file, endings, found.len())
        };
        let recordings = recordings
            .map(|path| place("--rrd", path, is_recording(path), ".rrd"))
            .transpose()?;
        let figures = figures
            .map(|path| place("--figure", path, is_figure(path), FIGURES))
            .transpose()?;
        for (option, folder) in [("--plans", plans), ("--report", report)] {
            if let Some(folder) = folder {
                place(option, folder, false, "")?;
            }
        }
        let mut outputs: Vec<_> = { files.into_iter() }
            .map(|(option, file)| (option, file.to_owned()))
            .collect();
        for found in found {
            let stem = &found.stem;
            let file = |place: &Option<Place>, ending| Some(place.as_ref()?.file(stem, ending));
            let named =
                |folder: Option<&Path>, ending| Some(folder?.join(format!("{stem}{ending}")));
            let of_scenario = [
                ("--rrd", file(&recordings, "rrd")),
                ("--figure", file(&figures, "svg")),
                ("--plans", named(plans, ".json")),
                ("--report", named(report, "-1.svg")),
            ];
            outputs.extend({ of_scenario.into_iter() }.filter_map(|(o, file)| Some((o, file?))));
        }
        outputs.extend(report.map(|folder| ("--report", folder.join("index.html"))));
        let read = read.into_iter().map(Path::to_owned);
        let read: Vec<PathBuf> = { found.iter() }
            .map(|f| f.file.clone())
            .chain(read)
            .collect();
        refuse_overlaps(&read, outputs)?;
        Ok(Self {
            stems: found.iter().map(|found| found.stem.clone()).collect(),
            recordings,
            figures,
            drawn,
            plans: plans.map(Path::to_owned),
            report: report.map(Path::to_owned),
        })
    }

    pub fn write(&self, stem: &str, run: &Run, plan: &PlanDocument) -> Result<(), Failure> {
        attempt(|| {
            #[cfg(feature = "recording")]
            if let Some(place) = &self.recordings {
                searoom::recording::write(run, plan, &place.file(stem, "rrd"))?;
            }
            if let Some(place) = &self.figures {
                plan_figure(run, plan, &self.drawn)?.write(&place.file(stem, "svg"))?;
            }
            if let Some(folder) = &self.plans {
                let file = folder.join(format!("{stem}.json"));
                write_atomically(&file, json(plan)?.as_bytes())?;
            }
            Ok(())
        })
    }

    /// Notes where the results are, unless one could not be written.
    pub fn announce(&self, written: ExitStatus, output: &Output) {
        if written != ExitStatus::Good {
            return;
        }
        match &self.recordings {
            Some(Place::File(file)) => {
                let file = file.display();
                output.note(&format_args!(
                    "wrote {file}; to open it: rerun {file} {VIEWER}"
                ));
            }
            Some(place @ Place::Folder(folder)) => {
                let files = self.stems.iter().map(|stem| place.file(stem, "rrd"));
                let first = { files }.find(|file| file.is_file());
                let first = first.map_or(String::new(), |file| {
                    format!("; to open one: rerun {} {VIEWER}", file.display())
                });
                output.note(&format_args!("wrote {}{first}", folder.display()));
            }
            None => {}
        }
        if let Some(place) = &self.figures {
            output.wrote(place.path());
        }
        if let Some(folder) = &self.plans {
            let folder = folder.display();
            output.note(&format_args!(
                "wrote {folder}; to check the plans: searoom verify {folder}"
            ));
        }
        if let Some(folder) = &self.report {
            output.wrote(&folder.join("index.html"));
        }
    }

    /// Names and links of a scenario in a report. Call it after all other results are written.
    pub fn subject(&self, stem: &str, file: String) -> Subject {
        let recording = self.recordings.as_ref().map(|p| p.file(stem, "rrd"));
        let plan = self.plans.as_ref().map(|f| f.join(format!("{stem}.json")));
        let written = [("recording", recording), ("plan document", plan)];
        let folder = self.report.as_deref().unwrap_or(Path::new("."));
        let links = written.into_iter().filter_map(|(name, file)| {
            // omit links to files that could not be written
            let file = file.filter(|f| f.is_file())?;
            Some((name.to_owned(), link_from(folder, &file)))
        });
        Subject {
            stem: stem.to_owned(),
            file,
            links: links.collect(),
        }
    }

    pub fn wants_report(&self) -> bool {
        self.report.is_some()
    }

    pub fn write_report(
        &self,
        report: &HtmlReport,
        title: &str,
        lead: &str,
    ) -> Result<(), Failure> {
        let Some(folder) = &self.report else {
            return Ok(());
        };
        attempt(|| Ok(report.write(folder, title, lead)?))
    }

    /// Writes the recording of a comparison, if requested.
    #[cfg_attr(
        not(feature = "recording"),
        expect(unused_variables, reason = "only recordings are written of it")
    )]
    pub fn write_comparison(
        &self,
        stem: &str,
        scenario: &Scenario,
        entries: &[Entry],
        document: &ScenarioComparisonDocument,
    ) -> Result<(), Failure> {
        #[cfg(feature = "recording")]
        if let Some(place) = &self.recordings {
            let whole = searoom::document::ComparisonDocument {
                comparisons: vec![document.clone()],
            };
            return attempt(|| {
                let compared = searoom::recording::Compared {
                    scenario,
                    entries,
                    table: &searoom::report::comparison_table(document)
                        .brief()
                        .markdown(),
                    document: &json(&whole)?,
                };
                let file = place.file(stem, "rrd");
                Ok(searoom::recording::write_comparison(&compared, &file)?)
            });
        }
        Ok(())
    }

    /// Writes the figure of a simulation, and the recording of one that kept its plans.
    #[cfg_attr(
        not(feature = "recording"),
        expect(unused_variables, reason = "only recordings need the plans")
    )]
    pub fn write_simulation(
        &self,
        stem: &str,
        scenario: &Scenario,
        simulation: &Simulation,
        document: &SimulationDocument,
    ) -> Result<(), Failure> {
        attempt(|| {
            #[cfg(feature = "recording")]
            if let Some(place) = &self.recordings {
                let simulated = searoom::recording::Simulated {
                    scenario,
                    document,
                    plans: simulation.plans(),
                    text: &simulation_markdown(document),
                };
                searoom::recording::write_simulation(&simulated, &place.file(stem, "rrd"))?;
            }
            if let Some(place) = &self.figures {
                simulation_figure(scenario, document, &self.drawn)?
                    .write(&place.file(stem, "svg"))?;
            }
            Ok(())
        })
    }
}

/// Exit status and reason of a failed write.
pub type Failure = (ExitStatus, String);

fn attempt(work: impl FnOnce() -> anyhow::Result<()>) -> Result<(), Failure> {
    match guarded(work) {
        Ok(Ok(())) => Ok(()),
        // each error message already includes its cause
        Ok(Err(error)) => Err((ExitStatus::BadInput, error.to_string())),
        Err(fault) => Err((ExitStatus::InternalFault, fault)),
    }
}

/// Endings of figures.
const FIGURES: &str = ".svg, .png or .pdf";

/// Rejects a figure that this build cannot draw.
fn refuse_undrawn(path: &Path) -> anyhow::Result<()> {
    let is_pdf = FigureFormat::of(path) == Some(FigureFormat::Pdf);
    if is_pdf && !cfg!(feature = "pdf") {
        bail!("--figure: {}: {}", path.display(), FigureError::NoPdf);
    }
    Ok(())
}

/// Rejects a name that is an ending and nothing else.
fn refuse_ending(option: &str, path: &Path, endings: &str) -> anyhow::Result<()> {
    let name = path.file_name().map(|name| name.to_string_lossy());
    let is_ending = |name: &str| {
        endings
            .split([',', ' '])
            .any(|e| e.eq_ignore_ascii_case(name))
    };
    if name.is_some_and(|name| !name.is_empty() && is_ending(&name)) {
        let shown = path.display();
        bail!("{option}: {shown}: an ending alone; put a name before it");
    }
    Ok(())
}

/// Rejects a figure name with another extension, and creates its folder.
pub fn prepare_figure(path: &Path) -> anyhow::Result<()> {
    refuse_ending("--figure", path, FIGURES)?;
    if FigureFormat::of(path).is_none() {
        let file = path.to_owned();
        bail!("--figure: {}", FigureError::Format { file });
    }
    refuse_undrawn(path)?;
    refuse_folder("--figure", path, "name a file")?;
    make_parent(path)
}

impl TableFiles {
    pub fn files(&self) -> impl Iterator<Item = (&'static str, &Path)> {
        let files = [
            ("--csv", &self.csv),
            ("--md", &self.md),
            ("--tex", &self.tex),
        ];
        files
            .into_iter()
            .filter_map(|(option, file)| Some((option, file.as_deref()?)))
    }

    /// Rejects what names no file and one of the paths that are `read`, and creates the folders of the
    /// files.
    pub fn prepare(&self, read: &[PathBuf]) -> anyhow::Result<()> {
        let inputs: Vec<PathBuf> = read
            .iter()
            .filter_map(|path| path.canonicalize().ok())
            .collect();
        for (option, file) in self.files() {
            if file.as_os_str() == "-" {
                bail!("{option}: found -; allowed: a file, or /dev/stdout for standard output");
            }
            refuse_folder(option, file, "name a file")?;
            make_parent(file)?;
            let place = place(file);
            if inputs.contains(&place) || place.extension().is_some_and(|e| e == "toml") {
                let file = file.display();
                bail!(
                    "{option}: {file}: a scenario file, which would be overwritten; name another"
                );
            }
        }
        Ok(())
    }

    /// Writes the files that are asked for, with all tables in each.
    pub fn write(&self, tables: &[ResultTable], output: &Output) -> ExitStatus {
        let joined = |text: fn(&ResultTable) -> String| {
            let texts: Vec<String> = tables.iter().map(text).collect();
            Ok(format!("{}\n", texts.join("\n\n")).into_bytes())
        };
        let mut status = ExitStatus::Good;
        for (option, file) in self.files().filter(|_| !tables.is_empty()) {
            let written = attempt(|| {
                let contents = match option {
                    "--csv" => csv(records(tables)),
                    "--md" => joined(ResultTable::markdown),
                    _ => joined(ResultTable::tex),
                };
                Ok(write_atomically(file, &contents?)?)
            });
            if written.is_ok() {
                output.wrote(file);
            }
            status = status.max(output.written(written));
        }
        status
    }
}

/// Standard output, as the file that other options may name.
pub const STDOUT: &str = "/dev/stdout";

/// Rejects an option that writes a file which is `read`, and two options that write the same file.
fn refuse_overlaps(read: &[PathBuf], outputs: Vec<(&'static str, PathBuf)>) -> anyhow::Result<()> {
    let read: Vec<PathBuf> = { read.iter() }
        .filter_map(|file| file.canonicalize().ok())
        .collect();
    let mut taken: HashMap<PathBuf, &str> = HashMap::new();
    for (option, file) in outputs {
        let at = place(&file);
        // a device keeps nothing
        if at == Path::new("/dev/null") {
            continue;
        }
        if read.contains(&at) {
            let file = file.display();
            bail!(
                "{option}: {file}: a file that is read, which would be overwritten; name another"
            );
        }
        if let Some(other) = taken.insert(at, option) {
            let file = file.display();
            bail!("{option}: {file}: written by {other}, too; name another");
        }
    }
    Ok(())
}

/// Where a file is, or will be in a folder that exists: links and `..` lead there, too.
fn place(file: &Path) -> PathBuf {
    let in_folder = || {
        let folder = file
            .parent()
            .filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.unwrap_or(Path::new(".")).canonicalize().ok()?;
        Some(folder.join(file.file_name()?))
    };
    let found = file.canonicalize().ok().or_else(in_folder);
    found.unwrap_or_else(|| file.to_owned())
}

/// The rows of tables with the same keys, which come once.
fn records(tables: &[ResultTable]) -> Vec<Vec<String>> {
    let of_one =
        |(index, table): (usize, &ResultTable)| table.records()[usize::from(index > 0)..].to_vec();
    tables.iter().enumerate().flat_map(of_one).collect()
}

/// Rejects the name of a file that is a folder, or asks for one.
fn refuse_folder(option: &str, path: &Path, advice: &str) -> anyhow::Result<()> {
    if path.is_dir() || asks_for_folder(path) {
        bail!("{option}: {}: a folder; {advice}", path.display());
    }
    Ok(())
}

impl Place {
    /// Prepares one output path; `is_file` is true if its name has one of the `endings` of such a
    /// file. Without `endings`, it is a folder.
    fn prepare(
        option: &str,
        path: &Path,
        is_file: bool,
        endings: &str,
        scenarios: usize,
    ) -> anyhow::Result<Self> {
        let shown = path.display();
        if !is_file && is_another_file(path) {
            let file = match endings {
                "" => String::new(),
                endings => format!("a file ends in {endings}, "),
            };
            bail!("{option}: {shown}: {file}a new folder ends in '/'");
        }
        refuse_ending(option, path, endings)?;
        if !is_file || asks_for_folder(path) {
            make_folder(path)?;
            return Ok(Self::Folder(path.to_owned()));
        }
        refuse_folder(option, path, "a folder of results ends in '/'")?;
        if scenarios > 1 {
            bail!("{option} {shown}: a file, but there are {scenarios} scenarios; name a folder");
        }
        make_parent(path)?;
        Ok(Self::File(path.to_owned()))
    }

    fn path(&self) -> &Path {
        let (Self::File(path) | Self::Folder(path)) = self;
        path
    }

    fn file(&self, stem: &str, ending: &str) -> PathBuf {
        match self {
            Self::File(file) => file.clone(),
            Self::Folder(folder) => folder.join(format!("{stem}.{ending}")),
        }
    }
}

/// True for a name with an extension that is neither a folder nor ends with a slash.
fn is_another_file(path: &Path) -> bool {
    path.extension().is_some() && !path.is_dir() && !asks_for_folder(path)
}

fn asks_for_folder(path: &Path) -> bool {
    path.to_string_lossy().ends_with(std::path::is_separator)
}

pub fn make_parent(file: &Path) -> anyhow::Result<()> {
    match file.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => make_folder(folder),
        _ => Ok(()),
    }
}

pub fn make_folder(folder: &Path) -> anyhow::Result<()> {
    fs::create_dir_all(folder)
        .with_context(|| format!("{}: the folder cannot be made", folder.display()))
}

/// Adds a failure to a report, which shows files without the folders of this machine.
pub fn report_failure(report: &mut HtmlReport, refused: &Refused) {
    let Refused { file, error, .. } = refused;
    let name = shown(file);
    let error = error.replace(&file.display().to_string(), &name);
    report.add_failure(&name, refused.outcome, &error);
}
