//! Land: reading a map, asking it, planning round it. Every bench asserts the answer, then times
//! it.

use std::hint::black_box;
use std::path::PathBuf;

use criterion::{Criterion, criterion_group, criterion_main};
use searoom::frame::{Geographic, Georeference, Vector};
use searoom::map::Map;
use searoom::pipeline;
use searoom::planner::space_time;
use searoom::scenario::Scenario;

fn earth(lat_deg: f64, lon_deg: f64) -> Georeference {
    Georeference::new(Geographic { lat_deg, lon_deg }).expect("an origin")
}

fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("maps/{name}.geojson"))
}

/// From the file to the index.
fn load(criterion: &mut Criterion) {
    for (name, lat, lon, vertices) in [
        ("trondheim-harbour", 63.44, 10.399, 1_593),
        ("froya-skerries-gshhg", 63.8, 8.8, 8_075),
    ] {
        let (file, earth) = (file(name), earth(lat, lon));
        let map = Map::read(&file, &earth, None).expect("a map");
        // a ring of the file has its first vertex twice
        let found: usize = map
            .polygons()
            .iter()
            .map(|p| p.vertex_count() + p.rings().len())
            .sum();
        assert_eq!(found, vertices);
        criterion.bench_function(&format!("map/load/{vertices} vertices"), |b| {
            b.iter(|| Map::read(black_box(&file), &earth, None).expect("a map"))
        });
    }
}

/// One ragged ring of 100,000 vertices, 24 km about a point.
fn ragged() -> String {
    const VERTICES: u32 = 100_000;
    let position = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i % VERTICES) / f64::from(VERTICES);
        let waves =
            (0..14).map(|k| 1.6_f64.powi(-k) * (2_f64.powi(k) * angle + f64::from(k)).sin());
        let radius = 24e3 * (1.0 + 0.1 * waves.sum::<f64>());
        let (sin, cos) = angle.sin_cos();
        format!(
            "[{:.7},{:.7}]",
            10.4 + radius * cos / 49.8e3,
            63.44 + radius * sin / 111.4e3
        )
    };
    let positions: Vec<String> = (0..=VERTICES).map(position).collect();
    format!(
        r#"{{"type":"Polygon","coordinates":[[{}]]}}"#,
        positions.join(",")
    )
}

fn load_a_large_one(criterion: &mut Criterion) {
    let (text, earth) = (ragged(), earth(63.44, 10.4));
    let map = Map::parse(&text, &earth, None).expect("a map");
    assert_eq!(map.polygons()[0].vertex_count(), 100_000);
    let mut group = criterion.benchmark_group("map");
    group
        .sample_size(10)
        .bench_function("load/100000 vertices", |b| {
            b.iter(|| Map::parse(black_box(&text), &earth, None).expect("a map"))
        });
    group.finish();
}

/// A path around Munkholmen, and the distance from land.
fn ask(criterion: &mut Criterion) {
    let map = Map::read(&file("trondheim-harbour"), &earth(63.44, 10.399), None).expect("a map");
    let path = [
        (600.0, 900.0),
        (-800.0, 800.0),
        (-1200.0, 1300.0),
        (-700.0, 1700.0),
    ]
    .map(|(x, y)| Vector::new(x, y));
    assert!(map.crossings(&path, 10.0).is_empty());
    criterion.bench_function("map/path of 3 legs", |b| {
        b.iter(|| map.crossings(black_box(&path), 10.0))
    });
    assert!(map.signed_distance(path[1]) > 0.0);
    criterion.bench_function("map/signed distance", |b| {
        b.iter(|| map.signed_distance(black_box(path[1])))
    });
}

/// Round Munkholmen among three targets: the plan alone, and with it the land that is folded in.
fn plan(criterion: &mut Criterion) {
    let scenario =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("scenarios/harbour/munkholmen.toml");
    let scenario = Scenario::read(&scenario).expect("a scenario");
    let run = pipeline::run(scenario.clone());
    let evaluation = run.evaluation.expect("a plan");
    assert!(evaluation.verified() && evaluation.min_land_distance >= 15.0 - 1e-6);
    assert_eq!(scenario.targets.len(), 3);
    let obstacles: Vec<_> = pipeline::sets(&scenario)
        .into_iter()
        .map(|s| s.with_domain)
        .collect();
    let land = pipeline::land_within_reach(&scenario).pieces;
    let land_obstacle = pipeline::land_obstacle(&scenario, &land);
    let asked = pipeline::problem(&scenario, &obstacles, &land_obstacle);
    let id = format!("plan/3 targets, {} pieces of land", land.len());
    criterion.bench_function(&id, |b| b.iter(|| space_time::plan(black_box(&asked))));
    criterion.bench_function("plan/land folded in", |b| {
        b.iter(|| {
            pipeline::land_obstacle(
                &scenario,
                &pipeline::land_within_reach(black_box(&scenario)).pieces,
            )
        })
    });
}

criterion_group!(benches, load, load_a_large_one, ask, plan);
criterion_main!(benches);
