//! How the viewer opens a recording: the chart at left, then volume, curves and the verdict.

mod panes;

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

use panes::{Pane, Panes};

use crate::frame::{Vector, knots_from_mps, to_starboard};
use crate::recording::canvas::{Canvas, ViewModel, style};
use crate::recording::views::chart::legend_height;
use crate::recording::views::curves::{CLEARANCE, COURSE, Curves, MARGIN, RISK, SPEED};
use crate::recording::views::explored::BLOCKED;
use crate::recording::views::{forces, path_time, rules, velocities};
use crate::recording::write::Recorder;
use crate::recording::{
    CHART, EXPLORED, PATH_TIME, RULES, SUMMARY, TIMELINE, TRAILS, VELOCITIES, VOLUME, path,
};

/// How long it takes to play the whole run, seconds.
const PLAY_S: f64 = 25.0;

/// Least range of a plot of distances, metres, or half of the bounds.
const LEAST_RANGE_M: f64 = 50.0;

/// Lays out all views of a run.
pub fn of_run(model: &ViewModel, curves: &Curves) -> RecordingStreamResult<Recorder> {
    let mut layout = Panes::new();
    let to = &mut layout;
    let chart = chart_view(to, model, 1, &[path(&[EXPLORED])])?;
    let mut left = vec![chart];
    let mut left_shares = vec![0.66];
    if let Some((rules, share)) = rules_view(to, model)? {
        left.push(rules);
        left_shares = vec![0.66 - share, share];
    }
    left.push(to.view::<TextDocumentView>("Verdict", SUMMARY)?);
    left_shares.push(0.34);
    let left = to.below(&left, left_shares)?;
    let blocked = path(&[VOLUME, "explored", BLOCKED]);
    let mut views = vec![volume_view(to, model, &[blocked])?];
    views.extend(path_time_view(to, model)?);
    let mut shares = vec![0.5 / views.len() as f32; views.len()];
    let mut small = curve_views(to, model, curves)?;
    if forces::steered(model).is_some() {
        small.extend(force_views(to, model)?);
    }
    small.push(velocity_view(to, model)?);
    views.push(to.grid(&small, 2)?);
    shares.push(0.5);
    let right = to.below(&views, shares)?;
    let root = to.beside(&[left, right], [0.54, 0.46])?;
    layout.finished(&root, &time_panel(model))
}

/// Lays out a comparison: chart and volume side by side, below them the table and the curves.
///
/// `rows` are those of the legend; `hidden` are folders on the chart and in the volume; `plots` are
/// the name, the entity and the range of each plot.
pub fn of_comparison(
    canvas: &Canvas,
    rows: usize,
    hidden: &[Vec<EntityPath>; 2],
    plots: &[(&str, &str, [f64; 2])],
) -> RecordingStreamResult<Recorder> {
    let mut layout = Panes::new();
    let to = &mut layout;
    let chart = chart_view(to, canvas, rows, &hidden[0])?;
    let volume = volume_view(to, canvas, &hidden[1])?;
    let pictures = to.beside(&[chart, volume], [0.5, 0.5])?;
    let table = to.view::<TextDocumentView>("Comparison", SUMMARY)?;
    let mut curves = Vec::new();
    for (name, origin, range) in plots {
        // the legend of the chart serves the plots, too
        let legend = PlotLegend::new().with_visible(false);
        let plot = plot_view(to, canvas, (name, origin), &legend)?;
        to.set(&plot, "ScalarAxis", &scale(*range))?;
        curves.push(plot);
    }
    let curves = to.below(&curves, [])?;
    let below = to.beside(&[table, curves], [0.56, 0.44])?;
    let root = to.below(&[pictures, below], [0.62, 0.38])?;
    layout.finished(&root, &time_panel(canvas))
}

/// Paused at the start.
fn time_panel(canvas: &Canvas) -> TimePanelBlueprint {
    TimePanelBlueprint::new()
        .with_state(PanelState::Collapsed)
        .with_timeline(TIMELINE)
        .with_playback_speed((canvas.end / PLAY_S).round().max(1.0))
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

/// From the start to the end, with a margin.
fn whole_time(canvas: &Canvas) -> TimeRange {
    let nanoseconds =
        |seconds: f64| TimeRangeBoundary::Absolute(((seconds * 1e9).round() as i64).into());
    TimeRange {
        start: nanoseconds(-0.02 * canvas.end),
        end: nanoseconds(1.02 * canvas.end),
    }
}

fn chart_view(
    to: &mut Panes,
    canvas: &Canvas,
    legend_rows: usize,
    hidden_folders: &[EntityPath],
) -> RecordingStreamResult<Pane> {
    let (low, high) = (canvas.bounds.low, canvas.bounds.high);
    // the view's own axis points down: north is negative there
    let shown = [
        [low.x, high.x],
        [-high.y, -low.y + legend_height(canvas, legend_rows)],
    ];
    let chart = plane_view(to, ("Chart, north up", CHART), shown)?;
    to.set_of(&chart, &path(&[TRAILS]), &up_to_cursor())?;
    hide(to, &chart, hidden_folders)?;
    Ok(chart)
}

/// A view of a plane, with the ranges that it shows to the right and downward.
fn plane_view(
    to: &mut Panes,
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

/// Hides folders of a view until they are switched on.
fn hide(to: &mut Panes, view: &Pane, folders: &[EntityPath]) -> RecordingStreamResult<()> {
    let hidden = EntityBehavior::new().with_visible(false);
    folders
        .iter()
        .try_for_each(|folder| to.set_of(view, folder, &hidden))
}

fn volume_view(
    to: &mut Panes,
    canvas: &Canvas,
    hidden_folders: &[EntityPath],
) -> RecordingStreamResult<Pane> {
    let size = 0.92 * canvas.bounds.size().norm();
    let middle = canvas.lifted(canvas.bounds.center(), 0.42 * canvas.end);
    // from starboard and somewhat astern: own ship runs from left to right and upward
    let ahead = canvas.ahead();
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
    to: &mut Panes,
    model: &ViewModel,
    curves: &Curves,
) -> RecordingStreamResult<Vec<Pane>> {
    let margin = model.scenario.own_ship.safety_margin;
    let fastest = knots_from_mps(model.scenario.own_ship.max_speed());
    let farthest = near_zero(model, curves.farthest_passage(), margin);
    let least = near_zero(model, curves.least_margin(), margin);
    let views = [
        ("Clearance between hulls (m)", CLEARANCE, farthest),
        ("Margin to the sets (m)", MARGIN, least),
        ("Risk", RISK, [-0.05, 1.2]),
        ("Speed (kn)", SPEED, [0.0, 1.4 * fastest]),
        ("Course (deg)", COURSE, course_range(curves)),
    ];
    let view = |(name, origin, range)| {
        let view = plot_view(to, model, (name, origin), &above_the_curves())?;
        to.set(&view, "ScalarAxis", &scale(range))?;
        Ok(view)
    };
    views.into_iter().map(view).collect()
}

/// A legend above the curves: curves of distances are low where they matter.
fn above_the_curves() -> PlotLegend {
    PlotLegend::new().with_corner(Corner2D::RightTop)
}

fn scale(range: [f64; 2]) -> ScalarAxis {
    ScalarAxis::new().with_range(rerun::datatypes::Range1D(range))
}

fn plot_view(
    to: &mut Panes,
    canvas: &Canvas,
    (name, origin): (&str, &str),
    legend: &PlotLegend,
) -> RecordingStreamResult<Pane> {
    let view = to.view::<TimeSeriesView>(name, origin)?;
    to.set(&view, "PlotLegend", legend)?;
    to.set(&view, "TimeAxis", &time_axis(canvas))?;
    Ok(view)
}

fn time_axis(canvas: &Canvas) -> TimeAxis {
    TimeAxis::new().with_view_range(whole_time(canvas))
}

/// For a plan of forces: the velocities and the forces.
fn force_views(to: &mut Panes, model: &ViewModel) -> RecordingStreamResult<[Pane; 2]> {
    let legend = above_the_curves();
    Ok([
        plot_view(
            to,
            model,
            ("Velocity (m/s, deg/s)", forces::STATES),
            &legend,
        )?,
        plot_view(to, model, ("Forces (N, Nm)", forces::FORCES), &legend)?,
    ])
}

fn velocity_view(to: &mut Panes, model: &ViewModel) -> RecordingStreamResult<Pane> {
    let limit = 1.05 * velocities::limit(model);
    let name = "Velocity obstacles (m/s, north up)";
    plane_view(to, (name, VELOCITIES), [[-limit, limit]; 2])
}

/// The roles over time and the fraction of the height that they need; `None` where no rule applies.
fn rules_view(to: &mut Panes, model: &ViewModel) -> RecordingStreamResult<Option<(Pane, f32)>> {
    let lanes = rules::height(model);
    if lanes == 0 {
        return Ok(None);
    }
    let name = "Rules: roles over time, and what is broken";
    let view = to.view::<StateTimelineView>(name, RULES)?;
    to.set(&view, "TimeAxis", &time_axis(model))?;
    let share = LANES_HEAD + LANE * lanes.min(MOST_LANES) as f32;
    Ok(Some((view, share)))
}

/// Fractions of the window's height for the head of the lanes and for each lane, and how many lanes
/// are seen without scrolling.
const LANES_HEAD: f32 = 0.075;
const LANE: f32 = 0.03;
const MOST_LANES: usize = 5;

/// The diagram of a path-time plan, beside the volume.
fn path_time_view(to: &mut Panes, model: &ViewModel) -> RecordingStreamResult<Option<Pane>> {
    let Some(diagram) = model.run.planned.path_time.as_deref() else {
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

/// The range of a plot of a distance that falls to `least`, with the required `margin`; metres.
pub fn near_zero(canvas: &Canvas, least: f64, margin: f64) -> [f64; 2] {
    let least = if least.is_finite() { least } else { 0.0 };
    let top = (3.0 * least.abs())
        .max(8.0 * margin)
        .max(LEAST_RANGE_M.min(0.5 * canvas.bounds.extent()));
    [least.min(0.0) - 0.1 * top, top]
}

/// The range of the plot of courses, degrees, with space above for the legend.
fn course_range(curves: &Curves) -> [f64; 2] {
    let [low, high] = curves.course_range();
    let air = (0.15 * (high - low)).max(10.0);
    [low - air, high + 3.0 * air]
}
