//! A position of a sweep is found alike whatever was found before it, on however many threads.

use rayon::ThreadPoolBuilder;
use wheelrail::error::Result;
use wheelrail::internal::Random;
use wheelrail::measured::{CurveKind, Format, Options};
use wheelrail::search::ParallelSweep;
use wheelrail::{
    Pair, Position, Profile, RailDistance, Roll, Selection, WheelDistance, WheelsetOnTrack, inclination,
    standards,
};
use wheelrail_report::specimen::{Instrument, Specimen, SpecimenKind};

use super::campaign::scenes;

/// What is found at every position, each as text with all digits.
fn found(system: &WheelsetOnTrack, positions: &[Position], threads: usize) -> Result<Vec<String>> {
    let selection = Selection { within: 0.5, apart: 0.5 };
    let sweep = ParallelSweep { system, selection, conicity: None, positions };
    let pool = ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    let mut all = Vec::new();
    pool.install(|| {
        sweep.blocks::<Vec<String>>(
            |made, _, rows| {
                made.push(format!("{rows:?}"));
                Ok(())
            },
            |_, chunks| {
                all.extend(chunks.into_iter().flatten());
                Ok(true)
            },
        )
    })?;
    Ok(all)
}

#[test]
fn sweeps_in_any_order_give_the_same_bits() -> Result<()> {
    let worn = |kind: SpecimenKind, curve: CurveKind| -> Result<Profile> {
        let specimen = Specimen::new(kind, Instrument::new(0.25, 3.0, 5))?;
        let options = Options { curve: Some(curve), ..specimen.options(Format::Csv) };
        Ok(specimen.measured_with(Format::Csv, &options)?.profile)
    };
    let rail = standards::rail("60E1")?.rotated(inclination(1.0, 40.0)?);
    let drawn = Pair::new(rail, standards::wheel("S1002")?, 460.0)?;
    let mut pairs = vec![drawn];
    for curve in [CurveKind::Smoothing, CurveKind::Interpolation] {
        let [rail, wheel] = [SpecimenKind::WornRail, SpecimenKind::WornWheel].map(|kind| worn(kind, curve));
        pairs.push(Pair::new(rail?, wheel?, 460.0)?);
    }
    let backs = WheelDistance::BackToBack { distance: 1360.0, flange_back_x: -70.0 };
    let mut random = Random::new(331);
    let count = scenes().max(100);
    for pair in &pairs {
        let system = WheelsetOnTrack::new(pair, RailDistance::Gauge { gauge: 1435.0, height: 14.0 }, backs)?;
        let at = |k: u64| {
            let lateral = 9.0 * (2.0 * k as f64 / (count - 1) as f64 - 1.0);
            let roll = if k.is_multiple_of(3) { Roll::Neglect } else { Roll::Solve };
            Position { lateral, yaw: if k.is_multiple_of(2) { 0.0 } else { 0.01 }, roll }
        };
        let positions: Vec<Position> = (0..count).map(at).collect();
        let mut order: Vec<usize> = (0..positions.len()).collect();
        order.sort_by_cached_key(|_| random.bits());
        let shuffled: Vec<Position> = order.iter().map(|&k| positions[k]).collect();
        let expected = found(&system, &positions, 1)?;
        assert_eq!(found(&system, &positions, 3)?, expected);
        for (row, &k) in found(&system, &shuffled, 2)?.iter().zip(&order) {
            assert_eq!(*row, expected[k], "{:?}", positions[k]);
        }
    }
    Ok(())
}
