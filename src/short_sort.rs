//! Sorting of lists that are short beside the work on their entries.
//!
//! The standard library's sort is compiled anew for every type and comparison, 5 kB each time in a page; here one copy
//! sorts places, and the entries follow. Large samples take the standard library's.

use std::cmp::Ordering;

/// Stable sorts with the results of [`slice::sort_by`], [`slice::sort_by_key`] and [`slice::sort`].
pub(crate) trait ShortSort<T> {
    fn sort_short_by(&mut self, compare: impl FnMut(&T, &T) -> Ordering);

    fn sort_short_by_key<K: Ord>(&mut self, mut key: impl FnMut(&T) -> K) {
        self.sort_short_by(|a, b| key(a).cmp(&key(b)));
    }

    fn sort_short(&mut self)
    where
        T: Ord,
    {
        self.sort_short_by(T::cmp);
    }
}

impl<T> ShortSort<T> for [T] {
    fn sort_short_by(&mut self, mut compare: impl FnMut(&T, &T) -> Ordering) {
        let mut sources = sorted_places(self.len(), &mut |a, b| compare(&self[a], &self[b]));
        // Each cycle of the permutation is followed once: an entry whose source is its own place is done.
        for start in 0..sources.len() {
            let mut place = start;
            loop {
                let source = std::mem::replace(&mut sources[place], place);
                if source == start {
                    break;
                }
                self.swap(place, source);
                place = source;
            }
        }
    }
}

/// For every place of the sorted list, where its entry stands.
fn sorted_places(count: usize, compare: &mut dyn FnMut(usize, usize) -> Ordering) -> Vec<usize> {
    let mut places: Vec<usize> = (0..count).collect();
    places.sort_by(|&a, &b| compare(a, b));
    places
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Few keys, so that many entries are equal: their order shows whether the sort is stable.
        #[test]
        fn entries_stand_as_the_standard_library_sorts_them(keys in prop::collection::vec(0..6u8, 0..80)) {
            let list: Vec<(u8, usize)> = keys.into_iter().zip(0..).collect();
            let [mut expected, mut descending] = [list.clone(), list.clone()];
            let [mut by, mut by_key, mut whole] = [list.clone(), list.clone(), list];
            expected.sort_by_key(|&(key, _)| key);
            by_key.sort_short_by_key(|&(key, _)| key);
            prop_assert_eq!(&by_key, &expected);
            whole.sort_short();
            prop_assert_eq!(whole, expected);
            descending.sort_by_key(|&(key, _)| std::cmp::Reverse(key));
            by.sort_short_by(|a, b| b.0.cmp(&a.0));
            prop_assert_eq!(by, descending);
        }
    }
}
