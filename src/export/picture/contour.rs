//! Finds lines of equal separation, by marching squares with linear interpolation along the grid's edges.

use std::collections::HashMap;

/// An edge of the grid: its lower node, and whether it runs along ξ.
type CellEdge = (usize, bool);

/// A function on the nodes of a rectangular grid, at `i * eta.len() + j`.
#[derive(Debug, Clone, Copy)]
pub struct Nodes<'a> {
    /// ξ \[mm\], ascending.
    pub xi: &'a [f64],
    /// η \[mm\], ascending.
    pub eta: &'a [f64],
    /// One value for every node; NaN where it is undefined.
    pub values: &'a [f64],
}

impl Nodes<'_> {
    /// Returns the lines on which the function equals `level`, as polylines in (ξ, η). A closed line ends where it begins.
    /// Cells with an undefined corner have no lines. Cost: linear in the number of nodes.
    pub fn lines(&self, level: f64) -> Vec<Vec<[f64; 2]>> {
        let mut links: HashMap<CellEdge, Vec<CellEdge>> = HashMap::new();
        for i in 1..self.xi.len() {
            for j in 1..self.eta.len() {
                for [a, b] in self.segments(i - 1, j - 1, level).into_iter().flatten() {
                    links.entry(a).or_default().push(b);
                    links.entry(b).or_default().push(a);
                }
            }
        }
        // Open lines come first, from their ends; the others are closed. They are sorted, so that every run writes the same
        // file.
        let mut starts: Vec<CellEdge> = links.keys().copied().collect();
        starts.sort_by_key(|edge| (links[edge].len(), *edge));
        starts.into_iter().filter_map(|start| self.chain(&mut links, start, level)).collect()
    }

    /// Returns the pieces of the line inside the cell whose lowest node is (i, j): none, one or, on a saddle,
    /// two.
    fn segments(&self, i: usize, j: usize, level: f64) -> [Option<[CellEdge; 2]>; 2] {
        let n = self.eta.len();
        let node = i * n + j;
        // The corners are counter-clockwise in (ξ, η).
        let corners = [node, node + n, node + n + 1, node + 1].map(|k| self.values[k]);
        if corners.iter().any(|value| value.is_nan()) {
            return [None; 2];
        }
        let above = corners.map(|value| value > level);
        let edges: [CellEdge; 4] = [(node, true), (node + n, false), (node + 1, true), (node, false)];
        let mut crossed = (0..4).filter(|&k| above[k] != above[(k + 1) % 4]);
        match [crossed.next(), crossed.next(), crossed.next(), crossed.next()] {
            [Some(a), Some(b), None, _] => [Some([edges[a], edges[b]]), None],
            // On a saddle the mean of the corners decides which opposite corners are joined.
            [Some(_), Some(_), Some(_), Some(_)] => {
                if (corners.iter().sum::<f64>() / 4.0 > level) == above[0] {
                    [Some([edges[0], edges[1]]), Some([edges[2], edges[3]])]
                } else {
                    [Some([edges[3], edges[0]]), Some([edges[1], edges[2]])]
                }
            }
            _ => [None; 2],
        }
    }

    /// Follows the links from `start` to their end, and removes them.
    fn chain(
        &self,
        links: &mut HashMap<CellEdge, Vec<CellEdge>>,
        start: CellEdge,
        level: f64,
    ) -> Option<Vec<[f64; 2]>> {
        let mut line = vec![self.crossing(start, level)];
        let mut here = start;
        while let Some(next) = links.get_mut(&here).and_then(Vec::pop) {
            let back = links.entry(next).or_default();
            if let Some(k) = back.iter().position(|edge| *edge == here) {
                back.swap_remove(k);
            }
            line.push(self.crossing(next, level));
            here = next;
        }
        (line.len() > 1).then_some(line)
    }

    fn crossing(&self, (node, along_xi): CellEdge, level: f64) -> [f64; 2] {
        let n = self.eta.len();
        let (i, j) = (node / n, node % n);
        let other = if along_xi { node + n } else { node + 1 };
        let (a, b) = (self.values[node], self.values[other]);
        let t = (level - a) / (b - a);
        if along_xi {
            [self.xi[i] + t * (self.xi[i + 1] - self.xi[i]), self.eta[j]]
        } else {
            [self.xi[i], self.eta[j] + t * (self.eta[j + 1] - self.eta[j])]
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(f: fn(f64, f64) -> f64, level: f64) -> Vec<Vec<[f64; 2]>> {
        let axis: Vec<f64> = (-20..=20).map(|i| f64::from(i) * 0.1).collect();
        let values: Vec<f64> = axis.iter().flat_map(|&x| axis.iter().map(move |&y| f(x, y))).collect();
        Nodes { xi: &axis, eta: &axis, values: &values }.lines(level)
    }

    #[test]
    fn a_circle_is_one_closed_line() {
        let circle = lines(|x, y| x * x + y * y, 1.0);
        assert_eq!(circle.len(), 1);
        assert_eq!(circle[0].first(), circle[0].last());
        // The error of linear interpolation along a chord is h²/8 × second derivative / slope.
        assert!(circle[0].iter().all(|p| (p[0].hypot(p[1]) - 1.0).abs() < 0.1 * 0.1 / 8.0 * 2.0));
    }

    #[test]
    fn open_lines_run_from_edge_to_edge_and_holes_cut_them() {
        assert_eq!(lines(|x, _| x, 0.55).len(), 1);
        assert_eq!(lines(|x, y| if y.abs() < 0.05 { f64::NAN } else { x }, 0.55).len(), 2);
        assert_eq!(lines(|x, y| x * y, 0.005).len(), 2);
        assert!(lines(|_, _| 1.0, 2.0).is_empty());
    }
}
