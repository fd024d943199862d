//! How the viewer opens the recording: chart at left, volume, curves, and the verdict in words.

use rerun::blueprint::{
    Blueprint, BlueprintPanel, ContainerLike, Grid, Horizontal, SelectionPanel, Spatial2DView,
    Spatial3DView, StateTimelineView, TextDocumentView, TimePanel, TimeSeriesView, Vertical,
};
use rerun::datatypes::{TimeRange, TimeRangeBoundary, VisibleTimeRange};
use rerun::external::re_log_types::{BlueprintActivationCommand, LogMsg, StoreKind, TimelineName};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EntityBehavior, EyeControls3D, LineGrid3D, PlotLegend, ScalarAxis, TimeAxis,
    VisibleTimeRanges, VisualBounds2D,
};
use rerun::external::re_sdk_types::blueprint::components::{
    BackgroundKind, Corner2D, LoopMode, PanelState, PlayState,
};
use rerun::log::{Chunk, ChunkError};
use rerun::{
    AsComponents, EntityPath, RecordingStream, RecordingStreamBuilder, RecordingStreamResult,
};

use super::chart::legend_height;
use super::curves::{CLEARANCE, COURSE, Curves, MARGIN, RISK, SPEED};
use super::explored::BLOCKED;
use super::scene::{Scene, Stage};
use super::{
    APPLICATION, CHART, EXPLORED, PATH_TIME, RULES, SUMMARY, TIMELINE, TRAILS, VELOCITIES, VOLUME,
    forces, path, path_time, rules, style, velocities,
};
use crate::frame::{Vector, knots_from_mps, to_starboard};

/// Seconds in which the whole run is played.
const PLAY_S: f64 = 25.0;

/// The timeline of the store that the layout is in: what a user changes comes later on it.
const LAYOUT_TIMELINE: &str = "blueprint";

/// Metres that a plot of distances shows at least, or half of the sea that is shown.
const LEAST_RANGE_M: f64 = 50.0;

/// Properties of views, with the path they are logged at.
type Properties = Vec<(String, Box<dyn AsComponents>)>;

/// Lays out all views and makes that the recording's blueprint.
pub fn send_blueprint(
    rec: &RecordingStream,
    scene: &Scene,
    curves: &Curves,
) -> RecordingStreamResult<()> {
    let mut properties = Properties::new();
    let chart = chart_view(scene, 1, &[path(&[EXPLORED])], &mut properties);
    let blocked = path(&[VOLUME, "explored", BLOCKED]);
    let volume = volume_view(scene, &[blocked], &mut properties);
    let summary = TextDocumentView::new("Verdict").with_origin(SUMMARY).into();
    let mut small = Vec::from(curve_views(scene, curves, &mut properties));
    if forces::steered(scene).is_some() {
        small.extend(force_views(scene, &mut properties));
    }
    small.push(velocity_view(scene, &mut properties));
    let mut left = vec![chart];
    let mut left_shares = vec![0.66];
    if let Some((rules, share)) = rules_view(scene, &mut properties) {
        left.push(rules);
        left_shares = vec![0.66 - share, share];
    }
    left.push(summary);
    left_shares.push(0.34);
    let left = Vertical::new(left).with_row_shares(left_shares);
    let mut views = vec![volume];
    views.extend(path_time_view(scene, &mut properties));
    let mut shares = vec![0.5 / views.len() as f32; views.len()];
    views.push(Grid::new(small).with_grid_columns(2).into());
    shares.push(0.5);
    let right = Vertical::new(views).with_row_shares(shares);
    let root = Horizontal::new([left.into(), right.into()]).with_column_shares(vec![0.54, 0.46]);
    open_with(rec, scene, root, &properties)
}

/// The layout of a comparison: chart and volume side by side, below them the table and the curves. `hidden` are folders on the
/// chart and in the volume; `rows` those of the legend, `plots` the name, the entity and the range of each plot.
pub fn send_comparison_blueprint(
    rec: &RecordingStream,
    stage: &Stage,
    rows: usize,
    hidden: &[Vec<EntityPath>; 2],
    plots: &[(&str, &str, [f64; 2])],
) -> RecordingStreamResult<()> {
    let mut properties = Properties::new();
    let chart = chart_view(stage, rows, &hidden[0], &mut properties);
    let volume = volume_view(stage, &hidden[1], &mut properties);
    let table = TextDocumentView::new("Comparison").with_origin(SUMMARY);
    let plots: Vec<ContainerLike> = plots
        .iter()
        .map(|(name, origin, range)| {
            // the legend of the chart is theirs, too
            let legend = PlotLegend::new().with_visible(false);
            plot_view(stage, (name, origin), *range, legend, &mut properties)
        })
        .collect();
    let pictures = Horizontal::new([chart, volume]).with_column_shares(vec![0.5, 0.5]);
    let below = Horizontal::new([table.into(), Vertical::new(plots).into()])
        .with_column_shares(vec![0.56, 0.44]);
    let root = Vertical::new([pictures.into(), below.into()]).with_row_shares(vec![0.62, 0.38]);
    open_with(rec, stage, root, &properties)
}

/// The panels around the views, paused at the start.
fn open_with(
    rec: &RecordingStream,
    stage: &Stage,
    root: impl Into<ContainerLike>,
    properties: &Properties,
) -> RecordingStreamResult<()> {
    let blueprint = Blueprint::new(root)
        .with_auto_views(false)
        .with_auto_layout(false)
        .with_blueprint_panel(BlueprintPanel::from_state(PanelState::Hidden))
        .with_selection_panel(SelectionPanel::from_state(PanelState::Hidden))
        .with_time_panel(
            TimePanel::new()
                .with_state(PanelState::Collapsed)
                .with_timeline(TIMELINE)
                .with_playback_speed((stage.end / PLAY_S).round().max(1.0))
                .with_play_state(PlayState::Paused)
                .with_loop_mode(LoopMode::All),
        );
    send(rec, blueprint, properties)
}

/// Adds a property to a view and returns the view.
fn with(
    view: impl Into<ContainerLike>,
    properties: &mut Properties,
    added: Vec<(&str, Box<dyn AsComponents>)>,
) -> ContainerLike {
    let view = view.into();
    if let ContainerLike::View(inner) = &view {
        for (name, property) in added {
            properties.push((format!("{}/{name}", inner.blueprint_path()), property));
        }
    }
    view
}

fn plain_background() -> Box<dyn AsComponents> {
    Box::new(Background::new(BackgroundKind::SolidColor).with_color(style::background()))
}

fn hidden() -> Box<dyn AsComponents> {
    Box::new(EntityBehavior::new().with_visible(false))
}

/// Where a view keeps what it does with an entity.
fn behavior(entity: &EntityPath) -> String {
    let entity = entity.to_string();
    let entity = entity.trim_start_matches('/');
    format!("ViewContents/overrides/{entity}/visualizers")
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
    stage: &Stage,
    legend_rows: usize,
    hidden_folders: &[EntityPath],
    properties: &mut Properties,
) -> ContainerLike {
    let (low, high) = (stage.bounds.low, stage.bounds.high);
    // the view's own axis points down: north is negative there
    let shown = rerun::datatypes::Range2D {
        x_range: [low.x, high.x].into(),
        y_range: [-high.y, -low.y + legend_height(stage, legend_rows)].into(),
    };
    let chart = with(
        Spatial2DView::new("Chart, north up").with_origin(CHART),
        properties,
        vec![
            ("VisualBounds2D", Box::new(VisualBounds2D::new(shown))),
            ("Background", plain_background()),
            (&behavior(&path(&[TRAILS])), Box::new(up_to_cursor())),
        ],
    );
    without(chart, properties, hidden_folders)
}

/// The view with some folders of it hidden until they are asked for.
fn without(
    view: ContainerLike,
    properties: &mut Properties,
    folders: &[EntityPath],
) -> ContainerLike {
    folders.iter().fold(view, |view, folder| {
        with(view, properties, vec![(&behavior(folder), hidden())])
    })
}

fn volume_view(
    stage: &Stage,
    hidden_folders: &[EntityPath],
    properties: &mut Properties,
) -> ContainerLike {
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
    let volume = with(
        Spatial3DView::new("Space-time: time upward").with_origin(VOLUME),
        properties,
        vec![
            (
                "EyeControls3D",
                Box::new(
                    EyeControls3D::new()
                        .with_position(eye)
                        .with_look_target(middle)
                        .with_eye_up([0.0, 0.0, 1.0]),
                ),
            ),
            (
                "LineGrid3D",
                Box::new(LineGrid3D::new().with_visible(false)),
            ),
            ("Background", plain_background()),
        ],
    );
    without(volume, properties, hidden_folders)
}

fn curve_views(scene: &Scene, curves: &Curves, properties: &mut Properties) -> [ContainerLike; 5] {
    let margin = scene.scenario.own_ship.safety_margin;
    let views = [
        (
            "Clearance between hulls (m)",
            CLEARANCE,
            near_zero(scene, curves.farthest_passage(), margin),
        ),
        (
            "Margin to the sets (m)",
            MARGIN,
            near_zero(scene, curves.least_margin(), margin),
        ),
        ("Risk", RISK, [-0.05, 1.2]),
        (
            "Speed (kn)",
            SPEED,
            [
                0.0,
                1.4 * knots_from_mps(scene.scenario.own_ship.max_speed()),
            ],
        ),
        ("Course (deg)", COURSE, course_range(curves)),
    ];
    views.map(|(name, origin, range)| {
        // curves of distances are low where they matter
        let legend = PlotLegend::new().with_corner(Corner2D::RightTop);
        plot_view(scene, (name, origin), range, legend, properties)
    })
}

fn plot_view(
    stage: &Stage,
    (name, origin): (&str, &str),
    range: [f64; 2],
    legend: PlotLegend,
    properties: &mut Properties,
) -> ContainerLike {
    let times = TimeAxis::new().with_view_range(whole_time(stage));
    let range = rerun::datatypes::Range1D(range);
    with(
        TimeSeriesView::new(name).with_origin(origin),
        properties,
        vec![
            ("PlotLegend", Box::new(legend)),
            ("TimeAxis", Box::new(times)),
            ("ScalarAxis", Box::new(ScalarAxis::new().with_range(range))),
        ],
    )
}

/// Of a plan of forces: what the ship does, and what makes her do it.
fn force_views(scene: &Scene, properties: &mut Properties) -> [ContainerLike; 2] {
    let names = [
        ("Velocity (m/s, deg/s)", forces::STATES),
        ("Forces (N, Nm)", forces::FORCES),
    ];
    names.map(|(name, origin)| {
        let legend = PlotLegend::new().with_corner(Corner2D::RightTop);
        let times = TimeAxis::new().with_view_range(whole_time(scene));
        with(
            TimeSeriesView::new(name).with_origin(origin),
            properties,
            vec![
                ("PlotLegend", Box::new(legend)),
                ("TimeAxis", Box::new(times)),
            ],
        )
    })
}

fn velocity_view(scene: &Scene, properties: &mut Properties) -> ContainerLike {
    let limit = 1.05 * velocities::limit(scene);
    let shown = rerun::datatypes::Range2D {
        x_range: [-limit, limit].into(),
        y_range: [-limit, limit].into(),
    };
    with(
        Spatial2DView::new("Velocity obstacles (m/s, north up)").with_origin(VELOCITIES),
        properties,
        vec![
            ("VisualBounds2D", Box::new(VisualBounds2D::new(shown))),
            ("Background", plain_background()),
        ],
    )
}

/// The roles over time and the share of the height that they need; nothing where no rule asks anything.
fn rules_view(scene: &Scene, properties: &mut Properties) -> Option<(ContainerLike, f32)> {
    let lanes = rules::height(scene);
    if lanes == 0 {
        return None;
    }
    let times = TimeAxis::new().with_view_range(whole_time(scene));
    let view = with(
        StateTimelineView::new("Rules: roles over time, and what is broken").with_origin(RULES),
        properties,
        vec![("TimeAxis", Box::new(times))],
    );
    let share = LANES_HEAD + LANE * lanes.min(MOST_LANES) as f32;
    Some((view, share))
}

/// Of the height of the window: what the head of the lanes takes, each of them, and how many are seen without scrolling.
const LANES_HEAD: f32 = 0.075;
const LANE: f32 = 0.03;
const MOST_LANES: usize = 5;

/// The diagram of a path-time plan, beside the volume.
fn path_time_view(scene: &Scene, properties: &mut Properties) -> Option<ContainerLike> {
    let diagram = scene.run.planned.path_time.as_deref()?;
    let frame = path_time::Frame::of(diagram);
    let height = frame.top * frame.rise;
    // the view's own axis points down: time is negative there
    let shown = rerun::datatypes::Range2D {
        x_range: [-0.08 * frame.length, 1.04 * frame.length].into(),
        y_range: [-1.04 * height, 0.08 * height].into(),
    };
    Some(with(
        Spatial2DView::new("Path and time: time upward").with_origin(PATH_TIME),
        properties,
        vec![
            ("VisualBounds2D", Box::new(VisualBounds2D::new(shown))),
            ("Background", plain_background()),
        ],
    ))
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

/// The API has no setters for most properties of views: they are logged into the blueprint's own
/// store, before one activation.
fn send(
    rec: &RecordingStream,
    blueprint: Blueprint,
    properties: &Properties,
) -> RecordingStreamResult<()> {
    let (_stream, store) = RecordingStreamBuilder::new(APPLICATION)
        .enabled(true)
        .with_blueprint(blueprint)
        .memory()?;
    let mut messages: Vec<LogMsg> = store
        .take()
        .into_iter()
        .filter(|m| m.store_id().kind() == StoreKind::Blueprint)
        .filter(|m| !matches!(m, LogMsg::BlueprintActivationCommand(_)))
        .map(without_clock)
        .collect::<Result<_, _>>()?;
    let Some(id) = messages.first().map(|m| m.store_id().clone()) else {
        return Ok(());
    };
    let (extra, store) = RecordingStreamBuilder::new(APPLICATION)
        .enabled(true)
        .recording_id(id.recording_id().clone())
        .blueprint()
        .memory()?;
    extra.set_log_time_enabled(false);
    extra.set_log_tick_enabled(false);
    extra.set_time_sequence(LAYOUT_TIMELINE, 0);
    for (path, property) in properties {
        extra.log(path.as_str(), property.as_ref())?;
    }
    let only_data = |m: &LogMsg| matches!(m, LogMsg::ArrowMsg(..));
    messages.extend(store.take().into_iter().filter(only_data));
    rec.send_blueprint(
        messages,
        BlueprintActivationCommand {
            blueprint_id: id,
            make_active: true,
            make_default: true,
        },
    );
    Ok(())
}

/// A part of the layout without the time of day that the library writes beside it.
fn without_clock(message: LogMsg) -> Result<LogMsg, ChunkError> {
    let LogMsg::ArrowMsg(store, data) = message else {
        return Ok(message);
    };
    let kept = [TimelineName::from(LAYOUT_TIMELINE)].into_iter().collect();
    let chunk = Chunk::from_arrow_msg(&data)?.timelines_sliced(&kept);
    Ok(LogMsg::ArrowMsg(store, chunk.to_arrow_msg()?))
}
