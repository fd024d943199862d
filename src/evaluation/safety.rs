//! What a motion enters: the fact beside that it is verified.

use super::{Least, Request, collision, grounding};
use crate::tolerance;

/// What a motion enters from start to arrival, the worst last.
///
/// # Examples
///
/// ```
/// use searoom::evaluation::Safety;
/// use searoom::pipeline;
/// use searoom::scenario::Scenario;
///
/// let mut scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let safety = |scenario| pipeline::run(scenario).evaluation.expect("a plan").safety;
/// assert_eq!(safety(scenario.clone()), Safety::Safe);
/// scenario.max_risk = 0.3;
/// assert_eq!(safety(scenario), Safety::Safe, "the shape alone is entered, not the hard set");
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Safety {
    /// No hard set, no hull and no land.
    Safe,
    /// A hard set, but not its level set of the accepted risk, and no hull.
    AtRisk,
    /// A hull that a target may have, a hard set of which nothing is kept, or the margin to land. So is a motion that own
    /// ship cannot sail, and whatever could not be proven.
    Unsafe,
    /// The hull of a target that keeps course and speed, or land.
    Collides,
}

impl Safety {
    /// Of a motion that can be sailed, or not.
    pub(super) fn of_motion(sound: bool) -> Self {
        if sound { Self::Safe } else { Self::Unsafe }
    }

    /// Of a motion at this distance from land.
    pub(super) fn of_land(least: &Least, request: &Request) -> Self {
        // negated on purpose: a NaN is aground
        if !(least.value >= -tolerance::DEPTH_M) {
            Self::Collides
        } else if grounding(least, request.land_margin).is_some() {
            Self::Unsafe
        } else {
            Self::Safe
        }
    }
}

/// What is kept of the sets of one target.
pub(super) struct Claim {
    /// The least distance to them.
    pub margin: Least,
    /// Seconds. Nothing is claimed of them before.
    pub from: f64,
    sets: usize,
    kept: bool,
}

impl Claim {
    /// Of a target without a set.
    pub fn new() -> Self {
        Self {
            margin: Least::new(),
            from: 0.0,
            sets: 0,
            kept: true,
        }
    }

    /// Takes note of one of her sets.
    pub fn see(&mut self, least: &Least, kept: bool, from: f64) {
        self.margin.see(least.value, least.time);
        self.from = self.from.max(from);
        self.sets += 1;
        self.kept &= kept;
    }

    /// Toward a ship: `closest` and `worst` are the distances from her hull where she keeps course and speed and from any that
    /// she may have, `centre` that of own ship's centre from the latter. Her hard set holds the places where own hull, on
    /// any heading, would be nearer than the margin.
    pub fn of_ship(
        &self,
        request: &Request,
        [closest, worst]: [&Least; 2],
        centre: impl FnOnce() -> Least,
    ) -> Safety {
        // negated on purpose: a NaN is a collision
        if !(closest.value >= -tolerance::DEPTH_M) {
            return Safety::Collides;
        }
        if collision("", worst, true).is_some() {
            return Safety::Unsafe;
        }
        self.of_hard_set(request, || {
            let mut least = centre();
            least.value -= request.own.hull.half_diagonal() + request.own.safety_margin;
            collision("", &least, true).is_none()
        })
    }

    /// Toward a target whose set is given: that is her hard set.
    pub fn of_set(&self, request: &Request, least: &Least, has_interior: bool) -> Safety {
        self.of_hard_set(request, || collision("", least, has_interior).is_none())
    }

    fn of_hard_set(&self, request: &Request, clear: impl FnOnce() -> bool) -> Safety {
        if self.from > 0.0 {
            return Safety::Unsafe;
        }
        let kept = self.sets > 0 && self.kept;
        // whole sets hold the hard ones
        if kept && request.max_risk == 0.0 || clear() {
            Safety::Safe
        } else if kept {
            Safety::AtRisk
        } else {
            Safety::Unsafe
        }
    }
}
