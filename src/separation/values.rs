//! Memory for the values of a grid, and the part of the machine's memory in which it is.

use std::ops::{Deref, DerefMut};

/// Number of values in a cache line.
pub(super) const LINE: usize = 8;

/// Most values of an array that fits into the second cache of a core: 1 MiB.
const SECOND_CACHE: usize = 1 << 17;

/// Least number of values of an array that is larger than one user's share of the last cache: 64 MiB.
const BEYOND_CACHES: usize = 1 << 23;

/// Least number of values of an array that holds a whole large page of the system (2 MiB), wherever it begins: 4 MiB.
const LARGE_PAGES: usize = 1 << 19;

/// The memory in which an array is while it is filled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Residence {
    /// The second cache of a core.
    SecondCache,
    /// The last cache.
    LastCache,
    /// Memory beyond the caches.
    Memory,
}

impl Residence {
    /// Returns where an array of so many values is.
    pub fn of(count: usize) -> Self {
        match count {
            0..=SECOND_CACHE => Self::SecondCache,
            BEYOND_CACHES.. => Self::Memory,
            _ => Self::LastCache,
        }
    }
}

/// An array whose first value begins a cache line, because a store across two lines takes twice as long.
#[derive(Debug)]
pub struct Values {
    memory: Vec<f64>,
    begin: usize,
    count: usize,
}

impl Values {
    /// Makes an array of `count` zeros.
    pub fn new(count: usize) -> Self {
        let memory = vec![0.0; count + LINE - 1];
        if count >= LARGE_PAGES {
            ask_for_large_pages(&memory);
        }
        Self { begin: lead(&memory), memory, count }
    }
}

impl Clone for Values {
    fn clone(&self) -> Self {
        let mut copy = Self::new(self.count);
        copy.copy_from_slice(self);
        copy
    }
}

impl Deref for Values {
    type Target = [f64];

    fn deref(&self) -> &[f64] {
        &self.memory[self.begin..self.begin + self.count]
    }
}

impl DerefMut for Values {
    fn deref_mut(&mut self) -> &mut [f64] {
        &mut self.memory[self.begin..self.begin + self.count]
    }
}

/// Asks the system for large pages. They are mapped in a third of the time at the first write: 4·10⁶ values take 5 ms
/// instead of 14, and computing s takes 5 ms. The system may refuse.
#[cfg(target_os = "linux")]
#[allow(unsafe_code, reason = "no safe call gives this advice")]
fn ask_for_large_pages(memory: &[f64]) {
    use rustix::mm::{Advice, madvise};
    use rustix::param::page_size;

    let pages = memory.as_ptr_range();
    let begin = pages.start.addr().next_multiple_of(page_size());
    let length = pages.end.addr().saturating_sub(begin);
    let address = pages.start.with_addr(begin).cast_mut().cast();
    // SAFETY: The pages lie inside an allocation that is borrowed here. The advice does not change their content.
    let _ = unsafe { madvise(address, length, Advice::LinuxHugepage) };
}

#[cfg(not(target_os = "linux"))]
fn ask_for_large_pages(_: &[f64]) {}

/// Returns the number of values before the first one that begins a cache line.
#[inline(always)]
pub(super) fn lead(values: &[f64]) -> usize {
    values.as_ptr().align_offset(LINE * size_of::<f64>()).min(LINE - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_value_begins_a_line() {
        for count in [0, 1, 7, 8, 1000, LARGE_PAGES] {
            let mut values = Values::new(count);
            assert_eq!((values.len(), lead(&values)), (count, 0));
            assert!(values.iter().all(|&value| value == 0.0));
            values.fill(0.5);
            let copy = values.clone();
            assert_eq!((&*copy, lead(&copy)), (&*values, 0));
        }
    }
}
