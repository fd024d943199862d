//! One run, prepared for the views.

use super::{Canvas, Palette, ShownMotion};
use crate::pipeline::Run;

/// See [`Canvas::pane`]; with a lane of rules below it.
const PANE: [f64; 2] = [690.0, 357.0];

/// A run on its canvas.
#[derive(Debug)]
pub struct ViewModel<'a> {
    pub run: &'a Run,
    pub motion: ShownMotion<'a>,
    /// It ends at arrival, or at the end of the desired trajectory if that is later. Nothing is
    /// claimed after arrival, and the sets only grow.
    pub canvas: Canvas<'a>,
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
        let look = (Palette::Targets, PANE);
        let sets = run.targets.iter().map(|target| &target.sets);
        Self {
            run,
            motion,
            canvas: Canvas::new(&run.scenario, sets, &[motion], end, look),
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
