//! How fleets are divided, and where what is read comes from.

use super::list::{ListedWheelset, Source};
use super::profiles::{data, keys};
use super::*;
use crate::scene::SideData;

fn fleet(wheelsets: usize, sections: usize) -> Fleet {
    let source = |k: usize| Source::File(format!("{k}").into());
    let wheelset = |k: usize| ListedWheelset {
        name: k.to_string(),
        wheels: [source(k), source(k)],
        radii: [None; 2],
        rails: None,
    };
    let mirrored = ProfileData { mirror: Some(true), ..Default::default() };
    Fleet {
        listed: Listed {
            scene: Scene {
                left: Some(SideData { wheel: Some(mirrored), ..Default::default() }),
                ..Default::default()
            },
            folder: "scenes".into(),
            wheelsets: (0..wheelsets).map(wheelset).collect(),
            sections: (0..sections).map(|k| Some(source(k))).collect(),
        },
    }
}

#[test]
fn parts_hold_every_pair_once_and_are_of_bounded_size() {
    for (wheelsets, sections) in [(1, 1), (1000, 1), (7, 300), (130, 40), (3, 513)] {
        let fleet = fleet(wheelsets, sections);
        let mut seen = vec![false; fleet.pairs()];
        for part in fleet.split() {
            assert!(part.all().count() <= PAIRS.max(WHEELSETS[0] * MOST_SECTIONS));
            assert!(part.wheelsets.len() <= WHEELSETS[1] && part.sections.len() <= MOST_SECTIONS);
            for number in part.all() {
                let at = number.wheelset * sections + number.section;
                assert!(!std::mem::replace(&mut seen[at], true), "{number:?} twice");
            }
        }
        assert!(seen.into_iter().all(|seen| seen), "{wheelsets} wheelsets on {sections} sections");
    }
}

#[test]
fn a_side_with_options_of_its_own_has_profiles_of_its_own() {
    let fleet = fleet(1, 1);
    let [rails, wheels] = keys(&fleet.listed, PairNumber { wheelset: 0, section: 0 });
    assert!(rails[0] == rails[1] && wheels[0] != wheels[1] && wheels[0].source == wheels[1].source);
    assert_eq!([0, 1].map(|k| data(&fleet.listed, &wheels[k]).mirror), [Some(true), None]);
}
