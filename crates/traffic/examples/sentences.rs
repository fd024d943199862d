//! Reads sentences of AIS from a file, or a sample, and prints what each says as sets.
//!
//! ```sh
//! cargo run --release -p searoom-traffic --example sentences -- FILE
//! ```

use std::time::Instant;

use searoom_geometry::frame::KNOT_MPS;
use searoom_traffic::{Reader, Settings};

const SAMPLE: &[u8] = b"\\c:1565218798*53\\!BSVDM,1,1,,A,13mb9U0P00PRk8fT5nw>4?wj2006,0*5D
\\c:1565218798*53\\!BSVDM,1,1,,A,33mkDd1000QbddT`LhTnCiKh0Dfr,0*68
noise
";

/// Reports that are printed; the others are counted.
const MOST: usize = 10;

fn main() -> std::io::Result<()> {
    let file = match std::env::args_os().nth(1) {
        Some(file) => std::fs::read(file)?,
        None => SAMPLE.to_vec(),
    };
    let mut reader = Reader::new(Settings::default());
    let (mut reports, begun) = (Vec::new(), Instant::now());
    reader.bytes(&file, 0.0, |report| reports.push(report));
    reader.finish(0.0, |report| reports.push(report));
    let seconds = begun.elapsed().as_secs_f64();
    for report in reports.iter().take(MOST) {
        let identity = report.identity;
        println!("{identity:?}, {}", report.kind);
        if let Some(fix) = report.fix {
            match fix.position {
                Some(set) => println!("  within {:.0} m of {}", set.radius_m, set.at),
                None => println!("  no place"),
            }
            let [least, most] = [fix.velocity.speed.least, fix.velocity.speed.most];
            let (least, most) = (least / KNOT_MPS, most / KNOT_MPS);
            println!("  {least:.2} to {most:.2} kn");
        }
        for note in report.notes.iter() {
            println!("  {}", note.word());
        }
    }
    println!("{}", reader.counts());
    let lines = reader.counts().lines as f64;
    eprintln!("{:.2} million lines a second", 1e-6 * lines / seconds);
    Ok(())
}
