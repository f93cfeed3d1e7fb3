//! Bands: parts of a component in which each ξ has one interval of η.

use super::edges::EdgeFinder;
use super::end::End;
use super::grading::Grading;
use super::slice::{Slice, Slicer};
use super::stretch::{Stretch, StretchFit};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::{Lanes, MANY, lanes};
use crate::numerics::nan_max;
use crate::numerics::quadrature::smooth_integrals;
use crate::placement::Body;

/// Distance of two corners, as a share of the band's length, up to which they count as one.
pub(super) const ONE_CORNER: f64 = 1e-11;

/// Share of a slice up to which its ends on both sides of a line count as the same.
pub(super) const ONE_SIDE: f64 = 1e-9;

/// Width next to an end, as a share of that in the middle, up to which a band ends in a point there.
const NARROW: f64 = 1e-5;

/// How far an edge along the window is moved out, as a share of the band's length.
const OUTSIDE: f64 = 1e-3;

/// Rounding of s in units of the rounding of the coordinates.
const ROUNDINGS: f64 = 4.0;

/// Relative accuracy of the interpolated boundary from samples: a spline across the rail bends anew in every cell.
const SMOOTH: f64 = 1e-9;

/// A range of ξ over which a component has one interval of η, whose ends vary without a jump.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Band {
    /// Range of ξ \[mm\].
    pub(crate) xi: Interval,
    /// What bounds the band at either end of `xi`; `None` where the component continues in other bands.
    pub(crate) ends: [Option<End>; 2],
    /// Interval of η \[mm\] at either end of `xi`. It has no width at a tip, unless s is level along that end.
    pub(crate) sides: [Interval; 2],
    /// Number of the lane from which slices are found; `None` where a line has one slice.
    pub(super) lane: Option<usize>,
    /// Both ends of `xi`, and every ξ between them where a side may have a corner \[mm\], ascending.
    pub(crate) corners: Vec<f64>,
    /// The edges between the corners, as if there were no window in η; by ascending ξ.
    pub(super) stretches: Vec<Stretch>,
    /// Range of η of the window \[mm\].
    pub(super) window: Interval,
}

impl Band {
    /// Makes a band without corners and stretches; [`Self::fit`] finds the latter.
    pub(super) fn new(xi: Interval, ends: [Option<End>; 2], sides: [Interval; 2], window: Interval) -> Self {
        Self { xi, ends, sides, lane: None, corners: Vec::new(), stretches: Vec::new(), window }
    }

    /// Fits interpolants to the edges between the corners, of which those that are nearly one are made one.
    pub(super) fn fit(&mut self, slicer: &mut Slicer<'_>) {
        let length = self.xi.width();
        let apart = |corner: f64, other: f64| (corner - other).abs() > ONE_CORNER * length;
        let mut corners = vec![self.xi.low];
        for &corner in &self.corners {
            if apart(corner, corners[corners.len() - 1]) && apart(corner, self.xi.high) {
                corners.push(corner);
            }
        }
        corners.push(self.xi.high);
        // A band with a corner next to an end may be as wide there as anywhere.
        let mut width = |xi: f64| {
            let edges = slicer.edges(xi, self.lane);
            edges.map_or(0.0, |[low, high]| high - low)
        };
        let mut blunted = |end: f64| {
            let mut near = self.corners.iter().filter(|&&corner| corner != end && !apart(corner, end));
            near.any(|&corner| width(corner) > NARROW * width(self.xi.middle()))
        };
        let zero = [0, 1].map(|end| {
            let side = self.sides[end];
            let is_tip = self.ends[end] == Some(End::Tip) || self.window.surrounds(side.low);
            side.low == side.high && is_tip && !blunted(self.xi[end])
        });
        let blunt = |end: usize| self.ends[end] == Some(End::Tip) && self.sides[end].has_width();
        let root = [0, 1].map(|end| matches!(self.ends[end], None | Some(End::ProfileEnd)) || blunt(end));
        let noise = self.noise(slicer);
        let mut stretches = Vec::new();
        let many = slicer.is_over_raised() && self.lane.is_none();
        let mut finder = many.then(|| EdgeFinder::new(slicer.placement()));
        // ξ, the square of half the width and the middle of the last two slices that were found one by one.
        let mut known = [[f64::NAN; 3]; 2];
        // An edge along the window is moved out, so that it is cut off there to the last digit.
        let (window, out) = (self.window, OUTSIDE * length);
        let beyond = |[low, high]: [f64; 2]| {
            [
                if low == window.low { low - out } else { low },
                if high == window.high { high + out } else { high },
            ]
        };
        let edges = |xi: &Lanes| {
            let many = finder.as_mut().and_then(|finder| finder.edges(&slicer.raised(xi)));
            many.unwrap_or_else(|| {
                let one = |xi: f64| {
                    let near = slicer.edges_near(xi, self.lane, extrapolated(&known, xi));
                    let edges = near.or_else(|| slicer.edges(xi, self.lane));
                    let [low, high] = edges.unwrap_or_else(|| [slicer.valley(self.lane, xi); 2]);
                    known = [known[1], halved(xi, [low, high])];
                    beyond([low, high])
                };
                let both = xi.map(one);
                [both.map(|edges| edges[0]), both.map(|edges| edges[1])]
            })
        };
        let mut fit = StretchFit { edges, band: self.xi, zero, root, noise };
        for pair in corners.windows(2) {
            fit.add(Interval::new(pair[0], pair[1]), &mut stretches);
        }
        self.stretches = stretches;
        self.corners = corners;
    }

    /// Returns the least and the largest rounding of the square of half the width \[mm²\] that may be expected: the rounding of s times the
    /// square over the depth, both in the middle of the band. s has at least the rounding of ξ and ζ, and off the segments through C up to
    /// that of the profiles' own coordinates. Of samples both are a share of that square.
    fn noise(&self, slicer: &mut Slicer<'_>) -> [f64; 2] {
        let bodies = [slicer.placement().rail(), slicer.placement().wheel()];
        let rail = &bodies[0].section;
        // Over the rail's surface the arc length stands for both coordinates.
        let height = |xi: f64| if slicer.is_over_rail() { xi.abs() } else { rail.height(xi).abs() };
        let through_c =
            |body: &Body| self.xi.ends().iter().all(|xi| body.section.on_contact_segment(*xi, 0.0));
        let off = bodies.into_iter().filter(|body| !through_c(body));
        let own = off.map(|body| body.profile().extent()).fold(0.0, f64::max);
        let size = self.xi.map(|xi| height(xi) + xi.abs());
        let middle = self.xi.middle();
        let depth = slicer.depth_over(self.lane, middle).abs();
        let square: f64 =
            slicer.edges(middle, self.lane).map_or(0.0, |[low, high]| ((high - low) / 2.0).powi(2));
        if slicer.by_samples.is_some() {
            return [SMOOTH * square; 2];
        }
        let size = nan_max(size.low, size.high);
        [size, size + own].map(|size| ROUNDINGS * f64::EPSILON * square * (1.0 + size / depth))
    }

    fn stretch(&self, xi: f64) -> Option<&Stretch> {
        let k = self.stretches.partition_point(|stretch| stretch.xi.high < xi);
        self.stretches.get(k.min(self.stretches.len().saturating_sub(1)))
    }

    /// Returns the slice at ξ, which must lie within `xi`.
    pub(crate) fn slice(&self, xi: f64) -> Slice {
        if let Some(end) = (0..2).find(|&end| xi == self.xi[end]) {
            return Slice { eta: self.sides[end] };
        }
        let [[low], [high]] = self.stretch(xi).map_or([[f64::NAN]; 2], |stretch| stretch.edges(&[xi]));
        Slice { eta: self.clipped(Interval::new(low, high)) }
    }

    /// Returns \[ξ, lower η, upper η\] \[mm\] at ascending ξ within `xi`.
    pub(crate) fn rows(&self, xi: &[f64]) -> Vec<[f64; 3]> {
        let mut rows = Vec::with_capacity(xi.len());
        while let Some(&first) = xi.get(rows.len()) {
            let rest = &xi[rows.len()..];
            let last = self.stretch(first).map_or(first, |stretch| stretch.xi.high);
            let count = rest.iter().take(MANY).take_while(|xi| **xi <= last).count().max(1);
            let own: Lanes = lanes(|k| rest[k.min(count - 1)]);
            let found =
                self.stretch(first).map(|stretch| pulp::Arch::new().dispatch(EdgesAt { stretch, xi: &own }));
            let [low, high] = found.unwrap_or([[f64::NAN; MANY]; 2]);
            rows.extend((0..count).map(|k| {
                let end = (0..2).find(|&end| own[k] == self.xi[end]);
                let found = || self.clipped(Interval::new(low[k], high[k]));
                let eta = end.map_or_else(found, |end| self.sides[end]);
                [own[k], eta.low, eta.high]
            }));
        }
        rows
    }

    /// Cuts a slice off at the window.
    fn clipped(&self, eta: Interval) -> Interval {
        let Interval { low, high } = self.window;
        Interval::new(eta.low.max(low).min(high), eta.high.min(high).max(low))
    }

    /// Returns dη/dξ of one side at ξ, which is infinite at a tip and 0 along the window.
    pub(super) fn slope(&self, branch: usize, xi: f64) -> f64 {
        let Some(stretch) = self.stretch(xi) else { return f64::NAN };
        let [[[low], [high]], slopes] = stretch.edges_and_slopes(&[xi]);
        if self.clipped(Interval::new(low, high))[branch] == [low, high][branch] {
            slopes[branch][0]
        } else {
            0.0
        }
    }

    /// Returns ∫ f dξ over a range within `xi` for several functions of ξ and the edges, which are given at 16 places at once, together
    /// with their slopes if `with_slopes`. Each integral has its own relative accuracy.
    pub(crate) fn integrals<const N: usize>(
        &self,
        xi: Interval,
        with_slopes: bool,
        f: impl Fn(&BandPlaces) -> [Lanes; N],
        relative: [f64; N],
    ) -> [f64; N] {
        let grading = self.grading();
        let ends = self.stretches.iter().map(|stretch| stretch.xi.high).chain(self.corners.iter().copied());
        let mut cuts: Vec<f64> = ends.filter(|cut| xi.surrounds(*cut)).chain([xi.high]).collect();
        cuts.sort_by(f64::total_cmp);
        // The ends of the parameter are exactly 0 and 1, in spite of rounding.
        let parameter = |xi: f64| match self.xi.ends().iter().position(|end| *end == xi) {
            Some(end) => end as f64,
            None => grading.parameter(xi),
        };
        let (mut sums, mut begin) = ([0.0; N], (xi.low, parameter(xi.low)));
        for cut in cuts {
            let end = (cut, parameter(cut));
            let Some(stretch) = self.stretch(cut).filter(|_| begin.0 < cut) else { continue };
            let mut weighted = |t: &[f64]| {
                let at = PlacesAt {
                    stretch,
                    grading: &grading,
                    with_slopes,
                    t: &lanes(|k| t[k.min(t.len() - 1)]),
                };
                let places = pulp::Arch::new().dispatch(at).clipped(self.window);
                f(&places).map(|values| lanes(|k| values[k] * places.rate[k]))
            };
            let part = smooth_integrals(&mut weighted, Interval::new(begin.1, end.1), relative, false);
            sums.iter_mut().zip(part).for_each(|(sum, part)| *sum += part);
            begin = end;
        }
        sums
    }

    /// Returns ξ as a function of t in \[0, 1\] in which the width of the band is smooth except at corners. An end at a
    /// window is not round.
    pub(crate) fn grading(&self) -> Grading {
        Grading { xi: self.xi, round: self.ends.map(|end| end != Some(End::Window)) }
    }

    /// Returns the ranges of t between neighbouring corners.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = Interval> {
        let (grading, last) = (self.grading(), self.corners.len().saturating_sub(1));
        // The ends are exactly 0 and 1, in spite of rounding.
        let parameter = move |k: usize| match k {
            0 => 0.0,
            k if k == last => 1.0,
            k => grading.parameter(self.corners[k]),
        };
        (1..self.corners.len()).map(move |k| Interval::new(parameter(k - 1), parameter(k)))
    }

    /// Returns whether the component continues in `next`: this band ends where `next` begins, and their slices overlap
    /// there.
    pub(crate) fn meets(&self, next: &Self) -> bool {
        self.xi.high == next.xi.low && self.sides[1].overlaps(next.sides[0])
    }
}

/// 16 places of a band.
#[derive(Debug, Clone, Copy)]
pub(crate) struct BandPlaces {
    /// ξ \[mm\].
    pub(crate) xi: Lanes,
    /// dξ/dt of the grading \[mm\].
    rate: Lanes,
    /// Lower and upper η \[mm\].
    pub(crate) edges: [Lanes; 2],
    /// dη/dξ of both, if asked for.
    pub(super) slopes: [Lanes; 2],
}

impl BandPlaces {
    /// Cuts the edges off at the window, along which their slopes are 0.
    fn clipped(mut self, window: Interval) -> Self {
        for branch in 0..2 {
            for (eta, slope) in self.edges[branch].iter_mut().zip(&mut self.slopes[branch]) {
                if !window.contains(*eta) {
                    (*eta, *slope) = (eta.max(window.low).min(window.high), 0.0);
                }
            }
        }
        self
    }
}

/// The places of a stretch at 16 values of t.
struct PlacesAt<'b> {
    stretch: &'b Stretch,
    grading: &'b Grading,
    with_slopes: bool,
    t: &'b Lanes,
}

impl pulp::WithSimd for PlacesAt<'_> {
    type Output = BandPlaces;

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> BandPlaces {
        let Self { stretch, grading, with_slopes, t } = self;
        let [xi, rate] = grading.xi_and_rate(t);
        let [edges, slopes] =
            if with_slopes { stretch.edges_and_slopes(&xi) } else { [stretch.edges(&xi), [[0.0; MANY]; 2]] };
        BandPlaces { xi, rate, edges, slopes }
    }
}

/// The edges of a stretch at 16 values of ξ.
struct EdgesAt<'b> {
    stretch: &'b Stretch,
    xi: &'b Lanes,
}

impl pulp::WithSimd for EdgesAt<'_> {
    type Output = [Lanes; 2];

    #[inline(always)]
    fn with_simd<S: pulp::Simd>(self, _: S) -> [Lanes; 2] {
        self.stretch.edges(self.xi)
    }
}

/// Returns ξ, the square of half the width and the middle of a slice: what varies smoothly up to a tip.
pub(super) fn halved(xi: f64, [low, high]: [f64; 2]) -> [f64; 3] {
    let half = (high - low) / 2.0;
    [xi, half * half, low + half]
}

/// Returns the edges \[mm\] at ξ on the straight line through two slices, each as [`halved`] returns it; NaN if these are NaN.
pub(super) fn extrapolated(&[[x, square, middle], [y, other, last]]: &[[f64; 3]; 2], xi: f64) -> [f64; 2] {
    let share = (xi - y) / (y - x);
    let half = (other + (other - square) * share).sqrt();
    let middle = last + (last - middle) * share;
    [middle - half, middle + half]
}
