//! Checking plan documents, from text to verdict. Every bench asserts the verdict, then times it.

use std::hint::black_box;
use std::path::PathBuf;

use criterion::{Criterion, criterion_group, criterion_main};
use searoom::document::PlanDocument;
use searoom::pipeline;
use searoom::scenario::Scenario;
use searoom::verification::verify;

fn documents(criterion: &mut Criterion) {
    for path in [
        "colregs/head-on",
        "colregs/overtaking",
        "uncertainty/turning",
        "uncertainty/ellipse",
        "harbour/munkholmen",
        "harbour/canal-transit",
        "paper/figure_9",
    ] {
        let file = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join(format!("scenarios/{path}.toml"));
        let run = pipeline::run(Scenario::read(&file).expect("a scenario"));
        let text = serde_json::to_string_pretty(&PlanDocument::of(&run)).expect("a document");
        let found = verify(&text).expect("a document");
        assert!(found.verified(), "{:#?}", found.violations);
        let id = format!(
            "verify/{path}, {} pieces, {} sets, {} pieces of land",
            found.pieces, found.sets, found.land
        );
        criterion.bench_function(&id, |b| b.iter(|| verify(black_box(&text))));
    }
}

criterion_group!(benches, documents);
criterion_main!(benches);
