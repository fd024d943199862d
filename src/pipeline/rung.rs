//! How far down the ladder an answer is.

/// How much of what was asked a plan keeps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Rung {
    /// All that compliance asks: the rules, and the sets as it shapes them, as far as own ship's start lets them be.
    Compliant,
    /// By the rules, and clear of the hard sets and of what is left of the shapes.
    Rules,
    /// Clear of the shapes, but not by the rules.
    Shapes,
    /// Clear of the hard sets, and of what is left of the shapes.
    Domains,
    /// Clear of the hard sets and of what is left of the shapes up to the horizon, but not at the end by then: along paths.
    Waiting,
    /// Clear of the level sets of the least risk that was found to leave a way.
    Risk,
    /// A hard set is entered or left, and nothing is claimed of it before.
    Inside,
}
