//! MIDSEP (Report Sec. 5): transformed parameters α, β, ξ_i and the midplane separation at equal steps of ξ.

use std::fmt::Write;

use super::gap::midplane_gap;
use crate::placement::{Body, Placement};
use crate::profile::{Shape, Station};

/// The parameters α, β and ξ_i of one segment in the contact frame, (4.6)–(4.8).
#[derive(Debug, Clone, PartialEq)]
pub struct Transformed {
    /// Name of the segment in the drawing, or empty.
    pub label: String,
    /// "line", "arc" or "polynomial".
    pub kind: &'static str,
    /// α and β: the centre of an arc \[mm\], or slope and intercept of a line \[1, mm\]; `None` for a polynomial.
    pub alpha_beta: Option<[f64; 2]>,
    /// Signed radius of an arc \[mm\], positive where the hollow side is up; `None` for other segments.
    pub radius: Option<f64>,
    /// ξ of the two ends \[mm\].
    pub xi: [f64; 2],
}

/// One row of the midplane table: the heights and the gap at one ξ.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MidplaneRow {
    /// ξ \[mm\].
    pub xi: f64,
    /// ζ^R \[mm\]; NaN off the rail.
    pub rail: f64,
    /// ζ^W at η = 0 \[mm\]; NaN off the wheel.
    pub wheel: f64,
    /// Δζ = ζ^W − ζ^R \[mm\]; NaN off either body.
    pub gap: f64,
}

/// Computes the transformed parameters of every segment: RAIL0 and WHEEL0 of the Report.
pub fn transformed_parameters(body: &Body) -> Vec<Transformed> {
    let frame = &body.section.frame;
    body.profile()
        .segments()
        .iter()
        .map(|segment| {
            let (start, end) = (segment.start().seen_from(frame), segment.end().seen_from(frame));
            let (kind, alpha_beta, radius) = match &segment.shape {
                Shape::Arc(arc) => match arc.centre() {
                    Some([x, z]) => {
                        let centre = Station { x, z, cos: 1.0, sin: 0.0 }.seen_from(frame);
                        ("arc", Some([centre.x, centre.z]), Some(arc.radius))
                    }
                    None => {
                        let slope = start.sin / start.cos;
                        ("line", Some([slope, start.z - slope * start.x]), None)
                    }
                },
                Shape::Polynomial(_) => ("polynomial", None, None),
            };
            Transformed { label: segment.label.clone(), kind, alpha_beta, radius, xi: [start.x, end.x] }
        })
        .collect()
}

/// Computes the midplane table at these ξ \[mm\].
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::separation::{midplane_rows, transformed_parameters};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let row = midplane_rows(&placement, &[2.0])[0];
/// assert!((row.gap - (300.0 - f64::sqrt(300.0 * 300.0 - 2.0 * 2.0))).abs() < 1e-13);
/// assert_eq!(transformed_parameters(placement.rail())[0].alpha_beta, Some([0.0, -300.0]));
/// # Ok::<(), wheelrail::Error>(())
/// ```
pub fn midplane_rows(placement: &Placement, xi: &[f64]) -> Vec<MidplaneRow> {
    let row = |&xi: &f64| MidplaneRow {
        xi,
        rail: placement.rail().section.height(xi),
        wheel: placement.wheel().section.height(xi),
        gap: midplane_gap(placement, xi),
    };
    xi.iter().map(row).collect()
}

/// Returns the table of MIDSEP as readable text: transformed parameters of both bodies, then the midplane.
pub fn midplane_table(placement: &Placement, xi: &[f64]) -> String {
    let mut out = String::from("# MIDSEP: midplane separation, Report FRA/ORD-78/41, Sec. 5\n");
    out += "# Lengths in mm, angles in rad; contact frame: origin C, xi along the tangent, zeta from rail to wheel.\n";
    for (name, body) in [("rail", placement.rail()), ("wheel", placement.wheel())] {
        parameters(&mut out, name, body);
    }
    out += "\n# midplane, eta = 0\n";
    let _ = writeln!(out, "# {:>22} {:>24} {:>24} {:>24}", "xi", "zeta_rail", "zeta_wheel", "separation");
    for row in midplane_rows(placement, xi) {
        let _ =
            writeln!(out, "{:24.16e} {:24.16e} {:24.16e} {:24.16e}", row.xi, row.rail, row.wheel, row.gap);
    }
    out
}

fn parameters(out: &mut String, name: &str, body: &Body) {
    let (point, angle) = (&body.point.station, body.contact_angle());
    let _ = writeln!(out, "\n# {name}: {}", body.profile().name);
    let _ = writeln!(out, "# C: x = {} z = {} theta_C = {angle}", point.x, point.z);
    let header =
        format!("{:>24} {:>24} {:>24} {:>24} {:>24}", "alpha", "beta", "radius", "xi_start", "xi_end");
    let _ = writeln!(out, "# {:<10} {:<10} {header}", "segment", "kind");
    for (index, t) in transformed_parameters(body).iter().enumerate() {
        let label = if t.label.is_empty() { (index + 1).to_string() } else { t.label.replace(' ', "_") };
        let field =
            |value: Option<f64>| value.map_or_else(|| format!("{:>24}", "-"), |v| format!("{v:24.16e}"));
        let [alpha, beta] = [0, 1].map(|k| field(t.alpha_beta.map(|ab| ab[k])));
        let (radius, start, end) = (field(t.radius), field(Some(t.xi[0])), field(Some(t.xi[1])));
        let _ = writeln!(out, "{label:<12} {:<10} {alpha} {beta} {radius} {start} {end}", t.kind);
    }
}
