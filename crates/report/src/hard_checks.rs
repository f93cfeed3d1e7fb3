//! The checks of every hard case.

use super::errors::{ComparedPoint, compare, inside_contact};
use super::hard_case::{COLUMNS, HardCase, METHODS, RelationKind, StatedComponent, StatedPatch};
use super::reference::exact;
use wheelrail::error::{Error, Result};
use wheelrail::patch::{Component, End, Patch, Slicer};
use wheelrail::placement::Placement;
use wheelrail::separation::{Choice, Evaluator, Method};

/// The bounds of the methods that promise digits: the relative error over the contact segments, and the absolute error
/// \[mm\] elsewhere, the latter × unit × max(1, R_max/300 mm). They are measured over all cases. If less than a quarter of
/// one is used, the suite fails.
pub const BOUNDS: [(Method, f64, f64); 2] =
    [(Method::Spectral, 5e-15, 2e-14), (Method::Pointwise, 2e-15, 2e-14)];

/// Promised relative accuracy of s, through which the boundary and the tips are checked.
const PROMISED_RELATIVE: f64 = 1e-13;
/// Promised absolute accuracy of s \[mm\], through which the boundary and the tips are checked.
const PROMISED_ABSOLUTE: f64 = 2e-12;

/// Number of points per column on which s must rise with |η|.
const RISING_SAMPLES: usize = 64;

/// Largest ratio of the stated bound of the Report's method to its error.
const MOST_SLACK: f64 = 4.0;

/// One check of one case.
#[derive(Debug, Clone, PartialEq)]
pub struct HardCheck {
    /// Subject of the check.
    pub what: String,
    /// The worst input.
    pub input: String,
    /// Result at the worst input.
    pub found: String,
    /// Expected result at the worst input.
    pub expected: String,
    /// Whether the check passed.
    pub passed: bool,
    /// For a check against one of [`BOUNDS`]: the name of the bound and the share of it that was used.
    pub share: Option<(String, f64)>,
}

impl HardCheck {
    fn new(what: impl Into<String>, input: String, found: String, expected: String, passed: bool) -> Self {
        Self { what: what.into(), input, found, expected, passed, share: None }
    }
}

/// A case while it is checked.
struct Bench<'a> {
    case: &'a HardCase,
    placement: &'a Placement,
    /// Scale of absolute bounds \[mm\].
    scale: f64,
}

/// Runs all checks; `points` are in the order of [`METHODS`].
pub(super) fn all(
    case: &HardCase,
    placement: &Placement,
    points: &[Vec<ComparedPoint>; 3],
    cases: &[HardCase],
) -> Result<Vec<HardCheck>> {
    let scale = case.unit * (case.reference.scene.largest_radius() / case.unit / 300.0).max(1.0);
    let bench = Bench { case, placement, scale };
    let mut checks = Vec::new();
    for (method, points) in METHODS.iter().zip(points) {
        match BOUNDS.iter().find(|(bound, ..)| bound == method) {
            Some((_, relative, absolute)) => {
                checks.extend(bench.digits(*method, points, *relative, *absolute));
            }
            None => checks.push(bench.report_newton(points)),
        }
    }
    checks.push(bench.rising());
    checks.extend(bench.boundary());
    checks.extend(case.patches.iter().flat_map(|stated| bench.patch(stated)));
    checks.extend(bench.relation(cases)?);
    Ok(checks)
}

impl Bench<'_> {
    /// Checks the mask, the relative error over the contact segments and the absolute error elsewhere.
    fn digits(
        &self,
        method: Method,
        points: &[ComparedPoint],
        relative: f64,
        absolute: f64,
    ) -> Vec<HardCheck> {
        let name = method.name();
        let worst = |measure: &dyn Fn(&ComparedPoint) -> Option<f64>| {
            let measured = points.iter().filter_map(|p| Some((measure(p)?, p)));
            measured.max_by(|a, b| a.0.total_cmp(&b.0))
        };
        let masked = points.iter().find(|p| p.error().is_nan());
        let mut checks = vec![HardCheck::new(
            format!("{name}: values exactly where both bodies have a surface"),
            masked.map_or("all points".into(), at),
            masked.map_or("so".into(), |p| p.found.to_string()),
            masked.map_or("so".into(), |p| format!("{:?}", p.expected)),
            masked.is_none(),
        )];
        let over = worst(&|p| p.relative().filter(|e| p.inside_contact && !e.is_nan()));
        let elsewhere = |p: &ComparedPoint| (!p.inside_contact || p.expected == Some(0.0)).then(|| p.error());
        let beside = worst(&|p| elsewhere(p).filter(|e| !e.is_nan()));
        let rows = [
            ("relative error over the contact segments", over, relative),
            ("absolute error elsewhere, mm", beside, absolute * self.scale),
        ];
        for (what, worst, bound) in rows {
            let Some((error, point)) = worst else { continue };
            let (what, value) = (format!("{name}: {what}"), point.expected.unwrap_or(f64::NAN));
            let found = format!("{error:.2e} (s = {:e})", point.found);
            let expected = format!("at most {bound:.2e} (s = {value:e})");
            let share = Some((what.clone(), error / bound));
            checks.push(HardCheck {
                share,
                ..HardCheck::new(what, at(point), found, expected, error <= bound)
            });
        }
        checks
    }

    /// Checks that the file's statement about the Report's method holds, and is not slack.
    fn report_newton(&self, points: &[ComparedPoint]) -> HardCheck {
        let stated = &self.case.report_newton;
        let undefined = points.iter().filter(|p| p.error().is_nan()).count();
        let largest = |values: &mut dyn Iterator<Item = f64>| {
            values.filter(|v| !v.is_nan()).fold(0.0, |m: f64, v| m.max(v))
        };
        let absolute = largest(&mut points.iter().map(ComparedPoint::error)) / self.case.unit;
        let relative = largest(&mut points.iter().filter_map(ComparedPoint::relative));
        let fits =
            |found: f64, stated: f64| found <= stated && stated <= MOST_SLACK * found || found == stated;
        let passed = undefined == stated.undefined
            && fits(absolute, stated.max_abs_error_mm)
            && fits(relative, stated.max_rel_error);
        HardCheck::new(
            "report-newton: as stated",
            "all points".into(),
            format!("{undefined} undefined, errors {absolute:.1e} mm and {relative:.1e}"),
            format!(
                "{} undefined, errors up to {:e} mm and {:e}, at least a quarter of that",
                stated.undefined, stated.max_abs_error_mm, stated.max_rel_error
            ),
            passed,
        )
    }

    /// Checks that s rises with |η| along every column, so that every slice of the patch is one interval.
    fn rising(&self) -> HardCheck {
        let [xi, eta] = self.case.reference.scene.axes();
        let reach = eta.iter().fold(0.0, |m: f64, v| m.max(v.abs()));
        let mut evaluator = Evaluator::new(self.placement);
        let mut worst = (0.0, String::from("all columns"));
        for &xi in &xi {
            let mut last = f64::NAN;
            for k in 0..=RISING_SAMPLES {
                let eta = reach * k as f64 / RISING_SAMPLES as f64;
                let s = evaluator.separation(xi, eta);
                if last - s > worst.0 {
                    worst = (last - s, format!("xi = {xi}, eta up to {eta}"));
                }
                last = s;
            }
        }
        let bound = PROMISED_ABSOLUTE * self.scale;
        let expected = format!("a fall of at most {bound:.1e} mm");
        HardCheck::new(
            "s rises with |eta|",
            worst.1,
            format!("a fall of {:.1e} mm", worst.0),
            expected,
            worst.0 <= bound,
        )
    }

    /// Returns the bound on s at a point.
    fn bound(&self, xi: f64, eta: f64, s: f64) -> f64 {
        if inside_contact(self.placement, xi, eta) {
            PROMISED_RELATIVE * s
        } else {
            PROMISED_ABSOLUTE * self.scale
        }
    }

    /// Checks η(ξ) of s = δ: |Δη| ≤ R/η × the bound on s, and rounding.
    fn boundary(&self) -> Option<HardCheck> {
        let mut worst: Option<(f64, HardCheck)> = None;
        for (delta, xi, value) in &self.case.reference.boundary {
            let found = Slicer::new(self.placement, *delta).slice(*xi).map(|slice| slice.eta[1]);
            let expected = value.as_deref().map(exact);
            let share = match (found, expected) {
                (Some(found), Some(eta)) if found == eta => 0.0,
                (Some(found), Some(eta)) => {
                    let radius = self.placement.rolling_radius();
                    let bound = radius / eta * self.bound(*xi, eta, *delta) + 2.0 * f64::EPSILON * eta;
                    (found - eta).abs() / bound
                }
                (None, None) => 0.0,
                _ => f64::INFINITY,
            };
            if worst.as_ref().is_none_or(|(largest, _)| share > *largest) {
                let input = format!("delta = {delta}, xi = {xi}");
                let passed = share <= 1.0;
                let (found, expected) = (format!("{found:?}"), format!("{expected:?}"));
                worst = Some((share, HardCheck::new("boundary eta(xi)", input, found, expected, passed)));
            }
        }
        worst.map(|(_, check)| check)
    }

    fn patch(&self, stated: &StatedPatch) -> Vec<HardCheck> {
        let window = stated.window;
        let patch = Patch::new(self.placement, stated.delta, &window);
        let input = format!("delta = {}, {window:?}", stated.delta);
        let (found, expected) = (patch.components.len(), stated.components.len());
        let mut checks = vec![HardCheck::new(
            "parts of the patch",
            input.clone(),
            found.to_string(),
            expected.to_string(),
            found == expected,
        )];
        for (found, expected) in patch.components.iter().zip(&stated.components) {
            let describe = |xi: String, ends: [&str; 2], cut: bool| format!("xi {xi}, {ends:?}, cut {cut}");
            let ends = found.ends.map(end_name);
            let passed = ends == expected.ends.each_ref().map(String::as_str)
                && found.cut_by_window == expected.cut_by_window
                && self.same_extent(found, expected, stated.delta);
            checks.push(HardCheck::new(
                "extent of a part",
                input.clone(),
                describe(format!("{:?}", found.xi), ends, found.cut_by_window),
                describe(
                    expected.xi.join(" … "),
                    expected.ends.each_ref().map(String::as_str),
                    expected.cut_by_window,
                ),
                passed,
            ));
        }
        checks
    }

    /// Returns whether tips agree within the bound on s over its slope there, and other ends within the
    /// rounding of abscissae.
    fn same_extent(&self, found: &Component, expected: &StatedComponent, delta: f64) -> bool {
        let profiles = [self.placement.rail().profile(), self.placement.wheel().profile()];
        let extent = profiles.map(|profile| profile.extent()).into_iter().fold(0.0, f64::max);
        let rounding = 16.0 * f64::EPSILON * extent;
        (0..2).all(|k| {
            let xi = exact(&expected.xi[k]);
            let slope = expected.slope[k].as_deref().map(exact);
            let tip = slope.map_or(0.0, |slope| self.bound(xi, 0.0, delta) / slope);
            (found.xi[k] - xi).abs() <= tip + rounding
        })
    }

    fn relation(&self, cases: &[HardCase]) -> Result<Vec<HardCheck>> {
        let Some(relation) = &self.case.relation else { return Ok(Vec::new()) };
        let base = cases.iter().find(|case| case.reference.name == relation.to).ok_or_else(|| {
            let place = format!("{}: relation", self.case.reference.name);
            Error::new(place, relation.to.clone(), "the name of a hard case", "correct it")
        })?;
        let placement = base.reference.placement()?;
        let checks = BOUNDS.iter().map(|(method, _, absolute)| {
            // Every column is computed on its own: the number of coefficients to start with does not depend on the
            // geometry.
            let choice = |case: &HardCase, placement: &Placement| Choice {
                coefficients: 1,
                ..case.choice(placement, *method)
            };
            let (my_choice, other_choice) = (choice(self.case, self.placement), choice(base, &placement));
            COLUMNS.map(|columns| {
                let mine = compare(&self.case.reference, self.placement, &my_choice, columns);
                let other = compare(&base.reference, &placement, &other_choice, columns);
                self.agreement(*method, relation.kind, &mine, &other, 2.0 * absolute * self.scale)
            })
        });
        Ok(checks.flatten().collect())
    }

    fn agreement(
        &self,
        method: Method,
        kind: RelationKind,
        mine: &[ComparedPoint],
        other: &[ComparedPoint],
        bound: f64,
    ) -> HardCheck {
        let unit = if kind == RelationKind::Scaled { self.case.unit } else { 1.0 };
        let partner = |p: &ComparedPoint| {
            let xi = if kind == RelationKind::Mirrored { -p.xi } else { p.xi / unit };
            let eta = if kind == RelationKind::EtaReversed { -p.eta } else { p.eta / unit };
            other.iter().find(|q| q.xi == xi && q.eta == eta).map(|q| q.found * unit)
        };
        let same_bits = matches!(kind, RelationKind::Scaled | RelationKind::EtaReversed);
        let agrees = |p: &ComparedPoint, other: f64| {
            p.found == other
                || p.found.is_nan() && other.is_nan()
                || !same_bits && (p.found - other).abs() <= bound
        };
        // On an axis that is not symmetric, some η have no partner.
        let pairs: Vec<_> = mine.iter().filter_map(|p| Some((p, partner(p)?))).collect();
        let wrong = pairs.iter().find(|(p, other)| !agrees(p, *other));
        HardCheck::new(
            format!("{}: {kind:?}", method.name()),
            wrong.map_or(format!("{} points", pairs.len()), |(p, _)| at(p)),
            wrong.map_or("the same".into(), |(p, _)| format!("{:e}", p.found)),
            wrong.map_or("the same".into(), |(_, other)| format!("{other:e}")),
            wrong.is_none() && !pairs.is_empty(),
        )
    }
}

fn at(point: &ComparedPoint) -> String {
    let ComparedPoint { xi, eta, .. } = point;
    format!("xi = {xi:e} (bits {:016x}), eta = {eta:e} (bits {:016x})", xi.to_bits(), eta.to_bits())
}

fn end_name(end: End) -> &'static str {
    match end {
        End::Tip => "tip",
        End::Window => "window",
        End::ProfileEnd => "profile-end",
    }
}
