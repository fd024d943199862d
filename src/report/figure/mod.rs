//! Figures: panels in a grid, drawn as SVG, PNG or PDF. Equal panels give equal bytes.
//!
//! Charts have equal axes, and every axis has its unit. Fields use the viridis palette. Its
//! lightness increases with the value, so fields remain readable in greyscale print.

mod assessment;
mod campaign;
mod comparison;
mod field;
mod forces;
mod options;
mod outline;
mod panel;
mod path_time;
mod plan;
mod render;
mod sections;
mod simulation;

pub use assessment::assessment_figure;
pub(super) use campaign::distribution_panel;
pub use comparison::comparison_figure;
pub(super) use comparison::{comparison_panels, diagram_panels};
pub use field::{VelocityWindow, dcpa_panel, risk_panel};
pub use options::FigureOptions;
pub(super) use options::Style;
pub use panel::Panel;
pub use path_time::{ProfileLine, path_time_panel};
pub(super) use plan::plan_panels;
pub use plan::{chart_panel, explored_panel, path_panel, plan_figure};
pub use render::{Figure, FigureError, FigureFormat};
pub use sections::{extent_panel, sections_panel, set_panel};
pub use simulation::simulation_figure;
pub(super) use simulation::simulation_panel;

pub use crate::study::compare::Stroke;
