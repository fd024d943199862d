//! Rendering of panels in a grid to bytes.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};

use kurbo::{BezPath, PathEl, Shape};
#[cfg(feature = "pdf")]
use kuva::backend::pdf::{PageSize, PdfBackend};
use kuva::backend::png::PngBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::color::Color;
use kuva::render::figure::Figure as Canvas;
use kuva::render::render::{Primitive, Scene, TextAnchor};

use super::Panel;
use super::panel::{AREA, COLOURED, Key, text_size, text_width};
use crate::frame::Vector;
use crate::geometry::clipped;
use crate::report::{WriteError, write_atomically};
use crate::text::broken;

/// Dots per inch: of a PNG unless asked otherwise, of SVG pixels, of PDF points.
const PNG_DPI: f64 = 192.0;
const SVG_DPI: f64 = 96.0;
#[cfg(feature = "pdf")]
const PDF_DPI: f64 = 72.0;

/// Most millions of pixels of a PNG; each pixel takes four bytes of memory.
const MOST_MILLIONS: f64 = 200.0;

/// Font size of a title in pixels, the number of letters that fit above one panel, and the most lines
/// of a title.
const TITLE_SIZE: u32 = 18;
const LETTERS: usize = 44;
const MOST_LINES: usize = 3;

/// Most dashes of a line in a PNG.
const MOST_DASHES: f64 = 1e4;

/// Prefix of clip path names in the drawing library. A process-wide counter follows it.
const CLIP: &str = "kuva-clip-";

/// Pixels around the whole and between the panels, the height of a line of a title, and its base.
const PADDING: f64 = 6.0;
const TITLE: f64 = 28.2;
const TITLE_BASE: f64 = 20.3;

/// A title that only takes room.
const BLANK: &str = " ";

/// Height in pixels of the letter of a panel.
const LETTER: f64 = 20.0;

/// Pixels of a legend: the height of a row, the width of a mark, and the gap after a text.
const ROW: f64 = 16.0;
const SWATCH: f64 = 24.0;
const GAP: f64 = 12.0;

/// Format of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureFormat {
    /// Scalable vector graphics; text stays text.
    Svg,
    /// Raster image; two pixels per SVG pixel unless its resolution is asked for.
    Png,
    /// One page of vector graphics.
    Pdf,
}

impl FigureFormat {
    /// Selects the format by the file extension, `.svg`, `.png` or `.pdf`.
    pub fn of(file: &Path) -> Option<Self> {
        let ending = file.extension()?.to_str()?;
        let formats = [("svg", Self::Svg), ("png", Self::Png), ("pdf", Self::Pdf)];
        let known = formats
            .into_iter()
            .find(|(e, _)| ending.eq_ignore_ascii_case(e));
        known.map(|(_, format)| format)
    }
}

/// Reason why a figure was not written.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// Unsupported file extension.
    #[error(
        "{}: found a name that ends in none of .svg, .png and .pdf; allowed: one of the three",
        file.display()
    )]
    Format {
        /// File path.
        file: PathBuf,
    },
    /// A PDF from a build without the feature `pdf`.
    #[error("this build has no PDF: name a .svg or .png, or build with `--features pdf`")]
    NoPdf,
    /// A marked time outside the motion.
    #[error("--times: found {found} s; allowed: from 0 to {end} s, where the motion ends")]
    Time {
        /// The time in seconds.
        found: f64,
        /// End of the motion in seconds.
        end: f64,
    },
    /// A size in millimetres that leaves no room between the axes.
    #[error(
        "--size: found {}x{} mm; allowed: at least {} mm for this figure",
        found[0], found[1], sizes(least)
    )]
    Size {
        /// The size.
        found: [f64; 2],
        /// The least size of each arrangement of the panels.
        least: Vec<[f64; 2]>,
    },
    /// Too many pixels.
    #[error(
        "--dpi: found a figure of {0:.0} million pixels; allowed: at most {MOST_MILLIONS} million; \
         choose a lower resolution or a smaller size"
    )]
    Pixels(f64),
    /// Rendering failed.
    #[error("the figure cannot be drawn: {0}")]
    Draw(String),
    /// Writing failed.
    #[error(transparent)]
    Write(#[from] WriteError),
}

fn sizes(all: &[[f64; 2]]) -> String {
    let sizes = all
        .iter()
        .map(|[width, height]| format!("{width}x{height}"));
    sizes.collect::<Vec<_>>().join(" or ")
}

/// Panels in rows of `columns`, with an optional title.
pub struct Figure {
    title: Option<String>,
    columns: usize,
    panels: Vec<Panel>,
    area: [f64; 2],
    /// Width and height in SVG pixels, unless as much as the panels need.
    size: Option<[f64; 2]>,
    dpi: f64,
    /// True where all panels have the same axes, numbered at the left and at the foot alone.
    shared: bool,
    /// True where titles tell the panels apart.
    keeps_titles: bool,
}

impl Figure {
    /// Creates a figure; panels are in row-major order.
    pub fn new(columns: usize, panels: Vec<Panel>) -> Self {
        let columns = columns.clamp(1, panels.len().max(1));
        Self {
            title: None,
            columns,
            panels,
            area: AREA,
            size: None,
            dpi: PNG_DPI,
            shared: false,
            keeps_titles: false,
        }
    }

    /// Sets a title above all panels, in lines of their width.
    pub fn titled(self, title: &str) -> Self {
        Self {
            title: (!title.is_empty()).then(|| title.to_owned()),
            ..self
        }
    }

    /// Numbers the axes at the left and at the foot alone, because all panels have the same.
    pub(super) fn with_shared_axes(self) -> Self {
        Self {
            shared: true,
            ..self
        }
    }

    /// Keeps the titles of the panels whatever the width.
    pub(super) fn with_titles(self) -> Self {
        Self {
            keeps_titles: true,
            ..self
        }
    }

    pub(super) fn with_dpi(self, dpi: Option<f64>) -> Self {
        Self {
            dpi: dpi.unwrap_or(self.dpi),
            ..self
        }
    }

    /// Removes the titles, except those that tell panels apart.
    pub(super) fn untitled(mut self) -> Self {
        self.title = None;
        if !self.keeps_titles {
            self.panels.iter_mut().for_each(Panel::remove_title);
        }
        self
    }

    /// Sets the areas between the axes in pixels.
    pub(super) fn sized(self, area: [f64; 2]) -> Self {
        let panels = self.panels.into_iter().map(|panel| panel.sized(area));
        Self {
            panels: panels.collect(),
            area,
            ..self
        }
    }

    /// Sets the areas between the axes and the size of the whole, in pixels.
    pub(super) fn with_size(self, area: [f64; 2], size: [f64; 2]) -> Self {
        Self {
            size: Some(size),
            ..self.sized(area)
        }
    }

    /// Arranges the panels in at most `most` columns.
    pub(super) fn in_columns(self, most: usize) -> Self {
        let columns = self.columns.min(most);
        Self { columns, ..self }
    }

    /// Columns and rows.
    pub(super) fn grid(&self) -> [usize; 2] {
        let columns = self.columns;
        [columns, self.panels.len().div_ceil(columns).max(1)]
    }

    /// True where a panel has numbers at its left, and at its foot.
    fn numbered(&self, index: usize) -> [bool; 2] {
        let is_last = index + self.columns >= self.panels.len();
        [index.is_multiple_of(self.columns), is_last].map(|edge| edge || !self.shared)
    }

    fn is_lettered(&self) -> bool {
        self.panels.len() > 1 && !self.shared
    }

    /// Pixels beside the areas: to the left in each column, to the right, above, and below in each
    /// row.
    fn margins(&self) -> (Vec<f64>, f64, f64, Vec<f64>) {
        let [columns, rows] = self.grid();
        let left = (0..columns).map(|i| Panel::left(self.area, self.numbered(i)[0]));
        let below = (0..rows).map(|row| {
            let mut panels = row * columns..self.panels.len().min((row + 1) * columns);
            Panel::below(panels.any(|i| self.numbered(i)[1]))
        });
        let right = self.panels.iter().map(Panel::right).fold(0.0, f64::max);
        let least = if self.is_lettered() { LETTER } else { 0.0 };
        let top = self.panels.iter().map(Panel::top).fold(least, f64::max);
        (left.collect(), right, top, below.collect())
    }

    /// Width and height in pixels of all but the areas and the legend.
    pub(super) fn frame(&self) -> [f64; 2] {
        let [columns, rows] = self.grid().map(|count| count as f64);
        let (left, right, top, below) = self.margins();
        let beside = PADDING * (columns + 1.0) + left.iter().sum::<f64>() + columns * right;
        let title = TITLE * self.title_lines(beside + columns * self.area[0]).len() as f64;
        [
            beside,
            PADDING * (rows + 1.0) + title + rows * top + below.iter().sum::<f64>(),
        ]
    }

    /// The lines of the title in a width in pixels.
    fn title_lines(&self, width: f64) -> Vec<String> {
        let letters = (width / AREA[0] * LETTERS as f64) as usize;
        let title = self.title.as_deref();
        title.map_or_else(Vec::new, |title| in_lines(title, letters))
    }

    /// The legend of all panels in rows of a width: offset in pixels, row, and key.
    fn legend(&self, width: f64) -> Vec<(f64, usize, &Key)> {
        let mut placed: Vec<(f64, usize, &Key)> = Vec::new();
        let (mut at, mut row) = (PADDING, 0);
        for key in self.panels.iter().flat_map(Panel::legend) {
            if placed.iter().any(|(.., known)| *known == key) {
                continue;
            }
            let length = SWATCH + GAP + text_width(&key.label, self.area);
            if at > PADDING && at + length - GAP > width - PADDING {
                (at, row) = (PADDING, row + 1);
            }
            placed.push((at, row, key));
            at += length;
        }
        placed
    }

    pub(super) fn legend_height(&self, width: f64) -> f64 {
        let rows = self.legend(width).last().map_or(0, |(_, row, _)| row + 1);
        ROW * rows as f64
    }

    fn scene(self) -> Scene {
        let [columns, rows] = self.grid();
        let (area, frame) = (self.area, self.frame());
        let (left, right, top, below) = self.margins();
        let grid = [columns as f64, rows as f64];
        let [width, foot] = [0, 1].map(|i| frame[i] + grid[i] * area[i]);
        let title = self.title_lines(width);
        let [width, height] = self
            .size
            .unwrap_or([width, foot + self.legend_height(width)]);
        let legend: Vec<Primitive> = (self.legend(width).into_iter())
            .flat_map(|(x, row, key)| {
                let letters = ((width - x - SWATCH) / text_width("n", area)) as usize;
                drawn_key(key, [x, foot + ROW * row as f64], letters, text_size(area))
            })
            .collect();
        let count = self.panels.len();
        let layouts = (self.panels.iter().enumerate())
            .map(|(i, panel)| {
                let [column, row] = [i % columns, i / columns];
                let sides = [left[column], right, top, below[row]];
                panel.layout(sides, self.numbered(i))
            })
            .collect();
        let mut canvas = Canvas::new(rows, columns)
            .with_structure((0..count).map(|i| vec![i]).collect())
            .with_layouts(layouts)
            .with_spacing(PADDING)
            .with_padding(PADDING);
        if self.is_lettered() {
            canvas = canvas.with_labels_lowercase();
        }
        canvas = canvas.with_plots(self.panels.into_iter().map(|p| p.plots).collect());
        if !title.is_empty() {
            // one line of that height: the library breaks none
            let size = TITLE_SIZE * title.len() as u32;
            canvas = canvas.with_title(BLANK).with_title_size(size);
        }
        for (i, left) in left.into_iter().enumerate() {
            canvas = canvas.with_col_width(i, left + area[0] + right);
        }
        for (i, below) in below.into_iter().enumerate() {
            canvas = canvas.with_row_height(i, top + area[1] + below);
        }
        let mut scene = canvas.render();
        scene.elements.iter_mut().for_each(colour_note);
        let is_blank =
            |part: &Primitive| matches!(part, Primitive::Text { content, .. } if content == BLANK);
        scene.elements.retain(|part| !is_blank(part));
        legend.into_iter().for_each(|part| scene.add(part));
        for (index, line) in title.into_iter().enumerate() {
            scene.add(Primitive::Text {
                x: 0.5 * width,
                y: TITLE_BASE + TITLE * index as f64,
                content: line,
                size: TITLE_SIZE,
                anchor: TextAnchor::Middle,
                rotate: None,
                bold: false,
                color: None,
            });
        }
        [scene.width, scene.height] = [width, height];
        scene
    }

    /// Renders SVG text.
    pub fn svg(self) -> String {
        numbered_anew(&SvgBackend::new().render_scene(&self.scene()))
    }

    /// Renders PNG bytes.
    pub fn png(self) -> Result<Vec<u8>, FigureError> {
        let (dpi, scale) = (self.dpi, self.dpi / SVG_DPI);
        let mut scene = self.scene();
        let pixels = [scene.width, scene.height].map(|length| (length * scale).round());
        let millions = pixels[0] * pixels[1] / 1e6;
        if !(millions <= MOST_MILLIONS) {
            return Err(FigureError::Pixels(millions.ceil()));
        }
        scene.elements = within_reach(scene.elements, scene.width.max(scene.height));
        scene.elements = scene.elements.into_iter().flat_map(cut).collect();
        let upright = taken_upright(&mut scene);
        // the backend rounds up
        [scene.width, scene.height] = pixels.map(|pixels| (pixels - 0.3) / scale);
        let draw = |scene: &Scene| {
            let drawn = PngBackend::new().with_scale(scale as f32);
            let bytes = drawn.render_scene(scene).map_err(FigureError::Draw)?;
            Raster::read(&bytes).map_err(|e| FigureError::Draw(e.to_string()))
        };
        let mut raster = draw(&scene)?;
        for ([x, y], text) in upright {
            let [x, y] = [x, y].map(|length| (length * scale).round() as i64);
            raster.add_turned(&draw(&text)?, [x, y]);
        }
        (raster.written(dpi)).map_err(|e| FigureError::Draw(e.to_string()))
    }

    /// Renders PDF bytes: one page as large as the figure. Without the feature `pdf` it is an error.
    #[cfg(not(feature = "pdf"))]
    pub fn pdf(self) -> Result<Vec<u8>, FigureError> {
        Err(FigureError::NoPdf)
    }

    /// Renders PDF bytes: one page as large as the figure.
    #[cfg(feature = "pdf")]
    pub fn pdf(self) -> Result<Vec<u8>, FigureError> {
        let scene = self.scene();
        let [width, height] = [scene.width, scene.height].map(|px| px * PDF_DPI / SVG_DPI);
        PdfBackend::new()
            .with_page_size(PageSize::points(width, height))
            .render_scenes(&[scene])
            .map_err(FigureError::Draw)
    }

    /// Writes the file atomically in the format of its extension.
    pub fn write(self, file: &Path) -> Result<(), FigureError> {
        let bytes = match FigureFormat::of(file) {
            Some(FigureFormat::Svg) => self.svg().into_bytes(),
            Some(FigureFormat::Png) => self.png()?,
            Some(FigureFormat::Pdf) => self.pdf()?,
            None => {
                let file = file.to_owned();
                return Err(FigureError::Format { file });
            }
        };
        Ok(write_atomically(file, &bytes)?)
    }
}

/// Gives a note its colour.
fn colour_note(part: &mut Primitive) {
    if let Primitive::Text { content, color, .. } = part
        && let Some((shade, text)) = content.split_once(COLOURED)
    {
        (*color, *content) = (Some(shade.into()), text.to_owned());
    }
}

/// A line of a scene.
struct Line {
    points: Vec<(f64, f64)>,
    stroke: Color,
    width: f64,
    /// Lengths of the dashes and the gaps.
    pattern: Option<String>,
}

impl Line {
    /// The line that a part of a scene is.
    fn of(part: &Primitive) -> Option<Self> {
        let (points, stroke, width, pattern) = match part {
            Primitive::PolyLine {
                points,
                stroke,
                stroke_width,
                stroke_dasharray,
            } => (points.clone(), stroke, stroke_width, stroke_dasharray),
            Primitive::Line {
                x1,
                y1,
                x2,
                y2,
                stroke,
                stroke_width,
                stroke_dasharray,
            } => {
                let ends = vec![(*x1, *y1), (*x2, *y2)];
                (ends, stroke, stroke_width, stroke_dasharray)
            }
            _ => return None,
        };
        Some(Self {
            points,
            stroke: stroke.clone(),
            width: *width,
            pattern: pattern.clone(),
        })
    }

    /// Lines of the same stroke through other points.
    fn with(&self, pattern: Option<&str>, lines: Vec<Vec<(f64, f64)>>) -> Vec<Primitive> {
        let line = |points| Primitive::PolyLine {
            points,
            stroke: self.stroke.clone(),
            stroke_width: self.width,
            stroke_dasharray: pattern.map(str::to_owned),
        };
        lines.into_iter().map(line).collect()
    }
}

/// A dashed line as its dashes, and everything else as it is. The raster backend would begin the
/// dashes anew at every point of a line, and not scale them.
fn cut(part: Primitive) -> Vec<Primitive> {
    let line = Line::of(&part);
    let pattern = line.as_ref().and_then(|line| line.pattern.as_deref());
    let (Some(line), Some(pattern)) = (&line, pattern) else {
        return vec![part];
    };
    let lengths: Vec<f64> = pattern.split(' ').filter_map(|l| l.parse().ok()).collect();
    line.with(None, dashes(&line.points, &lengths))
}

/// The dashes of a line, whose lengths and those of the gaps take turns in a pattern of even length.
/// A line of too many is one dash.
fn dashes(points: &[(f64, f64)], pattern: &[f64]) -> Vec<Vec<(f64, f64)>> {
    let line = BezPath::from_vec(
        (points.iter().enumerate())
            .map(|(index, point)| match index {
                0 => PathEl::MoveTo((*point).into()),
                _ => PathEl::LineTo((*point).into()),
            })
            .collect(),
    );
    // negated so that a NaN is one
    if points.is_empty() || !(line.perimeter(0.1) <= MOST_DASHES * pattern.iter().sum::<f64>()) {
        return vec![points.to_vec()];
    }
    let mut all: Vec<Vec<(f64, f64)>> = Vec::new();
    for part in kurbo::dash(line.iter(), 0.0, pattern) {
        match (part, all.last_mut()) {
            (PathEl::MoveTo(point), _) => all.push(vec![(point.x, point.y)]),
            (PathEl::LineTo(point), Some(dash)) => dash.push((point.x, point.y)),
            _ => {}
        }
    }
    all
}

/// The lines and areas of a figure without what is far outside of it: the raster backend takes a
/// step for every pixel of a line, drawn or not. `size` is the longer side in pixels. Coordinates
/// are those of the panels, each of which is moved by less than that.
fn within_reach(parts: Vec<Primitive>, size: f64) -> Vec<Primitive> {
    let reach = 2.0 * size;
    // negated so that a NaN is far
    let is_far = |(x, y): (f64, f64)| !(x.abs() <= reach && y.abs() <= reach);
    let near = |part| match (Line::of(&part), part) {
        (Some(line), part) => match line.points.iter().any(|point| is_far(*point)) {
            true => line.with(line.pattern.as_deref(), line_within(&line.points, reach)),
            false => vec![part],
        },
        (None, Primitive::Path(mut path)) => {
            if let Some(area) = area_within(&path.d, reach) {
                path.d = area;
            }
            vec![Primitive::Path(path)]
        }
        (None, part) => vec![part],
    };
    parts.into_iter().flat_map(near).collect()
}

/// The stretches of a line in the square that reaches so far from the origin. A segment with a
/// coordinate that is not finite is left out (Liang & Barsky, doi:10.1145/357332.357333).
fn line_within(points: &[(f64, f64)], reach: f64) -> Vec<Vec<(f64, f64)>> {
    let mut all: Vec<Vec<(f64, f64)>> = Vec::new();
    for pair in points.windows(2) {
        let [start, end] = [0, 1].map(|i| Vector::new(pair[i].0, pair[i].1));
        let way = end - start;
        let (mut from, mut until) = (0.0_f64, 1.0_f64);
        for axis in [0, 1] {
            let [a, b] = [-reach, reach].map(|side| (side - start[axis]) / way[axis]);
            let is_beside = way[axis] == 0.0 && start[axis].abs() > reach;
            if is_beside || !way[axis].is_finite() {
                until = -1.0;
            } else if way[axis] != 0.0 {
                (from, until) = (from.max(a.min(b)), until.min(a.max(b)));
            }
        }
        if !(from <= until) {
            continue;
        }
        let [start, end] = [from, until].map(|share| {
            let point = start + way * share;
            (point.x, point.y)
        });
        match all.last_mut() {
            Some(line) if line.last() == Some(&start) => line.push(end),
            _ => all.push(vec![start, end]),
        }
    }
    all
}

/// The part of an area in the square that reaches so far from the origin, as SVG data; `None` where
/// that is the whole area, and for data of another program.
fn area_within(data: &str, reach: f64) -> Option<String> {
    let path = BezPath::from_svg(data).ok()?;
    let around = path.control_box();
    let sides = [around.x0, around.y0, around.x1, around.y1];
    if sides.iter().all(|side| side.abs() <= reach) {
        return None;
    }
    let mut areas: Vec<Vec<Vector>> = Vec::new();
    kurbo::flatten(path.iter(), 0.1, |part| match (part, areas.last_mut()) {
        (PathEl::MoveTo(point), _) => areas.push(vec![Vector::new(point.x, point.y)]),
        (PathEl::LineTo(point), Some(area)) => area.push(Vector::new(point.x, point.y)),
        _ => {}
    });
    let mut kept = BezPath::new();
    for area in areas {
        let sides = [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)];
        let area = sides.into_iter().fold(area, |area, (axis, sign)| {
            clipped(&area, |point| sign * point[axis] - reach)
        });
        for (index, point) in area.iter().enumerate() {
            match index {
                0 => kept.move_to((point.x, point.y)),
                _ => kept.line_to((point.x, point.y)),
            }
        }
        if !area.is_empty() {
            kept.close_path();
        }
    }
    Some(kept.to_svg())
}

/// Takes the texts that run upwards out of a scene: the raster backend blurs what it turns. Each is
/// returned as a scene in which it runs to the right, with the place in pixels of the lower left
/// corner of that scene after a quarter turn to the left.
fn taken_upright(scene: &mut Scene) -> Vec<([f64; 2], Scene)> {
    let mut moves = vec![[0.0, 0.0]];
    let mut taken = Vec::new();
    scene.elements.retain(|part| {
        let [dx, dy] = moves.last().copied().unwrap_or_default();
        match part {
            Primitive::GroupStart { transform, .. } => {
                let [x, y] = transform.as_deref().map_or([0.0; 2], translation);
                moves.push([dx + x, dy + y]);
            }
            Primitive::GroupEnd => drop(moves.pop()),
            Primitive::Text {
                x,
                y,
                rotate: Some(-90.0),
                size,
                ..
            } => {
                let (x, y, height) = (x + dx, y + dy, 2.0 * f64::from(*size));
                let mut text = part.clone();
                if let Primitive::Text { x, y, rotate, .. } = &mut text {
                    // in the middle of a line as long as the figure is high
                    (*x, *y, *rotate) = (0.5 * scene.height, 0.75 * height, None);
                }
                let mut alone = Scene::new(scene.height, height);
                alone.add(text);
                taken.push(([x - 0.75 * height, y + 0.5 * scene.height], alone));
                return false;
            }
            _ => {}
        }
        true
    });
    taken
}

/// The move of `translate(x,y)`, in pixels; none for another transform.
fn translation(transform: &str) -> [f64; 2] {
    let inside = transform.strip_prefix("translate(");
    let inside = inside.and_then(|rest| rest.strip_suffix(')'));
    let mut numbers = inside.into_iter().flat_map(|text| text.split(','));
    let mut next = || numbers.next().and_then(|text| text.trim().parse().ok());
    [next().unwrap_or(0.0), next().unwrap_or(0.0)]
}

/// A drawn figure.
struct Raster {
    info: png::Info<'static>,
    /// Rows from above, four bytes each pixel: red, green, blue, opacity.
    pixels: Vec<u8>,
}

impl Raster {
    fn read(bytes: &[u8]) -> Result<Self, Box<dyn std::error::Error>> {
        let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info()?;
        let mut pixels = vec![0; reader.output_buffer_size().ok_or("too large")?];
        reader.next_frame(&mut pixels)?;
        let info = reader.info().clone();
        Ok(Self { info, pixels })
    }

    /// Adds a drawing in dark on white, turned a quarter to the left, whose lower left corner is then
    /// at a place in pixels.
    fn add_turned(&mut self, other: &Self, [left, foot]: [i64; 2]) {
        let [width, height] = [self.info.width, self.info.height].map(i64::from);
        let wide = other.info.width as usize;
        for (index, colour) in other.pixels.chunks_exact(4).enumerate() {
            let (column, row) = ((index % wide) as i64, (index / wide) as i64);
            let (x, y) = (left + row, foot - 1 - column);
            if (0..width).contains(&x) && (0..height).contains(&y) {
                let at = 4 * (y * width + x) as usize;
                for (below, above) in self.pixels[at..at + 3].iter_mut().zip(colour) {
                    *below = (u16::from(*below) * u16::from(*above) / 255) as u8;
                }
            }
        }
    }

    /// The image with its resolution, which the drawing library leaves out.
    fn written(mut self, dpi: f64) -> Result<Vec<u8>, png::EncodingError> {
        let per_metre = (dpi / 0.0254).round() as u32;
        self.info.pixel_dims = Some(png::PixelDimensions {
            xppu: per_metre,
            yppu: per_metre,
            unit: png::Unit::Meter,
        });
        let mut written = Vec::new();
        let mut writer = png::Encoder::with_info(&mut written, self.info)?.write_header()?;
        writer.write_image_data(&self.pixels)?;
        writer.finish()?;
        Ok(written)
    }
}

/// Mark and text of a key whose upper left corner is given in pixels.
fn drawn_key(key: &Key, [x, y]: [f64; 2], letters: usize, size: u32) -> [Primitive; 2] {
    let (middle, stroke) = (y + 0.5 * ROW, key.stroke);
    let width = SWATCH - 6.0;
    let mark = match key.filled {
        None => Primitive::Line {
            x1: x,
            y1: middle,
            x2: x + width,
            y2: middle,
            stroke: stroke.colour.into(),
            stroke_width: stroke.width,
            stroke_dasharray: stroke.dashed.then(|| "5 3".to_owned()),
        },
        opacity => Primitive::Rect {
            x,
            y: middle - 5.0,
            width,
            height: 10.0,
            fill: stroke.colour.into(),
            stroke: None,
            stroke_width: None,
            opacity,
        },
    };
    let text = Primitive::Text {
        x: x + SWATCH,
        y: middle + 0.36 * f64::from(size),
        content: shortened(&key.label, letters),
        size,
        anchor: TextAnchor::Start,
        rotate: None,
        bold: false,
        color: None,
    };
    [mark, text]
}

/// A text cut to at most this many letters.
fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.to_owned();
    }
    let kept: String = text.chars().take(letters.saturating_sub(1)).collect();
    format!("{}…", kept.trim_end())
}

/// A text in lines of at most this many letters. What does not fit into three is cut.
pub(super) fn in_lines(text: &str, letters: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for line in broken(text, letters, "").lines() {
        match lines.len() {
            MOST_LINES => lines[MOST_LINES - 1] += &format!(" {line}"),
            _ => lines.push(line.to_owned()),
        }
    }
    lines.iter().map(|line| shortened(line, letters)).collect()
}

/// Renumbers the clip paths from 0, so that equal figures give equal bytes.
fn numbered_anew(svg: &str) -> String {
    let mut numbers: BTreeMap<&str, usize> = BTreeMap::new();
    let mut parts = svg.split(CLIP);
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let digits = part.len() - part.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let next = numbers.len();
        let number = *numbers.entry(&part[..digits]).or_insert(next);
        text.push_str(&format!("{CLIP}{number}{}", &part[digits..]));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;
    use kuva::render::render::PathData;

    #[test]
    fn dashes_go_on_over_the_points_of_a_line() {
        let line = [0.0, 3.0, 6.0, 30.0].map(|x| (x, 1.0));
        let mut found: Vec<Vec<f64>> = (dashes(&line, &[8.0, 4.0]).iter())
            .map(|dash| dash.iter().map(|point| point.0).collect())
            .collect();
        found.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert_eq!(
            found,
            [vec![0.0, 3.0, 6.0, 8.0], vec![12.0, 20.0], vec![24.0, 30.0]]
        );
        assert_eq!(dashes(&[(0.0, 0.0), (1e9, 0.0)], &[8.0, 4.0]).len(), 1);
        assert_eq!(dashes(&[(0.0, 0.0), (f64::NAN, 0.0)], &[8.0, 4.0]).len(), 1);
        assert_eq!(dashes(&[], &[8.0, 4.0]).len(), 1);
    }

    /// The raster backend takes a step for every pixel of a line: what is left of lines and areas
    /// bounds its work, however far they reach.
    #[test]
    fn nothing_far_outside_is_drawn() {
        let (size, far) = (500.0, 1e10);
        let line = |points: &[(f64, f64)]| Primitive::PolyLine {
            points: points.to_vec(),
            stroke: "#000000".into(),
            stroke_width: 0.6,
            stroke_dasharray: None,
        };
        let area = |data: &str| {
            Primitive::Path(Box::new(PathData {
                d: data.to_owned(),
                fill: Some("#000000".into()),
                stroke: Color::None,
                stroke_width: 0.0,
                opacity: None,
                stroke_dasharray: None,
            }))
        };
        let near = line(&[(1.0, 2.0), (300.0, 400.0), (-700.0, 0.0)]);
        let parts = vec![
            near.clone(),
            line(&[(-far, 10.0), (far, 10.0), (far, far), (20.0, -far)]),
            line(&[(far, far), (far, 2.0 * far), (f64::NAN, 0.0), (0.0, 0.0)]),
            area("M -1e10 -1e10 L 1e10 -1e10 L 1e10 1e10 L -1e10 1e10 Z"),
            area("M 5000 5000 L 6000 5000 L 6000 6000 Z"),
        ];
        let kept = within_reach(parts, size);
        let [first, across, all, none] = &kept[..] else {
            panic!("{kept:?}");
        };
        let points = |part: &Primitive| Line::of(part).expect("a line").points;
        assert_eq!(points(first), points(&near));
        assert_eq!(points(across), [(-1000.0, 10.0), (1000.0, 10.0)]);
        let data = |part: &Primitive| match part {
            Primitive::Path(path) => path.d.clone(),
            other => panic!("{other:?}"),
        };
        let whole = BezPath::from_svg(&data(all)).expect("a path");
        assert_eq!(whole.area().abs(), 4e6);
        assert!(data(none).is_empty());
    }

    #[test]
    fn a_title_has_three_lines_at_most() {
        assert_eq!(in_lines("Give-way", 20), ["Give-way"]);
        assert_eq!(in_lines("one two three", 7), ["one two", "three"]);
        let cut = in_lines("one two three four five six", 5);
        assert_eq!(cut, ["one", "two", "thre…"]);
        assert!(in_lines("", 5).is_empty());
    }

    #[test]
    fn clip_paths_are_counted_from_zero() {
        let svg = "a kuva-clip-17 b kuva-clip-4\" kuva-clip-17";
        assert_eq!(
            numbered_anew(svg),
            "a kuva-clip-0 b kuva-clip-1\" kuva-clip-0"
        );
    }
}
