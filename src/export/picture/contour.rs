//! Finds lines of equal separation, by marching squares with linear interpolation along the grid's edges.

/// An edge of the grid: twice its lower node, and one more if it runs along ξ.
type CellEdge = usize;

/// A piece of a line inside a cell, as it is met at one of its edges.
struct CellLink {
    from: CellEdge,
    to: CellEdge,
    /// Whether a line was followed over it.
    followed: bool,
}

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
    /// Cells with an undefined corner have no lines. Cost: linear in the number of nodes, and n log n in that
    /// of crossed edges.
    pub fn lines(&self, level: f64) -> Vec<Vec<[f64; 2]>> {
        let n = self.eta.len();
        let mut links: Vec<CellLink> = Vec::new();
        for i in 1..self.xi.len() {
            let [low, high] = [&self.values[(i - 1) * n..i * n], &self.values[i * n..(i + 1) * n]];
            for j in 1..n {
                // The corners are counter-clockwise in (ξ, η).
                let corners = [low[j - 1], high[j - 1], high[j], low[j]];
                let [a, b, c, d] = corners;
                let above = [a > level, b > level, c > level, d > level];
                if above == [true; 4] || above == [false; 4] || corners.iter().any(|value| value.is_nan()) {
                    continue;
                }
                let joined = self.joined((i - 1) * n + j - 1, corners, above, level);
                let both_ways = joined.into_iter().flatten().flat_map(|[a, b]| [[a, b], [b, a]]);
                links.extend(both_ways.map(|[from, to]| CellLink { from, to, followed: false }));
            }
        }
        links.sort_by_key(|link| link.from);
        // Open lines come first, from their ends, which have one link; the others are closed. They are sorted, so that every run
        // writes the same file.
        let of_one_edge = links.chunk_by(|a, b| a.from == b.from);
        let mut starts: Vec<(usize, CellEdge)> = of_one_edge.map(|own| (own.len(), own[0].from)).collect();
        starts.sort_unstable();
        starts.into_iter().filter_map(|(_, start)| self.chain(&mut links, start, level)).collect()
    }

    /// Returns the pieces of the line inside the cell with this lowest node, whose corners are not all on one side: one or, on a
    /// saddle, two.
    fn joined(
        &self,
        node: usize,
        corners: [f64; 4],
        above: [bool; 4],
        level: f64,
    ) -> [Option<[CellEdge; 2]>; 2] {
        let n = self.eta.len();
        let edges: [CellEdge; 4] = [2 * node + 1, 2 * (node + n), 2 * (node + 1) + 1, 2 * node];
        let mut crossed = (0..4).filter(|&k| above[k] != above[(k + 1) % 4]);
        match [crossed.next(), crossed.next(), crossed.next(), crossed.next()] {
            [Some(a), Some(b), None, _] => [Some([edges[a], edges[b]]), None],
            // On a saddle the mean of the corners decides which opposite corners are joined.
            _ if (corners.iter().sum::<f64>() / 4.0 > level) == above[0] => {
                [Some([edges[0], edges[1]]), Some([edges[2], edges[3]])]
            }
            _ => [Some([edges[3], edges[0]]), Some([edges[1], edges[2]])],
        }
    }

    /// Follows the links, which are in order of their edges, from `start` to their end; `None` where all were followed before.
    fn chain(&self, links: &mut [CellLink], start: CellEdge, level: f64) -> Option<Vec<[f64; 2]>> {
        let mut line = vec![self.crossing(start, level)];
        let mut here = start;
        while let Some(link) = of_edge(links, here).iter_mut().rfind(|link| !link.followed) {
            link.followed = true;
            let next = link.to;
            if let Some(back) = of_edge(links, next).iter_mut().find(|back| !back.followed && back.to == here)
            {
                back.followed = true;
            }
            line.push(self.crossing(next, level));
            here = next;
        }
        (line.len() > 1).then_some(line)
    }

    fn crossing(&self, edge: CellEdge, level: f64) -> [f64; 2] {
        let (n, node, along_xi) = (self.eta.len(), edge / 2, edge % 2 == 1);
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

/// Returns the links that are met at an edge, one in each of its cells, out of all in order of their edges.
fn of_edge(links: &mut [CellLink], edge: CellEdge) -> &mut [CellLink] {
    let begin = links.partition_point(|link| link.from < edge);
    let count = links[begin..].iter().take_while(|link| link.from == edge).count();
    &mut links[begin..begin + count]
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
