//! Curves over time: clearance, margin, risk, speed, course; for a plan of forces also velocities
//! and forces.

use std::collections::BTreeSet;

use rerun::components::AggregationPolicy;
use rerun::components::InterpolationMode::{self, Linear, StepAfter};
use rerun::{Color, EntityPath, Scalars, SeriesLines, TimeColumn};

use crate::frame::{clockwise_deg_per_s, course_deg_from_heading, heading_of, knots_from_mps};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::recording::canvas::style::{self, SpeedClass};
use crate::recording::canvas::{Canvas, ShownMotion, ViewModel, desired_leg};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, TIMELINE, path};
use crate::target::Target;
use crate::tolerance;
use crate::trajectory::{ForceNode, Steered};

pub const CLEARANCE: &str = "curves/clearance_m";
pub const MARGIN: &str = "curves/margin_m";
pub const RISK: &str = "curves/risk";
pub const SPEED: &str = "curves/speed_kn";
/// Course from 0 to 360, with a row without values where it passes north.
pub const COURSE: &str = "curves/course_deg";
pub const STATES: &str = "curves/states";
/// Surge force, sway force and yaw moment, held from node to node.
pub const FORCES: &str = "curves/forces";

/// A plot: what is logged, and its panel in the viewer.
pub struct Plot {
    /// `None` has no panel.
    pub title: Option<String>,
    pub entity: &'static str,
    /// Values that the panel shows; all of them without.
    pub range: Option<[f64; 2]>,
    pub times: Vec<f64>,
    pub between: InterpolationMode,
    /// Nothing is logged without.
    pub series: Vec<Series>,
    /// Rows before which the lines are interrupted.
    pub breaks: BTreeSet<usize>,
    /// True where every curve has an entity of its own below that of the plot.
    pub apart: bool,
}

impl Plot {
    /// A panel with lines from sample to sample.
    pub fn new(
        title: impl Into<String>,
        entity: &'static str,
        times: &[f64],
        series: Vec<Series>,
    ) -> Self {
        Self {
            title: Some(title.into()),
            entity,
            range: None,
            times: times.to_vec(),
            between: Linear,
            series,
            breaks: BTreeSet::new(),
            apart: false,
        }
    }

    /// The panel of speeds, knots.
    pub fn of_speeds(times: &[f64], series: Vec<Series>) -> Self {
        Self {
            between: StepAfter,
            ..Self::new("Speed (kn)", SPEED, times, series)
        }
    }
}

/// The plots of a run: two of distances, then the others.
pub fn plots(model: &ViewModel) -> Vec<Plot> {
    let least = |curves: &[Series]| {
        let values = curves.iter().flat_map(|curve| &curve.values);
        values.copied().fold(f64::INFINITY, f64::min)
    };
    let clearances = clearance_curves(model);
    let clearance = least(&clearances[..clearances.len() - 1]);
    let mut margins = margin_curves(model);
    let margin = least(&margins);
    if model.sets.is_empty() {
        margins.clear();
    }
    let [_, top] = model.near(clearance);
    let distances = |what: &str, entity, curves, least: f64| {
        let title = format!("{what} up to {top} m");
        Plot {
            range: Some([least.min(0.0).max(-top), top]),
            ..Plot::new(title, entity, &model.samples, curves)
        }
    };
    let courses = course_curves(model);
    let times = risk_times(model);
    let risks = risk_curves(model, &times);
    let of_targets = risks[..risks.len() - 1].iter();
    let has_risk = of_targets.flat_map(|curve| &curve.values).any(|r| *r > 0.0);
    let mut plots = vec![
        distances("Hull clearance", CLEARANCE, clearances, clearance),
        distances("Set margin", MARGIN, margins, margin),
        speed_plot(model),
        Plot {
            breaks: jumps(&courses),
            ..Plot::new("Course (deg)", COURSE, &model.samples, courses)
        },
        Plot {
            title: has_risk.then(|| "Risk".to_owned()),
            ..Plot::new("", RISK, &times, risks)
        },
    ];
    if let ShownMotion::Planned(trajectory) = model.motion {
        plots.extend(trajectory.steered().into_iter().flat_map(force_plots));
    }
    plots
}

pub struct Series {
    pub name: String,
    color: Color,
    width: f32,
    /// One per time.
    pub values: Vec<f64>,
}

impl Series {
    pub fn new(name: impl Into<String>, color: Color, width: f32, values: Vec<f64>) -> Self {
        let name = name.into();
        Self {
            name,
            color,
            width,
            values,
        }
    }
}

pub fn log_plots(rec: &mut Recorder, plots: &[Plot]) -> Logged {
    for plot in plots {
        if !plot.apart {
            log_curves(rec, path(&[plot.entity]), plot, &plot.series)?;
            continue;
        }
        for curve in &plot.series {
            let entity = path(&[plot.entity, &curve.name]);
            log_curves(rec, entity, plot, std::slice::from_ref(curve))?;
        }
    }
    Ok(())
}

/// Logs curves of a plot as one entity. Every row has a number for each of them, so they end with
/// the shortest.
fn log_curves(rec: &mut Recorder, entity: EntityPath, plot: &Plot, series: &[Series]) -> Logged {
    let Some(rows) = series.iter().map(|s| s.values.len()).min() else {
        return Ok(());
    };
    let mut times = plot.times[..rows.min(plot.times.len())].to_vec();
    let style = SeriesLines::new()
        .with_names(series.iter().map(|s| s.name.as_str()))
        .with_colors(series.iter().map(|s| s.color))
        .with_widths(series.iter().map(|s| s.width))
        .with_interpolation_mode(plot.between)
        // averaging neighbours would show speeds and depths that are not there
        .with_aggregation_policy(AggregationPolicy::Off);
    let values = (0..times.len()).flat_map(|row| series.iter().map(move |s| s.values[row]));
    let columns = Scalars::update_fields().with_scalars(values);
    let mut lengths = vec![series.len(); times.len()];
    // a row without values interrupts the lines
    for row in plot.breaks.range(..times.len()).rev() {
        times.insert(*row, 0.5 * (times[*row - 1] + times[*row]));
        lengths.insert(*row, 0);
    }
    let times = TimeColumn::new_duration_secs(TIMELINE, times);
    rec.log_moving(entity, times, &style, columns.columns(lengths)?)
}

fn clearance_curves(model: &ViewModel) -> Vec<Series> {
    let targets = model.scenario.targets.iter().enumerate();
    let curve = |(index, target): (usize, &Target)| {
        let values = clearances(model, &model.motion, target);
        Series::new(&target.name, style::target(index), 2.0, values)
    };
    let mut series: Vec<Series> = targets.map(curve).collect();
    series.push(safety_margin(model));
    series
}

/// The required distance between the hulls, at every sample.
pub fn safety_margin(canvas: &Canvas) -> Series {
    let margin = canvas.scenario.own_ship.safety_margin;
    let values = vec![margin; canvas.samples.len()];
    Series::new("safety margin", style::ALARM, 1.0, values)
}

/// Metres between own ship and the target's expected hull or set, at every sample until arrival;
/// see [`Target::distance_from`].
pub fn clearances(canvas: &Canvas, motion: &ShownMotion, target: &Target) -> Vec<f64> {
    let own = &canvas.scenario.own_ship.hull;
    let times = motion.until_arrival(&canvas.samples).iter();
    let distance = |&time: &f64| target.distance_from(own, &motion.pose_at(time), time);
    times.map(distance).collect()
}

/// Margins to the hard sets, to those with ship domains, and to those that were planned against
/// where they are neither.
pub fn margin_curves(model: &ViewModel) -> Vec<Series> {
    let sets = &model.sets;
    let hard: Vec<&Obstacle> = sets.iter().map(|s| &s.hard).collect();
    let with_domain: Vec<&Obstacle> = (sets.iter())
        .map(|s| model.with_domain(s).unwrap_or(&s.hard))
        .collect();
    let curve = |name: &str, color: Color, sets: &[&Obstacle]| {
        Series::new(name, color, 2.0, margins(model, sets))
    };
    let mut series = vec![curve("hard sets", style::OWN_SHIP, &hard)];
    if hard != with_domain {
        let color = SpeedClass::Slow.color();
        series.push(curve("with domains", color, &with_domain));
    }
    // level sets of an accepted risk, or ellipsoids around the others
    let avoided: Vec<&Obstacle> = model.run.obstacles().collect();
    if avoided != hard && avoided != with_domain {
        let color = SpeedClass::Fast.color();
        series.push(curve("sets kept out of", color, &avoided));
    }
    let contact = vec![0.0; model.samples.len()];
    series.push(Series::new("contact", style::ALARM, 1.0, contact));
    series
}

/// Metres from own ship's centre to the nearest of the sets, at every sample until arrival;
/// negative inside.
pub fn margins(model: &ViewModel, sets: &[&Obstacle]) -> Vec<f64> {
    let at = |&time: &f64| {
        let own = model.motion.pose_at(time).position;
        let margins = sets.iter().map(|s| s.signed_distance(own, time).distance);
        margins.fold(f64::INFINITY, f64::min)
    };
    let times = model.motion.until_arrival(&model.samples);
    times.iter().map(at).collect()
}

/// The risks against the sets that were planned against, as the plan document reports them, and
/// those against the hard sets where these differ.
pub fn risk_curves(model: &ViewModel, times: &[f64]) -> Vec<Series> {
    let mut series = Vec::new();
    for (index, target) in model.run.targets.iter().enumerate() {
        let (avoided, sets) = (&target.whole, &target.sets);
        let name = sets.hard.name();
        let mut curve = |name: String, width: f32, set: &Obstacle| {
            let values = risks(model, set, times);
            series.push(Series::new(name, style::target(index), width, values));
        };
        if *avoided == sets.hard {
            curve(name.to_owned(), 2.0, avoided);
        } else {
            curve(format!("{name}, with domain"), 2.0, avoided);
            curve(format!("{name}, hard set"), 1.0, &sets.hard);
        }
    }
    let accepted = vec![model.run.max_risk; times.len()];
    series.push(Series::new("accepted", style::ALARM, 1.0, accepted));
    series
}

/// The samples and the times of the largest risks, so that the curves reach the reported values.
pub fn risk_times(model: &ViewModel) -> Vec<f64> {
    let mut times = model.samples.clone();
    times.extend(model.run.risks().into_iter().map(|peak| peak.time));
    times.sort_by(f64::total_cmp);
    times.dedup();
    times
}

/// The risk of a set at own ship's centre, at every one of the times until arrival. As in the
/// document, it is 0 where own ship is not deeper in the set than [`tolerance::DEPTH_M`].
fn risks(model: &ViewModel, set: &Obstacle, times: &[f64]) -> Vec<f64> {
    let at = |&time: &f64| {
        let own = model.motion.pose_at(time).position;
        let clear = set.signed_distance(own, time).distance >= -tolerance::DEPTH_M;
        if clear { 0.0 } else { set.risk(own, time) }
    };
    let times = model.motion.until_arrival(times);
    times.iter().map(at).collect()
}

fn speed_plot(model: &ViewModel) -> Plot {
    let wanted = ShownMotion::Nominal(&model.scenario.desired);
    let mut shown = vec![(wanted, "desired", style::DESIRED, 1.0)];
    if model.motion.is_planned() {
        shown.push((model.motion, "own ship", style::OWN_SHIP, 2.0));
    }
    let times = step_times(model, shown.iter().map(|(motion, ..)| motion));
    let curve = |(motion, name, color, width): (ShownMotion, &str, Color, f32)| {
        Series::new(name, color, width, speeds(&motion, &times))
    };
    Plot::of_speeds(&times, shown.into_iter().map(curve).collect())
}

/// Times at which one of the speeds changes or ends, seconds.
pub fn step_times<'a>(
    canvas: &Canvas,
    motions: impl Iterator<Item = &'a ShownMotion<'a>>,
) -> Vec<f64> {
    let mut times: Vec<f64> = motions
        .flat_map(|motion| [motion.speed_changes(), vec![motion.end()]].concat())
        .collect();
    times.retain(|&t| t <= canvas.end);
    times.push(canvas.end);
    times.sort_by(f64::total_cmp);
    times.dedup_by(|later, earlier| *later - *earlier < tolerance::TIME_S);
    times
}

/// Speeds at every one of the times, knots; 0 where the motion has ended and own ship is at rest.
pub fn speeds(motion: &ShownMotion, times: &[f64]) -> Vec<f64> {
    let last = times.last().copied().unwrap_or(0.0);
    let end = motion.end();
    // a motion that lasts as long as the plot keeps its speed
    let lasts = end > last - tolerance::TIME_S;
    let at = |&time: &f64| {
        if lasts || time < end - tolerance::TIME_S {
            knots_from_mps(motion.speed_at(time))
        } else {
            0.0
        }
    };
    times.iter().map(at).collect()
}

fn course_curves(model: &ViewModel) -> Vec<Series> {
    let times = model.samples.iter();
    let desired = &model.scenario.desired;
    let wanted = times.clone().map(|&t| desired_leg(desired, t).direction);
    let wanted = wanted.map(|way| course_deg_from_heading(heading_of(way)));
    let wanted = wanted.collect();
    let mut series = vec![Series::new("desired", style::DESIRED, 1.0, wanted)];
    if model.motion.is_planned() {
        let own = times.map(|&t| course_deg_from_heading(model.motion.pose_at(t).heading));
        let own = own.collect();
        series.push(Series::new("own ship", style::OWN_SHIP, 2.0, own));
    }
    series
}

/// The index after each jump of a curve of courses through north.
fn jumps(series: &[Series]) -> BTreeSet<usize> {
    let jumps = series.iter().flat_map(|curve| {
        let pairs = curve.values.windows(2).enumerate();
        pairs.filter_map(|(k, pair)| ((pair[1] - pair[0]).abs() > 180.0).then_some(k + 1))
    });
    jumps.collect()
}

type Quantity = (&'static str, fn(&ForceNode) -> f64);

const STATE: [Quantity; 3] = [
    ("surge, m/s", |n| n.velocity.x),
    ("sway to starboard, m/s", |n| -n.velocity.y),
    ("yaw rate clockwise, deg/s", |n| {
        clockwise_deg_per_s(n.yaw_rate)
    }),
];

const FORCE: [Quantity; 3] = [
    ("surge, N", |n| n.force.x),
    ("sway to starboard, N", |n| -n.force.y),
    ("yaw clockwise, Nm", |n| -n.moment),
];

fn force_plots(motion: &Steered) -> [Plot; 2] {
    let nodes = motion.nodes();
    let times: Vec<f64> = nodes.iter().map(|n| n.time).collect();
    let plot = |title: &str, entity, quantities: [Quantity; 3]| {
        let quantities = quantities.into_iter().enumerate();
        let series = quantities.map(|(index, (name, value))| {
            let values = nodes.iter().map(value).collect();
            Series::new(name, style::target(index), 2.0, values)
        });
        Plot::new(title, entity, &times, series.collect())
    };
    [
        plot("Velocity (m/s, deg/s)", STATES, STATE),
        Plot {
            between: StepAfter,
            ..plot("Forces (N, Nm)", FORCES, FORCE)
        },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_course_through_north_is_interrupted_there() {
        let values = vec![350.0, 355.0, 0.0, 5.0, 358.0];
        let series = [Series::new("own ship", style::OWN_SHIP, 2.0, values)];
        assert_eq!(jumps(&series), BTreeSet::from([2, 4]));
        let mut rec = Recorder::default();
        let plot = Plot {
            breaks: jumps(&series),
            ..Plot::new("", COURSE, &[0.0, 10.0, 20.0, 30.0, 40.0], series.into())
        };
        log_plots(&mut rec, &[plot]).expect("logs");
        let chunks = rec.into_chunks();
        let moving = chunks
            .iter()
            .find(|chunk| !chunk.is_static())
            .expect("rows");
        let scalars = Scalars::descriptor_scalars().component;
        let rows = moving.components().get_array(scalars).expect("scalars");
        let lengths: Vec<usize> = rows.iter().map(|row| row.map_or(0, |r| r.len())).collect();
        assert_eq!(lengths, [1, 1, 0, 1, 1, 0, 1]);
    }
}
