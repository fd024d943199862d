//! The map of a scenario, and the parts of a scenario that must keep off its land.

use std::path::Path;
use std::sync::Arc;

use super::plane::Plane;
use crate::map::{LandCrossing, Map};
use searoom_geometry::frame::{Pose, Vector, heading_of};
use searoom_geometry::tolerance;
use searoom_input::{Field, Range, Remarks, Table};
use searoom_model::trajectory::DesiredTrajectory;
use searoom_model::vessel::{Hull, OwnShip};

/// Metres: resolution of the room for a turn on the spot, which is never overestimated.
const TURN_SETTLED_M: f64 = 1e-3;
const MAX_LISTED: usize = 20;

/// Land, and the margin that own ship keeps from it.
#[derive(Debug, Clone, PartialEq)]
pub struct Land {
    /// Shared, not copied, by the copies of a scenario.
    pub map: Arc<Map>,
    /// Kept between own hull and the land, metres.
    pub margin: f64,
}

impl Land {
    /// Least distance in metres between a straight path and land for a hull that follows the path.
    pub fn clearance_along(&self, hull: &Hull) -> f64 {
        0.5 * hull.beam + self.margin
    }

    /// Stretches of a path that are nearer to land than [`Land::clearance_along`].
    pub fn crossings(&self, hull: &Hull, path: &[Vector]) -> Vec<LandCrossing> {
        self.map.crossings(path, self.clearance_along(hull))
    }

    /// Least distance in metres between own hull and land while it turns on the spot by `turn`
    /// radians, at most a millimetre too small. Branch and bound on the heading: in a turn no point
    /// of the hull moves farther than the angle times the half-diagonal. Infinite if land is
    /// farther than the margin on every heading.
    pub fn room_to_turn(&self, hull: &Hull, place: Vector, from: f64, turn: f64) -> f64 {
        let reach = hull.half_diagonal();
        if self.map.signed_distance(place) > reach + self.margin {
            return f64::INFINITY;
        }
        let apart = |heading: f64| {
            let lying = hull.polygon(&Pose::new(place, heading));
            self.map.separation(&lying, self.margin + 2.0 * reach)
        };
        let mut least = apart(from).min(apart(from + turn));
        let mut open = vec![(from, from + turn)];
        while let Some((first, last)) = open.pop() {
            let (middle, half) = (0.5 * (first + last), 0.5 * (last - first).abs());
            let here = apart(middle);
            // negated on purpose: a NaN is taken over
            if !(here >= least) {
                least = here;
            }
            if here - reach * half < least - TURN_SETTLED_M {
                open.push((first, middle));
                open.push((middle, last));
            }
        }
        least - TURN_SETTLED_M
    }
}

/// Metres around points and lines of a map.
pub(super) const POINT_RADIUS: Range = Range::between(0.001, 10_000.0);

/// The map that the key `map` names, from `folder`: a file, or a table of a file and of the radius
/// that points and lines have. `None` without the key, or with a fault noted.
pub(super) fn map(
    root: &mut Table,
    plane: &Plane,
    folder: &Path,
    remarks: &mut Remarks,
) -> Option<Arc<Map>> {
    let mut field = root.take("map")?;
    let earth = plane.need_earth();
    let mut radius = Some(None);
    if field.is_table() {
        let mut table = field.table("a file, or a table { file, point_radius_m }")?;
        let file = table.require("file", "a GeoJSON file of land");
        radius = table
            .take("point_radius_m")
            .map_or(Some(None), |field| field.number(POINT_RADIUS).map(Some));
        table.finish();
        field = file?;
    }
    let file = field.file_in(folder)?;
    let kind = "a GeoJSON file of land polygons";
    let map = field.contents(&file, Map::read(&file, &earth?, radius?), kind)?;
    remarks.extend(map.remarks());
    Some(Arc::new(map))
}

/// Notes a start on land, and every stretch of a path that is too near to land.
pub(super) fn check(
    root: &mut Table,
    land: &Land,
    plane: &Plane,
    own: Option<&OwnShip>,
    paths: Option<(&DesiredTrajectory, &[Vec<Vector>])>,
) {
    let Some(own) = own else { return };
    let start = own.hull.polygon(&own.pose);
    let apart = land.map.separation(&start, land.margin);
    // negated on purpose: a NaN is on land
    if !(apart >= land.margin - tolerance::DEPTH_M)
        && let Some(field) = table(root, "own_ship").and_then(|mut s| s.take("position"))
    {
        let allowed = format_args!("at least {} m of water around own hull", land.margin);
        if apart < 0.0 {
            let depth = -apart;
            field.fault(format_args!("own hull on land, {depth:.1} m deep"), allowed);
        } else {
            field.fault(format_args!("own hull {apart:.1} m from land"), allowed);
        }
    }
    let Some((desired, alternatives)) = paths else {
        return;
    };
    let Some(mut mission) = table(root, "mission") else {
        return;
    };
    let path = desired.waypoints();
    // the waypoints of a route have one place in this file
    let waypoints = match mission.take("route") {
        Some(route) => vec![route; path.len()],
        None => mission.take("waypoints").map(positions).unwrap_or_default(),
    };
    check_path(&waypoints, &path, land, plane, &own.hull);
    let others = mission
        .take("alternatives")
        .map(positions)
        .unwrap_or_default();
    for (field, path) in others.into_iter().zip(alternatives) {
        check_path(&positions(field), path, land, plane, &own.hull);
    }
}

/// Notes stretches too near to land, at the waypoint where the leg ends, and waypoints where own
/// hull has no room on the course of a leg that begins or ends there.
fn check_path(fields: &[Field], path: &[Vector], land: &Land, plane: &Plane, hull: &Hull) {
    let clearance = land.clearance_along(hull);
    let crossings = land.crossings(hull, path);
    for crossing in crossings.iter().take(MAX_LISTED) {
        let Some(field) = fields.get(crossing.leg + 1) else {
            continue;
        };
        let LandCrossing { from, to, .. } = crossing;
        let how = if crossing.missing > clearance {
            "crosses land"
        } else {
            "comes too near to land"
        };
        let at = crossing.worst;
        let place = plane.earth().map_or_else(String::new, |earth| {
            format!(" ({})", earth.to_geographic(at))
        });
        field.fault(
            format_args!(
                "leg {}, which {how} from {from:.1} m to {to:.1} m after its start; {:.1} m are \
                 missing at east {:.1} m, north {:.1} m{place}",
                crossing.leg + 1,
                crossing.missing,
                at.x,
                at.y
            ),
            format_args!(
                "at least {clearance:.1} m from the leg to land: half of own beam, and \
                 land_margin_m"
            ),
        );
    }
    for (leg, pair) in path.windows(2).enumerate() {
        let course = heading_of(pair[1] - pair[0]);
        for (end, waypoint) in pair.iter().enumerate() {
            let lying = hull.polygon(&Pose::new(*waypoint, course));
            let apart = land.map.separation(&lying, land.margin);
            let along = (waypoint - pair[0]).norm();
            let known = crossings
                .iter()
                .any(|c| c.leg == leg && along >= c.from && along <= c.to);
            // negated on purpose: a NaN is on land
            if !known
                && !(apart >= land.margin - tolerance::DEPTH_M)
                && let Some(field) = fields.get(leg + end)
            {
                field.fault(
                    format_args!(
                        "own hull {apart:.1} m from land on the course of leg {} at its {}",
                        leg + 1,
                        if end == 0 { "beginning" } else { "end" }
                    ),
                    format_args!("at least {} m of water around own hull", land.margin),
                );
            }
        }
    }
}

/// The positions of a path that was read before.
fn positions<'a>(field: Field<'a>) -> Vec<Field<'a>> {
    field.list(0..=usize::MAX, "positions").unwrap_or_default()
}

/// A table that was read before, to find the place of a value again.
fn table<'a>(root: &mut Table<'a>, key: &'static str) -> Option<Table<'a>> {
    root.take(key)?.table("a table")
}
