//! The result of the check, as data and as text.

use std::fmt;

use serde::Serialize;

use super::floor::Floor;
use wheelrail::internal::largest;

/// Expected order at which chordal errors fall.
const EXPECTED_ORDER: f64 = 2.0;
const ORDER_SPREAD: f64 = 0.1;

/// Largest angle \[rad\] between ξ and the profile's tangent at C. It allows tangents of drawings with ten digits, and is
/// far above rounding.
const TANGENT: f64 = 1e-12;

/// Statistics of the differences between two measurements of the same quantity.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Differences {
    /// Number of compared values.
    pub compared: usize,
    /// Largest difference.
    pub max: f64,
    /// 99 % quantile of the differences.
    pub p99: f64,
    /// Median of the differences.
    pub median: f64,
    /// Point (ξ, η) \[mm\] whose difference is worst against the allowed one.
    pub worst_at_mm: [f64; 2],
    /// Difference at the worst point.
    pub worst: f64,
    /// Allowed difference at the worst point.
    pub allowed: f64,
}

/// Observed orders log₂(e(h)/e(h/2)) between levels of meshes; 2 is expected.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Orders {
    /// Number of heights with errors clear of rounding.
    pub observed: usize,
    /// Least order.
    pub least: f64,
    /// Median order.
    pub median: f64,
    /// Largest order.
    pub most: f64,
}

/// Closest distances compared with the separation.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct ClosestDistances {
    /// Amount by which the relation is violated \[mm\]; 0 if it holds.
    pub violation: Differences,
    /// Widest interval of the relation \[mm\], which tells how sharp it is.
    pub widest_mm: f64,
    /// Lift of the wheel along ζ that separates the bodies \[mm\].
    pub lift_mm: f64,
    /// Closest distance of the two bodies after the lift \[mm\]; NaN if it was not found.
    pub bodies_mm: f64,
    /// Place (ξ, η) of the wheel's closest point \[mm\].
    pub bodies_at_mm: [f64; 2],
    /// Separation at that place, lift included \[mm\]: the s of the relation; NaN at the end of a body.
    pub bodies_separation_mm: f64,
}

/// Numbers of points; no point is left out silently.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Counts {
    /// Rays that were asked for.
    pub points: usize,
    /// Separations that were compared.
    pub compared: usize,
    /// Points where neither the checker nor the program finds both surfaces.
    pub no_surface: usize,
    /// Points where a surface is too steep to measure, or ends.
    pub steep_or_end: usize,
    /// Points where only one of checker and program finds a surface: a disagreement.
    pub surface_disputed: usize,
    /// Points where the checker could not locate its own answer: these count as failures.
    pub unresolved: usize,
}

/// The result of a check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Whether the check passed: `objections` is empty.
    pub agrees: bool,
    /// Each disagreement, and each sign that the checker could not decide, with the value found and the value expected.
    pub objections: Vec<String>,
    /// Numbers of points, by what was found at them.
    pub counts: Counts,
    /// The checker's own errors on closed forms of the scene's size.
    pub floors: Vec<Floor>,
    /// Differences |s − s by rays| \[mm\].
    pub separation: Differences,
    /// Full width of the widest rigorous bracket of s \[mm\].
    pub bracket_mm: f64,
    /// Number of separations outside their bracket.
    pub outside_bracket: usize,
    /// Largest error estimate of an extrapolated height \[mm\].
    pub largest_estimate_mm: f64,
    /// Observed orders of the chordal errors.
    pub orders: Orders,
    /// Differences |n − n by meshes| of both bodies' unit normals.
    pub normals: Differences,
    /// Distance of C from the profiles \[mm\] and angle between the frame's ξ axis and their tangents \[rad\]; `None` if C is
    /// not the frame's origin.
    pub contact_point: Option<[f64; 2]>,
    /// The text [`RELATION`](super::RELATION).
    pub relation: &'static str,
    /// Closest distances compared with the separation.
    pub distances: ClosestDistances,
    /// Time of the check \[s\].
    pub seconds: f64,
}

impl Differences {
    /// Computes the statistics of (difference, allowed, (ξ, η)). NaN counts as larger than any difference.
    pub(super) fn of(all: &[(f64, f64, [f64; 2])]) -> Self {
        let number = |difference: f64| if difference.is_nan() { f64::INFINITY } else { difference };
        let all: Vec<_> = all.iter().map(|d| (number(d.0), d.1, d.2)).collect();
        let Some(worst) = all.iter().max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1))) else {
            return Self::default();
        };
        let mut sorted: Vec<f64> = all.iter().map(|d| d.0).collect();
        sorted.sort_by(f64::total_cmp);
        let n = sorted.len();
        let quantile = |share: f64| sorted[((share * n as f64).ceil() as usize).clamp(1, n) - 1];
        Self {
            compared: n,
            max: sorted[n - 1],
            p99: quantile(0.99),
            median: quantile(0.5),
            worst_at_mm: worst.2,
            worst: worst.0,
            allowed: worst.1,
        }
    }

    /// Returns whether something was compared and no difference is larger than allowed.
    pub fn within(&self) -> bool {
        self.compared > 0 && self.worst <= self.allowed
    }

    /// Returns the objection to the differences, in `unit`; `None` if there is none.
    fn objection(&self, what: &str, unit: &str) -> Option<String> {
        let [xi, eta] = self.worst_at_mm;
        let (worst, allowed) = (self.worst, self.allowed);
        if self.compared == 0 {
            return Some(format!("{what}: nothing could be compared; expected at least one point"));
        }
        (!self.within()).then(|| {
            format!("{what}: {worst:.2e}{unit} off at ξ = {xi:.6}, η = {eta:.6} mm; expected at most {allowed:.1e}{unit}")
        })
    }
}

impl Orders {
    pub(super) fn of(mut all: Vec<f64>) -> Self {
        all.sort_by(f64::total_cmp);
        let n = all.len();
        if n == 0 {
            return Self::default();
        }
        Self { observed: n, least: all[0], median: all[n / 2], most: all[n - 1] }
    }
}

impl Report {
    /// Lists every objection; the pair agrees if there is none. `resolved` \[mm\] is the largest error that the checker
    /// itself may have; `rounding` \[mm\] is that of coordinates.
    pub(super) fn judge(&mut self, resolved: f64, rounding: f64) {
        let counts = self.counts;
        let mut objections: Vec<String> = [
            self.separation.objection("separation", " mm"),
            self.normals.objection("unit normals", ""),
            self.distances.violation.objection("closest distances", " mm"),
        ]
        .into_iter()
        .flatten()
        .collect();
        let mut object = |right: bool, objection: String| {
            if !right {
                objections.push(objection);
            }
        };
        let bodies = self.distances.bodies_mm;
        object(bodies.is_finite(), "closest distance of the bodies: not found; expected a number".into());
        let outside = self.outside_bracket;
        object(
            outside == 0,
            format!("separation: {outside} outside the bracket of the meshes; expected none"),
        );
        let disputed = counts.surface_disputed;
        object(
            disputed == 0,
            format!("surface: {disputed} points where only one of both finds one; expected none"),
        );
        let unresolved = counts.unresolved;
        object(unresolved == 0, format!("checker: {unresolved} points it could not resolve; expected none"));
        if let Some([off, turned]) = self.contact_point {
            let expected = format!("expected at most {rounding:.1e} mm");
            object(off <= rounding, format!("C: {off:.2e} mm off a profile; {expected}"));
            let tangent = format!(
                "ξ: turned by {turned:.2e} rad from a profile's tangent at C; expected at most {TANGENT:.1e}"
            );
            object(turned <= TANGENT, tangent);
        }
        let median = self.orders.median;
        let order = self.orders.observed == 0 || (median - EXPECTED_ORDER).abs() <= ORDER_SPREAD;
        object(order, format!("meshes: they converge with order {median:.3}; expected {EXPECTED_ORDER}"));
        let floor = largest(self.floors.iter().flat_map(|f| [f.ray_mm, f.closest_mm]));
        object(
            floor <= resolved,
            format!("checker: {floor:.1e} mm off on closed forms; expected at most {resolved:.1e} mm"),
        );
        self.agrees = objections.is_empty();
        self.objections = objections;
    }
}

/// Writes the whole report, to be read after the name of the contact.
impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.agrees { "agrees" } else { "DISAGREES" };
        writeln!(f, "{verdict} with triangle meshes measured by parry3d, {:.2} s", self.seconds)?;
        self.objections.iter().try_for_each(|objection| writeln!(f, "  objection: {objection}"))?;
        self.counts.lines(f)?;
        row(f, "|s - s by rays|", "mm", &self.separation)?;
        row(f, "|n - n of the meshes|", "", &self.normals)?;
        row(f, "d outside its range", "mm", &self.distances.violation)?;
        writeln!(
            f,
            "    d: closest distance of a point of one body from the other; its range: {}",
            self.relation
        )?;
        writeln!(f, "    widest range {:.1e} mm", self.distances.widest_mm)?;
        let ClosestDistances { lift_mm, bodies_mm, bodies_separation_mm, .. } = self.distances;
        writeln!(
            f,
            "  bodies: {bodies_mm:.6} mm apart with the wheel lifted by {lift_mm:.6} mm; along ζ from there {}",
            if bodies_separation_mm.is_nan() {
                "no surface, at the end of a body".into()
            } else {
                format!("{bodies_separation_mm:.6} mm")
            }
        )?;
        writeln!(
            f,
            "  rigorous bounds of s: at most {:.1e} mm apart, {} s outside",
            self.bracket_mm, self.outside_bracket
        )?;
        let Orders { observed, least, median, most } = self.orders;
        writeln!(
            f,
            "  error of the meshes ~ cell^p: p = {median:.2} in the middle of {observed} points, {least:.2} to \
             {most:.2}; expected {EXPECTED_ORDER}"
        )?;
        match self.contact_point {
            Some([off, turned]) => writeln!(
                f,
                "  C: {off:.1e} mm off the profiles; ξ {turned:.1e} rad off their tangents where smooth"
            )?,
            None => writeln!(f, "  C: not the origin of this frame, and not compared")?,
        }
        writeln!(f, "  the checker's own errors on bodies of known shape and this size:")?;
        self.floors.iter().try_for_each(|Floor { form, ray_mm, normal, closest_mm }| {
            writeln!(
                f,
                "    {form:<9} rays {ray_mm:.1e} mm, normals {normal:.1e}, closest points {closest_mm:.1e} mm"
            )
        })
    }
}

impl Counts {
    fn lines(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "  points: {} of {} compared", self.compared, self.points)?;
        let reasons = [
            (self.no_surface, "points where program and meshes find no surface"),
            (self.steep_or_end, "points at the end of a body, or where it is within 1.2° of the ζ direction"),
            (self.surface_disputed, "points where only one of both finds a surface"),
            (self.unresolved, "points that the checker could not resolve"),
        ];
        let reasons = reasons.iter().filter(|(count, _)| *count > 0);
        reasons.into_iter().try_for_each(|(count, reason)| writeln!(f, "    left out: {count} {reason}"))
    }
}

fn row(f: &mut fmt::Formatter<'_>, name: &str, unit: &str, d: &Differences) -> fmt::Result {
    let ([xi, eta], Differences { compared, max, p99, median, worst, allowed, .. }) = (d.worst_at_mm, *d);
    if compared == 0 {
        return writeln!(f, "  {name:<22} none compared");
    }
    writeln!(
        f,
        "  {name:<22} largest {max:.1e}, 99 % up to {p99:.1e}, half up to {median:.1e} {unit:<2} of {compared}; \
         nearest to its limit: {worst:.1e} of {allowed:.1e} at ξ = {xi:.4}, η = {eta:.4} mm"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_compared_and_nan_are_no_agreement() {
        assert!(!Differences::default().within());
        for bad in [(f64::NAN, 1.0), (0.0, f64::NAN), (f64::INFINITY, f64::INFINITY)] {
            let all = [(0.0, 1.0, [0.0; 2]), (bad.0, bad.1, [1.0; 2])];
            let found = Differences::of(&all);
            assert!(!found.within() || bad.1.is_infinite(), "{bad:?}: {found:?}");
        }
        assert!(largest([1.0, f64::NAN, 2.0]).is_nan());
        assert_eq!(largest([]), 0.0);
    }
}
