//! Random numbers from a seed: the same in every run. Uniform ones are equal on every machine, normal ones but for rounding.

/// A stream of random numbers by SplitMix64 (Steele, Lea, Flood 2014); normal ones are made by Box–Muller.
#[derive(Debug, Clone)]
pub struct Random(u64);

/// 2⁶⁴ over the golden ratio, odd.
const GOLDEN: u64 = 0x9E37_79B9_7F4A_7C15;

fn mixed(state: u64) -> u64 {
    let z = (state ^ (state >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

impl Random {
    /// Makes the stream of a seed. Every seed gives another stream.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Makes one of the streams of a seed, by its number. They are independent of each other.
    pub fn stream(seed: u64, number: u64) -> Self {
        Self(mixed(Self(seed).bits().wrapping_add(number)))
    }

    /// Returns the next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(GOLDEN);
        mixed(self.0)
    }

    /// Returns a whole number below n, or 0 if n is 0.
    pub fn below(&mut self, n: usize) -> usize {
        (self.bits() % n.max(1) as u64) as usize
    }

    /// Returns one of several items.
    pub fn pick<'a, T>(&mut self, all: &'a [T]) -> &'a T {
        &all[self.below(all.len())]
    }

    /// Returns a uniform deviate in (0, 1], so that its logarithm is finite.
    pub fn uniform(&mut self) -> f64 {
        ((self.bits() >> 11) as f64 + 1.0) / (1u64 << 53) as f64
    }

    /// Returns a uniform deviate between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Returns a normal deviate of mean 0 and standard deviation 1.
    pub fn normal(&mut self) -> f64 {
        let (radius, turn) = ((-2.0 * self.uniform().ln()).sqrt(), std::f64::consts::TAU * self.uniform());
        radius * turn.cos()
    }
}
