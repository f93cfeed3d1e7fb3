//! What bounds a patch along ξ.

use serde::Serialize;

/// What bounds a component at one of its ends in ξ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum End {
    /// A tip: the two branches meet in a single point with s(ξ, η) = δ, or stand at both ends of a line along which s is level.
    Tip,
    /// The window cuts the component.
    Window,
    /// One of the bodies ends, or steps away from the other body behind an overhang.
    ProfileEnd,
}
