//! Writes NumPy arrays (`.npy`, version 1.0): f64, little-endian, C order, in blocks.

use super::block::{Block, put_f64};
use std::io::{self, Write};

/// Number of values put into a block at a time.
const RUN: usize = 1 << 12;

/// Writes one array of the given shape; NaN stays NaN, bit for bit.
///
/// # Errors
/// The errors of the sink; `InvalidInput` if the shape does not have as many elements as `values`.
///
/// # Examples
/// ```
/// let mut file = Vec::new();
/// wheelrail::export::array_npy(&mut file, &[2, 3], &[0.0; 6])?;
/// assert_eq!(file.len(), 128 + 6 * 8);
/// assert!(wheelrail::export::array_npy(&mut Vec::new(), &[7], &[0.0; 6]).is_err());
/// # Ok::<(), std::io::Error>(())
/// ```
pub fn array_npy(sink: &mut dyn Write, shape: &[u64], values: &[f64]) -> io::Result<()> {
    if shape.iter().product::<u64>() != values.len() as u64 {
        let text = format!("{} values for an array of shape {shape:?}", values.len());
        return Err(io::Error::new(io::ErrorKind::InvalidInput, text));
    }
    let mut block = Block::new(sink);
    block.bytes(&head(shape))?;
    for run in values.chunks(RUN) {
        put_f64(block.room(8 * run.len())?, run.iter().copied());
    }
    block.finish()
}

/// Length of the header's beginning: magic, version, and the length of the rest as two bytes, little-endian.
const PREFIX: usize = 10;

/// Multiple \[bytes\] at which NumPy begins the data; blanks before the line break that ends the header fill up to it.
const ALIGNMENT: usize = 64;

/// Returns the header of an array of at most a thousand dimensions: its length fits into two bytes.
fn head(shape: &[u64]) -> Vec<u8> {
    let sizes: String = shape.iter().map(|size| format!("{size}, ")).collect();
    // As Python prints a tuple: (2, 3), but (2,).
    let sizes = sizes.strip_suffix(if shape.len() > 1 { ", " } else { " " }).unwrap_or_default();
    let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({sizes}), }}");
    let rest = (PREFIX + text.len() + 1).next_multiple_of(ALIGNMENT) - PREFIX;
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((rest as u16).to_le_bytes());
    bytes.extend(format!("{text:<0$}\n", rest - 1).bytes());
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_bit_for_bit() {
        let values = [1.0, -0.0, f64::NAN, 5e-324, 0.1, 2.0];
        let mut file = Vec::new();
        array_npy(&mut file, &[2, 3], &values).unwrap();
        let back = file[128..].chunks(8).map(|bytes| bytes.try_into().map(f64::from_le_bytes).unwrap());
        assert_eq!(back.map(f64::to_bits).collect::<Vec<_>>(), values.map(f64::to_bits));
        assert!(array_npy(&mut Vec::new(), &[7], &values).is_err());
    }

    /// The bytes that NumPy 2.4 writes for such arrays.
    #[test]
    fn headers_are_those_of_numpy() {
        for (shape, text) in [(&[5][..], "(5,)"), (&[2, 3], "(2, 3)"), (&[2, 3, 4], "(2, 3, 4)")] {
            let text = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {text}, }}");
            let expected = [b"\x93NUMPY\x01\x00\x76\x00", format!("{text:<117}\n").as_bytes()].concat();
            assert_eq!(head(shape), expected);
        }
    }
}
