//! Turns numbers into little-endian bytes at the speed of memory: a block is filled and passed to a sink.

use std::io::{self, Write};

/// Size in bytes at which a block is passed to the sink. It stays inside the second-level cache, and one call costs little
/// compared with its content.
const BLOCK: usize = 1 << 18;

/// Gathers bytes into blocks for a sink.
pub(super) struct Block<'a> {
    sink: &'a mut dyn Write,
    bytes: Vec<u8>,
}

impl<'a> Block<'a> {
    pub(super) fn new(sink: &'a mut dyn Write) -> Self {
        Self { sink, bytes: Vec::with_capacity(BLOCK) }
    }

    /// Returns room for the next `count` bytes, which the caller must fill.
    pub(super) fn room(&mut self, count: usize) -> io::Result<&mut [u8]> {
        let begin = self.begin(count)?;
        self.bytes.resize(begin + count, 0);
        Ok(&mut self.bytes[begin..])
    }

    /// Appends bytes.
    pub(super) fn bytes(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.begin(bytes.len())?;
        self.bytes.extend_from_slice(bytes);
        Ok(())
    }

    fn begin(&mut self, count: usize) -> io::Result<usize> {
        if self.bytes.len() + count > BLOCK {
            self.sink.write_all(&self.bytes)?;
            self.bytes.clear();
        }
        Ok(self.bytes.len())
    }

    /// Passes the remaining bytes to the sink.
    pub(super) fn finish(self) -> io::Result<()> {
        self.sink.write_all(&self.bytes)
    }
}

/// Writes numbers into `room`, 8 bytes each, little-endian.
pub(super) fn put_f64(room: &mut [u8], values: impl Iterator<Item = f64>) {
    for (place, value) in room.chunks_exact_mut(8).zip(values) {
        place.copy_from_slice(&value.to_le_bytes());
    }
}

/// Writes vectors into `room`, 24 bytes each, little-endian.
pub(super) fn put_vectors(room: &mut [u8], vectors: impl Iterator<Item = [f64; 3]>) {
    for (place, [x, y, z]) in room.chunks_exact_mut(24).zip(vectors) {
        place[..8].copy_from_slice(&x.to_le_bytes());
        place[8..16].copy_from_slice(&y.to_le_bytes());
        place[16..].copy_from_slice(&z.to_le_bytes());
    }
}

/// Writes bytes into `room`.
pub(super) fn put_bytes(room: &mut [u8], values: impl Iterator<Item = u8>) {
    room.iter_mut().zip(values).for_each(|(place, value)| *place = value);
}

/// Writes numbers into `room`, 8 bytes each, big-endian.
pub(super) fn put_f64_be(room: &mut [u8], values: impl Iterator<Item = f64>) {
    for (place, value) in room.chunks_exact_mut(8).zip(values) {
        place.copy_from_slice(&value.to_be_bytes());
    }
}
