//! A place of contact: where it comes from, what is known of it, and what makes it again.

use std::sync::{Arc, OnceLock};

use pyo3::prelude::*;
use wheelrail::case::PlacedContact;
use wheelrail::search::{self, TrackSide};
use wheelrail::{Error, Placement};

use crate::errors::{OrRaise, exception};

/// A place of contact of a pair.
#[derive(Clone)]
pub(crate) struct PairContact {
    /// What messages call it.
    pub(crate) name: String,
    /// Side and number of a contact that was found.
    pub(crate) place: Option<FoundAt>,
    pub(crate) origin: ContactOrigin,
    /// Position along the rail and gap at first touch \[mm\].
    pub(crate) y: f64,
    pub(crate) gap: f64,
    /// Approach \[mm\] and normal force \[N\] of a case's contact.
    pub(crate) approach: Option<f64>,
    pub(crate) normal_load: Option<f64>,
    pub(crate) pair: wheelrail::Pair,
    /// Made when it is first asked for.
    placement: OnceLock<Placement>,
}

/// Where a contact comes from, and what makes it again.
#[derive(Clone)]
pub(crate) enum ContactOrigin {
    /// A search.
    Found(search::Contact),
    /// Chosen abscissae on rail and wheel \[mm\], and the skew \[rad\].
    Chosen([f64; 3]),
    /// A case, by its number there.
    OfCase(Arc<Py<PyAny>>, usize),
}

/// Where a contact was found.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FoundAt {
    pub(crate) side: &'static str,
    /// From 1.
    pub(crate) number: usize,
}

impl PairContact {
    pub(crate) fn found(pair: &wheelrail::Pair, found: search::Contact, place: FoundAt) -> Self {
        Self {
            name: format!("{} {}", place.side, place.number),
            place: Some(place),
            origin: ContactOrigin::Found(found),
            y: found.y,
            gap: found.gap,
            approach: None,
            normal_load: None,
            pair: pair.clone(),
            placement: OnceLock::new(),
        }
    }

    pub(crate) fn chosen(placement: Placement, points: [f64; 3]) -> Self {
        Self {
            name: "chosen".into(),
            place: None,
            origin: ContactOrigin::Chosen(points),
            y: 0.0,
            gap: 0.0,
            approach: None,
            normal_load: None,
            pair: placement.pair(),
            placement: placement.into(),
        }
    }

    /// Takes over the contact of a case with this number.
    pub(crate) fn of_case(case: Py<PyAny>, number: usize, contact: PlacedContact) -> Self {
        let found = contact.found.as_ref();
        let place = found.map(|found| FoundAt {
            side: found.side.map_or("single", TrackSide::name),
            number: found.contact,
        });
        Self {
            name: contact.name(),
            place,
            y: found.map_or(0.0, |found| found.place.y_mm),
            gap: found.map_or(0.0, |found| found.place.gap_mm),
            origin: ContactOrigin::OfCase(Arc::new(case), number),
            approach: contact.approach,
            normal_load: contact.is_loaded().then(|| contact.normal_loads.iter().sum()),
            pair: contact.placement.pair(),
            placement: contact.placement.into(),
        }
    }

    pub(crate) fn search(&self) -> Option<&search::Contact> {
        match &self.origin {
            ContactOrigin::Found(found) => Some(found),
            ContactOrigin::Chosen(_) | ContactOrigin::OfCase(..) => None,
        }
    }

    pub(crate) fn placement(&self) -> PyResult<&Placement> {
        if let (None, Some(found)) = (self.placement.get(), self.search()) {
            let placement = found.placed(&self.pair).or_raise()?;
            return Ok(self.placement.get_or_init(|| placement));
        }
        self.placement.get().ok_or_else(|| {
            exception(Error::new(
                "contact",
                "no placement",
                "a contact that was found or placed",
                "report this",
            ))
        })
    }

    /// Tells whether two contacts have the same origin and name, and equal pairs.
    ///
    /// # Errors
    /// Those of comparing two cases.
    pub(crate) fn same(&self, py: Python<'_>, other: &Self) -> PyResult<bool> {
        let same = match (&self.origin, &other.origin) {
            (ContactOrigin::Found(a), ContactOrigin::Found(b)) => a == b,
            (ContactOrigin::Chosen(a), ContactOrigin::Chosen(b)) => a == b,
            (ContactOrigin::OfCase(case, a), ContactOrigin::OfCase(other, b)) => {
                a == b && case.bind(py).eq(other.bind(py))?
            }
            _ => false,
        };
        let [one, two] = [&self.pair, &other.pair];
        let radii = |pair: &wheelrail::Pair| (pair.wheel_radius(), pair.roller_radius());
        let bodies = one.rail() == two.rail() && one.wheel() == two.wheel() && radii(one) == radii(two);
        Ok(same && self.name == other.name && bodies)
    }
}

/// Makes a pair of the library from its parts; radii \[mm\].
pub(crate) fn joined(
    rail: wheelrail::Profile,
    wheel: wheelrail::Profile,
    radius: f64,
    roller: Option<f64>,
) -> wheelrail::Result<wheelrail::Pair> {
    let pair = wheelrail::Pair::new(rail, wheel, radius)?;
    roller.map_or_else(|| Ok(pair.clone()), |radius| pair.on_roller(radius))
}
