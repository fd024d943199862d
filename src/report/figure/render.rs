//! Panels in a grid, as bytes.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use kuva::backend::png::PngBackend;
use kuva::backend::svg::SvgBackend;
use kuva::render::figure::Figure as Canvas;

use super::Panel;
use super::panel::{AREA, MARGIN};
use crate::report::{WriteError, write_atomically};

/// Pixels of a PNG for one of the SVG.
const PNG_SCALE: f32 = 2.0;

/// Pixels of a title's letters, and how many of them stand above one panel.
const TITLE_SIZE: u32 = 18;
const LETTERS: usize = 54;

/// The name of clip paths in the drawing library, before a number that counts on through a process.
const CLIP: &str = "kuva-clip-";

/// The format of a figure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FigureFormat {
    /// Scalable, the text kept as text.
    Svg,
    /// Two pixels for one of the SVG.
    Png,
}

impl FigureFormat {
    /// By the ending of a file's name, `.svg` or `.png`.
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

/// Why a figure is not written.
#[derive(Debug, thiserror::Error)]
pub enum FigureError {
    /// Neither ending.
    #[error("{}: found a name that ends neither in .svg nor in .png; allowed: one of the two", file.display())]
    Format {
        /// The file.
        file: PathBuf,
    },
    /// The picture cannot be made.
    #[error("the figure cannot be drawn: {0}")]
    Draw(String),
    /// The file cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

/// Panels in rows of `columns`, under a title.
pub struct Figure {
    title: Option<String>,
    columns: usize,
    panels: Vec<Panel>,
}

impl Figure {
    /// Panels, row by row.
    pub fn new(columns: usize, panels: Vec<Panel>) -> Self {
        let columns = columns.clamp(1, panels.len().max(1));
        Self {
            title: None,
            columns,
            panels,
        }
    }

    /// With a title above all panels, shortened to their width.
    pub fn titled(self, title: &str) -> Self {
        let fits = self.columns.max(1) * LETTERS;
        let title = if title.chars().count() > fits {
            let kept: String = title.chars().take(fits - 1).collect();
            format!("{}…", kept.trim_end())
        } else {
            title.to_owned()
        };
        Self {
            title: Some(title),
            ..self
        }
    }

    fn scene(self) -> kuva::render::render::Scene {
        let rows: Vec<f64> = self
            .panels
            .chunks(self.columns)
            .map(|row| Panel::below(row.iter().map(Panel::lines).max().unwrap_or(0)))
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

    /// As the text of an SVG file.
    pub fn svg(self) -> String {
        numbered_anew(&SvgBackend::new().render_scene(&self.scene()))
    }

    /// As the bytes of a PNG file.
    pub fn png(self) -> Result<Vec<u8>, FigureError> {
        PngBackend::new()
            .with_scale(PNG_SCALE)
            .render_scene(&self.scene())
            .map_err(FigureError::Draw)
    }

    /// Writes the file, whole or not at all, in the format of its ending.
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

/// Counts the clip paths from 0 in every figure: the same figure, the same bytes.
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
    fn the_ending_decides() {
        let of = |name: &str| FigureFormat::of(Path::new(name));
        assert_eq!(of("a.svg"), Some(FigureFormat::Svg));
        assert_eq!(of("b/a.PNG"), Some(FigureFormat::Png));
        assert_eq!((of("a"), of("a.pdf"), of(".svg")), (None, None, None));
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
