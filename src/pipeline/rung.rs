//! How far down the ladder an answer is.

/// How much of what was asked a plan keeps.
///
/// # Examples
///
/// ```
/// use searoom::frame::Vector;
/// use searoom::pipeline::{self, Rung};
/// use searoom::scenario::Scenario;
/// use searoom::target::Motion;
///
/// // own ship begins within the ferry's shape
/// let mut scenario = Scenario::read("scenarios/colregs/head-on.toml".as_ref())?;
/// let Motion::Ship(ferry) = &mut scenario.targets[0].motion else { panic!("a ship") };
/// ferry.pose.position = Vector::new(180.0, 40.0);
/// let run = pipeline::run(scenario);
/// // clear of what is left of the shape, and so of the ferry
/// assert!(run.rung >= Rung::Compliant && run.rung < Rung::Risk);
/// assert!(Rung::Domains < Rung::Risk, "in the order in which things are given up");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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
