//! Measures the effects of sampling, noise and the choice of curve on measured profiles: 60E1 (1:40) and
//! S1002, sampled from their drawings, read back as files, and compared with the drawings.

use std::fmt::Write as _;

use rayon::prelude::*;

use super::inclined::{RADIUS, inclined_pair};
use wheelrail::Interval;
use wheelrail::error::{Error, Result};
use wheelrail::internal::Random;
use wheelrail::load::{Elastic, curvatures, effective_modulus};
use wheelrail::measured::{self, CUTOFF_WAVELENGTH, CurveKind, Format, Options, write};
use wheelrail::patch::{Patch, Window};
use wheelrail::placement::{Body, Placement};
use wheelrail::profile::{Mark, Profile, Side, beside, standards, trace};
use wheelrail::search::{Pose, first_touch};
use wheelrail::separation::Evaluator;

/// Distances of the points \[mm\].
pub const SPACINGS: [f64; 4] = [0.1, 0.5, 1.0, 2.0];
/// Standard deviations of the noise across the profile \[µm\]; it is normal and independent from point to
/// point.
pub const NOISES: [f64; 4] = [0.0, 0.1, 1.0, 10.0];
/// Seed of the noise. It is equal for all rows of one body, so that rows of one spacing and noise differ only by their curves.
const SEED: u64 = 0x60E1_51002;

/// Approach δ of the comparison \[mm\].
const APPROACH: f64 = 0.08;
/// Load of the comparison \[N\].
const LOAD: f64 = 1e5;
/// Range of x in which rails are compared \[mm\]: the running surface. A patch on a tread never lies below the gauge
/// corner.
const RAIL_ZONE: Interval = Interval::new(-33.0, 33.0);
/// Range of x in which wheels are compared \[mm\]. A patch on a tread never lies on the flange.
const WHEEL_ZONE: Interval = Interval::new(-38.0, 50.0);
/// Distance of the marks that are compared \[mm\]; not a multiple of a spacing.
const MARKS: f64 = 0.071;
/// Least curvature \[1/mm\] by which errors of curvature are divided: that of the crown. A tread has places without
/// curvature.
const LEAST_CURVATURE: f64 = 1.0 / 300.0;
/// Share of the places whose errors are below the reported one. At a joint of a drawing the curvature jumps, and every
/// smooth curve is wrong there.
const QUANTILE: f64 = 0.95;
/// Half the number of columns and rows at which s is compared.
const GRID: i32 = 20;

/// A kind of curve through the points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CurveChoice {
    /// A spline through every point.
    Interpolation,
    /// A smoothing spline with this cut-off wavelength \[mm\].
    Smoothing(f64),
    /// A chain of arcs within the default tolerance, or 4.5 times the noise if that is more.
    Arcs,
}

/// The curves that are compared.
pub const CURVES: [CurveChoice; 5] = [
    CurveChoice::Interpolation,
    CurveChoice::Smoothing(3.0),
    CurveChoice::Smoothing(5.0),
    CurveChoice::Smoothing(10.0),
    CurveChoice::Arcs,
];

/// One row of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct MeasuredRow {
    /// Distance of the points \[mm\].
    pub spacing: f64,
    /// Standard deviation of the noise \[µm\].
    pub noise: f64,
    /// Kind of curve.
    pub curve: CurveChoice,
    /// The errors, or why there is no curve.
    pub errors: std::result::Result<MeasuredErrors, String>,
}

/// Differences of a pair of fitted profiles from the drawn one; each of the first three is the larger one of
/// rail and wheel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredErrors {
    /// 95 % quantile of the distance across the profile \[mm\].
    pub profile: f64,
    /// 95 % quantile of the error of the tangent angle \[rad\].
    pub slope: f64,
    /// 95 % quantile of the error of the curvature, relative to it or to 1/300 mm.
    pub curvature: f64,
    /// Largest error of s over the patch \[mm\], after lowering to first touch.
    pub separation: f64,
    /// Relative error of the patch's area.
    pub area: f64,
    /// Relative error of Hertz's pressure at the drawn contact point, or `None` if s is not convex there.
    pub pressure: Option<f64>,
}

impl CurveChoice {
    fn options(self, noise: f64) -> Options {
        let base = Options { mirror: Some(false), flip_z: Some(false), ..Options::default() };
        match self {
            Self::Interpolation => Options { curve: Some(CurveKind::Interpolation), ..base },
            Self::Smoothing(cutoff) => Options { cutoff_wavelength: Some(cutoff), ..base },
            Self::Arcs => {
                // Of some thousand points the farthest is three to four standard deviations off.
                let tolerance = measured::ARC_TOLERANCE.max(4.5e-3 * noise);
                Options { curve: Some(CurveKind::Arcs), arc_tolerance: Some(tolerance), ..base }
            }
        }
    }

    fn name(self) -> String {
        match self {
            Self::Interpolation => "interpolation".into(),
            Self::Smoothing(cutoff) => format!("smoothing {cutoff} mm"),
            Self::Arcs => "arcs".into(),
        }
    }
}

/// One drawn body with its marks.
struct DrawnBody {
    profile: Profile,
    side: Side,
    marks: Vec<Mark>,
    fine: Vec<Mark>,
}

impl DrawnBody {
    fn new(profile: Profile, side: Side) -> Self {
        let zone = if side == Side::Rail { RAIL_ZONE } else { WHEEL_ZONE };
        let inside = |mark: &Mark| zone.contains(mark.station.x) && mark.station.cos > 0.2;
        let marks = trace(&profile, MARKS).into_iter().filter(inside).collect();
        let fine = trace(&profile, 0.01);
        Self { profile, side, marks, fine }
    }

    /// Returns points every `spacing` mm of arc length with noise \[µm\] across.
    fn points(&self, spacing: f64, noise: f64) -> Vec<[f64; 2]> {
        let mut random = Random::new(SEED ^ self.profile.name.len() as u64);
        let mut next = 0.0;
        let mut out = Vec::new();
        for Mark { s, station, .. } in &self.fine {
            if *s >= next {
                next += spacing;
                let off = 1e-3 * noise * random.normal();
                out.push([station.x - off * station.sin, station.z + off * station.cos]);
            }
        }
        out
    }

    /// Returns the profile that the program makes of these points, written as a file and read back.
    fn fitted(&self, points: &[[f64; 2]], options: &Options) -> Result<Profile> {
        let text = write::points(points, Format::Csv, self.side, "sample");
        measured::profile("sample.csv", text.as_bytes(), self.side, options).map(|m| m.profile)
    }

    /// Returns the quantiles of the errors of distance \[mm\], angle \[rad\] and relative curvature.
    fn compare(&self, fitted: &Profile) -> [f64; 3] {
        let marks = trace(fitted, MARKS / 2.0);
        let mut hint = 0;
        let mut errors: [Vec<f64>; 3] = Default::default();
        for exact in &self.marks {
            let at = [exact.station.x, exact.station.z];
            let Some(found) = beside(&marks, at, hint) else { continue };
            hint = found.mark;
            let near = &marks[found.mark];
            // The nearest mark is up to half a step away from the foot.
            let turn = near.station.seen_from(&exact.station).angle() + (found.s - near.s) * near.curvature;
            errors[0].push(found.across.abs());
            errors[1].push(turn.abs());
            let scale = exact.curvature.abs().max(LEAST_CURVATURE);
            errors[2].push((near.curvature - exact.curvature).abs() / scale);
        }
        errors.map(|mut values| {
            values.sort_by(f64::total_cmp);
            values[(QUANTILE * (values.len() - 1) as f64) as usize]
        })
    }
}

/// The drawn pair in contact, with all data for the comparison with fitted pairs.
struct DrawnPair {
    bodies: [DrawnBody; 2],
    placement: Placement,
    window: Window,
    points: Vec<[f64; 3]>,
    area: f64,
    pressure: f64,
}

impl DrawnPair {
    fn new() -> Result<Self> {
        let rail = standards::rail("60E1")?;
        let bodies =
            [DrawnBody::new(rail, Side::Rail), DrawnBody::new(standards::wheel("S1002")?, Side::Wheel)];
        let pair = inclined_pair(&bodies[0].profile, bodies[1].profile.clone())?;
        let placement = first_touch(&pair, &Pose::new(0.0, 0.0, 0.0)?)?;
        let missing = |what: &str| Error::new("60E1 on S1002", what, "a tread contact", "report this");
        let window = Window { xi: Interval::symmetric(20.0), eta: Interval::symmetric(20.0) };
        let patch = Patch::new(&placement, APPROACH, &window);
        let extent = patch.extent().ok_or_else(|| missing("no patch"))?;
        let pressure = pressure(&placement).ok_or_else(|| missing("no ellipse"))?;
        let points = inside(&placement, &extent);
        Ok(Self { bodies, placement, window, points, area: patch.area(), pressure })
    }

    fn errors(&self, spacing: f64, noise: f64, curve: CurveChoice) -> Result<MeasuredErrors> {
        let options = curve.options(noise);
        let [rail, wheel] = &self.bodies;
        let fit = |body: &DrawnBody| body.fitted(&body.points(spacing, noise), &options);
        let (fitted_rail, fitted_wheel) = (fit(rail)?, fit(wheel)?);
        let (a, b) = (rail.compare(&fitted_rail), wheel.compare(&fitted_wheel));
        let pair = inclined_pair(&fitted_rail, fitted_wheel)?;
        let placed = pair.placed_like(&self.placement);
        let mut evaluator = Evaluator::new(&placed);
        let found: Vec<f64> =
            self.points.iter().map(|[xi, eta, _]| evaluator.separation(*xi, *eta)).collect();
        let lowest = found.iter().copied().fold(f64::INFINITY, f64::min);
        let off = found.iter().zip(&self.points).map(|(s, [.., exact])| (s - lowest - exact).abs());
        let separation = off.fold(0.0, f64::max);
        let area = Patch::new(&placed, APPROACH + lowest, &self.window).area() / self.area - 1.0;
        let at_contact = |body: &Body| body.point().station.x;
        let own = pair.placed(at_contact(self.placement.rail()), at_contact(self.placement.wheel()), 0.0)?;
        let pressure = pressure(&own).map(|pressure| pressure / self.pressure - 1.0);
        let [profile, slope, curvature] = [0, 1, 2].map(|k: usize| a[k].max(b[k]));
        Ok(MeasuredErrors { profile, slope, curvature, separation, area, pressure })
    }
}

/// Returns \[ξ, η, s\] at the points of a grid over the box that are in the patch; C is one of them.
fn inside(placement: &Placement, extent: &Window) -> Vec<[f64; 3]> {
    let mut evaluator = Evaluator::new(placement);
    let steps = || (-GRID..=GRID).map(|k| f64::from(k) / f64::from(GRID));
    let along = |share: f64, side: Interval| if share < 0.0 { -share * side.low } else { share * side.high };
    let mut points = Vec::new();
    for [a, b] in steps().flat_map(|a| steps().map(move |b| [a, b])) {
        let [xi, eta] = [along(a, extent.xi), along(b, extent.eta)];
        let s = evaluator.separation(xi, eta);
        if s <= APPROACH {
            points.push([xi, eta, s]);
        }
    }
    points
}

/// Returns Hertz's largest pressure \[N/mm²\] under the load.
fn pressure(placement: &Placement) -> Option<f64> {
    let modulus = effective_modulus(&Elastic::STEEL, &Elastic::STEEL);
    curvatures(placement).under_load(LOAD, modulus).map(|ellipse| ellipse.pressure_n_per_mm2)
}

/// Calculates all rows: these distances of the points \[mm\] × 4 noises × 5 curves, on all threads.
///
/// # Errors
/// Built-in profiles that do not touch, which is a fault of this program.
pub fn rows(spacings: &[f64]) -> Result<Vec<MeasuredRow>> {
    let reference = DrawnPair::new()?;
    let cases: Vec<(f64, f64, CurveChoice)> = spacings
        .iter()
        .flat_map(|&spacing| NOISES.map(|noise| (spacing, noise)))
        .flat_map(|(spacing, noise)| CURVES.map(|curve| (spacing, noise, curve)))
        .collect();
    let row = |&(spacing, noise, curve): &(f64, f64, CurveChoice)| {
        let errors = reference.errors(spacing, noise, curve).map_err(|error| error.to_string());
        MeasuredRow { spacing, noise, curve, errors }
    };
    Ok(cases.par_iter().map(row).collect())
}

/// Returns the section of the report.
pub fn section(rows: &[MeasuredRow]) -> String {
    let mut out = format!(
        "60E1 (1:40) under S1002, R = {RADIUS} mm, sampled from the drawings at equal arc lengths, with normal noise \
         across the profile (fixed seed), read back as files and compared with the drawings. Profile, slope and \
         curvature: 95 % quantile over the running surface, the larger of rail and wheel; curvature relative to \
         itself or to 1/300 mm. s: largest error over the patch at δ = {APPROACH} mm after lowering to first touch. \
         Pressure: Hertz, at the drawn contact point under {LOAD:e} N; \"none\" where the fitted surfaces are not \
         convex there.\n\n\
         | points every \\[mm\\] | noise \\[µm\\] | curve | profile \\[µm\\] | slope \\[mrad\\] | curvature \\[%\\] | \
         s \\[µm\\] | area \\[%\\] | pressure \\[%\\] |\n|---|---|---|---|---|---|---|---|---|\n"
    );
    for row in rows {
        let _ = write!(out, "| {} | {} | {} | ", row.spacing, row.noise, row.curve.name());
        let _ = match &row.errors {
            Ok(e) => {
                let pressure = e.pressure.map_or("none".into(), |p| format!("{:+.2}", 1e2 * p));
                let [profile, slope, curvature] = [1e3 * e.profile, 1e3 * e.slope, 1e2 * e.curvature];
                let [s, area] = [1e3 * e.separation, 1e2 * e.area];
                writeln!(
                    out,
                    "{profile:.3} | {slope:.3} | {curvature:.2} | {s:.3} | {area:+.2} | {pressure} |"
                )
            }
            Err(why) => writeln!(out, "{} | | | | | |", why.replace('|', "/")),
        };
    }
    out + &recommendation(rows)
}

/// Error of the pressure in the summary if s is not convex: 100 %.
const NO_ELLIPSE: f64 = 1.0;

/// Returns the largest errors \[of pressure, relative; of s, mm\] of a curve on rows with points up to
/// `spacing` mm apart and this noise \[µm\]; infinite if there is no curve.
pub fn worst(rows: &[MeasuredRow], curve: CurveChoice, spacing: f64, noise: f64) -> [f64; 2] {
    let counted = rows.iter().filter(|r| r.curve == curve && r.spacing <= spacing && r.noise == noise);
    counted.fold([0.0f64; 2], |[pressure, s], row| match &row.errors {
        Ok(e) => [pressure.max(e.pressure.map_or(NO_ELLIPSE, f64::abs)), s.max(e.separation)],
        Err(_) => [f64::INFINITY; 2],
    })
}

fn recommendation(rows: &[MeasuredRow]) -> String {
    let mut out = String::from(
        "\nThe largest errors with points up to 1 mm apart, pressure \\[%\\] (100: none) / s \\[µm\\]:\n\n| curve |",
    );
    for noise in NOISES {
        let _ = write!(out, " noise {noise} µm |");
    }
    out += "\n|---|---|---|---|---|\n";
    for curve in CURVES {
        let _ = write!(out, "| {} |", curve.name());
        for noise in NOISES {
            let [pressure, s] = worst(rows, curve, 1.0, noise);
            let _ = write!(out, " {:.1} / {:.1} |", 1e2 * pressure, 1e3 * s);
        }
        out.push('\n');
    }
    let _ = writeln!(
        out,
        "\nRecommended, and the longest default: smoothing with a cut-off wavelength of {CUTOFF_WAVELENGTH} mm. Over points up to \
         1 mm apart with up to 1 µm of noise no other curve has a smaller largest error of s. At 1 mm and 1 µm its \
         pressure is worse than that of 10 mm, which costs a larger error of s and of the profile on every such row. \
         With less than 1 µm of noise, or points every 0.1 mm, 3 mm is better in most columns. With 10 µm of noise take \
         10 mm and points every 0.5 mm or closer. Interpolation is for points without noise. Every row is one draw of \
         the noise: errors that noise dominates are examples, not bounds."
    );
    out
}
