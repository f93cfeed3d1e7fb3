//! Scenes: what the user writes. A scene is read, then resolved once into a [`Case`](crate::case::Case) of checked values
//! in mm and rad.

mod axes;
mod data;
mod doubts;
mod march;
mod method_or_auto;
mod motion;
mod motion_data;
mod profile_data;
mod profiles;
mod read;
mod resolve;
mod setup;
mod side_data;
mod sides;
mod varying;
pub(crate) mod words;

pub use axes::check_axis;
pub use data::{
    AxisData, ContactData, GridData, MaterialData, OutputData, PatchData, RollData, RollWord, Scene, Spacing,
    TrackData, WheelsetData, schema,
};
pub use doubts::doubts_of_keys;
pub use march::march;
pub use motion_data::{FrictionData, MotionData, PitchData, PitchWord};
pub use profile_data::{FlatData, ProfileData, Rotation};
pub use profiles::{
    Given, ProfileSource, is_chain_file, near, pair_of, profile_from_file, profile_from_text, profile_of,
    read_profile, section_from_files,
};
pub use read::{load, parse};
pub use resolve::{approach, echo, modulus, pressure_cell, resolve, resolve_given, to_toml, with_profiles};
pub use setup::{distance, within};
pub use side_data::{DeviationData, SideData};
pub use varying::loft;
pub use words::perhaps;
