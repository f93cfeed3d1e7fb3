//! Computes the equivalent conicity of a sweep's positions, and the remarks that a user should read.

use crate::answer::counted;
use wheelrail::search::{ACCURACY, Conicity, Equivalent, NoConicity, Position, free};

/// Relative errors that divide the conicities that have not converged into classes.
const CLASSES: [f64; 2] = [1e-3, 1e-2];

/// Returns remarks on positions whose conicity is inaccurate, or missing although both wheels touch.
pub(super) fn remarks(conicity: &Conicity, positions: &[Position]) -> Vec<String> {
    let found: Vec<ConicityFound> = free(positions).map(|position| conicity.at(position.lateral)).collect();
    let inaccurate = inaccurate(&found).map(|text| format!("{text}, after {} searches", conicity.searches()));
    inaccurate.into_iter().chain(missing(&found)).collect()
}

type ConicityFound = std::result::Result<Equivalent, NoConicity>;

fn inaccurate(found: &[ConicityFound]) -> Option<String> {
    let open = || found.iter().flatten().filter(|found| !found.converged());
    let class = |found: &Equivalent| CLASSES.iter().take_while(|limit| found.error > **limit).count();
    let names = CLASSES.map(|limit| format!("up to {limit:e}")).into_iter().chain(["more".into()]);
    let counts: Vec<String> = names
        .enumerate()
        .map(|(k, name)| (open().filter(|found| class(found) == k).count(), name))
        .filter(|(count, _)| *count > 0)
        .map(|(count, name)| format!("{count} {name}"))
        .collect();
    (open().count() > 0).then(|| {
        format!(
            "conicity of {} of {} positions is not converged to {ACCURACY:e}; estimated relative errors: {}",
            open().count(),
            found.len(),
            counts.join(", ")
        )
    })
}

fn missing(found: &[ConicityFound]) -> Vec<String> {
    let reasons = [
        (NoConicity::NotRestoring, "from which the movement does not come back"),
        (NoConicity::OffTrack, "from which a wheel leaves its rail before the movement turns"),
        (NoConicity::NoCentre, "since the wheels have equal rolling radii nowhere on the track"),
    ];
    let counted = reasons.map(|(why, said)| {
        let count = found.iter().filter(|found| **found == Err(why)).count();
        (count > 0).then(|| format!("no conicity at {}, {said}", counted(count, "position")))
    });
    counted.into_iter().flatten().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_converged_is_counted_by_its_error() {
        let found = |error| Ok(Equivalent { conicity: 0.1, error });
        let all = [found(1e-5), found(1e-4), Err(NoConicity::NoAmplitude), Err(NoConicity::OffTrack)];
        let off = "no conicity at 1 position, from which a wheel leaves its rail before the movement turns";
        assert_eq!((inaccurate(&all), missing(&all)), (None, vec![off.to_owned()]));
        let all = [found(2e-4), found(1e-3), found(0.5), found(0.0), Err(NoConicity::NotRestoring)];
        let expected = "conicity of 3 of 5 positions is not converged to 1e-4; estimated relative errors: 2 up to 1e-3, 1 more";
        assert_eq!(inaccurate(&all).as_deref(), Some(expected));
        let expected = "no conicity at 1 position, from which the movement does not come back";
        assert_eq!(missing(&all), [expected]);
    }
}
