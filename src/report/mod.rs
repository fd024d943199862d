//! What people and other programs read of a [`Run`](crate::pipeline::Run): tables, verdicts, JSON
//! documents. Nautical at this border: degrees clockwise, starboard positive, every unit in its name.

mod assessment;
mod comparison;
mod conduct;

pub mod figure;
mod lint;
mod no_return;
pub mod page;
mod summary;
mod table;
mod verification;

mod write;

pub use crate::pipeline::Verdict;
pub use crate::text::{printable, printable_lines};
pub use assessment::assessment_text;
pub use comparison::{
    COMPARISON_COLUMNS, ComparisonRow, comparison_csv, comparison_markdown, comparison_table,
};
pub use lint::lint_text;
pub use no_return::{no_return_line, no_return_reason};
pub use summary::{Meeting, Summary, Turn};
pub use table::{Row, plan_text, suite_table};
pub use verification::verification_text;
pub use write::{WriteError, write_atomically};
