//! Ship domains: nested, swept to the forbidden side, reduced around own ship's start.

use super::*;
use crate::ship_fixtures::own_ship;
use crate::{Role, Sectors, SteadyShip, role_within, sweep_distance};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use searoom_geometry::frame::{direction, to_port, to_starboard};
use searoom_model::target::KnownLeg;
use searoom_model::vessel::Hull;
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
        hull: Hull::new(50.0, 10.0),
        safety_margin,
        ..own_ship(&[3.0, 6.0])
    }
}

fn track(position: Vector, heading: f64, speed: f64) -> ShipTrack {
    ShipTrack {
        position_std: 2.0,
        speed_spread: 0.5,
        course_spread: 0.1,
        domain: DomainKind::Colregs,
        ..ShipTrack::exact(Pose::new(position, heading), speed, Hull::new(50.0, 10.0))
    }
}

fn risk_with(own: &OwnShip, target: &ShipTrack) -> Risk {
    let steady = |pose, speed| SteadyShip { pose, speed };
    let own = steady(own.pose, own.speed);
    let target = steady(target.pose, target.speed);
    Risk {
        role: role_within(&own, &target, &Sectors::STANDARD).expect("finite"),
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
    let off = (head_on - Vector::new(0.0, -length)).norm();
    assert!(off < 1e-9, "{head_on:?}");
    let give_way = in_body(&at(720.0, -720.0, FRAC_PI_2, 6.0));
    let diagonal = Vector::new(1.0, -1.0).normalize() * length;
    assert!((give_way - diagonal).norm() < 1e-9, "{give_way:?}");
    let overtaking = in_body(&at(432.0, 0.0, 0.0, 2.4));
    assert!((overtaking - Vector::new(0.0, -length)).norm() < 1e-9);
    // own ship well on its starboard quarter passes to starboard: the port side is closed
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
        let Some(role) = role_within(&risk.own, &risk.target, &Sectors::STANDARD) else {
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
        let domain = ship_domain(&own, &target, Some(&risk), HORIZON).with_domain;
        let centre = target.pose.position;
        let reach = |n: Vector| domain.support(n) - n.dot(&centre);
        let asymmetry = reach(bad) - reach(-bad);
        let d_risk = sweep_distance(&own, &target);
        assert!(asymmetry >= 2.0 * d_risk);
        assert!((asymmetry - e.norm()).abs() < 1e-6, "{asymmetry} {e:?}");
        assert!(reach(-bad) >= own.safety_margin);
    }
    assert!(swept > 500, "{swept}");
}

#[test]
fn hull_in_hard_in_domain_and_a_start_outside_stays_outside() {
    let mut rng = ChaCha8Rng::seed_from_u64(33);
    let (mut drawn_back, mut bare) = (0, 0);
    for _ in 0..3000 {
        let own = own_at(Vector::zeros(), rng.random_range(0.0..60.0));
        let mut target = random_track(&mut rng);
        target.pose.position *= 0.4;
        let risk = risk_with(&own, &target);
        let found = ship_domain(&own, &target, Some(&risk), HORIZON);
        let inside = |inner: &ConvexPolygon, outer: &ConvexPolygon| {
            let mut corners = inner.vertices().iter();
            corners.all(|p| outer.signed_distance(*p) < 1e-7)
        };
        assert!(inside(&target.hull.polygon(&target.pose), &found.hard));
        assert!(inside(&found.hard, &found.with_domain), "{target:?}");
        let away = own_at(Vector::new(1e5, 0.0), own.safety_margin);
        let whole = ship_domain(&away, &target, Some(&risk), HORIZON);
        assert!(inside(&found.with_domain, &whole.with_domain) && whole.reduced == 0.0);
        let start = own.pose.position;
        let from_hard = found.hard.signed_distance(start);
        let from_whole = whole.with_domain.signed_distance(start);
        if from_hard <= 0.0 || from_whole > 0.0 {
            assert_eq!(found.with_domain, whole.with_domain);
            assert_eq!(found.reduced, 0.0);
            continue;
        }
        drawn_back += 1;
        bare += usize::from(found.with_domain.area() < 1.05 * found.hard.area());
        let from_used = found.with_domain.signed_distance(start);
        let least = tolerance::START_M.min(0.99 * from_hard);
        assert!(from_used >= least, "{from_used}");
        // not more than needed: at most the room that the bisection leaves, or the hard set's own
        assert!(from_used < 1.1 * tolerance::START_M || from_used > 0.99 * from_hard);
        assert!(found.reduced >= -from_whole - 1e-6, "{found:?}");
        let cut = (0..720)
            .map(|i| direction(f64::from(i) * PI / 360.0))
            .map(|n| whole.with_domain.support(n) - found.with_domain.support(n))
            .fold(0.0, f64::max);
        let reduced = found.reduced;
        assert!(cut <= reduced + 1e-6 && cut > 0.9 * reduced, "{cut}");
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
    let found = ship_domain(&own, &target, Some(&risk), HORIZON);
    let base = ship_domain(&own, &target, None, HORIZON);
    assert!(found.reduced > 10.0 && base.reduced == 0.0);
    for p in base.with_domain.vertices() {
        assert!(found.with_domain.signed_distance(*p) < 1e-7);
    }
    assert!(found.with_domain.area() > 1.1 * base.with_domain.area());
}

#[test]
fn domains_have_the_reach_they_are_named_for() {
    let own = own_at(Vector::new(5000.0, 0.0), 20.0);
    let around = own.hull.half_diagonal() + 20.0 + 6.0;
    let reaches = |domain| {
        let mut target = track(Vector::zeros(), 0.0, 5.0);
        (target.domain, target.course_spread) = (domain, 0.0);
        let found = ship_domain(&own, &target, None, HORIZON);
        let ways = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)];
        let reach = |set: &ConvexPolygon| {
            ways.map(|(x, y)| (set.support(Vector::new(x, y)) - around).round() as i32)
        };
        assert_eq!(reach(&found.hard), [25, 25, 5, 5]);
        let count = found.with_domain.vertices().len();
        (reach(&found.with_domain), count)
    };
    assert_eq!(reaches(DomainKind::Colregs), ([100, 100, 75, 75], 16));
    assert_eq!(reaches(DomainKind::Paper).0, [300, 100, 75, 200]);
    assert_eq!(reaches(DomainKind::Hull), ([25, 25, 5, 5], 16));
    assert_eq!(reaches(DOMAINS[3]), ([225, 75, 35, 95], 16));
    // starboard is starboard
    let mut target = track(Vector::zeros(), FRAC_PI_2, 5.0);
    target.domain = DomainKind::Paper;
    let set = ship_domain(&own, &target, None, HORIZON).with_domain;
    assert!(set.support(Vector::new(1.0, 0.0)) > set.support(Vector::new(-1.0, 0.0)));
}

/// The paper's domain reaches six lengths ahead: on every leg of the route.
#[test]
fn the_domain_has_every_heading_of_a_known_route() {
    let own = own_at(Vector::new(-5000.0, 0.0), 20.0);
    let ship = ShipTrack {
        domain: DomainKind::Paper,
        ..ShipTrack::exact(Pose::new(Vector::zeros(), 0.0), 5.0, Hull::new(50.0, 10.0))
    };
    let leg = |x, y| KnownLeg {
        to: Vector::new(x, y),
        speed: 5.0,
    };
    let straight = ship_domain(&own, &ship, None, 600.0).with_domain;
    let routed = ship.with_route(vec![leg(400.0, 0.0), leg(400.0, 900.0), leg(-100.0, 900.0)]);
    let routed = ship_domain(&own, &routed, None, 600.0).with_domain;
    for (n, reaches) in [(0.0, true), (FRAC_PI_2, false), (PI, false)] {
        let n = direction(n);
        assert!(routed.support(n) >= straight.support(direction(0.0)) - 1e-6);
        assert_eq!(straight.support(n) >= 300.0, reaches);
    }
}
