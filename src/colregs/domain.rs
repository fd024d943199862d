//! Shapes of the initial set: where a target's ship may be, with what own ship is to keep of her
//! folded in, and what the rules of the road add to it (`colregs.md` 3.2-3.3).

use super::bevelled_box::BevelledBox;
use super::encounter::{Risk, risk_distance};
use super::sweep::sweep;
use crate::frame::{Pose, Vector};
use crate::geometry::{ConvexPolygon, outer_disc};
use crate::target::{DomainKind, ShipTrack};
use crate::tolerance;
use crate::vessel::OwnShip;

/// Standard deviations of the position that the sets cover.
const POSITION_SIGMAS: f64 = 3.0;

/// The two initial sets of one target, for own ship's centre, metres.
///
/// # Examples
///
/// ```
/// use searoom::colregs::{Shapes, first_risk, shapes};
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/colregs/give-way.toml".as_ref())?;
/// let ferry = scenario.targets[0].ship().expect("a ship");
/// let risk = first_risk(&scenario.own_ship, &scenario.desired, ferry, scenario.horizon);
/// let Shapes { hard, shaped, .. } = shapes(&scenario.own_ship, ferry, risk.as_ref(), scenario.horizon);
/// // the shape holds the hard set and what the rules add to it
/// assert!(hard.vertices().iter().all(|v| shaped.signed_distance(*v) < 1e-6));
/// assert!(shaped.area() > 2.0 * hard.area());
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
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

/// The initial sets of a tracked ship, `colregs.md` 3.3:
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
        own.hull.half_diagonal() + own.safety_margin + POSITION_SIGMAS * target.position_std,
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

/// `colregs.md` 3.2: passing on the side that the rules forbid asks for at least two risk distances more than on the other, where
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::colregs::{Role, SteadyShip, raw_role, risk_distance};
    use crate::frame::{direction, to_port, to_starboard};
    use crate::vessel::Hull;
    use rand::{Rng, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use std::f64::consts::{FRAC_PI_2, PI};

    const DOMAINS: [DomainKind; 4] = [
        DomainKind::Colregs,
        DomainKind::Paper,
        DomainKind::Hull,
        DomainKind::Custom {
            fore: 200.0,
            aft: 50.0,
            port: 30.0,
            starboard: 90.0,
        },
    ];

    const HORIZON: f64 = 600.0;

    fn own_at(position: Vector, safety_margin: f64) -> OwnShip {
        OwnShip {
            pose: Pose::new(position, 0.0),
            speed: 6.0,
            hull: Hull {
                length: 50.0,
                beam: 10.0,
            },
            turning_radius: 100.0,
            speeds: vec![3.0, 6.0],
            safety_margin,
        }
    }

    fn track(position: Vector, heading: f64, speed: f64) -> ShipTrack {
        ShipTrack {
            pose: Pose::new(position, heading),
            speed,
            hull: Hull {
                length: 50.0,
                beam: 10.0,
            },
            position_std: 2.0,
            speed_spread: 0.5,
            course_spread: 0.1,
            turn_rate: 0.0,
            domain: DomainKind::Colregs,
        }
    }

    fn risk_with(own: &OwnShip, target: &ShipTrack) -> Risk {
        let steady = |pose, speed| SteadyShip { pose, speed };
        let (own, target) = (
            steady(own.pose, own.speed),
            steady(target.pose, target.speed),
        );
        Risk {
            role: raw_role(&own, &target).expect("finite"),
            time: 0.0,
            own,
            target,
        }
    }

    fn random_track(rng: &mut ChaCha8Rng) -> ShipTrack {
        let mut within = |a: f64, b: f64| rng.random_range(a..b);
        let position = Vector::new(within(-900.0, 900.0), within(-900.0, 900.0));
        let mut target = track(position, within(-PI, PI), within(0.0, 9.0));
        target.hull = Hull {
            length: within(5.0, 200.0),
            beam: within(2.0, 40.0),
        };
        target.position_std = within(0.0, 10.0);
        target.course_spread = [0.0, 0.1][rng.random_range(0..2)];
        target.domain = DOMAINS[rng.random_range(0..4)];
        target
    }

    #[test]
    fn the_fixtures_are_swept_to_the_side_that_the_rules_forbid() {
        let own = own_at(Vector::zeros(), 20.0);
        let at = |x, y, heading, speed| track(Vector::new(x, y), heading, speed);
        // in the target's own axes: (ahead, to port)
        let in_body = |target: &ShipTrack| {
            let e = sweep(&own, target, &risk_with(&own, target));
            let ahead = target.pose.ahead();
            Vector::new(ahead.dot(&e), to_port(ahead).dot(&e))
        };
        let length = 2.2 * 100.0;
        let head_on = in_body(&at(1440.0, 0.0, PI, 6.0));
        assert!(
            (head_on - Vector::new(0.0, -length)).norm() < 1e-9,
            "{head_on:?}"
        );
        let give_way = in_body(&at(720.0, -720.0, FRAC_PI_2, 6.0));
        let diagonal = Vector::new(1.0, -1.0).normalize() * length;
        assert!((give_way - diagonal).norm() < 1e-9, "{give_way:?}");
        let overtaking = in_body(&at(432.0, 0.0, 0.0, 2.4));
        assert!((overtaking - Vector::new(0.0, -length)).norm() < 1e-9);
        // own ship well on her starboard quarter passes to starboard: the port side is the bad one
        let off = in_body(&at(432.0, 80.0, 0.0, 2.4));
        assert!(off.y > 0.9 * length, "{off:?}");
        let slightly = in_body(&at(432.0, 30.0, 0.0, 2.4));
        assert!(slightly.y < -0.9 * length, "{slightly:?}");
        for stand_on in [
            at(720.0, 720.0, -FRAC_PI_2, 6.0),
            at(-432.0, 0.0, 0.0, 9.6),
            at(432.0, 0.0, 0.0, 0.1),
        ] {
            assert_eq!(in_body(&stand_on), Vector::zeros());
        }
    }

    #[test]
    fn the_design_inequality_holds_whatever_the_hull() {
        let mut rng = ChaCha8Rng::seed_from_u64(32);
        let mut swept = 0;
        for _ in 0..3000 {
            let own = own_at(Vector::new(5000.0, 0.0), rng.random_range(0.0..300.0));
            let mut target = random_track(&mut rng);
            target.domain = DomainKind::Colregs;
            let mut risk = risk_with(&own_at(Vector::zeros(), 0.0), &target);
            risk.own.pose.heading = rng.random_range(-PI..PI);
            let Some(role) = raw_role(&risk.own, &risk.target) else {
                continue;
            };
            risk.role = role;
            let e = sweep(&own, &target, &risk);
            let relative = risk.own.velocity() - risk.target.velocity();
            if e == Vector::zeros() || relative.norm() < 0.1 {
                continue;
            }
            swept += 1;
            let bad = e.normalize();
            assert!(bad.dot(&relative).abs() < 1e-9 * relative.norm());
            let ahead = target.pose.ahead();
            match role {
                Role::HeadOn | Role::PortToPort => assert!(bad.dot(&to_starboard(ahead)) > 0.0),
                Role::GiveWay => assert!(bad.dot(&ahead) > 0.0),
                Role::Overtaking => {}
                other => panic!("{other:?} has no bad side"),
            }
            let shape = shapes(&own, &target, Some(&risk), HORIZON).shaped;
            let centre = target.pose.position;
            let reach = |n: Vector| shape.support(n) - n.dot(&centre);
            let asymmetry = reach(bad) - reach(-bad);
            let d_risk = risk_distance(&own, &target);
            assert!(asymmetry >= 2.0 * d_risk);
            assert!((asymmetry - e.norm()).abs() < 1e-6, "{asymmetry} {e:?}");
            assert!(reach(-bad) >= own.safety_margin);
        }
        assert!(swept > 500, "{swept}");
    }

    #[test]
    fn hull_in_hard_in_shaped_and_a_start_outside_stays_outside() {
        let mut rng = ChaCha8Rng::seed_from_u64(33);
        let (mut drawn_back, mut bare) = (0, 0);
        for _ in 0..3000 {
            let own = own_at(Vector::zeros(), rng.random_range(0.0..60.0));
            let mut target = random_track(&mut rng);
            target.pose.position *= 0.4;
            let risk = risk_with(&own, &target);
            let found = shapes(&own, &target, Some(&risk), HORIZON);
            let inside = |inner: &ConvexPolygon, outer: &ConvexPolygon| {
                inner
                    .vertices()
                    .iter()
                    .all(|p| outer.signed_distance(*p) < 1e-7)
            };
            assert!(inside(&target.hull.polygon(&target.pose), &found.hard));
            assert!(inside(&found.hard, &found.shaped), "{target:?}");
            let away = own_at(Vector::new(1e5, 0.0), own.safety_margin);
            let whole = shapes(&away, &target, Some(&risk), HORIZON);
            assert!(inside(&found.shaped, &whole.shaped) && whole.reduced == 0.0);
            let start = own.pose.position;
            let (from_hard, from_whole) = (
                found.hard.signed_distance(start),
                whole.shaped.signed_distance(start),
            );
            if from_hard <= 0.0 || from_whole > 0.0 {
                assert_eq!(found.shaped, whole.shaped);
                assert_eq!(found.reduced, 0.0);
                continue;
            }
            drawn_back += 1;
            bare += usize::from(found.shaped.area() < 1.05 * found.hard.area());
            let from_used = found.shaped.signed_distance(start);
            assert!(
                from_used >= tolerance::START_M.min(0.99 * from_hard),
                "{from_used}"
            );
            // not more than needed: at most the room that the bisection leaves, or the hard set's own
            assert!(from_used < 1.1 * tolerance::START_M || from_used > 0.99 * from_hard);
            assert!(found.reduced >= -from_whole - 1e-6, "{found:?}");
            let cut = (0..720)
                .map(|i| direction(f64::from(i) * PI / 360.0))
                .map(|n| whole.shaped.support(n) - found.shaped.support(n))
                .fold(0.0, f64::max);
            assert!(
                cut <= found.reduced + 1e-6 && cut > 0.9 * found.reduced,
                "{cut}"
            );
        }
        assert!(drawn_back > 200 && bare > 0, "{drawn_back} {bare}");
    }

    #[test]
    fn the_sweep_is_given_up_before_the_base() {
        // own ship ahead of the target's starboard bow: under the sweep, but clear of the base
        let target = track(Vector::zeros(), FRAC_PI_2, 6.0);
        let own = own_at(Vector::new(250.0, 0.0), 20.0);
        let mut risk = risk_with(&own, &target);
        risk.role = Role::HeadOn;
        risk.own.pose.heading = -FRAC_PI_2;
        let found = shapes(&own, &target, Some(&risk), HORIZON);
        let base = shapes(&own, &target, None, HORIZON);
        assert!(found.reduced > 10.0 && base.reduced == 0.0);
        for p in base.shaped.vertices() {
            assert!(found.shaped.signed_distance(*p) < 1e-7);
        }
        assert!(found.shaped.area() > 1.1 * base.shaped.area());
    }

    #[test]
    fn shapes_have_the_reach_they_are_named_for() {
        let own = own_at(Vector::new(5000.0, 0.0), 20.0);
        let around = own.hull.half_diagonal() + 20.0 + 6.0;
        let reaches = |domain| {
            let mut target = track(Vector::zeros(), 0.0, 5.0);
            (target.domain, target.course_spread) = (domain, 0.0);
            let found = shapes(&own, &target, None, HORIZON);
            let ways = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
            let reach = |set: &ConvexPolygon| {
                ways.map(|(x, y)| (set.support(Vector::new(x, y)) - around).round() as i32)
            };
            assert_eq!(reach(&found.hard), [25, 25, 5, 5]);
            (reach(&found.shaped), found.shaped.vertices().len())
        };
        assert_eq!(reaches(DomainKind::Colregs), ([100, 100, 75, 75], 16));
        assert_eq!(reaches(DomainKind::Paper).0, [300, 100, 75, 200]);
        assert_eq!(reaches(DomainKind::Hull), ([25, 25, 5, 5], 16));
        assert_eq!(reaches(DOMAINS[3]), ([225, 75, 35, 95], 16));
        // starboard is starboard
        let mut target = track(Vector::zeros(), FRAC_PI_2, 5.0);
        target.domain = DomainKind::Paper;
        let set = shapes(&own, &target, None, HORIZON).shaped;
        assert!(set.support(Vector::new(1.0, 0.0)) > set.support(Vector::new(-1.0, 0.0)));
    }
}
