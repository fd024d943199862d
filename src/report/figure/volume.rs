//! The space-time body in the round: an axonometric view, time upward.

use super::outline::{Stroke, area, curve, sampled_boundary};
use super::panel::AREA;
use super::sections::{INITIAL, LATER, seconds};
use super::{Panel, Window};
use crate::frame::{Vector, direction, to_port};
use crate::geometry::ConvexPolygon;
use crate::obstacle::Obstacle;

/// Radians: how far the east axis is turned from the line of sight's right, and how far one looks down.
const AZIMUTH: f64 = 0.55;
const ELEVATION: f64 = 0.45;

/// Height of the time axis, of the longer side of the ground.
const HEIGHT: f64 = 0.9;

/// Sections that the body's outline is drawn from.
const SWEEP: usize = 48;

/// Marks of an axis, about.
const MARKS: f64 = 4.0;

/// Length of a mark, of the longer side of the ground.
const MARK: f64 = 0.015;

/// Around what is shown, of the greater side: room for the numbers.
const MARGIN: f64 = 0.1;

/// Pixels, to the right and up, from a mark to its number and from the middle or the end of an axis to its name: of the
/// axes of east, north and time.
const NUMBERS: [[f64; 2]; 3] = [[-8.0, -16.0], [6.0, -10.0], [-8.0, -4.0]];
const NAMES: [[f64; 2]; 3] = [[-54.0, -34.0], [2.0, 8.0], [-20.0, 12.0]];

/// Pixels of a figure of a number.
const FIGURE: f64 = 6.0;

/// The edges of the body.
const EDGE: Stroke = Stroke {
    colour: "#444444",
    width: 1.0,
    dashed: false,
};

/// The axes and the ground.
const AXIS: Stroke = Stroke {
    colour: "#000000",
    width: 1.0,
    dashed: false,
};
const GROUND: Stroke = Stroke {
    colour: "#bbbbbb",
    width: 0.7,
    dashed: false,
};

/// Of the body, and of a section: dark lines on light areas stay apart in grey.
const BODY: (&str, f64) = ("#9ecae1", 0.45);
const SHEET: (&str, f64) = ("#ffffff", 0.55);

/// The view: parallel lines stay parallel, and lengths along one axis keep their ratios.
struct View {
    low: Vector,
    high: Vector,
    /// Metres of height per second.
    rise: f64,
    /// Metres of the picture.
    pixel: f64,
}

impl View {
    /// Metres of the picture, to the right and up.
    fn at(&self, position: Vector, time: f64) -> Vector {
        let right = direction(AZIMUTH);
        let depth = to_port(right).dot(&position);
        Vector::new(
            right.dot(&position),
            depth * ELEVATION.sin() + self.rise * time * ELEVATION.cos(),
        )
    }
}

/// The body of a target from t = 0 to `end` seconds, seen from the south-east above, with its sections at `times`, and
/// with axes in metres and seconds.
pub fn volume_panel(title: &str, target: &Obstacle, times: &[f64], end: f64) -> Panel {
    let step = end / SWEEP as f64;
    let sweep = (0..=SWEEP).map(|i| step * i as f64);
    let boundary = |time: f64| sampled_boundary(&target.section(time));
    let body: Vec<(Vector, f64)> = sweep
        .flat_map(|time| boundary(time).into_iter().map(move |p| (p, time)))
        .collect();
    let ground = Window::around(body.iter().map(|b| b.0), 0.05);
    let side = ground.size().max();
    let mut view = View {
        pixel: 0.0,
        low: ground.low,
        high: ground.high,
        rise: HEIGHT * side / end,
    };
    let corners = [0.0, end].into_iter().flat_map(|time| {
        let (low, high) = (view.low, view.high);
        [
            low,
            Vector::new(high.x, low.y),
            high,
            Vector::new(low.x, high.y),
        ]
        .map(|p| view.at(p, time))
    });
    let shown = Window::around(corners, MARGIN);
    let mut panel = Panel::picture(title.to_owned(), shown);
    view.pixel = panel.window().size().x / AREA[0];
    axes(&mut panel, &view, side, end);
    // a slab after another: each is convex, all need not be
    for (from, to) in spans(target, end) {
        let seen = body
            .iter()
            .filter(|(_, time)| (from..=to).contains(time))
            .map(|(p, time)| view.at(*p, *time));
        let ends = [from, to].map(|time| boundary(time).into_iter().map(move |p| (p, time)));
        let ends = ends.into_iter().flatten().map(|(p, time)| view.at(p, time));
        let outline = ConvexPolygon::hull(&seen.chain(ends).collect::<Vec<_>>());
        if let Ok(outline) = outline {
            panel.plots.extend(area(&outline, BODY.0, BODY.1));
            panel.plots.push(curve(outline.vertices(), true, EDGE));
        }
    }
    if let Obstacle::Polytope(polytope) = target {
        for vertex in polytope.moving_vertices() {
            let edge = [0.0, end].map(|t| view.at(vertex.origin + vertex.velocity * t, t));
            panel.plots.push(curve(&edge, false, EDGE));
        }
    }
    for (i, time) in times.iter().enumerate() {
        let sheet: Vec<Vector> = boundary(*time).iter().map(|p| view.at(*p, *time)).collect();
        let filled = ConvexPolygon::hull(&sheet).ok();
        panel
            .plots
            .extend(filled.and_then(|f| area(&f, SHEET.0, SHEET.1)));
        let stroke = if i == 0 { INITIAL } else { LATER };
        panel.plots.push(curve(&sheet, true, stroke));
    }
    let list: Vec<String> = times.iter().skip(1).map(|t| seconds(*t)).collect();
    if let Some(first) = times.first() {
        panel.line_key(&format!("section at {} s", seconds(*first)), INITIAL);
    }
    if !list.is_empty() {
        panel.line_key(&format!("sections at {} s", list.join(", ")), LATER);
    }
    panel.line_key("edges of the body", EDGE);
    panel
}

/// Spans of time in which the body is convex.
fn spans(target: &Obstacle, end: f64) -> Vec<(f64, f64)> {
    match target {
        Obstacle::Slabs(obstacle) => obstacle
            .slabs()
            .iter()
            .filter(|slab| slab.start() < end)
            .map(|slab| (slab.start(), slab.end().min(end)))
            .collect(),
        Obstacle::Polytope(_) | Obstacle::Ellipsoid(_) => vec![(0.0, end)],
    }
}

/// The ground with its lines, and the three axes with marks, numbers and units.
fn axes(panel: &mut Panel, view: &View, side: f64, end: f64) {
    let (low, high) = (view.low, view.high);
    let mark = MARK * side;
    let line = |panel: &mut Panel, ends: [(Vector, f64); 2], stroke: Stroke| {
        let ends = ends.map(|(p, t)| view.at(p, t));
        panel.plots.push(curve(&ends, false, stroke));
    };
    let east_end = Vector::new(high.x, low.y);
    let offset = |[right, up]: [f64; 2]| Vector::new(right, up) * view.pixel;
    for east in marks(low.x, high.x) {
        let (near, far) = (Vector::new(east, low.y), Vector::new(east, high.y));
        line(panel, [(near, 0.0), (far, 0.0)], GROUND);
        let out = near - Vector::new(0.0, mark);
        line(panel, [(near, 0.0), (out, 0.0)], AXIS);
        panel.note(&number(east), view.at(out, 0.0) + offset(NUMBERS[0]));
    }
    for north in marks(low.y, high.y) {
        let (near, far) = (Vector::new(high.x, north), Vector::new(low.x, north));
        line(panel, [(near, 0.0), (far, 0.0)], GROUND);
        let out = near + Vector::new(mark, 0.0);
        line(panel, [(near, 0.0), (out, 0.0)], AXIS);
        panel.note(&number(north), view.at(out, 0.0) + offset(NUMBERS[1]));
    }
    for time in marks(0.0, end) {
        let out = low - Vector::new(mark, 0.0);
        line(panel, [(low, time), (out, time)], AXIS);
        let text = number(time);
        let wide = Vector::new(FIGURE * view.pixel * text.len() as f64, 0.0);
        panel.note(&text, view.at(out, time) + offset(NUMBERS[2]) - wide);
    }
    line(panel, [(low, 0.0), (east_end, 0.0)], AXIS);
    line(panel, [(east_end, 0.0), (high, 0.0)], AXIS);
    line(panel, [(low, 0.0), (low, end)], AXIS);
    let middle = 0.5 * (low + high);
    let names = [
        ("East [m]", Vector::new(middle.x, low.y), 0.0),
        ("North [m]", high, 0.0),
        ("Time [s]", low, end),
    ];
    for ((name, at, time), pixels) in names.into_iter().zip(NAMES) {
        panel.note(name, view.at(at, time) + offset(pixels));
    }
}

/// Round numbers within two, about [`MARKS`] of them.
fn marks(low: f64, high: f64) -> Vec<f64> {
    let rough = (high - low) / MARKS;
    let power = 10.0_f64.powf(rough.log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0]
        .map(|s| s * power)
        .into_iter()
        .find(|s| *s >= rough * (1.0 - 1e-9))
        .unwrap_or(power);
    if !(step > 0.0 && step.is_finite()) {
        return Vec::new();
    }
    let first = (low / step).ceil() as i64;
    let last = (high / step).floor() as i64;
    (first..=last).map(|i| i as f64 * step).collect()
}

/// As it is written beside a mark.
fn number(value: f64) -> String {
    format!("{}", (value * 1e6).round() / 1e6 + 0.0)
}
