//! Bounds of x and z over cells.

use crate::numerics::interval::Interval;

/// Makes a binary tree of bounds over those of cells, with its root at 1: the children of k are 2k and 2k + 1, the last half are the
/// cells.
pub(super) fn tree(cells: impl ExactSizeIterator<Item = [Interval; 2]>) -> Vec<[Interval; 2]> {
    let leaves = cells.len().next_power_of_two();
    let mut tree = vec![[Interval::NONE; 2]; leaves];
    tree.extend(cells);
    tree.resize(2 * leaves, [Interval::NONE; 2]);
    for node in (1..leaves).rev() {
        tree[node] = [0, 1].map(|axis| tree[2 * node][axis].hull(tree[2 * node + 1][axis]));
    }
    tree
}
