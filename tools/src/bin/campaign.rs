//! Runs a campaign over random scenes, prints its table, and checks its bounds.
//!
//! ```text
//! cargo campaign encounters --count 10000 --seed 0
//! ```
//!
//! The exit status is 1 if a bound is missed. Scenes have the seeds `--seed`, `--seed` + 1, ….

#[path = "../../../tests/campaigns/mod.rs"]
mod campaigns;

use std::panic::catch_unwind;
use std::path::PathBuf;
use std::process::ExitCode;

use campaigns::closed_loop::{replanning, simulation};
use campaigns::encounter_generator::Meeting;
use campaigns::plans::{
    asked, compliance, encounters, harbour, invariance, mutations, relations, several,
    short_missions, tidiness,
};
use campaigns::{Report, dense_search, forces, path_time, stopping, wild};
use clap::{Args, Parser, Subcommand};
use searoom::scenario::Compliance;

#[derive(Parser)]
#[command(about = "Runs a campaign over random scenes, prints its table, and checks its bounds")]
struct Options {
    #[command(subcommand)]
    campaign: Campaign,
    /// Changes a setting of the space-time planner, as in `--set conflicts.lead_s=200`: an ablation. Values
    /// are not checked beyond their type, and some, such as a zero interval, do not end
    #[arg(long, global = true, value_name = "GROUP.NAME=VALUE")]
    set: Vec<String>,
}

#[derive(Subcommand)]
enum Campaign {
    /// Encounters with one target, a fifth of each kind
    Encounters {
        #[command(flatten)]
        scenes: Scenes<10_000>,
        /// Turns and changes of speed at every level of compliance, with and without tidiness
        #[arg(long)]
        tidiness: bool,
    },
    /// Scenes with 2, 4 and 10 targets, a third of each
    Traffic(Scenes<3_000>),
    /// Costs against a dense search over east, north, heading and time
    DenseSearch {
        #[command(flatten)]
        scenes: Scenes<200>,
        /// Targets; with more than one, A* and the thorough search
        #[arg(long, default_value_t = 1)]
        targets: usize,
    },
    /// Plans that keep to the rules, a fifth of each kind of encounter
    Compliance {
        #[command(flatten)]
        scenes: Scenes<15_000>,
        /// Encounters that begin 300 to 900 s before the closest approach, not 100 to 220 s
        #[arg(long)]
        far: bool,
        /// CSV file with a line for each plan, to compare two versions scene by scene
        #[arg(long)]
        rows: Option<PathBuf>,
        /// Folder for the scenes, which another version can plan
        #[arg(long)]
        keep: Option<PathBuf>,
    },
    /// Plans among several targets, and what both judges say
    Several {
        #[command(flatten)]
        scenes: Scenes<200>,
        /// Targets, up to three where they are met one after another
        #[arg(long, default_value_t = 2)]
        targets: usize,
        /// Targets that are met some 400 s one after another on 7 km, not all within 220 s
        #[arg(long)]
        apart: bool,
        /// What own ship plans by: none, shape or rules
        #[arg(long, default_value = "rules", value_parser = compliance_level)]
        compliance: Compliance,
        /// CSV file with a line for each plan, to compare two versions scene by scene
        #[arg(long)]
        rows: Option<PathBuf>,
        /// Folder for the scenes, which another version can plan
        #[arg(long)]
        keep: Option<PathBuf>,
    },
    /// Encounters planned again and again, a fifth of each kind; the sailed motion is judged
    Replanning {
        #[command(flatten)]
        scenes: Scenes<1_000>,
        /// Encounters that begin 300 to 900 s before the closest approach, not 100 to 220 s
        #[arg(long)]
        far: bool,
        /// Motion of the targets
        #[arg(long, value_enum, default_value = "constant")]
        targets: replanning::Behaviour,
        /// Own ship is up to this far off its plan when the next is made: its tracking margin,
        /// metres
        #[arg(long, default_value_t = 0.0)]
        off: f64,
        /// The targets are measured anywhere within three standard deviations of their positions
        #[arg(long)]
        noise: bool,
        /// Every plan begins anew
        #[arg(long)]
        no_memory: bool,
    },
    /// Random meetings sailed in the closed loop, a fifth of each kind; what was sailed is judged
    Simulation {
        #[command(flatten)]
        scenes: Scenes<1_000>,
        /// Meetings that begin 300 to 900 s before the closest approach, not 100 to 220 s
        #[arg(long)]
        far: bool,
        /// Motion of the targets
        #[arg(long, value_enum, default_value = "constant")]
        behaviour: simulation::Truth,
        /// Random and extreme targets exceed their spreads by this factor
        #[arg(long, default_value_t = 1.0)]
        factor: f64,
        /// Own ship's sensor
        #[arg(long, value_enum, default_value = "exact")]
        seen: simulation::Seen,
        /// How own ship moves
        #[arg(long, value_enum, default_value = "kinematic")]
        ship: simulation::Ship,
        /// Own ship sails its first plan to the end
        #[arg(long)]
        once: bool,
        /// Degrees: how much farther to starboard each target may steer, as own ship assumes
        #[arg(long, default_value_t = 0.0)]
        starboard_turn: f64,
        /// What own ship plans by: none, shape or rules
        #[arg(long, default_value = "rules", value_parser = compliance_level)]
        compliance: Compliance,
        /// Seconds of reports before the meeting begins
        #[arg(long, default_value_t = 60.0)]
        settle: f64,
        /// Root of the spectral density of the acceleration that the tracker assumes, m/s^1.5
        #[arg(long, default_value_t = 0.02)]
        acceleration: f64,
    },
    /// Traffic among land, a third of the scenes in each of three waters
    Harbour {
        #[command(flatten)]
        scenes: Scenes<300>,
        /// Sail them in the closed loop, half of them under the rules
        #[arg(long)]
        sail: bool,
    },
    /// The path-time planner against a fine grid: least time, error, ellipsoids and alternatives
    PathTime(Scenes<7_000>),
    /// Scenes that stopping solves: a plan is unsafe only where that along the path is
    Stopping(Scenes<3_000>),
    /// The optimal-control planner on random scenes and from random starts
    Control {
        /// Number of scenes, half of them with three ellipsoids, half with six
        #[arg(long, default_value_t = 400)]
        count: usize,
        /// Random starts of each shipped scenario
        #[arg(long, default_value_t = 40)]
        starts: usize,
    },
    /// Requests and stricter ones: domains, rules, ellipses, risk, margin
    Asked(Scenes<200>),
    /// Scenes moved, turned, mirrored and scaled
    Invariance(Scenes<300>),
    /// Changes whose effect on the cost is known: horizon, speeds, margin, a far ship, waypoints, legs
    Relations(Scenes<100>),
    /// Missions that end near the meeting against longer ones
    ShortMissions {
        #[command(flatten)]
        scenes: Scenes<60>,
        /// Folder for the scenes
        #[arg(long)]
        keep: Option<PathBuf>,
    },
    /// Numbers of plan documents altered, each alone
    Mutations {
        /// Numbers altered in each document; all of them if not given
        #[arg(long, default_value_t = usize::MAX)]
        numbers: usize,
    },
    /// Scenes of every planner and setting, from text to verification
    Wild {
        #[command(flatten)]
        scenes: Scenes<10_000>,
        /// Only this planner
        #[arg(long, value_parser = wild::PLANNERS)]
        planner: Option<String>,
        /// Folder for the scenes with a fault
        #[arg(long)]
        keep: Option<PathBuf>,
    },
}

#[derive(Args)]
struct Scenes<const COUNT: u64> {
    /// Number of scenes, otherwise that of the campaign. No default of clap's: it would be one for all
    /// campaigns (findings/clap-default-of-a-generic.sh)
    #[arg(long)]
    count: Option<u64>,
    /// Seed of the first scene
    #[arg(long, default_value_t = 0)]
    seed: u64,
}

impl<const COUNT: u64> Scenes<COUNT> {
    fn count(&self) -> u64 {
        self.count.unwrap_or(COUNT)
    }

    /// Seeds where every scene occurs in `kinds` kinds.
    fn of_each(&self, kinds: u64) -> campaigns::Seeds {
        self.seed..self.seed + self.count().div_ceil(kinds)
    }
}

fn compliance_level(word: &str) -> Result<Compliance, &'static str> {
    let found = Compliance::WORDS.iter().find(|(name, _)| *name == word);
    found
        .map(|(_, level)| *level)
        .ok_or("allowed: none, shape, rules")
}

fn run(campaign: Campaign) -> Report {
    match campaign {
        Campaign::Encounters { scenes, tidiness } => match tidiness {
            true => tidiness::run(scenes.of_each(5)),
            false => encounters::run(scenes.of_each(5)),
        },
        Campaign::Traffic(scenes) => encounters::run_among_many(scenes.of_each(3)),
        Campaign::DenseSearch { scenes, targets: 1 } => dense_search::run(scenes.of_each(5)),
        Campaign::DenseSearch { scenes, targets } => {
            dense_search::run_among(targets, scenes.of_each(1))
        }
        Campaign::Compliance {
            scenes,
            far,
            rows,
            keep,
        } => {
            let meeting = if far { Meeting::FAR } else { Meeting::NEAR };
            compliance::run(
                scenes.of_each(5),
                &meeting,
                rows.as_deref(),
                keep.as_deref(),
            )
        }
        Campaign::Several {
            scenes,
            targets,
            apart,
            compliance,
            rows,
            keep,
        } => {
            let which = several::Which {
                targets,
                apart,
                compliance,
            };
            several::run(scenes.of_each(1), &which, rows.as_deref(), keep.as_deref())
        }
        Campaign::Replanning {
            scenes,
            far,
            targets,
            off,
            noise,
            no_memory,
        } => {
            let meeting = if far { Meeting::FAR } else { Meeting::NEAR };
            let how = replanning::How {
                behaviour: targets,
                off,
                noise,
                memory: !no_memory,
            };
            replanning::run(scenes.of_each(5), &meeting, &how)
        }
        Campaign::Simulation {
            scenes,
            far,
            behaviour,
            factor,
            seen,
            ship,
            once,
            starboard_turn,
            compliance,
            settle,
            acceleration,
        } => {
            let meeting = if far { Meeting::FAR } else { Meeting::NEAR };
            let how = simulation::How {
                truth: behaviour,
                factor,
                seen,
                ship,
                replan: !once,
                starboard_turn,
                compliance,
                settle,
                acceleration,
            };
            simulation::run(scenes.of_each(5), &meeting, &how)
        }
        Campaign::Harbour { scenes, sail: true } => harbour::sail_all(scenes.of_each(2)),
        Campaign::Harbour { scenes, .. } => harbour::run(scenes.of_each(3)),
        Campaign::PathTime(scenes) => path_time::run(scenes.of_each(1)),
        Campaign::Stopping(scenes) => stopping::run(scenes.of_each(3)),
        Campaign::Control { count, starts } => {
            let mut report = forces::run_scenes(count.div_ceil(2));
            report.missed.extend(forces::run_starts(starts).missed);
            report
        }
        Campaign::Asked(scenes) => asked::run(scenes.of_each(1)),
        Campaign::Invariance(scenes) => invariance::run(scenes.of_each(1)),
        Campaign::Relations(scenes) => relations::run(scenes.of_each(1)),
        Campaign::ShortMissions { scenes, keep } => {
            short_missions::run(scenes.of_each(1), keep.as_deref())
        }
        Campaign::Mutations { numbers } => mutations::run(numbers),
        Campaign::Wild {
            scenes,
            planner,
            keep,
        } => wild::run(
            scenes.seed,
            scenes.count(),
            planner.as_deref(),
            keep.as_deref(),
        ),
    }
}

fn main() -> ExitCode {
    let Options { campaign, set } = Options::parse();
    let is_used = !matches!(
        campaign,
        Campaign::PathTime(_)
            | Campaign::Control { .. }
            | Campaign::Mutations { .. }
            | Campaign::Wild { .. }
    );
    let done = match set.is_empty() || is_used {
        true => campaigns::ablation::set(&set),
        false => Err("--set: not for campaigns of other planners and of scenario files".to_owned()),
    };
    if let Err(error) = done {
        eprintln!("{error}");
        return ExitCode::from(2);
    }
    set.iter().for_each(|change| println!("with {change}"));
    // a wrong plan may panic with its seed
    let Ok(report) = catch_unwind(|| run(campaign)) else {
        return ExitCode::FAILURE;
    };
    for missed in &report.missed {
        eprintln!("missed: {missed}");
    }
    ExitCode::from(u8::from(!report.missed.is_empty()))
}
