//! A real feed, against what is known of it from other decoders.

use std::collections::BTreeSet;

use searoom_geometry::frame::KNOT_MPS;
use searoom_traffic::{Dropped, Identity, Kind, Reader, Report, Settings};

#[test]
fn a_thousand_lines_of_the_norwegian_coast() {
    let file = include_bytes!("data/kystverket-1000-lines.nm4");
    let mut reader = Reader::new(Settings::default());
    let mut reports: Vec<Report> = Vec::new();
    reader.bytes(file, 1_565_218_800.0, |report| reports.push(report));
    reader.finish(1_565_218_800.0, |report| reports.push(report));
    let counts = reader.counts();
    // as pyais 3.3.1 reads them, with the same positions and names
    assert_eq!((counts.lines, counts.reports), (1000, 877), "{counts}");
    assert_eq!(counts.dropped(Dropped::TagCheckSum), 246);
    let known = [1, 3, 5, 18, 24].map(|number| counts.messages(number));
    assert_eq!(known.iter().sum::<u64>(), 877);
    let ships: BTreeSet<Identity> = reports.iter().map(|report| report.identity).collect();
    assert_eq!(ships.len(), 833);
    let mut moving = BTreeSet::new();
    for report in &reports {
        assert!(
            matches!(report.kind, Kind::ClassA | Kind::ClassB | Kind::Mark),
            "{report:?}"
        );
        let Some(fix) = report.fix else {
            assert!(report.hull.is_some() || report.name.is_some(), "{report:?}");
            continue;
        };
        if let Some(set) = fix.position {
            // from Jan Mayen to Vardø, and from Lista to Svalbard
            assert!((57.0..80.0).contains(&set.at.lat_deg), "{report:?}");
            assert!((-10.0..35.0).contains(&set.at.lon_deg), "{report:?}");
        }
        // within the thirty seconds, and a minute before
        assert!((fix.time.most - 1_565_218_813.0).abs() < 90.0, "{report:?}");
        let speed = fix.velocity.speed;
        if speed.least > KNOT_MPS && speed.most.is_finite() {
            moving.insert(report.identity);
        }
    }
    assert!((205..=225).contains(&moving.len()), "{}", moving.len());
}
