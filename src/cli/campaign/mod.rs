//! `searoom campaign`: many random encounters, sailed in parts.

use std::num::NonZero;
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;

use anyhow::{Context, anyhow, bail};
use clap::{Args, Subcommand, ValueHint};
use indicatif::ProgressStyle;
use searoom::campaign::{
    Effort, Folder, Progress, Row, Shard, Specification, differing, distributions, merge,
    rare_contacts, run, summarise,
};
use searoom::document::CampaignDocument;
use searoom::report::page::HtmlReport;
use searoom::report::{campaign_text, rare_contacts_text, simulation_text, write_atomically};
use searoom::simulation::Simulation;

use super::found::Found;
use super::output::products::{Products, Wanted, make_parent};
use super::output::{Output, json};
use super::runner::guarded;
use super::simulate::catch_interrupt;
use super::status::ExitStatus;

/// Fraction of trajectories that go on to the next level: near the best, a fifth, for many levels.
const FRACTION: f64 = 0.2;

#[derive(Debug, Args)]
pub struct CampaignArgs {
    #[command(subcommand)]
    pub command: CampaignCommand,
}

#[derive(Debug, Subcommand)]
pub enum CampaignCommand {
    /// Sails the rows of a shard that are not in the folder yet
    Run(RunArgs),
    /// Joins all parts as DIR/campaign.parquet; refuses missing, double and foreign rows
    Merge(MergeArgs),
    /// Counts the rows that are there, with bounds on each probability
    Summarise(SummariseArgs),
    /// Sails a row again, and compares it with the one that is there
    Replay(ReplayArgs),
    /// Estimates the probability of a contact that is too rare for rows (multilevel splitting)
    Rare(RareArgs),
}

#[derive(Debug, Args)]
pub struct RunArgs {
    /// The specification (docs/guide/campaigns.md)
    #[arg(value_name = "SPEC.toml", value_hint = ValueHint::FilePath)]
    pub specification: PathBuf,
    /// Number of this shard, and how many there are
    #[arg(long, value_name = "K/N", default_value = "1/1", value_parser = shard)]
    pub shard: Shard,
    /// Folder of the campaign; all shards may share it
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
    /// Rows that are sailed at once [default: as many as there are cores]
    #[arg(long, value_name = "N")]
    pub threads: Option<NonZero<usize>>,
}

#[derive(Debug, Args)]
pub struct MergeArgs {
    /// Folder of the campaign
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// Take rows of other builds of the program, too
    #[arg(long)]
    pub allow_other_builds: bool,
}

#[derive(Debug, Args)]
pub struct SummariseArgs {
    #[command(flatten)]
    pub parts: MergeArgs,
    /// Write a report for a browser, index.html and its figures, into this folder
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub report: Option<PathBuf>,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct ReplayArgs {
    /// Folder of the campaign
    #[arg(value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub folder: PathBuf,
    /// Number of the row, from 0
    #[arg(long, value_name = "I")]
    pub row: u64,
    /// Write the simulation document
    #[arg(long, value_name = "FILE.json", value_hint = ValueHint::FilePath)]
    pub json: Option<PathBuf>,
    /// Write a Rerun recording
    #[arg(long, value_name = "FILE.rrd", value_hint = ValueHint::FilePath)]
    pub rrd: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct RareArgs {
    /// The specification (docs/guide/campaigns.md)
    #[arg(value_name = "SPEC.toml", value_hint = ValueHint::FilePath)]
    pub specification: PathBuf,
    /// The stratum; the only one by default
    #[arg(long, value_name = "NAME")]
    pub stratum: Option<String>,
    /// Trajectories that begin at each level, 10 to 100000
    #[arg(long, value_name = "N", default_value_t = 500, value_parser = whole(10..=100_000))]
    pub trajectories: u64,
    /// Independent estimates, 5 to 10000
    #[arg(long, value_name = "N", default_value_t = 20, value_parser = whole(5..=10_000))]
    pub replicas: u64,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

fn whole(range: std::ops::RangeInclusive<u64>) -> clap::builder::RangedU64ValueParser {
    clap::value_parser!(u64).range(range)
}

fn shard(word: &str) -> Result<Shard, String> {
    let read = || {
        let (number, of) = word.split_once('/')?;
        let (number, of) = (number.parse().ok()?, of.parse().ok()?);
        (number <= of).then_some(Shard { number, of })
    };
    read().ok_or_else(|| "allowed: K/N with K from 1 to N, such as 1/8".to_owned())
}

pub fn campaign(command: &CampaignCommand, output: &Output) -> anyhow::Result<ExitStatus> {
    match command {
        CampaignCommand::Run(args) => sail(args, output),
        CampaignCommand::Merge(args) => {
            let folder = Folder::open(&args.folder)?;
            output.wrote(&merge(&folder, args.allow_other_builds)?);
            Ok(ExitStatus::Good)
        }
        CampaignCommand::Summarise(args) => {
            let folder = Folder::open(&args.parts.folder)?;
            let summary = summarise(&folder, args.parts.allow_other_builds)?;
            if let Some(file) = &args.report {
                write_report(args, &folder, &summary, file)?;
                output.wrote(&file.join("index.html"));
            }
            let text = || campaign_text(&summary, output.display);
            Ok(output.show(args.json, &summary, text))
        }
        CampaignCommand::Replay(args) => replay(args, output),
        CampaignCommand::Rare(args) => rare(args, output),
    }
}

fn sail(args: &RunArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    let specification = Specification::read(&args.specification)?;
    let stop = catch_interrupt(output);
    let bar = output.progress(0);
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} {per_sec} {eta} left") {
        bar.set_style(style);
    }
    let progress = |progress| match progress {
        Progress::Begins(left, _) => bar.set_length(left),
        Progress::Row => bar.inc(1),
        Progress::Damaged(text) => bar.suspend(|| output.note(&text)),
    };
    let done = run(
        &specification,
        &args.specification,
        args.shard,
        &args.out,
        args.threads,
        &stop,
        &progress,
    );
    bar.finish_and_clear();
    let done = done?;
    let mut text = format!(
        "{}, shard {}: {} rows sailed, {} were there",
        specification.name, args.shard, done.sailed, done.there
    );
    if done.faults > 0 {
        text += &format!("; the program failed at {} of them", done.faults);
    }
    if done.interrupted {
        text += "; interrupted, the same command goes on";
    }
    let shown = output.result(&text);
    let status = match (done.interrupted, done.faults) {
        (true, _) => ExitStatus::Interrupted,
        (false, 0) => ExitStatus::Good,
        (false, _) => ExitStatus::InternalFault,
    };
    Ok(shown.max(status))
}

/// A distribution of a report: title, axis, and the columns of rows, the first over the second.
type Distribution = (
    &'static str,
    &'static str,
    &'static str,
    Option<&'static str>,
);

const DISTRIBUTIONS: [Distribution; 3] = [
    (
        "Least clearance",
        "Least distance of the hulls [m]",
        "clearance_m",
        None,
    ),
    (
        "Lead of the first manoeuvre",
        "Time before the closest approach [s]",
        "lead_s",
        None,
    ),
    (
        "Space-time error",
        "J sailed / J of the first plan",
        "sailed_cost_m2",
        Some("planned_cost_m2"),
    ),
];

fn write_report(
    args: &SummariseArgs,
    folder: &Folder,
    summary: &CampaignDocument,
    into: &Path,
) -> anyhow::Result<()> {
    let columns = DISTRIBUTIONS.map(|(_, _, of, over)| (of, over));
    let values = distributions(folder, args.parts.allow_other_builds, &columns)?;
    let named = DISTRIBUTIONS.into_iter().zip(values);
    let values: Vec<_> = named
        .map(|((title, axis, ..), values)| (title, axis, values))
        .collect();
    let mut report = HtmlReport::new();
    report.add_campaign(summary, &values, &args.parts.folder.display().to_string());
    let lead = format!(
        "{} of {} rows of the specification {}.",
        summary.rows_there, summary.rows, summary.specification
    );
    Ok(report.write(into, &summary.campaign, &lead)?)
}

fn replay(args: &ReplayArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    let (row, folder) = (args.row, Folder::open(&args.folder)?);
    let specification = folder.specification()?;
    if row >= specification.rows {
        let last = specification.rows - 1;
        bail!("--row: found {row}; allowed: a row from 0 to {last}");
    }
    let stem = format!("row-{row:010}");
    let found = Found {
        file: args.folder.clone(),
        stem: stem.clone(),
        in_folder: false,
    };
    let wanted = Wanted {
        recordings: args.rrd.as_deref(),
        ..Wanted::default()
    };
    let products = Products::prepare(&[found], wanted)?;
    if let Some(file) = &args.json {
        make_parent(file)?;
    }
    let stop = catch_interrupt(output);
    let drawn = specification.scenario(row);
    let drawn = drawn.with_context(|| format!("row {row}: no draw is of its class"))?;
    let begin = match args.rrd.is_some() {
        true => Simulation::keeping_plans,
        false => Simulation::new,
    };
    let mut simulation = begin(drawn.scenario.clone(), false).map_err(|faults| {
        let faults: Vec<String> = faults.iter().map(ToString::to_string).collect();
        anyhow!("row {row}: {}", faults.join("; "))
    })?;
    while !simulation.finished() {
        simulation.step();
        if stop.load(Ordering::Relaxed) {
            output.note(&"interrupted; nothing is written");
            return Ok(ExitStatus::Interrupted);
        }
    }
    let document = simulation.record();
    let mut status = output.result(&simulation_text(&document, output.display));
    if !document.is_success() {
        status = status.max(ExitStatus::NoPlan);
    }
    if let Some(file) = &args.json {
        write_atomically(file, json(&document)?.as_bytes())?;
        output.wrote(file);
    }
    let written = products.write_simulation(&stem, &drawn.scenario, &simulation, &document);
    let written = output.written(written);
    products.announce(written, output);
    let again = Row::of(&specification, row, Some(&drawn), Some(document), 0.0);
    let compared = match folder.row(row)? {
        None => {
            output.note(&format_args!("row {row} is not in the campaign yet"));
            ExitStatus::Good
        }
        Some(kept) => match (
            differing(&kept, &again.cells).as_slice(),
            folder.document_fault(&kept),
        ) {
            ([], None) => {
                output.note(&format_args!("row {row} is as it was in the campaign"));
                ExitStatus::Good
            }
            ([], Some(fault)) => output.fault(&fault),
            (columns, _) => output.fault(&format_args!(
                "row {row} is not as it was in the campaign, which another build may have sailed: \
                 {}",
                columns.join(", ")
            )),
        },
    };
    Ok(status.max(written).max(compared))
}

fn rare(args: &RareArgs, output: &Output) -> anyhow::Result<ExitStatus> {
    let specification = Specification::read(&args.specification)?;
    let names: Vec<&str> = specification.strata.iter().map(|s| &*s.name).collect();
    let stratum = match (&args.stratum, names.as_slice()) {
        (Some(name), _) => names.iter().position(|own| own == name),
        (None, [_]) => Some(0),
        (None, _) => bail!("--stratum: found none; allowed: one of {names:?}"),
    };
    let name = args.stratum.as_deref().unwrap_or(names[0]);
    let Some(stratum) = stratum else {
        bail!("--stratum: found {name:?}; allowed: one of {names:?}");
    };
    let effort = Effort {
        trajectories: args.trajectories as usize,
        replicas: args.replicas as usize,
        fraction: FRACTION,
    };
    let stop = catch_interrupt(output);
    // the pilot run is one step
    let bar = output.progress(effort.replicas + 1);
    let tick = || bar.inc(1);
    let found = guarded(|| rare_contacts(&specification, stratum, &effort, &stop, &tick));
    bar.finish_and_clear();
    let found = match found {
        Ok(found) => found,
        Err(fault) => return Ok(output.fault(&format_args!("{name}: {fault}"))),
    };
    let (ended, of) = (
        found.as_ref().map_or(0, |f| f.replicas.len()),
        effort.replicas,
    );
    let shown = found.map_or(ExitStatus::Good, |found| {
        output.show(args.json, &found, || {
            rare_contacts_text(&found, output.display)
        })
    });
    if ended == of {
        return Ok(shown);
    }
    output.note(&match ended {
        0 => "interrupted before two replicas had ended; nothing is estimated".to_owned(),
        _ => format!("interrupted; the estimate is that of {ended} of {of} replicas"),
    });
    Ok(shown.max(ExitStatus::Interrupted))
}
