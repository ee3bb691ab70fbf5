//! Loops over all cores, by rayon if there are threads. In a browser, where WebAssembly has one thread, they take one item after the other.
//!
//! Results are collected in the order of the items, so both variants give the same bits.

use std::sync::{Mutex, PoisonError};

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub use rayon::join;

/// Does two pieces of work, here one after the other.
#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub fn join<A, B>(first: impl FnOnce() -> A, second: impl FnOnce() -> B) -> (A, B) {
    (first(), second())
}

/// Number of threads that work in parallel.
pub fn threads() -> u32 {
    #[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
    return rayon::current_num_threads() as u32;
    #[cfg(all(target_family = "wasm", target_os = "unknown"))]
    1
}

/// Pool of work spaces, as many as tasks run at once. A task reuses the work space that another has released.
pub struct Rooms<T>(Mutex<Vec<T>>);

impl<T> Rooms<T> {
    /// Pool without work spaces.
    pub fn none() -> Self {
        Self(Mutex::new(Vec::new()))
    }

    /// Runs a task in a free work space, or in a new one.
    pub fn within<R>(&self, new: impl FnOnce() -> T, work: impl FnOnce(&mut T) -> R) -> R {
        let free = || self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let left = free().pop();
        let mut room = left.unwrap_or_else(new);
        let result = work(&mut room);
        free().push(room);
        result
    }
}

/// Parallel iterators of rayon.
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub mod prelude {
    pub use rayon::prelude::*;
}

/// Functions of rayon that this crate calls, on iterators of the standard library.
#[cfg(all(target_family = "wasm", target_os = "unknown"))]
pub mod prelude {
    /// Conversion into an iterator, under the name of rayon.
    pub trait IntoParallelIterator: IntoIterator + Sized {
        /// Iterator over the items.
        fn into_par_iter(self) -> Self::IntoIter {
            self.into_iter()
        }
    }

    impl<I: IntoIterator> IntoParallelIterator for I {}

    /// Iterators over a slice, under the names of rayon.
    pub trait ParallelSlice<T> {
        /// Iterator over references.
        fn par_iter(&self) -> std::slice::Iter<'_, T>;
        /// Iterator over mutable references.
        fn par_iter_mut(&mut self) -> std::slice::IterMut<'_, T>;
        /// Iterator over chunks of this size.
        fn par_chunks(&self, size: usize) -> std::slice::Chunks<'_, T>;
        /// Iterator over mutable chunks of this size.
        fn par_chunks_mut(&mut self, size: usize) -> std::slice::ChunksMut<'_, T>;
    }

    impl<T> ParallelSlice<T> for [T] {
        fn par_iter(&self) -> std::slice::Iter<'_, T> {
            self.iter()
        }

        fn par_iter_mut(&mut self) -> std::slice::IterMut<'_, T> {
            self.iter_mut()
        }

        fn par_chunks(&self, size: usize) -> std::slice::Chunks<'_, T> {
            self.chunks(size)
        }

        fn par_chunks_mut(&mut self, size: usize) -> std::slice::ChunksMut<'_, T> {
            self.chunks_mut(size)
        }
    }

    /// Further adapters of iterators, under the names of rayon.
    pub trait ParallelIterator: Iterator + Sized {
        /// Iterator over the items of the iterators that a function returns.
        fn flat_map_iter<U: IntoIterator, F: FnMut(Self::Item) -> U>(self, each: F) -> std::iter::FlatMap<Self, U, F> {
            self.flat_map(each)
        }
    }

    impl<I: Iterator> ParallelIterator for I {}
}
