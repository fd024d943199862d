//! The arguments.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Arg, Args, Parser, Subcommand, ValueHint};
use searoom::colregs::Thresholds;
use searoom::document::{PlanDocument, breaks};
use searoom::input::DATE_TIME;
use searoom::pipeline::Run;
use searoom::planner::{Planner, SearchKind, planner_words};
use searoom::report::figure::{FigureFormat, FigureOptions};
use searoom::report::printable_lines;
use searoom::scenario::import::{Assumed, Assumption};
use searoom::scenario::read_thresholds;
use searoom::scenario::{Compliance, Fault, Scenario, unix_seconds};
use searoom::traffic::Source;

use super::campaign::CampaignArgs;
use super::input::rows;
use super::output::products::{STDOUT, Wanted};
use super::shell::schema_kinds;
use super::status::ExitStatus;

/// Heading of the options of traffic.
const TRAFFIC: &str = "Traffic";

/// The text below the options of a command.
macro_rules! example {
    ($words:literal) => {
        concat!("Example:\n  ", $words)
    };
}

/// Plans how a ship keeps clear of others when nobody knows exactly what they will do.
///
/// Exit status; the highest of a run wins:
///   0    every scenario has a plan that is verified and safe
///   1    a scenario has no safe plan that arrives, or `verify` rejects a plan
///   2    bad input or usage, or a result that cannot be written
///   3    a fault of the program
///   130  a simulation or a campaign was ended by Ctrl-C
#[derive(Debug, Parser)]
#[command(name = "searoom", version, max_term_width = 100, verbatim_doc_comment)]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
    /// Print errors alone, and a document if one is asked for
    #[arg(long, global = true, display_order = 998)]
    pub quiet: bool,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Writes a commented scenario file to begin with
    #[command(after_help = example!("searoom init mine.toml"))]
    Init(InitArgs),
    /// Reads and checks scenario files, plans nothing; reports every fault at once
    #[command(after_help = example!("searoom check scenarios/colregs"))]
    Check(CheckArgs),
    /// Gives risk, closest approach, velocity obstacle and least alteration, without planning
    #[command(after_help = example!("searoom assess scenarios/colregs/head-on.toml --at 700,0,120 --section 120"))]
    Assess(AssessArgs),
    /// Plans one scenario, prints the verdict and the costs
    #[command(after_help = example!("searoom plan scenarios/colregs/head-on.toml --figure head-on.svg"))]
    Plan(PlanArgs),
    /// Runs every scenario below the paths: one row each, a summary, one exit status
    #[command(after_help = example!("searoom suite scenarios/colregs --report report"))]
    Suite(SuiteArgs),
    /// Sails scenarios in the closed loop: plans again and again while the targets move
    #[command(after_help = example!("searoom simulate scenarios/closed-loop/head-on-radar.toml --seed 2"))]
    Simulate(SimulateArgs),
    /// Sails thousands of random encounters, in parts that are resumed, merged and counted
    #[command(after_help = example!("searoom campaign run spec.toml --shard 1/4 --out sailed"))]
    Campaign(CampaignArgs),
    /// Turns files of other formats into scenario files
    #[command(after_help = example!("searoom import scenarios/dnv --out imported"))]
    Import(ImportArgs),
    /// Watches live or recorded traffic: the ships with risk of collision, and a plan where there is any
    #[command(after_help = example!("searoom watch own.toml --listen udp://10110"))]
    Watch(WatchArgs),
    /// Compares all planners that apply, and two baselines, on the same scenarios
    #[command(after_help = example!("searoom compare scenarios/colregs --csv compared.csv"))]
    Compare(CompareArgs),
    /// Shows the contents of a recording
    #[command(after_help = example!("searoom inspect head-on.rrd"))]
    Inspect(InspectArgs),
    /// Checks plan documents from their own content, without the code of the planners
    #[command(after_help = example!("searoom plan scenarios/colregs/head-on.toml --json | searoom verify -"))]
    Verify(VerifyArgs),
    /// Prints the completion script of a shell
    #[command(after_help = example!("searoom completions bash > ~/.local/share/bash-completion/completions/searoom"))]
    Completions(CompletionsArgs),
    /// Prints the JSON schema of scenario files, of thresholds, or of the document of a command
    #[command(after_help = example!("searoom schema scenario > scenario.schema.json"))]
    Schema(SchemaArgs),
}

#[derive(Debug, Args)]
pub struct InitArgs {
    /// The new file
    #[arg(value_name = "FILE.toml", value_hint = ValueHint::FilePath)]
    pub file: PathBuf,
}

#[derive(Debug, Args)]
pub struct CheckArgs {
    /// Scenario files, files of other formats, or folders of them; - is standard input
    #[arg(required = true, value_name = "SCENARIO")]
    pub paths: Vec<PathBuf>,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub assumed: AssumedArgs,
}

#[derive(Debug, Args)]
#[command(mut_arg("figure", |arg| arg.value_name("FILE").help(
    "Draw the sections, their risk, and dCPA: a file ending in .svg, .png or .pdf"
)))]
pub struct AssessArgs {
    /// A scenario file, or a file of another format with one situation; - is standard input
    #[arg(value_name = "SCENARIO", value_hint = ValueHint::FilePath)]
    pub scenario: PathBuf,
    /// A point and a time: metres, metres, seconds; repeatable
    #[arg(long, value_name = "EAST,NORTH,T", value_parser = point, allow_hyphen_values = true)]
    pub at: Vec<[f64; 3]>,
    /// Points from a CSV file with the header east_m,north_m,t_s
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub points: Option<PathBuf>,
    /// A velocity of own ship from t = 0 on, m/s; repeatable
    #[arg(long, value_name = "EAST,NORTH", value_parser = velocity, allow_hyphen_values = true)]
    pub velocity: Vec<[f64; 2]>,
    /// Velocities from a CSV file with the header east_mps,north_mps
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub velocities: Option<PathBuf>,
    /// A time in seconds at which to print the sets; repeatable
    #[arg(long, value_name = "T", value_parser = time, allow_hyphen_values = true)]
    pub section: Vec<f64>,
    /// Use the ship domains instead of the hard sets
    #[arg(long)]
    pub domains: bool,
    #[command(flatten)]
    pub drawn: Drawn,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
    #[command(flatten)]
    pub assumed: AssumedArgs,
}

#[derive(Debug, Args)]
pub struct PlanArgs {
    /// A scenario file, or a file of another format with one situation; - is standard input
    #[arg(value_name = "SCENARIO", value_hint = ValueHint::FilePath)]
    pub scenario: PathBuf,
    #[command(flatten)]
    pub shared: Shared,
    /// Also find the last time at which own ship can still avoid every hard set (space-time
    /// planner)
    #[arg(long)]
    pub no_return: bool,
    /// Also find a cost that no motion can be below, and so how far the plan may be from the best
    /// (takes some seconds)
    #[arg(long)]
    pub bound: bool,
    /// Write the legs: a file ending in .csv, .geojson or .rtz; the last two need an origin
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub route: Option<PathBuf>,
    /// The plan that own ship follows now, as `plan --json` wrote it; - is standard input. The new
    /// plan keeps its roles and its manoeuvre
    #[arg(long, value_name = "PLAN.json", value_hint = ValueHint::FilePath)]
    pub previous: Option<PathBuf>,
    /// Ignore the previous plan if it does not fit
    #[arg(long, requires = "previous")]
    pub ignore_previous: bool,
    // the last, because its heading holds for all that follows
    #[command(flatten)]
    pub assumed: AssumedArgs,
}

#[derive(Debug, Args)]
pub struct SuiteArgs {
    /// Scenario files, files of other formats, or folders. A folder is searched for .toml, .json
    /// and .xml files, except hidden ones; - is standard input
    #[arg(value_name = "PATH", default_value = "scenarios")]
    pub paths: Vec<PathBuf>,
    #[command(flatten)]
    pub shared: Shared,
    /// Write one plan document per scenario into this folder
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub plans: Option<PathBuf>,
    #[command(flatten)]
    pub tables: TableFiles,
    /// Plan nothing: report where ships would meet, and errors in the scenarios
    #[arg(long, conflicts_with_all = [
        "plans", "report", "rrd", "figure", "planner", "search", "compliance", "max_risk",
        "thresholds", "strict", "csv", "md", "tex",
    ])]
    pub lint: bool,
    // the last, because its heading holds for all that follows
    #[command(flatten)]
    pub assumed: AssumedArgs,
}

#[derive(Debug, Args)]
#[command(
    mut_arg("rrd", |arg| arg.help(
        "Write one Rerun recording per scenario: a file ending in .rrd, or a folder"
    )),
    mut_arg("figure", |arg| arg.help(
        "Draw the tracks of all ships and the closest approach: a file ending in .svg, .png or \
         .pdf, or a folder for SVG"
    )),
)]
pub struct SimulateArgs {
    /// Scenario files, files of other formats, or folders of them; - is standard input
    #[arg(required = true, value_name = "SCENARIO")]
    pub paths: Vec<PathBuf>,
    #[command(flatten)]
    pub asked: Asked,
    /// Seed of the random numbers instead of the scenario's
    #[arg(long, value_name = "N")]
    pub seed: Option<u64>,
    /// Seconds to simulate instead of the scenario's
    #[arg(long, value_name = "S", value_parser = duration)]
    pub duration_s: Option<f64>,
    /// Discard a plan that takes longer than the delay; the result then depends on the machine
    #[arg(long)]
    pub measured_delay: bool,
    /// Write the document of every plan into this folder
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub plans: Option<PathBuf>,
    #[command(flatten)]
    pub written: Written,
    #[command(flatten)]
    pub assumed: AssumedArgs,
}

#[derive(Debug, Args)]
pub struct ImportArgs {
    /// Files of other formats, or folders of them; with --at files of traffic, - is standard input
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Make one scenario of the traffic at a date and time, such as 2026-05-01T12:00:00Z
    #[arg(long, value_name = "TIME", value_parser = date, requires = "route", help_heading = TRAFFIC)]
    pub at: Option<f64>,
    /// Own ship's MMSI, where the traffic has own ship as one among others
    #[arg(long, value_name = "MMSI", requires = "at", help_heading = TRAFFIC)]
    #[arg(value_parser = clap::value_parser!(u32).range(1..=999_999_999))]
    pub own: Option<u32>,
    /// Own ship's position, course and speed in knots, where the traffic does not have it
    #[arg(long, value_name = "LAT,LON,COURSE,KN", requires = "at", help_heading = TRAFFIC)]
    #[arg(value_parser = own_pose, allow_hyphen_values = true, conflicts_with = "own")]
    pub own_pose: Option<[f64; 4]>,
    /// Own ship's route
    #[arg(long, value_name = "FILE.rtz", requires = "at", help_heading = TRAFFIC)]
    pub route: Option<PathBuf>,
    /// Folder for the scenario files; created if it does not exist
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub out: PathBuf,
    #[command(flatten)]
    pub assumed: AssumedArgs,
}

#[derive(Debug, Args)]
pub struct WatchArgs {
    /// A scenario file with an origin: own ship, its mission and settings. The traffic gives positions
    #[arg(value_name = "SCENARIO", value_hint = ValueHint::FilePath)]
    pub scenario: PathBuf,
    /// Where the traffic comes from: udp://[HOST:]PORT, tcp://HOST:PORT, a file, or - for standard
    /// input; repeatable
    #[arg(long, required = true, value_name = "SOURCE", value_parser = source)]
    pub listen: Vec<Source>,
    /// Own ship's MMSI, where the traffic has own ship as one among others
    #[arg(long, value_name = "MMSI", value_parser = clap::value_parser!(u32).range(1..=999_999_999))]
    pub own: Option<u32>,
    /// Times the pace at which a file was recorded, or max
    #[arg(long, value_name = "N", default_value = "1", value_parser = pace)]
    pub speed: f64,
    /// Seconds from one moment to the next
    #[arg(long, value_name = "S", default_value = "1", value_parser = every)]
    pub every_s: f64,
    /// Seconds to watch, on the clock of the traffic [default: to its end, or to Ctrl-C]
    #[arg(long, value_name = "S", value_parser = duration)]
    pub duration_s: Option<f64>,
    /// Compliance instead of the scenario's
    #[arg(long, value_name = "C", value_parser = words(Compliance::WORDS))]
    pub compliance: Option<Compliance>,
    /// Keep the newest plan in this file, as `plan --json` writes it
    #[arg(long, value_name = "FILE.json", value_hint = ValueHint::FilePath)]
    pub plan: Option<PathBuf>,
    /// Print one JSON document per moment, a line each
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(
    mut_arg("planner", |arg| arg.help("Only this planner, beside the baselines")),
    mut_arg("search", |arg| arg.help("Only this search")),
    mut_arg("panels", |arg| arg.hide(true)),
    mut_arg("rrd", |arg| arg.help(
        "Write one Rerun recording per scenario, with every motion in it: a file ending in .rrd, \
         or a folder"
    )),
    mut_arg("figure", |arg| arg.value_name("FILE").help(
        "Draw trajectories, distances, in a sweep cost over risk, else cost over planning time where \
         a thorough search found several answers: a file ending in .svg, .png or .pdf"
    )),
)]
pub struct CompareArgs {
    /// Scenario files, files of other formats, or folders of them; - is standard input
    #[arg(required = true, value_name = "SCENARIO")]
    pub paths: Vec<PathBuf>,
    #[command(flatten)]
    pub asked: Asked,
    /// Accepted risks instead of the scenario's, each from 0 to below 1; several give a sweep
    #[arg(long, value_name = "R,R,..", value_parser = max_risk, value_delimiter = ',')]
    pub max_risk: Vec<f64>,
    /// Also find, for each plan, a cost that no motion can be below (takes some seconds)
    #[arg(long)]
    pub bound: bool,
    #[command(flatten)]
    pub tables: TableFiles,
    #[command(flatten)]
    pub written: Written,
    #[command(flatten)]
    pub assumed: AssumedArgs,
}

#[derive(Debug, Args)]
pub struct InspectArgs {
    /// A recording
    #[arg(value_name = "FILE.rrd", value_hint = ValueHint::FilePath)]
    pub recording: PathBuf,
    /// Print the plan document in it, as `plan --json` wrote it
    #[arg(long, conflicts_with_all = ["csv", "json"])]
    pub plan: bool,
    /// Print the rows of an entity as CSV: one column per curve, other components as JSON
    #[arg(long, value_name = "ENTITY", conflicts_with = "json")]
    pub csv: Option<String>,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct VerifyArgs {
    /// Plan documents, as `plan --json` and `suite --plans` write them, recordings of plans (.rrd), or
    /// folders of them; - is standard input
    #[arg(required = true, value_name = "PLAN.json")]
    pub plans: Vec<PathBuf>,
    /// Seconds for each document; a check that takes longer counts as not verified
    #[arg(long, value_name = "S", default_value = "10", value_parser = budget)]
    #[arg(allow_negative_numbers = true)]
    pub budget_s: Duration,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct CompletionsArgs {
    /// Name of the shell
    #[arg(value_enum, value_name = "SHELL")]
    pub shell: clap_complete::Shell,
}

#[derive(Debug, Args)]
pub struct SchemaArgs {
    /// A scenario file, a file of thresholds, or the command that prints the document with --json
    #[arg(value_name = "KIND", value_parser = PossibleValuesParser::new(schema_kinds()))]
    pub kind: String,
}

/// Settings that replace those of a scenario.
#[derive(Debug, Args)]
pub struct Asked {
    /// Planner instead of the scenario's
    #[arg(long, value_name = "KIND", value_parser = words(planner_words()))]
    pub planner: Option<&'static dyn Planner>,
    /// Search instead of the scenario's; thorough: with several targets the best of many searches
    #[arg(long, value_name = "KIND", value_parser = words(SearchKind::WORDS))]
    pub search: Option<SearchKind>,
    /// Compliance instead of the scenario's: with hulls alone, ship domains, or domains and rules
    #[arg(long, value_name = "C", value_parser = words(Compliance::WORDS))]
    pub compliance: Option<Compliance>,
    /// Thresholds of rule compliance, without effect on the plan: a published profile, or a TOML
    /// file
    #[arg(long, value_name = "PROFILE|FILE", value_parser = ThresholdsParser)]
    pub thresholds: Option<Arc<Thresholds>>,
}

/// Most charts of a figure of several times.
const MOST_PANELS: usize = 6;

/// A figure.
#[derive(Debug, Args)]
pub struct Drawn {
    /// Draw the chart, and the path-time diagram of a path-time plan: a file ending in .svg, .png
    /// or .pdf, or a folder for SVG
    #[arg(long, value_name = "PATH")]
    pub figure: Option<PathBuf>,
    /// Size of the figure in millimetres, such as 170x120
    #[arg(long, value_name = "WIDTHxHEIGHT", value_parser = size, requires = "figure")]
    #[arg(allow_hyphen_values = true)]
    pub size: Option<[f64; 2]>,
    /// Resolution of a PNG in dots per inch [default: 192]
    #[arg(long, value_name = "N", value_parser = dpi, requires = "figure")]
    #[arg(allow_hyphen_values = true)]
    pub dpi: Option<f64>,
}

impl Drawn {
    /// Options of the figure, with marked times.
    pub fn options(&self, times: &[f64], panels: bool) -> FigureOptions {
        FigureOptions {
            size_mm: self.size,
            dpi: self.dpi,
            times: times.to_vec(),
            panels,
        }
    }

    /// Rejects a resolution without a raster image.
    pub fn refuse_dpi(&self) -> anyhow::Result<()> {
        match (&self.figure, self.dpi) {
            (Some(file), Some(dpi)) if FigureFormat::of(file) != Some(FigureFormat::Png) => {
                anyhow::bail!(
                    "--dpi {dpi}: found the figure {}; allowed: with a file that ends in .png",
                    file.display()
                )
            }
            _ => Ok(()),
        }
    }
}

/// Files of the table.
#[derive(Debug, Args)]
pub struct TableFiles {
    /// Write the rows as CSV: all columns, with all digits and in SI units
    #[arg(long, value_name = "FILE.csv", value_hint = ValueHint::FilePath)]
    pub csv: Option<PathBuf>,
    /// Write the table as Markdown
    #[arg(long, value_name = "FILE.md", value_hint = ValueHint::FilePath)]
    pub md: Option<PathBuf>,
    /// Write the table for LaTeX, with its package booktabs
    #[arg(long, value_name = "FILE.tex", value_hint = ValueHint::FilePath)]
    pub tex: Option<PathBuf>,
}

/// Where results go.
#[derive(Debug, Args)]
pub struct Written {
    /// Write a Rerun recording: a file ending in .rrd, or a folder
    #[arg(long, value_name = "PATH")]
    pub rrd: Option<PathBuf>,
    #[command(flatten)]
    pub drawn: Drawn,
    /// Times in seconds at which the chart marks all ships, instead of round ones
    #[arg(long, value_name = "T,T,..", value_parser = time, value_delimiter = ',')]
    #[arg(requires = "figure", allow_hyphen_values = true)]
    pub times: Vec<f64>,
    /// Draw one chart for each of up to six times: those of --times, or four around the closest
    /// approaches
    #[arg(long, requires = "figure")]
    pub panels: bool,
    /// Write a report for a browser, index.html and its figures, into this folder
    #[arg(long, value_name = "DIR", value_hint = ValueHint::DirPath)]
    pub report: Option<PathBuf>,
    /// Print one JSON document instead of text
    #[arg(long)]
    pub json: bool,
}

/// Options of `plan` and `suite`.
#[derive(Debug, Args)]
pub struct Shared {
    #[command(flatten)]
    pub asked: Asked,
    /// Accepted risk instead of the scenario's: from 0 to below 1
    #[arg(long, value_name = "R", value_parser = max_risk)]
    pub max_risk: Option<f64>,
    /// Exit status 1 also if a plan breaks a rule or was made without the rules
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub written: Written,
}

/// Values that files of other formats do not give.
#[derive(Debug, Args)]
#[command(next_help_heading = "Foreign files (no effect on scenario files)")]
pub struct AssumedArgs {
    /// Half-width of every target's speed, m/s [default: 0.5]
    #[arg(long, value_name = "MPS", value_parser = assumption(Assumption::SpeedSpread))]
    pub speed_spread_mps: Option<f64>,
    /// Half-width of every target's course, degrees [default: 5]
    #[arg(long, value_name = "DEG", value_parser = assumption(Assumption::CourseSpread))]
    pub course_spread_deg: Option<f64>,
    /// Distance kept between the hulls, metres [default: own length]
    #[arg(long, value_name = "M", visible_alias = "margin-m")]
    #[arg(value_parser = assumption(Assumption::SafetyMargin))]
    pub safety_margin_m: Option<f64>,
    /// Length of ships without one, metres [default: 100 if the format has none, else required]
    #[arg(long, value_name = "M", value_parser = assumption(Assumption::Length))]
    pub length_m: Option<f64>,
    /// Beam of ships without one, metres [default: 20 if the format has none, else required]
    #[arg(long, value_name = "M", value_parser = assumption(Assumption::Beam))]
    pub beam_m: Option<f64>,
    /// Speed of an own ship without one, m/s [default: required]
    #[arg(long, value_name = "MPS", value_parser = assumption(Assumption::OwnSpeed))]
    pub own_speed_mps: Option<f64>,
    /// Also import the published variants of Imazu's cases
    #[arg(long)]
    pub variants: bool,
}

impl AssumedArgs {
    /// The assumptions.
    pub fn assumed(&self) -> Assumed {
        let given = [
            (Assumption::SpeedSpread, self.speed_spread_mps),
            (Assumption::CourseSpread, self.course_spread_deg),
            (Assumption::SafetyMargin, self.safety_margin_m),
            (Assumption::Length, self.length_m),
            (Assumption::Beam, self.beam_m),
            (Assumption::OwnSpeed, self.own_speed_mps),
        ];
        let given = given
            .into_iter()
            .filter_map(|(what, value)| Some((what, value?)));
        let assumed = Assumed::default().with_variants(self.variants);
        given.fold(assumed, |assumed, (what, value)| assumed.with(what, value))
    }
}

fn source(word: &str) -> Result<Source, String> {
    Source::parse(word).ok_or_else(|| format!("allowed: {}", Source::ALLOWED))
}

/// Pace of a file; infinite for "max".
fn pace(word: &str) -> Result<f64, String> {
    match word {
        "max" => Ok(f64::INFINITY),
        _ => number(
            word,
            |n| (0.001..=1e6).contains(&n),
            "0.001 to 1000000, or max",
        ),
    }
}

fn every(word: &str) -> Result<f64, String> {
    number(word, |n| (0.1..=3600.0).contains(&n), "0.1 to 3600")
}

/// Seconds of Unix time of a date and a time with its offset from UTC.
fn date(word: &str) -> Result<f64, String> {
    unix_seconds(word).ok_or_else(|| format!("allowed: {DATE_TIME}"))
}

/// Latitude, longitude, course and knots.
fn own_pose(word: &str) -> Result<[f64; 4], String> {
    const ALLOWED: &str = "allowed: four numbers with commas between, latitude -89 to 89, longitude \
                           -180 to 180, course -360 to 360, and 0 to 194 knots";
    let numbers: Vec<f64> = (word.split(','))
        .map(|part| part.trim().parse().map_err(|_| ALLOWED.to_owned()))
        .collect::<Result<_, String>>()?;
    let limits = [
        (-89.0, 89.0),
        (-180.0, 180.0),
        (-360.0, 360.0),
        (0.0, 194.0),
    ];
    match <[f64; 4]>::try_from(numbers) {
        Ok(numbers)
            if numbers
                .iter()
                .zip(limits)
                .all(|(n, (low, high))| (low..=high).contains(n)) =>
        {
            Ok(numbers)
        }
        _ => Err(ALLOWED.to_owned()),
    }
}

fn assumption(what: Assumption) -> impl Fn(&str) -> Result<f64, String> + Clone {
    move |word| number(word, |value| what.allows(value), &what.allowed())
}

/// The number in a word, if it is allowed.
fn number(word: &str, allows: impl Fn(f64) -> bool, allowed: &str) -> Result<f64, String> {
    match word.parse() {
        // +0.0 turns a negative zero into zero
        Ok(value) if allows(value) => Ok(value + 0.0),
        _ => Err(format!("allowed: {allowed}")),
    }
}

impl Asked {
    /// Replaces settings of the scenario; fails where the planner cannot use them.
    pub fn apply(&self, scenario: &mut Scenario) -> Result<(), Vec<Fault>> {
        if let Some(planner) = self.planner {
            scenario.set_planner(planner);
        }
        scenario.search = self.search.unwrap_or(scenario.search);
        self.apply_rules(scenario);
        let faults = scenario.unfit();
        match faults.is_empty() {
            true => Ok(()),
            false => Err(faults),
        }
    }

    /// Replaces compliance and thresholds.
    pub fn apply_rules(&self, scenario: &mut Scenario) {
        if let Some(compliance) = self.compliance {
            scenario.compliance = compliance;
        }
        if let Some(thresholds) = &self.thresholds {
            let mut thresholds = Thresholds::clone(thresholds);
            // a property of the scene
            thresholds.sectors.in_sight = scenario.limits.sectors.in_sight;
            scenario.thresholds = Some(Arc::new(thresholds));
        }
    }
}

impl Written {
    /// The files to be written.
    pub fn wanted(&self) -> anyhow::Result<Wanted<'_>> {
        self.drawn.refuse_dpi()?;
        if self.panels && self.times.len() > MOST_PANELS {
            anyhow::bail!(
                "--panels: found {} times; allowed: at most {MOST_PANELS}",
                self.times.len()
            );
        }
        Ok(Wanted {
            recordings: self.rrd.as_deref(),
            figures: self.drawn.figure.as_deref(),
            drawn: self.drawn.options(&self.times, self.panels),
            plans: None,
            report: self.report.as_deref(),
            files: { self.json.then_some(("--json", Path::new(STDOUT))) }
                .into_iter()
                .collect(),
            read: Vec::new(),
        })
    }
}

impl Shared {
    /// Exit status of a run and its document: with `--strict`, a plan that breaks rules or gives
    /// them up is none.
    pub fn status(&self, run: &Run, plan: &PlanDocument) -> ExitStatus {
        let broken = breaks(&plan.encounters).is_some_and(|broken| !broken.is_empty());
        let strict = if self.strict && (broken || run.gives_up_rules()) {
            ExitStatus::NoPlan
        } else {
            ExitStatus::Good
        };
        let is_fault = plan.trajectory.is_some() && !plan.verified;
        let fault = is_fault.then_some(ExitStatus::InternalFault);
        strict
            .max(ExitStatus::of(run))
            .max(fault.unwrap_or_default())
    }

    /// Replaces settings of the scenario; fails where the planner cannot use them.
    pub fn apply(&self, scenario: &mut Scenario) -> Result<(), Vec<Fault>> {
        scenario.max_risk = self.max_risk.unwrap_or(scenario.max_risk);
        self.asked.apply(scenario)
    }
}

fn point(text: &str) -> Result<[f64; 3], String> {
    rows::option(text, &rows::POINT)
}

fn velocity(text: &str) -> Result<[f64; 2], String> {
    rows::option(text, &rows::VELOCITY)
}

fn time(text: &str) -> Result<f64, String> {
    let allowed = "seconds from 0 to 1000000";
    number(text, |time| (0.0..=1e6).contains(&time), allowed)
}

/// One of these words, which the help lists and shells complete.
fn words<T: Copy + Send + Sync + 'static>(
    words: impl AsRef<[(&'static str, T)]>,
) -> impl TypedValueParser<Value = T> {
    let words = words.as_ref().to_vec();
    let known = PossibleValuesParser::new(words.iter().map(|(word, _)| *word));
    known.try_map(move |found| {
        let value = words.iter().find(|(word, _)| *word == found);
        value.map(|(_, value)| *value).ok_or("not a known word")
    })
}

/// The name of published thresholds, which shells complete, or a file.
#[derive(Debug, Clone)]
struct ThresholdsParser;

impl TypedValueParser for ThresholdsParser {
    type Value = Arc<Thresholds>;

    fn parse_ref(
        &self,
        command: &clap::Command,
        arg: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Self::Value, clap::Error> {
        thresholds.parse_ref(command, arg, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        let names = Thresholds::all().iter();
        Some(Box::new(names.map(|t| PossibleValue::new(&*t.name))))
    }
}

/// Published thresholds by name, before a file of that name; `./NAME` is the file.
fn thresholds(word: &str) -> Result<Arc<Thresholds>, String> {
    if let Some(published) = Thresholds::named(word) {
        return Ok(Arc::new(published.clone()));
    }
    let file = Path::new(word);
    if !file.exists() {
        let names: Vec<&str> = Thresholds::all().iter().map(|t| &*t.name).collect();
        return Err(format!(
            "allowed: {}, or a file that is there",
            names.join(", ")
        ));
    }
    read_thresholds(file)
        .map(Arc::new)
        .map_err(|error| printable_lines(&error.to_string()).into_owned())
}

fn budget(word: &str) -> Result<Duration, String> {
    let seconds = word.parse().ok().filter(|s| *s > 0.0);
    let budget = seconds.and_then(|s| Duration::try_from_secs_f64(s).ok());
    budget.ok_or_else(|| "allowed: a positive number of seconds".to_owned())
}

/// Millimetres of width and height.
fn size(word: &str) -> Result<[f64; 2], String> {
    const ALLOWED: &str = "WIDTHxHEIGHT in millimetres, each from 20 to 2000, such as 170x120";
    let side = |word| number(word, |mm| (20.0..=2000.0).contains(&mm), ALLOWED);
    let (width, height) = word.split_once('x').ok_or(format!("allowed: {ALLOWED}"))?;
    Ok([side(width)?, side(height)?])
}

fn dpi(word: &str) -> Result<f64, String> {
    let allowed = "dots per inch from 30 to 2400";
    number(word, |dpi| (30.0..=2400.0).contains(&dpi), allowed)
}

fn duration(word: &str) -> Result<f64, String> {
    let allowed = "seconds from 0.001 to 1000000";
    number(word, |s| (1e-3..=1e6).contains(&s), allowed)
}

fn max_risk(word: &str) -> Result<f64, String> {
    number(
        word,
        Scenario::allows_max_risk,
        &Scenario::max_risk_allowed(),
    )
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn every_command_has_an_example_that_it_accepts() {
        for command in Arguments::command().get_subcommands() {
            let help = command.get_after_help().map(ToString::to_string);
            let help = help.unwrap_or_default();
            let example = help.strip_prefix("Example:\n  ").expect("an example");
            assert!(example.contains(&format!("searoom {}", command.get_name())));
            for part in example.split(['|', '>']).filter(|p| p.contains("searoom ")) {
                let parsed = Arguments::try_parse_from(part.split_whitespace());
                assert!(parsed.is_ok(), "{part}");
            }
        }
    }
}
