//! Rendering of panels in a grid to bytes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use kuva::backend::pdf::{PageSize, PdfBackend};
use kuva::backend::png::PngBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::figure::Figure as Canvas;

use super::Panel;
use super::panel::{AREA, MARGIN};
use crate::report::{WriteError, write_atomically};

/// Dots per inch: of a PNG unless asked otherwise, of SVG pixels, of PDF points.
const PNG_DPI: f64 = 192.0;
const SVG_DPI: f64 = 96.0;
const PDF_DPI: f64 = 72.0;

/// Most millions of pixels of a PNG; each pixel takes four bytes of memory.
const MOST_MILLIONS: f64 = 200.0;

/// Font size of a title in pixels, and the number of letters that fit above one panel.
const TITLE_SIZE: u32 = 18;
const LETTERS: usize = 44;

/// Prefix of clip path names in the drawing library. A process-wide counter follows it.
const CLIP: &str = "kuva-clip-";

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
        "--size: found {}x{} mm; allowed: at least {}x{} mm for this figure",
        found[0], found[1], least[0], least[1]
    )]
    Size {
        /// The size.
        found: [f64; 2],
        /// The least size.
        least: [f64; 2],
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

/// Panels in rows of `columns`, with an optional title.
pub struct Figure {
    title: Option<String>,
    columns: usize,
    panels: Vec<Panel>,
    area: [f64; 2],
    /// Width and height in SVG pixels, unless as much as the panels need.
    size: Option<[f64; 2]>,
    dpi: f64,
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
        }
    }

    /// Sets a title above all panels, shortened to their width.
    pub fn titled(self, title: &str) -> Self {
        Self {
            title: (!title.is_empty()).then(|| title.to_owned()),
            ..self
        }
    }

    pub(super) fn with_dpi(self, dpi: Option<f64>) -> Self {
        Self {
            dpi: dpi.unwrap_or(self.dpi),
            ..self
        }
    }

    /// Sets the areas between the axes and the size of the whole, in pixels.
    pub(super) fn with_size(self, area: [f64; 2], size: [f64; 2]) -> Self {
        let panels = self.panels.into_iter().map(|panel| panel.sized(area));
        Self {
            panels: panels.collect(),
            area,
            size: Some(size),
            ..self
        }
    }

    /// Columns and rows.
    pub(super) fn grid(&self) -> [usize; 2] {
        let columns = self.columns;
        [columns, self.panels.len().div_ceil(columns).max(1)]
    }

    /// Width and height in SVG pixels.
    pub(super) fn pixels(self) -> [f64; 2] {
        let scene = self.scene();
        [scene.width, scene.height]
    }

    fn scene(self) -> kuva::render::render::Scene {
        let rows: Vec<f64> = self
            .panels
            .chunks(self.columns)
            .map(|row| Panel::below(row.iter().map(Panel::legend_lines).max().unwrap_or(0)))
            .collect();
        let (area, size) = (self.area, self.size);
        let count = self.panels.len();
        let [left, beside, top] = MARGIN;
        let right = match &self.panels[..] {
            [panel] => panel.right(),
            _ => beside,
        };
        let layouts = (self.panels.iter().enumerate())
            .map(|(i, panel)| panel.layout(right, rows[i / self.columns]))
            .collect();
        let mut canvas = Canvas::new(rows.len().max(1), self.columns)
            .with_cell_size(left + area[0] + right, top + area[1] + Panel::below(0))
            .with_structure((0..count).map(|i| vec![i]).collect())
            .with_plots(self.panels.into_iter().map(|p| p.plots).collect())
            .with_layouts(layouts)
            .with_spacing(6.0)
            .with_padding(8.0);
        if count > 1 {
            canvas = canvas.with_labels_lowercase();
        }
        if let Some(title) = self.title {
            let letters =
                self.columns as f64 * LETTERS as f64 * (area[0] + left) / (AREA[0] + left);
            let title = shortened(&title, letters as usize);
            canvas = canvas.with_title(title).with_title_size(TITLE_SIZE);
        }
        for (i, below) in rows.into_iter().enumerate() {
            canvas = canvas.with_row_height(i, top + area[1] + below);
        }
        let mut scene = canvas.render();
        if let Some(size) = size {
            [scene.width, scene.height] = size;
        }
        scene
    }

    /// Renders SVG text.
    pub fn svg(self) -> String {
        numbered_anew(&SvgBackend::new().render_scene(&self.scene()))
    }

    /// Renders PNG bytes.
    pub fn png(self) -> Result<Vec<u8>, FigureError> {
        let scale = self.dpi / SVG_DPI;
        let mut scene = self.scene();
        let pixels = [scene.width, scene.height].map(|length| (length * scale).round());
        let millions = pixels[0] * pixels[1] / 1e6;
        if !(millions <= MOST_MILLIONS) {
            return Err(FigureError::Pixels(millions.ceil()));
        }
        // the backend rounds up
        [scene.width, scene.height] = pixels.map(|pixels| (pixels - 0.3) / scale);
        PngBackend::new()
            .with_scale(scale as f32)
            .render_scene(&scene)
            .map_err(FigureError::Draw)
    }

    /// Renders PDF bytes: one page as large as the figure.
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

/// A text cut to at most this many letters.
pub(super) fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.to_owned();
    }
    let kept: String = text.chars().take(letters.saturating_sub(1)).collect();
    format!("{}…", kept.trim_end())
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

    #[test]
    fn clip_paths_are_counted_from_zero() {
        let svg = "a kuva-clip-17 b kuva-clip-4\" kuva-clip-17";
        assert_eq!(
            numbered_anew(svg),
            "a kuva-clip-0 b kuva-clip-1\" kuva-clip-0"
        );
    }
}
