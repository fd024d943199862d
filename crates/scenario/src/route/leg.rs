//! A leg of a route on the earth, and its part within reach of a plane.

use searoom_geometry::frame::{
    Geographic, Georeference, Vector, cross, deg_from_radians, radians_from_deg, wrap,
};
use searoom_input::Remarks;
use searoom_input::text::counted;

/// Metres between two samples of a leg: far less than the reach of a plane.
const SAMPLE_M: f64 = 10_000.0;

/// Halvings of a sample: to a metre at most.
const HALVINGS: usize = 16;

/// Equatorial radius and first eccentricity of WGS84.
const EQUATOR_M: f64 = 6_378_137.0;
const ECCENTRICITY: f64 = 0.081_819_190_842_622;

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct RouteLeg {
    pub from: Geographic,
    pub to: Geographic,
    /// True for a great circle, false for a rhumb line.
    pub is_great_circle: bool,
    /// m/s by the schedule.
    pub speed: Option<f64>,
    /// Highest speed that the leg allows, m/s.
    pub most: Option<f64>,
    /// Metres that own ship may be off the leg to port and to starboard.
    pub limits: [Option<f64>; 2],
    /// Seconds that own ship waits where the leg ends.
    pub wait: f64,
}

impl RouteLeg {
    /// The place at a fraction of the leg.
    pub fn at(&self, fraction: f64) -> Geographic {
        match self.is_great_circle {
            _ if fraction == 0.0 => self.from,
            _ if fraction == 1.0 => self.to,
            true => self.on_great_circle(fraction),
            false => self.on_rhumb_line(fraction),
        }
    }

    /// On a rhumb line the longitude is proportional to the isometric latitude.
    fn on_rhumb_line(&self, fraction: f64) -> Geographic {
        let [from, to] = [self.from, self.to].map(|place| radians_from_deg(place.lat_deg));
        let lat = from + fraction * (to - from);
        let [start, here, end] = [from, lat, to].map(isometric);
        let share = match (to - from).abs() > 1e-9 {
            true => (here - start) / (end - start),
            false => fraction,
        };
        let east = wrap(radians_from_deg(self.to.lon_deg - self.from.lon_deg));
        let lon = wrap(radians_from_deg(self.from.lon_deg) + share * east);
        Geographic::new(deg_from_radians(lat), deg_from_radians(lon))
    }

    /// On the plane through the centre of the earth and both ends.
    fn on_great_circle(&self, fraction: f64) -> Geographic {
        let [from, to] = [self.from, self.to].map(towards);
        let dot: f64 = from.iter().zip(&to).map(|(a, b)| a * b).sum();
        let angle = dot.clamp(-1.0, 1.0).acos();
        if !(angle > 1e-12) {
            return self.from;
        }
        let [a, b] = [1.0 - fraction, fraction].map(|part| (part * angle).sin() / angle.sin());
        let here: Vec<f64> = from
            .iter()
            .zip(&to)
            .map(|(from, to)| a * from + b * to)
            .collect();
        let squared = 1.0 - ECCENTRICITY * ECCENTRICITY;
        let lat = (here[2] / squared).atan2(here[0].hypot(here[1]));
        let lon = here[1].atan2(here[0]);
        Geographic::new(deg_from_radians(lat), deg_from_radians(lon))
    }

    /// Metres, by short lines with the radii of curvature in their middles.
    pub fn length(&self) -> f64 {
        let samples = 16;
        let mut length = 0.0;
        let mut last = self.from;
        for k in 1..=samples {
            let here = self.at(f64::from(k) / f64::from(samples));
            let north = radians_from_deg(here.lat_deg - last.lat_deg);
            let east = wrap(radians_from_deg(here.lon_deg - last.lon_deg));
            let middle = radians_from_deg(0.5 * (here.lat_deg + last.lat_deg));
            let across = 1.0 - (ECCENTRICITY * middle.sin()).powi(2);
            let normal = EQUATOR_M / across.sqrt();
            let meridian = normal * (1.0 - ECCENTRICITY * ECCENTRICITY) / across;
            length += (meridian * north).hypot(normal * middle.cos() * east);
            last = here;
        }
        length
    }

    /// The first part of the leg that is within reach of a plane, from one fraction to another.
    pub fn within_reach(&self, earth: &Georeference) -> Option<[f64; 2]> {
        let is_near = |fraction: f64| earth.to_near_plane(self.at(fraction)).is_some();
        let samples = (self.length() / SAMPLE_M).ceil().max(1.0);
        let fraction = |k: u32| f64::from(k) / samples;
        let all = 0..=samples as u32;
        let first = all.clone().find(|k| is_near(fraction(*k)))?;
        let beyond = all
            .skip_while(|k| *k < first)
            .find(|k| !is_near(fraction(*k)));
        // between a place within reach and one beyond it
        let edge = |near: f64, far: f64| {
            let halve = |[near, far]: [f64; 2], _| {
                let middle = 0.5 * (near + far);
                if is_near(middle) {
                    [middle, far]
                } else {
                    [near, middle]
                }
            };
            (0..HALVINGS).fold([near, far], halve)[0]
        };
        let begins = match first.checked_sub(1) {
            Some(before) => edge(fraction(first), fraction(before)),
            None => 0.0,
        };
        let ends = beyond.map_or(1.0, |far| edge(fraction(far - 1), fraction(far)));
        Some([begins, ends])
    }

    /// Metres from the middle of a part of the leg to the straight line between its ends on a plane.
    pub fn beside(&self, [begins, ends]: [f64; 2], earth: &Georeference) -> f64 {
        let [from, middle, to] =
            [begins, 0.5 * (begins + ends), ends].map(|fraction| earth.to_plane(self.at(fraction)));
        let way: Vector = to - from;
        cross(way.normalize(), middle - from).abs()
    }
}

/// Isometric latitude on WGS84.
fn isometric(lat: f64) -> f64 {
    let sin = lat.sin().clamp(-1.0 + 1e-15, 1.0 - 1e-15);
    sin.atanh() - ECCENTRICITY * (ECCENTRICITY * sin).atanh()
}

/// Unit vector from the centre of the earth towards a place.
fn towards(place: Geographic) -> [f64; 3] {
    let [lat, lon] = [place.lat_deg, place.lon_deg].map(radians_from_deg);
    let squared = 1.0 - ECCENTRICITY * ECCENTRICITY;
    let centric = (squared * lat.sin()).atan2(lat.cos());
    let (sin, cos) = centric.sin_cos();
    [cos * lon.cos(), cos * lon.sin(), sin]
}

/// Cautions that the cross-track limits are not kept, with the least ones.
pub(super) fn remark(legs: &[RouteLeg], remarks: &mut Remarks) {
    let least = |side: usize| {
        let limits = legs.iter().filter_map(|leg| leg.limits[side]);
        limits.reduce(f64::min)
    };
    let sides = [(0, "port"), (1, "starboard")].into_iter();
    let given = sides.filter_map(|(side, name)| Some(format!("{:.0} m to {name}", least(side)?)));
    let given: Vec<String> = given.collect();
    if given.is_empty() {
        return;
    }
    let of = legs
        .iter()
        .filter(|leg| leg.limits.iter().any(Option::is_some));
    remarks.caution(
        "cross-track limits",
        format_args!(
            "not kept, of {}; the least are {}, and a plan may leave its leg farther",
            counted(of.count(), "leg"),
            given.join(" and ")
        ),
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    fn leg(from: (f64, f64), to: (f64, f64), is_great_circle: bool) -> RouteLeg {
        RouteLeg {
            from: Geographic::new(from.0, from.1),
            to: Geographic::new(to.0, to.1),
            is_great_circle,
            speed: None,
            most: None,
            limits: [None; 2],
            wait: 0.0,
        }
    }

    #[test]
    fn legs_are_rhumb_lines_or_great_circles_across_the_date_line_too() {
        let [rhumb, great] = [false, true].map(|great| leg((60.0, 175.0), (60.0, -175.0), great));
        let middle = rhumb.at(0.5);
        assert!((middle.lat_deg - 60.0).abs() < 1e-12 && middle.lon_deg.abs() > 179.999_999);
        let north = great.at(0.5);
        assert!(north.lat_deg > 60.09 && north.lat_deg < 60.1, "{north}");
        assert!(great.length() < rhumb.length());
        // a parallel of latitude on WGS84: 55,800 m to a degree
        assert!(
            (rhumb.length() - 558_000.0).abs() < 100.0,
            "{}",
            rhumb.length()
        );
        let steep = leg((0.0, 0.0), (45.0, 45.0), false).at(0.5);
        assert!((steep.lon_deg - 20.565_77).abs() < 1e-5, "{steep}");
    }

    #[test]
    fn the_part_within_reach_ends_at_its_edge() {
        let earth = Georeference::new(Geographic::new(60.0, 10.0)).expect("valid");
        let near = leg((60.0, 10.0), (60.05, 10.0), false);
        assert_eq!(near.within_reach(&earth), Some([0.0, 1.0]));
        let plane = earth.to_plane(near.to).norm();
        assert!((near.length() - plane).abs() < 1e-4 * plane);
        for great in [false, true] {
            // past the origin from both sides, neither end within reach
            let long = leg((60.0, 2.0), (60.0, 18.0), great);
            let [from, to] = long.within_reach(&earth).expect("a part");
            for edge in [from, to] {
                let off = earth.to_plane(long.at(edge)).norm();
                assert!(off <= 1e5 && off > 1e5 - 10.0, "{off}");
            }
            // a parallel of latitude leaves the straight line by L² tan(lat) / 8R
            let beside = long.beside([from, to], &earth);
            let expected = if great { 0.0..100.0 } else { 1_330.0..1_380.0 };
            assert!(expected.contains(&beside), "{beside}");
        }
        assert_eq!(
            leg((50.0, 0.0), (50.0, 9.0), false).within_reach(&earth),
            None
        );
    }
}
