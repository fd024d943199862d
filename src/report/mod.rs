//! Reports: text and tables, an HTML page, and figures. Units are nautical: degrees clockwise,
//! starboard positive.

mod assessment;
mod campaign;
mod comparison;
#[cfg(feature = "figures")]
pub mod figure;
mod inspection;
mod lint;
#[cfg(feature = "figures")]
pub mod page;
mod plan;
mod route;
mod simulation;
mod table;
mod verification;
mod watch;

pub use crate::output::{WriteError, write_atomically};
pub use crate::text::{broken, counted, printable, printable_lines};
pub use assessment::assessment_text;
pub use campaign::{campaign_text, rare_contacts_text};
pub use comparison::comparison_table;
pub use inspection::{entities_table, timelines_text};
pub use lint::lint_text;
pub use plan::{
    NO_BOUND, bound_line, legs_text, no_return_line, no_return_reason, plan_document_text,
    plan_text, suite_table,
};
pub use route::{RouteError, RouteFormat};
pub use simulation::{simulation_markdown, simulation_text, simulations_line};
pub use table::{Display, ResultTable};
pub use verification::{simulation_verification_text, verification_line, verification_text};
pub use watch::watch_text;
