//! The facts of a contact, each listed once: the table of a run, its page and `summary.json` read this list.

use super::contact::EllipseUnder;
use super::pressure::EdgeOnRail;
use super::run::Part;
use crate::load::Ellipse;
use crate::numerics::interval::Interval;
use crate::patch::Patch;

/// One fact of a contact.
pub struct Fact {
    /// What it is, in words.
    pub label: &'static str,
    /// Unit of the text; empty without one.
    pub unit: &'static str,
    said: Said,
}

/// How a fact is written: as a number with its keys, or as text.
enum Said {
    Number(FactNumber),
    /// A number that is not shown where it is 0.
    Unless0(FactNumber),
    /// A text; `None` where there is nothing to say.
    Text(fn(&Part) -> Option<String>),
}

/// A number of `summary.json`.
struct FactNumber {
    /// Where it stands there: keys with their unit, the outermost first.
    keys: &'static [&'static str],
    /// The number in that unit; `None` where there is none.
    value: fn(&Part) -> Option<f64>,
    /// Factor from that unit to the one of the text, and decimals there.
    shown: (f64, usize),
}

const DEGREES: f64 = 180.0 / std::f64::consts::PI;
const KILO: f64 = 1e-3;
const MILLI: f64 = 1e3;

/// The facts of a contact, in the order in which they are shown.
pub const FACTS: [Fact; 28] = [
    number("C on the rail, x", "mm", &["rail", "contact_x_mm"], (1.0, 3), |part| {
        Some(part.site.contact.placement.rail().point().station.x)
    }),
    number("C on the wheel, x", "mm", &["wheel", "contact_x_mm"], (1.0, 3), |part| {
        Some(part.site.contact.placement.wheel().point().station.x)
    }),
    number("contact angle", "degrees", &["rail", "contact_angle_rad"], (DEGREES, 3), |part| {
        Some(part.site.contact.placement.rail().contact_angle())
    }),
    number("rolling radius", "mm", &["rolling_radius_mm"], (1.0, 3), |part| {
        Some(part.site.contact.placement.rolling_radius())
    }),
    unless_0("contact pitch", "mrad", &["contact_pitch_rad"], (MILLI, 3), |part| {
        // 0 without a sign.
        Some(0.0 - part.site.contact.placement.turn())
    }),
    unless_0("skew", "mrad", &["skew_rad"], (MILLI, 3), |part| Some(part.site.contact.placement.skew())),
    number("approach", "mm", &["approach_mm"], (1.0, 5), |part| part.site.contact.approach),
    text("approach is", |part| {
        part.site.contact.approach?;
        Some(if part.site.contact.is_loaded() { "est. by half-space" } else { "given" }.into())
    }),
    number("normal force", "kN", &["normal_load_n"], (KILO, 3), |part| part.site.normal_load),
    number("its vertical part", "kN", &["vertical_load_n"], (KILO, 3), |part| part.site.vertical_load()),
    number("largest pressure", "N/mm²", &["pressure", "largest_n_per_mm2"], (1.0, 0), |part| {
        let found = part.analysis.pressure.as_ref()?;
        Some(found.largest.pressure_n_per_mm2).filter(|_| found.unbounded.is_none())
    }),
    text("largest pressure", |part| {
        part.analysis.pressure.as_ref()?.unbounded.as_ref().map(EdgeOnRail::said)
    }),
    number("its estimated error", "N/mm²", &["pressure", "largest_error_n_per_mm2"], (1.0, 0), |part| {
        Some(part.analysis.pressure.as_ref()?.largest_error).filter(|error| error.is_finite())
    }),
    Fact {
        unit: "mm",
        ..text("its place, ξ, η", |part| {
            let [xi, eta] = part.analysis.pressure.as_ref()?.largest.at_mm;
            // −0.00 is 0.00.
            let [xi, eta] = [xi, eta].map(|at| (100.0 * at).round() / 100.0 + 0.0);
            Some(format!("{xi:.2}, {eta:.2}"))
        })
    },
    number("true contact area", "mm²", &["pressure", "contact_area_mm2"], (1.0, 1), |part| {
        Some(part.analysis.pressure.as_ref()?.contact_area)
    }),
    number("Hertz's pressure", "N/mm²", &["hertz_ellipse", "pressure_n_per_mm2"], (1.0, 0), |part| {
        part.hertz_pressure()
    }),
    Fact {
        unit: "mm",
        ..text("Hertz's semi-axes", |part| {
            let Ellipse { a_mm, b_mm, .. } = hertz(part)?;
            Some(format!("{a_mm:.3}, {b_mm:.3}"))
        })
    },
    // Under a load it is the normal force.
    Fact {
        unit: "kN",
        ..text("Hertz's force", |part| {
            let of_approach = part.site.contact.ellipse_under == Some(EllipseUnder::Approach);
            hertz(part).filter(|_| of_approach).map(|ellipse| format!("{:.3}", KILO * ellipse.load_n))
        })
    },
    // The area of no part is −0, which + 0 makes 0.
    number("patch: area", "mm²", &["patch", "area_mm2"], (1.0, 2), |part| Some(patch(part)?.area() + 0.0)),
    Fact {
        unit: "mm",
        ..text("patch: extent, ξ × η", |part| {
            let extent = patch(part)?.extent()?;
            let [xi, eta] = [extent.xi, extent.eta].map(Interval::width);
            Some(format!("{xi:.3} × {eta:.3}"))
        })
    },
    text("patch: parts", |part| {
        Some(patch(part)?.components.len()).filter(|count| *count != 1).map(|count| count.to_string())
    }),
    number("conformal patch: area", "mm²", &["conformal", "patch", "area_mm2"], (1.0, 2), |part| {
        Some(conformal_patch(part)?.area() + 0.0)
    }),
    Fact {
        unit: "degrees",
        ..text("its normal turns", |part| {
            let turns = part.analysis.conformal.as_ref()?.angles.iter().map(|angle| angle.width());
            Some(format!("{:.2}", turns.reduce(f64::max)?.to_degrees()))
        })
    },
    text("feasible", |part| {
        let feasible = part.site.contact.feasibility.feasible;
        let first = part.site.contact.found.as_ref().is_none_or(|found| found.contact == 1);
        first.then(|| if feasible { "yes" } else { "no" }.into())
    }),
    text("grid, ξ × η", |part| part.site.grid.sigma.is_none().then(|| points(part))),
    text("grid, σ × η", |part| part.site.grid.sigma.is_some().then(|| points(part))),
    text("method", |part| Some(part.analysis.plan.choice.method.name().into())),
    Fact { unit: "mm", ..text("error of s up to", |part| Some(format!("{:.1e}", part.analysis.plan.error))) },
];

const fn number(
    label: &'static str,
    unit: &'static str,
    keys: &'static [&'static str],
    shown: (f64, usize),
    value: fn(&Part) -> Option<f64>,
) -> Fact {
    Fact { label, unit, said: Said::Number(FactNumber { keys, value, shown }) }
}

const fn unless_0(
    label: &'static str,
    unit: &'static str,
    keys: &'static [&'static str],
    shown: (f64, usize),
    value: fn(&Part) -> Option<f64>,
) -> Fact {
    Fact { label, unit, said: Said::Unless0(FactNumber { keys, value, shown }) }
}

const fn text(label: &'static str, of: fn(&Part) -> Option<String>) -> Fact {
    Fact { label, unit: "", said: Said::Text(of) }
}

impl Fact {
    /// Gives the fact as text without its unit; `None` where the contact does not have it.
    pub fn text(&self, part: &Part) -> Option<String> {
        match &self.said {
            Said::Number(number) => number.text(part),
            Said::Unless0(number) => number.text(part).filter(|_| (number.value)(part) != Some(0.0)),
            Said::Text(of) => of(part),
        }
    }

    /// Gives the keys under which `summary.json` has the number, the outermost first, and the number in the unit that the last
    /// key names; `None` for a text.
    pub fn number(&self, part: &Part) -> Option<(&'static [&'static str], Option<f64>)> {
        match &self.said {
            Said::Number(number) | Said::Unless0(number) => Some((number.keys, (number.value)(part))),
            Said::Text(_) => None,
        }
    }
}

impl FactNumber {
    fn text(&self, part: &Part) -> Option<String> {
        let (factor, decimals) = self.shown;
        (self.value)(part).map(|value| format!("{:.decimals$}", factor * value))
    }
}

fn patch(part: &Part) -> Option<&Patch> {
    part.analysis.patch.as_ref()
}

/// Gives the patch over the rail's surface; `None` for a grid over the plane and without an approach.
fn conformal_patch(part: &Part) -> Option<&Patch> {
    part.analysis.conformal.as_ref()?.patch.as_ref()
}

/// Gives Hertz's ellipse; `None` without one, and where pressures were solved: Hertz's is then not that of the contact.
fn hertz(part: &Part) -> Option<Ellipse> {
    part.site.contact.ellipse.filter(|_| part.hertz_pressure().is_some())
}

fn points(part: &Part) -> String {
    format!("{} × {}", part.site.grid.xi.len(), part.site.grid.eta.len())
}
