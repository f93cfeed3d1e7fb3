//! Profiles (Report Sec. 3, Appendix A): chains of lines, arcs and polynomials, as drawings and standards
//! define them, in profile axes (x lateral, z up, mm).

mod arc;
mod builder;
mod chain;
mod closing;
mod continuity;
mod drawing;
mod groove;
mod inclination;
mod polynomial;
mod section;
mod segment;
mod side;
pub mod standards;
mod station;
mod trace;

pub use arc::{Arc, Half};
pub use builder::ChainBuilder;
pub use chain::Profile;
pub use closing::Closing;
pub(crate) use closing::ONE_JOINT;
pub use continuity::Joint;
pub use drawing::{ArcData, HalfData, LineData, PolynomialData, SegmentData, drawn_profile};
pub(crate) use groove::last_groove;
pub use inclination::inclination;
pub use polynomial::Polynomial;
pub(crate) use section::{
    ArcBranch, Branch, BranchPoint, BranchPoints, BranchShape, Branches, Piece, PolynomialBranch,
    parallel_to, stationary_points,
};
pub use section::{ProfilePoint, Section};
pub use segment::{Segment, Shape};
pub use side::Side;
pub use station::Station;
pub(crate) use trace::points_along;
pub use trace::{Beside, Mark, beside, trace};
