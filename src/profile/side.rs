//! Rail or wheel.

/// The body that a profile bounds; it decides which of several heights at one ξ is the outer one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// Rail, with the material below: the highest branch counts.
    Rail,
    /// Wheel, with the material above: the lowest branch counts.
    Wheel,
}
