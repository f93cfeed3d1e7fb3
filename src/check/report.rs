//! What the check answers, as data and as text.

use std::fmt;

use serde::Serialize;

use super::floor::Floor;

/// The relation between the distance along ζ and the closest distance.
pub const RELATION: &str = "s*min(n0, n1) <= d <= s*max(n0, n1), n0 and n1 the zeta components of the unit \
                            normals at the foot along zeta and at the closest point, and at joints between";

/// Order at which chordal errors fall, and how far the median of the observed ones may be from it.
const EXPECTED_ORDER: f64 = 2.0;
const ORDER_SPREAD: f64 = 0.1;

/// Largest angle \[rad\] between ξ and the profile's tangent at C: a tangent of a drawing with ten digits, and far
/// above rounding.
const TANGENT: f64 = 1e-12;

/// Differences between two measurements of the same quantity.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Differences {
    /// How many were compared.
    pub compared: usize,
    /// Largest.
    pub max: f64,
    /// 99 % of them are not larger.
    pub p99: f64,
    /// Half of them are not larger.
    pub median: f64,
    /// (ξ, η) \[mm\] of the point that is worst against what is allowed there.
    pub worst_at_mm: [f64; 2],
    /// The difference there.
    pub worst: f64,
    /// What is allowed there.
    pub allowed: f64,
}

/// Orders log₂(e(h)/e(h/2)) that were observed between levels of meshes; 2 is expected.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Orders {
    /// Heights with errors clear of rounding.
    pub observed: usize,
    /// Smallest.
    pub least: f64,
    /// Middle one.
    pub median: f64,
    /// Largest.
    pub most: f64,
}

/// Closest distances against the separation.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Distances {
    /// By how much the relation is violated \[mm\]; 0 where it holds.
    pub violation: Differences,
    /// Widest interval of the relation \[mm\]: how tight it is.
    pub widest_mm: f64,
    /// By how much the wheel is lifted along ζ so that the bodies are apart \[mm\].
    pub lift_mm: f64,
    /// Closest distance of the two bodies so lifted \[mm\]; NaN where it was not found.
    pub bodies_mm: f64,
    /// (ξ, η) of the wheel's foot of it \[mm\].
    pub bodies_at_mm: [f64; 2],
    /// Separation at that foot, lift included \[mm\]: the relation's s.
    pub bodies_separation_mm: f64,
}

/// Counts of points, none left out silently.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Counts {
    /// Rays asked for.
    pub points: usize,
    /// Separations compared.
    pub compared: usize,
    /// Neither the checker nor the program finds both surfaces.
    pub no_surface: usize,
    /// Too steep to measure, or at the very end of a body.
    pub steep_or_end: usize,
    /// One finds a surface where the other does not: a disagreement.
    pub surface_disputed: usize,
    /// Where the checker could not pin its own answer down: counts as a failure.
    pub unresolved: usize,
}

/// The result of a check.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Report {
    /// Whether everything agrees to the floor.
    pub agrees: bool,
    /// Why not; empty when it agrees.
    pub objections: Vec<String>,
    /// What became of the points.
    pub counts: Counts,
    /// The checker's own errors on closed forms of the scene's size.
    pub floors: Vec<Floor>,
    /// |s − s by rays| \[mm\].
    pub separation: Differences,
    /// Widest rigorous bracket of s \[mm\], full width.
    pub bracket_mm: f64,
    /// Separations outside their bracket.
    pub outside_bracket: usize,
    /// Largest error estimate of an extrapolated height \[mm\].
    pub largest_estimate_mm: f64,
    /// Observed orders.
    pub orders: Orders,
    /// |n − n by meshes| of both bodies' unit normals.
    pub normals: Differences,
    /// Distance of C from the profiles \[mm\] and angle between the frame's ξ axis and their tangents \[rad\].
    pub contact_point: [f64; 2],
    /// [`RELATION`].
    pub relation: &'static str,
    /// Closest distances.
    pub distances: Distances,
    /// Time taken \[s\].
    pub seconds: f64,
}

impl Differences {
    /// From (difference, allowed, (ξ, η)).
    pub(super) fn of(all: &[(f64, f64, [f64; 2])]) -> Self {
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

    /// Whether no difference is larger than allowed.
    pub fn within(&self) -> bool {
        self.compared == 0 || self.worst <= self.allowed
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
    /// Lists every objection; the pair agrees when there is none. `resolved`: largest error \[mm\] the checker may
    /// have itself; `rounding`: of coordinates \[mm\].
    pub(super) fn judge(&mut self, resolved: f64, rounding: f64) {
        let mut object = |wrong: bool, objection: String| {
            if wrong {
                self.objections.push(objection);
            }
        };
        let worst = |d: &Differences| {
            format!("off by {:e}, more than {:e}, at ξ, η = {:?} mm", d.worst, d.allowed, d.worst_at_mm)
        };
        let counts = self.counts;
        object(!self.separation.within(), format!("separation {} (mm)", worst(&self.separation)));
        object(!self.normals.within(), format!("unit normal {}", worst(&self.normals)));
        object(
            !self.distances.violation.within(),
            format!("relation {} (mm)", worst(&self.distances.violation)),
        );
        object(
            self.outside_bracket > 0,
            format!("{} separations outside their bracket", self.outside_bracket),
        );
        object(
            counts.surface_disputed > 0,
            format!("{} points with a surface for one only", counts.surface_disputed),
        );
        object(counts.unresolved > 0, format!("{} points not resolved by the checker", counts.unresolved));
        object(counts.compared == 0, "no point could be compared".into());
        object(
            self.contact_point[0] > rounding,
            format!("C is {:e} mm off a profile", self.contact_point[0]),
        );
        let turned = self.contact_point[1] > TANGENT;
        object(turned, format!("ξ is turned from a profile's tangent by {:e} rad", self.contact_point[1]));
        let order = self.orders.observed > 0 && (self.orders.median - EXPECTED_ORDER).abs() > ORDER_SPREAD;
        object(order, format!("meshes converge with order {}", self.orders.median));
        let floor = self.floors.iter().map(|f| f.ray_mm.max(f.closest_mm)).fold(0.0, f64::max);
        object(floor.is_nan() || floor > resolved, format!("the checker's own floor is {floor:e} mm"));
        self.agrees = self.objections.is_empty();
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "floor of the checker on closed forms of this size (mm; normals as unit vectors):")?;
        for Floor { form, ray_mm, normal, closest_mm } in &self.floors {
            writeln!(f, "  {form:<9} rays {ray_mm:8.1e}  closest {closest_mm:8.1e}  normals {normal:8.1e}")?;
        }
        let Counts { points, compared, no_surface, steep_or_end, surface_disputed, unresolved } = self.counts;
        writeln!(
            f,
            "points {points}: {compared} compared, {no_surface} without surface, {steep_or_end} steep or at an \
             end, {surface_disputed} disputed, {unresolved} unresolved"
        )?;
        row(f, "separation (mm)", &self.separation)?;
        row(f, "unit normals", &self.normals)?;
        row(f, "relation (mm)", &self.distances.violation)?;
        writeln!(
            f,
            "bracket of s: at most {:.1e} mm wide; {} outside",
            self.bracket_mm, self.outside_bracket
        )?;
        let Orders { observed, least, median, most } = self.orders;
        writeln!(f, "observed order: {least:.3} to {most:.3}, median {median:.3}, of {observed}")?;
        let [off, turned] = self.contact_point;
        writeln!(f, "contact point: {off:.1e} mm off the profiles, tangent {turned:.1e} rad off")?;
        writeln!(f, "relation: {}; at most {:.1e} mm wide", self.relation, self.distances.widest_mm)?;
        writeln!(
            f,
            "bodies lifted by {} mm: {} mm apart, {} along zeta",
            self.distances.lift_mm, self.distances.bodies_mm, self.distances.bodies_separation_mm
        )?;
        for objection in &self.objections {
            writeln!(f, "objection: {objection}")?;
        }
        writeln!(f, "verdict: {}", if self.agrees { "agrees" } else { "does not agree" })
    }
}

fn row(f: &mut fmt::Formatter<'_>, name: &str, d: &Differences) -> fmt::Result {
    let [xi, eta] = d.worst_at_mm;
    writeln!(
        f,
        "{name:<16} max {:8.1e}  99 % {:8.1e}  median {:8.1e}  of {}; worst {:.1e} (allowed {:.1e}) at ({xi}, {eta})",
        d.max, d.p99, d.median, d.compared, d.worst, d.allowed
    )
}
