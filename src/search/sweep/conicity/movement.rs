//! Calculates how long a quarter of a wheelset's movement takes, under a force Δr that is straight between
//! displacements.
//!
//! With E(y) = 2 ∫_0^y Δr the speed at y is v = √(E(ŷ) − E(y)), and T(ŷ) = ∫_0^ŷ dy/v. Near the turning point
//! ŷ the cells are crossed one by one, in closed form. Far from it, where v² hardly varies, whole blocks of
//! cells are crossed at once: with E within c ± r in a block and d = E(ŷ) − c, 1/v = d^(−1/2) Σ_j C_j ((E −
//! c)/d)^j. The moments ∫ (E − c)^j dy do not depend on ŷ and give the block's time.

use crate::numerics::interval::Interval;
use crate::numerics::roots::last_where;

/// Number of terms of the series of 1/√(1 − t).
const TERMS: usize = 16;

/// Largest |t| of the series: its next term is then below 4e-10 of the block's time.
const FAR: f64 = 1.0 / 3.0;

/// Number of cells of the smallest blocks: crossing so many costs as much as a series.
const SMALLEST: usize = 8;

/// Half of the nodes and weights of the Gauss–Legendre rule with 8 points on \[−1, 1\]: exact for moments up
/// to the seventh, and to 1e-9 for the other moments of cells in a block, whose energy varies less than the
/// block's.
const GAUSS: [[f64; 2]; 4] = [
    [0.183_434_642_495_649_8, 0.362_683_783_378_362],
    [0.525_532_409_916_329, 0.313_706_645_877_887_3],
    [0.796_666_477_413_626_7, 0.222_381_034_453_374_48],
    [0.960_289_856_497_536_3, 0.101_228_536_290_376_26],
];

/// Coefficients C_j of 1/√(1 − t): C_j = C_(j−1) (2j − 1)/2j.
const SERIES: [f64; TERMS] = {
    let mut c = [1.0; TERMS];
    let mut j = 1;
    while j < TERMS {
        c[j] = c[j - 1] * (2 * j - 1) as f64 / (2 * j) as f64;
        j += 1;
    }
    c
};

/// A displacement with its Δr; a jump is two knots at the same displacement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Knot {
    /// Displacement y \[mm\].
    pub y: f64,
    /// Δr at y \[mm\].
    pub force: f64,
    /// Possible error of ∫ Δr over the cell that ends here \[mm²\].
    pub defect: f64,
}

/// Δr over \[0, ŷ_max\], prepared for any amplitude.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Movement {
    knots: Vec<Knot>,
    /// E at the knots \[mm²\].
    energy: Vec<f64>,
    /// Largest E up to each knot \[mm²\].
    highest: Vec<f64>,
    /// Sum of the squares of the defects up to each knot \[mm⁴\]: errors of cells are independent.
    squares: Vec<f64>,
    /// Blocks as a heap: block k consists of blocks 2k and 2k + 1, the last half are the smallest.
    blocks: Vec<CellBlock>,
}

/// The time of a quarter of the movement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Quarter {
    /// T \[1\], with Δr as force.
    pub time: f64,
    /// Estimated relative error of the time, from the defects.
    pub error: f64,
}

/// Several cells together.
#[derive(Debug, Clone, Copy, PartialEq)]
struct CellBlock {
    /// Middle c of the range of E \[mm²\].
    centre: f64,
    /// Half width r of the range of E \[mm²\].
    radius: f64,
    /// Moments ∫ ((E − c)/r)^j dy \[mm\].
    moments: [f64; TERMS],
    /// Sum of the squares of the defects up to the middle of the block \[mm⁴\].
    squares: f64,
}

/// The time of one movement while it is summed over cells and blocks.
struct TimeSum<'m> {
    movement: &'m Movement,
    /// Number of cells below the one with the turning point.
    below: usize,
    /// E(ŷ) \[mm²\].
    total: f64,
    /// Sum of the squares of the defects up to ŷ \[mm⁴\].
    squares: f64,
    time: f64,
    /// Absolute error of the time.
    error: f64,
}

impl Movement {
    /// Prepares knots, which must be in order of y, the first at 0.
    pub(super) fn new(knots: Vec<Knot>) -> Self {
        let (mut energy, mut squares) = (vec![0.0], vec![0.0]);
        for (k, cell) in knots.windows(2).enumerate() {
            energy.push(energy[k] + (cell[1].y - cell[0].y) * (cell[0].force + cell[1].force));
            squares.push(squares[k] + cell[1].defect * cell[1].defect);
        }
        let mut movement = Self { knots, energy, highest: vec![0.0], squares, blocks: Vec::new() };
        for cell in 0..movement.cells() {
            let peak = movement.peak(cell, movement.knots[cell + 1].y);
            movement.highest.push(movement.highest[cell].max(peak));
        }
        let smallest = movement.cells().div_ceil(SMALLEST).next_power_of_two();
        movement.blocks = (0..2 * smallest).map(|k| movement.block(k, smallest)).collect();
        movement
    }

    /// Returns the number of cells between the knots.
    pub(super) fn cells(&self) -> usize {
        self.knots.len().saturating_sub(1)
    }

    /// Returns where a cell begins and ends \[mm\].
    pub(super) fn ends(&self, cell: usize) -> Interval {
        Interval::new(self.knots[cell].y, self.knots[cell + 1].y)
    }

    /// Returns the cell, of a width above 0, in which an amplitude above 0 lies, its end included; `None`
    /// beyond the last.
    pub(super) fn cell(&self, amplitude: f64) -> Option<usize> {
        let above = self.knots.partition_point(|knot| knot.y < amplitude);
        (above < self.knots.len()).then(|| above.checked_sub(1)).flatten()
    }

    /// Returns where the last cell ends \[mm\].
    pub(super) fn reach(&self) -> f64 {
        self.knots.last().map_or(0.0, |knot| knot.y)
    }

    /// Returns the largest E within an amplitude \[mm²\], beyond the last cell that within all cells: a movement turns there only if it
    /// has this energy.
    pub(super) fn highest_at(&self, amplitude: f64) -> f64 {
        match self.cell(amplitude) {
            Some(cell) => self.highest[cell].max(self.peak(cell, amplitude)),
            None if amplitude > 0.0 => self.highest.last().copied().unwrap_or(0.0),
            None => 0.0,
        }
    }

    /// Returns the larger of E at an amplitude in `cell` and of the top of E in the cell before it \[mm²\].
    fn peak(&self, cell: usize, amplitude: f64) -> f64 {
        let [inner, outer] = [self.knots[cell], self.knots[cell + 1]];
        let (run, width) = (amplitude - inner.y, outer.y - inner.y);
        if width <= 0.0 {
            return self.energy[cell];
        }
        let stiffness = (outer.force - inner.force) / width;
        let force = inner.force + run * stiffness;
        if inner.force > 0.0 && force < 0.0 {
            return self.energy[cell] - inner.force * inner.force / stiffness;
        }
        self.energy[cell] + run * (inner.force + force)
    }

    /// Returns the quarter of the movement with its turning point ŷ in `cell`; `None` if the movement does
    /// not come back through 0.
    ///
    /// Accuracy: 1e-9 of the time, for the force as it is. Cost: grows with the logarithm of the number of
    /// cells.
    pub(super) fn quarter(&self, cell: usize, amplitude: f64) -> Option<Quarter> {
        let [inner, outer] = [self.knots[cell], self.knots[cell + 1]];
        let run = amplitude - inner.y;
        let share = run / (outer.y - inner.y);
        let force = inner.force + share * (outer.force - inner.force);
        let gained = run * (inner.force + force);
        if gained <= 0.0 {
            return None;
        }
        let speed = gained.sqrt();
        let time = crossing(run, [inner.force, force], [speed, 0.0])?;
        // The table is exact at its knots: from there the error of the integral grows with the square of the
        // distance.
        let defect = share * share * (3.0 - 2.0 * share) * outer.defect;
        let mut sum = TimeSum {
            movement: self,
            below: cell,
            total: self.energy[cell] + gained,
            squares: self.squares[cell] + defect * defect,
            time,
            error: time * defect / gained,
        };
        sum.add(1, 0, self.blocks.len() / 2 * SMALLEST)?;
        Some(Quarter { time: sum.time, error: sum.error / sum.time })
    }

    /// Makes the block at a place of the heap, whose last half begins at `smallest`.
    fn block(&self, place: usize, smallest: usize) -> CellBlock {
        let depth = place.max(1).ilog2();
        let cells = (smallest >> depth) * SMALLEST;
        let first = ((place - (1 << depth).min(place)) * cells).min(self.cells());
        let last = (first + cells).min(self.cells());
        let energies = Interval::around(self.energy[first..=last].iter().copied());
        let (centre, radius) = (energies.middle(), energies.width() / 2.0);
        let mut moments = [0.0; TERMS];
        for k in first..last {
            self.add_moments(k, centre, radius, &mut moments);
        }
        CellBlock { centre, radius, moments, squares: self.squares[first + (last - first) / 2] }
    }

    fn add_moments(&self, cell: usize, centre: f64, radius: f64, moments: &mut [f64; TERMS]) {
        let [inner, outer] = [self.knots[cell], self.knots[cell + 1]];
        let half = (outer.y - inner.y) / 2.0;
        for [node, weight] in GAUSS.iter().flat_map(|&[node, weight]| [[node, weight], [-node, weight]]) {
            let share = (1.0 + node) / 2.0;
            let force = inner.force + share * (outer.force - inner.force);
            let energy = self.energy[cell] + 2.0 * half * share * (inner.force + force);
            let t = if radius > 0.0 { (energy - centre) / radius } else { 0.0 };
            let mut term = half * weight;
            for moment in moments.iter_mut() {
                *moment += term;
                term *= t;
            }
        }
    }
}

/// Finds the distances from the centre, to the left and to the right, at which a movement with this amplitude \[mm\] turns whose two
/// sides differ: 2 ŷ apart, at one energy. `None` where one of them lies beyond its side's last cell.
///
/// The movements of all energies about one centre lie in each other, so that there is at most one of a width. There is none where a
/// hump of E is just passed, since the movement then is wider at once: [`Movement::quarter`] does not come back from the distances that
/// are found there.
pub(super) fn turning([left, right]: [&Movement; 2], amplitude: f64) -> Option<[f64; 2]> {
    let span = 2.0 * amplitude;
    let [from, to] = [(span - left.reach()).max(0.0), span.min(right.reach())];
    let within = |right_turn: f64| right.highest_at(right_turn) <= left.highest_at(span - right_turn);
    let enclosed = from <= to && within(from) && (to == span || !within(to));
    enclosed.then(|| last_where(within, from, to)).map(|right_turn| [span - right_turn, right_turn])
}

impl TimeSum<'_> {
    /// Adds the first `cells` cells of a block that lie below the turning point's cell; `None` if the speed
    /// drops to zero.
    fn add(&mut self, place: usize, first: usize, cells: usize) -> Option<()> {
        let last = (first + cells).min(self.below);
        if first >= last {
            return Some(());
        }
        let movement = self.movement;
        let block = &movement.blocks[place];
        let depth = self.total - block.centre;
        let whole = first + cells <= self.below;
        if whole && block.radius <= FAR * depth {
            let t = block.radius / depth;
            let terms = SERIES.iter().zip(&block.moments).rev();
            let series = terms.fold(0.0, |sum: f64, (c, moment)| sum * t + c * moment);
            let speed = depth.sqrt();
            self.time += series / speed;
            self.error += block.moments[0] * (self.squares - block.squares).max(0.0).sqrt() / (depth * speed);
            return Some(());
        }
        if cells > SMALLEST {
            self.add(2 * place, first, cells / 2)?;
            return self.add(2 * place + 1, first + cells / 2, cells / 2);
        }
        let mut inner = self.speed(first)?;
        for k in first..last {
            let outer = self.speed(k + 1)?;
            let [from, to] = [movement.knots[k], movement.knots[k + 1]];
            let time = crossing(to.y - from.y, [from.force, to.force], [inner, outer])?;
            self.time += time;
            self.error += time * (self.squares - movement.squares[k]).max(0.0).sqrt() / (inner * inner);
            inner = outer;
        }
        Some(())
    }

    fn speed(&self, knot: usize) -> Option<f64> {
        let square = self.total - self.movement.energy[knot];
        (square > 0.0).then(|| square.sqrt())
    }
}

/// Returns the time over a run under a force straight between its end values, at the given end speeds: with
/// the stiffness g, tan(√g T/2) = √g run/(v0 + v1). `None` if a force outwards (g < 0) turns the movement
/// back within the run.
fn crossing(run: f64, force: [f64; 2], speed: [f64; 2]) -> Option<f64> {
    let mean = run / (speed[0] + speed[1]);
    let stiffness = if run > 0.0 { (force[1] - force[0]) / run } else { 0.0 };
    let square = stiffness * mean * mean;
    // The next term of the series is below 2e-11 of the first.
    if square.abs() < 1e-2 {
        let series = 1.0 / 3.0 - square * (0.2 - square * (1.0 / 7.0 - square / 9.0));
        return Some(2.0 * mean * (1.0 - square * series));
    }
    let root = square.abs().sqrt();
    let angle = if square > 0.0 { root.atan() } else { (root < 1.0).then(|| root.atanh())? };
    Some(2.0 * mean * angle / root)
}
