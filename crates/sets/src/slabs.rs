//! An obstacle as slabs in time, each convex in space-time: one where the velocity set never
//! changes, else one per velocity set, docs/reference/theory.md section 10 (ii).

use std::sync::{Arc, OnceLock};

use crate::closest_approach::{ClosestApproach, usable_horizon};
use crate::risk::{PeakRisk, level_of, peak_by_bisection};
use crate::space_time_obstacle::largest_risk_of_parts;
use crate::{EllipsoidObstacle, HalfSpace, PolytopeObstacle, SpaceTimeObstacle, Support};
use searoom_geometry::frame::Vector;
use searoom_geometry::tolerance::{self, ELLIPSE_SIDES};
use searoom_geometry::{ConvexPolygon, ConvexSet, Ellipse, SignedDistance};
use searoom_model::target::{Representation, TimedVelocitySet, Uncertainty};
use searoom_model::trajectory::{Segment, Trajectory};

/// Why velocity sets do not form a sequence.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum SlabError {
    /// No velocity set.
    #[error("no velocity sets; at least one is needed")]
    Empty,
    /// An end that is not after the previous one.
    #[error(
        "velocity set {index} ends at {found} s; it must end after {after} s, where it starts, and only the last may have no end"
    )]
    NotIncreasing {
        /// Index of the set, from 0.
        index: usize,
        /// Its end, seconds.
        found: f64,
        /// Exclusive lower bound of the end, seconds.
        after: f64,
    },
}

/// An obstacle that is convex in space-time: its velocity set never changes.
///
/// It is an enum and not a trait object because planners match on the kind, and documents write
/// each kind with its own keys.
#[derive(Debug, Clone)]
pub enum ConvexObstacle {
    /// Exact, paper eqs. (2)-(9).
    Polytope(PolytopeObstacle),
    /// Outer set, paper eqs. (12)-(19). Boxed because it is several times larger than the other.
    Ellipsoid(Box<EllipsoidObstacle>),
}

impl ConvexObstacle {
    /// From two sets: an ellipsoid where both are ellipses, else a polytope around them.
    fn outer_of(name: &str, initial: &ConvexSet, velocity: &ConvexSet) -> Self {
        match (initial, velocity) {
            (ConvexSet::Ellipse(initial), ConvexSet::Ellipse(velocity)) => {
                let ellipsoid = EllipsoidObstacle::new(name, *initial, *velocity);
                Self::Ellipsoid(Box::new(ellipsoid))
            }
            (initial, velocity) => {
                let [initial, velocity] =
                    [initial, velocity].map(|set| set.outer_polygon(ELLIPSE_SIDES));
                Self::Polytope(PolytopeObstacle::new(name, initial, velocity))
            }
        }
    }

    /// The set at the start of its clock, metres.
    pub fn initial(&self) -> ConvexSet {
        match self {
            Self::Polytope(o) => o.initial().clone().into(),
            Self::Ellipsoid(o) => (*o.initial()).into(),
        }
    }

    /// The velocity set, m/s.
    pub fn velocity(&self) -> ConvexSet {
        match self {
            Self::Polytope(o) => o.velocity().clone().into(),
            Self::Ellipsoid(o) => (*o.velocity()).into(),
        }
    }

    fn section(&self, time: f64) -> ConvexSet {
        match self {
            Self::Polytope(o) => o.section(time).into(),
            Self::Ellipsoid(o) => o.outer_section(time).into(),
        }
    }

    fn set(&self) -> &dyn SpaceTimeObstacle {
        match self {
            Self::Polytope(o) => o,
            Self::Ellipsoid(o) => o.as_ref(),
        }
    }
}

/// A time interval with one velocity set.
#[derive(Debug, Clone)]
pub struct Slab {
    start: f64,
    end: f64,
    obstacle: ConvexObstacle,
    /// Faces of a polytope, computed when alpha is first asked for.
    faces: OnceLock<Vec<SlabFace>>,
    /// Displacement of the target until the slab's start with the central velocities, metres.
    nominal: Vector,
    /// Displacement with any of the velocities, for ellipses.
    displacement: Option<Ellipse>,
}

impl Slab {
    /// Seconds from the scenario's start.
    pub fn start(&self) -> f64 {
        self.start
    }

    /// Seconds; infinite for the last.
    pub fn end(&self) -> f64 {
        self.end
    }

    /// The convex body of this slab: its initial set is the section at the slab's start, its clock
    /// starts there.
    pub fn obstacle(&self) -> &ConvexObstacle {
        &self.obstacle
    }

    /// A polytope that contains the body for `duration` seconds, at most as long as the slab: the
    /// body itself, or 64-gons around the ellipses, enlarged by the excess of the ellipsoid over
    /// their sum. `None` where that is unbounded, for an ellipse that is a segment.
    pub fn outer_polytope(&self, duration: f64) -> Option<PolytopeObstacle> {
        match &self.obstacle {
            ConvexObstacle::Polytope(o) => Some(o.clone()),
            ConvexObstacle::Ellipsoid(o) => {
                let growth = o.largest_ratio_to_sum(duration);
                let around =
                    |e: &Ellipse| e.scaled_about_center(growth).outer_polygon(ELLIPSE_SIDES);
                let polytope =
                    || PolytopeObstacle::new("", around(o.initial()), around(o.velocity()));
                growth.is_finite().then(polytope)
            }
        }
    }
}

/// Dependence of one face of a slab on alpha.
#[derive(Debug, Clone, Copy, PartialEq)]
struct SlabFace {
    normal: Vector,
    /// `h_O0(n)`, metres.
    initial_support: f64,
    /// `sum of duration (h_V(n) - n . v)` over the previous slabs, metres.
    spread_before: f64,
    /// `h_V(n) - n . v` of this slab, m/s.
    spread_rate: f64,
}

/// Every position that a target may reach whose velocity is in `V_k` from `t_k` to `t_k+1`.
///
/// `O_t = O_0 ⊕ sum of (t_j+1 - t_j) V_j ⊕ (t - t_k) V_k`, exact for polygons. For ellipses each
/// section is the ellipse of least trace around that sum, an outer set, and the next slab starts
/// from it. Sections and slabs are convex. The whole is not where the sets grow, so every query
/// goes slab by slab. A slab of polygons has the faces of `O_0` and of all sets so far.
#[derive(Debug, Clone)]
pub struct Obstacle {
    shared: Arc<Shared>,
}

/// Shared by all clones.
#[derive(Debug)]
struct Shared {
    name: String,
    sets: Uncertainty,
    slabs: Vec<Slab>,
}

impl From<ConvexObstacle> for Obstacle {
    fn from(obstacle: ConvexObstacle) -> Self {
        let name = obstacle.set().name().to_owned();
        let sets = Uncertainty::constant(obstacle.initial(), obstacle.velocity());
        let slab = Slab {
            start: 0.0,
            end: f64::INFINITY,
            obstacle,
            faces: OnceLock::new(),
            nominal: Vector::zeros(),
            displacement: None,
        };
        let slabs = vec![slab];
        Self {
            shared: Arc::new(Shared { name, sets, slabs }),
        }
    }
}

impl From<PolytopeObstacle> for Obstacle {
    fn from(obstacle: PolytopeObstacle) -> Self {
        ConvexObstacle::Polytope(obstacle).into()
    }
}

impl From<EllipsoidObstacle> for Obstacle {
    fn from(obstacle: EllipsoidObstacle) -> Self {
        ConvexObstacle::Ellipsoid(Box::new(obstacle)).into()
    }
}

impl PartialEq for Obstacle {
    fn eq(&self, other: &Self) -> bool {
        // everything else follows from these
        self.name() == other.name() && self.sets() == other.sets()
    }
}

impl Obstacle {
    /// From the sets of a target: all ellipses, or all polygons, else polygons around the ellipses.
    /// The last velocity set has no end, whatever its `until`.
    pub fn new(name: impl Into<String>, sets: Uncertainty) -> Result<Self, SlabError> {
        let Some((_, changes)) = sets.velocities.split_last() else {
            return Err(SlabError::Empty);
        };
        let mut after = 0.0;
        for (index, set) in changes.iter().enumerate() {
            let found = set.until;
            if !(found > after && found.is_finite()) {
                return Err(SlabError::NotIncreasing {
                    index,
                    found,
                    after,
                });
            }
            after = found;
        }
        Ok(Self::from_sequence(name.into(), sets))
    }

    fn from_sequence(name: String, mut sets: Uncertainty) -> Self {
        if let Some(last) = sets.velocities.last_mut() {
            last.until = f64::INFINITY;
        }
        let is_round = |set: &ConvexSet| set.as_ellipse().is_some();
        let round =
            is_round(&sets.initial) && sets.velocities.iter().all(|v| is_round(&v.velocities));
        if !round {
            sets.initial = sets.initial.outer_polygon(ELLIPSE_SIDES).into();
            for set in &mut sets.velocities {
                set.velocities = set.velocities.outer_polygon(ELLIPSE_SIDES).into();
            }
        }
        let mut slabs: Vec<Slab> = Vec::with_capacity(sets.velocities.len());
        let (mut start, mut nominal) = (0.0, Vector::zeros());
        let mut displacement = round.then(|| Ellipse::point(Vector::zeros()));
        let mut section = sets.initial.clone();
        for set in &sets.velocities {
            let end = set.until;
            let obstacle = ConvexObstacle::outer_of(&name, &section, &set.velocities);
            let center = set.velocities.center();
            let moved = displacement
                .map(|displacement| displacement_after(displacement, &set.velocities, end - start));
            if end.is_finite() {
                section = obstacle.section(end - start);
            }
            slabs.push(Slab {
                start,
                end,
                obstacle,
                faces: OnceLock::new(),
                nominal,
                displacement,
            });
            if end.is_finite() {
                nominal += center * (end - start);
                (start, displacement) = (end, moved);
            }
        }
        Self {
            shared: Arc::new(Shared { name, sets, slabs }),
        }
    }

    /// Dependence of each face of a slab on alpha. O(faces): the section at the slab's start is the
    /// sum of `O_0`, the nominal displacement and the spreads before.
    fn faces_of(&self, slab: &Slab, obstacle: &PolytopeObstacle) -> Vec<SlabFace> {
        let centroid = obstacle.velocity().centroid();
        let of = |face: &HalfSpace| {
            let initial_support = self.sets().initial.support(face.normal);
            let nominal = initial_support + face.normal.dot(&slab.nominal);
            SlabFace {
                normal: face.normal,
                initial_support,
                spread_before: (face.initial_support - nominal).max(0.0),
                spread_rate: face.velocity_support - face.normal.dot(&centroid),
            }
        };
        obstacle.faces().iter().map(of).collect()
    }

    /// These velocity sets with another set at t = 0, metres.
    pub fn with_initial(&self, initial: impl Into<ConvexSet>) -> Self {
        let sets = Uncertainty::new(initial.into(), self.sets().velocities.clone());
        Self::from_sequence(self.shared.name.clone(), sets)
    }

    /// The set at t = 0 and the velocity sets.
    pub fn sets(&self) -> &Uncertainty {
        &self.shared.sets
    }

    /// The slabs in order of time; the first starts at 0, the last has no end.
    pub fn slabs(&self) -> &[Slab] {
        &self.shared.slabs
    }

    /// The only slab's body, where the velocity set never changes.
    fn as_convex(&self) -> Option<&ConvexObstacle> {
        match self.slabs() {
            [slab] => Some(&slab.obstacle),
            _ => None,
        }
    }

    /// The polytope, if it is one.
    pub fn as_polytope(&self) -> Option<&PolytopeObstacle> {
        match self.as_convex() {
            Some(ConvexObstacle::Polytope(o)) => Some(o),
            _ => None,
        }
    }

    /// The ellipsoid, if it is one.
    pub fn as_ellipsoid(&self) -> Option<&EllipsoidObstacle> {
        match self.as_convex() {
            Some(ConvexObstacle::Ellipsoid(o)) => Some(o),
            _ => None,
        }
    }

    /// Kind of the sections.
    pub fn representation(&self) -> Representation {
        match self.sets().initial {
            ConvexSet::Polygon(_) => Representation::Polytope,
            ConvexSet::Ellipse(_) => Representation::Ellipsoid,
        }
    }

    /// The section `O_t` for `t >= 0`. O(faces).
    pub fn section(&self, time: f64) -> ConvexSet {
        let slab = self.slab_at(time);
        slab.obstacle.section(time - slab.start)
    }

    /// Polygon that contains the section, metres: exact for polygons, the circumscribed
    /// 64-gon of an ellipse.
    pub fn outer_section(&self, time: f64) -> ConvexPolygon {
        self.section(time).outer_polygon(ELLIPSE_SIDES)
    }

    /// The obstacle from `time` on, with a clock that starts then.
    ///
    /// Exact for polygons; an outer set for ellipses. A time below 0 or NaN counts as
    /// 0.
    pub fn remainder(&self, time: f64) -> Self {
        // negated so that a NaN counts as 0
        if !(time > 0.0) {
            return self.clone();
        }
        // the last set never ends, so one remains, and the ends increase
        Self::new(self.name(), self.remaining_sets(time)).unwrap_or_else(|_| self.clone())
    }

    /// The sets of [`Self::remainder`], for a finite time.
    pub fn remaining_sets(&self, time: f64) -> Uncertainty {
        let sets = self.sets();
        // negated so that a NaN counts as 0
        if !(time > 0.0) {
            return sets.clone();
        }
        let later = sets.velocities.iter().filter(|set| set.until > time);
        let mut later: Vec<TimedVelocitySet> = later
            .map(|set| TimedVelocitySet::new(set.until - time, set.velocities.clone()))
            .collect();
        // two ends may round to one
        later.dedup_by(|next, set| !(next.until > set.until));
        Uncertainty::new(self.section(time), later)
    }

    /// The largest risk over a chain of segments. Level sets are within the set, so they are
    /// compared only with the parts that meet it.
    fn peak_over(&self, segments: &[Segment]) -> PeakRisk {
        let start_time = segments.first().map_or(0.0, |s| s.start_time);
        if let Some(invalid) = segments.iter().find(|s| !s.is_valid()) {
            return PeakRisk::new(1.0, invalid.start_time);
        }
        let mut levels: Vec<(usize, PolytopeObstacle)> = Vec::new();
        let mut met: Vec<(usize, Segment)> = Vec::new();
        for (index, slab) in self.slabs().iter().enumerate() {
            let before = met.len();
            let later = segments.iter().filter(|s| s.end_time() >= slab.start);
            let during = later.take_while(|s| s.start_time <= slab.end);
            let parts = during.map(|s| s.between(slab.start, slab.end));
            met.extend(
                parts
                    .filter(|part| {
                        contact_within(slab.obstacle.set(), slab.start, part, 0.0).is_some()
                    })
                    .map(|part| (index, part)),
            );
            if let (true, ConvexObstacle::Polytope(o)) = (met.len() > before, &slab.obstacle) {
                levels.push((index, o.clone()));
            }
        }
        peak_by_bisection(start_time, |risk| {
            let alpha = level_of(risk);
            for (index, level) in &mut levels {
                let slab = &self.slabs()[*index];
                let ConvexObstacle::Polytope(whole) = &slab.obstacle else {
                    continue;
                };
                let faces = slab.faces.get_or_init(|| self.faces_of(slab, whole));
                // from the faces of the whole set, so that a risk of 0 gives the set itself
                let less = 1.0 - alpha;
                let both = whole.faces().iter().zip(faces);
                level.move_faces(both.map(|(face, spread)| Support {
                    value: face.initial_support - less * spread.spread_before,
                    rate: face.velocity_support - less * spread.spread_rate,
                }));
            }
            let round = levels.is_empty().then(|| self.at_risk(risk));
            let contacts = met.iter().filter_map(|(index, part)| {
                let start = self.slabs()[*index].start;
                match (
                    &round,
                    levels.binary_search_by_key(index, |(slab, _)| *slab),
                ) {
                    (Some(round), _) => {
                        contact_within(round.slabs()[*index].obstacle.set(), start, part, 0.0)
                    }
                    (None, Ok(k)) => contact_within(&levels[k].1, start, part, 0.0),
                    (None, Err(_)) => None,
                }
            });
            contacts.min_by(f64::total_cmp)
        })
    }

    fn slab_at(&self, time: f64) -> &Slab {
        &self.slabs()[self.index_at(time)]
    }

    /// Index of the slab at `time`; the first one before 0 and for a NaN.
    fn index_at(&self, time: f64) -> usize {
        let after = self.slabs().partition_point(|s| s.end <= time);
        after.min(self.slabs().len() - 1)
    }

    /// The slabs that a time interval meets, each with its part of the interval.
    fn slabs_within(&self, from: f64, to: f64) -> impl Iterator<Item = (&Slab, f64, f64)> {
        self.shared
            .slabs
            .iter()
            .map(move |s| (s, s.start.max(from), s.end.min(to)))
            .filter(|(_, start, end)| start <= end)
    }
}

/// First contact of a part of a segment with the body of a slab that begins at `start`.
fn contact_within(
    body: &dyn SpaceTimeObstacle,
    start: f64,
    part: &Segment,
    depth: f64,
) -> Option<f64> {
    let local = Segment {
        start_time: part.start_time - start,
        ..*part
    };
    let contact = body.first_contact(&local, depth);
    // conversion to and from the slab's own time costs a digit
    contact.map(|t| (t + start).max(part.start_time).min(part.end_time()))
}

impl SpaceTimeObstacle for Obstacle {
    fn name(&self) -> &str {
        &self.shared.name
    }

    fn support(&self, normal: Vector, time: f64) -> Support {
        let slab = self.slab_at(time);
        slab.obstacle.set().support(normal, time - slab.start)
    }

    fn signed_distance(&self, position: Vector, time: f64) -> SignedDistance {
        let slab = self.slab_at(time);
        slab.obstacle
            .set()
            .signed_distance(position, time - slab.start)
    }

    fn contains(&self, position: Vector, time: f64) -> bool {
        let slab = self.slab_at(time);
        slab.obstacle.set().contains(position, time - slab.start)
    }

    fn first_contact(&self, segment: &Segment, depth: f64) -> Option<f64> {
        if let Some(convex) = self.as_convex() {
            return convex.set().first_contact(segment, depth);
        }
        if !(segment.is_valid() && depth.is_finite()) {
            return Some(segment.start_time);
        }
        self.slabs_within(segment.start_time, segment.end_time())
            .find_map(|(slab, from, to)| {
                let part = segment.between(from, to);
                contact_within(slab.obstacle.set(), slab.start, &part, depth)
            })
    }

    /// One alpha for all velocity sets, each about its own centre. O(faces).
    fn alpha_within(&self, position: Vector, time: f64, edge: f64) -> f64 {
        if let Some(convex) = self.as_convex() {
            return convex.set().alpha_within(position, time, edge);
        }
        if time < 0.0 {
            return f64::INFINITY;
        }
        let index = self.index_at(time);
        let slab = &self.slabs()[index];
        let elapsed = time - slab.start;
        let velocities = &self.sets().velocities[index].velocities;
        let obstacle = match (&slab.obstacle, slab.displacement, &self.sets().initial) {
            (ConvexObstacle::Polytope(obstacle), ..) => obstacle,
            // the section is that of one ellipsoid after a second, in which it moves by the displacement
            (_, Some(displacement), ConvexSet::Ellipse(initial)) if time.is_finite() => {
                let displacement = displacement_after(displacement, velocities, elapsed);
                let whole = EllipsoidObstacle::new("", *initial, displacement);
                return whole.alpha_within(position, 1.0, edge);
            }
            _ => return 0.0,
        };
        let q = position - slab.nominal - velocities.center() * elapsed;
        let mut most = 0.0_f64;
        for face in slab.faces.get_or_init(|| self.faces_of(slab, obstacle)) {
            let beyond = face.normal.dot(&q) - face.initial_support;
            if beyond.is_nan() {
                return 0.0;
            }
            if beyond > edge {
                let spread = face.spread_before + elapsed * face.spread_rate;
                most = most.max(if spread > 0.0 {
                    beyond / spread
                } else {
                    f64::INFINITY
                });
            }
        }
        most
    }

    /// For several slabs by bisection over exact contacts, to [`tolerance::RISK`].
    fn peak_risk(&self, segment: &Segment) -> PeakRisk {
        match self.as_convex() {
            Some(convex) => convex.set().peak_risk(segment),
            None => self.peak_over(std::slice::from_ref(segment)),
        }
    }

    /// [`Self::peak_risk`] with each level set built once for all segments.
    fn peak_risk_along(&self, trajectory: &Trajectory) -> PeakRisk {
        if self.as_convex().is_some() || trajectory.steered().is_some() {
            return largest_risk_of_parts(self, trajectory);
        }
        self.peak_over(trajectory.segments())
    }

    fn at_risk(&self, risk: f64) -> Self {
        let alpha = level_of(risk);
        if alpha == 1.0 {
            return self.clone();
        }
        let mut sets = self.sets().clone();
        for set in &mut sets.velocities {
            set.velocities = set.velocities.scaled_about_center(alpha);
        }
        Self::from_sequence(self.shared.name.clone(), sets)
    }

    /// The minimum over the slabs; the earliest of equal ones.
    fn closest_approach(
        &self,
        position: Vector,
        velocity: Vector,
        horizon: f64,
    ) -> ClosestApproach {
        let Some(horizon) = usable_horizon(position, velocity, horizon) else {
            return ClosestApproach::contact(0.0);
        };
        let mut best: Option<ClosestApproach> = None;
        for (slab, start, end) in self.slabs_within(0.0, horizon) {
            let at = position + velocity * slab.start;
            let here = slab
                .obstacle
                .set()
                .closest_approach(at, velocity, end - start);
            let here = ClosestApproach {
                time: here.time + slab.start,
                ..here
            };
            if best.is_none_or(|b| here.distance < b.distance - tolerance::LENGTH_M) {
                best = Some(here);
            }
        }
        best.unwrap_or(ClosestApproach::contact(0.0))
    }

    /// True where any slab is met within the horizon. O(faces).
    fn in_velocity_obstacle(&self, position: Vector, velocity: Vector, horizon: f64) -> bool {
        let Some(horizon) = usable_horizon(position, velocity, horizon) else {
            return true;
        };
        self.slabs_within(0.0, horizon).any(|(slab, start, end)| {
            let at = position + velocity * slab.start;
            let convex = slab.obstacle.set();
            convex.in_velocity_obstacle(at, velocity, end - start)
        })
    }
}

/// Ellipse of least trace around a displacement and a further one with these velocities, metres.
fn displacement_after(displacement: Ellipse, velocities: &ConvexSet, duration: f64) -> Ellipse {
    match velocities {
        ConvexSet::Ellipse(velocity) if duration.is_finite() => {
            EllipsoidObstacle::new("", displacement, *velocity).outer_section(duration)
        }
        _ => displacement,
    }
}
