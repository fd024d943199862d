//! Campaigns: many closed-loop rows of one specification, in parts that any number of processes
//! write; merged, counted and sailed again (docs/guide/campaigns.md).

mod bounds;
mod encounter;
mod folder;
mod part;
mod rare;
mod row;
mod run;
mod specification;
mod splitting;
mod summary;

pub use bounds::{anytime, clopper_pearson};
pub use encounter::{Distribution, Encounter, EncounterKind, Miss};
pub use folder::{CampaignError, Folder, Index};
pub use part::{Header, Part, PartError, differing, untimed};
pub use rare::rare_contacts;
pub use row::{COLUMNS, Cell, Column, Row, TIMED};
pub use run::{Done, Progress, Shard, run};
pub use specification::{RowScenario, Specification, Stratum, StratumClass};
pub use splitting::Effort;
pub use summary::{distributions, merge, summarise};
