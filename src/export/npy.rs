//! Writes NumPy arrays (`.npy`): f64, little-endian, C order. `npyz` writes the header. It would write the body value by
//! value, at half the speed of the disk's cache; this file writes it in blocks.

use super::block::{Block, put_f64};
use npyz::WriterBuilder;
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
    block.bytes(&head(shape)?)?;
    for run in values.chunks(RUN) {
        put_f64(block.room(8 * run.len())?, run.iter().copied());
    }
    block.finish()
}

fn head(shape: &[u64]) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    // The header is complete once the writer exists; dropping the writer adds nothing.
    drop(npyz::WriteOptions::<f64>::new().default_dtype().shape(shape).writer(&mut bytes).begin_nd()?);
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_bit_for_bit() {
        let values = [1.0, -0.0, f64::NAN, 5e-324, 0.1, 2.0];
        let mut file = Vec::new();
        array_npy(&mut file, &[2, 3], &values).unwrap();
        let read = npyz::NpyFile::new(&file[..]).unwrap();
        assert_eq!(read.shape(), [2, 3]);
        let back: Vec<f64> = read.into_vec().unwrap();
        assert_eq!(back.map_bits(), values.to_vec().map_bits());
        assert!(array_npy(&mut Vec::new(), &[7], &values).is_err());
    }

    trait Bits {
        fn map_bits(self) -> Vec<u64>;
    }

    impl Bits for Vec<f64> {
        fn map_bits(self) -> Vec<u64> {
            self.into_iter().map(f64::to_bits).collect()
        }
    }
}
