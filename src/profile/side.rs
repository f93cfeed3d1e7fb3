//! Rail or wheel.

/// Which body a profile bounds, and so which of several heights at one ξ is the outer one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Material below: the highest branch counts.
    Rail,
    /// Material above: the lowest branch counts.
    Wheel,
}
