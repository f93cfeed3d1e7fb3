//! Solver meshes over the patch, surfaces around it, and measures of their quality.

mod axes;
mod boundary;
mod delaunay;
mod lines;
mod quality;
mod shells;
mod smoothing;
mod spacing;
mod strips;
mod surfaces;
mod trace;
mod triangles;

#[cfg(feature = "files")]
pub(crate) use axes::CELLS_REACHED;
pub use axes::{Axes, GridGroup, MOST_ON_AXIS, MOST_POINTS, equal_steps, groups};
pub use quality::{Quality, QualityRange};
pub use shells::{BodyShell, axle_point};
pub use strips::{StripCell, StripCounts, StripMesh};
pub use surfaces::Surface;
pub use triangles::{BoundaryChain, TriangleMesh, checked_size};
