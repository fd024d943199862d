//! Colours and line widths. Own ship is the brightest, targets have a middle brightness, and the
//! desired motion is grey: they differ without colour, too.

use rerun::datatypes::Rgba32;
use rerun::{Color, Radius};

use crate::tolerance;

/// Behind the chart and the space-time volume, whatever the viewer's theme.
pub const BACKGROUND: Color = rgb(0x0b1220);
pub const OWN_SHIP: Color = rgb(0xffffff);
pub const DESIRED: Color = rgb(0x8fa3b8);
pub const GRID: Color = rgb(0x26344a);
pub const LAND: Color = rgb(0x685c3e);
pub const CHART_TEXT: Color = rgb(0xa0aec0);
pub const ALARM: Color = rgb(0xff2d2d);
pub const CLOSEST: Color = rgb(0x5cff9d);
pub const GRAPH_FREE: Color = rgb(0x1e4c54);
pub const GRAPH_BLOCKED: Color = rgb(0x60222c);
const SLOW: Color = rgb(0x408cff);
const FAST: Color = rgb(0xffe246);
const TARGETS: [Color; 6] = [
    rgb(0xff8040),
    rgb(0xe260be),
    rgb(0xb284ff),
    rgb(0x58b0b0),
    rgb(0xcea828),
    rgb(0x96aa5a),
];
const GREYS: [Color; 3] = [rgb(0xbcc2cc), rgb(0x8c929e), rgb(0xdee2e8)];

const fn rgb(digits: u32) -> Color {
    Color(Rgba32((digits << 8) | 0xff))
}

pub fn target(index: usize) -> Color {
    TARGETS[index % TARGETS.len()]
}

/// A grey for a target by its index, where colours distinguish own ships.
pub fn grey_target(index: usize) -> Color {
    GREYS[index % GREYS.len()]
}

/// Colour at a fraction of its strength on the [`BACKGROUND`].
pub fn toward_background(color: Color, strength: f32) -> Color {
    let (over, under) = (color.to_array(), BACKGROUND.to_array());
    let [r, g, b] = [0, 1, 2].map(|i| {
        let (over, under) = (f32::from(over[i]), f32::from(under[i]));
        (under + strength * (over - under)).round() as u8
    });
    Color::from_rgb(r, g, b)
}

pub fn translucent(color: Color, alpha: u8) -> Color {
    let [r, g, b, _] = color.to_array();
    Color::from_unmultiplied_rgba(r, g, b, alpha)
}

/// A width on the screen, whatever the zoom.
pub fn points(radius: f32) -> Radius {
    Radius::new_ui_points(radius)
}

/// How a planned speed compares with the desired one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SpeedClass {
    Slow,
    Desired,
    Fast,
}

impl SpeedClass {
    /// Compares a speed with the desired one, both m/s.
    pub fn of(speed: f64, desired: f64) -> Self {
        let slack = desired * tolerance::LIMIT;
        if speed < desired - slack {
            Self::Slow
        } else if speed > desired + slack {
            Self::Fast
        } else {
            Self::Desired
        }
    }

    /// Brighter is faster.
    pub fn color(self) -> Color {
        match self {
            Self::Slow => SLOW,
            Self::Desired => OWN_SHIP,
            Self::Fast => FAST,
        }
    }

    /// Thicker is faster.
    pub fn radius(self) -> f32 {
        match self {
            Self::Slow => 1.2,
            Self::Desired => 1.8,
            Self::Fast => 2.8,
        }
    }
}
