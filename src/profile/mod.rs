//! Profiles (Report Sec. 3, Appendix A): chains of lines, arcs and polynomials, as drawings and standards
//! define them, in profile axes (x lateral, z up, mm).

mod arc;
pub mod builder;
mod chain;
pub mod closing;
pub mod continuity;
pub mod drawing;
mod groove;
mod polynomial;
mod section;
mod segment;
mod side;
pub mod standards;
mod station;
pub mod trace;

pub use arc::{Arc, Half};
pub use chain::Profile;
pub use closing::ONE_JOINT;
pub use groove::last_groove;
pub use polynomial::Polynomial;
pub use section::{
    ArcBranch, Branch, BranchPoint, BranchPoints, BranchShape, Branches, Piece, PolynomialBranch,
    ProfilePoint, Section, stationary_points,
};
pub use segment::{Segment, Shape};
pub use side::Side;
pub use station::Station;
