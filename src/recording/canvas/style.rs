//! Colours and line widths. Own ship is the brightest, targets have a middle brightness, and the
//! desired motion is grey: they differ without colour, too.

use rerun::{Color, Radius};

use crate::tolerance;

/// Behind the chart and the space-time volume, whatever the viewer's theme.
pub const BACKGROUND: (u8, u8, u8) = (11, 18, 32);
const OWN_SHIP: (u8, u8, u8) = (255, 255, 255);
const DESIRED: (u8, u8, u8) = (143, 163, 184);
const GRID: (u8, u8, u8) = (38, 52, 74);
const LAND: (u8, u8, u8) = (104, 92, 62);
const CHART_TEXT: (u8, u8, u8) = (160, 174, 192);
const ALARM: (u8, u8, u8) = (255, 45, 45);
const GRAPH_FREE: (u8, u8, u8) = (30, 76, 84);
const GRAPH_BLOCKED: (u8, u8, u8) = (96, 34, 44);
const TARGETS: [(u8, u8, u8); 6] = [
    (255, 128, 64),
    (226, 96, 190),
    (178, 132, 255),
    (88, 176, 176),
    (206, 168, 40),
    (150, 170, 90),
];
const GREYS: [(u8, u8, u8); 3] = [(188, 194, 204), (140, 146, 158), (222, 226, 232)];

pub fn rgb(color: (u8, u8, u8)) -> Color {
    Color::from_rgb(color.0, color.1, color.2)
}

pub fn background() -> Color {
    rgb(BACKGROUND)
}

pub fn own_ship() -> Color {
    rgb(OWN_SHIP)
}

pub fn desired() -> Color {
    rgb(DESIRED)
}

pub fn grid() -> Color {
    rgb(GRID)
}

pub fn land() -> Color {
    rgb(LAND)
}

pub fn chart_text() -> Color {
    rgb(CHART_TEXT)
}

pub fn alarm() -> Color {
    rgb(ALARM)
}

pub fn graph_free() -> Color {
    rgb(GRAPH_FREE)
}

pub fn graph_blocked() -> Color {
    rgb(GRAPH_BLOCKED)
}

/// The colour of a target by its index in the scenario.
pub fn target(index: usize) -> Color {
    rgb(TARGETS[index % TARGETS.len()])
}

/// A grey for a target by its index, where colours distinguish own ships.
pub fn grey_target(index: usize) -> Color {
    rgb(GREYS[index % GREYS.len()])
}

/// Colour at a fraction of its strength on the [`BACKGROUND`].
pub fn toward_background(color: Color, strength: f32) -> Color {
    let [r, g, b, _] = color.to_array();
    let mix = |c: u8, under: u8| {
        let value = f32::from(under) + strength * (f32::from(c) - f32::from(under));
        value.round().clamp(0.0, 255.0) as u8
    };
    Color::from_rgb(
        mix(r, BACKGROUND.0),
        mix(g, BACKGROUND.1),
        mix(b, BACKGROUND.2),
    )
}

/// Makes a colour translucent.
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
    /// Below the desired speed.
    Slow,
    /// At the desired speed.
    Desired,
    /// Above the desired speed.
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

    /// For the legend.
    pub fn name(self) -> &'static str {
        match self {
            Self::Slow => "slower",
            Self::Desired => "planned",
            Self::Fast => "faster",
        }
    }

    /// Brighter is faster.
    pub fn color(self) -> Color {
        match self {
            Self::Slow => Color::from_rgb(64, 140, 255),
            Self::Desired => own_ship(),
            Self::Fast => Color::from_rgb(255, 226, 70),
        }
    }

    /// Thicker is faster.
    pub fn radius(self) -> Radius {
        points(match self {
            Self::Slow => 1.2,
            Self::Desired => 1.8,
            Self::Fast => 2.8,
        })
    }
}
