//! A situation from the traffic around own ship at a time.

use chrono::{DateTime, SecondsFormat, Utc};

use super::situation::{Declared, GivenHull, Other, Own, OwnRoute, Situation};
use searoom_geometry::frame::{Georeference, Pose};
use searoom_input::Remarks;
use searoom_model::target::Target;
use searoom_model::vessel::Hull;

/// Own ship among others at a time.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnInTraffic {
    /// On the plane of the situation.
    pub pose: Pose,
    /// m/s.
    pub speed: f64,
    /// The hull, where it is known.
    pub hull: Option<Hull>,
    /// Its route, as a scenario file beside it names it.
    pub route_file: String,
}

impl Situation {
    /// Own ship and the ships around it, with their sets as they are at a time. Cautions name those that
    /// are in no set.
    pub fn of_traffic(
        name: &str,
        time: Option<DateTime<Utc>>,
        earth: Georeference,
        own: &OwnInTraffic,
        targets: Vec<Target>,
        remarks: Remarks,
    ) -> Self {
        Self {
            name: name.to_owned(),
            id: None,
            start_utc: time.map(|time| time.to_rfc3339_opts(SecondsFormat::AutoSi, true)),
            own: Own {
                pose: own.pose,
                speed: own.speed,
                hull: own.hull.map_or(GivenHull::NotInFormat, GivenHull::Known),
                route: OwnRoute::File(own.route_file.clone()),
                horizon: None,
            },
            others: (targets.into_iter())
                .map(|target| Other::Tracked(Box::new(target)))
                .collect(),
            earth: Some(earth),
            declared: Declared::default(),
            remarks,
        }
    }
}
