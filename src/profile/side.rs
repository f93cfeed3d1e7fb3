//! The two bodies: rail and wheel.

/// The body that a profile bounds. It decides which of several heights at one ξ is the outer one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The rail. Its material is below, so that the highest branch counts.
    Rail,
    /// The wheel. Its material is above, so that the lowest branch counts.
    Wheel,
}
