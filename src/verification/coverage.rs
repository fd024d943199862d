//! Are the sets large enough for what is known of the targets?
//!
//! A tracked ship's initial set has to contain her hull, on every heading that she may have until the horizon, ⊕ a disc of own
//! half-diagonal, safety margin and three standard deviations of her position; her velocity set every velocity with a speed and a course within the spreads, turned
//! as far as she may have turned. Explicit sets have to be contained as they are. Where risk was accepted, the velocity
//! sets are first scaled back about their centres.

use super::claim::Claim;
use super::reached;
use crate::evaluation::{SetShape, SpaceTimeSet, TurnedHull, Violation};
use crate::frame::{Vector, direction, to_port};
use crate::geometry::{ConvexPolygon, Ellipse, outer_enclosing_ellipse};
use crate::target::{Motion, Representation, ShipTrack, Target, VelocitySpell};
use crate::tolerance;

/// What a set may be too small for.
const INITIAL: &str = "the initial set, m";
const VELOCITY: &str = "the velocity set, m/s";
const LEVEL: &str = "the velocities at the accepted risk, m/s";

/// Standard deviations of the position that a set covers.
pub(super) const POSITION_SIGMAS: f64 = 3.0;

/// Radians, a quarter of a degree: half the angle between tangents of the faster arc. What they cut off beyond the arc is a
/// hundred-thousandth of the speed.
const TANGENT_SPACING: f64 = std::f64::consts::PI / 720.0;

/// Places around an ellipse at which it is compared with an ellipse.
pub(super) const SAMPLED_DIRECTIONS: usize = 720;

/// Every target without a set of her own, or with one that is too small; every set of nobody.
pub(super) fn check(claim: &Claim) -> Vec<Violation> {
    let mut found = Vec::new();
    let mut note = |what: String, time: f64| found.push(Violation { what, time });
    for set in &claim.sets {
        if !claim.targets.iter().any(|t| t.name == set.name) {
            note(
                format!("set of '{}': no target has this name", set.name),
                0.0,
            );
        }
    }
    for (index, target) in claim.targets.iter().enumerate() {
        let name = &target.name;
        if claim.targets[..index].iter().any(|t| t.name == *name) {
            note(format!("target '{name}': twice"), 0.0);
        }
        let mut own = claim.sets.iter().filter(|s| s.name == *name);
        let (Some(set), None) = (own.next(), own.next()) else {
            note(format!("target '{name}': not exactly one set"), 0.0);
            continue;
        };
        for (what, time) in lacks(claim, target, set) {
            note(format!("set of '{name}': {what}"), time);
        }
    }
    found
}

/// What a set lacks of a target, and from when.
fn lacks(claim: &Claim, target: &Target, set: &SpaceTimeSet) -> Vec<(String, f64)> {
    let level = 1.0 - claim.file.max_risk;
    let enclosed = claim.file.optimal_control.is_some();
    // the ellipse around a polygon that was scaled has a centre of its own: it cannot be scaled back
    let velocities_known = level == 1.0 || !enclosed;
    let whole = Whole::of(&set.shape, level, set.from);
    let mut lacks = Vec::new();
    let mut need = |what: &str, short: f64, time: f64| {
        // negated on purpose: a NaN is too small
        if !(short <= tolerance::DEPTH_M) {
            lacks.push((format!("too small for {what}: by {short:.3e}"), time));
        }
    };
    if set.from > 0.0 {
        need(
            "where she may be when it has been left, m",
            reached::short(claim, target, &whole.initial, set.from),
            set.from,
        );
    }
    let at_start = set.from == 0.0;
    match &target.motion {
        Motion::Ship(ship) => {
            let reach = claim.own.hull.half_diagonal()
                + claim.own.safety_margin
                + POSITION_SIGMAS * ship.position_std;
            if at_start {
                let hull = TurnedHull::of(ship, claim.file.horizon_s);
                need(
                    "the hull, the margin and the uncertainty, m",
                    whole.initial.beyond_hull(&hull) + reach,
                    0.0,
                );
            }
            if velocities_known {
                for spell in &whole.spells {
                    let short = spell
                        .set
                        .beyond(&Sector::of(ship, spell.until.min(claim.file.horizon_s)));
                    need("her velocities, m/s", short, spell.start);
                }
            }
            if let ([only], true) = (&whole.spells[..], level < 1.0 && ship.turn_rate == 0.0) {
                let known = at_level(target, &ship.outer_velocity_set(), level);
                need(LEVEL, only.level.beyond_polygon(&known), 0.0);
            }
        }
        Motion::Sets { initial, velocity } => {
            if at_start {
                need(INITIAL, whole.initial.beyond_polygon(initial), 0.0);
            }
            for spell in &whole.spells {
                if velocities_known {
                    need(VELOCITY, spell.set.beyond_polygon(velocity), spell.start);
                }
                if level < 1.0 {
                    let known = at_level(target, velocity, level);
                    need(LEVEL, spell.level.beyond_polygon(&known), spell.start);
                }
            }
        }
        Motion::Ellipses { initial, velocity } => {
            if at_start {
                need(INITIAL, whole.initial.beyond_ellipse(initial), 0.0);
            }
            for spell in &whole.spells {
                if velocities_known {
                    need(VELOCITY, spell.set.beyond_ellipse(velocity), spell.start);
                }
                if level < 1.0 {
                    let known = velocity.scaled_about_center(level);
                    need(LEVEL, spell.level.beyond_ellipse(&known), spell.start);
                }
            }
        }
        Motion::Spells { initial, spells } => {
            if at_start {
                need(INITIAL, whole.initial.beyond_polygon(initial), 0.0);
            }
            if velocities_known {
                for spell in &whole.spells {
                    for known in
                        overlapping(spells, spell.start, spell.until.min(claim.file.horizon_s))
                    {
                        need(
                            VELOCITY,
                            spell.set.beyond_polygon(&known.velocities),
                            spell.start,
                        );
                    }
                }
            }
            if level < 1.0 {
                for spell in &whole.spells {
                    let until = spell.until.min(claim.file.horizon_s);
                    for known in overlapping(spells, spell.start, until) {
                        let known = at_level(target, &known.velocities, level);
                        need(LEVEL, spell.level.beyond_polygon(&known), spell.start);
                    }
                }
            }
        }
    }
    lacks
}

/// The largest, NaN if any is.
pub(super) fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::NEG_INFINITY, |most, v| {
        if v > most || v.is_nan() { v } else { most }
    })
}

/// Those that hold for a while between two times.
fn overlapping(
    spells: &[VelocitySpell],
    from: f64,
    until: f64,
) -> impl Iterator<Item = &VelocitySpell> {
    let starts = std::iter::once(0.0).chain(spells.iter().map(|s| s.until));
    starts
        .zip(spells)
        .filter(move |(start, s)| start.max(from) + tolerance::TIME_S < s.until.min(until))
        .map(|(_, s)| s)
}

/// A set before risk was accepted.
struct Whole {
    initial: Bounded,
    spells: Vec<Spell>,
}

struct Spell {
    start: f64,
    until: f64,
    set: Bounded,
    /// As the document has it.
    level: Bounded,
}

impl Whole {
    /// Times are those of the document: the clock of the set starts at `from`.
    fn of(shape: &SetShape, level: f64, from: f64) -> Self {
        match shape {
            SetShape::Polygons { initial, spells } => {
                let starts = std::iter::once(0.0).chain(spells.iter().map(|s| s.until));
                Self {
                    initial: Bounded::Polygon(initial.clone()),
                    spells: starts
                        .zip(spells)
                        .map(|(start, spell)| Spell {
                            start: from + start,
                            until: from + spell.until,
                            set: Bounded::Polygon(about_centroid(&spell.velocities, level.recip())),
                            level: Bounded::Polygon(spell.velocities.clone()),
                        })
                        .collect(),
                }
            }
            SetShape::Ellipses { initial, velocity } => Self {
                initial: Bounded::Ellipse(*initial),
                spells: vec![Spell {
                    start: from,
                    until: f64::INFINITY,
                    set: Bounded::Ellipse(velocity.scaled_about_center(level.recip())),
                    level: Bounded::Ellipse(*velocity),
                }],
            },
        }
    }
}

/// A polygon scaled about its centroid: what a level of risk does to a velocity set.
pub(super) fn about_centroid(set: &ConvexPolygon, factor: f64) -> ConvexPolygon {
    let center = set.centroid();
    set.translated(-center).scaled(factor).translated(center)
}

/// What is known of a target's velocities at a level: scaled about the centre that her representation has.
fn at_level(target: &Target, velocities: &ConvexPolygon, level: f64) -> ConvexPolygon {
    match target.representation {
        Representation::Polytope => about_centroid(velocities, level),
        Representation::Ellipsoid => {
            let center = outer_enclosing_ellipse(velocities).center();
            let about = velocities.translated(-center);
            about.scaled(level).translated(center)
        }
    }
}

pub(super) enum Bounded {
    Polygon(ConvexPolygon),
    Ellipse(Ellipse),
}

impl Bounded {
    /// Signed, negative inside: a disc is contained when its centre is as deep as its radius.
    fn distance(&self, p: Vector) -> f64 {
        match self {
            Self::Polygon(set) => set.signed_distance(p),
            Self::Ellipse(set) => set.signed_distance(p).distance,
        }
    }

    /// How far the farthest point of a polygon is outside.
    fn beyond_polygon(&self, set: &ConvexPolygon) -> f64 {
        largest(set.vertices().iter().map(|p| self.distance(*p)))
    }

    /// How far an ellipse reaches outside: exactly for a polygon, in the directions of [`sampled_directions`] for an ellipse.
    fn beyond_ellipse(&self, set: &Ellipse) -> f64 {
        match self {
            Self::Polygon(own) => {
                let normals = own.normals().into_iter();
                largest(normals.map(|n| set.support(n) - own.support(n)))
            }
            Self::Ellipse(own) => {
                largest(sampled_directions(own).map(|n| set.support(n) - own.support(n)))
            }
        }
    }

    /// How far a turned hull reaches outside, negative where it is inside: exactly for a polygon, by tangents of the arcs that its
    /// corners make for an ellipse.
    fn beyond_hull(&self, hull: &TurnedHull) -> f64 {
        match self {
            Self::Polygon(set) if set.vertices().len() > 2 => {
                let normals = set.normals().into_iter();
                largest(normals.map(|n| hull.support(n) - set.support(n)))
            }
            _ => largest(hull.outer_points(TANGENT_SPACING).map(|p| self.distance(p))),
        }
    }

    /// How far a sector of velocities reaches outside: exactly for a polygon, by tangents that contain the sector for an ellipse.
    fn beyond(&self, sector: &Sector) -> f64 {
        match self {
            Self::Polygon(set) if set.vertices().len() > 2 => largest(
                set.normals()
                    .into_iter()
                    .map(|n| sector.support(n) - set.support(n)),
            ),
            _ => largest(sector.outer_points().into_iter().map(|p| self.distance(p))),
        }
    }
}

/// Unit vectors all around, evenly, and the normals of an ellipse at places all around it: where it is a needle, nearly all are across.
pub(super) fn sampled_directions(ellipse: &Ellipse) -> impl Iterator<Item = Vector> {
    let [a, b] = ellipse.semi_axes();
    let step = std::f64::consts::TAU / SAMPLED_DIRECTIONS as f64;
    (0..SAMPLED_DIRECTIONS).flat_map(move |k| {
        let z = direction(step * k as f64);
        let tangent = b * z.x - a * z.y;
        let normal = tangent.try_normalize(0.0).map(to_port);
        [Some(z), normal].into_iter().flatten()
    })
}

/// Every velocity with a speed and a course within bounds.
pub(super) struct Sector {
    slow: f64,
    fast: f64,
    heading: f64,
    /// To either side, radians.
    spread: f64,
}

impl Sector {
    pub fn of(ship: &ShipTrack, until: f64) -> Self {
        Self {
            slow: (ship.speed - ship.speed_spread).max(0.0),
            fast: ship.speed + ship.speed_spread,
            heading: ship.pose.heading,
            spread: (ship.course_spread + ship.turn_rate * until).min(std::f64::consts::PI),
        }
    }

    /// In closed form: the course within the spread that is nearest to the direction.
    pub fn support(&self, n: Vector) -> f64 {
        let off = crate::frame::wrap(crate::frame::heading_of(n) - self.heading).abs();
        let along = (off - self.spread).max(0.0).cos();
        (self.fast * along).max(self.slow * along)
    }

    /// Points whose hull contains the sector, on it but for the tangents' corners.
    fn outer_points(&self) -> Vec<Vector> {
        let edges = [-self.spread, self.spread].map(|edge| direction(self.heading + edge));
        let mut points: Vec<Vector> = edges
            .into_iter()
            .flat_map(|ahead| [ahead * self.slow, ahead * self.fast])
            .collect();
        if self.spread > 0.0 {
            let pieces = (self.spread / TANGENT_SPACING).ceil().max(1.0);
            let half = self.spread / pieces;
            points.extend((0..pieces as usize).map(|piece| {
                let middle = self.heading - self.spread + half * (2 * piece + 1) as f64;
                direction(middle) * (self.fast / half.cos())
            }));
        }
        points
    }
}
