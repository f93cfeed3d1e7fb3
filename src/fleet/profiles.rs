//! The profiles of a part: read once, with the measures of wheels, and the hash of all that a part is made of.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use rayon::prelude::*;
use sha2::{Digest, Sha256};

use super::list::{ListedWheelset, Source};
use super::listed::{Listed, PairNumber, Pairs};
use crate::error::{Error, Result};
use crate::files::read_bytes;
use crate::measure::{MeasureOptions, Measures, measure};
use crate::measured::{self, CurveKind, LARGEST_FILE, Record, SliceList};
use crate::profile::{Profile, Side};
use crate::scene::{self, ProfileData};

/// A profile of a fleet: where it comes from, of which body, and of which side's options of the scene.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(super) struct Key {
    pub source: Source,
    pub wheel: bool,
    /// Whose options of the scene it has.
    of: OptionsOf,
}

/// Whose options of the scene a profile has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
enum OptionsOf {
    Both,
    Left,
    Right,
}

/// A profile that was read.
#[derive(Debug, Clone)]
pub(super) struct Read {
    pub profile: Profile,
    pub record: Option<Record>,
    /// Measures of a wheel; `None` of a rail.
    pub measures: Option<Measures>,
}

/// The profiles that are in memory, or why they cannot be had.
#[derive(Debug, Default)]
pub(super) struct Shelf {
    read: HashMap<Key, Result<Read>>,
}

impl Shelf {
    /// Reads what the pairs of a part need and is not there yet, and forgets the rest.
    pub fn fill(&mut self, fleet: &Listed, pairs: &Pairs) {
        let mut needed: Vec<Key> = Vec::new();
        let mut kept = HashMap::new();
        for key in pairs.all().flat_map(|number| keys(fleet, number)).flatten() {
            if kept.contains_key(&key) {
                continue;
            }
            match self.read.remove(&key) {
                Some(read) => drop(kept.insert(key, Some(read))),
                None => {
                    needed.push(key.clone());
                    kept.insert(key, None);
                }
            }
        }
        let new: Vec<_> = needed.into_par_iter().map(|key| (read(fleet, &key), key)).collect();
        self.read = kept.into_iter().filter_map(|(key, read)| Some((key, read?))).collect();
        self.read.extend(new.into_iter().map(|(read, key)| (key, read)));
    }

    /// Gives a profile, or why there is none.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn get(&self, key: &Key) -> Result<&Read> {
        let none =
            || Error::new("profile", "none", "one that was read", "report this as a fault of wheelrail");
        self.read.get(key).ok_or_else(none)?.as_ref().map_err(Clone::clone)
    }
}

/// Returns the keys of the rails and the wheels of a pair, \[left, right\].
pub(super) fn keys(fleet: &Listed, PairNumber { wheelset, section }: PairNumber) -> [[Key; 2]; 2] {
    let ListedWheelset { wheels, rails, .. } = &fleet.wheelsets[wheelset];
    let section = fleet.sections[section].as_ref();
    let rail = |k: usize| section.or(rails.as_ref().map(|own| &own[k])).unwrap_or(&Source::Scene);
    let key = |k: usize, wheel: bool| {
        let side = if k == 0 { &fleet.scene.left } else { &fleet.scene.right };
        let own =
            side.as_ref().is_some_and(|side| if wheel { side.wheel.is_some() } else { side.rail.is_some() });
        let of = match (own, k) {
            (false, _) => OptionsOf::Both,
            (true, 0) => OptionsOf::Left,
            (true, _) => OptionsOf::Right,
        };
        Key { source: if wheel { wheels[k].clone() } else { rail(k).clone() }, wheel, of }
    };
    [[key(0, false), key(1, false)], [key(0, true), key(1, true)]]
}

/// Returns the keys of the scene that hold for a profile: those of its side, or those of both.
pub(super) fn data<'a>(fleet: &'a Listed, key: &Key) -> &'a ProfileData {
    let side = match key.of {
        OptionsOf::Both => None,
        OptionsOf::Left => fleet.scene.left.as_ref(),
        OptionsOf::Right => fleet.scene.right.as_ref(),
    };
    let own = side.and_then(|side| if key.wheel { side.wheel.as_ref() } else { side.rail.as_ref() });
    own.unwrap_or(if key.wheel { &fleet.scene.wheel } else { &fleet.scene.rail })
}

fn read(fleet: &Listed, key: &Key) -> Result<Read> {
    let side = if key.wheel { Side::Wheel } else { Side::Rail };
    let shared = data(fleet, key).clone();
    let bare = ProfileData { profile: None, file: None, segments: None, start: None, ..shared.clone() };
    let (data, folder) = match &key.source {
        Source::Scene => (shared, fleet.folder.as_path()),
        Source::File(path) => (ProfileData { file: Some(path.clone()), ..bare }, Path::new("")),
        Source::BuiltIn(name) => (ProfileData { profile: Some(name.clone()), ..bare }, Path::new("")),
    };
    let (profile, record) = scene::profile_of(&data, folder, side)?;
    if !key.wheel {
        return Ok(Read { profile, record, measures: None });
    }
    // Wheels are measured in the axes of their files and, as `profile measure` does it, on a curve through their points.
    let curve = data.curve.or(record.as_ref().map(|_| CurveKind::Interpolation));
    let smoothed = curve == Some(CurveKind::Interpolation) && data.curve.is_none();
    let cutoff_wavelength = data.cutoff_wavelength.filter(|_| !smoothed);
    let own = ProfileData { rotate: None, shift: None, curve, cutoff_wavelength, ..data.clone() };
    let again = own != data;
    let exact = if again { Some(scene::profile_of(&own, folder, side)) } else { None };
    let (exact, _) = exact.transpose()?.unwrap_or((profile.clone(), None));
    let measures = measure(&exact, side, None, &MeasureOptions::default())?;
    let measures = measures
        .with_diameter(record.as_ref().and_then(|record| record.diameter))
        .compared(record.as_ref().map_or(&[], |record| record.stated.as_slice()));
    Ok(Read { profile, record, measures: Some(measures) })
}

/// Returns the SHA-256, in hexadecimal, of all that the rows of a part depend on: program, scene, list, content of the files.
/// Files that cannot be read count by their errors.
pub(super) fn hash(fleet: &Listed, pairs: &Pairs) -> String {
    let mut sha = Sha256::new();
    let mut add = |text: &[u8]| {
        sha.update((text.len() as u64).to_le_bytes());
        sha.update(text);
    };
    add(env!("CARGO_PKG_VERSION").as_bytes());
    add(scene::echo(&fleet.scene, "").hash.as_bytes());
    let mut files: HashMap<PathBuf, Vec<u8>> = HashMap::new();
    for number in pairs.all() {
        let ListedWheelset { name, radii, .. } = &fleet.wheelsets[number.wheelset];
        add(name.as_bytes());
        radii.iter().for_each(|radius| add(&radius.unwrap_or(f64::NAN).to_le_bytes()));
        for key in keys(fleet, number).iter().flatten() {
            add(key.source.to_string().as_bytes());
            let path = match &key.source {
                Source::File(path) => Some(path.clone()),
                Source::Scene => data(fleet, key).file.as_ref().map(|file| fleet.folder.join(file)),
                Source::BuiltIn(_) => None,
            };
            if let Some(path) = path {
                add(files.entry(path).or_insert_with_key(|path| content(path)));
            }
        }
    }
    sha.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}

/// Returns the hash of a file's content, and of its slices' if it is a list; the message stands for the content of one that cannot be read.
fn content(path: &Path) -> Vec<u8> {
    let mut sha = Sha256::new();
    let mut add = |path: &Path| match read_bytes(path, LARGEST_FILE) {
        Ok(bytes) => {
            sha.update(&bytes);
            bytes
        }
        Err(error) => {
            sha.update(error.to_string());
            Vec::new()
        }
    };
    let bytes = add(path);
    let listed = measured::listed_body(&path.display().to_string());
    let list = listed.and_then(|side| SliceList::read(&bytes, side).ok());
    let folder = path.parent().unwrap_or(Path::new(""));
    list.iter().flat_map(|list| &list.slices).for_each(|slice| drop(add(&folder.join(&slice.file))));
    sha.finalize().to_vec()
}
