//! Tests of the figures: deterministic bytes, units on the axes, and only finite coordinates.

use std::fs;

use searoom::frame::{Pose, Vector};
use searoom::geometry::{ConvexPolygon, Ellipse};
use searoom::obstacle::{EllipsoidObstacle, Obstacle, PolytopeObstacle};
use searoom::report::figure::{Figure, FigureOptions, assessment_figure};
use searoom::study::assess::OwnSituation;
use searoom::target::{TimedVelocitySet, Uncertainty};

use super::program::{Folder, HEAD_ON, run};

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
    assessment_figure(&situation, None, times, &FigureOptions::default(), title).expect("drawn")
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

/// Tests that a title is above the panels, that a long one has several lines, and that one of more
/// than three is truncated visibly.
#[test]
fn a_title_is_drawn_and_fits() {
    let all = targets();
    let titled = |title: &str| titled(&all, 5.0, &[0.0], title).svg();
    let svg = titled("Three & more");
    assert!(svg.contains("Three &amp; more"));
    let long = titled(&"ahoy ".repeat(40));
    assert_eq!(long.matches("ahoy").count(), 40);
    assert!(!long.contains('…') && !long.contains(&"ahoy ".repeat(30)));
    assert!(titled(&"ahoy ".repeat(200)).contains("…<"));
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

const GIVE_WAY_FILE: &str = "scenarios/colregs/give-way.toml";
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
        let dpi = options
            .split_once("--dpi ")
            .map_or(192.0, |(_, dpi)| dpi.parse::<f64>().expect("dpi"));
        let reader = png::Decoder::new(std::io::Cursor::new(&png))
            .read_info()
            .expect("a PNG");
        let dims = reader.info().pixel_dims.expect("a resolution");
        assert_eq!(dims.unit, png::Unit::Meter);
        assert!(
            [dims.xppu, dims.yppu]
                .iter()
                .all(|n| (f64::from(*n) * 0.0254 - dpi).abs() < 0.02)
        );
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
    run(&format!("{GIVE_WAY} {file} --times 200,0,60,60")).success();
    let svg = fs::read_to_string(&file).expect("written");
    for (time, count) in [(">1:00<", 1), (">3:20<", 2), (", 2:04<", 1), (">2:00<", 0)] {
        assert_eq!(svg.matches(time).count(), count, "{time}");
    }
    for first in [">own ship, 0:00<", ">target, 1:00<"] {
        assert!(svg.contains(first), "{first}");
    }
}

/// Figures of one and of two columns have names and the closest approach, and a title where it is
/// wide; a size that is refused names one that is not.
#[test]
fn figures_fit_the_columns_of_papers() {
    let folder = Folder::new();
    let file = folder.at("a.svg");
    let drawn = |words: &str| {
        run(&format!("{words} {file}")).success();
        fs::read_to_string(&file).expect("written")
    };
    for (size, titles) in [("85x60", 0), ("85x85", 0), ("120x90", 0), ("180x120", 1)] {
        let svg = drawn(&format!(
            "plan {GIVE_WAY_FILE} --quiet --size {size} --figure"
        ));
        for text in ["own ship", "target", "209 m, 2:04", ">closest approach<"] {
            assert!(svg.contains(text), "{size} {text}");
        }
        assert_eq!(svg.matches(">Give-way<").count(), titles, "{size}");
    }
    // panels below each other, and land below the sets
    let compared = drawn(&format!(
        "compare {GIVE_WAY_FILE} --quiet --size 85x120 --figure"
    ));
    assert!(compared.contains(">Distance [m]<"));
    let assessed = "assess scenarios/sound/kronborg.toml --quiet --size 85x260 --figure";
    let assessed = drawn(assessed);
    assert!(assessed.contains(">land<") && assessed.contains("#d9cba3"));
    let refused = run(&format!("{GIVE_WAY} {file} --size 25x25")).failure();
    let error = String::from_utf8_lossy(&refused.get_output().stderr).into_owned();
    let least = error.split("at least ").nth(1).expect("a size");
    let least = least.split(' ').next().expect("a size");
    drawn(&format!(
        "plan {GIVE_WAY_FILE} --quiet --size {least} --figure"
    ));
}

/// The legend names a few of the targets that are outside the chart, and counts the others.
#[test]
fn targets_outside_the_chart_are_counted() {
    let folder = Folder::new();
    let mut scene = fs::read_to_string(GIVE_WAY_FILE).expect("a scenario");
    for k in 0..9 {
        scene += &format!(
            "[[targets]]\nname = \"far {k}\"\nposition = {{ east_m = 9e4, north_m = {k}e3 }}\n\
             course_deg = 0\nspeed_mps = 3\nlength_m = 50\nbeam_m = 10\n"
        );
    }
    let (file, figure) = (folder.at("far.toml"), folder.at("a.svg"));
    fs::write(&file, scene).expect("written");
    run(&format!("plan {file} --quiet --figure {figure}")).success();
    let svg = fs::read_to_string(&figure).expect("written");
    assert_eq!(svg.matches(": outside the chart<").count(), 5);
    assert!(svg.contains(">5 more: outside the chart<"));
}

/// One chart per time with its sets, numbered at the left and at the foot.
#[test]
fn panels_show_one_time_each() {
    let folder = Folder::new();
    let file = folder.at("a.svg");
    for (options, titles, [east, north]) in [
        ("", &["0:00", "1:00", "2:04", "3:30"][..], [2, 2]),
        (
            "--times 0,30,60 --size 120x90",
            &["0:00", "0:30", "1:00"],
            [2, 2],
        ),
        ("--times 124 --size 85x60", &["2:04"], [1, 1]),
    ] {
        run(&format!("{GIVE_WAY} {file} --panels {options}")).success();
        let svg = fs::read_to_string(&file).expect("written");
        for title in titles {
            assert_eq!(
                svg.matches(&format!(">{title}<")).count(),
                1,
                "{options} {title}"
            );
        }
        assert_eq!(svg.matches(">East [m]<").count(), east, "{options}");
        assert_eq!(svg.matches(">North [m]<").count(), north, "{options}");
        assert_eq!(
            svg.contains(">209 m<"),
            titles.contains(&"2:04"),
            "{options}"
        );
        // the target's set is filled in every panel, and in the legend
        let filled = svg.matches("opacity=\"0.25\"").count();
        assert_eq!(filled, titles.len() + 1, "{options}");
    }
}

/// Each target is drawn at its own closest approach, with own ship at the same time, and each of them
/// has a panel.
#[test]
fn every_encounter_is_drawn_at_its_closest_approach() {
    let folder = Folder::new();
    let text = include_str!("../../scenarios/sound/kronborg.toml");
    let long = "the ferry with a name of many words";
    let text = text
        .replace("../../", concat!(env!("CARGO_MANIFEST_DIR"), "/"))
        .replace("\"ferry\"", &format!("\"{long}\""));
    let (scenario, file) = (folder.write("a.toml", &text), folder.at("a.svg"));
    let draw = |options: &str| {
        let asked = format!("plan {scenario} --quiet --figure {file} {options}");
        run(&asked).success();
        fs::read_to_string(&file).expect("written")
    };
    let svg = draw("");
    let times = ["8:34", "11:47", "12:26"];
    for time in times {
        assert_eq!(svg.matches(&format!(" m, {time}<")).count(), 1, "{time}");
    }
    // the dots on own ship, the thick line with its key, and the thin ones
    assert_eq!(svg.matches("r=\"2.6\"").count(), 3);
    let lines = |width: &str| format!("stroke=\"#b3001b\" stroke-width=\"{width}\"");
    let lines = ["1.8", "0.8"].map(|width| svg.matches(&lines(width)).count());
    assert_eq!(lines, [2, 2]);
    for role in ["give-way", "port-to-port (desired)"] {
        assert!(svg.contains(&format!(">own ship: {role}<")), "{role}");
    }
    assert!(svg.contains(">the ferry with a name<") || svg.contains(">the ferry with a name of<"));
    assert!(!svg.contains('…'));
    let svg = draw("--panels");
    for title in ["0:00"].into_iter().chain(times) {
        assert!(svg.contains(&format!(">{title}<")), "{title}");
    }
}

/// Methods with the same motions have one curve and one name.
#[test]
fn equal_motions_of_a_comparison_share_a_curve() {
    let folder = Folder::new();
    let file = folder.at("a.svg");
    run(&format!(
        "compare {GIVE_WAY_FILE} --compliance shape --quiet --size 120x90 --figure {file}"
    ))
    .success();
    let svg = fs::read_to_string(&file).expect("written");
    for (text, count) in [
        (">space-time, A* and Dijkstra<", 1),
        (">space-time, Dijkstra<", 0),
        (">sets at their closest approach<", 1),
    ] {
        assert_eq!(svg.matches(text).count(), count, "{text}");
    }
    let colours = |colour: &str| svg.matches(&format!("stroke=\"{colour}\"")).count();
    // the chart, the distances and the legend; nothing for Dijkstra
    assert_eq!([colours("#0072b2"), colours("#56b4e9")], [3, 0]);
}

#[test]
fn options_of_figures_are_refused_by_name() {
    let folder = Folder::new();
    let head_on = "scenarios/colregs/head-on.toml";
    fs::create_dir(folder.at("sub.pdf")).expect("a folder");
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
        plan {head_on} --quiet --figure DIR/a.svg --times -1 | --times | '-1' | seconds from 0 to
        plan {head_on} --size 100x100 | --figure
        plan {head_on} --panels | --figure
        plan {head_on} --quiet --figure DIR/a.svg --panels --times 1,2,3,4,5,6,7 | --panels: found 7
        compare {head_on} --quiet --figure DIR/a.svg --panels | --panels | suite
        plan {head_on} --quiet --figure DIR/.pdf | .pdf: an ending alone
        suite {head_on} --quiet --figure DIR/.SVG | .SVG: an ending alone
        compare {head_on} --quiet --figure DIR/.png | .png: an ending alone
        assess {head_on} --quiet --figure DIR/.png | .png: an ending alone
        plan {head_on} --quiet --figure DIR/sub.pdf | sub.pdf: a folder | '/'
        compare {head_on} --quiet --figure DIR/sub.pdf | sub.pdf: a folder
        "
    ));
    assert_eq!(
        fs::read_dir(folder.at("sub.pdf"))
            .expect("a folder")
            .count(),
        0
    );
    for name in ["a.svg", "a.png", "a.pdf", ".pdf", ".SVG", ".png"] {
        assert!(!std::path::Path::new(&folder.at(name)).exists(), "{name}");
    }
}

/// Own ship sails a millimetre, and a target is ten kilometres broad: a PNG takes no step for each
/// pixel that is far outside. `report::figure::render` bounds the steps; here the whole is drawn.
#[test]
fn a_chart_of_a_millimetre_beside_a_target_of_kilometres_is_drawn() {
    let folder = Folder::new();
    let text = HEAD_ON
        .replace(
            "{ east_m = 1500.0, north_m = 0.0 }]",
            "{ east_m = 0.001, north_m = 0.0 }]",
        )
        .replace(
            "position = { east_m = 1500.0",
            "position = { east_m = 20000.0",
        )
        .replace("length_m = 60.0", "length_m = 10000.0")
        .replace("beam_m = 12.0", "beam_m = 10000.0");
    let file = folder.write("a.toml", text);
    let figure = folder.at("a.png");
    run(&format!("plan {file} --figure {figure}")).success();
    assert!(fs::read(figure).expect("a figure").starts_with(b"\x89PNG"));
    // numbers of the axes without the rounding of the machine, which would run into each other
    let figure = folder.at("a.svg");
    run(&format!("plan {file} --figure {figure}")).success();
    let svg = fs::read_to_string(figure).expect("a figure");
    let numbers: Vec<&str> = svg
        .split('<')
        .filter_map(|tag| tag.split_once('>'))
        .map(|t| t.1)
        .collect();
    let numbers: Vec<&str> = numbers
        .into_iter()
        .filter(|text| text.parse::<f64>().is_ok())
        .collect();
    assert!(
        numbers.iter().any(|text| text.contains("e-4")),
        "{numbers:?}"
    );
    assert!(numbers.iter().all(|text| text.len() < 9), "{numbers:?}");
}
