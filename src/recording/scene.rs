//! What all pictures of a recording share: the stage, which is the scenario with its sets, until when, at which moments, and
//! how much of the sea is seen; and of one run whose motion is shown on it.

use rerun::{Color, TimeColumn};

use super::{TIMELINE, style, thinning};
use crate::colregs::compliance::ComplianceReport;
use crate::frame::{Pose, Vector, heading_of};
use crate::obstacle::Obstacle;
use crate::pipeline::{Run, TargetSets};
use crate::scenario::{Compliance, Scenario};
use crate::tolerance;
use crate::trajectory::{DesiredLeg, DesiredTrajectory, Trajectory};

/// Bytes that everything that moves may take; the step of the cursor follows.
const MOVING_BYTES: f64 = 62e3;

/// Bytes at a moment: a corner of a section, what a row has beside its values, a target with her velocity obstacle, own ship.
const CORNER_BYTES: usize = 8;
const ROW_BYTES: usize = 25;
const TARGET_BYTES: usize = 140;
const OWN_BYTES: usize = 190;

/// Seconds between two moments of the cursor, at least.
const MOMENT_STEP_S: f64 = 2.0;

/// Moments, at least and at most.
const MOMENTS: (f64, f64) = (36.0, 120.0);

/// Most samples of one curve.
const CURVE_SAMPLES: f64 = 400.0;

/// The motion that the pictures show.
#[derive(Debug, Clone, Copy)]
pub enum Motion<'a> {
    /// The plan.
    Planned(&'a Trajectory),
    /// Without a plan: own ship as if she followed the desired trajectory, so that the picture shows
    /// what stands in her way.
    Undisturbed(&'a DesiredTrajectory),
}

impl Motion<'_> {
    pub fn is_planned(&self) -> bool {
        matches!(self, Self::Planned(_))
    }

    /// Of times that rise those until the plan has arrived: nothing is claimed after that.
    pub fn until_arrival<'t>(&self, times: &'t [f64]) -> &'t [f64] {
        match self {
            Self::Planned(plan) => {
                let end = plan.end_time() + tolerance::TIME_S;
                &times[..times.partition_point(|t| *t <= end)]
            }
            Self::Undisturbed(_) => times,
        }
    }

    /// Seconds.
    pub fn end(&self) -> f64 {
        match self {
            Self::Planned(trajectory) => trajectory.end_time(),
            Self::Undisturbed(desired) => desired.duration(),
        }
    }

    /// When its speed may change, seconds, its start and its end among them.
    pub fn steps(&self) -> Vec<f64> {
        let mut times = match self {
            Self::Planned(trajectory) => trajectory.joints(),
            Self::Undisturbed(desired) => desired.legs().iter().map(|l| l.start_time).collect(),
        };
        times.push(self.end());
        times
    }

    pub fn pose_at(&self, time: f64) -> Pose {
        match self {
            Self::Planned(trajectory) => trajectory.pose_at(time),
            Self::Undisturbed(desired) => Pose::new(
                desired.position_at(time),
                heading_of(desired_leg(desired, time).direction),
            ),
        }
    }

    pub fn speed_at(&self, time: f64) -> f64 {
        match self {
            Self::Planned(trajectory) => trajectory.speed_at(time),
            Self::Undisturbed(desired) => desired_leg(desired, time).speed,
        }
    }
}

/// The leg that is to be run at `time`.
pub fn desired_leg(desired: &DesiredTrajectory, time: f64) -> &DesiredLeg {
    let legs = desired.legs();
    let index = legs.partition_point(|leg| leg.end_time() <= time);
    &legs[index.min(legs.len() - 1)]
}

/// A box in the plane, metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    pub low: Vector,
    pub high: Vector,
}

impl Bounds {
    fn of(points: impl IntoIterator<Item = Vector>) -> Self {
        let mut bounds = Self {
            low: Vector::repeat(f64::INFINITY),
            high: Vector::repeat(f64::NEG_INFINITY),
        };
        for p in points {
            bounds.low = bounds.low.inf(&p);
            bounds.high = bounds.high.sup(&p);
        }
        bounds
    }

    pub fn grown(self, by: f64) -> Self {
        Self {
            low: self.low.add_scalar(-by),
            high: self.high.add_scalar(by),
        }
    }

    pub fn contains(&self, p: &Vector) -> bool {
        p.x > self.low.x && p.x < self.high.x && p.y > self.low.y && p.y < self.high.y
    }

    pub fn size(&self) -> Vector {
        self.high - self.low
    }

    pub fn center(&self) -> Vector {
        (self.low + self.high) / 2.0
    }

    /// The longer side.
    pub fn extent(&self) -> f64 {
        self.size().max()
    }
}

/// What colours are for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Hues {
    /// Own ship is white.
    Targets,
    /// Targets are grey.
    OwnShips,
}

/// A scenario and its sets, prepared for drawing whoever sails in it.
#[derive(Debug)]
pub struct Stage<'a> {
    pub scenario: &'a Scenario,
    pub sets: &'a [TargetSets],
    /// Seconds: nothing is shown after that.
    pub end: f64,
    /// Seconds: every position of the cursor at which something moves.
    pub moments: Vec<f64>,
    /// Seconds: where the curves are sampled.
    pub samples: Vec<f64>,
    /// What the pictures show.
    pub bounds: Bounds,
    /// Metres of height per second in the space-time volume.
    pub metres_per_second: f64,
    /// Colours of the targets: these, or greys where colours tell own ships apart.
    pub hues: Hues,
}

impl<'a> Stage<'a> {
    /// `motions` are to be seen whole.
    pub fn new(
        scenario: &'a Scenario,
        sets: &'a [TargetSets],
        motions: &[Motion],
        end: f64,
        hues: Hues,
    ) -> Self {
        let moments = steps(end, moment_step(sets, end));
        let samples = steps(end, (end / CURVE_SAMPLES).ceil().max(1.0));
        let bounds = bounds(scenario, motions, &moments);
        Self {
            scenario,
            sets,
            end,
            moments,
            samples,
            bounds,
            metres_per_second: one_digit(0.65 * bounds.extent() / end),
            hues,
        }
    }

    /// The colour of a target by its index.
    pub fn target_color(&self, index: usize) -> Color {
        match self.hues {
            Hues::Targets => style::target(index),
            Hues::OwnShips => style::grey_target(index),
        }
    }

    /// True where something of the shapes is asked for: elsewhere they are not shown.
    fn is_shaped(&self) -> bool {
        self.scenario.compliance != Compliance::None
    }

    /// The shaped set, where there is one to be shown beside the hard one.
    pub fn shaped<'s>(&self, sets: &'s TargetSets) -> Option<&'s Obstacle> {
        (self.is_shaped() && sets.shaped != sets.hard).then_some(&sets.shaped)
    }

    /// Metres: how far lines may be drawn from where they are.
    pub fn fineness(&self) -> f64 {
        thinning::FINENESS * self.bounds.extent()
    }

    /// The unit vector from the first waypoint to the last; own ship's first heading on a round trip.
    pub fn ahead(&self) -> Vector {
        let desired = &self.scenario.desired;
        let start = desired.legs()[0].start;
        (desired.end() - start)
            .try_normalize(0.0)
            .unwrap_or_else(|| self.scenario.own_ship.pose.ahead())
    }

    /// The index column of everything that moves.
    pub fn moment_column(&self) -> TimeColumn {
        TimeColumn::new_duration_secs(TIMELINE, self.moments.iter().copied())
    }

    /// The point of the space-time volume, metres.
    pub fn lifted(&self, position: Vector, time: f64) -> [f32; 3] {
        let [east, north] = flat(position);
        [east, north, (time * self.metres_per_second) as f32]
    }
}

/// One run on its stage.
#[derive(Debug)]
pub struct Scene<'a> {
    pub run: &'a Run,
    pub motion: Motion<'a>,
    /// Until arrival, or the end of the desired trajectory if that is later. Nothing is claimed after arrival, and the sets only
    /// grow.
    pub stage: Stage<'a>,
    /// How own ship behaves toward each target, in the order of the scenario's; `None` for one that is no ship, and without a plan.
    pub conduct: Vec<Option<ComplianceReport>>,
}

impl<'a> Scene<'a> {
    pub fn new(run: &'a Run) -> Self {
        let desired = &run.scenario.desired;
        let motion = match run.planned.outcome.plan() {
            Some(plan) => Motion::Planned(&plan.trajectory),
            None => Motion::Undisturbed(desired),
        };
        let end = match motion {
            Motion::Planned(trajectory) => trajectory.end_time().max(desired.duration()),
            Motion::Undisturbed(_) => desired.duration(),
        }
        .min(run.scenario.horizon);
        Self {
            run,
            motion,
            stage: Stage::new(&run.scenario, &run.sets, &[motion], end, Hues::Targets),
            conduct: run.judged_conduct(),
        }
    }
}

/// A scene is a stage with somebody on it: what the stage knows, it knows.
impl<'a> std::ops::Deref for Scene<'a> {
    type Target = Stage<'a>;

    fn deref(&self) -> &Stage<'a> {
        &self.stage
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

/// `value` with one digit.
fn one_digit(value: f64) -> f64 {
    let power = 10f64.powf(value.log10().floor());
    (value / power).round() * power
}

/// 0, every `step`, and `end`.
fn steps(end: f64, step: f64) -> Vec<f64> {
    let count = (end / step).ceil() as usize;
    let mut times: Vec<f64> = (0..count).map(|i| step * i as f64).collect();
    times.push(end);
    times
}

/// Bytes of a section as the last one is.
fn section_bytes(set: &Obstacle, end: f64) -> usize {
    CORNER_BYTES * set.outer_section(end).vertices().len() + ROW_BYTES
}

/// Seconds from moment to moment.
fn moment_step(sets: &[TargetSets], end: f64) -> f64 {
    let of_target = |s: &TargetSets| {
        let shaped = (s.shaped != s.hard).then(|| section_bytes(&s.shaped, end));
        TARGET_BYTES + section_bytes(&s.hard, end) + shaped.unwrap_or(0)
    };
    let each = OWN_BYTES + sets.iter().map(of_target).sum::<usize>();
    let moments = (MOVING_BYTES / each as f64).clamp(MOMENTS.0, MOMENTS.1);
    (end / moments).ceil().max(MOMENT_STEP_S)
}

/// The desired trajectory, the motions, and every target while it is near one of them.
fn bounds(scenario: &Scenario, motions: &[Motion], moments: &[f64]) -> Bounds {
    let desired = &scenario.desired;
    let near = 0.6 * desired.length();
    let mut points = desired.waypoints();
    points.push(scenario.own_ship.pose.position);
    for &time in moments {
        for motion in motions {
            let own = motion.pose_at(time).position;
            points.push(own);
            points.extend(
                scenario
                    .targets
                    .iter()
                    .map(|target| target.position_at(time))
                    .filter(|p| (p - own).norm() < near),
            );
        }
    }
    let bounds = Bounds::of(points);
    let bounds = bounds.grown(0.06 * bounds.extent());
    // a straight run is a line: leave sea on both sides of it
    let short = 0.45 * bounds.extent();
    let missing = bounds.size().map(|side| (short - side).max(0.0) / 2.0);
    Bounds {
        low: bounds.low - missing,
        high: bounds.high + missing,
    }
}
