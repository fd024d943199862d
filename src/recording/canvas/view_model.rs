//! One run, prepared for the views.

use super::{Canvas, Palette, ShownMotion};
use crate::colregs::compliance::ComplianceReport;
use crate::pipeline::Run;

/// A run on its canvas.
#[derive(Debug)]
pub struct ViewModel<'a> {
    pub run: &'a Run,
    pub motion: ShownMotion<'a>,
    /// It ends at arrival, or at the end of the desired trajectory if that is later. Nothing is
    /// claimed after arrival, and the sets only grow.
    pub canvas: Canvas<'a>,
    /// How own ship behaves toward each target, in the order of the scenario; `None` for a target
    /// that is no ship, and without a plan.
    pub conduct: Vec<Option<ComplianceReport>>,
}

impl<'a> ViewModel<'a> {
    pub fn new(run: &'a Run) -> Self {
        let desired = &run.scenario.desired;
        let motion = match run.planned.outcome.plan() {
            Some(plan) => ShownMotion::Planned(&plan.trajectory),
            None => ShownMotion::Nominal(desired),
        };
        let end = motion.end().max(desired.duration());
        let end = end.min(run.scenario.horizon);
        let palette = Palette::Targets;
        let sets = run.targets.iter().map(|target| &target.sets);
        Self {
            run,
            motion,
            canvas: Canvas::new(&run.scenario, sets, &[motion], end, palette),
            conduct: run.judged_compliance(),
        }
    }
}

/// A view model is a canvas with a run on it.
impl<'a> std::ops::Deref for ViewModel<'a> {
    type Target = Canvas<'a>;

    fn deref(&self) -> &Canvas<'a> {
        &self.canvas
    }
}
