//! Parts of a lofted body with their control points, and lower bounds of the gap over them.

use super::above::SweptAbove;
use crate::lofted::{Bay, Loft, directions, on_wheel};
use crate::numerics::interval::Interval;
use crate::profile::Side;
use crate::search::bounds::Bounds;

/// Largest change of x or z \[mm\], across and along, over a part from which Newton's method starts.
const SMALL_ACROSS: f64 = 0.1;

/// Largest length \[mm\], along the track or around the wheel, of a part from which Newton's method starts: a wheel rises by 0.3 µm over
/// it.
const SMALL_ALONG: f64 = 1.0;

/// Ratio of length to size above which a part of several cells is halved along the track.
const LONG: f64 = 8.0;

/// Length \[mm\] along the track above which a part is bounded from the nearest point to the wheel's lowest meridian, not from its
/// middle: where the rise over the part counts for more than its slope.
const FAR: f64 = 10.0;

/// Least cosine between a plane's normal and the vertical at which the plane bounds a vertical gap.
const STEEPEST: f64 = 0.03;

/// Rounding of the rise of a part \[mm\].
const LEVEL: f64 = 1e-12;

/// Part of the varying body: over some cells between two slices, and over an interval of y.
#[derive(Debug, Clone, Copy)]
pub(super) struct VaryingPart {
    /// Index of the strip.
    pub strip: usize,
    /// Index of the bay between two slices.
    pub bay: usize,
    /// Node of the bay's tree.
    pub node: usize,
    /// Shares of the cell across; \[0, 1\] of a node with several cells.
    pub shares: Interval,
    /// Interval of y in the list's coordinate \[mm\].
    pub y: Interval,
}

/// A part with what bounds it, in the swept body's axes.
#[derive(Debug, Clone, Copy)]
pub(super) struct BoundPart {
    pub part: VaryingPart,
    /// Points whose hull holds the part: control points, or corners of a box.
    points: [[f64; 3]; 16],
    /// Number of these points.
    count: usize,
    /// Reach of the abscissa at which vertical lines through the part meet the level of the swept profile \[mm\].
    abscissa: Interval,
    /// Reach of y \[mm\].
    along: Interval,
    /// Larger extent of x or z \[mm\].
    pub size: f64,
    /// Change of x or z across and along, as multiples of the largest of a small part; of several cells, size and length over [`LONG`].
    changes: [f64; 2],
    /// Of a wheel's part: how it is wrapped around the axle.
    wrap: Option<Wrap>,
    /// Whether Newton's method has started from it.
    pub settled: bool,
}

/// A part of a wheel on the tangent plane at its middle, with bounds of the error of that.
#[derive(Debug, Clone, Copy)]
struct Wrap {
    /// Direction out from the axle, in the swept body's axes.
    out: [f64; 3],
    /// Larger extent of x or of the distance from the axle \[mm\].
    size: f64,
    /// Largest error along the plane, around the axle \[mm\].
    around: f64,
    /// Largest distance of the surface from the plane, towards the axle \[mm\].
    inward: f64,
    /// Largest errors of the differences of the part's control points \[mm\]: across, along.
    turns: [f64; 2],
}

impl VaryingPart {
    pub fn bay<'a>(&self, loft: &'a Loft) -> Bay<'a> {
        loft.strips[self.strip].bay(self.bay)
    }

    /// Gives the cell of a part of one cell; `None` for a part of several.
    pub fn cell(&self, loft: &Loft) -> Option<usize> {
        self.bay(loft).only_cell(self.node)
    }

    /// Gives the parameters (u, y) of its middle.
    pub fn middle(&self, loft: &Loft) -> [f64; 2] {
        let u = match self.cell(loft) {
            Some(cell) => cell as f64 + self.shares.middle(),
            None => {
                let cells = self.bay(loft).cells(self.node);
                0.5 * (cells.start + cells.end) as f64
            }
        };
        [u, self.y.middle()]
    }

    /// Makes its bounds under a swept body; the middle of the axle is over `along` \[mm\] of the surface.
    pub fn bound(self, loft: &Loft, over: &SweptAbove<'_>, along: f64) -> BoundPart {
        let bay = self.bay(loft);
        let (mut points, mut count) = ([[0.0; 3]; 16], 8);
        if let Some(cell) = self.cell(loft) {
            let control = bay.cell(cell).control(self.shares, self.y);
            points.iter_mut().zip(control.iter().flatten()).for_each(|(own, at)| *own = *at);
            count = 16;
        } else {
            let [x, z] = bay.bounds(self.node).map(Interval::ends);
            let y = self.y.ends();
            for (k, point) in points.iter_mut().take(count).enumerate() {
                *point = [x[k & 1], y[k >> 1 & 1], z[k >> 2]];
            }
        }
        let wrap = match over.varying {
            Side::Rail => {
                points.iter_mut().for_each(|point| point[1] -= along);
                None
            }
            Side::Wheel => {
                let off = loft.strips[self.strip].off();
                Some(self.wrap(&mut points[..count], over, along).wider(off))
            }
        };
        let mut reach = [Interval::NONE; 4];
        for point in points.iter_mut().take(count) {
            *point = over.seen(*point);
            let [x, y, z] = *point;
            let reached = [x, y, z, x - over.up[0] / over.up[2] * z];
            reach.iter_mut().zip(reached).for_each(|(reach, at)| *reach = reach.with(at));
        }
        let [x, along, z, abscissa] = reach;
        let size = match wrap {
            // The corners around a long part of a wheel stand high because of its length.
            Some(wrap) if count == 8 => wrap.size,
            _ => x.width().max(z.width()),
        };
        let inward = wrap.map_or(0.0, |wrap| wrap.inward + wrap.around);
        let length = self.y.width();
        let change = |step: usize, other: usize| {
            let lines = (0..4).flat_map(|line| (1..4).map(move |k| (other * line, other * line + k * step)));
            let far = |(a, b): (usize, usize)| {
                (points[b][0] - points[a][0]).abs().max((points[b][2] - points[a][2]).abs())
            };
            lines.map(far).fold(0.0, f64::max) / SMALL_ACROSS
        };
        let changes = if count == 16 {
            [change(4, 1), change(1, 4).max(length / SMALL_ALONG)]
        } else {
            [size, length / LONG]
        };
        BoundPart {
            part: self,
            points,
            count,
            abscissa: abscissa.grown(inward),
            along,
            size,
            changes,
            wrap,
            settled: false,
        }
    }

    /// Wraps the points of a part around a wheel, onto the tangent plane at the middle of the part.
    ///
    /// Method: at the angle d from there a point of the distance ϱ from the axle is ϱ (1 − cos d) within the plane through it, and off
    /// by |ϱ sin d − ϱ_m d| along it. Corners of a box stand around the whole sector.
    fn wrap(&self, points: &mut [[f64; 3]], over: &SweptAbove<'_>, along: f64) -> Wrap {
        let radius = over.attitude.radius;
        let (middle, half) = (self.y.middle(), 0.5 * self.y.width() / radius);
        let angle = (middle - along) / radius;
        let [x, h] = [0, 2].map(|axis| Interval::around(points.iter().map(|point| point[axis])));
        let (farthest, between) = (radius + h.high, 0.5 * h.width());
        let [out, _] = directions(angle);
        let mut wrap = Wrap {
            out: over.turned(out),
            size: x.width().max(h.width()),
            around: 0.0,
            inward: 0.0,
            turns: [0.0; 2],
        };
        if points.len() == 16 {
            let largest = |step: usize, other: usize| {
                let pairs = (0..4).flat_map(|line| (0..3).map(move |k| other * line + step * k));
                pairs.map(|at| (points[at + step][2] - points[at][2]).abs()).fold(0.0, f64::max)
            };
            let third = self.y.width() / 3.0;
            wrap.around = half * (between + farthest * half * half / 6.0);
            wrap.inward = 0.5 * farthest * half * half;
            wrap.turns = [
                half * largest(4, 1),
                half * (largest(1, 4) + third * farthest / radius) + third * between / radius,
            ];
            let mean = radius + h.low + between;
            for point in points.iter_mut() {
                *point = on_wheel(radius, angle, [point[0], point[2], mean * (point[1] - middle) / radius]);
            }
        } else {
            let (sin, cos) = half.sin_cos();
            for point in points.iter_mut() {
                let inner = (radius + h.low) * cos - radius;
                let height = if point[2] == h.high { h.high } else { inner };
                *point =
                    on_wheel(radius, angle, [point[0], height, (farthest * sin).copysign(point[1] - middle)]);
            }
        }
        wrap
    }
}

impl Wrap {
    /// Widens the bounds for a surface that may be off the part's bicubic by this much \[mm\]: slopes over a cell are off by at most 3.1
    /// times that, and control points differ by a third of the slopes.
    fn wider(self, off: f64) -> Self {
        Self { around: self.around + off, turns: self.turns.map(|by| by + 2.0 * off), ..self }
    }
}

impl BoundPart {
    /// Tells whether Newton's method may start from the part: it lies in one cell, and is small in both directions.
    pub fn is_small(&self) -> bool {
        self.count == 16 && self.changes.iter().all(|change| *change <= 1.0)
    }

    /// Halves the part where it changes most.
    pub fn halves(&self, loft: &Loft) -> [VaryingPart; 2] {
        let VaryingPart { y, shares, node, .. } = self.part;
        if self.changes[1] > self.changes[0] {
            return y.halves().map(|y| VaryingPart { y, ..self.part });
        }
        if self.part.cell(loft).is_none() {
            return [0, 1].map(|k| VaryingPart { node: 2 * node + k, ..self.part });
        }
        shares.halves().map(|shares| VaryingPart { shares, ..self.part })
    }

    /// Tells whether the gap over the part may be least there or level: whether the surfaces of both bodies may be parallel across and
    /// along the track. Where they cannot, the gap is least at the part's edge, which counts at an end of the strip only.
    pub fn may_be_level(&self, loft: &Loft, over: &SweptAbove<'_>, of: &Bounds) -> bool {
        let Some(cell) = self.part.cell(loft) else { return true };
        let (least, most) = (over.radius - of.z.high, over.radius - of.z.low);
        let farthest = self.along.magnitude();
        if farthest >= least {
            return true;
        }
        let down = ((least - farthest) * (least + farthest)).sqrt();
        let across = of.tangent * Interval::new(1.0, if least == f64::INFINITY { 1.0 } else { least / down });
        let along = self.along * Interval::new(most.recip(), down.recip());
        let strip = &loft.strips[self.part.strip];
        let (VaryingPart { shares, y, .. }, reach) = (self.part, strip.reach());
        let ends = [
            [cell == 0 && shares.low == 0.0, cell + 1 == strip.cells() && shares.high == 1.0],
            [y.low == reach.low, y.high == reach.high],
        ];
        let steepest = [across, along].map(Interval::magnitude);
        let off =
            self.wrap.map_or([0.0; 2], |wrap| wrap.turns.map(|by| by * (1.0 + steepest[0] + steepest[1])));
        [(4, 1), (1, 4)].into_iter().zip(ends).zip(off).all(|(((step, other), [at_first, at_last]), off)| {
            let mut rise = Interval::NONE;
            for (line, k) in (0..4).flat_map(|line| (0..3).map(move |k| (line, k))) {
                let at = other * line + step * k;
                let v = [0, 1, 2].map(|axis| self.points[at + step][axis] - self.points[at][axis]);
                rise = rise.hull(across * Interval::of(v[0]) + along * Interval::of(v[1]) + -v[2]);
            }
            (rise.low <= LEVEL + off || at_first) && (rise.high >= -LEVEL - off || at_last)
        })
    }

    /// Returns a lower bound of the vertical gap between the part and what is swept of a part of the other profile \[mm\]; infinite
    /// where no vertical line meets both.
    ///
    /// Method: a plane that touches the swept part from below, along its chord and, of a wheel, at the angle of the rail's part about the
    /// axle. The varying body's part is below the highest plane parallel to it through its control points.
    pub fn gap_below(&self, over: &SweptAbove<'_>, of: &Bounds) -> f64 {
        let radius = over.radius;
        let tilt = over.up[0] / over.up[2];
        let farthest = self.along.magnitude();
        // The profile's part is carried up where the ring rises.
        let least = radius - of.z.high;
        let rise = if tilt == 0.0 {
            0.0
        } else if farthest < least {
            farthest * farthest / (least + (least * least - farthest * farthest).sqrt())
        } else {
            least.max(0.0)
        };
        let shift = Interval::between(tilt * of.z.low, tilt * (of.z.high + rise));
        if !(of.x + -shift).meets(self.abscissa) {
            return f64::INFINITY;
        }
        let along = self.along;
        let y = if along.width() > FAR { 0f64.clamp(along.low, along.high) } else { along.middle() };
        let sine = (y / (radius - of.z.low)).clamp(-1.0, 1.0);
        let cosine = ((1.0 - sine) * (1.0 + sine)).sqrt();
        let [cos, sin] = of.chord;
        // The part of a wheel has to face the plane.
        let outward = |normal: [f64; 3]| {
            self.wrap.map_or(1.0, |wrap| (0..3).map(|k| normal[k] * wrap.out[k]).sum::<f64>())
        };
        let steep =
            cos * cosine * over.up[2] - sin * over.up[0] < STEEPEST || outward([-sin, 0.0, cos]) < 0.0;
        let (cos, sin, level) = if steep { (1.0, 0.0, of.z.low) } else { (cos, sin, of.level) };
        let normal = [-sin, -cos * sine, cos * cosine];
        let rate: f64 = (0..3).map(|k| normal[k] * over.up[k]).sum();
        if rate < STEEPEST || outward(normal) < 0.0 {
            return f64::NEG_INFINITY;
        }
        // Free of the radius where the plane is level: R (cos cosine − cos).
        let lift = if sine == 0.0 { 0.0 } else { radius * cos * sine * sine / (1.0 + cosine) };
        let highest = self.points[..self.count]
            .iter()
            .map(|p| normal[0] * p[0] + normal[1] * p[1] + normal[2] * p[2])
            .fold(f64::NEG_INFINITY, f64::max);
        (level - lift - highest - self.wrap.map_or(0.0, |wrap| wrap.around)) / rate
    }
}
