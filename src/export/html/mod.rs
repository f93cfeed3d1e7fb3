//! Pages for a browser. A page is one file: it holds its numbers, its style and its script, and asks the network for nothing.
//!
//! The scripts are bundles. Their sources are in `source/` beside this file, with `package.json` and `package-lock.json`;
//! `npm ci && npm run build` there makes them, and a test compares the result with what is committed. Cargo needs no node.

mod document;
mod fleet;
mod measure;
mod numbers;
mod sweep;
mod view;

pub use fleet::{FleetDistribution, FleetHeat, FleetPage, FleetWorst};
pub use measure::{MeasuredPage, MeasuresPage};
pub use sweep::{
    PageCut, PageEvent, PageEvents, PageFigure, PageMap, SweepCurve, SweepPage, SweepPanel, SweepSide,
};
pub use view::{
    PageConformal, PageFrame, PageLoop, PagePair, PagePressure, PageProfile, ViewContact, ViewPage,
};
