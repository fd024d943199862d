//! Rendering of panels in a grid to bytes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use kuva::backend::png::PngBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::figure::Figure as Canvas;

use super::Panel;
use super::panel::{AREA, MARGIN};
use crate::report::{WriteError, write_atomically};

/// PNG pixels per SVG pixel.
const PNG_SCALE: f32 = 2.0;

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
    /// Raster image with two pixels per SVG pixel.
    Png,
}

impl FigureFormat {
    /// Selects the format by the file extension, `.svg` or `.png`.
    pub fn of(file: &Path) -> Option<Self> {
        let ending = file.extension()?.to_str()?;
        if ending.eq_ignore_ascii_case("svg") {
            Some(Self::Svg)
        } else if ending.eq_ignore_ascii_case("png") {
            Some(Self::Png)
        } else {
            None
        }
    }
}

/// Reason why a figure was not written.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// Unsupported file extension.
    #[error(
        "{}: found a name that ends neither in .svg nor in .png; allowed: one of the two",
        file.display()
    )]
    Format {
        /// File path.
        file: PathBuf,
    },
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
}

impl Figure {
    /// Creates a figure; panels are in row-major order.
    pub fn new(columns: usize, panels: Vec<Panel>) -> Self {
        let columns = columns.clamp(1, panels.len().max(1));
        Self {
            title: None,
            columns,
            panels,
        }
    }

    /// Sets a title above all panels, shortened to their width.
    pub fn titled(self, title: &str) -> Self {
        Self {
            title: Some(shortened(title, self.columns.max(1) * LETTERS)),
            ..self
        }
    }

    fn scene(self) -> kuva::render::render::Scene {
        let rows: Vec<f64> = self
            .panels
            .chunks(self.columns)
            .map(|row| Panel::below(row.iter().map(Panel::legend_lines).max().unwrap_or(0)))
            .collect();
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
            .with_cell_size(left + AREA[0] + right, top + AREA[1] + Panel::below(0))
            .with_structure((0..count).map(|i| vec![i]).collect())
            .with_plots(self.panels.into_iter().map(|p| p.plots).collect())
            .with_layouts(layouts)
            .with_spacing(6.0)
            .with_padding(8.0);
        if count > 1 {
            canvas = canvas.with_labels_lowercase();
        }
        if let Some(title) = self.title {
            canvas = canvas.with_title(title).with_title_size(TITLE_SIZE);
        }
        for (i, below) in rows.into_iter().enumerate() {
            canvas = canvas.with_row_height(i, top + AREA[1] + below);
        }
        canvas.render()
    }

    /// Renders SVG text.
    pub fn svg(self) -> String {
        numbered_anew(&SvgBackend::new().render_scene(&self.scene()))
    }

    /// Renders PNG bytes.
    pub fn png(self) -> Result<Vec<u8>, FigureError> {
        PngBackend::new()
            .with_scale(PNG_SCALE)
            .render_scene(&self.scene())
            .map_err(FigureError::Draw)
    }

    /// Writes the file atomically in the format of its extension.
    pub fn write(self, file: &Path) -> Result<(), FigureError> {
        let bytes = match FigureFormat::of(file) {
            Some(FigureFormat::Svg) => self.svg().into_bytes(),
            Some(FigureFormat::Png) => self.png()?,
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
