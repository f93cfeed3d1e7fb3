//! Polynomial segments as their sections need them in every frame: their ends and directions are found once, and a segment is
//! turned into a frame when its curve is first asked for. A measured profile has a thousand segments, a patch lies over fifty.

use std::ops::Deref;
use std::sync::{Arc, OnceLock};

use super::curve::PolynomialBranch;
use super::turned::seen_from;
use crate::numerics::interval::Interval;
use crate::numerics::polynomial::{derivative, exact_coefficients, range};
use crate::numerics::twice::Twice;
use crate::profile::chain::Profile;
use crate::profile::polynomial::Polynomial;
use crate::profile::segment::Shape;
use crate::profile::station::Station;

/// Steepest slope of a segment whose ends and directions alone tell which part of it faces the other body: a rounding of ξ there
/// is no more than a few of ζ.
const STEEPEST: f64 = 4.0;

/// Roundings by which bounds of slopes are widened, relative to 1 + slope²: a few of each direction and of their quotient.
const WIDENING: f64 = 16.0 * f64::EPSILON;

/// A polynomial segment with what does not depend on the frame.
#[derive(Debug)]
pub(super) struct PolynomialSpan {
    polynomial: Polynomial,
    /// x and z \[mm\] at both ends.
    ends: [[Twice; 2]; 2],
    /// Direction in the middle, as cosine and sine.
    middle: [f64; 2],
    /// Bounds of the tangents of all directions against the middle's; `None` beyond ±45°.
    spread: Option<Interval>,
}

impl PolynomialSpan {
    /// Returns the spans of a profile's polynomial segments, in their order.
    pub(super) fn all(profile: &Profile) -> Arc<[Self]> {
        let of = |shape: &Shape| match shape {
            Shape::Polynomial(polynomial) => Some(Self::new(polynomial)),
            Shape::Arc(_) => None,
        };
        profile.segments().iter().filter_map(|segment| of(&segment.shape)).collect()
    }

    fn new(polynomial: &Polynomial) -> Self {
        let t = polynomial.range();
        let rates =
            [&polynomial.x, &polynomial.z].map(|c| derivative(&c.iter().map(|c| c.high).collect::<Vec<_>>()));
        let Station { cos, sin, .. } = polynomial.station(t.middle());
        let get = |c: &[f64], k: usize| c.get(k).copied().unwrap_or(0.0);
        let both = (0..rates[0].len().max(rates[1].len())).map(|k| [get(&rates[0], k), get(&rates[1], k)]);
        let (along, across): (Vec<_>, Vec<_>) =
            both.map(|[dx, dz]| (dx * cos + dz * sin, dz * cos - dx * sin)).unzip();
        let (run, rise) = (range(&along, t), range(&across, t));
        let spread = (run.low > 0.0).then(|| rise.quotient(run));
        Self {
            ends: t.ends().map(|t| {
                [&polynomial.x, &polynomial.z].map(|c| exact_coefficients(c, t.into())).map(|[at]| at)
            }),
            middle: [cos, sin],
            spread: spread.filter(|spread| spread.magnitude() <= 1.0),
            polynomial: polynomial.clone(),
        }
    }

    /// Returns ξ and ζ \[mm\] of the start (0) or the end (1), to a rounding of their distance from the frame's origin.
    pub(super) fn end(&self, end: usize, frame: &Station) -> [f64; 2] {
        let [x, z] = self.ends[end];
        let (x, z) = ((x.high - frame.x) + x.low, (z.high - frame.z) + z.low);
        [x * frame.cos + z * frame.sin, z * frame.cos - x * frame.sin]
    }

    /// Tells whether the segment faces the other body all along, or nowhere, by more than rounding; `None` where neither is sure.
    pub(super) fn faces(&self, frame: &Station) -> Option<bool> {
        let runs = self.extremes(frame)?.map(|[run, _]| run);
        let all = |sign: f64| runs.iter().all(|run| sign * run > WIDENING);
        if all(1.0) { Some(true) } else { all(-1.0).then_some(false) }
    }

    /// Returns the two directions, as run and rise in a frame, between which all others lie; `None` beyond ±45° from the middle.
    fn extremes(&self, frame: &Station) -> Option<[[f64; 2]; 2]> {
        let [cos, sin] = self.middle;
        let (cos, sin) = (cos * frame.cos + sin * frame.sin, sin * frame.cos - cos * frame.sin);
        Some(self.spread?.ends().map(|tangent| [cos - tangent * sin, sin + tangent * cos]))
    }

    /// Returns bounds of ζ′ in a frame; `None` where it may be steeper than [`STEEPEST`], or face away.
    pub(super) fn slopes(&self, frame: &Station) -> Option<Interval> {
        let [low, high] = self.extremes(frame)?;
        let gentle = |[run, rise]: [f64; 2]| run > 0.0 && rise.abs() <= STEEPEST * run;
        if !gentle(low) || !gentle(high) {
            return None;
        }
        let [low, high] = [low, high].map(|[run, rise]| rise / run);
        Some(Interval::new(low - WIDENING * (1.0 + low * low), high + WIDENING * (1.0 + high * high)))
    }
}

/// The spans of a profile and the frame from which a section sees them.
#[derive(Debug)]
pub(super) struct View {
    pub(super) spans: Arc<[PolynomialSpan]>,
    pub(super) frame: Station,
}

/// The curve of a polynomial branch in the section's frame, turned when it is first asked for.
#[derive(Debug, Clone)]
pub struct TurnedPolynomial {
    curve: OnceLock<Box<PolynomialBranch>>,
    view: Arc<View>,
    span: usize,
}

impl TurnedPolynomial {
    /// Makes the curve of a whole span.
    pub(super) fn of_span(view: &Arc<View>, span: usize) -> Self {
        Self { curve: OnceLock::new(), view: Arc::clone(view), span }
    }

    /// Makes a part of a span that was turned already.
    pub(super) fn of_part(view: &Arc<View>, span: usize, part: PolynomialBranch) -> Self {
        Self { curve: Box::new(part).into(), ..Self::of_span(view, span) }
    }

    /// Returns the curve, turned if it was not yet. Where a formula reads several of its parts, call it once.
    #[inline(always)]
    pub(super) fn curve(&self) -> &PolynomialBranch {
        self.curve.get_or_init(|| self.turn())
    }

    #[cold]
    fn turn(&self) -> Box<PolynomialBranch> {
        let (exact, t) = seen_from(&self.view.spans[self.span].polynomial, &self.view.frame);
        Box::new(PolynomialBranch::new(exact, t))
    }

    /// Returns bounds of ζ′ over the span; `None` where they are not known without its curve.
    pub(super) fn slopes(&self) -> Option<Interval> {
        self.view.spans[self.span].slopes(&self.view.frame)
    }
}

impl Deref for TurnedPolynomial {
    type Target = PolynomialBranch;

    #[inline(always)]
    fn deref(&self) -> &PolynomialBranch {
        self.curve()
    }
}

#[cfg(test)]
mod tests {
    use super::super::turned::rising_parts;
    use super::super::{BranchShape, Section};
    use super::*;
    use crate::profile::{Side, standards};

    /// In frames at points all over a wheel of polynomials: what is known of a span without its curve is that of its curve.
    #[test]
    fn ends_and_slopes_of_spans_are_those_of_their_curves() -> crate::error::Result<()> {
        let wheel = standards::wheel("S1002")?;
        let own = Section::own_axes(&wheel, Side::Wheel);
        let mut compared = 0;
        for x in [-60.0, -40.0, -38.0, -30.0, -10.0, 0.0, 30.0, 50.0] {
            let Some(point) = own.point(&wheel, x) else { continue };
            let section = own.at_contact(&wheel, &point, Side::Wheel);
            for branch in &section.branches {
                let (BranchShape::Polynomial(p), Some(heights)) = (&branch.shape, branch.heights) else {
                    continue;
                };
                let Some(slopes) = p.slopes() else { continue };
                assert_eq!([branch.begins_segment, branch.ends_segment], [true; 2]);
                for ((xi, height), end) in branch.xi.ends().into_iter().zip(heights).zip(p.ends.ends()) {
                    let rounding = 8.0 * f64::EPSILON * (1.0 + xi.abs() + height.abs());
                    assert!((xi - end).abs() <= rounding, "{x}: {branch:?}");
                    assert!((height - branch.height(xi)).abs() <= 5.0 * rounding, "{x}: {branch:?}");
                }
                for k in 0..=64 {
                    let xi = branch.xi.at(f64::from(k) / 64.0);
                    let slope = branch.slope_from(&branch.point(xi).0);
                    assert!(slopes.contains(slope), "{x}: {slope} beyond {slopes:?}");
                }
                compared += 1;
            }
        }
        assert!(compared >= 8, "only {compared} spans");
        Ok(())
    }

    /// In frames all around wheels of polynomials, drawn and with noise: what surely faces the other body, or surely does not, is what
    /// the turned curve says.
    #[test]
    fn what_faces_the_other_body_is_that_of_the_curve() -> crate::error::Result<()> {
        let drawn = standards::wheel("S1002")?;
        let points = crate::measured::write::sample(&drawn, 0.7)?.into_iter().enumerate();
        let noisy: Vec<[f64; 2]> = points.map(|(k, [x, z])| [x, z + 0.02 * (k as f64 * 1.7).sin()]).collect();
        let curve = Some(crate::measured::CurveKind::Interpolation);
        let options = crate::measured::Options { curve, ..Default::default() };
        let noisy = crate::measured::of_points("noisy", &noisy, Side::Wheel, &options)?.profile;
        let mut seen = [0; 3];
        for (profile, degrees) in [&drawn, &noisy].into_iter().flat_map(|p| (-180..180).map(move |k| (p, k)))
        {
            let (sin, cos) = f64::from(degrees).to_radians().sin_cos();
            let frame = Station { x: 3.0, z: -2.0, cos, sin };
            for span in &*PolynomialSpan::all(profile) {
                let (exact, t) = seen_from(&span.polynomial, &frame);
                let whole = PolynomialBranch::new(exact, t);
                let parts = rising_parts([&whole.xi, &whole.zeta], t);
                match span.faces(&frame) {
                    Some(true) => assert_eq!(parts, [t], "{degrees}°"),
                    Some(false) => assert_eq!(parts, [], "{degrees}°"),
                    None => {}
                }
                seen[span.faces(&frame).map_or(2, usize::from)] += 1;
            }
        }
        assert!(seen[0] > 10_000 && seen[1] > 10_000 && seen[2] < seen[0] / 4, "{seen:?}");
        Ok(())
    }
}
