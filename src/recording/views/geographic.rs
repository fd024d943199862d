//! Plan and ships in latitude and longitude, for a map, where the scenario has an origin.

use rerun::components::GeoLineString;
use rerun::{Color, EntityPath, GeoLineStrings, GeoPoints};

use super::chart::planned_strips;
use crate::frame::{Georeference, Vector};
use crate::recording::canvas::{Canvas, ViewModel, style};
use crate::recording::recorder::Recorder;
use crate::recording::{EARTH, Logged, path};

/// By how much the dark edge of the plan is wider than the plan: tiles of maps are bright.
const EDGE: f32 = 1.5;

pub fn log_geographic(rec: &mut Recorder, model: &ViewModel) -> Logged {
    let Some(earth) = model.scenario.earth else {
        return Ok(());
    };
    log_lines(rec, model, &earth)?;
    let own = |t: f64| model.motion.pose_at(t).position;
    let entity = path(&[EARTH, "own_ship"]);
    log_ship(rec, model, &earth, (entity, style::OWN_SHIP), own)?;
    for (index, target) in model.scenario.targets.iter().enumerate() {
        let entity = path(&[EARTH, "targets", &target.name]);
        let color = model.target_color(index);
        log_ship(rec, model, &earth, (entity, color), |t| {
            target.position_at(t)
        })?;
    }
    Ok(())
}

/// Logs the desired path and the plan, one line per segment as on the chart.
fn log_lines(rec: &mut Recorder, model: &ViewModel, earth: &Georeference) -> Logged {
    let desired = GeoLineStrings::from_lat_lon([line(earth, model.scenario.desired.waypoints())])
        .with_colors([style::DESIRED])
        .with_radii([style::points(1.2)]);
    rec.log_static(path(&[EARTH, "desired"]), &desired)?;
    let strips = planned_strips(model);
    if strips.is_empty() {
        return Ok(());
    }
    let lines = strips
        .iter()
        .map(|(_, points)| line(earth, points.iter().map(|(place, _)| *place)));
    let lines: Vec<GeoLineString> = lines.collect();
    let radii = strips.iter().map(|(pace, _)| pace.radius());
    let edges = GeoLineStrings::from_lat_lon(lines.clone())
        .with_colors([style::BACKGROUND])
        .with_radii(radii.clone().map(|radius| style::points(radius + EDGE)));
    rec.log_static(path(&[EARTH, "edge"]), &edges)?;
    let planned = GeoLineStrings::from_lat_lon(lines)
        .with_colors(strips.iter().map(|(pace, _)| pace.color()))
        .with_radii(radii.map(style::points));
    rec.log_static(path(&[EARTH, "planned"]), &planned)
}

/// Logs the place of a ship at every cursor time.
fn log_ship(
    rec: &mut Recorder,
    canvas: &Canvas,
    earth: &Georeference,
    (entity, color): (EntityPath, Color),
    at: impl Fn(f64) -> Vector,
) -> Logged {
    let style = GeoPoints::update_fields()
        .with_colors([color])
        .with_radii([style::points(5.0)]);
    let places = canvas.cursor_times.iter().map(|&t| place(earth, at(t)));
    let columns = GeoPoints::update_fields()
        .with_positions(places)
        .columns_of_unit_batches()?;
    rec.log_moving(entity, canvas.cursor_column(), &style, columns)
}

fn line(earth: &Georeference, points: impl IntoIterator<Item = Vector>) -> GeoLineString {
    GeoLineString::from_iter(points.into_iter().map(|point| place(earth, point)))
}

/// Latitude and longitude, degrees.
fn place(earth: &Georeference, point: Vector) -> [f64; 2] {
    let place = earth.to_geographic(point);
    [place.lat_deg, place.lon_deg]
}
