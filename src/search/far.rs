//! Rolls far from zero, which are tried where Newton's method finds no roll.

/// Largest roll that is tried \[rad\]: one wheel is then 150 mm higher than the other, far above a flange on top of its rail.
pub(super) const LARGEST_ROLL: f64 = 0.1;

/// Rolls \[rad\] at which a change of sign is looked for if Newton's method finds no roll: with a lift of 28
/// mm over 1.5 m a flange is on top of its rail; wider gauges and higher flanges need more.
const FAR: [f64; 3] = [0.025, 0.05, LARGEST_ROLL];

/// Far rolls of both signs. The first ones have the sign that raises the wheel which touches first, given the
/// difference of the heights at which the right and the left side touch.
pub(super) struct Far {
    first: f64,
    tried: usize,
}

impl Far {
    pub fn new(difference: f64) -> Self {
        Self { first: -difference.signum(), tried: 0 }
    }
}

impl Iterator for Far {
    type Item = f64;

    fn next(&mut self) -> Option<f64> {
        let sign = if self.tried < FAR.len() { self.first } else { -self.first };
        let roll = (self.tried < 2 * FAR.len()).then(|| sign * FAR[self.tried % FAR.len()]);
        self.tried += 1;
        roll
    }
}
