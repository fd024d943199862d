//! What a manoeuvre by the rules keeps clear of: sets and land, a length around each hull, and the
//! water ahead of a bow. All but land are hugged; from land the exact contact test keeps clear.

use crate::space_time::context::Context;
use crate::space_time::land;
use crate::space_time::proxy::{Proxy, first_met};
use crate::space_time::rules::compliance::broken_rules;
use crate::space_time::rules::hug::HeldTurn;
use crate::space_time::rules::manoeuvre::Manoeuvres;
use searoom_colregs::Encountered;
use searoom_geometry::frame::{Pose, Vector, to_port};
use searoom_geometry::tolerance::TOUCH_M;
use searoom_geometry::{ConvexPolygon, outer_disc};
use searoom_model::trajectory::Segment;
use searoom_sets::{PolytopeObstacle, contact};

/// Half the width of the line ahead of a bow, metres.
const BOW_LINE_M: f64 = 0.02;

/// Metres by which that line is longer than the room that the judge asks for.
const BOW_SPARE_M: f64 = 0.5;

/// A target, and the bodies that own ship keeps off for its sake.
pub(super) struct Passing<'a> {
    pub encountered: &'a Encountered,
    /// The nominal hull, grown by own half-diagonal and the longer ship's length; `None` where a set
    /// covers it, so that own ship keeps off it anyway.
    within_a_length: Option<PolytopeObstacle>,
    /// The nominal hull, grown by own hull on its first course.
    pub hulls: PolytopeObstacle,
    /// The line ahead of the target that own ship must not cross, where there is one and own ship
    /// does not begin on it.
    ahead: Option<PolytopeObstacle>,
}

impl<'a> Passing<'a> {
    pub(super) fn new(context: &Context, encountered: &'a Encountered) -> Self {
        let problem = context.problem;
        let (own, ship) = (&problem.own.hull, &encountered.ship);
        let hull = encountered.hull.polygon(&ship.pose);
        let around = own.half_diagonal() + own.length.max(encountered.hull.length);
        let disc = outer_disc(around, ship.pose.heading);
        let course = Pose::new(Vector::zeros(), encountered.own.pose.heading);
        let moving =
            |initial| PolytopeObstacle::new("", initial, ConvexPolygon::point(ship.velocity()));
        let reach = (problem.own.max_speed() + ship.speed) * problem.horizon;
        let room = encountered.bow_room();
        let ahead = (room > 0.0).then(|| {
            let (along, across) = (ship.pose.ahead(), to_port(ship.pose.ahead()) * BOW_LINE_M);
            let to = ship.pose.position + along * (room.min(reach) + BOW_SPARE_M);
            let from = ship.pose.position - along * BOW_SPARE_M;
            ConvexPolygon::hull(&[from + across, from - across, to + across, to - across])
        });
        let ahead = ahead.and_then(Result::ok).map(moving);
        let within_a_length = moving(hull.minkowski_sum(&disc));
        let covers = |proxy: &Proxy| proxy.contains_body(&within_a_length);
        let is_covered = context.proxies.iter().any(covers);
        let begins_there = |o: &PolytopeObstacle| o.contains(problem.own.pose.position, 0.0);
        Self {
            encountered,
            within_a_length: (!is_covered).then_some(within_a_length),
            hulls: moving(hull.minkowski_sum(&own.polygon(&course).negated())),
            ahead: ahead.filter(|line| !begins_there(line)),
        }
    }

    pub(super) fn keeps_clear(&self) -> bool {
        self.encountered.role.duties().keeps_clear
    }

    /// True where own ship must not head to some side before the target has passed.
    pub(super) fn forbids_a_heading(&self) -> bool {
        self.encountered.role.duties().no_heading_to.is_some()
    }

    /// What is within a length of this target, where a length is more than the sets ask for.
    pub(super) fn within_a_length(&self) -> Option<&PolytopeObstacle> {
        self.within_a_length.as_ref()
    }
}

/// First time at which a motion that breaks a rule comes within a length of a target that own ship keeps clear
/// of, seconds.
pub(crate) fn first_within_a_length(context: &Context, motion: &[Segment]) -> Option<f64> {
    let all = context.problem.encountered.iter();
    let passing = all.map(|e| Passing::new(context, e));
    let times = passing.filter(Passing::keeps_clear).filter_map(|p| {
        let body = p.within_a_length()?;
        let meets = |s| contact::first_contact(body, s, TOUCH_M);
        motion.iter().find_map(meets)
    });
    let first = times.reduce(f64::min);
    first.filter(|_| broken_rules(context.problem, motion) > 0)
}

impl Manoeuvres<'_, '_> {
    /// True for segments that are clear of every set, of land and of the water ahead of every target's bow, with
    /// Rule 8(d) clearance from the targets.
    pub(super) fn is_clear(&self, segments: &[Segment]) -> bool {
        first_met(self.context.proxies, segments).is_none()
            && !land::meets(self.problem().land_obstacle, segments)
            && self.keeps_lengths(segments)
            && self.crosses_no_bow(segments)
    }

    /// Seconds for which a straight course is clear, at most to the horizon.
    pub(super) fn clear_for(&self, pose: Pose, speed: f64, time: f64) -> f64 {
        let problem = self.problem();
        let line = Segment::straight(pose, time, problem.horizon - time, speed);
        let sets = self
            .context
            .proxies
            .iter()
            .filter_map(|p| p.first_contact(&line));
        let land = problem.land_obstacle.first_contact(&line, TOUCH_M);
        let lengths = self.kept_off();
        let ahead = self.passing.iter().filter_map(|p| p.ahead.as_ref());
        let bodies = lengths.chain(ahead);
        let bodies = bodies.filter_map(|body| contact::first_contact(body, &line, TOUCH_M));
        let first = sets.chain(land).chain(bodies).reduce(f64::min);
        first.unwrap_or(problem.horizon) - time
    }

    fn crosses_no_bow(&self, segments: &[Segment]) -> bool {
        let mut lines = self.passing.iter().filter_map(|p| p.ahead.as_ref());
        let meets = |s: &Segment, line| contact::meets(line, s, TOUCH_M);
        !lines.any(|line| segments.iter().any(|s| meets(s, line)))
    }

    pub(super) fn keeps_lengths(&self, segments: &[Segment]) -> bool {
        let near = |s, body| contact::meets(body, s, TOUCH_M);
        !segments
            .iter()
            .any(|s| self.kept_off().any(|body| near(s, body)))
    }

    /// Holds of a range after which the line of a turn touches a body other than land.
    pub(super) fn touching(&self, turn: &HeldTurn, range: (f64, f64)) -> Vec<f64> {
        let sets = self.context.proxies.iter();
        let sets = sets.map(|proxy| (proxy.body.moving_vertices(), proxy.start()));
        let lengths = self.kept_off();
        let ahead = self.passing.iter().filter_map(|p| p.ahead.as_ref());
        let others = lengths
            .chain(ahead)
            .map(|body| (body.moving_vertices(), 0.0));
        turn.touching(sets.chain(others), range)
    }
}
