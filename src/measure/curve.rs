//! A profile as marks along it, with its crossings of lines and its extremes.

use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::profile::{Mark, Profile, Station, trace};

/// Distance of marks \[mm\]. Between two marks the curve is a cubic, off an arc of 3 mm radius by 6e-10 mm.
const STEP: f64 = 0.05;

/// Marks from left to right.
#[derive(Debug, Clone)]
pub(super) struct MarkedCurve {
    pub marks: Vec<Mark>,
}

/// A point on a curve \[mm\].
#[derive(Debug, Clone, Copy)]
pub(super) struct CurvePoint {
    pub x: f64,
    pub z: f64,
    /// Index of the mark before it.
    pub mark: usize,
}

impl MarkedCurve {
    pub fn new(profile: &Profile) -> Self {
        Self { marks: trace(profile, STEP) }
    }

    /// Returns the curve as it lies after its axes are put on `frame`.
    pub fn placed(&self, frame: &Station) -> Self {
        let placed = |mark: &Mark| Mark { station: mark.station.placed_by(frame), ..*mark };
        Self { marks: self.marks.iter().map(placed).collect() }
    }

    /// Returns the marks from `first` on.
    pub fn from(&self, first: usize) -> Self {
        Self { marks: self.marks.get(first..).unwrap_or_default().to_vec() }
    }

    /// Returns the marks up to `last`, with it.
    pub fn up_to(&self, last: usize) -> Self {
        Self { marks: self.marks.iter().take(last + 1).copied().collect() }
    }

    /// Returns the length that each mark stands for \[mm\]: half the way to its neighbours.
    pub fn lengths(&self) -> impl Iterator<Item = f64> {
        let s = |k: usize| self.marks[k].s;
        let last = self.marks.len().saturating_sub(1);
        (0..self.marks.len()).map(move |k| 0.5 * (s((k + 1).min(last)) - s(k.saturating_sub(1))))
    }

    /// Returns the range of x \[mm\]; empty for a curve without marks.
    pub fn extent(&self) -> Interval {
        Interval::around(self.marks.iter().map(|mark| mark.station.x))
    }

    /// Returns where a·x + b·z = `level`, from left to right along the curve.
    pub fn crossings(&self, [a, b]: [f64; 2], level: f64) -> Vec<CurvePoint> {
        let over = |[x, z]: [f64; 2]| a * x + b * z - level;
        let mut found = Vec::new();
        for (mark, pair) in self.marks.windows(2).enumerate() {
            let ends = [0, 1].map(|k| over([pair[k].station.x, pair[k].station.z]));
            if (ends[0] >= 0.0) == (ends[1] >= 0.0) {
                continue;
            }
            if let Some(share) = bracketed(|share| over(pair[0].between(&pair[1], share)), 0.0, 1.0) {
                let [x, z] = pair[0].between(&pair[1], share);
                found.push(CurvePoint { x, z, mark });
            }
        }
        found
    }

    /// Returns where the curve has this x.
    pub fn at_x(&self, x: f64) -> Vec<CurvePoint> {
        self.crossings([1.0, 0.0], x)
    }

    /// Returns where the curve has this height.
    pub fn at_z(&self, z: f64) -> Vec<CurvePoint> {
        self.crossings([0.0, 1.0], z)
    }

    /// Returns the highest place, or for `sign` = −1 the lowest; `None` without marks.
    pub fn highest(&self, sign: f64) -> Option<CurvePoint> {
        let height = |k: &usize| sign * self.marks[*k].station.z;
        let best = (0..self.marks.len()).max_by(|a, b| height(a).total_cmp(&height(b)))?;
        let at = |mark: usize, [x, z]: [f64; 2]| CurvePoint { x, z, mark };
        let own = &self.marks[best].station;
        let mut found = at(best, [own.x, own.z]);
        for k in best.saturating_sub(1)..=best {
            let Some(pair) = self.marks.get(k..k + 2) else { continue };
            let level = |share: f64| {
                // The step balances truncation and rounding of a central difference on a cubic.
                let h = 1e-4;
                pair[0].between(&pair[1], share + h)[1] - pair[0].between(&pair[1], share - h)[1]
            };
            if let Some(share) = bracketed(level, 0.0, 1.0) {
                let place = at(k, pair[0].between(&pair[1], share));
                if sign * place.z > sign * found.z {
                    found = place;
                }
            }
        }
        Some(found)
    }
}
