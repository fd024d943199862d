//! The map of a file, and what of the file is not to be on its land.

use std::path::Path;
use std::sync::Arc;

use super::file::Entry;
use super::plane::Plane;
use super::section::Section;
use crate::frame::{Pose, Vector, heading_of};
use crate::map::{LandCrossing, Map, MapError};
use crate::tolerance;
use crate::trajectory::DesiredTrajectory;
use crate::vessel::{Hull, OwnShip};

/// Metres. What is missing for a turn on the spot is found to this, never less than it is.
const TURN_SETTLED_M: f64 = 1e-3;

/// Faults of a map or a path that are listed: a map of another place has one in every feature.
const MAX_LISTED: usize = 20;

/// What own ship keeps off.
///
/// # Examples
///
/// ```
/// use searoom::frame::Vector;
/// use searoom::scenario::Land;
/// use searoom::scenario::Scenario;
///
/// let scenario = Scenario::read("scenarios/harbour/munkholmen.toml".as_ref())?;
/// let land: &Land = scenario.land.as_ref().expect("a map");
/// // straight through the island
/// let path = [Vector::new(-1500.0, 0.0), Vector::new(1500.0, 0.0)];
/// assert!(!land.map.polygons().is_empty());
/// assert!(land.clearance_along(&scenario.own_ship.hull) >= scenario.own_ship.hull.beam / 2.0);
/// assert!(!land.crossings(&scenario.own_ship.hull, &path).is_empty());
/// # Ok::<(), searoom::scenario::ScenarioError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Land {
    /// Shared, not copied, by the copies of a scenario.
    pub map: Arc<Map>,
    /// Kept between own hull and the land, metres.
    pub margin: f64,
}

impl Land {
    /// Metres that the middle line of a hull keeps from land while it sails along a straight path.
    pub fn clearance_along(&self, hull: &Hull) -> f64 {
        0.5 * hull.beam + self.margin
    }

    /// Every stretch of a path that own hull cannot sail: nearer to land than half of the beam and the margin.
    pub fn crossings(&self, hull: &Hull, path: &[Vector]) -> Vec<LandCrossing> {
        self.map.crossings(path, self.clearance_along(hull))
    }

    /// Metres between own hull and land while she turns on the spot from a heading by `turn` radians: the least over all
    /// headings between, at most a millimetre too small. By halving: in a turn no point of the hull moves farther than the angle
    /// times its half-diagonal. Infinite where land is farther than the margin from all of them.
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

/// The map that the key `map` names, from `folder`; `None` without the key, or with a fault noted.
pub(super) fn map(root: &mut Section, plane: &Plane, folder: &Path) -> Option<Arc<Map>> {
    let entry = root.take("map")?;
    let earth = plane.need_earth();
    let file = entry.file_in(folder)?;
    match Map::read(&file, &earth?) {
        Ok(map) => Some(Arc::new(map)),
        Err(MapError::Read { file, source }) => {
            let found = format_args!("{}, which cannot be read ({source})", file.display());
            entry.fault(found, "a GeoJSON file of land polygons");
            None
        }
        Err(MapError::Faults { file, faults }) => {
            for fault in faults.iter().take(MAX_LISTED) {
                let place = fault.place_and_found();
                entry.fault(format_args!("{}: {place}", file.display()), &fault.allowed);
            }
            if let Some(more) = faults.len().checked_sub(MAX_LISTED).filter(|n| *n > 0) {
                let found = format_args!("{}: {more} more faults", file.display());
                entry.fault(found, "none");
            }
            None
        }
    }
}

/// Notes a start on land, and every stretch of the desired path that own hull cannot sail.
pub(super) fn check(
    root: &mut Section,
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
        && let Some(entry) = table(root, "own_ship").and_then(|mut s| s.take("position"))
    {
        let allowed = format_args!("at least {} m of water around own hull", land.margin);
        if apart < 0.0 {
            let depth = -apart;
            entry.fault(format_args!("own hull on land, {depth:.1} m deep"), allowed);
        } else {
            entry.fault(format_args!("own hull {apart:.1} m from land"), allowed);
        }
    }
    let Some((desired, alternatives)) = paths else {
        return;
    };
    let Some(mut mission) = table(root, "mission") else {
        return;
    };
    let waypoints = mission.take("waypoints").map(positions).unwrap_or_default();
    check_path(&waypoints, &desired.waypoints(), land, plane, &own.hull);
    let others = mission
        .take("alternatives")
        .map(positions)
        .unwrap_or_default();
    for (entry, path) in others.into_iter().zip(alternatives) {
        check_path(&positions(entry), path, land, plane, &own.hull);
    }
}

/// Notes every stretch of a path that own hull cannot sail, at the waypoint where its leg ends, and every waypoint where
/// it cannot lie on the course of a leg that begins or ends there.
fn check_path(entries: &[Entry], path: &[Vector], land: &Land, plane: &Plane, hull: &Hull) {
    let clearance = land.clearance_along(hull);
    let crossings = land.crossings(hull, path);
    for crossing in crossings.iter().take(MAX_LISTED) {
        let Some(entry) = entries.get(crossing.leg + 1) else {
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
        entry.fault(
            format_args!(
                "a leg that {how} from {from:.1} m to {to:.1} m after its start; {:.1} m are missing at \
                 east {:.1} m, north {:.1} m{place}",
                crossing.missing, at.x, at.y
            ),
            format_args!(
                "at least {clearance:.1} m from the leg to land: half of own beam, and land_margin_m"
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
                && let Some(entry) = entries.get(leg + end)
            {
                entry.fault(
                    format_args!(
                        "own hull {apart:.1} m from land on the course of the leg that {} here",
                        if end == 0 { "begins" } else { "ends" }
                    ),
                    format_args!("at least {} m of water around own hull", land.margin),
                );
            }
        }
    }
}

/// The positions of a path that was read before.
fn positions<'a, 'i>(entry: Entry<'a, 'i>) -> Vec<Entry<'a, 'i>> {
    entry.list(0, "positions").unwrap_or_default()
}

/// A table that was read before, to find the place of a value again.
fn table<'a, 'i>(root: &mut Section<'a, 'i>, key: &str) -> Option<Section<'a, 'i>> {
    root.take(key)?.section("a table")
}
