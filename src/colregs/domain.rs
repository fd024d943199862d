//! Shapes of the initial set: where a target's ship may be, with what own ship is to keep of her
//! folded in, and what the rules of the road add to it (docs/colregs.md 3.2-3.3).

use super::encounter::{Risk, offset_from_wake, risk_distance};
use super::rules::ClosedSide;
use crate::frame::{Pose, Vector, direction, to_port};
use crate::geometry::{ConvexPolygon, outer_disc};
use crate::target::{DomainKind, ShipTrack};
use crate::tolerance;
use crate::vessel::OwnShip;

/// The two initial sets of one target, for own ship's centre, metres.
#[derive(Debug, Clone, PartialEq)]
pub struct Shapes {
    /// Hull and own ship, each on any heading it may have, safety margin, position uncertainty: safety is claimed on this.
    pub hard: ConvexPolygon,
    /// `hard` and the domain around it; contains `hard`.
    pub shaped: ConvexPolygon,
    /// The same before it was drawn back to let own ship start outside.
    pub full: ConvexPolygon,
    /// Metres by which the shape was drawn back to let own ship start outside: the largest distance
    /// of a point of the full shape from the one used. 0 when it was not.
    pub reduced: f64,
    /// Metres from the hard set to the farthest point of the full shape: what giving it up altogether
    /// would draw back.
    pub reach: f64,
}

/// The initial sets of a tracked ship, docs/colregs.md 3.3:
///
/// - hull = [`ShipTrack::outer_hull`], on every heading that she may have until `horizon` seconds;
/// - hard = hull ⊕ disc(own half-diagonal + safety margin + three standard deviations);
/// - shaped = (conv(base ∪ hull) ⊕ `[0, e]`) ⊕ the same disc.
///
/// The disc is an outer 16-gon aligned with the target. The base holds the hull before it is swept, so
/// that the shape contains the hard set by construction and, the base being symmetric, its asymmetry
/// is exactly `e . n_bad`, hull or not. The base is sized by the target's length alone; margin and own
/// size enter once, with the disc. `risk` is the first instant of risk, for the "colregs" domain only:
/// its `e` is [`sweep`]. A target without risk, at rest, or to be stood on for, keeps the bare base.
///
/// Where the shape, but not the hard set, contains own ship's start, it is drawn back just enough to
/// leave her [`tolerance::START_M`] outside: first `e` shrinks, then the base toward the hull. A
/// start inside the hard set changes nothing: there is no plan to be had. A value that is not finite makes
/// the set the origin; checked input has none.
pub fn shapes(own: &OwnShip, target: &ShipTrack, risk: Option<&Risk>, horizon: f64) -> Shapes {
    // about the target: far from the origin digits of every edge would be lost
    let place = target.pose.position;
    let about = |pose: Pose| Pose::new(pose.position - place, pose.heading);
    let own = &OwnShip {
        pose: about(own.pose),
        ..own.clone()
    };
    let target = &ShipTrack {
        pose: about(target.pose),
        ..target.clone()
    };
    let about = shapes_about(own, target, risk, horizon);
    Shapes {
        hard: about.hard.translated(place),
        shaped: about.shaped.translated(place),
        full: about.full.translated(place),
        ..about
    }
}

/// The same of a target at the origin.
fn shapes_about(own: &OwnShip, target: &ShipTrack, risk: Option<&Risk>, horizon: f64) -> Shapes {
    let around = outer_disc(
        own.hull.half_diagonal()
            + own.safety_margin
            + tolerance::POSITION_SIGMAS * target.position_std,
        target.pose.heading,
    );
    let hull = target.outer_hull(horizon);
    let hard = hull.minkowski_sum(&around);
    if target.domain == DomainKind::Hull {
        return Shapes {
            shaped: hard.clone(),
            full: hard.clone(),
            hard,
            reduced: 0.0,
            reach: 0.0,
        };
    }
    let shape = Shape {
        base: base(target, &hull),
        sweep: match (target.domain, risk) {
            (DomainKind::Colregs, Some(risk)) => sweep(own, target, risk),
            _ => Vector::zeros(),
        },
        hull,
        around,
    };
    let shaped = shape.at(1.0, 1.0);
    debug_assert!(
        risk.is_none() || keeps_the_design_inequality(own, target, shape.sweep, &shaped),
        "swept by {:?}",
        shape.sweep
    );
    let reach = beyond(&shaped, &hard);
    let start = own.pose.position;
    let clear = |set: &ConvexPolygon| set.signed_distance(start) >= tolerance::START_M;
    if shaped.signed_distance(start) > 0.0 || hard.contains(start) {
        return Shapes {
            hard,
            full: shaped.clone(),
            shaped,
            reduced: 0.0,
            reach,
        };
    }
    let used = if clear(&shape.at(1.0, 0.0)) {
        shape.at(1.0, largest(|swept| clear(&shape.at(1.0, swept))))
    } else {
        shape.at(largest(|grown| clear(&shape.at(grown, 0.0))), 0.0)
    };
    Shapes {
        hard,
        reduced: beyond(&shaped, &used),
        shaped: used,
        full: shaped,
        reach,
    }
}

/// docs/colregs.md 3.2: passing on the side that the rules forbid asks for at least two risk distances more than on the other, where
/// the margin is kept. True of a shape that is not swept, and of one that has no size in numbers.
fn keeps_the_design_inequality(
    own: &OwnShip,
    target: &ShipTrack,
    sweep: Vector,
    shaped: &ConvexPolygon,
) -> bool {
    let Some(bad) = sweep.try_normalize(0.0) else {
        return true;
    };
    let centre = target.pose.position;
    let reach = |n: Vector| shaped.support(n) - n.dot(&centre);
    let rounding = 1e-9 * (1.0 + centre.norm() + sweep.norm());
    let short = 2.0 * risk_distance(own, target) - (reach(bad) - reach(-bad));
    short.is_nan() || short <= rounding && reach(-bad) >= own.safety_margin - rounding
}

impl Shapes {
    /// What is left of the shape when it is drawn back toward the hard set, all around at once: `kept` of 1 is
    /// `shaped`, 0 is `hard`. Convex, nested and between the two. O(n + m).
    pub fn drawn_back(&self, kept: f64) -> ConvexPolygon {
        let (hard, shaped) = (self.hard.scaled(1.0 - kept), self.shaped.scaled(kept));
        hard.minkowski_sum(&shaped)
    }

    /// Metres by which a set is short of the full shape: the largest distance of a point of that from it.
    pub fn cut(&self, used: &ConvexPolygon) -> f64 {
        beyond(&self.full, used)
    }
}

/// The largest distance of a point of one set from the other, metres.
fn beyond(set: &ConvexPolygon, other: &ConvexPolygon) -> f64 {
    set.vertices()
        .iter()
        .map(|p| other.signed_distance(*p))
        .fold(0.0, f64::max)
}

/// What a shape is made of, in the plane.
struct Shape {
    base: ConvexPolygon,
    hull: ConvexPolygon,
    sweep: Vector,
    around: ConvexPolygon,
}

impl Shape {
    /// The shape with the base grown from the hull (0) to its full size (1), and the given fraction of
    /// the sweep. Nested: more of either contains less of it.
    fn at(&self, grown: f64, swept: f64) -> ConvexPolygon {
        let body = if grown < 1.0 {
            let (base, hull) = (self.base.scaled(grown), self.hull.scaled(1.0 - grown));
            base.minkowski_sum(&hull)
        } else {
            self.base.clone()
        };
        let way = [Vector::zeros(), self.sweep * swept];
        let way = hull_or_origin(&way);
        body.minkowski_sum(&way).minkowski_sum(&self.around)
    }
}

/// conv(base ∪ hull) in the world.
fn base(target: &ShipTrack, hull: &ConvexPolygon) -> ConvexPolygon {
    let (length, half_length, half_beam) = (
        target.hull.length,
        target.hull.length / 2.0,
        target.hull.beam / 2.0,
    );
    let mut points: Vec<Vector> = match target.domain {
        DomainKind::Hull => Vec::new(),
        DomainKind::Colregs => BevelledBox::symmetric().corners(length).to_vec(),
        DomainKind::Paper => BevelledBox::one_size().corners(length).to_vec(),
        DomainKind::Custom {
            fore,
            aft,
            port,
            starboard,
        } => {
            let (fore, aft) = (half_length + fore, -half_length - aft);
            let (port, starboard) = (half_beam + port, -half_beam - starboard);
            [
                (fore, starboard),
                (fore, port),
                (aft, port),
                (aft, starboard),
            ]
            .map(|(ahead, port)| Vector::new(ahead, port))
            .to_vec()
        }
    };
    let pose: &Pose = &target.pose;
    for p in &mut points {
        *p = pose.world_coordinates(*p);
    }
    points.extend_from_slice(hull.vertices());
    hull_or_origin(&points)
}

fn hull_or_origin(points: &[Vector]) -> ConvexPolygon {
    ConvexPolygon::hull(points).unwrap_or_else(|_| ConvexPolygon::point(Vector::zeros()))
}

/// The largest fraction in `[0, 1]` that satisfies a condition which, once lost, stays lost; by
/// bisection to rounding. 0 when none does.
fn largest(holds: impl Fn(f64) -> bool) -> f64 {
    const STEPS: usize = 40;
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if holds(middle) {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// How much the sweep exceeds what the design inequality needs: covers a planner that does not find
/// the exact optimum.
const SWEEP_EXCESS: f64 = 0.1;

/// Radians. Own ship this far off the wake of the ship that she overtakes passes on that side (5°).
const OFF_THE_WAKE: f64 = std::f64::consts::PI / 36.0;

/// `e` of docs/colregs.md 3.3, metres: which way, and how far, the base is swept. Passing on the side that
/// the rules forbid then costs `|e| = 2 (1 + 0.1)` risk distances more of displacement than on the other,
/// so that the cheaper side is the compliant one for every miss distance that is a risk (3.2).
///
/// The direction is the normal of the relative velocity at the first instant of risk on the bad side:
/// the target's starboard side in a head-on or port-to-port meeting; ahead of her when giving way; when
/// overtaking her starboard side, unless own ship is more than 5° to starboard of her wake, then her
/// port side. Zero for every other role.
pub fn sweep(own: &OwnShip, target: &ShipTrack, risk: &Risk) -> Vector {
    let ahead = direction(target.pose.heading);
    let port = to_port(ahead);
    // the bad side, and what decides when the normal has no part in it
    let (bad, otherwise) = match risk.role.duties().closed_side {
        ClosedSide::Starboard => (-port, ahead),
        ClosedSide::Ahead => (ahead, -port),
        ClosedSide::AcrossWake if offset_from_wake(risk) > OFF_THE_WAKE => (port, ahead),
        ClosedSide::AcrossWake => (-port, ahead),
        ClosedSide::None => return Vector::zeros(),
    };
    let relative = risk.own.velocity() - risk.target.velocity();
    let Some(along) = relative.try_normalize(0.0) else {
        return Vector::zeros();
    };
    let normal = to_port(along);
    let toward = match normal.dot(&bad) {
        0.0 => normal.dot(&otherwise),
        part => part,
    };
    normal * toward.signum() * (2.0 * (1.0 + SWEEP_EXCESS) * risk_distance(own, target))
}

/// A bevelled box about a ship, in her lengths: how far it reaches, and the fraction of the side reach
/// to which it is bevelled at the bow and at the stern.
struct BevelledBox {
    fore: f64,
    aft: f64,
    port: f64,
    starboard: f64,
    bow: f64,
    stern: f64,
}

impl BevelledBox {
    /// The symmetric base of the "colregs" domain: two lengths ahead and astern, one and a half
    /// abeam. The bevel leans by a multiple of 22.5°, like the sides of the disc that is added: the
    /// sum has 16 edges instead of 20. The safety margin is not in here, it is in that disc.
    fn symmetric() -> Self {
        let (along, abeam) = (2.0, 1.5);
        let bevel = 1.0 - (std::f64::consts::PI / 8.0).tan() * (along / 2.0) / abeam;
        Self {
            fore: along,
            aft: along,
            port: abeam,
            starboard: abeam,
            bow: bevel,
            stern: bevel,
        }
    }

    /// The "paper" domain: a large forbidden region in front and to starboard.
    fn one_size() -> Self {
        Self {
            fore: 6.0,
            aft: 2.0,
            port: 1.5,
            starboard: 4.0,
            bow: 0.5,
            stern: 0.5,
        }
    }

    /// `P(f, a, p, s, kf, ka)` of docs/colregs.md 3.3, `(ahead, to port)` in units of `length`.
    fn corners(&self, length: f64) -> [Vector; 8] {
        [
            (self.fore, -self.bow * self.starboard),
            (self.fore, self.bow * self.port),
            (self.fore / 2.0, self.port),
            (-self.aft / 2.0, self.port),
            (-self.aft, self.stern * self.port),
            (-self.aft, -self.stern * self.starboard),
            (-self.aft / 2.0, -self.starboard),
            (self.fore / 2.0, -self.starboard),
        ]
        .map(|(ahead, port)| Vector::new(ahead, port) * length)
    }
}

#[cfg(test)]
mod tests;
