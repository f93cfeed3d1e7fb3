//! The normal gap against brute force in space, on random placed pairs: lowered wheels, chosen points, measured profiles, and
//! profiles that nobody has.
//!
//! `WHEELRAIL_RAYS=1500 cargo test first_entry -- --nocapture` is the long run over lines.

mod fill;
pub mod oracle;
pub mod placements;

use fill::Filled;
use oracle::{Line, Revolved};
use placements::{KINDS, Placed, Stock};
use rayon::prelude::*;
use wheelrail::Interval;
use wheelrail::conformal::{NormalGap, fill_normal_gap};
use wheelrail::internal::Random;
use wheelrail::separation::{EtaAxis, FULL_PRECISION};
use wheelrail::{Component, Patch, Window};

/// Seeds of every kind of pair in one ordinary test run.
const SEEDS: u64 = 50;

/// Largest difference of t \[mm\] from brute force.
const DIFFERENCE: f64 = 1e-9;

/// Number of columns of a grid, and of their points. Every third point is compared.
const COLUMNS: u32 = 12;
const POINTS: u32 = 40;
const EVERY: usize = 3;

/// Times by which a line is followed more finely where t disagrees: a corner of the wheel may lie within one step.
const FINER: f64 = 100.0;

/// Seeds of every kind of pair whose patches are compared.
const PATCH_SEEDS: u64 = 8;

/// Number of points of a flood fill on an axis.
const CELLS: usize = 300;

/// Largest relative difference of the area, and of the sides of the box.
const AREA: f64 = 1e-3;
const EXTENT: f64 = 0.02;

/// What was compared.
#[derive(Default)]
struct Tally {
    placements: usize,
    points: usize,
    hits: usize,
    negative: usize,
    wrong: Vec<String>,
}

impl Tally {
    fn of(placed: &Placed, dice: &mut Random) -> Self {
        let gap = NormalGap::new(&placed.placement);
        let wheel = Revolved::new(&placed.placement);
        let [low, high] = gap.rail().reach().expect("a rail's surface at C").ends();
        // Half the columns are near C, where patches are.
        let mut sigma: Vec<f64> = (0..COLUMNS)
            .map(|k| if k % 2 == 0 { [low, high] } else { [low.max(-12.0), high.min(12.0)] })
            .map(|[a, b]| dice.between(a, b))
            .collect();
        sigma.sort_by(f64::total_cmp);
        let half = 10f64.powf(dice.between(-0.5, 1.5));
        let centre = if dice.below(2) == 0 { 0.0 } else { dice.between(-half, half) };
        let share = |k: u32| 2.0 * f64::from(k) / f64::from(POINTS - 1) - 1.0;
        let eta: Vec<f64> = (0..POINTS).map(|k| centre + half * share(k)).collect();
        let mut filled = vec![0.0; sigma.len() * eta.len()];
        fill_normal_gap(&gap, &sigma, &EtaAxis::new(&eta), FULL_PRECISION, &mut filled);
        let mut tally = Self { placements: 1, ..Self::default() };
        for (i, &sigma) in sigma.iter().enumerate() {
            let at = gap.rail().point(sigma).expect("a point of the rail");
            for (j, &eta) in eta.iter().enumerate().skip(i % EVERY).step_by(EVERY) {
                let found = [gap.gap(sigma, eta), filled[i * POINTS as usize + j]];
                tally.compare(&wheel, &Line::new(&at, eta), found, &|| {
                    format!("{}, σ = {sigma}, η = {eta}", placed.name)
                });
            }
        }
        tally
    }

    /// Compares t of a single point and of a grid with brute force.
    fn compare(&mut self, wheel: &Revolved<'_>, line: &Line, found: [f64; 2], place: &dyn Fn() -> String) {
        let differs = |t: f64, exact: f64| t.is_nan() || (t - exact).abs() > DIFFERENCE;
        let wrong =
            |exact: Option<f64>| found.iter().any(|&t| exact.map_or(!t.is_nan(), |exact| differs(t, exact)));
        let mut exact = wheel.gap(line, 1.0);
        if wrong(exact) {
            exact = wheel.gap(line, FINER);
        }
        self.points += 1;
        self.hits += usize::from(exact.is_some());
        self.negative += usize::from(exact.is_some_and(|t| t < 0.0));
        if wrong(exact) {
            self.wrong.push(format!("{}: {found:?} for {exact:?}", place()));
        }
    }

    fn joined(mut self, other: Self) -> Self {
        self.placements += other.placements;
        self.points += other.points;
        self.hits += other.hits;
        self.negative += other.negative;
        self.wrong.extend(other.wrong);
        self
    }
}

#[test]
fn the_normal_gap_is_the_first_entry_into_the_wheel() {
    let seeds = std::env::var("WHEELRAIL_RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(SEEDS);
    let stock = Stock::new();
    let mut wrong = Vec::new();
    for (kind, name) in KINDS.iter().enumerate() {
        let pairs = (0..seeds).into_par_iter().flat_map_iter(|seed| {
            let mut dice = Random::new(seed);
            stock.placed(kind, seed).into_iter().map(move |placed| Tally::of(&placed, &mut dice))
        });
        let tally = pairs.reduce(Tally::default, Tally::joined);
        let Tally { placements, points, hits, negative, .. } = tally;
        println!(
            "{name}: {placements} pairs, {points} points, {hits} on the wheel, {negative} in it, {} wrong",
            tally.wrong.len()
        );
        assert!(placements as u64 > seeds / 2 && 10 * hits > 6 * points, "{name}");
        wrong.extend(tally.wrong);
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong[..wrong.len().min(20)].join("\n"));
}

/// The patch of a pair within a window, and what a flood fill finds: areas \[mm²\], and boxes around the parts.
struct Compared {
    name: String,
    areas: [f64; 2],
    parts: [Vec<Window>; 2],
    /// Sides of a cell of the fill \[mm\]: its boxes err by one.
    cell: [f64; 2],
}

impl Compared {
    fn of(placed: &Placed, dice: &mut Random) -> Self {
        let gap = NormalGap::new(&placed.placement);
        let approach = 10f64.powf(dice.between(-2.0, -0.7));
        let reach = gap.rail().reach().expect("a rail's surface at C");
        let window = Window { xi: reach.cut(Interval::symmetric(15.0)), eta: Interval::symmetric(14.0) };
        let patch = Patch::over_rail(&placed.placement, approach, &window);
        let coarse = Filled::new(&gap, approach, &window, CELLS);
        // The fine grid is laid around what either finds.
        let found: Vec<Window> = patch.components.iter().map(Component::extent).collect();
        let around =
            coarse.parts().into_iter().chain(found.iter().copied()).reduce(Window::hull).unwrap_or(window);
        let box_of_fill = wider(&around, &window);
        let fine = Filled::new(&gap, approach, &box_of_fill, CELLS);
        let cell = [box_of_fill.xi, box_of_fill.eta].map(|side| side.width() / CELLS as f64);
        let name = format!("{}, δ = {approach}", placed.name);
        Self { name, areas: [patch.area(), fine.area()], parts: [found, fine.parts()], cell }
    }

    /// Says what differs.
    fn difference(&self) -> Option<String> {
        let [found, filled] = &self.parts;
        let area = (self.areas[0] / self.areas[1] - 1.0).abs();
        let near = |a: &Window, b: &Window| {
            [(a.xi, b.xi), (a.eta, b.eta)].iter().zip(self.cell).all(|((a, b), cell)| {
                let size = a.width().max(b.width());
                (a[0] - b[0]).abs().max((a[1] - b[1]).abs()) <= (EXTENT * size).max(cell)
            })
        };
        let agree = found.len() == filled.len() && found.iter().all(|a| filled.iter().any(|b| near(a, b)));
        (!agree || area > AREA).then(|| {
            format!("{}: area {:?}, off by {area:.1e}\n  {found:?}\n  {filled:?}", self.name, self.areas)
        })
    }
}

/// A box with a margin, inside another one.
fn wider(a: &Window, inside: &Window) -> Window {
    let more = |side: Interval, most: Interval| side.grown(0.04 * side.width()).cut(most);
    Window { xi: more(a.xi, inside.xi), eta: more(a.eta, inside.eta) }
}

#[test]
fn conformal_patches_are_those_of_a_flood_fill() {
    let stock = Stock::new();
    let mut wrong = Vec::new();
    // Of profiles that nobody has, a fill leaves open what is connected: their patches are slivers between kinks.
    for (kind, name) in KINDS.iter().enumerate().filter(|(_, name)| **name != "strange") {
        let pairs = (0..PATCH_SEEDS).into_par_iter().flat_map_iter(|seed| {
            let mut dice = Random::new(seed);
            stock.placed(kind, seed).into_iter().map(move |placed| Compared::of(&placed, &mut dice))
        });
        let all: Vec<Compared> = pairs.collect();
        let parts: usize = all.iter().map(|compared| compared.parts[1].len()).sum();
        let worst = all.iter().map(|compared| (compared.areas[0] / compared.areas[1] - 1.0).abs());
        println!("{name}: {} pairs, {parts} parts, area within {:.1e}", all.len(), worst.fold(0.0, f64::max));
        assert!(all.len() as u64 > PATCH_SEEDS / 2, "{name}");
        wrong.extend(all.iter().filter_map(Compared::difference));
    }
    assert!(wrong.is_empty(), "{} wrong:\n{}", wrong.len(), wrong[..wrong.len().min(20)].join("\n"));
}
