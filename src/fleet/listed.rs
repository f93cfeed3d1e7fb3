//! What a fleet is made of: the scene that all share, its wheelsets and its rail sections; and which pair is meant.

use std::ops::Range;
use std::path::PathBuf;

use super::list::{ListedWheelset, Source};
use crate::scene::{self, Scene};

/// The wheelsets and the sections, of which no profile was read.
#[derive(Debug, Clone)]
pub(super) struct Listed {
    pub scene: Scene,
    pub folder: PathBuf,
    pub wheelsets: Vec<ListedWheelset>,
    /// The sections; `None` stands for each wheelset's own rails, or the scene's.
    pub sections: Vec<Option<Source>>,
}

impl Listed {
    /// Lists what is allowed in the keys of the shared scene but seldom meant.
    pub fn warnings(&self) -> Vec<String> {
        scene::doubts_of_keys(&self.scene).iter().map(ToString::to_string).collect()
    }
}

/// Where a pair stands in a fleet.
#[derive(Debug, Clone, Copy)]
pub(super) struct PairNumber {
    pub wheelset: usize,
    pub section: usize,
}

/// The pairs of a part.
#[derive(Debug, Clone)]
pub(super) struct Pairs {
    pub wheelsets: Range<usize>,
    pub sections: Range<usize>,
}

impl Pairs {
    /// Lists all pairs, wheelset by wheelset, each over the sections in order.
    pub fn all(&self) -> impl Iterator<Item = PairNumber> {
        let sections = self.sections.clone();
        self.wheelsets
            .clone()
            .flat_map(move |wheelset| sections.clone().map(move |section| PairNumber { wheelset, section }))
    }
}
