//! Random numbers from a seed: the same in every run. Uniform ones are equal on every machine, normal ones but for rounding.

/// What readers of profiles may stumble over, for [`Random::mutate`].
pub const SNIPPETS: [&str; 18] = [
    "\n",
    "\n\n",
    " ",
    ",",
    ";",
    "=",
    "\"",
    "!",
    "-",
    "1e999",
    "nan",
    "\u{1a}",
    "[Profile2Points]\n",
    "XYPoints=1\n",
    "MPD3=A 1 2 3 4 5\n",
    "point.end\n",
    "inversion = 1\n",
    "ColumnDef=Y,X\n",
];

/// A stream of random numbers by SplitMix64; normal ones are made by Box–Muller.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// Makes the stream of a seed. Every seed gives another stream.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// Returns the next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
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

    /// Changes bytes at one to four places, as transfers and editors do: bytes and bits change, pieces go, come twice or turn around,
    /// and one of `snippets` comes in.
    pub fn mutate(&mut self, bytes: &mut Vec<u8>, snippets: &[&str]) {
        for _ in 0..=self.below(3) {
            let at = self.below(bytes.len());
            let end = (at + self.below(40)).min(bytes.len());
            match self.below(7) {
                0 if at < bytes.len() => bytes[at] = self.below(256) as u8,
                1 if at < bytes.len() => bytes[at] ^= 1 << self.below(8),
                2 => drop(bytes.drain(at..end)),
                3 => {
                    let copy = bytes[at..end].to_vec();
                    let to = self.below(bytes.len());
                    bytes.splice(to..to, copy);
                }
                4 => bytes.truncate(at.max(1)),
                5 => bytes[at..end].reverse(),
                _ => {
                    let snippet = self.pick(snippets);
                    bytes.splice(at..at, snippet.bytes());
                }
            }
        }
    }
}
