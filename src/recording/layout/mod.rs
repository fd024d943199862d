//! How the viewer opens a recording: the chart at left, then volume, curves and the verdict.

mod panes;

use rerun::EntityPath;
use rerun::datatypes::{TimeRange, TimeRangeBoundary, VisibleTimeRange};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EntityBehavior, EyeControls3D, LineGrid3D, PlotLegend, ScalarAxis, TextLogColumns,
    TimeAxis, TimePanelBlueprint, VisibleTimeRanges, VisualBounds2D,
};
use rerun::external::re_sdk_types::blueprint::components::{
    BackgroundKind, Corner2D, LoopMode, PanelState, PlayState,
};
use rerun::external::re_sdk_types::blueprint::datatypes::{TextLogColumn, TextLogColumnKind};
use rerun::external::re_sdk_types::blueprint::views::{
    MapView, Spatial2DView, Spatial3DView, StateTimelineView, TextDocumentView, TextLogView,
    TimeSeriesView,
};

use panes::{Pane, Panes};

use crate::frame::{Vector, to_starboard};
use crate::recording::canvas::{Canvas, ViewModel, style};
use crate::recording::recorder::Recorder;
use crate::recording::views::curves::Plot;
use crate::recording::views::explored::BLOCKED;
use crate::recording::views::velocities;
use crate::recording::{
    CHART, EARTH, EVENTS, EXPLORED, LEGS, Logged, ROLES, SUMMARY, TIMELINE, TRAILS, VELOCITIES,
    VOLUME, path,
};

/// How long it takes to play the whole run, seconds.
const PLAY_S: f64 = 25.0;

/// Lays out a run with so many lanes of rules, with or without legs, and with its plots, those of
/// distances first.
pub fn of_run(model: &ViewModel, lanes: usize, has_legs: bool, plots: &[Plot]) -> Logged<Recorder> {
    let mut layout = Panes::default();
    let to = &mut layout;
    let mut chart = chart_view(to, model)?;
    if model.scenario.earth.is_some() {
        // its tiles come from the network, by the viewer
        let map = to.view::<MapView>("Map", EARTH)?;
        chart = to.tabs(&[chart, map])?;
    }
    let mut words = to.view::<TextDocumentView>("Verdict", SUMMARY)?;
    if has_legs {
        let legs = to.view::<TextDocumentView>("Legs", LEGS)?;
        words = to.tabs(&[words, legs])?;
    }
    let left = chart_over(to, model, [(chart, 0.66), (words, 0.34)], lanes)?;
    let volume = volume_view(to, model, path(&[VOLUME, "explored", BLOCKED]))?;
    let velocities = velocity_view(to, model)?;
    let mut right = vec![to.tabs(&[volume, velocities])?];
    let (distances, others) = plots.split_at(2);
    right.extend(plot_views(to, model, distances, legend_room(model))?);
    let small = plot_views(to, model, others, 0.7)?;
    let rows = small.len().div_ceil(2) as f32;
    right.push(to.grid(&small, 2)?);
    let right = to.below(&right, [0.4, 0.22, 0.19, 0.19 * rows])?;
    let root = to.beside(&[left, right], [0.54, 0.46])?;
    layout.finished(&root, &time_panel(model))
}

/// Lays out a comparison: chart and volume side by side, below them the table and the curves.
pub fn of_comparison(canvas: &Canvas, plots: &[Plot]) -> Logged<Recorder> {
    let mut layout = Panes::default();
    let to = &mut layout;
    let chart = chart_view(to, canvas)?;
    let volume = volume_view(to, canvas, path(&[VOLUME, "explored"]))?;
    let pictures = to.beside(&[chart, volume], [0.5, 0.5])?;
    let table = to.view::<TextDocumentView>("Comparison", SUMMARY)?;
    let curves = plot_views(to, canvas, plots, 0.5)?;
    let curves = to.below(&curves, [])?;
    let below = to.beside(&[table, curves], [0.56, 0.44])?;
    let root = to.below(&[pictures, below], [0.62, 0.38])?;
    layout.finished(&root, &time_panel(canvas))
}

/// Lays out a simulation with so many lanes of rules: the chart over them and the events, beside
/// them the summary over the curves.
pub fn of_simulation(canvas: &Canvas, lanes: usize, plots: &[Plot]) -> Logged<Recorder> {
    let mut layout = Panes::default();
    let to = &mut layout;
    let chart = chart_view(to, canvas)?;
    let events = to.view::<TextLogView>("Events", EVENTS)?;
    let shown = [TextLogColumnKind::LogLevel, TextLogColumnKind::Body];
    let shown = shown.map(|kind| TextLogColumn {
        kind,
        visible: true.into(),
    });
    let columns = TextLogColumns::new().with_text_log_columns(shown);
    to.set(&events, "TextLogColumns", &columns)?;
    let left = chart_over(to, canvas, [(chart, 0.78), (events, 0.22)], lanes)?;
    let mut right = vec![to.view::<TextDocumentView>("Summary", SUMMARY)?];
    right.extend(plot_views(to, canvas, plots, legend_room(canvas))?);
    let shares = [0.4, 0.24, 0.18, 0.18].into_iter().take(right.len());
    let right = to.below(&right, shares)?;
    let root = to.beside(&[left, right], [0.55, 0.45])?;
    layout.finished(&root, &time_panel(canvas))
}

/// The chart over another pane, each with its share of the height. Roles are between them, where
/// there are any, in the share of the chart.
fn chart_over(
    to: &mut Panes,
    canvas: &Canvas,
    [(chart, share), (below, rest)]: [(Pane, f32); 2],
    lanes: usize,
) -> Logged<Pane> {
    match rules_view(to, canvas, lanes)? {
        Some((rules, part)) => to.below(&[chart, rules, below], [share - part, part, rest]),
        None => to.below(&[chart, below], [share, rest]),
    }
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
    Background::new(BackgroundKind::SolidColor).with_color(style::BACKGROUND)
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

fn chart_view(to: &mut Panes, canvas: &Canvas) -> Logged<Pane> {
    let (low, high) = (canvas.bounds.low, canvas.bounds.high);
    // the view's own axis points down: north is negative there
    let shown = [[low.x, high.x], [-high.y, -low.y]];
    let chart = plane_view(to, ("Chart, north up", CHART), shown)?;
    to.set_of(&chart, &path(&[TRAILS]), &up_to_cursor())?;
    hide(to, &chart, path(&[EXPLORED]))?;
    Ok(chart)
}

/// A view of a plane, with the ranges that it shows to the right and downward.
fn plane_view(
    to: &mut Panes,
    (name, origin): (&str, &str),
    [right, down]: [[f64; 2]; 2],
) -> Logged<Pane> {
    let view = to.view::<Spatial2DView>(name, origin)?;
    let shown = rerun::datatypes::Range2D {
        x_range: right.into(),
        y_range: down.into(),
    };
    to.set(&view, "VisualBounds2D", &VisualBounds2D::new(shown))?;
    to.set(&view, "Background", &plain_background())?;
    Ok(view)
}

/// Hides a folder of a view until it is switched on.
fn hide(to: &mut Panes, view: &Pane, folder: EntityPath) -> Logged {
    let hidden = EntityBehavior::new().with_visible(false);
    to.set_of(view, &folder, &hidden)
}

fn volume_view(to: &mut Panes, canvas: &Canvas, hidden: EntityPath) -> Logged<Pane> {
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
    hide(to, &volume, hidden)?;
    Ok(volume)
}

/// Room for a legend with the names of the targets, in a plot as wide as half the window of
/// 1280 × 800, as a part of the time.
fn legend_room(canvas: &Canvas) -> f64 {
    let names = canvas.scenario.targets.iter();
    let letters = names.map(|target| target.name.chars().count()).max();
    let pixels = 44.0 + 6.4 * letters.unwrap_or(0).max("safety margin".len()) as f64;
    let share = (pixels / 520.0).min(0.6);
    share / (1.0 - share)
}

/// The panels of plots over the whole time, with room for their legends beside the curves, as a
/// part of the time.
fn plot_views(to: &mut Panes, canvas: &Canvas, plots: &[Plot], room: f64) -> Logged<Vec<Pane>> {
    let legend = PlotLegend::new().with_corner(Corner2D::RightTop);
    let titled = plots
        .iter()
        .filter_map(|plot| Some((plot, plot.title.as_ref()?)));
    let panel = |(plot, title): (&Plot, &String)| {
        let view = to.view::<TimeSeriesView>(title, plot.entity)?;
        to.set(&view, "PlotLegend", &legend)?;
        to.set(&view, "TimeAxis", &time_axis(canvas, room))?;
        if let Some(range) = plot.range {
            to.set(&view, "ScalarAxis", &ScalarAxis::new().with_range(range))?;
        }
        Ok(view)
    };
    titled.map(panel).collect()
}

/// From the start to the end, with a margin and a part of the time more.
fn time_axis(canvas: &Canvas, more: f64) -> TimeAxis {
    let nanoseconds =
        |seconds: f64| TimeRangeBoundary::Absolute(((seconds * 1e9).round() as i64).into());
    TimeAxis::new().with_view_range(TimeRange {
        start: nanoseconds(-0.02 * canvas.end),
        end: nanoseconds((1.02 + more) * canvas.end),
    })
}

fn velocity_view(to: &mut Panes, model: &ViewModel) -> Logged<Pane> {
    let limit = 1.05 * velocities::limit(model);
    let name = "Velocity obstacles (m/s, north up)";
    plane_view(to, (name, VELOCITIES), [[-limit, limit]; 2])
}

/// The roles over time and the fraction of the height that they need; `None` without a lane.
fn rules_view(to: &mut Panes, canvas: &Canvas, lanes: usize) -> Logged<Option<(Pane, f32)>> {
    if lanes == 0 {
        return Ok(None);
    }
    let name = "Rules: roles over time, and what is broken";
    let view = to.view::<StateTimelineView>(name, ROLES)?;
    to.set(&view, "TimeAxis", &time_axis(canvas, 0.0))?;
    let share = LANES_HEAD + LANE * lanes.min(MOST_LANES) as f32;
    Ok(Some((view, share)))
}

/// Fractions of the window's height for the head of the lanes and for each lane, and how many lanes
/// are seen without scrolling.
const LANES_HEAD: f32 = 0.1;
const LANE: f32 = 0.034;
const MOST_LANES: usize = 5;
