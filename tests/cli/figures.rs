//! Tests of the figures: deterministic bytes, units on the axes, and only finite coordinates.

use std::fs;

use searoom::frame::{Pose, Vector};
use searoom::geometry::{ConvexPolygon, Ellipse};
use searoom::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle};
use searoom::report::figure::{Figure, FigureOptions, assessment_figure};
use searoom::study::assess::OwnSituation;
use searoom::target::{TimedVelocitySet, Uncertainty};

use super::program::{Folder, run};

/// One target of each kind.
fn targets() -> Vec<Obstacle> {
    let place = Vector::new(400.0, 100.0);
    let velocities = ConvexPolygon::rectangle(Vector::new(-2.0, 0.0), 0.3, 0.2);
    let shape = nalgebra::Matrix2::new(900.0, 0.0, 0.0, 400.0);
    let spread = nalgebra::Matrix2::new(0.04, 0.01, 0.01, 0.09);
    let square = |wide| ConvexPolygon::rectangle(Vector::new(0.0, -1.5), wide, wide);
    let timed = [(60.0, 0.2), (f64::INFINITY, 0.6)]
        .map(|(until, wide)| TimedVelocitySet::new(until, square(wide)));
    let initial = ConvexPolygon::rectangle(Vector::new(200.0, 500.0), 20.0, 20.0);
    let changing = Uncertainty::new(initial, timed.to_vec());
    let ellipse = |center, shape| Ellipse::new(center, shape).expect("a shape");
    let velocity = ellipse(Vector::new(1.0, 0.5), spread);
    let polygon = ConvexPolygon::rectangle(place, 30.0, 12.0);
    vec![
        PolytopeObstacle::new("polygons", polygon, velocities).into(),
        EllipsoidObstacle::new("ellipses", ellipse(-place, shape), velocity).into(),
        Obstacle::new("slabs", changing).expect("increasing"),
    ]
}

fn figure(obstacles: &[Obstacle], speed: f64, times: &[f64]) -> Figure {
    titled(obstacles, speed, times, "")
}

fn titled(obstacles: &[Obstacle], speed: f64, times: &[f64], title: &str) -> Figure {
    let situation = OwnSituation {
        pose: Pose::new(Vector::zeros(), 0.3),
        speed,
        max_speed: 6.0,
        horizon: 300.0,
        obstacles,
    };
    assessment_figure(&situation, times, &FigureOptions::default(), title).expect("drawn")
}

#[test]
fn the_same_figure_is_the_same_bytes() {
    let all = targets();
    let drawn = || figure(&all, 5.0, &[0.0, 80.0]);
    let svg = drawn().svg();
    assert_eq!(svg, drawn().svg());
    assert_eq!(drawn().png().expect("drawn"), drawn().png().expect("drawn"));
    let texts = "East [m]; North [m]; East velocity [m/s]; North velocity [m/s]; dCPA [m]; risk; \
        Risk at 80 s; velocity obstacle; own velocity; section at 0 s; polygons; ellipses; slabs";
    for text in texts.split("; ") {
        assert!(svg.contains(text), "{text}");
    }
    assert!(!svg.contains("NaN") && !svg.contains("inf"));
}

/// Tests that a title is above the panels, and that a long one is truncated visibly.
#[test]
fn a_title_is_drawn_and_fits() {
    let all = targets();
    let titled = |title: &str| titled(&all, 5.0, &[0.0], title).svg();
    let svg = titled("Three & more");
    assert!(svg.contains("Three &amp; more"));
    let long = titled(&"ahoy ".repeat(40));
    assert!(long.contains("…<") && !long.contains(&"ahoy ".repeat(40)));
    assert!(!figure(&all, 5.0, &[0.0]).svg().contains("Three"));
}

/// Tests one to many panels, and extreme situations.
#[test]
fn every_situation_can_be_drawn() {
    let all = targets();
    let point = ConvexPolygon::point;
    let at_rest = |name: &str, set| -> Obstacle {
        PolytopeObstacle::new(name, set, point(Vector::zeros())).into()
    };
    let still = at_rest("buoy", point(Vector::new(9.0, 9.0)));
    let over = at_rest("over", ConvexPolygon::rectangle(Vector::zeros(), 9.0, 9.0));
    let [place, velocity] = [50.0, -1.0].map(|east| Ellipse::point(Vector::new(east, 0.0)));
    let needle: Obstacle = EllipsoidObstacle::new("needle", place, velocity).into();
    for obstacles in [&[][..], &all[..1], &all[1..], &[still], &[over], &[needle]] {
        for times in [
            &[][..],
            &[0.0],
            &[5.0, 5.0, 2.0],
            &[1e6],
            &[0.0, 1.0, 2.0, 3.0, 4.0],
        ] {
            for speed in [0.0, 5.0, 100.0] {
                let svg = figure(obstacles, speed, times).svg();
                assert!(
                    svg.starts_with("<svg") && !svg.contains("NaN"),
                    "{obstacles:?} {times:?}"
                );
            }
        }
    }
    assert!(Figure::new(2, Vec::new()).svg().starts_with("<svg"));
}

const GIVE_WAY: &str = "plan scenarios/colregs/give-way.toml --quiet --figure";

/// A size in millimetres is the size of the page, and with the resolution the number of pixels.
#[test]
fn a_figure_has_the_size_and_the_resolution_asked_for() {
    let folder = Folder::new();
    let drawn = |name: &str, options: &str| {
        let file = folder.at(name);
        run(&format!("{GIVE_WAY} {file} {options}")).success();
        fs::read(&file).expect("written")
    };
    for (options, [width, height]) in [
        ("--size 170x150 --dpi 300", [2008, 1772]),
        ("--size 101.6x127 --dpi 96", [384, 480]),
        ("--size 101.6x127", [768, 960]),
    ] {
        let png = drawn("a.png", options);
        let sides = [16, 20].map(|at| png[at..at + 4].try_into().expect("four bytes"));
        assert_eq!(sides.map(u32::from_be_bytes), [width, height], "{options}");
    }
    let svg = String::from_utf8(drawn("a.svg", "--size 101.6x127")).expect("text");
    assert!(svg.starts_with("<svg") && svg.contains("width=\"384\" height=\"480\""));
    let pdf = drawn("a.pdf", "--size 101.6x127");
    assert!(pdf.starts_with(b"%PDF"));
    // points: 1/72 inch
    let page = b"/MediaBox[0 0 288 360]";
    assert!(pdf.windows(page.len()).any(|part| part == page));
    assert_eq!(pdf, drawn("b.pdf", "--size 101.6x127"));
}

/// The times asked for stand beside own ship and beside the target, and no others but the closest
/// approach.
#[test]
fn all_ships_are_marked_at_the_times_asked_for() {
    let folder = Folder::new();
    let file = folder.at("a.svg");
    run(&format!("{GIVE_WAY} {file} --times 200,0,100,100")).success();
    let svg = fs::read_to_string(&file).expect("written");
    for (time, count) in [(">1:40<", 2), (">3:20<", 2), (">2:33<", 2), (">2:00<", 0)] {
        assert_eq!(svg.matches(time).count(), count, "{time}");
    }
    for first in [">own ship, 0:00<", ">target, 0:00<"] {
        assert!(svg.contains(first), "{first}");
    }
}

#[test]
fn options_of_figures_are_refused_by_name() {
    let folder = Folder::new();
    let head_on = "scenarios/colregs/head-on.toml";
    folder.refuses(&format!(
        "
        plan {head_on} --quiet --figure DIR/a.svg --size 0 | --size | WIDTHxHEIGHT in millimetres
        plan {head_on} --quiet --figure DIR/a.svg --size 0x100 | --size | from 20 to 2000
        plan {head_on} --quiet --figure DIR/a.svg --size NaNx100 | --size | from 20 to 2000
        plan {head_on} --quiet --figure DIR/a.svg --size 30x30 | --size: found 30x30 mm | at least
        plan {head_on} --quiet --figure DIR/a.png --dpi 0 | --dpi | from 30 to 2400
        plan {head_on} --quiet --figure DIR/a.png --dpi 2400 --size 900x900 | --dpi | at most 200 million
        plan {head_on} --quiet --figure DIR/a.svg --dpi 300 | --dpi 300 | a.svg | .png
        compare {head_on} --quiet --figure DIR/a.pdf --dpi 300 | --dpi 300 | a.pdf | .png
        plan {head_on} --quiet --figure DIR/a.svg --times 0,9999 | --times: found 9999 s | from 0 to
        simulate {head_on} --quiet --figure DIR/a.svg --times 9999 | --times: found 9999 s | from 0 to
        compare {head_on} --quiet --figure DIR/a.svg --times 9999 | --times: found 9999 s | from 0 to
        plan {head_on} --quiet --figure DIR/a.svg --times -1 | --times | -1
        plan {head_on} --size 100x100 | --figure
        "
    ));
    for name in ["a.svg", "a.png", "a.pdf"] {
        assert!(!std::path::Path::new(&folder.at(name)).exists(), "{name}");
    }
}
