//! The instrument that measures a specimen.

/// The instrument that measures a specimen, and the damage of its surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Instrument {
    /// Distance of the points along the profile \[mm\]; each point is off its place by up to a fifth of it.
    /// Typical 0.05–1.
    pub spacing: f64,
    /// Standard deviation of the noise across the profile \[µm\]; typical 0–20. Points closer than 0.25 mm
    /// share part of it.
    pub noise: f64,
    /// Number of dents in the surface, 0.05–0.3 mm deep and 1–5 mm wide.
    pub pits: usize,
    /// Number of plane stretches of 4–12 mm.
    pub flats: usize,
    /// Seed of the wear, the noise and the places of pits and flats.
    pub seed: u64,
}

impl Instrument {
    /// Makes an instrument with points every `spacing` \[mm\] and `noise` \[µm\], without pits and flats.
    pub fn new(spacing: f64, noise: f64, seed: u64) -> Self {
        Self { spacing, noise, pits: 0, flats: 0, seed }
    }
}
