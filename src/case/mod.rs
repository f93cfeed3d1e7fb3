//! A case: what is to be computed, as checked values, and the way from it to results and their files.
//!
//! Cases know nothing of scenes: the room `scene` makes them.

mod analysis;
mod columns;
mod conformal;
mod conicity;
mod conicity_doubts;
mod conicity_files;
mod conicity_noise;
mod contact;
mod curves;
mod doubts;
mod drawn;
mod elements;
mod ends;
mod facts;
mod files;
mod formats;
mod found;
mod grids;
mod in_place;
mod input;
mod jobs;
mod joined;
mod landmarks;
mod march;
mod march_table;
mod march_view;
mod measure_view;
mod on_rail;
mod overlaps;
mod places;
mod polylines;
mod pressure;
mod profile_view;
mod roll_ends;
mod run;
mod site;
mod site_doubts;
mod summary;
mod sweep_view;
mod table;
mod tally;
mod unmeasured;
mod unrolled;
pub mod usual;
mod view;
mod wheel;

pub use analysis::{Analysis, Timings, check_method};
pub use columns::{COLUMNS, ColumnArray, SweepColumn, SweepColumns};
pub use conformal::Conformal;
pub use conicity::{
    ConicityMap, ConicityOptions, ConicityReport, DOUBT, FUNCTIONS, KEY_FIGURES, conicity, contact_geometry,
};
pub use conicity_doubts::{ConicityBasis, doubts_of_conicities};
pub use conicity_files::{
    conicity_csv, conicity_page, conicity_picture, conicity_text, conicity_values, uncertainty_values,
};
pub use conicity_noise::{Noise, UNCERTAIN, Uncertainty};
pub use contact::{EllipseUnder, PlacedContact};
pub use curves::{MOST_DRAWN, ascending, curves};
pub use doubts::{ContactDoubts, Doubt, DoubtKind, DoubtSet};
pub use drawn::{patch_picture, quads};
pub use elements::patch_mesh;
pub use ends::OpenEnd;
pub use facts::{FACTS, Fact};
pub use files::{Rasterise, WrittenFile, WrittenPart, files, summaries, write};
pub use formats::{OutputFormat, PATCHES_FOLDER, RUN_FOLDER, run_files};
pub use found::{Found, ListedContact};
pub use grids::Grid;
pub use input::{
    ApproachBy, Arrangement, AskedAxes, AskedPressure, Case, Echo, FrameOrigin, Friction, Outputs, Profiles,
    Question, RollByLoad, Setup, SideProfiles,
};
pub use joined::joined_pair;
pub use landmarks::{Landmarks, SideLandmarks};
pub use march::{ALONG, AROUND, MarchCase, MarchCourse, MarchRow, MarchStop, cut_off_warning, hole_warning};
pub use march_table::{
    EVENT_NUMBERS, MARCH_NUMBERS, MarchColumns, append_event, event_numbers, events_head, march_head,
};
pub use march_view::{DrawnMarch, ListedEvents};
pub use measure_view::measures_page;
pub use places::{approach_under_load, contacts, find};
pub(crate) use polylines::polyline;
pub use pressure::{EdgeOnRail, OnGrid, PartPressure};
pub use profile_view::{about_profile, profile_picture};
pub use roll_ends::{RollEnds, table_roll_ends};
pub use run::{Part, Run, SILENT, Tell};
pub use site::{Site, sites};
pub use sweep_view::sweep_page;
pub use table::{TABLE_FOLDER, table, write_table};
pub use tally::Tally;
pub use unmeasured::BridgeInContact;
pub(crate) use view::about_bodies;
