//! Scenes: what the user writes, read and checked once, in mm and rad from here on.

mod data;
mod position;
mod read;
mod resolve;

pub use data::{
    AxisData, ContactData, Format, GridData, MaterialData, OutputData, PatchData, ProfileData, RollData,
    RollWord, Rotation, Scene, Spacing, TrackData, WheelsetData,
};
pub use position::{Place, Standing};
pub use read::{hash, load, parse, perhaps};
pub use resolve::{equal_steps, is_chain_file, profile_from_file};

/// The JSON Schema of a scene.
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(Scene)
}
