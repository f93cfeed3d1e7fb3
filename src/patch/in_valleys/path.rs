//! Follows the places of a wheel that are parallel to η in the order of its profile, and cuts this path where
//! it turns back in ξ.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use super::circle::{Circle, FARTHEST, Turned};
use crate::numerics::interval::Interval;
use crate::numerics::lanes::Lanes;
use crate::numerics::sign_changes::sign_changes;

/// Rounding of dξ/dl.
const RUN_NOISE: f64 = 64.0 * f64::EPSILON;

/// Turn about the axle below which a kink makes no fold. Its ridge would be ρ t²/2 above its valleys, which is less than
/// rounding.
const LEAST_TURN: f64 = 1e-8;

/// A part of the path over which ξ is monotone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Leg {
    /// Index of the piece; `None` on the circle of one profile point.
    pub(super) piece: Option<usize>,
    /// The circle of that profile point; for a piece, the circle at its beginning.
    pub(super) circle: Circle,
    /// Profile abscissae at both ends \[mm\], or t on the circle.
    pub(super) range: [f64; 2],
    /// ξ at both ends \[mm\].
    pub(super) xi: [f64; 2],
}

impl Leg {
    fn reversed(self) -> Self {
        let back = |[a, b]: [f64; 2]| [b, a];
        Self { xi: back(self.xi), range: back(self.range), ..self }
    }
}

/// The path over one run of pieces.
pub(super) struct ValleyPath {
    legs: Vec<Leg>,
    /// Valleys that are not part of the path. They lie behind ends over which lines of constant ξ leave the wheel and enter
    /// it again.
    apart: Vec<Leg>,
    /// The circles at both ends of the run.
    pub(super) ends: [Circle; 2],
}

impl ValleyPath {
    /// Makes the path over a run of pieces, from the left end of its surface to the right end.
    pub(super) fn new(turned: &Turned<'_>, run: &Range<usize>) -> Self {
        let pieces = &turned.section.pieces;
        let [first, last] = [run.start, run.end - 1];
        let ends = [turned.circle(first, pieces[first].xi.low), turned.circle(last, pieces[last].xi.high)];
        let mut path = Self { legs: Vec::new(), apart: Vec::new(), ends };
        path.end(turned, 0, turned.parallel(first, pieces[first].xi.low).1);
        let mut before = None;
        for k in run.clone() {
            if let Some(before) = before {
                let from = turned.parallel(before, pieces[before].xi.high);
                path.kink(turned, from, turned.parallel(k, pieces[k].xi.low).1);
            }
            path.piece(turned, k);
            before = Some(k);
        }
        path.end(turned, 1, turned.parallel(last, pieces[last].xi.high).1);
        path
    }

    /// Appends the circle of an end: at the left end (0) up to the place `t` of the end point, at the right end (1) from
    /// there on.
    fn end(&mut self, turned: &Turned<'_>, end: usize, t: f64) {
        let circle = self.ends[end];
        if !turned.is_skewed() {
            // Lines that leave the wheel at the midplane enter it again ahead of C and behind.
            let both = turned.is_hollow(end).then(|| circle_legs(turned, circle));
            self.apart.extend(both.into_iter().flatten());
            return;
        }
        // The outward tangents turn the place against the skew on the right end, and with it on the left end.
        let side = if end == 0 { turned.skew.im } else { -turned.skew.im };
        let (mut limit, touching) = (FARTHEST.copysign(side), turned.touching());
        if touching.abs() < FARTHEST {
            if (touching - t) * side > 0.0 {
                limit = touching;
            } else if turned.is_hollow(end) {
                let range = if end == 0 { [-limit, touching] } else { [touching, -limit] };
                self.apart.push(leg(turned, circle, range));
            }
        }
        if (limit - t) * side > 0.0 {
            self.legs.push(leg(turned, circle, if end == 0 { [limit, t] } else { [t, limit] }));
        }
    }

    /// Appends the circle of a joint between the places of its two tangents, if these differ.
    fn kink(&mut self, turned: &Turned<'_>, (circle, from): (Circle, f64), to: f64) {
        if (to - from).abs() <= LEAST_TURN {
            return;
        }
        let touching = turned.touching();
        let inside = (touching - from) * (touching - to) < 0.0;
        let cuts = if inside { vec![from, touching, to] } else { vec![from, to] };
        self.legs.extend(cuts.windows(2).map(|pair| leg(turned, circle, [pair[0], pair[1]])));
    }

    /// Appends the places of a piece, as legs between the folds of ξ(p).
    fn piece(&mut self, turned: &Turned<'_>, index: usize) {
        let over = turned.section.pieces[index].xi;
        let [a, b] = over.ends();
        let xi = |p: f64| {
            let (circle, t) = turned.parallel(index, p);
            turned.place(&circle, t).xi
        };
        let mut cuts = vec![a];
        if turned.may_turn(index) {
            // Beside a vertical end of an arc the run is a function of the square root of the distance from it, which the sine
            // resolves.
            let branch = &turned.section.branches[turned.section.pieces[index].branch];
            let range = over.map(|p| branch.parameter(p));
            let (middle, half) = (range.middle(), range.width() / 2.0);
            let parameter = |angle: f64| range.nearest(middle + half * angle.sin());
            let run = |angle: &Lanes| angle.map(|angle| turned.run(branch, parameter(angle)));
            let mut turns = Vec::new();
            sign_changes(run, Interval::symmetric(FRAC_PI_2), RUN_NOISE, &mut turns);
            let abscissa = |angle: f64| branch.station_and_curvature(parameter(angle)).0.x;
            cuts.extend(turns.into_iter().map(abscissa).filter(|p| a < *p && *p < b));
            cuts.dedup();
        }
        cuts.push(b);
        let circle = turned.parallel(index, a).0;
        self.legs.extend(cuts.windows(2).map(|pair| {
            let range = [pair[0], pair[1]];
            Leg { piece: Some(index), circle, range, xi: range.map(xi) }
        }));
    }

    /// Returns the chains of legs along which ξ only grows (valleys, true) or only falls (ridges, false). Ridges are
    /// reversed, so that ξ grows along every chain.
    pub(super) fn monotone(&self, rounding: f64) -> Vec<(Vec<Leg>, bool)> {
        let mut chains: Vec<(Vec<Leg>, bool)> = self.apart.iter().map(|leg| (vec![*leg], true)).collect();
        let mut chain: Vec<Leg> = Vec::new();
        let mut grows = true;
        for leg in &self.legs {
            let up = leg.xi[1] > leg.xi[0];
            // A leg as short as rounding has no direction.
            if !chain.is_empty() && up != grows && (leg.xi[1] - leg.xi[0]).abs() <= rounding {
                continue;
            }
            if !chain.is_empty() && up != grows {
                chains.push((std::mem::take(&mut chain), grows));
            }
            if leg.xi[0] != leg.xi[1] {
                grows = up;
                chain.push(*leg);
            }
        }
        if !chain.is_empty() {
            chains.push((chain, grows));
        }
        for (legs, _) in chains.iter_mut().filter(|(_, grows)| !grows) {
            legs.reverse();
            legs.iter_mut().for_each(|leg| *leg = leg.reversed());
        }
        chains
    }
}

fn leg(turned: &Turned<'_>, circle: Circle, range: [f64; 2]) -> Leg {
    Leg { piece: None, circle, range, xi: range.map(|t| turned.place(&circle, t).xi) }
}

/// Returns the whole circle of a profile point, as legs of ascending ξ.
pub(super) fn circle_legs(turned: &Turned<'_>, circle: Circle) -> impl Iterator<Item = Leg> {
    let touching = turned.touching().clamp(-FARTHEST, FARTHEST);
    let halves = [[-FARTHEST, touching], [touching, FARTHEST]].into_iter().filter(|[from, to]| from < to);
    halves
        .map(move |range| leg(turned, circle, range))
        .map(|leg| if leg.xi[0] <= leg.xi[1] { leg } else { leg.reversed() })
}
