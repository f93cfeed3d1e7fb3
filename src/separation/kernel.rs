//! The interface of every method of the accuracy ladder: it fills columns of constant ξ.

/// A method that evaluates s over columns of constant ξ; their η are those of an axis.
pub trait Kernel {
    /// Writes s(ξ, η_j) \[mm\] for all η_j of the axis; NaN where a body has no surface.
    fn column(&mut self, xi: f64, out: &mut [f64]);

    /// Writes neighbouring columns one after the other; `xi` \[mm\] ascends.
    fn columns(&mut self, xi: &[f64], out: &mut [f64]) {
        let length = out.len() / xi.len().max(1);
        for (&xi, out) in xi.iter().zip(out.chunks_exact_mut(length)) {
            self.column(xi, out);
        }
    }

    /// Returns the largest truncation error \[mm\] that was measured so far; 0 if none is measured.
    fn truncation(&self) -> f64 {
        0.0
    }
}
