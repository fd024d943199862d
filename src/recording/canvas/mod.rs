//! Data that all views of a recording share: the scenario with its sets, the times and the part of
//! the sea that are shown, colours.

mod closed_loop;
mod labels;
mod lines;
mod motion;
pub mod style;
mod view_model;

pub use closed_loop::{AssumedTarget, ClosedLoop};
#[cfg(test)]
pub use labels::covered;
pub use labels::{Labels, leader_style};
pub use lines::{Lines, Strip, labelled, lines, points, strip_columns};
pub use motion::{ShownMotion, desired_leg};
pub use view_model::ViewModel;

use rerun::{Color, TimeColumn};

use super::TIMELINE;
use crate::frame::Vector;
use crate::geometry::Window;
use crate::obstacle::Obstacle;
use crate::pipeline::TargetSets;
use crate::scenario::{Compliance, Scenario};
use crate::target::Target;

/// Least time between two rows of what moves, seconds.
const CURSOR_STEP_S: f64 = 2.0;

/// Plots of distances end at this many safety margins, or beyond the least distance.
const NEAR: f64 = 5.0;

/// Seconds by which an arrival on schedule may differ from its time.
const ROUNDING_S: f64 = 1e-6;
const CURSOR_TIMES: f64 = 120.0;
const CURVE_SAMPLES: f64 = 400.0;

/// Things that colours distinguish.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Palette {
    /// Own ship is white.
    Targets,
    /// Targets are grey.
    OwnShips,
}

/// A scenario and its sets, prepared for drawing whatever own ship does.
#[derive(Debug)]
pub struct Canvas<'a> {
    pub scenario: &'a Scenario,
    pub sets: Vec<&'a TargetSets>,
    /// Seconds: nothing is shown after that.
    pub end: f64,
    /// Seconds: the times at which something moves.
    pub cursor_times: Vec<f64>,
    /// Seconds: the times at which curves are sampled.
    pub samples: Vec<f64>,
    pub bounds: Window,
    /// Width and height in pixels of the chart in a window of 1280 × 800.
    pub pane: [f64; 2],
    /// Metres of height per second in the space-time volume.
    pub metres_per_second: f64,
    pub palette: Palette,
}

impl<'a> Canvas<'a> {
    /// All of `motions` is within the bounds.
    pub fn new(
        scenario: &'a Scenario,
        sets: impl IntoIterator<Item = &'a TargetSets>,
        motions: &[ShownMotion],
        end: f64,
        (palette, pane): (Palette, [f64; 2]),
    ) -> Self {
        let cursor_times = cursor_times(end, CURSOR_TIMES);
        let samples = steps(end, (end / CURVE_SAMPLES).ceil().max(1.0));
        let bounds = bounds(scenario, motions, &cursor_times);
        Self {
            scenario,
            sets: sets.into_iter().collect(),
            end,
            cursor_times,
            samples,
            bounds,
            pane,
            metres_per_second: one_digit(0.65 * bounds.size().max() / end),
            palette,
        }
    }

    pub fn target_color(&self, index: usize) -> Color {
        match self.palette {
            Palette::Targets => style::target(index),
            Palette::OwnShips => style::grey_target(index),
        }
    }

    /// The set with the ship domain, where it is shown beside the hard one.
    pub fn with_domain<'s>(&self, sets: &'s TargetSets) -> Option<&'s Obstacle> {
        let is_used = self.scenario.compliance != Compliance::None;
        (is_used && sets.with_domain != sets.hard).then_some(&sets.with_domain)
    }

    /// The unit vector from the first waypoint to the last; own ship's first heading on a round
    /// trip.
    pub fn ahead(&self) -> Vector {
        let desired = &self.scenario.desired;
        let start = desired.legs()[0].start;
        (desired.end() - start)
            .try_normalize(0.0)
            .unwrap_or_else(|| self.scenario.own_ship.pose.ahead())
    }

    pub fn cursor_column(&self) -> TimeColumn {
        TimeColumn::new_duration_secs(TIMELINE, self.cursor_times.iter().copied())
    }

    /// Start and end of a target's expected track, and the times between at which it bends, seconds.
    pub fn joints(&self, target: &Target) -> Vec<f64> {
        let changes = target.changes().into_iter();
        let between = changes.take_while(|time| *time < self.end);
        std::iter::once(0.0)
            .chain(between)
            .chain([self.end])
            .collect()
    }

    /// The part of the sea that the chart shows in a window of 1280 × 800.
    pub fn view(&self) -> Window {
        let half = Vector::from(self.pane) * (0.5 * self.pixel());
        let middle = self.bounds.center();
        Window::new(middle - half, middle + half)
    }

    /// Metres of a pixel in that window.
    pub fn pixel(&self) -> f64 {
        let size = self.bounds.size();
        (size.x / self.pane[0]).max(size.y / self.pane[1])
    }

    /// The distances that matter beside the least one: from 0 to a round number of metres.
    pub fn near(&self, least: f64) -> [f64; 2] {
        let own = &self.scenario.own_ship;
        let near = [NEAR * own.safety_margin, 2.0 * own.hull.length, 2.0 * least];
        let near = near.into_iter().filter(|metres| metres.is_finite());
        let near = near.fold(0.0, f64::max);
        let step = 10f64.powf(near.log10().floor() - 1.0);
        [least.min(0.0), (near / step).ceil() * step]
    }

    /// The point of the space-time volume, metres.
    pub fn lifted(&self, position: Vector, time: f64) -> [f32; 3] {
        let [east, north] = flat(position);
        [east, north, (time * self.metres_per_second) as f32]
    }
}

/// The point of the chart, metres.
pub fn flat(position: Vector) -> [f32; 2] {
    [position.x as f32, position.y as f32]
}

/// The largest of 1, 2, 5 times a power of ten that is not larger than `value`.
pub fn round_down(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    let lead = value / power;
    let rounded = if lead >= 5.0 {
        5.0
    } else if lead >= 2.0 {
        2.0
    } else {
        1.0
    };
    rounded * power
}

/// Round times, seconds.
const ROUND_S: [f64; 12] = [
    1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1200.0, 3600.0,
];

/// The largest round number of seconds or minutes that is not larger than `seconds`.
pub fn round_down_time(seconds: f64) -> f64 {
    let fits = ROUND_S.into_iter().rev().find(|step| *step <= seconds);
    fits.unwrap_or_else(|| round_down(seconds))
}

fn one_digit(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    (value / power).round() * power
}

/// The times of what moves, `most` and two at most.
fn cursor_times(end: f64, most: f64) -> Vec<f64> {
    steps(end, (end / most).ceil().max(CURSOR_STEP_S))
}

/// 0, every `step`, and `end`; no step is at the end but for rounding.
fn steps(end: f64, step: f64) -> Vec<f64> {
    let count = ((end - ROUNDING_S) / step).ceil() as usize;
    let mut times: Vec<f64> = (0..count).map(|i| step * i as f64).collect();
    times.push(end);
    times
}

/// The desired trajectory, the motions, and every target while it is near one of them.
fn bounds(scenario: &Scenario, motions: &[ShownMotion], times: &[f64]) -> Window {
    let desired = &scenario.desired;
    let near = 0.6 * desired.length();
    let mut points = desired.waypoints();
    points.push(scenario.own_ship.pose.position);
    for &time in times {
        for motion in motions {
            let own = motion.pose_at(time).position;
            points.push(own);
            let targets = scenario.targets.iter().map(|t| t.position_at(time));
            points.extend(targets.filter(|p| (p - own).norm() < near));
        }
    }
    with_sea(&points)
}

/// The box around points, with sea on all sides.
fn with_sea(points: &[Vector]) -> Window {
    let tight = Window::around(points).unwrap_or_else(|| Window::at(Vector::zeros()));
    let bounds = tight.grown(0.06 * tight.size().max());
    // a straight run is a line: leave sea on both sides of it
    let short = 0.45 * bounds.size().max();
    let missing = bounds.size().map(|side| (short - side).max(0.0) / 2.0);
    Window::new(bounds.low - missing, bounds.high + missing)
}
