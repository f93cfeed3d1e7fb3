//! Specimens: the files that instruments might have written.

use wheelrail::Result;
use wheelrail::measured::Format;
use wheelrail_report::specimen::{Instrument, Specimen, SpecimenKind};

#[test]
fn every_kind_reads_back_in_every_format_as_it_was_measured() -> Result<()> {
    let mut seed = 60;
    for kind in SpecimenKind::RAILS.into_iter().chain(SpecimenKind::WHEELS) {
        for format in Format::ALL {
            seed += 1;
            let instrument = Instrument { pits: 2, flats: 1, ..Instrument::new(0.2, 3.0, seed) };
            let specimen = Specimen::new(kind, instrument)?;
            let read = specimen.measured(format)?;
            let back: Vec<[f64; 2]> = read.points.iter().map(|p| p.xz()).collect();
            if format != Format::Vampire {
                assert_eq!(back, specimen.points, "{kind:?} {format:?} seed {seed}");
                continue;
            }
            // Vampire's heads set the origin: the points are shifted all alike.
            let shift = [0, 1].map(|k| back[0][k] - specimen.points[0][k]);
            assert_eq!(back.len(), specimen.points.len());
            for (p, q) in back.iter().zip(&specimen.points) {
                assert!(
                    (0..2).all(|k| (p[k] - q[k] - shift[k]).abs() < 1e-9),
                    "{kind:?} seed {seed}: {p:?} {q:?}"
                );
            }
        }
    }
    Ok(())
}

#[test]
fn spacing_noise_and_seed_are_what_they_are_called() -> Result<()> {
    let clean = Specimen::new(SpecimenKind::FullHead, Instrument::new(0.05, 0.0, 1))?;
    let noisy = Specimen::new(SpecimenKind::FullHead, Instrument::new(0.05, 20.0, 1))?;
    assert_eq!(clean.points.len(), noisy.points.len());
    assert!((2500..3500).contains(&clean.points.len()), "{}", clean.points.len());
    let steps = clean.points.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]));
    assert!(steps.clone().all(|step| (0.02..=0.1).contains(&step)), "{:?}", steps.fold(0.0, f64::max));
    let off: Vec<f64> =
        clean.points.iter().zip(&noisy.points).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).collect();
    let rms = (off.iter().map(|d| d * d).sum::<f64>() / off.len() as f64).sqrt();
    // Averaged along a line between two normal numbers, the mean square is two thirds of theirs.
    assert!((rms - 0.020 * (2.0f64 / 3.0).sqrt()).abs() < 0.002, "{rms}");
    let other = Specimen::new(SpecimenKind::FullHead, Instrument::new(0.05, 20.0, 2))?;
    assert!(other.points != noisy.points);
    assert_eq!(Specimen::new(SpecimenKind::FullHead, noisy.instrument)?, noisy);
    Ok(())
}

#[test]
fn overhangs_grooves_and_hollows_are_there() -> Result<()> {
    let specimen = |kind| Specimen::new(kind, Instrument::new(0.1, 0.0, 5));
    let lipped = specimen(SpecimenKind::LippedRail)?.points;
    assert!(lipped.windows(2).any(|p| p[1][0] < p[0][0] - 1e-3), "no overhang");
    let grooved = specimen(SpecimenKind::GroovedRail)?.points;
    assert!(grooved.iter().any(|p| p[1] < -46.0 && (-70.0..-40.0).contains(&p[0])));
    let hollow = specimen(SpecimenKind::HollowWheel)?.points;
    let at = |x: f64| hollow.iter().find(|p| p[0] > x).map_or(f64::NAN, |p| p[1]);
    // The material is above, so that the worn tread is higher than the field side.
    assert!(at(6.0) > at(40.0) + 1.0, "{} {}", at(6.0), at(40.0));
    Ok(())
}
