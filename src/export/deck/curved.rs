//! Writes the decks over the rail's surface: `conform.wrp` with a curved reference, and `contact.inp` in CONTACT's conformal
//! form.
//!
//! ```text
//! CONFCURV   1 mm                            (a8,i4,1x,a8)   magic, version, unit
//!       20                                   (i8)            comment lines that follow
//! # …
//!      128      96                           (2i8)           n_sigma n_eta
//! sigma0 eta0                                (2e25.16)       centre of the first cell
//! dsigma deta                                (2e25.16)
//! delta                                      (e25.16)
//! origin, xi axis, eta axis, normal          4 × (3e25.16)   contact frame in rail profile axes (x, y, z)
//! sigma xi zeta                              (3e25.16)       for each sigma: the rail's point, then a second line
//! alpha n_xi n_zeta                          (3e25.16)       with its angle and outward unit normal
//! m sigma eta t                              (i2,3e25.16)    n_sigma·n_eta records, eta fastest; m = 1 defined
//!   n_xi n_eta n_zeta                        (2x,3e25.16)    second line: outward unit normal of the wheel
//! END
//! ```
//!
//! If m = 0, the number in the column of t is 10 × the largest |t|, and the normal is 0 0 0.

use super::super::block::Block;
use super::super::curved::CurvedFields;
use super::super::model::{Header, even_step, known};
use super::contact::{ContactSettings, DistanceSurface, Prescribed, control, rows};
use super::number::{WIDTH, field};
use super::text::{Lattice, line};
use super::wrp::head;
use crate::error::Result;
use crate::placement::Creepages;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Most inclinations that CONTACT takes.
const MOST_INCLINATIONS: usize = 9999;

const NOTES: [&str; 8] = [
    "the reference is the rail's surface, by its arc length sigma from C:",
    "then n_sigma n_eta; first cell's centre; d_sigma d_eta; delta; frame's",
    "origin, xi, eta, zeta axes in rail profile axes x (lateral), y, z (up);",
    "for each sigma two lines (3e25.16): sigma xi zeta / alpha n_xi n_zeta;",
    "records (i2,3e25.16): m sigma eta t; m = 0: undefined, t is a filler;",
    "second line (2x,3e25.16): outward unit normal of the wheel, xi eta zeta",
    "t: gap along the rail's outward normal (-sin alpha, 0, cos alpha); delta",
    "closes delta cos(alpha) of it: the patch is t < delta cos(alpha)",
];

/// The normal gap with equal steps of σ and η.
pub struct CurvedDeck<'a> {
    header: &'a Header,
    fields: &'a CurvedFields<'a>,
    /// Steps \[d_σ, d_η\] \[mm\].
    steps: [f64; 2],
}

impl<'a> CurvedDeck<'a> {
    /// Checks the steps of a grid.
    ///
    /// # Errors
    /// A grid of unequal steps, or of one row or column, because decks state a grid by its first point and its steps.
    pub fn new(header: &'a Header, fields: &'a CurvedFields<'a>) -> Result<Self> {
        let format = "the text decks";
        let steps =
            [even_step(format, "xi", fields.sigma())?, even_step(format, "eta", fields.grid().eta())?];
        Ok(Self { header, fields, steps })
    }

    fn first(&self) -> [f64; 2] {
        [self.fields.sigma()[0], self.fields.grid().eta()[0]]
    }
}

/// Writes `conform.wrp` with a curved reference.
///
/// # Errors
/// The errors of the sink.
pub fn conform_curved_wrp(deck: &CurvedDeck<'_>, sink: &mut dyn Write) -> io::Result<()> {
    let (fields, grid) = (deck.fields, deck.fields.grid());
    let mut block = Block::new(sink);
    let count = [fields.sigma().len(), grid.eta().len()];
    let lattice = Lattice { count, first: deck.first(), steps: deck.steps };
    let notes = NOTES.iter().map(|note| (*note).to_string());
    let comments = deck.header.statements().into_iter().chain(notes).collect::<Vec<_>>();
    block.bytes(head(deck.header, "CONFCURV", &comments, &lattice).as_bytes())?;
    for (i, &sigma) in fields.sigma().iter().enumerate() {
        let [n_xi, n_zeta] = fields.normal(i);
        block.bytes(line(&[sigma, grid.xi()[i], grid.rail_height()[i]]).as_bytes())?;
        block.bytes(line(&[fields.angle(i), n_xi, n_zeta]).as_bytes())?;
    }
    let fill = grid.fill_value();
    for (i, &sigma) in fields.sigma().iter().enumerate() {
        let column = grid.column(i).iter().zip(grid.eta()).zip(fields.wheel_normals(i));
        for ((&t, &eta), normal) in column {
            let record = [sigma, eta, if t.is_nan() { fill } else { t }];
            block.bytes(if t.is_nan() { b" 0" } else { b" 1" })?;
            block.bytes(line(&record).as_bytes())?;
            block.bytes(b"  ")?;
            block.bytes(line(&normal.map(known)).as_bytes())?;
        }
    }
    block.bytes(b"END\n")?;
    block.finish()
}

/// Writes `contact.inp` in the conformal form: C = 4 with the surface's inclinations, and distances along its normal.
///
/// CONTACT's PEN is one number for all elements, but a rigid approach closes δ cos α, which varies: it is subtracted from the
/// distances here, and PEN is 0. So the approach is prescribed, also where it was estimated from a load. CONTACT's
/// inclinations turn about x = η from y to z (down), so that they are −α.
///
/// With creepages E = 9: CKSI, CETA and CPHI hold the slip that is linear from C, and a line for each element adds what the
/// curved surface has beyond it, so that the sum is the exact slip at the element's centre.
///
/// # Errors
/// The errors of the sink.
pub fn contact_curved_inp(
    deck: &CurvedDeck<'_>,
    settings: &ContactSettings,
    sink: &mut dyn Write,
) -> io::Result<()> {
    let (fields, grid, delta) = (deck.fields, deck.fields.grid(), deck.header.approach);
    let mut lines = deck.header.statements();
    lines.extend(
        [
            "conformal form: the reference is the rail's surface, by its arc length",
            "sigma from C. CONTACT's axes: x = eta (rolling), y = sigma, z into the rail",
            "ALPHA = -alpha: CONTACT's z points down",
            "h(1) ... h(MX*MY) = t - delta cos(alpha), t the gap along the rail's normal,",
            "ix (eta) fastest, then iy (sigma); PEN = 0, as the approach is in h",
        ]
        .map(String::from),
    );
    if settings.creepages.is_some() {
        lines.push("creepages: velocity of the rail (body 1) minus that of the wheel, over VELOC".into());
        lines.push("EXRHS (last lines, x y) adds what the turning surface slips beyond them".into());
    }
    let undefined = grid.separation().iter().filter(|t| t.is_nan()).count();
    lines.push(format!("undefined elements, filled with 10 x the largest |t|: {undefined}"));
    if let Prescribed::Force(force) = settings.normal {
        lines.push(format!("the approach is an estimate for the normal force {force:?} N"));
    }
    let mut block = Block::new(sink);
    for line in lines {
        block.bytes(format!("% {line}\n").as_bytes())?;
    }
    let mut inclinations = String::new();
    let thinned = fields.sigma().len().div_ceil(MOST_INCLINATIONS).max(1);
    let kept: Vec<usize> = (0..fields.sigma().len()).step_by(thinned).collect();
    // Writing to a String cannot fail.
    let _ = writeln!(inclinations, "   1 4 {}           IF_METH VARIANT NN", kept.len());
    for &i in &kept {
        let [y, alpha] = [fields.sigma()[i], -fields.angle(i)].map(field);
        inclinations.extend(y.into_iter().chain(alpha).map(char::from));
        inclinations.push('\n');
    }
    let settings = ContactSettings { normal: Prescribed::Approach(0.0), ..*settings };
    let count = [fields.sigma().len(), grid.eta().len()];
    let lattice = Lattice { count, first: deck.first(), steps: deck.steps };
    let reference = DistanceSurface::Curved(&inclinations);
    block.bytes(control(&lattice, &settings, reference).as_bytes())?;
    let fill = grid.fill_value();
    for i in 0..fields.sigma().len() {
        let closed = delta * fields.normal(i)[1];
        let number = |&t: &f64| field(if t.is_nan() { fill } else { t - closed });
        let column: Vec<[u8; WIDTH]> = grid.column(i).iter().map(number).collect();
        rows(&mut block, &column)?;
    }
    if let Some(creepages) = &settings.creepages {
        slips(&mut block, deck, creepages)?;
    }
    block.bytes(b" 0  MODULE\n")?;
    block.finish()
}

/// Share of a step by which CONTACT shifts the lever of the spin in rolling.
const SPIN_SHIFT: f64 = 1.0 / 6.0;

/// Writes the extra slip (x, y) of every element in the order of the distances: the slip on the rail's surface there minus
/// CONTACT's own, CKSI − CPHI y and CETA + CPHI (x ± DQ/6).
fn slips(block: &mut Block<'_>, deck: &CurvedDeck<'_>, creepages: &Creepages) -> io::Result<()> {
    let (fields, grid) = (deck.fields, deck.fields.grid());
    let Creepages { longitudinal, lateral, spin, forward, .. } = *creepages;
    let shift = if forward { SPIN_SHIFT } else { -SPIN_SHIFT } * deck.steps[1];
    for (i, &sigma) in fields.sigma().iter().enumerate() {
        for &eta in grid.eta() {
            let [x, y] = creepages.slip_at([grid.xi()[i], eta, grid.rail_height()[i]], fields.normal(i));
            let linear = [longitudinal - spin * sigma, lateral + spin * (eta + shift)];
            rows(block, &[x - linear[0], y - linear[1]].map(known).map(field))?;
        }
    }
    Ok(())
}
