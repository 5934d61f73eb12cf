//! A parallel map on threads of its own, for hashing files.
//!
//! Not on rayon's pool: that one belongs to the work of nodes, and whoever waits for it may be handed a piece of a long
//! integration to finish first.

use std::sync::atomic::{AtomicUsize, Ordering};

/// Items below which one thread is faster than starting another.
const FEW: usize = 16;

/// Applies `f` to all items on at most `threads` threads; the results are in the order of the items.
pub(super) fn map<T: Sync, R: Send>(items: &[T], threads: usize, f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = threads.min(items.len() / FEW + 1);
    if threads <= 1 {
        return items.iter().map(f).collect();
    }
    let next = AtomicUsize::new(0);
    let take = || {
        let mut results = Vec::new();
        while let index = next.fetch_add(1, Ordering::Relaxed)
            && let Some(item) = items.get(index)
        {
            results.push((index, f(item)));
        }
        results
    };
    let mut results = std::thread::scope(|scope| {
        let others: Vec<_> = (1..threads).map(|_| scope.spawn(take)).collect();
        let mut results = take();
        for other in others {
            match other.join() {
                Ok(more) => results.extend(more),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        results
    });
    results.sort_unstable_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    #[test]
    fn order_is_kept_for_any_number_of_threads() {
        let items: Vec<usize> = (0..1000).collect();
        for threads in [1, 2, 7] {
            let doubled = super::map(&items, threads, |x| 2 * x);
            assert_eq!(doubled, (0..1000).map(|x| 2 * x).collect::<Vec<_>>());
        }
    }
}
