#![doc = include_str!("../README.md")]
#![forbid(unsafe_code)]
#![warn(missing_docs)]

use std::cell::Cell;
use std::num::NonZero;
use std::panic::resume_unwind;
use std::thread;

/// Fewer items of little work are worked on one after another: starting a thread costs some 50 µs.
const FEWEST: usize = 8;

thread_local! {
    /// True on a thread that has a part of such work: all cores are busy then.
    static AT_WORK: Cell<bool> = const { Cell::new(false) };
}

/// `work` on every item, with its index; the results are in the order of the items.
pub fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(usize, &T) -> R + Sync) -> Vec<R> {
    let indexed = items.iter().enumerate();
    if items.len() < FEWEST {
        return indexed.map(|(index, item)| work(index, item)).collect();
    }
    let mut found: Vec<_> = indexed.map(|(index, item)| (index, item, None)).collect();
    each(&mut found, |(index, item, found)| {
        *found = Some(work(*index, item))
    });
    found.into_iter().filter_map(|(.., found)| found).collect()
}

/// `work` on every item, each of which takes long enough for a thread of its own.
pub fn each<T: Send>(items: &mut [T], work: impl Fn(&mut T) + Sync) {
    let threads = cores().min(items.len());
    if threads < 2 || AT_WORK.get() {
        items.iter_mut().for_each(work);
        return;
    }
    // strided, because neighbours in a list cost alike
    let mut parts: Vec<Vec<&mut T>> = (0..threads).map(|_| Vec::new()).collect();
    for (index, item) in items.iter_mut().enumerate() {
        parts[index % threads].push(item);
    }
    let do_part = |part: Vec<&mut T>| {
        AT_WORK.set(true);
        part.into_iter().for_each(&work);
    };
    thread::scope(|scope| {
        let own = parts.pop().unwrap_or_default();
        let running: Vec<_> = parts
            .into_iter()
            .map(|part| scope.spawn(|| do_part(part)))
            .collect();
        let _at_work = AtWork;
        do_part(own);
        for thread in running {
            thread.join().unwrap_or_else(|panic| resume_unwind(panic));
        }
    });
}

/// The results of two pieces of work at once, each of which takes long enough for a thread. Work
/// within them stays on its thread.
pub fn join<A, B: Send>(one: impl FnOnce() -> A, other: impl FnOnce() -> B + Send) -> (A, B) {
    if cores() < 2 || AT_WORK.get() {
        return (one(), other());
    }
    thread::scope(|scope| {
        let running = scope.spawn(|| {
            AT_WORK.set(true);
            other()
        });
        AT_WORK.set(true);
        let _at_work = AtWork;
        let one = one();
        let other = running.join();
        (one, other.unwrap_or_else(|panic| resume_unwind(panic)))
    })
}

/// `work` on so many threads at once; work within it stays on its thread.
pub fn on_threads(threads: usize, work: impl Fn() + Sync) {
    thread::scope(|scope| {
        let marked = || {
            AT_WORK.set(true);
            work();
        };
        let running: Vec<_> = (0..threads).map(|_| scope.spawn(marked)).collect();
        for thread in running {
            thread.join().unwrap_or_else(|panic| resume_unwind(panic));
        }
    });
}

/// All cores that this process may use.
pub fn cores() -> usize {
    thread::available_parallelism().map_or(1, NonZero::get)
}

/// Ends the part of the calling thread, after a panic too.
struct AtWork;

impl Drop for AtWork {
    fn drop(&mut self) {
        AT_WORK.set(false);
    }
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

    #[test]
    fn every_item_is_worked_on_once_within_other_work_too() {
        let mut items = [[0; 5]; 3];
        super::each(&mut items, |inner| super::each(inner, |item| *item += 1));
        assert_eq!(items, [[1; 5]; 3]);
        assert!(!super::AT_WORK.get());
    }

    #[test]
    fn both_results_are_those_of_their_work() {
        let within = || super::join(|| super::AT_WORK.get(), || 2);
        let ((at_work, two), three) = super::join(within, || "three");
        assert_eq!((at_work, two, three), (super::cores() > 1, 2, "three"));
        assert!(!super::AT_WORK.get());
        let in_one = || super::join(|| -> u8 { panic!("in one") }, || 1);
        let in_other = || super::join(|| 1, || -> u8 { panic!("in the other") });
        assert!(std::panic::catch_unwind(in_one).is_err());
        assert!(std::panic::catch_unwind(in_other).is_err());
        assert!(!super::AT_WORK.get());
    }

    #[test]
    fn a_panic_is_passed_on() {
        let work = || super::each(&mut [0, 1, 2], |item| assert!(*item < 2));
        assert!(std::panic::catch_unwind(work).is_err());
        assert!(!super::AT_WORK.get());
    }
}
