//! Fleets: every wheelset on every rail section, with a row each, in parts that are kept, so that a study goes on where it was stopped.
//!
//! ```text
//! folder or table → wheelsets × sections → parts (a file each, by the hash of what it is made of) → table, summary, pages
//! ```
//!
//! A part has 1024 pairs at most: wheelsets on a group of sections. Its profiles are read once, and only those of one part are kept in
//! memory. At the end the table, the summary and the page are made of the parts in their order, and the pages of the worst pairs from
//! their profiles, read again: all have the same bits whatever the number of threads and stops.

mod list;
mod listed;
mod page;
mod pair;
mod part;
mod profiles;
mod tally;

use std::collections::BTreeSet;
use std::ops::Range;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;

use crate::case::{Arrangement, Profiles};
use crate::error::{Error, Result, in_order};
use crate::files::{KeptFolder, Names};
use crate::placement::Pair;
use crate::profile::standards;
use crate::scene::{self, ProfileData, Scene};
use crate::search::Roll;
use listed::{Listed, PairNumber, Pairs};
use part::FleetPart;
use profiles::Shelf;

/// Most pairs of a part: some seconds of work.
const PAIRS: usize = 1024;
/// Most rail sections of a part, which are in memory together.
const MOST_SECTIONS: usize = 256;
/// Least and most wheelsets of a part.
const WHEELSETS: [usize; 2] = [4, 64];

/// Names in the output folder.
const MARKER: &str = "fleet.json";
const PARTS: &str = "parts";
const FOLDER: Names = Names {
    marker: MARKER,
    is_file: |name| [MARKER, "fleet.csv", "summary.json", "fleet.html", PARTS, page::WORST].contains(&name),
    is_part: |_| false,
};

/// Every wheelset of a fleet on every rail section.
///
/// # Examples
/// ```
/// use wheelrail::fleet::Fleet;
/// use wheelrail::{Scene, scene};
///
/// let scene: Scene = scene::parse("wheel = { radius = 460.0 }
///     rail = { rotate = '1:40' }
///     track = { gauge = 1435.0 }
///     wheelset = { back_to_back = 1360.0, flange_back_x = -70.0 }", false)?;
/// # let temporary = tempfile::tempdir().expect("a folder");
/// # let folder = temporary.path();
/// # let wheels = wheelrail::files::KeptFolder::open(folder, wheelrail::case::RUN_FOLDER)?;
/// wheels.write("wheels.csv", b"wheelset,left,right\nnew,S1002,S1002\n")?;
/// let fleet = Fleet::new(scene, folder, &wheels.file("wheels.csv"), Some("60E1"))?;
/// let summary = fleet.run(&folder.join("out"), &|_, _| Ok(()))?;
/// assert_eq!(summary.pairs, 1);
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone)]
pub struct Fleet {
    listed: Listed,
}

/// Counts of a fleet that was computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FleetOutcome {
    /// Number of pairs: wheelsets on sections.
    pub pairs: usize,
    /// Pairs that have an equivalent conicity at 3 mm.
    pub with_conicity: usize,
    /// Pairs with a finding.
    pub with_finding: usize,
    /// Parts that were there already.
    pub kept: usize,
    /// Parts that were there and were computed again, because what they are made of has changed.
    pub changed: usize,
}

impl Fleet {
    /// Lists a fleet. `scene` has what all pairs share: \[track\], \[wheelset\], the radius, options of measured files; its own rails count
    /// where none are given. `wheels` is a folder, whose files are both wheels of a wheelset each, or a table (CSV). `rails` is a folder of
    /// sections, a file or a built-in name; `None` takes the rails of the table, or the scene's. Paths of the scene are relative to `folder`.
    ///
    /// No profile is read.
    ///
    /// # Errors
    /// A scene without wheelset or with a given roll, or with anything else wrong except its profiles; lists that cannot be read; no rails,
    /// or rails in the table beside `rails`.
    pub fn new(scene: Scene, folder: &Path, wheels: &Path, rails: Option<&str>) -> Result<Self> {
        checked(&scene).map_err(|error| error.within("scene"))?;
        let wheelsets = list::wheelsets(wheels)?;
        let sides = [&scene.left, &scene.right].into_iter().flatten();
        let own =
            sides.filter_map(|side| side.rail.as_ref()).chain([&scene.rail]).any(ProfileData::has_source);
        let sections = match rails {
            None if !own && wheelsets.iter().any(|wheelset| wheelset.rails.is_none()) => {
                let expected =
                    "a folder of sections or a built-in name, columns of the table, or a profile in [rail]";
                return Err(Error::new("rails", "none", expected, "give --rails"));
            }
            None => vec![None],
            Some(rails) if wheelsets.iter().all(|wheelset| wheelset.rails.is_none()) => {
                list::rails(rails)?.into_iter().map(Some).collect()
            }
            Some(rails) => {
                let expected = "rails in the table or sections for all wheelsets";
                let place = wheels.display().to_string();
                let found = format!("rails of its own beside {rails}");
                return Err(Error::new(place, found, expected, "remove one of them"));
            }
        };
        Ok(Self { listed: Listed { scene, folder: folder.into(), wheelsets, sections } })
    }

    /// Returns the number of pairs.
    pub fn pairs(&self) -> usize {
        self.listed.wheelsets.len() * self.listed.sections.len()
    }

    /// Lists what in the keys of the scene looks like a slip; what looks so in a profile is in its rows.
    pub fn warnings(&self) -> Vec<String> {
        self.listed.warnings()
    }

    /// Returns the number of parts.
    pub fn parts(&self) -> usize {
        self.split().len()
    }

    /// Computes the parts that are not in the folder `out`, then writes `fleet.csv`, `summary.json`, `fleet.html` and `worst/`. `tell` gets
    /// the number of pairs done and of all, from any thread, and may end the work by an error; what is done by then stays.
    ///
    /// It runs on the threads of the current rayon pool. Cost: about 12 ms for a measured wheelset on a section, reading it included.
    ///
    /// # Errors
    /// A folder with other files; any error of the disk or of `tell`. What is wrong with a profile is in its row.
    pub fn run(
        &self,
        out: &Path,
        tell: &(dyn Fn(usize, usize) -> Result<()> + Sync),
    ) -> Result<FleetOutcome> {
        let folder = self.opened(out)?;
        let parts = folder.part(PARTS)?;
        let split = self.split();
        let own: BTreeSet<String> = (0..split.len()).map(part::name).collect();
        let (mut shelf, mut kept, mut changed, mut done) = (Shelf::default(), 0, 0, 0);
        for (number, pairs) in split.iter().enumerate() {
            match self.write_part(&parts, number, pairs, &mut shelf, (done, tell))? {
                PartWritten::Kept => kept += 1,
                PartWritten::Changed => changed += 1,
                PartWritten::New => {}
            }
            done += pairs.all().count();
            tell(done, self.pairs())?;
        }
        parts.remove(|name| part::is_part(name) && !own.contains(name))?;
        let (pairs, with_conicity, with_finding) = page::write(&self.listed, &folder, &parts, &split)?;
        Ok(FleetOutcome { pairs, with_conicity, with_finding, kept, changed })
    }

    /// Computes one part, from 0, unless it is there: what one of many machines does, before [`Fleet::run`] on one of them.
    ///
    /// # Errors
    /// No such part; the errors of [`Fleet::run`].
    pub fn part(&self, out: &Path, number: usize) -> Result<()> {
        let split = self.split();
        let Some(pairs) = split.get(number) else {
            let expected = format!("one of {} parts", split.len());
            return Err(Error::new("part", number.to_string(), expected, "count from 0"));
        };
        let parts = self.opened(out)?.part(PARTS)?;
        self.write_part(&parts, number, pairs, &mut Shelf::default(), (0, &|_, _| Ok(()))).map(drop)
    }

    fn opened(&self, out: &Path) -> Result<KeptFolder> {
        let folder = KeptFolder::open(out, FOLDER)?;
        let echo = scene::echo(&self.listed.scene, "fleet");
        let marker = serde_json::json!({ "program": "wheelrail", "scene": echo.scene, "wheelsets": self.listed.wheelsets.len(),
            "sections": self.listed.sections.len(), "parts": self.parts() });
        folder.write(MARKER, format!("{marker:#}\n").as_bytes())?;
        Ok(folder)
    }

    /// Divides the pairs into parts, whatever the machine.
    fn split(&self) -> Vec<Pairs> {
        let mut parts = Vec::new();
        for sections in ranges(self.listed.sections.len(), MOST_SECTIONS) {
            let [least, most] = WHEELSETS;
            let wheelsets = (PAIRS / sections.len()).clamp(least, most);
            let own = ranges(self.listed.wheelsets.len(), wheelsets);
            parts.extend(own.map(|wheelsets| Pairs { wheelsets, sections: sections.clone() }));
        }
        parts
    }

    fn write_part(
        &self,
        parts: &KeptFolder,
        number: usize,
        pairs: &Pairs,
        shelf: &mut Shelf,
        (before, tell): (usize, &(dyn Fn(usize, usize) -> Result<()> + Sync)),
    ) -> Result<PartWritten> {
        let (hash, name) = (profiles::hash(&self.listed, pairs), part::name(number));
        let there = FleetPart::hash_of(&parts.file(&name));
        if there.as_ref() == Some(&hash) {
            return Ok(PartWritten::Kept);
        }
        shelf.fill(&self.listed, pairs);
        let done = AtomicUsize::new(before);
        let row = |number| {
            let row = pair::row(&self.listed, shelf, number);
            tell(done.fetch_add(1, Ordering::Relaxed) + 1, self.pairs()).map(|()| row)
        };
        let all: Vec<PairNumber> = pairs.all().collect();
        let rows = in_order(all.into_par_iter().map(row))?;
        parts.write(&name, &FleetPart::new(hash, rows).bytes())?;
        Ok(if there.is_some() { PartWritten::Changed } else { PartWritten::New })
    }
}

/// What was done about a part.
enum PartWritten {
    New,
    Kept,
    Changed,
}

/// Divides 0 to `all` into ranges of at most `most`.
fn ranges(all: usize, most: usize) -> impl Iterator<Item = Range<usize>> {
    (0..all).step_by(most).map(move |from| from..(from + most).min(all))
}

/// Refuses a scene by which no pair can be placed, whatever its profiles, and one whose roll is given.
fn checked(scene: &Scene) -> Result<()> {
    let radius = scene.wheel.radius.unwrap_or(460.0);
    let pair = Pair::new(standards::rail("60E1")?, standards::wheel("S1002")?, radius)?;
    let case = scene::with_profiles(scene, Profiles::drawn(pair), "fleet")?;
    let Arrangement::Wheelset { position, .. } = &case.setup().arrangement else {
        let expected = "[track] and [wheelset]";
        return Err(Error::new("", "a single wheel", expected, "a fleet is of wheelsets on tracks"));
    };
    if let Roll::Fixed(angle) = position.roll {
        let expected = "roll = \"solve\" or \"neglect\"";
        return Err(Error::new(
            "wheelset: roll",
            angle.to_string(),
            expected,
            "a held wheelset has no conicity",
        ));
    }
    Ok(())
}

#[cfg(test)]
mod tests;
