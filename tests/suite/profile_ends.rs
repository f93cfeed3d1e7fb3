//! Contacts at the open ends of profiles: what stands beyond was not measured, and is no surface.

use std::path::PathBuf;

use wheelrail::case::{Arrangement, DoubtKind, Run, SILENT};
use wheelrail::error::Result;
use wheelrail::internal::Random;
use wheelrail::measured::{CurveKind, Options, profile};
use wheelrail::profile::trace;
use wheelrail::search::{ONE_CONTACT, Position, Roll, Selection, Sweep};
use wheelrail::{Pair, Profile, Side, inclination, scene, standards};

use crate::campaign;
use crate::common::repository;

/// The part of a profile between two abscissae, as an instrument measures it.
fn part(drawn: &Profile, side: Side, [from, to]: [f64; 2]) -> Result<Profile> {
    let marks = trace(drawn, 0.3);
    let inside = marks.windows(2).filter(|pair| pair[1].s - pair[0].s > 0.15).map(|pair| pair[0].station);
    let points: String =
        inside.filter(|at| (from..=to).contains(&at.x)).map(|at| format!("{},{}\n", at.x, at.z)).collect();
    let options = Options {
        mirror: Some(false),
        flip_z: Some(false),
        curve: Some(CurveKind::Interpolation),
        ..Options::default()
    };
    Ok(profile("part.csv", points.as_bytes(), side, &options)?.profile)
}

fn run(pair: &Pair, offset: f64, patch: &str) -> Result<Run> {
    let text = format!(
        "rail.profile = \"60E1\"\nwheel = {{ profile = \"S1002\", radius = 460.0 }}\n[contact]\noffset = {offset}\n{patch}\
         [output]\nformats = []\n"
    );
    let profiles = wheelrail::case::Profiles::drawn(pair.clone());
    Run::new(scene::with_profiles(&scene::parse(&text, false)?, profiles, "end")?, SILENT)
}

/// Whether a run doubts an end.
fn doubts_end(run: &Run) -> bool {
    run.warnings().iter().any(|warning| warning.contains("its profile ends at x = "))
}

/// A pair is cut at a random abscissa. Where the whole pair touches within what is left, by more than its patch, nothing changes; where it
/// touches beyond the cut, the end is doubted, and no pressure is given.
#[test]
fn ends_of_cut_profiles_are_doubted_where_they_touch() -> Result<()> {
    let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
    let wheel = standards::wheel("S1002")?;
    let whole = Pair::new(rail.clone(), wheel.clone(), 460.0)?;
    let load = "[patch]\nload = 60e3\n";
    let (mut at_end, mut inside) = (0, 0);
    for seed in 0..campaign::scenes() {
        let mut dice = Random::stream(8, seed);
        let offset = dice.between(-5.0, 6.0);
        let drawn = run(&whole, offset, load)?;
        assert!(!doubts_end(&drawn), "{offset}: {:?}", drawn.warnings());
        let first = &drawn.parts[0].site.contact.placement;
        let on_wheel = dice.below(2) == 1;
        let x = if on_wheel { first.wheel() } else { first.rail() }.point().station.x;
        // To the flange side of the cut nothing was measured, or to the field side.
        let away = dice.between(0.3, 40.0);
        let (beyond, field) = (dice.below(2) == 0, dice.below(2) == 0);
        let cut = x + if beyond == field { -away } else { away };
        let kept = if field { [-200.0, cut] } else { [cut, 200.0] };
        let side = if on_wheel { Side::Wheel } else { Side::Rail };
        let Ok(left) = part(if on_wheel { &wheel } else { &rail }, side, kept) else { continue };
        let short = if on_wheel { whole.with_wheel(left)? } else { whole.with_rail(left)? };
        let Ok(found) = run(&short, offset, load) else { continue };
        let known = found.parts.iter().all(|part| part.analysis.pressure.is_some());
        let patch =
            drawn.parts[0].site.contact.whole_patch().and_then(wheelrail::Patch::extent).expect("a patch");
        let (name, side) = (format!("{seed}: {offset} {cut} {on_wheel} {field}"), patch.xi.width());
        // How far the patch reaches towards the cut, along x.
        let reach = [-patch.xi.low, patch.xi.high][usize::from(field)] * first.rail().contact_angle().cos();
        if !beyond && away > 1.1 * side && found.parts.len() == drawn.parts.len() && drawn.parts.len() == 1 {
            assert!(!doubts_end(&found), "{name}: {:?}", found.warnings());
            inside += usize::from(known);
        }
        // A contact with the end itself, wherever it came to lie.
        let touching = found.parts.iter().any(|part| {
            let body = if on_wheel {
                part.site.contact.placement.wheel()
            } else {
                part.site.contact.placement.rail()
            };
            let ends = [
                body.profile().segments().first().map(|s| s.start()),
                body.profile().segments().last().map(|s| s.end()),
            ];
            ends.into_iter().flatten().any(|end| (end.x - body.point().station.x).abs() < 1e-7)
        });
        if touching || (!beyond && away < 0.6 * reach && drawn.parts.len() == 1) {
            assert!(doubts_end(&found) && !known, "{name}: {:?}", found.warnings());
            let part =
                found.parts.iter().find(|part| part.site.contact.open_end().is_some()).expect("an end");
            assert!(part.analysis.pressure.is_none() && part.hertz_pressure().is_none(), "{name}");
            at_end += 1;
        }
    }
    assert!(at_end > 1 && inside > 1, "{at_end} {inside}");
    Ok(())
}

#[test]
fn scenes_at_the_end_of_a_profile_have_a_doubt_and_no_pressure() -> Result<()> {
    let folder = repository("tests/defects");
    let case = scene::resolve(&scene::load(&folder.join("profile-end.toml"))?, &folder, "end")?;
    let found = Run::new(case, SILENT)?;
    assert!(doubts_end(&found) && found.parts[0].analysis.pressure.is_none(), "{:?}", found.warnings());
    let Some(contact) = std::env::var_os("WHEELRAIL_CONTACT").map(PathBuf::from) else { return Ok(()) };
    let text = "[rail]\nfile = \"testbank/profiles/rail_left_iter795.ban\"\nmirror = true\nflip_z = false\n[wheel]\n\
                file = \"testbank/profiles/whl_left_iter795.whl\"\nradius = 430.0\n[track]\ngauge = 1437\n[wheelset]\nback_to_back = 1360\n\
                flange_back_x = 0\n[patch]\nload = 80000.0\n[output]\nformats = []\n";
    let case = scene::resolve(&scene::parse(text, false)?, &contact, "end")?;
    let found = Run::new(case, SILENT)?;
    assert!(found.parts.iter().all(|part| part.analysis.pressure.is_none()), "{:?}", found.warnings());
    assert_eq!(found.warnings().iter().filter(|text| text.contains("its profile ends at x = ")).count(), 2);
    Ok(())
}

/// Sweeps name it at each contact, further ones included, under the word that the page on sweeps has.
#[test]
fn sweeps_doubt_contacts_at_an_end() -> Result<()> {
    let folder = repository("tests/defects");
    let text = "[rail]\nfile = \"short.csv\"\nmirror = false\nflip_z = false\ncurve = \"interpolation\"\n[wheel]\nprofile = \"S1002\"\n\
                radius = 460.0\n[track]\nspacing = 1500.0\n[wheelset]\nspacing = 1500.0\n";
    let case = scene::resolve(&scene::parse(text, false)?, &folder, "end")?;
    let Arrangement::Wheelset { system, .. } = &case.setup().arrangement else { panic!("a wheelset") };
    let mut sweep = Sweep::new(system, Selection { within: 1.0, apart: ONE_CONTACT }, None);
    let (marks, mut told) = (case.profiles().landmarks(), 0);
    for lateral in [-3.0, 0.0, 3.0] {
        let mut rows = Vec::new();
        sweep.position(&Position { lateral, yaw: 0.0, roll: Roll::Neglect }, &mut rows)?;
        for (row, doubts) in marks.of_rows(&rows) {
            let has = doubts.list().any(|(kind, _)| kind == DoubtKind::ProfileEnd);
            assert_eq!(has, (row.contact.rail_x + 36.0).abs() < 1e-7, "{row:?}");
            assert_eq!(doubts.kinds().to_string().contains("profile-end"), has);
            told += usize::from(has);
        }
    }
    assert!(told > 0);
    Ok(())
}
