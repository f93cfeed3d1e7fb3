//! The branches over which N columns lie: one branch for all, or a cubic for each.

use super::branch::{Branch, BranchShape};
use super::points::{self, BranchPoints};
use crate::numerics::lanes::Lanes;

/// The branches of N columns.
#[derive(Debug)]
pub enum Branches<'a, const N: usize> {
    /// One branch is common to all columns.
    One(&'a Branch),
    /// Each column has a cubic branch of its own, as over a spline.
    Cubics(Box<Cubics<N>>),
}

/// N polynomial branches of at most the third degree.
#[derive(Debug)]
pub struct Cubics<const N: usize> {
    xi: [Lanes<N>; CUBIC],
    zeta: [Lanes<N>; CUBIC],
    t: [Lanes<N>; 2],
    ends: [Lanes<N>; 2],
}

/// Number of coefficients of a cubic.
const CUBIC: usize = 4;

impl<const N: usize> Cubics<N> {
    const NONE: Self =
        Self { xi: [[0.0; N]; CUBIC], zeta: [[0.0; N]; CUBIC], t: [[0.0; N]; 2], ends: [[0.0; N]; 2] };
}

impl<'a, const N: usize> Branches<'a, N> {
    /// Collects the branches of N columns. Returns `None` unless all branches are the same one, or all are cubics.
    ///
    /// `others` are branches that are no longer needed; their memory is used again. Allocating it anew took a tenth of the
    /// time of a grid over splines.
    pub fn of(branches: [&'a Branch; N], others: Option<Self>) -> Option<Self> {
        if branches.iter().all(|branch| std::ptr::eq(*branch, branches[0])) {
            return Some(Self::One(branches[0]));
        }
        let mut all = match others {
            Some(Self::Cubics(others)) => others,
            _ => Box::new(Cubics::NONE),
        };
        for (k, branch) in branches.into_iter().enumerate() {
            let BranchShape::Polynomial(p) = &branch.shape else { return None };
            let p = p.curve();
            if p.xi.len().max(p.zeta.len()) > CUBIC {
                return None;
            }
            for (rows, c) in [(&mut all.xi, &p.xi), (&mut all.zeta, &p.zeta)] {
                for (power, row) in rows.iter_mut().enumerate() {
                    row[k] = c.get(power).copied().unwrap_or(0.0);
                }
            }
            for end in 0..2 {
                (all.t[end][k], all.ends[end][k]) = (p.t[end], p.ends[end]);
            }
        }
        Some(Self::Cubics(all))
    }

    /// Finds the points at N abscissae and their ζ \[mm\]. Returns `None` if N > 1 and Newton's steps do not settle.
    #[inline(always)]
    pub fn points(&self, xi: &Lanes<N>) -> Option<(BranchPoints<N>, Lanes<N>)> {
        match self {
            Self::One(branch) => branch.points(xi),
            Self::Cubics(c) => points::points([&c.xi, &c.zeta], c.t, c.ends, xi),
        }
    }

    /// Computes the slopes of chords from points of these branches to the abscissae `to` \[mm\]. Returns `None` for points
    /// of another shape, and if N > 1 and Newton's steps do not settle.
    #[inline(always)]
    pub fn chords_from(&self, from: &BranchPoints<N>, to: &Lanes<N>) -> Option<Lanes<N>> {
        match (self, from) {
            (Self::One(branch), _) => branch.chords_from(from, to),
            (Self::Cubics(c), BranchPoints::Polynomial { xi, t, rate }) => {
                points::chords([&c.xi, &c.zeta], c.t, [xi, t, rate], to)
            }
            _ => None,
        }
    }

    /// Computes ζ and ξ along chords as multiples of `runs`; [`Branch::chords_near`] describes the method and the cases of
    /// NaN.
    #[inline(always)]
    pub fn chords_near(&self, from: &BranchPoints<N>, runs: &Lanes<N>) -> [Lanes<N>; 2] {
        match (self, from) {
            (Self::One(branch), _) => branch.chords_near(from, runs),
            (Self::Cubics(c), BranchPoints::Polynomial { t, rate, .. }) => {
                points::chords_near([&c.xi, &c.zeta], [t, rate], runs)
            }
            _ => [[f64::NAN; N]; 2],
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::profile::{Profile, Section, Side, standards};

    /// Returns the largest relative difference of points and chords between three lanes and one, and the number of
    /// comparisons.
    fn differences(profile: &Profile, side: Side) -> (f64, usize) {
        let section = Section::own_axes(profile, side);
        let (mut worst, mut compared) = (0f64, 0);
        for branch in &section.branches {
            let at = |share: f64| branch.xi.at(share);
            let (xi, to) = ([at(0.1), at(0.5), at(0.9)], [at(0.3), at(0.500001), at(0.95)]);
            let Some((points, heights)) = branch.points(&xi) else { continue };
            let Some(chords) = branch.chords_from(&points, &to) else { continue };
            let [climb, stretch] = branch.chords_near(&points, &[0, 1, 2].map(|k| to[k] - xi[k]));
            let zeta = branch.exact_heights(&xi, &points);
            for k in 0..3 {
                let (point, height) = branch.point(xi[k]);
                let chord = branch.chord_from(&point, to[k]);
                worst = worst.max((heights[k] - height).abs() / (1.0 + height.abs()));
                worst = worst.max((chords[k] - chord).abs() / (1.0 + chord * chord));
                let other = branch.chord_from(&point, xi[k] + (to[k] - xi[k]) * stretch[k]);
                worst = worst.max((climb[k] / stretch[k] - other).abs() / (1.0 + other * other));
                let exact = (zeta[k] - height).high.abs();
                worst = worst.max(exact / (1.0 + height.abs()));
                compared += 1;
            }
        }
        (worst, compared)
    }

    #[test]
    fn three_lanes_are_three_times_one_lane() -> crate::error::Result<()> {
        let rail = differences(&standards::rail("UIC60")?, Side::Rail);
        let wheel = differences(&standards::wheel("S1002")?, Side::Wheel);
        for (worst, compared) in [rail, wheel] {
            assert!(worst <= 1e-14 && compared >= 12, "{worst:e} of {compared}");
        }
        Ok(())
    }
}
