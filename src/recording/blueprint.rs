//! How the viewer opens the recording: chart at left, volume, curves, and the verdict in words.

use rerun::datatypes::{TimeRange, TimeRangeBoundary, VisibleTimeRange};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EntityBehavior, EyeControls3D, LineGrid3D, PlotLegend, ScalarAxis, TimeAxis,
    TimePanelBlueprint, VisibleTimeRanges, VisualBounds2D,
};
use rerun::external::re_sdk_types::blueprint::components::{
    BackgroundKind, Corner2D, LoopMode, PanelState, PlayState,
};
use rerun::external::re_sdk_types::blueprint::views::{
    Spatial2DView, Spatial3DView, StateTimelineView, TextDocumentView, TimeSeriesView,
};
use rerun::{EntityPath, RecordingStreamResult};

use super::chart::legend_height;
use super::curves::{CLEARANCE, COURSE, Curves, MARGIN, RISK, SPEED};
use super::explored::BLOCKED;
use super::layout::{Layout, Pane};
use super::recorder::Recorder;
use super::scene::{Scene, Stage};
use super::{
    CHART, EXPLORED, PATH_TIME, RULES, SUMMARY, TIMELINE, TRAILS, VELOCITIES, VOLUME, forces, path,
    path_time, rules, style, velocities,
};
use crate::frame::{Vector, knots_from_mps, to_starboard};

/// Seconds in which the whole run is played.
const PLAY_S: f64 = 25.0;

/// Metres that a plot of distances shows at least, or half of the sea that is shown.
const LEAST_RANGE_M: f64 = 50.0;

/// Lays out all views of a run.
pub fn of_run(scene: &Scene, curves: &Curves) -> RecordingStreamResult<Recorder> {
    let mut layout = Layout::new();
    let to = &mut layout;
    let chart = chart_view(to, scene, 1, &[path(&[EXPLORED])])?;
    let mut left = vec![chart];
    let mut left_shares = vec![0.66];
    if let Some((rules, share)) = rules_view(to, scene)? {
        left.push(rules);
        left_shares = vec![0.66 - share, share];
    }
    left.push(to.view::<TextDocumentView>("Verdict", SUMMARY)?);
    left_shares.push(0.34);
    let left = to.below(&left, left_shares)?;
    let blocked = path(&[VOLUME, "explored", BLOCKED]);
    let mut views = vec![volume_view(to, scene, &[blocked])?];
    views.extend(path_time_view(to, scene)?);
    let mut shares = vec![0.5 / views.len() as f32; views.len()];
    let mut small = curve_views(to, scene, curves)?;
    if forces::steered(scene).is_some() {
        small.extend(force_views(to, scene)?);
    }
    small.push(velocity_view(to, scene)?);
    views.push(to.grid(&small, 2)?);
    shares.push(0.5);
    let right = to.below(&views, shares)?;
    let root = to.beside(&[left, right], [0.54, 0.46])?;
    layout.finished(&root, &time_panel(scene))
}

/// The layout of a comparison: chart and volume side by side, below them the table and the curves. `hidden` are folders on the
/// chart and in the volume; `rows` those of the legend, `plots` the name, the entity and the range of each plot.
pub fn of_comparison(
    stage: &Stage,
    rows: usize,
    hidden: &[Vec<EntityPath>; 2],
    plots: &[(&str, &str, [f64; 2])],
) -> RecordingStreamResult<Recorder> {
    let mut layout = Layout::new();
    let to = &mut layout;
    let chart = chart_view(to, stage, rows, &hidden[0])?;
    let volume = volume_view(to, stage, &hidden[1])?;
    let pictures = to.beside(&[chart, volume], [0.5, 0.5])?;
    let table = to.view::<TextDocumentView>("Comparison", SUMMARY)?;
    let mut curves = Vec::new();
    for (name, origin, range) in plots {
        // the legend of the chart is theirs, too
        let legend = PlotLegend::new().with_visible(false);
        let plot = plot_view(to, stage, (name, origin), &legend)?;
        to.set(&plot, "ScalarAxis", &scale(*range))?;
        curves.push(plot);
    }
    let curves = to.below(&curves, [])?;
    let below = to.beside(&[table, curves], [0.56, 0.44])?;
    let root = to.below(&[pictures, below], [0.62, 0.38])?;
    layout.finished(&root, &time_panel(stage))
}

/// Paused at the start.
fn time_panel(stage: &Stage) -> TimePanelBlueprint {
    TimePanelBlueprint::new()
        .with_state(PanelState::Collapsed)
        .with_timeline(TIMELINE)
        .with_playback_speed((stage.end / PLAY_S).round().max(1.0))
        .with_play_state(PlayState::Paused)
        .with_loop_mode(LoopMode::All)
}

fn plain_background() -> Background {
    Background::new(BackgroundKind::SolidColor).with_color(style::background())
}

/// Everything logged so far stays visible.
fn up_to_cursor() -> VisibleTimeRanges {
    VisibleTimeRanges::new([VisibleTimeRange {
        timeline: TIMELINE.into(),
        range: TimeRange {
            start: TimeRangeBoundary::Infinite,
            end: TimeRangeBoundary::CursorRelative(0.into()),
        },
    }])
}

/// From the start to the end, with a little air.
fn whole_time(stage: &Stage) -> TimeRange {
    let nanoseconds =
        |seconds: f64| TimeRangeBoundary::Absolute(((seconds * 1e9).round() as i64).into());
    TimeRange {
        start: nanoseconds(-0.02 * stage.end),
        end: nanoseconds(1.02 * stage.end),
    }
}

fn chart_view(
    to: &mut Layout,
    stage: &Stage,
    legend_rows: usize,
    hidden_folders: &[EntityPath],
) -> RecordingStreamResult<Pane> {
    let (low, high) = (stage.bounds.low, stage.bounds.high);
    // the view's own axis points down: north is negative there
    let shown = [
        [low.x, high.x],
        [-high.y, -low.y + legend_height(stage, legend_rows)],
    ];
    let chart = plane_view(to, ("Chart, north up", CHART), shown)?;
    to.set_of(&chart, &path(&[TRAILS]), &up_to_cursor())?;
    hide(to, &chart, hidden_folders)?;
    Ok(chart)
}

/// A view of a plane: from where to where, to the right and downward.
fn plane_view(
    to: &mut Layout,
    (name, origin): (&str, &str),
    [right, down]: [[f64; 2]; 2],
) -> RecordingStreamResult<Pane> {
    let view = to.view::<Spatial2DView>(name, origin)?;
    let shown = rerun::datatypes::Range2D {
        x_range: right.into(),
        y_range: down.into(),
    };
    to.set(&view, "VisualBounds2D", &VisualBounds2D::new(shown))?;
    to.set(&view, "Background", &plain_background())?;
    Ok(view)
}

/// Hides folders of a view until they are asked for.
fn hide(to: &mut Layout, view: &Pane, folders: &[EntityPath]) -> RecordingStreamResult<()> {
    let hidden = EntityBehavior::new().with_visible(false);
    folders
        .iter()
        .try_for_each(|folder| to.set_of(view, folder, &hidden))
}

fn volume_view(
    to: &mut Layout,
    stage: &Stage,
    hidden_folders: &[EntityPath],
) -> RecordingStreamResult<Pane> {
    let size = 0.92 * stage.bounds.size().norm();
    let middle = stage.lifted(stage.bounds.center(), 0.42 * stage.end);
    // from starboard and somewhat astern: own ship runs from left to right and upward
    let ahead = stage.ahead();
    let side: Vector = to_starboard(ahead) - ahead * 0.35;
    let eye = [
        middle[0] + (side.x * size) as f32,
        middle[1] + (side.y * size) as f32,
        middle[2] + (0.36 * size) as f32,
    ];
    let eye = EyeControls3D::new()
        .with_position(eye)
        .with_look_target(middle)
        .with_eye_up([0.0, 0.0, 1.0]);
    let volume = to.view::<Spatial3DView>("Space-time: time upward", VOLUME)?;
    to.set(&volume, "EyeControls3D", &eye)?;
    let no_grid = LineGrid3D::new().with_visible(false);
    to.set(&volume, "LineGrid3D", &no_grid)?;
    to.set(&volume, "Background", &plain_background())?;
    hide(to, &volume, hidden_folders)?;
    Ok(volume)
}

fn curve_views(
    to: &mut Layout,
    scene: &Scene,
    curves: &Curves,
) -> RecordingStreamResult<Vec<Pane>> {
    let margin = scene.scenario.own_ship.safety_margin;
    let fastest = knots_from_mps(scene.scenario.own_ship.max_speed());
    let farthest = near_zero(scene, curves.farthest_passage(), margin);
    let least = near_zero(scene, curves.least_margin(), margin);
    let views = [
        ("Clearance between hulls (m)", CLEARANCE, farthest),
        ("Margin to the sets (m)", MARGIN, least),
        ("Risk", RISK, [-0.05, 1.2]),
        ("Speed (kn)", SPEED, [0.0, 1.4 * fastest]),
        ("Course (deg)", COURSE, course_range(curves)),
    ];
    let view = |(name, origin, range)| {
        let view = plot_view(to, scene, (name, origin), &above_the_curves())?;
        to.set(&view, "ScalarAxis", &scale(range))?;
        Ok(view)
    };
    views.into_iter().map(view).collect()
}

/// Curves of distances are low where they matter.
fn above_the_curves() -> PlotLegend {
    PlotLegend::new().with_corner(Corner2D::RightTop)
}

fn scale(range: [f64; 2]) -> ScalarAxis {
    ScalarAxis::new().with_range(rerun::datatypes::Range1D(range))
}

fn plot_view(
    to: &mut Layout,
    stage: &Stage,
    (name, origin): (&str, &str),
    legend: &PlotLegend,
) -> RecordingStreamResult<Pane> {
    let view = to.view::<TimeSeriesView>(name, origin)?;
    to.set(&view, "PlotLegend", legend)?;
    to.set(&view, "TimeAxis", &time_axis(stage))?;
    Ok(view)
}

fn time_axis(stage: &Stage) -> TimeAxis {
    TimeAxis::new().with_view_range(whole_time(stage))
}

/// Of a plan of forces: what the ship does, and what makes her do it.
fn force_views(to: &mut Layout, scene: &Scene) -> RecordingStreamResult<[Pane; 2]> {
    let legend = above_the_curves();
    Ok([
        plot_view(
            to,
            scene,
            ("Velocity (m/s, deg/s)", forces::STATES),
            &legend,
        )?,
        plot_view(to, scene, ("Forces (N, Nm)", forces::FORCES), &legend)?,
    ])
}

fn velocity_view(to: &mut Layout, scene: &Scene) -> RecordingStreamResult<Pane> {
    let limit = 1.05 * velocities::limit(scene);
    let name = "Velocity obstacles (m/s, north up)";
    plane_view(to, (name, VELOCITIES), [[-limit, limit]; 2])
}

/// The roles over time and the share of the height that they need; nothing where no rule asks anything.
fn rules_view(to: &mut Layout, scene: &Scene) -> RecordingStreamResult<Option<(Pane, f32)>> {
    let lanes = rules::height(scene);
    if lanes == 0 {
        return Ok(None);
    }
    let name = "Rules: roles over time, and what is broken";
    let view = to.view::<StateTimelineView>(name, RULES)?;
    to.set(&view, "TimeAxis", &time_axis(scene))?;
    let share = LANES_HEAD + LANE * lanes.min(MOST_LANES) as f32;
    Ok(Some((view, share)))
}

/// Of the height of the window: what the head of the lanes takes, each of them, and how many are seen without scrolling.
const LANES_HEAD: f32 = 0.075;
const LANE: f32 = 0.03;
const MOST_LANES: usize = 5;

/// The diagram of a path-time plan, beside the volume.
fn path_time_view(to: &mut Layout, scene: &Scene) -> RecordingStreamResult<Option<Pane>> {
    let Some(diagram) = scene.run.planned.path_time.as_deref() else {
        return Ok(None);
    };
    let frame = path_time::Frame::of(diagram);
    let height = frame.top * frame.rise;
    // the view's own axis points down: time is negative there
    let shown = [
        [-0.08 * frame.length, 1.04 * frame.length],
        [-1.04 * height, 0.08 * height],
    ];
    plane_view(to, ("Path and time: time upward", PATH_TIME), shown).map(Some)
}

/// The interesting part of a distance that falls to `least`, where `margin` is asked for; metres.
pub fn near_zero(stage: &Stage, least: f64, margin: f64) -> [f64; 2] {
    let least = if least.is_finite() { least } else { 0.0 };
    let top = (3.0 * least.abs())
        .max(8.0 * margin)
        .max(LEAST_RANGE_M.min(0.5 * stage.bounds.extent()));
    [least.min(0.0) - 0.1 * top, top]
}

/// Degrees: all courses of the run, and air above them for the legend.
fn course_range(curves: &Curves) -> [f64; 2] {
    let [low, high] = curves.course_range();
    let air = (0.15 * (high - low)).max(10.0);
    [low - air, high + 3.0 * air]
}
