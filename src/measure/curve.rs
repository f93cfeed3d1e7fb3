//! A profile as marks along it, with its crossings of lines and its extremes.

use std::sync::Arc;

use super::smooth::NoisyPoints;
use crate::measured::noise::Deviates;
use crate::numerics::interval::Interval;
use crate::numerics::roots::bracketed;
use crate::profile::{Mark, Profile, Station, trace};

/// Distance of marks \[mm\]. Between two marks the curve is a cubic, off an arc of 3 mm radius by 6e-10 mm.
const STEP: f64 = 0.05;

/// Angle \[rad\] by which a curve may turn where it begins not to be measured: a tread or crown worn over a part of its width rises at
/// the part's end by as much.
const TURNS: f64 = 0.1;

/// Marks from left to right.
#[derive(Debug, Clone)]
pub(super) struct MarkedCurve {
    pub marks: Vec<Mark>,
    /// Whether the way from each mark to the next was not measured.
    pub unknown: Vec<bool>,
    /// The points with their noise.
    points: Arc<NoisyPoints>,
}

/// A point on a curve \[mm\].
#[derive(Debug, Clone, Copy)]
pub(super) struct CurvePoint {
    pub x: f64,
    pub z: f64,
    /// Index of the mark before it.
    pub mark: usize,
    /// Whether it lies where nothing was measured.
    unknown: bool,
}

impl CurvePoint {
    /// Returns the point, or why it has no value: it lies in a gap.
    pub fn known(self) -> Result<Self, String> {
        let Self { x, z, unknown, .. } = self;
        if unknown { Err(format!("a gap of the points at ({x:.1}, {z:.1}) mm")) } else { Ok(self) }
    }
}

impl MarkedCurve {
    /// Takes the curve of a profile; where its points are noisy, the smoothed one.
    pub fn new(profile: &Profile) -> Self {
        let points = NoisyPoints::new(profile);
        match points.smoothed() {
            Some((marks, unknown)) => Self { marks, unknown, points: Arc::new(points) },
            None => Self::drawn(profile, STEP),
        }
    }

    /// Takes a curve as it is drawn, with marks at most `step` \[mm\] apart.
    pub fn drawn(profile: &Profile, step: f64) -> Self {
        let marks = trace(profile, step);
        // Two marks stand at a joint: so its place is beside the gap, too.
        let gap = |pair: &[Mark]| pair.iter().any(|mark| profile.segments()[mark.segment].is_gap());
        let unknown = marks.windows(2).map(gap).chain([false]).take(marks.len()).collect();
        Self { marks, unknown, points: Arc::default() }
    }

    /// Returns the curve as it may be measured once more, in the axes of its points; `None` for points without noise.
    pub fn again(&self, deviates: &mut Deviates) -> Option<Self> {
        Some(self.of_points(self.points.again(deviates)?))
    }

    /// Returns the curve as its points are smoothed half as far, or joined by chords, in their axes; `None` for a drawing.
    pub fn less_smoothed(&self) -> Option<Self> {
        Some(self.of_points(self.points.less_smoothed()?))
    }

    fn of_points(&self, (marks, unknown): (Vec<Mark>, Vec<bool>)) -> Self {
        Self { marks, unknown, points: Arc::clone(&self.points) }
    }

    /// Returns the curve as it lies after its axes are put on `frame`.
    pub fn placed(&self, frame: &Station) -> Self {
        let placed = |mark: &Mark| Mark { station: mark.station.placed_by(frame), ..*mark };
        let marks = self.marks.iter().map(placed).collect();
        Self { marks, unknown: self.unknown.clone(), points: Arc::clone(&self.points) }
    }

    /// Returns the part with these marks.
    fn part(&self, range: std::ops::Range<usize>) -> Self {
        let range = range.start.min(self.marks.len())..range.end.min(self.marks.len());
        let (marks, unknown) = (self.marks[range.clone()].to_vec(), self.unknown[range].to_vec());
        Self { marks, unknown, points: Arc::clone(&self.points) }
    }

    /// Returns the marks from `first` on.
    pub fn from(&self, first: usize) -> Self {
        self.part(first..self.marks.len())
    }

    /// Returns the marks up to `last`, with it.
    pub fn up_to(&self, last: usize) -> Self {
        self.part(0..last.saturating_add(1))
    }

    /// Returns the part about a mark over which a·x + b·z lies in a range, with marks where it ends: a fit over whole marks alone would
    /// jump wherever one of them comes in.
    pub fn within(&self, [a, b]: [f64; 2], range: Interval, about: usize) -> Self {
        let over = |[x, z]: [f64; 2]| a * x + b * z;
        let inside = |k: usize| range.contains(over([self.marks[k].station.x, self.marks[k].station.z]));
        let end = |k: usize| {
            let (near, far) = (self.marks.get(k)?, self.marks.get(k + 1)?);
            let level = |level: f64| bracketed(|share| over(near.between(far, share)) - level, 0.0, 1.0);
            let share = level(range.low).or_else(|| level(range.high))?;
            let [x, z] = near.between(far, share);
            let station = Station { x, z, ..if share < 0.5 { near.station } else { far.station } };
            Some(Mark { s: near.s + share * (far.s - near.s), station, ..*near })
        };
        let first = (0..about).rfind(|k| !inside(*k));
        let last = (about..self.marks.len()).find(|k| !inside(*k)).unwrap_or(self.marks.len());
        let mut own = self.part(first.map_or(0, |k| k + 1)..last);
        if let Some((k, mark)) = first.and_then(|k| Some((k, end(k)?))) {
            own.marks.insert(0, mark);
            own.unknown.insert(0, self.unknown[k]);
        }
        own.marks.extend(last.checked_sub(1).and_then(end));
        own.unknown.resize(own.marks.len(), false);
        own
    }

    /// Returns the curve with marks at least `apart` \[mm\] from each other, without those in a gap.
    pub fn thinned(&self, apart: f64) -> Self {
        let mut own = self.part(0..0);
        for (k, mark) in self.marks.iter().enumerate() {
            let inside = self.unknown[k] && k.checked_sub(1).is_some_and(|before| self.unknown[before]);
            if !inside && own.marks.last().is_none_or(|last| mark.s - last.s >= apart) {
                own.marks.push(*mark);
                own.unknown.push(false);
            }
            if let Some(unknown) = own.unknown.last_mut() {
                *unknown |= self.unknown[k];
            }
        }
        own
    }

    /// Tells whether something between two heights or abscissas was not measured: a·x + b·z of the gap's ends meets the range.
    pub fn has_gap(&self, [a, b]: [f64; 2], range: Interval) -> bool {
        let over = |k: usize| a * self.marks[k].station.x + b * self.marks[k].station.z;
        let gap = |k: &usize| self.unknown[*k] && *k + 1 < self.marks.len();
        (0..self.marks.len()).filter(gap).any(|k| {
            let own = Interval::around([over(k), over(k + 1)]);
            own.high > range.low && own.low < range.high
        })
    }

    /// Returns the length that each mark stands for \[mm\]: half the way to its neighbours, but nothing of a gap.
    pub fn lengths(&self) -> impl Iterator<Item = f64> {
        let step = |k: usize| match self.marks.get(k..k + 2) {
            Some([a, b]) if !self.unknown[k] => b.s - a.s,
            _ => 0.0,
        };
        (0..self.marks.len()).map(move |k| 0.5 * (step(k) + k.checked_sub(1).map_or(0.0, step)))
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
                found.push(CurvePoint { x, z, mark, unknown: self.unknown[mark] });
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
        let own = &self.marks[best].station;
        // Beside a gap the highest place may lie in it, whatever the curve does next to it.
        let unknown = [best.checked_sub(1), Some(best)].into_iter().flatten().any(|k| self.unknown[k]);
        let at = |mark: usize, [x, z]: [f64; 2]| CurvePoint { x, z, mark, unknown };
        let mut found = at(best, [own.x, own.z]);
        // Two marks stand at a joint.
        for k in best.saturating_sub(2)..=best + 1 {
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
        found.unknown |= (0..self.marks.len()).any(|k| self.unknown[k] && self.may_reach(k, sign, found.z));
        Some(found)
    }

    /// Tells whether the way from a mark to the next one, which was not measured, may be higher than `z` \[mm\], or for `sign` = −1 lower:
    /// the tangents at its two ends meet there, if they may turn by [`TURNS`].
    fn may_reach(&self, k: usize, sign: f64, z: f64) -> bool {
        let Some([a, b]) = self.marks.get(k..k + 2).map(|pair| [pair[0].station, pair[1].station]) else {
            return false;
        };
        let along = |of: &Station, turn: f64| {
            let (sin, cos) = (sign * turn).sin_cos();
            [of.cos * cos - of.sin * sin, of.sin * cos + of.cos * sin]
        };
        let [u, v] = [along(&a, TURNS), along(&b, -TURNS)];
        if sign * u[1] <= 0.0 || sign * v[1] >= 0.0 {
            return false;
        }
        let across = u[0] * v[1] - u[1] * v[0];
        let share = ((b.x - a.x) * v[1] - (b.z - a.z) * v[0]) / across;
        sign * (a.z + share * u[1] - z) > 0.0
    }
}
