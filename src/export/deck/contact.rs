//! Writes `contact.inp`: a deck for Vollebregt's CONTACT, module 3 (one point of contact), with the
//! undeformed distance given point by point (IBASE = 9).
//!
//! CONTACT's axes are x rolling, y lateral and z down: its (x, y, z) is our (η, ξ, −ζ). Its elements are our cells. Its
//! distances belong to their centres and run x fastest, which is our order, too. CONTACT exits with 0 even when it rejects
//! its input; only its output tells.

use super::super::block::Block;
use super::number::WIDTH;
use super::text::{Deck, line};
use std::fmt::Write as _;
use std::io::{self, Write};

/// Largest number of elements that CONTACT takes (NPOT_MAX); beyond it CONTACT coarsens the grid.
pub const ELEMENT_LIMIT: usize = 20_000;

/// Numbers on a line. CONTACT takes lines of up to 256 characters and 50 items; with three numbers a line stays under 80
/// characters.
const PER_LINE: usize = 3;

/// The quantity prescribed along the normal.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Prescribed {
    /// Total normal force \[N\], > 0.
    Force(f64),
    /// Approach δ \[mm\], > 0.
    Approach(f64),
}

/// The data that CONTACT needs besides the geometry.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSettings {
    /// Prescribed force or approach.
    pub normal: Prescribed,
    /// Poisson's ratios of rail and wheel, typically 0.28.
    pub poisson: [f64; 2],
    /// Shear moduli of rail and wheel \[N/mm²\], typically 82,000.
    pub shear_modulus: [f64; 2],
    /// Coefficient of friction, static and kinetic, typically 0.3. It has no influence on the normal problem.
    pub friction: f64,
}

impl ContactSettings {
    /// Returns the settings for steel on steel: E = 210,000 N/mm², ν = 0.28, friction 0.3.
    pub fn steel(normal: Prescribed) -> Self {
        let shear = 210_000.0 / (2.0 * (1.0 + 0.28));
        Self { normal, poisson: [0.28; 2], shear_modulus: [shear; 2], friction: 0.3 }
    }
}

/// Writes `contact.inp`. Undefined distances are 10 × the largest |s|.
///
/// # Errors
/// The errors of the sink.
pub fn contact_inp(deck: &Deck<'_>, settings: &ContactSettings, sink: &mut dyn Write) -> io::Result<()> {
    let mut block = Block::new(sink);
    block.bytes(comments(deck).as_bytes())?;
    block.bytes(control(deck, settings).as_bytes())?;
    for i in 0..deck.xi.len() {
        for run in deck.column(i).chunks(PER_LINE) {
            let room = block.room(run.len() * WIDTH + 1)?;
            for (place, number) in room.chunks_exact_mut(WIDTH).zip(run) {
                place.copy_from_slice(number);
            }
            room[run.len() * WIDTH] = b'\n';
        }
    }
    block.bytes(b" 0  MODULE\n")?;
    block.finish()
}

fn comments(deck: &Deck<'_>) -> String {
    let mut lines = deck.header.statements();
    lines.push("CONTACT's axes: x = eta (rolling), y = xi (lateral), z = -zeta (down)".into());
    lines.push("h(1) ... h(MX*MY) = s at element centres, ix (eta) fastest, then iy (xi)".into());
    let undefined = deck.grid.separation().iter().filter(|s| s.is_nan()).count();
    lines.push(format!("undefined elements, filled with 10 x the largest |s|: {undefined}"));
    let count = deck.separation.len();
    if count > ELEMENT_LIMIT {
        lines.push(format!("{count} elements: above CONTACT's default NPOT_MAX = {ELEMENT_LIMIT},"));
        lines.push("beyond which it coarsens the grid; use a coarser one or raise NPOT_MAX".into());
    }
    lines.iter().map(|line| format!("% {line}\n")).collect()
}

fn control(deck: &Deck<'_>, settings: &ContactSettings) -> String {
    let (force, normal) = match settings.normal {
        Prescribed::Force(force) => (1, force),
        Prescribed::Approach(approach) => (0, approach),
    };
    let ([nu_r, nu_w], [g_r, g_w]) = (settings.poisson, settings.shear_modulus);
    let mut text = format!(
        " 3  MODULE\n  200{force}00       P-B-T-N-F-S     % N = {force}: {} prescribed\n",
        if force == 1 { "normal force [N]" } else { "approach [mm]" }
    );
    text += "  022020       L-D-C-M-Z-E\n 0002221       H-G-I-A-O-W-R\n";
    text += "   999 100 30 1 1.0e-8           MAXGS MAXIN MAXNR MAXOUT EPS\n";
    // `{:?}` writes every f64 with a point or an exponent, in the shortest form that reads back as the same number.
    let _ = writeln!(text, "   {normal:?} 0.0 0.0 0.0           {}", ["PEN", "FN"][force]);
    let _ = writeln!(text, "   {0:?} {0:?}           FSTAT FKIN", settings.friction);
    let _ = writeln!(text, "   {nu_r:?} {nu_w:?} {g_r:?} {g_w:?}           POISS 1,2  GG 1,2");
    text += "   3           IPOTCN\n";
    let _ = write!(text, "   {} {} ", deck.eta.len(), deck.xi.len());
    text += line(&[deck.grid.eta()[0], deck.grid.xi()[0], deck.steps[1], deck.steps[0]]).trim_end();
    text += "  MX MY XC1 YC1 DX DY\n";
    text + "   9 1           IBASE IPLAN\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{Sample, header};

    fn deck(sample: &Sample, normal: Prescribed) -> String {
        let (header, grid) = (header(), sample.fields());
        let mut bytes = Vec::new();
        let deck = Deck::new(&header, &grid).unwrap();
        contact_inp(&deck, &ContactSettings::steel(normal), &mut bytes).unwrap();
        String::from_utf8(bytes).unwrap()
    }

    #[test]
    fn lines_stand_in_contacts_order() {
        let sample = Sample::new(3, 4);
        let text = deck(&sample, Prescribed::Approach(0.05));
        let lines: Vec<_> = text.lines().filter(|line| !line.starts_with('%')).collect();
        let begins = |k: usize, words: &str| {
            assert!(lines[k].trim_start().starts_with(words), "line {k}: {}", lines[k]);
        };
        begins(0, "3 ");
        begins(1, "200000");
        begins(5, "0.05 0.0 0.0 0.0");
        begins(7, "0.28 0.28 82031.25 82031.25");
        begins(8, "3 ");
        begins(9, "4 3 ");
        begins(10, "9 1");
        let h: Vec<f64> = lines[11..lines.len() - 1]
            .iter()
            .flat_map(|line| line.split_whitespace())
            .map(|word| word.parse().unwrap())
            .collect();
        assert_eq!(h[1..], sample.separation[1..]);
        assert_eq!(h[0], sample.fields().fill_value());
        assert_eq!(lines[lines.len() - 1], " 0  MODULE");
        assert!(text.lines().all(|line| line.len() <= 256), "{text}");
    }

    #[test]
    fn force_and_size_are_said() {
        assert!(deck(&Sample::new(2, 2), Prescribed::Force(8e4)).contains("200100"));
        assert!(deck(&Sample::new(201, 101), Prescribed::Force(8e4)).contains("above CONTACT's default"));
        assert!(!deck(&Sample::new(20, 10), Prescribed::Force(8e4)).contains("above CONTACT's default"));
    }
}
