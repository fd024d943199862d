//! Tests that the interior-point iteration does not allocate.

#[path = "campaigns/forces/scenes.rs"]
mod optimal_control_scenes;

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

use optimal_control_scenes as scenes;
use searoom::planner::optimal_control::Settings;
use searoom::planner::optimal_control::solver::{Iterate, Workspace, solve};

struct Counting;

thread_local! {
    static COUNT: Cell<usize> = const { Cell::new(0) };
}

fn count() -> usize {
    COUNT.with(Cell::get)
}

// SAFETY: forwards all calls to the system allocator
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // an ending thread has no counter
        let _ = COUNT.try_with(|count| count.set(count.get() + 1));
        // SAFETY: guaranteed by the caller
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: guaranteed by the caller
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Runs on a separate thread, because the test harness may allocate at any time.
#[test]
fn steps_allocate_nothing() {
    let desired = scenes::desired();
    let keep_outs = scenes::figure_9();
    let task = scenes::task(&desired, &keep_outs, 50);
    let guess = scenes::straight(&task);
    let problem = task.transcription();
    let mut work = Workspace::new(&problem);
    let mut counts = Vec::with_capacity(3);
    let mut steps = Vec::with_capacity(3);
    for max_iterations in [1, 10, 200] {
        let mut at = Iterate::guess(guess.states.clone(), guess.forces.clone());
        let settings = Settings {
            max_iterations,
            ..Settings::default()
        };
        let before = count();
        let report = solve(&problem, &mut at, &mut work, &settings, &|| true);
        counts.push(count() - before);
        steps.push(report.iterations);
    }
    assert!(steps[2] > 25 && steps[0] == 1, "{steps:?}");
    // multipliers at the start, independent of the number of steps
    assert_eq!(counts[0], counts[2], "{counts:?} in {steps:?} steps");
    assert_eq!(counts[0], counts[1]);
    assert!(counts[0] <= 4, "{counts:?}");
}
