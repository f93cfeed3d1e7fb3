//! Writes `contact.inp`: a deck for Vollebregt's CONTACT, module 3 (one point of contact), with the
//! undeformed distance given point by point (IBASE = 9).
//!
//! CONTACT's axes are x rolling, y lateral and z down: its (x, y, z) is our (η, ξ, −ζ). Its elements are our cells. Its
//! distances belong to their centres and run x fastest, which is our order, too. CONTACT exits with 0 even when it rejects
//! its input; only its output tells.

use super::super::block::Block;
use super::number::{Field, WIDTH};
use super::text::{Deck, Lattice, line};
use crate::load::Elastic;
use crate::numerics::bodies::Bodies;
use crate::placement::Creepages;
use std::fmt::Write as _;
use std::io::{self, Write};

/// Numbers on a line: CONTACT takes lines of up to 256 characters and 50 items; three numbers keep a line
/// under 80.
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
    /// Elastic constants of rail and wheel.
    pub material: Bodies<Elastic>,
    /// Coefficients of friction, static and kinetic, typically 0.3; they do not enter the normal problem.
    pub friction: [f64; 2],
    /// Creepages of steady rolling; `None` asks for the normal problem alone, without friction.
    pub creepages: Option<Creepages>,
}

impl ContactSettings {
    /// Returns the settings for steel on steel without motion: E = 210,000 N/mm², ν = 0.28, friction 0.3.
    pub fn steel(normal: Prescribed) -> Self {
        let material = Bodies { rail: Elastic::STEEL, wheel: Elastic::STEEL };
        Self { normal, material, friction: [0.3; 2], creepages: None }
    }
}

/// Writes `contact.inp`. Undefined distances are 10 × the largest |s|.
///
/// # Errors
/// The errors of the sink.
pub fn contact_inp(deck: &Deck<'_>, settings: &ContactSettings, sink: &mut dyn Write) -> io::Result<()> {
    let mut block = Block::new(sink);
    block.bytes(comments(deck, settings).as_bytes())?;
    block.bytes(control(&deck.lattice(), settings, DistanceSurface::Plane).as_bytes())?;
    for i in 0..deck.xi.len() {
        rows(&mut block, deck.column(i))?;
    }
    block.bytes(b" 0  MODULE\n")?;
    block.finish()
}

/// Writes numbers, [`PER_LINE`] on a line; each column of elements begins a line.
pub(super) fn rows(block: &mut Block<'_>, column: &[Field]) -> io::Result<()> {
    for run in column.chunks(PER_LINE) {
        let room = block.room(run.len() * WIDTH + 1)?;
        for (place, number) in room.chunks_exact_mut(WIDTH).zip(run) {
            place.copy_from_slice(number);
        }
        room[run.len() * WIDTH] = b'\n';
    }
    Ok(())
}

/// CONTACT's constant |Ak| of dissimilar materials below which it solves the normal and then the tangential problem, each once.
const SIMILAR: f64 = 1e-4;

/// Most rounds in which CONTACT solves the normal and the tangential problem where each acts on the other. More rounds change its
/// tractions by at most 0.2 %.
const ROUNDS: u32 = 20;

/// The surface over which CONTACT's distances are given.
#[derive(Debug, Clone, Copy)]
pub(super) enum DistanceSurface<'a> {
    /// The tangent plane.
    Plane,
    /// A surface that is curved along y, with the lines of the deck that give its inclinations.
    Curved(&'a str),
}

fn comments(deck: &Deck<'_>, settings: &ContactSettings) -> String {
    let mut lines = deck.header.statements();
    lines.push("CONTACT's axes: x = eta (rolling), y = xi (lateral), z = -zeta (down)".into());
    lines.push("h(1) ... h(MX*MY) = s at element centres, ix (eta) fastest, then iy (xi)".into());
    let undefined = deck.grid.separation().iter().filter(|s| s.is_nan()).count();
    lines.push(format!("undefined elements, filled with 10 x the largest |s|: {undefined}"));
    if settings.creepages.is_some() {
        lines.push("creepages: velocity of the rail (body 1) minus that of the wheel, over VELOC".into());
    }
    lines.iter().map(|line| format!("% {line}\n")).collect()
}

pub(super) fn control(grid: &Lattice, settings: &ContactSettings, reference: DistanceSurface<'_>) -> String {
    let (force, normal) = match settings.normal {
        Prescribed::Force(force) => (1, force),
        Prescribed::Approach(approach) => (0, approach),
    };
    let Bodies { rail: [nu_r, g_r], wheel: [nu_w, g_w] } =
        settings.material.map(|body| [body.poissons_ratio, body.shear_modulus()]);
    let ([at_rest, sliding], tangential) =
        (settings.friction, if settings.creepages.is_some() { 3 } else { 0 });
    let mut text = format!(
        " 3  MODULE\n  20{tangential}{force}00       P-B-T-N-F-S     % N = {force}: {} prescribed\n",
        if force == 1 { "normal force [N]" } else { "approach [mm]" }
    );
    // The digit C is 2 for a half-space, and 4 for a body whose surface is curved along y.
    let (influence, inclinations) = match reference {
        DistanceSurface::Plane => (2, ""),
        DistanceSurface::Curved(inclinations) => (4, inclinations),
    };
    // The digit E is 9 where the slip of every element follows the distances.
    let extra = if influence == 4 && tangential == 3 { 9 } else { 0 };
    let _ = write!(text, "  02{influence}02{extra}       L-D-C-M-Z-E\n 0002221       H-G-I-A-O-W-R\n");
    let coupled = tangential == 3 && (influence == 4 || dissimilarity(settings).abs() >= SIMILAR);
    let rounds = if coupled { ROUNDS } else { 1 };
    let _ = writeln!(text, "   999 100 30 {rounds} 1.0e-8           MAXGS MAXIN MAXNR MAXOUT EPS");
    // `{:?}` writes every f64 with a point or an exponent, in the shortest form that reads back the same.
    let normal_name = ["PEN", "FN"][force];
    match settings.creepages {
        Some(Creepages { longitudinal, lateral, spin, .. }) => {
            let _ = write!(text, "   {normal:?} {longitudinal:?} {lateral:?} {spin:?}           ");
            let _ = writeln!(text, "{normal_name} CKSI CETA CPHI");
        }
        None => {
            let _ = writeln!(text, "   {normal:?} 0.0 0.0 0.0           {normal_name}");
        }
    }
    let _ = writeln!(text, "   {at_rest:?} {sliding:?}           FSTAT FKIN");
    if let Some(Creepages { rolling_speed, forward, .. }) = settings.creepages {
        // A step of one element along the rolling direction.
        let (direction, step) = (if forward { "0.0" } else { "180.0d" }, grid.steps[1]);
        let _ = writeln!(text, "   {direction} {step:?} {rolling_speed:?}           CHI DQ VELOC");
    }
    text += inclinations;
    let _ = writeln!(text, "   {nu_r:?} {nu_w:?} {g_r:?} {g_w:?}           POISS 1,2  GG 1,2");
    text += "   3           IPOTCN\n";
    let ([n_lateral, n_rolling], [lateral, rolling], [d_lateral, d_rolling]) =
        (grid.count, grid.first, grid.steps);
    let _ = write!(text, "   {n_rolling} {n_lateral} ");
    text += line(&[rolling, lateral, d_rolling, d_lateral]).trim_end();
    text += "  MX MY XC1 YC1 DX DY\n";
    text + "   9 1           IBASE IPLAN\n"
}

/// Gives CONTACT's Ak, by which a pressure moves the surfaces tangentially against each other; 0 for equal materials.
fn dissimilarity(settings: &ContactSettings) -> f64 {
    let Bodies { rail, wheel } = settings.material;
    let mean = 2.0 / (rail.shear_modulus().recip() + wheel.shear_modulus().recip());
    let share = |body: Elastic| (1.0 - 2.0 * body.poissons_ratio) / body.shear_modulus();
    mean / 4.0 * (share(rail) - share(wheel))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::export::sample::{Sample, header};

    fn deck(sample: &Sample, normal: Prescribed) -> String {
        deck_with(sample, &ContactSettings::steel(normal))
    }

    fn deck_with(sample: &Sample, settings: &ContactSettings) -> String {
        let (header, grid) = (header(), sample.fields());
        let mut bytes = Vec::new();
        let deck = Deck::new(&header, &grid).unwrap();
        contact_inp(&deck, settings, &mut bytes).unwrap();
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
    fn a_force_is_said_and_rolling_has_its_cards() {
        let sample = Sample::new(2, 2);
        assert!(deck(&sample, Prescribed::Force(8e4)).contains("200100"));
        let creepages = Creepages {
            longitudinal: 1e-3,
            lateral: -2e-3,
            spin: 3e-4,
            turn: [-2e-3, 0.0],
            rolling_speed: 2e4,
            forward: true,
            pitch: -43.0,
        };
        let steel = ContactSettings::steel(Prescribed::Force(8e4));
        let rolling = ContactSettings { friction: [0.4, 0.3], creepages: Some(creepages), ..steel };
        let text = deck_with(&sample, &rolling);
        let lines: Vec<_> = text.lines().filter(|line| !line.starts_with('%')).map(str::trim_start).collect();
        assert!(lines[1].starts_with("203100 ") && lines[2].starts_with("022020 "), "{text}");
        assert!(lines[4].starts_with("999 100 30 1 "), "{text}");
        let soft = Elastic { poissons_ratio: 0.27, ..Elastic::STEEL };
        let soft = ContactSettings { material: Bodies { wheel: soft, ..steel.material }, ..rolling };
        assert!(deck_with(&sample, &soft).contains("   999 100 30 20 1.0e-8 "), "dissimilar materials");
        assert!(lines[5].starts_with("80000.0 0.001 -0.002 0.0003 "), "{text}");
        assert!(lines[6].starts_with("0.4 0.3 "), "{text}");
        let step = sample.fields().steps("a test").unwrap()[1];
        assert!(lines[7].starts_with(&format!("0.0 {step:?} 20000.0 ")), "{text}");
        assert!(lines[8].starts_with("0.28 0.28 "), "{text}");
        let back = ContactSettings { creepages: Some(Creepages { forward: false, ..creepages }), ..rolling };
        assert!(deck_with(&sample, &back).contains("   180.0d "));
    }
}
