//! Bounds of x and z over cells.

/// Bounds of nothing.
pub(super) const NONE: [[f64; 2]; 2] = [[f64::INFINITY, f64::NEG_INFINITY]; 2];

/// Smallest bounds around two.
pub(super) fn around(a: [[f64; 2]; 2], b: [[f64; 2]; 2]) -> [[f64; 2]; 2] {
    [0, 1].map(|axis| [a[axis][0].min(b[axis][0]), a[axis][1].max(b[axis][1])])
}

/// A binary tree of bounds over those of cells, with its root at 1: the children of k are 2k and 2k + 1, and the last half are the cells.
pub(super) fn tree(cells: impl ExactSizeIterator<Item = [[f64; 2]; 2]>) -> Vec<[[f64; 2]; 2]> {
    let leaves = cells.len().next_power_of_two();
    let mut tree = vec![NONE; leaves];
    tree.extend(cells);
    tree.resize(2 * leaves, NONE);
    for node in (1..leaves).rev() {
        tree[node] = around(tree[2 * node], tree[2 * node + 1]);
    }
    tree
}
