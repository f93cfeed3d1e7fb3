//! The tree by which the cell of a lateral displacement and a yaw is found.

use super::about::About;
use super::cell::{Beginning, Cell};
use super::curve::Curve;
use super::quantity::QuantityValues;
use super::region::Division;
use crate::numerics::interval::Interval;

/// A part of the plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlanePart {
    /// The fork with this number divides it.
    Fork(usize),
    /// It is the cell with this number.
    Cell(usize),
}

/// What divides a part of the plane in two: a curve, or a yaw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fork {
    /// The number of the curve; `None` where it is a yaw.
    pub curve: Option<usize>,
    /// The yaw \[rad\]; 0 where it is a curve.
    pub yaw: f64,
    /// The parts below it, and from it upwards.
    pub parts: [PlanePart; 2],
}

/// Cells, the curves between them, and the forks by which a cell is found. The way begins at the first fork; what a fork leads to has a
/// greater number.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Tree {
    pub curves: Vec<Curve>,
    pub forks: Vec<Fork>,
    pub cells: Vec<Cell>,
    /// For each cell the coefficients of u^j tᵏ of all quantities, at j · [`COEFFICIENTS`](super::COEFFICIENTS) + k; none where nothing
    /// touches, NaN where a quantity does not exist.
    pub coefficients: Vec<Vec<QuantityValues>>,
}

impl Tree {
    /// Makes the tree of a divided range.
    pub fn of(branch: Division, about: About) -> Self {
        let mut tree = Self::default();
        let ends = about.lateral.ends().map(|y| tree.curve(Curve::constant(y, about.yaw, Beginning::Edge)));
        tree.add(branch, ends);
        tree
    }

    /// Makes the tree of a table under one yaw from its cells in ascending order, with their ends \[mm\] and how they begin; without
    /// coefficients.
    pub fn of_cells(cells: Vec<(Interval, Beginning, Cell)>, yaw: Interval) -> Self {
        let mut tree = Self::default();
        let last = cells.last().map(|(range, ..)| (range.high, Beginning::Edge));
        let begins = cells.iter().map(|(range, begins, _)| (range.low, *begins));
        for (y, kind) in begins.chain(last) {
            tree.curve(Curve::constant(y, yaw, kind));
        }
        tree.cells = cells
            .into_iter()
            .enumerate()
            .map(|(c, (.., cell))| Cell { curves: [c, c + 1], ..cell })
            .collect();
        let curves: Vec<usize> = (1..tree.cells.len()).collect();
        if !curves.is_empty() {
            tree.fork_row(tree.cells.len(), &curves, &mut |_, cell| PlanePart::Cell(cell));
        }
        tree
    }

    fn curve(&mut self, curve: Curve) -> usize {
        self.curves.push(curve);
        self.curves.len() - 1
    }

    /// Adds a branch between two curves.
    fn add(&mut self, branch: Division, [begin, end]: [usize; 2]) -> PlanePart {
        match branch {
            Division::Cell(fitted) => {
                self.cells.push(Cell { curves: [begin, end], ..fitted.cell });
                self.coefficients.push(fitted.coefficients.into_iter().flatten().collect());
                PlanePart::Cell(self.cells.len() - 1)
            }
            Division::Yaw(yaw, parts) => {
                let fork = self.fork(None, yaw);
                let [below, above] = *parts;
                let parts = [self.add(below, [begin, end]), self.add(above, [begin, end])];
                self.forks[fork].parts = parts;
                PlanePart::Fork(fork)
            }
            Division::Along(parts, curves) => {
                let curves: Vec<usize> = curves.into_iter().map(|curve| self.curve(curve)).collect();
                let bounds = [&[begin], curves.as_slice(), &[end]].concat();
                let mut parts: Vec<Option<Division>> = parts.into_iter().map(Some).collect();
                self.fork_row(parts.len(), &curves, &mut |tree, at| match parts[at].take() {
                    Some(part) => tree.add(part, [bounds[at], bounds[at + 1]]),
                    None => PlanePart::Cell(0),
                })
            }
        }
    }

    fn fork(&mut self, curve: Option<usize>, yaw: f64) -> usize {
        self.forks.push(Fork { curve, yaw, parts: [PlanePart::Cell(0); 2] });
        self.forks.len() - 1
    }

    /// Adds the forks between `count` parts in a row, with the numbers of the curves between them; `add` adds the part of an index.
    fn fork_row(
        &mut self,
        count: usize,
        curves: &[usize],
        add: &mut dyn FnMut(&mut Self, usize) -> PlanePart,
    ) -> PlanePart {
        fn among(
            tree: &mut Tree,
            [from, to]: [usize; 2],
            curves: &[usize],
            add: &mut dyn FnMut(&mut Tree, usize) -> PlanePart,
        ) -> PlanePart {
            if to - from == 1 {
                return add(tree, from);
            }
            let middle = from + (to - from) / 2;
            let fork = tree.fork(Some(curves[middle - 1]), 0.0);
            let parts = [among(tree, [from, middle], curves, add), among(tree, [middle, to], curves, add)];
            tree.forks[fork].parts = parts;
            PlanePart::Fork(fork)
        }
        among(self, [0, count], curves, add)
    }
}
