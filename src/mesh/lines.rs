//! The lines of a strip mesh along ξ. They continue from band to band where bands meet.

use nalgebra::Point3;

use crate::numerics::interval::Interval;
use crate::patch::Band;
use crate::placement::Placement;
use crate::separation::Evaluator;

/// Distance of two lines, as a share of a band's width, below which they are one. It is far above the rounding of one line
/// on both sides of a meeting, and far below a cell.
const ONE_LINE: f64 = 1e-7;

/// Returns c = −1 … 1 of the lines of every band, ascending. A band that meets narrower ones takes over their lines; every
/// other band begins with the lines `own`. Every line continues as far as there are bands.
pub(super) fn lines(bands: &[Band], own: &[f64]) -> Vec<Vec<f64>> {
    if bands.len() == 1 {
        return vec![own.to_vec()];
    }
    let mut pairs: Vec<[usize; 2]> = (0..bands.len())
        .flat_map(|left| (0..bands.len()).map(move |right| [left, right]))
        .filter(|&[left, right]| bands[left].meets(&bands[right]))
        .collect();
    pairs.sort_by(|p, q| bands[p[1]].xi[0].total_cmp(&bands[q[1]].xi[0]));
    let takes = |k: usize| {
        pairs.iter().any(|&[left, right]| {
            let widths = [(left, 1), (right, 0)].map(|(band, end)| bands[band].sides[end].width());
            (k == left && widths[0] > widths[1]) || (k == right && widths[1] > widths[0])
        })
    };
    let mut shares: Vec<Vec<f64>> =
        (0..bands.len()).map(|k| if takes(k) { vec![-1.0, 1.0] } else { own.to_vec() }).collect();
    for &[left, right] in pairs.iter().rev() {
        carry(bands, &mut shares, (right, 0), (left, 1));
    }
    for &[left, right] in &pairs {
        carry(bands, &mut shares, (left, 1), (right, 0));
    }
    shares
}

/// Adds the lines of a band at one of its ends to another band that meets it there.
fn carry(bands: &[Band], shares: &mut [Vec<f64>], (from, end): (usize, usize), (to, side): (usize, usize)) {
    let [own, other] = [bands[from].sides[end], bands[to].sides[side]].map(Interval::from);
    let places: Vec<f64> = shares[from].iter().map(|&share| between(own, share)).collect();
    let shares = &mut shares[to];
    for eta in places {
        let share = 2.0 * (eta - other.low) / other.width() - 1.0;
        let k = shares.partition_point(|&other| other < share);
        let near = |other: Option<&f64>| other.is_some_and(|other| (other - share).abs() <= 2.0 * ONE_LINE);
        // If two lines are one, the line of the receiving band is kept.
        if share > -1.0 && share < 1.0 && !near(shares.get(k)) && !near(shares.get(k.wrapping_sub(1))) {
            shares.insert(k, share);
        }
    }
}

/// The points at which bands meet at one ξ.
pub(super) struct BandMeeting {
    /// ξ of the meeting \[mm\].
    pub(super) xi: f64,
    /// η \[mm\] of the points, ascending.
    eta: Vec<f64>,
    /// Indices of the points in the mesh; `None` until they are added to it.
    points: Vec<Option<usize>>,
}

impl BandMeeting {
    /// Returns all meetings of some bands with these lines.
    pub(super) fn all(bands: &[Band], shares: &[Vec<f64>]) -> Vec<Self> {
        let mut meetings: Vec<Self> = Vec::new();
        for band in bands {
            let xi = band.xi.high;
            if meetings.iter().any(|known| known.xi == xi) || !bands.iter().any(|next| band.meets(next)) {
                continue;
            }
            let mut eta = Vec::new();
            let mut width = 0.0f64;
            for (other, shares) in bands.iter().zip(shares) {
                for end in (0..2).filter(|&end| other.xi[end] == xi) {
                    let side = other.sides[end];
                    width = width.max(side.width());
                    eta.extend(shares.iter().map(|&share| between(side, share)));
                }
            }
            eta.sort_by(f64::total_cmp);
            eta.dedup_by(|a, b| (*a - *b).abs() <= ONE_LINE * width);
            meetings.push(Self { xi, points: vec![None; eta.len()], eta });
        }
        meetings
    }

    /// Returns the indices of the points of a band that ends or begins here. New points are added to the mesh.
    pub(super) fn row(
        &mut self,
        points: &mut Vec<Point3<f64>>,
        placement: &Placement,
        band: &Band,
        shares: &[f64],
    ) -> Vec<usize> {
        let side = band.sides[usize::from(self.xi == band.xi.high)];
        let mut evaluator = Evaluator::new(placement);
        let place = |share: &f64| {
            let eta = between(side, *share);
            let k = self.eta.partition_point(|&other| other < eta);
            let before = k.saturating_sub(1);
            let k = k.min(self.eta.len() - 1);
            let nearest =
                if (self.eta[before] - eta).abs() <= (self.eta[k] - eta).abs() { before } else { k };
            *self.points[nearest].get_or_insert_with(|| {
                let [xi, eta] = [self.xi, self.eta[nearest]];
                points.push(Point3::new(xi, eta, evaluator.lower_height(xi, eta)));
                points.len() - 1
            })
        };
        shares.iter().map(place).collect()
    }
}

/// Returns η at a share of a slice; the share is −1 at its lower end and 1 at its upper end.
pub(super) fn between(slice: Interval, share: f64) -> f64 {
    if share == -1.0 {
        slice.low
    } else if share == 1.0 {
        slice.high
    } else {
        slice.low + slice.width() / 2.0 * (1.0 + share)
    }
}
