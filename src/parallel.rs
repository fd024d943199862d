//! Independent work on all cores.

use std::num::NonZero;
use std::panic::resume_unwind;
use std::thread;

/// Fewer items are worked on one after another: starting a thread costs some 50 µs.
const FEWEST: usize = 8;

/// `work` on every item, with its index; the results are in the order of the items.
pub(crate) fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(usize, &T) -> R + Sync) -> Vec<R> {
    let threads = if items.len() < FEWEST {
        1
    } else {
        thread::available_parallelism()
            .map_or(1, NonZero::get)
            .min(items.len())
    };
    if threads == 1 {
        let indexed = items.iter().enumerate();
        return indexed.map(|(index, item)| work(index, item)).collect();
    }
    // strided, because neighbours in a list cost alike
    let part = |first: usize| -> Vec<R> {
        let indices = (first..items.len()).step_by(threads);
        indices.map(|index| work(index, &items[index])).collect()
    };
    let part = &part;
    let mut parts: Vec<_> = thread::scope(|scope| {
        let running: Vec<_> = (0..threads)
            .map(|first| scope.spawn(move || part(first)))
            .collect();
        let join = |thread: thread::ScopedJoinHandle<'_, Vec<R>>| {
            thread.join().unwrap_or_else(|panic| resume_unwind(panic))
        };
        running.into_iter().map(join).map(Vec::into_iter).collect()
    });
    (0..items.len())
        .filter_map(|index| parts[index % threads].next())
        .collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn results_are_in_the_order_of_the_items() {
        for count in [0, 1, 7, 8, 9, 100] {
            let items: Vec<usize> = (0..count).collect();
            let found = super::map(&items, |index, item| (index, 2 * item));
            let expected: Vec<_> = items.iter().map(|i| (*i, 2 * i)).collect();
            assert_eq!(found, expected);
        }
    }
}
