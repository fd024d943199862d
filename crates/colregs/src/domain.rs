//! Ship domains: the initial set of a target for own ship's centre, enlarged so that the cheapest
//! plan follows the collision regulations (docs/reference/colregs.md 3.2-3.3).

use super::encounter::{Risk, offset_from_wake, sweep_distance};
use super::rules::ClosedSide;
use searoom_geometry::frame::{Pose, Vector, direction, to_port};
use searoom_geometry::numerics::bisected;
use searoom_geometry::tolerance;
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_model::target::{DomainKind, ShipTrack};
use searoom_model::vessel::OwnShip;

/// Initial sets of one target for own ship's centre, metres: hard set and ship domain.
#[derive(Debug, Clone, PartialEq)]
pub struct ShipDomain {
    /// Hulls on every possible heading, safety margin and position uncertainty: the claim of
    /// safety.
    pub hard: ConvexPolygon,
    /// The ship domain; contains `hard`.
    pub with_domain: ConvexPolygon,
    /// The ship domain before it was reduced to let own ship start outside.
    pub full: ConvexPolygon,
    /// Largest distance of a point of `full` from `with_domain`, metres; 0 if it was not reduced.
    pub reduced: f64,
    /// Largest distance of a point of `full` from `hard`, metres.
    pub reach: f64,
}

/// The initial sets of a tracked ship, docs/reference/colregs.md 3.3:
///
/// - hull = [`ShipTrack::outer_hull`], on every possible heading until `horizon` seconds;
/// - hard = hull ⊕ disc(own half-diagonal + safety margin + three standard deviations);
/// - with_domain = (conv(base ∪ hull) ⊕ `[0, e]`) ⊕ the same disc.
///
/// The disc is an outer 16-gon aligned with the target. The base contains the hull before it is
/// swept, so the domain contains the hard set by construction. The base is symmetric, so the
/// asymmetry of the domain is exactly `e . n_bad`. The base is sized by the target's length alone;
/// margin and own size enter once, with the disc. `risk` is the first instant of risk, for the
/// "colregs" domain only: its `e` is [`sweep`]. A target without risk, at rest, or to stand on for,
/// has the bare base.
///
/// If the domain, but not the hard set, contains own ship's start, it is reduced until own ship is
/// [`tolerance::START_M`] outside: first `e` shrinks, then the base toward the hull. A start inside
/// the hard set changes nothing: there is no plan. A value that is not finite makes the set the
/// origin; checked input has none.
pub fn ship_domain(
    own: &OwnShip,
    target: &ShipTrack,
    risk: Option<&Risk>,
    horizon: f64,
) -> ShipDomain {
    // relative to the target: far from the origin every edge would lose digits
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
    let about = ship_domain_about(own, target, risk, horizon);
    ShipDomain {
        hard: about.hard.translated(place),
        with_domain: about.with_domain.translated(place),
        full: about.full.translated(place),
        ..about
    }
}

/// [`ship_domain`] for a target at the origin.
fn ship_domain_about(
    own: &OwnShip,
    target: &ShipTrack,
    risk: Option<&Risk>,
    horizon: f64,
) -> ShipDomain {
    let reach = own.hull.half_diagonal() + own.safety_margin;
    let around = match &target.kept_positions {
        // the same polygon as below where nothing is excluded
        Some(_) => {
            outer_disc(reach, target.middle_course()).minkowski_sum(&target.outer_positions())
        }
        None => outer_disc(
            reach + tolerance::SIGMAS * target.position_std,
            target.middle_course(),
        ),
    };
    let hull = target.outer_hull(horizon);
    let hard = hull.minkowski_sum(&around);
    if target.domain == DomainKind::Hull {
        return ShipDomain {
            with_domain: hard.clone(),
            full: hard.clone(),
            hard,
            reduced: 0.0,
            reach: 0.0,
        };
    }
    let parts = DomainParts {
        base: base(target, &hull),
        sweep: match (target.domain, risk) {
            (DomainKind::Colregs, Some(risk)) => sweep(own, target, risk),
            _ => Vector::zeros(),
        },
        hull,
        around,
    };
    let with_domain = parts.at(1.0, 1.0);
    debug_assert!(
        risk.is_none() || keeps_the_design_inequality(own, target, parts.sweep, &with_domain),
        "swept by {:?}",
        parts.sweep
    );
    let reach = beyond(&with_domain, &hard);
    let start = own.pose.position;
    let clear = |set: &ConvexPolygon| set.signed_distance(start) >= tolerance::START_M;
    if with_domain.signed_distance(start) > 0.0 || hard.contains(start) {
        return ShipDomain {
            hard,
            full: with_domain.clone(),
            with_domain,
            reduced: 0.0,
            reach,
        };
    }
    let used = if clear(&parts.at(1.0, 0.0)) {
        parts.at(1.0, largest(|swept| clear(&parts.at(1.0, swept))))
    } else {
        parts.at(largest(|grown| clear(&parts.at(grown, 0.0))), 0.0)
    };
    ShipDomain {
        hard,
        reduced: beyond(&with_domain, &used),
        with_domain: used,
        full: with_domain,
        reach,
    }
}

/// docs/reference/colregs.md 3.2: passing on the forbidden side takes at least two sweep distances
/// more than on the other, where the margin is kept. True for a domain that is not swept or not
/// finite.
fn keeps_the_design_inequality(
    own: &OwnShip,
    target: &ShipTrack,
    sweep: Vector,
    with_domain: &ConvexPolygon,
) -> bool {
    let Some(bad) = sweep.try_normalize(0.0) else {
        return true;
    };
    let centre = target.pose.position;
    // the places of the target need not lie evenly about its estimate
    let places = target.outer_positions();
    let reach = |n: Vector| with_domain.support(n) - n.dot(&centre) - places.support(n);
    let rounding = 1e-9 * (1.0 + centre.norm() + sweep.norm());
    let short = 2.0 * sweep_distance(own, target) - (reach(bad) - reach(-bad));
    short.is_nan() || short <= rounding && reach(-bad) >= own.safety_margin - rounding
}

impl ShipDomain {
    /// The ship domain reduced toward the hard set: `scale` 1 gives `with_domain`, 0 gives `hard`.
    /// Convex and nested. O(n + m).
    pub fn scaled(&self, scale: f64) -> ConvexPolygon {
        let hard = self.hard.scaled(1.0 - scale);
        let with_domain = self.with_domain.scaled(scale);
        hard.minkowski_sum(&with_domain)
    }

    /// Largest distance of a point of the full domain from a set, metres.
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

/// Parts of a ship domain.
struct DomainParts {
    base: ConvexPolygon,
    hull: ConvexPolygon,
    sweep: Vector,
    around: ConvexPolygon,
}

impl DomainParts {
    /// The domain with its base between the hull (0) and the full size (1), and a fraction of the
    /// sweep. Increasing in both.
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
    let points: Vec<Vector> = match target.domain {
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
    // on the heading of every leg of a known route
    let headings = target.runs().map(|(_, pose, _)| pose.heading);
    let poses = headings.map(|heading| Pose::new(target.pose.position, heading));
    let around = poses.flat_map(|pose| points.iter().map(move |p| pose.world_coordinates(*p)));
    let mut all: Vec<Vector> = around.collect();
    all.extend_from_slice(hull.vertices());
    hull_or_origin(&all)
}

fn hull_or_origin(points: &[Vector]) -> ConvexPolygon {
    ConvexPolygon::hull(points).unwrap_or_else(|_| ConvexPolygon::point(Vector::zeros()))
}

/// Largest fraction in `[0, 1]` that satisfies a monotonic condition, by bisection; 0 if none does.
fn largest(holds: impl Fn(f64) -> bool) -> f64 {
    const STEPS: usize = 40;
    let [largest, _] = bisected([0.0, 1.0], STEPS, holds);
    largest
}

/// Relative excess of the sweep over the design inequality, for a planner that does not find the
/// exact optimum.
const SWEEP_EXCESS: f64 = 0.1;

/// Radians, 5°: own ship this far off the wake of the ship that it overtakes passes on that side.
const OFF_THE_WAKE: f64 = std::f64::consts::PI / 36.0;

/// Vector `e` of docs/reference/colregs.md 3.3 by which the base is swept, metres. Passing on the
/// forbidden side then takes `|e| = 2 (1 + 0.1)` sweep distances more than on the other, so that
/// the compliant side is cheaper for every miss distance that is a risk (3.2).
///
/// The direction is the normal of the relative velocity at the first instant of risk on the closed
/// side ([`RoleDuties::closed_side`](super::RoleDuties)). When overtaking, that is the target's
/// starboard side, or its port side if own ship is more than 5° to starboard of its wake.
pub fn sweep(own: &OwnShip, target: &ShipTrack, risk: &Risk) -> Vector {
    let ahead = direction(match target.route.is_empty() {
        true => target.pose.heading,
        false => risk.target.pose.heading,
    });
    let port = to_port(ahead);
    // the closed side, and the direction that decides if the normal is perpendicular to it
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
    normal * toward.signum() * (2.0 * (1.0 + SWEEP_EXCESS) * sweep_distance(own, target))
}

/// A bevelled box about a ship, in ship lengths: its reach to each side, and the fraction of the
/// side reach that is left at bow and stern.
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
    /// abeam. The bevel leans by a multiple of 22.5°, like the sides of the disc that is added, so
    /// the sum has 16 edges instead of 20. The disc contains the safety margin.
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

    /// `P(f, a, p, s, kf, ka)` of docs/reference/colregs.md 3.3, `(ahead, to port)` in units of
    /// `length`.
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
