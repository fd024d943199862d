//! Moving parts of the chart: ships and the sections of their sets.

use rerun::{
    AsComponents, Color, EntityPath, LineStrips2D, Points2D, Quaternion, TimeColumn, Transform3D,
};

use super::chart::Strip;
use super::rules::{Judged, name_with_role};
use crate::colregs::SteadyShip;
use crate::frame::{Pose, Vector};
use crate::geometry::{ConvexPolygon, Window};
use crate::obstacle::{Obstacle, SpaceTimeObstacle};
use crate::recording::canvas::{
    Canvas, Labels, Lines, ShownMotion, ViewModel, flat, labelled, leader_style, round_down_time,
    style,
};
use crate::recording::recorder::Recorder;
use crate::recording::{Logged, MAP, TIMELINE, TRAILS, path};
use crate::target::{ShipTrack, Target};
use crate::vessel::Hull;

pub const HARD_RADIUS: f32 = 1.6;
/// Line width of sets with a ship domain, thinner than that of the hard ones.
pub const DOMAIN_RADIUS: f32 = 0.7;

pub fn domain_color(canvas: &Canvas, index: usize) -> Color {
    style::toward_background(canvas.target_color(index), 0.75)
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
            tip: place + velocity * vector_seconds(canvas),
            is_set: false,
        }
    }

    pub fn set(place: Vector, outline: ConvexPolygon) -> Self {
        Self {
            place,
            outline,
            symbol: None,
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

pub fn log_ships(rec: &mut Recorder, model: &ViewModel) -> Logged {
    log_others(rec, model)?;
    let own = own_ship(model);
    log_own_ship(rec, model, path(&[MAP, "own_ship"]), &own)?;
    log_trails(rec, model, &[own])
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

/// Logs the names of own ship, and of the targets with own ship's role toward them.
pub fn log_names_of_run(
    rec: &mut Recorder,
    model: &ViewModel,
    labels: &Labels,
    judged: &[Judged],
) -> Logged {
    let own = [own_ship(model)];
    let colors: Vec<Color> = ship_colors(model, &own).collect();
    let ships = |time| sighted(model, &own, time);
    log_names(
        rec,
        model,
        labels,
        (0, &colors),
        ships,
        |index, time| match index.checked_sub(1) {
            None => own[0].name.clone(),
            Some(index) => name_with_role(judged, &model.scenario.targets[index].name, time),
        },
    )
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

/// Logs names beside ships at every cursor time: of those from the `first` on, which have `colors`.
/// `text` is that of the ship of an index at a time.
pub fn log_names(
    rec: &mut Recorder,
    canvas: &Canvas,
    labels: &Labels,
    (first, colors): (usize, &[Color]),
    ships: impl Fn(f64) -> Option<Vec<Sighted>>,
    text: impl Fn(usize, f64) -> String,
) -> Logged {
    let (mut anchors, mut texts, mut leaders) = (Vec::new(), Vec::new(), Vec::new());
    let (mut names, mut led) = (Vec::new(), Vec::new());
    let mut last = vec![None; first + colors.len()];
    for &time in &canvas.cursor_times {
        let ships = ships(time).unwrap_or_default();
        let mut labels = labels.without_ships();
        for ship in &ships {
            labels.keep_off(ship.covers());
            labels.keep_off_line(vec![ship.place, ship.tip]);
        }
        let before = (anchors.len(), leaders.len());
        for (index, ship) in ships.iter().enumerate().skip(first) {
            let text = text(index, time);
            let Some(placed) = labels.place(&text, ship.place, last[index]) else {
                continue;
            };
            last[index] = Some(placed.number);
            anchors.push(placed.anchor);
            texts.push(text);
            leaders.extend(placed.leader);
        }
        names.push(anchors.len() - before.0);
        led.push(leaders.len() - before.1);
    }
    let points = Points2D::update_fields()
        .with_colors(colors.iter().copied())
        .with_radii([style::points(0.0)])
        .with_show_labels(true);
    let leader_style = leader_style();
    let style: [&dyn AsComponents; 2] = [&points, &leader_style];
    let anchors = Points2D::update_fields()
        .with_positions(anchors)
        .with_labels(texts)
        .columns(names)?;
    let leaders = LineStrips2D::update_fields()
        .with_strips(leaders)
        .columns(led)?;
    let times = canvas.cursor_column();
    rec.log_moving(path(&[MAP, "names"]), times, &style, anchors.chain(leaders))
}

pub fn log_others(rec: &mut Recorder, canvas: &Canvas) -> Logged {
    for (index, sets) in canvas.sets.iter().enumerate() {
        let name = sets.hard.name();
        if let Some(with_domain) = canvas.with_domain(sets) {
            let style = set_style(domain_color(canvas, index), DOMAIN_RADIUS);
            let entity = path(&[MAP, "domain_sets", name]);
            log_sections(rec, canvas, entity, with_domain, &style)?;
        }
        let style = set_style(canvas.target_color(index), HARD_RADIUS);
        let entity = path(&[MAP, "hard_sets", name]);
        log_sections(rec, canvas, entity, &sets.hard, &style)?;
    }
    for (index, target) in canvas.scenario.targets.iter().enumerate() {
        log_target(rec, canvas, index, target)?;
    }
    Ok(())
}

pub fn set_style(color: Color, radius: f32) -> LineStrips2D {
    LineStrips2D::update_fields()
        .with_colors([color])
        .with_radii([style::points(radius)])
}

/// Logs the outline of the section at every cursor time.
pub fn log_sections(
    rec: &mut Recorder,
    canvas: &Canvas,
    entity: EntityPath,
    set: &Obstacle,
    style: &LineStrips2D,
) -> Logged {
    log_outlines(rec, canvas, entity, style, |t| {
        outline(&set.outer_section(t))
    })
}

pub fn log_outlines(
    rec: &mut Recorder,
    canvas: &Canvas,
    entity: EntityPath,
    style: &LineStrips2D,
    at: impl Fn(f64) -> Strip,
) -> Logged {
    let columns = LineStrips2D::update_fields()
        .with_strips(canvas.cursor_times.iter().map(|&time| at(time)))
        .columns_of_unit_batches()?;
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
        let times = canvas.cursor_times.iter();
        let drawn: Vec<Vec<Strip>> = times.map(|&t| drawn_at(canvas, ship, t)).collect();
        let lengths: Vec<usize> = drawn.iter().map(Vec::len).collect();
        let columns = LineStrips2D::update_fields()
            .with_strips(drawn.into_iter().flatten())
            .columns(lengths)?;
        let style = LineStrips2D::update_fields()
            .with_colors([color])
            .with_radii(DRAWN_RADII.map(style::points));
        rec.send_columns(entity.clone(), Some(canvas.cursor_column()), columns)?;
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

pub fn ship_colors(canvas: &Canvas, own: &[DrawnShip]) -> impl Iterator<Item = Color> {
    let targets = 0..canvas.scenario.targets.len();
    let others = targets.map(|index| canvas.target_color(index));
    own.iter().map(|o| o.color).chain(others)
}

/// The places of own ships and targets at every cursor time, and their number at each.
pub fn ship_places(canvas: &Canvas, own: &[DrawnShip]) -> (Vec<Vector>, Vec<usize>) {
    let targets = &canvas.scenario.targets;
    let mut places = Vec::new();
    for &time in &canvas.cursor_times {
        places.extend(own.iter().map(|o| o.motion.pose_at(time).position));
        places.extend(targets.iter().map(|t| t.position_at(time)));
    }
    let lengths = vec![own.len() + targets.len(); canvas.cursor_times.len()];
    (places, lengths)
}

/// Radius of the dots of trails, points.
const TRAIL_RADIUS: f32 = 2.4;

/// Logs a dot per ship and cursor time; the layout shows those up to the cursor. The last one marks
/// the ship at any zoom.
pub fn log_trails(rec: &mut Recorder, canvas: &Canvas, own: &[DrawnShip]) -> Logged {
    let style = Points2D::update_fields()
        .with_colors(ship_colors(canvas, own))
        .with_radii([style::points(TRAIL_RADIUS)]);
    let (places, lengths) = ship_places(canvas, own);
    let columns = Points2D::update_fields()
        .with_positions(places.into_iter().map(flat))
        .columns(lengths)?;
    rec.log_moving(path(&[TRAILS]), canvas.cursor_column(), &style, columns)
}

fn log_own_hull(
    rec: &mut Recorder,
    canvas: &Canvas,
    entity: EntityPath,
    own: &DrawnShip,
) -> Logged {
    let style = LineStrips2D::update_fields()
        .with_colors([own.color])
        .with_radii([1.2, 1.0, 1.2].map(style::points));
    let mut times = own.motion.speed_changes();
    times.extend(&canvas.cursor_times);
    times.sort_by(f64::total_cmp);
    times.dedup();
    let hull = canvas.scenario.own_ship.hull;
    let ahead = Pose::new(Vector::zeros(), 0.0);
    let symbol = symbol(canvas, &hull, &ahead);
    let lines = 2 + usize::from(symbol.is_some());
    let hull = outline(&hull.polygon(&ahead));
    let strips = times.iter().flat_map(|&t| {
        let tip = (own.motion.speed_at(t) * vector_seconds(canvas)) as f32;
        let drawn = [hull.clone(), vec![[0.0, 0.0], [tip, 0.0]]];
        drawn.into_iter().chain(symbol.clone())
    });
    let drawn = LineStrips2D::update_fields()
        .with_strips(strips)
        .columns(vec![lines; times.len()])?;
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
