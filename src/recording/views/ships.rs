//! Moving parts of the chart: ships and the sections of their sets.

use rerun::{
    AsComponents, Color, EntityPath, LineStrips2D, Points2D, Quaternion, TimeColumn, Transform3D,
};

use super::rules::{Judged, name_with_role};
use crate::colregs::SteadyShip;
use crate::frame::{Pose, Vector};
use crate::geometry::{ConvexPolygon, Window};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::recording::canvas::{
    Canvas, Labels, Lines, ShownMotion, Strip, ViewModel, flat, labelled, leader_style, lines,
    points, round_down_time, strip_columns, style,
};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, MAP, TIMELINE, TRAILS, path};
use crate::target::{ShipTrack, Target};
use crate::vessel::Hull;

/// How sets of a kind are shown, below a folder of the chart and of the volume.
pub struct SetKind {
    pub folder: &'static str,
    /// Strength of the colour of its lines, of 1.
    strength: f32,
    pub radius: f32,
    /// Opacity of its body, of 255.
    pub alpha: u8,
}

pub const HARD: SetKind = SetKind {
    folder: "hard_sets",
    strength: 1.0,
    radius: 1.6,
    alpha: 36,
};

/// Thinner and fainter than the hard ones.
pub const DOMAIN: SetKind = SetKind {
    folder: "domain_sets",
    strength: 0.75,
    radius: 0.7,
    alpha: 16,
};

/// The sets of the targets with their kinds and colours.
pub fn shown_sets<'c>(canvas: &'c Canvas) -> impl Iterator<Item = (SetKind, &'c Obstacle, Color)> {
    canvas
        .sets
        .iter()
        .enumerate()
        .flat_map(move |(index, sets)| {
            let with_domain = canvas.with_domain(sets).map(|set| (DOMAIN, set));
            let kinds = with_domain.into_iter().chain([(HARD, &sets.hard)]);
            kinds.map(move |(kind, set)| (kind, set, canvas.target_color(index)))
        })
}

/// Own ship on one of the motions that are shown.
#[derive(Debug, Clone)]
pub struct DrawnShip<'a> {
    pub motion: ShownMotion<'a>,
    /// Shown at it on the chart, or, among several, when it is pointed at.
    pub name: String,
    pub color: Color,
}

/// A ship, or an explicit set, as the chart shows it at a time.
#[derive(Debug)]
pub struct Sighted {
    pub place: Vector,
    /// The hull, or the set.
    pub outline: ConvexPolygon,
    symbol: Option<Strip>,
    /// Metres; 0 of a set.
    beam: f64,
    /// The end of the speed vector.
    tip: Vector,
    /// True for an explicit set, which own ship may not enter with its centre.
    pub is_set: bool,
}

impl Sighted {
    /// A ship in a pose, with its velocity over ground.
    pub fn ship(canvas: &Canvas, hull: &Hull, (pose, velocity): (Pose, Vector)) -> Self {
        let place = pose.position;
        Self {
            place,
            outline: hull.polygon(&pose),
            symbol: symbol(canvas, hull, &pose),
            beam: hull.beam,
            tip: place + velocity * vector_seconds(canvas),
            is_set: false,
        }
    }

    pub fn set(place: Vector, outline: ConvexPolygon) -> Self {
        Self {
            place,
            outline,
            symbol: None,
            beam: 0.0,
            tip: place,
            is_set: true,
        }
    }

    /// Own ship on a motion.
    pub fn own(canvas: &Canvas, motion: &ShownMotion, time: f64) -> Self {
        let own = SteadyShip::new(motion.pose_at(time), motion.speed_at(time));
        Self::ship(
            canvas,
            &canvas.scenario.own_ship.hull,
            (own.pose, own.velocity()),
        )
    }

    /// A target where it is expected.
    pub fn target(canvas: &Canvas, target: &Target, time: f64) -> Option<Self> {
        if let Some(ship) = target.ship() {
            let there = SteadyShip::on_track(ship, time);
            return Some(Self::ship(
                canvas,
                &ship.hull,
                (there.pose, there.velocity()),
            ));
        }
        let outline = target.sets()?.outer_section(time);
        Some(Self::set(target.position_at(time), outline))
    }

    /// The outline, and the symbol of a small ship.
    pub fn strips(&self) -> impl Iterator<Item = Strip> {
        std::iter::once(outline(&self.outline)).chain(self.symbol.clone())
    }

    pub fn vector(&self) -> Strip {
        [self.place, self.tip].map(flat).to_vec()
    }

    /// Areas that a label has to leave free.
    pub fn covers(&self) -> Window {
        let corners = self.symbol.iter().flatten();
        let corners = corners.map(|&[east, north]| Vector::new(east.into(), north.into()));
        let corners: Vec<Vector> = corners
            .chain(self.outline.vertices().iter().copied())
            .collect();
        let around = Window::around(&corners).filter(|_| !self.is_set);
        around.unwrap_or(Window::at(self.place))
    }
}

/// The ships that a recording shows, own ships first.
pub struct Ships<'a> {
    /// One per ship.
    pub colors: Vec<Color>,
    /// The ships at every cursor time; none where one of them is nowhere.
    pub rows: Vec<Vec<Sighted>>,
    /// The ships at any time.
    pub at: Box<dyn Fn(f64) -> Option<Vec<Sighted>> + 'a>,
}

impl<'a> Ships<'a> {
    /// Targets behind own ships. `at` is the ships at a time.
    pub fn new(
        canvas: &Canvas,
        own: impl IntoIterator<Item = Color>,
        at: impl Fn(f64) -> Option<Vec<Sighted>> + 'a,
    ) -> Self {
        let targets = 0..canvas.scenario.targets.len();
        let others = targets.map(|index| canvas.target_color(index));
        let times = canvas.cursor_times.iter();
        Self {
            colors: own.into_iter().chain(others).collect(),
            rows: times.map(|&time| at(time).unwrap_or_default()).collect(),
            at: Box::new(at),
        }
    }

    /// Own ships on their motions, and the targets where they are expected.
    pub fn expected(canvas: &'a Canvas, own: &'a [DrawnShip]) -> Self {
        let colors = own.iter().map(|own| own.color);
        Self::new(canvas, colors, move |time| sighted(canvas, own, time))
    }

    /// Labels keep off their tracks.
    pub fn keep_off(&self, labels: &mut Labels) {
        for index in 0..self.colors.len() {
            let track = self.rows.iter().filter_map(|row| row.get(index));
            let beam = track.clone().next().map_or(0.0, |ship| ship.beam);
            labels.keep_off_track(beam, track.map(|ship| ship.place));
        }
    }

    /// All places, and their number at every cursor time.
    pub fn places(&self) -> (impl Iterator<Item = Vector>, Vec<usize>) {
        let places = self.rows.iter().flatten().map(|ship| ship.place);
        (places, self.rows.iter().map(Vec::len).collect())
    }
}

pub fn log_ships(rec: &mut Recorder, model: &ViewModel, ships: &Ships) -> Logged {
    log_others(rec, model)?;
    log_own_ship(rec, model, path(&[MAP, "own_ship"]), &own_ship(model))?;
    log_trails(rec, model, ships, TRAIL_RADIUS)
}

/// Own ship of a run.
pub fn own_ship<'a>(model: &ViewModel<'a>) -> DrawnShip<'a> {
    let name = if model.motion.is_planned() {
        "Own ship"
    } else {
        "Own ship (no plan)"
    };
    DrawnShip {
        motion: model.motion,
        name: name.to_owned(),
        color: style::OWN_SHIP,
    }
}

/// Logs the names of own ship, `own` at a time, and of the targets with own ship's role toward them.
pub fn log_names_with_roles(
    rec: &mut Recorder,
    canvas: &Canvas,
    labels: &Labels,
    ships: &Ships,
    own: impl Fn(f64) -> String,
    judged: &[Judged],
) -> Logged {
    let targets = &canvas.scenario.targets;
    log_names(rec, canvas, labels, (0, ships), |index, time| {
        match index.checked_sub(1) {
            None => own(time),
            Some(index) => name_with_role(judged, &targets[index].name, time),
        }
    })
}

/// Own ships and targets at a time.
pub fn sighted(canvas: &Canvas, own: &[DrawnShip], time: f64) -> Option<Vec<Sighted>> {
    let targets = canvas.scenario.targets.iter();
    let own = own
        .iter()
        .map(|own| Some(Sighted::own(canvas, &own.motion, time)));
    own.chain(targets.map(|target| Sighted::target(canvas, target, time)))
        .collect()
}

/// Logs names beside ships at every cursor time: of those from the `first` on.
/// `text` is that of the ship of an index at a time.
pub fn log_names(
    rec: &mut Recorder,
    canvas: &Canvas,
    labels: &Labels,
    (first, ships): (usize, &Ships),
    text: impl Fn(usize, f64) -> String,
) -> Logged {
    let (mut anchors, mut texts) = (Vec::new(), Vec::new());
    let (mut names, mut leaders) = (Vec::new(), Vec::new());
    let mut last = vec![None; ships.colors.len()];
    for (&time, row) in canvas.cursor_times.iter().zip(&ships.rows) {
        let mut labels = labels.without_ships();
        for ship in row {
            labels.keep_off(ship.covers());
            labels.keep_off_line(vec![ship.place, ship.tip]);
        }
        let before = anchors.len();
        let mut led = Vec::new();
        for (index, ship) in row.iter().enumerate().skip(first) {
            let text = text(index, time);
            let Some(placed) = labels.place(&text, ship.place, last[index]) else {
                continue;
            };
            last[index] = Some(placed.number);
            anchors.push(placed.anchor);
            texts.push(text);
            led.extend(placed.leader.map(Vec::from));
        }
        names.push(anchors.len() - before);
        leaders.push(led);
    }
    let colors = ships.colors[first..].iter().copied();
    let points = points(style::CHART_TEXT, 0.0)
        .with_colors(colors)
        .with_show_labels(true);
    let leader_style = leader_style();
    let style: [&dyn AsComponents; 2] = [&points, &leader_style];
    let anchors = Points2D::update_fields()
        .with_positions(anchors)
        .with_labels(texts)
        .columns(names)?;
    let columns = anchors.chain(strip_columns(leaders)?);
    let times = canvas.cursor_column();
    rec.log_moving(path(&[MAP, "names"]), times, &style, columns)
}

pub fn log_others(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    for (kind, set, color) in shown_sets(canvas) {
        let style = lines(style::toward_background(color, kind.strength), kind.radius);
        let entity = path(&[MAP, kind.folder, set.name()]);
        log_sections(rec, canvas, entity, set, &style)?;
    }
    for (index, target) in canvas.scenario.targets.iter().enumerate() {
        log_target(rec, canvas, index, target)?;
    }
    Ok(())
}

/// Logs the outline of the section at every cursor time.
pub fn log_sections(
    rec: &mut Recorder,
    canvas: &Canvas,
    entity: EntityPath,
    set: &Obstacle,
    style: &LineStrips2D,
) -> Logged {
    log_strips(rec, canvas, entity, style, |time| {
        vec![outline(&set.outer_section(time))]
    })
}

/// Logs lines at every cursor time.
pub fn log_strips(
    rec: &mut Recorder,
    canvas: &Canvas,
    entity: EntityPath,
    style: &LineStrips2D,
    at: impl Fn(f64) -> Vec<Strip>,
) -> Logged {
    let columns = strip_columns(canvas.cursor_times.iter().map(|&time| at(time)))?;
    rec.log_moving(entity, canvas.cursor_column(), style, columns)
}

pub fn outline(polygon: &ConvexPolygon) -> Strip {
    let mut strip: Strip = polygon.vertices().iter().copied().map(flat).collect();
    strip.extend(strip.first().copied());
    strip
}

/// Logs a target. The hull and the speed vector of one that keeps its course are drawn once and only
/// move; on a known route they also turn.
fn log_target(rec: &mut Recorder, canvas: &Canvas, index: usize, target: &Target) -> Logged {
    let entity = path(&[MAP, "targets", &target.name]);
    let color = canvas.target_color(index);
    let places = canvas.cursor_times.iter().map(|&t| target.position_at(t));
    let turning = target.ship().filter(|ship| !ship.route.is_empty());
    if let Some(ship) = turning {
        let style = lines(color, 1.0).with_radii(DRAWN_RADII.map(style::points));
        let drawn = canvas.cursor_times.iter();
        let drawn = strip_columns(drawn.map(|&time| drawn_at(canvas, ship, time)))?;
        rec.send_columns(entity.clone(), Some(canvas.cursor_column()), drawn)?;
        return log_places(rec, canvas, entity, &style, places);
    }
    let mut lines = Lines::default();
    if let Some(ship) = target.ship() {
        for (strip, radius) in drawn_at(canvas, ship, 0.0).into_iter().zip(DRAWN_RADII) {
            lines.add(strip, color, radius);
        }
    }
    log_places(rec, canvas, entity, &lines.archetype(), places)
}

/// Radii of the lines of [`drawn_at`], points.
const DRAWN_RADII: [f32; 3] = [1.0, 1.0, 1.2];

/// Hull, speed vector, and the symbol of a small ship, about its place at a time.
fn drawn_at(canvas: &Canvas, ship: &ShipTrack, time: f64) -> Vec<Strip> {
    let (pose, speed) = ship.nominal_at(time);
    let here = Pose::new(Vector::zeros(), pose.heading);
    let tip = here.ahead() * speed * vector_seconds(canvas);
    let lines = [
        outline(&ship.hull.polygon(&here)),
        vec![[0.0, 0.0], flat(tip)],
    ];
    let symbol = symbol(canvas, &ship.hull, &here);
    lines.into_iter().chain(symbol).collect()
}

/// Logs own ship's place, and below it its hull and speed vector. The name is shown where it is
/// pointed at.
pub fn log_own_ship(
    rec: &mut Recorder,
    canvas: &Canvas,
    entity: EntityPath,
    own: &DrawnShip,
) -> Logged {
    let name = labelled([[0.0, 0.0]], own.color, TRAIL_RADIUS, [own.name.as_str()])
        .with_show_labels(false);
    let times = canvas.cursor_times.iter();
    let places = times.map(|&t| own.motion.pose_at(t).position);
    log_places(rec, canvas, entity.clone(), &name, places)?;
    log_own_hull(rec, canvas, entity.join(&EntityPath::from("hull")), own)
}

fn log_places(
    rec: &mut Recorder,
    canvas: &Canvas,
    entity: EntityPath,
    style: &dyn AsComponents,
    places: impl Iterator<Item = Vector>,
) -> Logged {
    let raised = places.map(|p| [p.x as f32, p.y as f32, 0.0]);
    let columns = Transform3D::update_fields()
        .with_many_translation(raised)
        .columns_of_unit_batches()?;
    rec.log_moving(entity, canvas.cursor_column(), style, columns)
}

/// Radius of the dots of trails, points.
pub const TRAIL_RADIUS: f32 = 2.4;

/// Logs a dot per ship and cursor time; the layout shows those up to the cursor. The last one marks
/// the ship at any zoom.
pub fn log_trails(rec: &mut Recorder, canvas: &Canvas, ships: &Ships, radius: f32) -> Logged {
    let style = points(style::OWN_SHIP, radius).with_colors(ships.colors.iter().copied());
    let (places, lengths) = ships.places();
    let columns = Points2D::update_fields()
        .with_positions(places.map(flat))
        .columns(lengths)?;
    rec.log_moving(path(&[TRAILS]), canvas.cursor_column(), &style, columns)
}

fn log_own_hull(
    rec: &mut Recorder,
    canvas: &Canvas,
    entity: EntityPath,
    own: &DrawnShip,
) -> Logged {
    let style = lines(own.color, 1.0).with_radii([1.2, 1.0, 1.2].map(style::points));
    let mut times = own.motion.speed_changes();
    times.extend(&canvas.cursor_times);
    times.sort_by(f64::total_cmp);
    times.dedup();
    let hull = canvas.scenario.own_ship.hull;
    let ahead = Pose::new(Vector::zeros(), 0.0);
    let symbol = symbol(canvas, &hull, &ahead);
    let hull = outline(&hull.polygon(&ahead));
    let drawn = strip_columns(times.iter().map(|&t| {
        let tip = (own.motion.speed_at(t) * vector_seconds(canvas)) as f32;
        let drawn = [hull.clone(), vec![[0.0, 0.0], [tip, 0.0]]];
        drawn.into_iter().chain(symbol.clone()).collect()
    }))?;
    let turns = times
        .iter()
        .map(|&t| rotation(own.motion.pose_at(t).heading));
    let turns = Transform3D::update_fields()
        .with_many_quaternion(turns)
        .columns_of_unit_batches()?;
    let times = TimeColumn::new_duration_secs(TIMELINE, times.iter().copied());
    rec.log_moving(entity, times, &style, drawn.chain(turns))
}

/// The symbol of a ship whose hull is too small to see when the chart is opened.
fn symbol(canvas: &Canvas, hull: &Hull, pose: &Pose) -> Option<Strip> {
    let length = SYMBOL_PIXELS * canvas.pixel();
    let corner = |&[x, y]: &[f64; 2]| flat(pose.world_coordinates(Vector::new(x, y) * length));
    (hull.length < length).then(|| SYMBOL.iter().map(corner).collect())
}

/// Length of a symbol.
const SYMBOL_PIXELS: f64 = 26.0;

/// A closed line, in lengths of the symbol.
const SYMBOL: [[f64; 2]; 6] = [
    [0.6, 0.0],
    [0.1, 0.2],
    [-0.4, 0.2],
    [-0.4, -0.2],
    [0.1, -0.2],
    [0.6, 0.0],
];

/// How far ahead a speed vector reaches, seconds.
pub fn vector_seconds(canvas: &Canvas) -> f64 {
    round_down_time(canvas.end / 6.0)
}

/// About the vertical, counter-clockwise seen from above.
fn rotation(heading: f64) -> Quaternion {
    let (sin, cos) = (heading / 2.0).sin_cos();
    Quaternion::from_xyzw([0.0, 0.0, sin as f32, cos as f32])
}
