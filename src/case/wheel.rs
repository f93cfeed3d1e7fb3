//! A wheel that sinks into its rail: the regions of contact that it makes, and the load that they carry.
//!
//! One unknown, how far the wheel sinks, gives every approach: a place of contact whose vertical gap at first touch is g
//! closes by δ = (sunk − g) cosθ along its own normal. Places whose patches overlap are one region, in the frame of the one that
//! touches first or in that of the overlap's centre. The normal forces of all regions add up vertically: Σ F cosθ is the load.

use std::sync::Arc;

use nalgebra::{Point2, Point3, Vector2, Vector3};

use super::input::FrameOrigin;
use super::overlaps::{Overlap, RegionRules, overlaps};
use crate::error::Result;
use crate::load::{HalfSpace, Located, Pressures, WeightedFrame, curvatures, press, under_total};
use crate::lofted::LoftedBody;
use crate::mesh::groups;
use crate::patch::{Patch, Window};
use crate::placement::{Pair, Placement};
use crate::profile::{Side, Station};
use crate::search;

/// An approach to begin with where a place has no ellipse \[mm\].
const USUAL_APPROACH: f64 = 0.05;

/// Largest violation of contact's conditions that pressures may leave, relative to δ: the load errs by less than 0.05 %.
pub(super) const SETTLED: f64 = 3e-4;

/// Tolerance on the load that wheels carry, relative: below the error of the cells.
const CARRIED: f64 = 2e-4;

/// Largest difference of a load on cells half as wide, relative, that needs no finer cells: twice that of Hertz's ellipse. Flats, whose
/// edges are narrower than cells, make up to 3 %.
const ROUGH: f64 = 4e-3;

/// Most times that cells are halved for a load along both axes, and along one.
const MOST_HALVINGS: [u32; 2] = [2, 3];

/// How often cells are halved, and along which axes.
type Halved = (u32, [bool; 2]);

/// A body that varies, and where the wheel stands.
#[derive(Clone, Copy)]
pub(super) struct OnLoft<'a> {
    pub body: &'a LoftedBody,
    /// Coordinate \[mm\] in the list of a rail's slices from which places count.
    pub from: f64,
}

/// Places a pair at a place that a search found.
///
/// # Errors
/// A place of another pair.
pub(super) fn placed_at(place: &search::Contact, pair: &Pair, on: Option<OnLoft<'_>>) -> Result<Placement> {
    on.map_or_else(|| place.placed(pair), |on| place.placed_on(pair, on.body, on.from))
}

/// A wheel over its rail, with the places where it may touch.
pub(super) struct SinkingWheel<'a> {
    pair: &'a Pair,
    on: Option<OnLoft<'a>>,
    /// The first one touches first.
    places: Vec<ReachedPlace>,
    rules: RegionRules,
    /// The pair in a frame whose ζ is vertical, once it was asked for.
    upright: Option<Placement>,
}

/// A place of contact that the wheel closes as it sinks.
struct ReachedPlace {
    /// (x, z) on the rail \[mm\].
    rail: Point2<f64>,
    placing: LazyPlacement,
    /// Vertical gap at first touch \[mm\].
    gap: f64,
    /// Cosine of the angle between its normal and the vertical.
    cos: f64,
    /// Where C lies along the rail \[mm\], in the list's coordinate on one that varies.
    y: f64,
    /// The pressures of its groups of parts under the last approach.
    known: Vec<Pressures>,
}

/// A place as a search found it, until the pair placed there is asked for.
enum LazyPlacement {
    Found(search::Contact),
    Placed(Arc<Placement>),
}

/// The parts of a patch that are one contact.
#[derive(Debug, Clone)]
pub(super) struct ContactRegion {
    /// Index of the place whose frame it has.
    pub place: usize,
    /// Indices of the other places inside.
    pub merged: Vec<usize>,
    pub placement: Arc<Placement>,
    /// δ along the place's normal \[mm\].
    pub approach: f64,
    pub patch: Patch,
    /// The boxes around its groups of parts.
    extents: Vec<Window>,
    /// Normal force of every group of parts \[N\]; empty unless a load was asked for.
    pub loads: Vec<f64>,
    /// Pressures of every group of parts; empty unless a load was asked for.
    pub pressures: Vec<Pressures>,
}

impl ContactRegion {
    /// Finds the region of a place under its approach δ \[mm\].
    fn new(place: usize, placement: Arc<Placement>, approach: f64, rules: &RegionRules) -> Self {
        let patch = Patch::new(&placement, approach, &Window::UNBOUNDED);
        Self::of(place, placement, approach, patch, rules)
    }

    fn of(place: usize, placement: Arc<Placement>, approach: f64, patch: Patch, rules: &RegionRules) -> Self {
        let mut parts = groups(&patch, rules.merge, rules.spacing);
        parts.truncate(if rules.alone { parts.len() } else { 1 });
        let extents = parts.into_iter().map(|group| group.extent).collect();
        let (merged, loads, pressures) = (Vec::new(), Vec::new(), Vec::new());
        Self { place, merged, placement, approach, patch, extents, loads, pressures }
    }

    /// Finds the region of a part of the overlap in a frame, where its place has closed by `closed` \[mm\] along the vertical;
    /// `touching` is the pair placed there.
    ///
    /// # Errors
    /// A wheel with yaw over a roller.
    fn over(
        (place, touching): (usize, &Placement),
        (upright, overlap): (&Placement, &Overlap),
        (frame, closed): (WeightedFrame, f64),
        rules: &RegionRules,
    ) -> Result<Self> {
        let WeightedFrame { rail_x, angle, .. } = frame;
        let placement = Arc::new(touching.reframed(rail_x, angle)?);
        let approach = closed * placement.upright();
        let patch = overlap.patch(upright, &placement, approach, rules.alone);
        // What is one part of the overlap stays one.
        let merge = if rules.alone { rules.merge } else { f64::INFINITY };
        Ok(Self::of(place, placement, approach, patch, &RegionRules { merge, ..*rules }))
    }

    /// Tells whether the group of parts around C, which lies at `y` \[mm\] along the rail, holds a place of contact.
    fn holds(&self, place: &ReachedPlace, y: f64) -> bool {
        let xi = self.placement.rail().contact_frame().inverse_transform_point(&place.rail).x;
        let [xi, eta] = match self.placement.lofted() {
            None => return self.extents.first().is_some_and(|extent| extent.xi.contains(xi)),
            Some(lofted) if lofted.side() == Side::Rail => {
                let [xi, eta, _] = lofted.seen([place.rail.x, place.y, place.rail.y]);
                [xi, eta]
            }
            Some(_) => [xi, place.y - y],
        };
        self.extents.first().is_some_and(|extent| extent.contains(xi, eta))
    }

    /// Gives the vertical displacement of the wheel \[mm\], + down, if this is the region of the place that touches first.
    pub(super) fn sunk(&self) -> f64 {
        self.approach / self.placement.upright()
    }

    /// Gives the vertical part of the normal forces \[N\].
    fn vertical(&self) -> f64 {
        self.loads.iter().sum::<f64>() * self.placement.upright()
    }
}

impl<'a> SinkingWheel<'a> {
    /// Makes a wheel of the places that a search found, the lowest gap first.
    pub(super) fn over(
        pair: &'a Pair,
        on: Option<OnLoft<'a>>,
        places: &[search::Contact],
        rules: RegionRules,
    ) -> Self {
        let reached = |place: &search::Contact| ReachedPlace {
            rail: Point2::new(place.rail_x, place.rail_z),
            placing: LazyPlacement::Found(*place),
            gap: place.gap,
            cos: place.upright(),
            y: place.y + on.map_or(0.0, |on| on.from),
            known: Vec::new(),
        };
        Self { pair, on, places: places.iter().map(reached).collect(), rules, upright: None }
    }

    /// Makes a wheel that touches at chosen points.
    pub(super) fn at_points(pair: &'a Pair, placement: Placement, rules: RegionRules) -> Self {
        let Station { x, z, .. } = placement.rail().point.station;
        let place = ReachedPlace {
            rail: Point2::new(x, z),
            gap: 0.0,
            cos: placement.upright(),
            placing: LazyPlacement::Placed(Arc::new(placement)),
            y: 0.0,
            known: Vec::new(),
        };
        Self { pair, on: None, places: vec![place], rules, upright: None }
    }

    /// Finds the regions under an approach δ \[mm\] of the first place; the first region is that place's.
    ///
    /// # Errors
    /// A place at which the pair cannot be placed; in weighted frames also a wheel with yaw over a roller, and a body that varies.
    pub(super) fn regions(&mut self, first_approach: f64) -> Result<Vec<ContactRegion>> {
        let sunk = self.places.first().map_or(0.0, |first| first_approach / first.cos);
        let centred = match self.rules.frame {
            FrameOrigin::Weighted => true,
            FrameOrigin::Auto => self.several(sunk)?,
            FrameOrigin::Contact => false,
        };
        if centred {
            let regions = self.weighted(sunk)?;
            if regions.first().is_some_and(|first| first.place == 0) {
                return Ok(regions);
            }
        }
        let mut regions: Vec<ContactRegion> = Vec::new();
        for index in 0..self.places.len() {
            let place = &self.places[index];
            let approach = if index == 0 { first_approach } else { (sunk - place.gap) * place.cos };
            if index > 0 && approach <= 0.0 {
                continue;
            }
            let holds = |region: &&mut ContactRegion| region.holds(place, self.places[region.place].y);
            if let Some(region) = regions.iter_mut().find(holds) {
                region.merged.push(index);
                continue;
            }
            regions.push(ContactRegion::new(index, self.placement(index)?, approach, &self.rules));
        }
        Ok(regions)
    }

    /// Finds the regions under a sinking \[mm\], each in the frame at the centre of its overlap; none where the bodies
    /// do not overlap by more than rounding.
    ///
    /// # Errors
    /// A place at which the pair cannot be placed; a wheel with yaw over a roller; a body that varies.
    fn weighted(&mut self, sunk: f64) -> Result<Vec<ContactRegion>> {
        let upright = match self.upright.take() {
            Some(upright) => upright,
            None => upright(&*self.placement(0)?)?,
        };
        let parts = overlaps(&upright, sunk, &self.rules);
        // The places of each part, which has closed there, in the order in which they touch.
        let mut taken: Vec<(usize, Vec<usize>)> = Vec::new();
        for (index, place) in self.places.iter().enumerate() {
            let xi = upright.rail().contact_frame().inverse_transform_point(&place.rail).x;
            let held = |part: &Overlap| part.holds(xi) || self.rules.alone;
            let Some(k) = parts.iter().position(held).filter(|_| place.gap < sunk) else { continue };
            match taken.iter_mut().find(|(part, _)| *part == k) {
                Some((_, own)) => own.push(index),
                None => taken.push((k, vec![index])),
            }
        }
        let mut regions = Vec::new();
        for (part, own) in taken {
            let (index, part) = (own[0], &parts[part]);
            let (touching, closed) = (self.placement(index)?, sunk - self.places[index].gap);
            let Station { x, .. } = touching.rail().point.station;
            let frame = match self.rules.frame {
                FrameOrigin::Auto if own.len() == 1 => part.of_place([x, touching.rail().contact_angle()]),
                _ => Some(part.frame),
            };
            let mut region = match frame {
                None => ContactRegion::new(index, touching, closed * self.places[index].cos, &self.rules),
                Some(frame) => {
                    let in_part = (&upright, part);
                    ContactRegion::over((index, &touching), in_part, (frame, closed), &self.rules)?
                }
            };
            region.merged.extend(&own[1..]);
            regions.push(region);
        }
        self.upright = Some(upright);
        Ok(regions)
    }

    /// Tells whether several places have closed under a sinking \[mm\], and the bodies may be seen from another frame than theirs.
    ///
    /// # Errors
    /// A place at which the pair cannot be placed.
    fn several(&mut self, sunk: f64) -> Result<bool> {
        if self.places.iter().filter(|place| place.gap < sunk).count() < 2 {
            return Ok(false);
        }
        if self.upright.is_none() {
            self.upright = upright(&*self.placement(0)?).ok();
        }
        Ok(self.upright.is_some())
    }

    fn placement(&mut self, index: usize) -> Result<Arc<Placement>> {
        let placement = match &self.places[index].placing {
            LazyPlacement::Placed(placement) => Arc::clone(placement),
            LazyPlacement::Found(found) => Arc::new(placed_at(found, self.pair, self.on)?),
        };
        self.places[index].placing = LazyPlacement::Placed(Arc::clone(&placement));
        Ok(placement)
    }

    /// Finds the normal forces that regions carry, and their pressures, on cells that are halved so many times along some axes.
    fn press(&mut self, regions: &mut [ContactRegion], modulus: f64, (halvings, axes): Halved) -> Result<()> {
        let mut spaces = Vec::new();
        for region in &*regions {
            let place = &self.places[region.place];
            let y = place.y + region.placement.ahead();
            for (k, extent) in region.extents.iter().enumerate() {
                let mut space = HalfSpace::over(&region.placement, extent, region.approach);
                for _ in 0..halvings {
                    space = space.finer(&region.placement, region.approach, axes)?;
                }
                let [xi, eta] = space.middle();
                let (middle, normal) = in_space(&region.placement, y, [xi, eta]);
                let region = match place.known.get(k) {
                    Some(known) => space.beginning_at(known),
                    None => space,
                };
                spaces.push(Located { region, middle, normal });
            }
        }
        let mut pressed = press(&spaces, SETTLED, modulus)?.into_iter();
        for region in regions {
            region.pressures = pressed.by_ref().take(region.extents.len()).collect();
            region.loads = region.pressures.iter().map(Pressures::load).collect();
            self.places[region.place].known.clone_from(&region.pressures);
        }
        Ok(())
    }

    /// Estimates the vertical displacement of the wheel \[mm\] under a load \[N\] from Hertz's ellipse at the first place.
    fn guess(&mut self, load: f64, modulus: f64) -> Result<f64> {
        let ellipse = curvatures(&*self.placement(0)?).under_load(load, modulus);
        Ok(ellipse.map_or(USUAL_APPROACH, |ellipse| ellipse.approach_mm) / self.places[0].cos)
    }
}

/// Gives a point (ξ, η) \[mm\] of the tangent plane and its normal in axes that all regions of a wheel share; `y` is where C lies.
fn in_space(placement: &Placement, y: f64, [xi, eta]: [f64; 2]) -> (Point3<f64>, Vector3<f64>) {
    if let Some(lofted) = placement.lofted_rail() {
        let [along_xi, along_eta, normal] = lofted.axes().map(Vector3::from);
        return (Point3::from(lofted.origin()) + xi * along_xi + eta * along_eta, normal);
    }
    let frame = placement.rail().contact_frame();
    let (at, normal) = (frame * Point2::new(xi, 0.0), frame * Vector2::y());
    (Point3::new(at.x, y + eta, at.y), Vector3::new(normal.x, 0.0, normal.y))
}

/// Gives a placed pair in the frame of the same place whose ζ is vertical.
///
/// # Errors
/// A wheel with yaw over a roller.
fn upright(placement: &Placement) -> Result<Placement> {
    placement.reframed(placement.rail().point.station.x, 0.0).map_err(|mut error| {
        error.place = "patch: frame".into();
        error
    })
}

/// Sinks wheels together until they carry a vertical load \[N\]; gives the regions of each, with forces that add up to the load.
/// `None` if they would have to sink by more than `most` \[mm\].
///
/// Method: secants over half-spaces of every region; those of a wheel press upon each other. The forces are scaled at the end by what
/// the search leaves, 2e-4. Where cells half as wide carry another load, the search goes on with them.
/// Accuracy: see the table in [`docs::loads`](crate::docs::loads). Cost: four half-spaces and patches a region.
///
/// # Errors
/// The errors of [`SinkingWheel::regions`]; pressures that do not settle.
pub(super) fn carry(
    wheels: &mut [SinkingWheel<'_>],
    load: f64,
    modulus: f64,
    most: f64,
) -> Result<Option<Vec<Vec<ContactRegion>>>> {
    if load == 0.0 {
        let untouched = |wheel: &mut SinkingWheel<'_>| {
            let mut regions = wheel.regions(0.0)?;
            regions.truncate(1);
            Ok(regions)
        };
        return wheels.iter_mut().map(untouched).collect::<Result<_>>().map(Some);
    }
    let count = wheels.len() as f64;
    let mut guess = 0.0;
    for wheel in wheels.iter_mut() {
        guess += wheel.guess(load / count, modulus)? / count;
    }
    let Some((mut depth, mut all)) = sinks(wheels, load, modulus, (guess, most), (0, [true; 2]))? else {
        return Ok(None);
    };
    let rough = all.iter().flatten().flat_map(|region| &region.pressures).map(Pressures::rough_axes);
    let axes = rough.reduce(|a, b| [a[0] || b[0], a[1] || b[1]]).unwrap_or([true; 2]);
    let most_halvings = MOST_HALVINGS[usize::from(axes != [true; 2])];
    for halvings in (1..=most_halvings).map(|halvings| (halvings, axes)) {
        let mut finer = all.clone();
        for (wheel, regions) in wheels.iter_mut().zip(&mut finer) {
            wheel.press(regions, modulus, halvings)?;
        }
        if (vertical(&finer) / load - 1.0).abs() <= ROUGH {
            break;
        }
        let Some(found) = sinks(wheels, load, modulus, (depth, most), halvings)? else { return Ok(None) };
        (depth, all) = found;
    }
    let scale = load / vertical(&all);
    for regions in &mut all {
        regions.iter_mut().flat_map(|region| &mut region.loads).for_each(|load| *load *= scale);
        // A region that the others press down by more than its overlap does not touch.
        let mut first = true;
        regions.retain(|region| std::mem::take(&mut first) || region.vertical() > 0.0);
    }
    Ok(Some(all))
}

/// Gives the vertical part of all normal forces \[N\].
fn vertical(all: &[Vec<ContactRegion>]) -> f64 {
    all.iter().flatten().map(ContactRegion::vertical).sum()
}

/// Sinks wheels together, from a guess on and by at most so much \[mm\], until they carry a load; gives by how much, and the regions.
fn sinks(
    wheels: &mut [SinkingWheel<'_>],
    load: f64,
    modulus: f64,
    (guess, most): (f64, f64),
    halvings: Halved,
) -> Result<Option<(f64, Vec<Vec<ContactRegion>>)>> {
    let mut failure = None;
    let mut sink = |sunk: f64| -> Vec<Vec<ContactRegion>> {
        let pressed = wheels.iter_mut().map(|wheel| {
            let mut regions = wheel.regions(sunk * wheel.places[0].cos)?;
            wheel.press(&mut regions, modulus, halvings)?;
            Ok(regions)
        });
        pressed.collect::<Result<_>>().unwrap_or_else(|error| {
            failure = Some(error);
            Vec::new()
        })
    };
    // The solution is mostly the last trial.
    let mut last = (f64::NAN, Vec::new());
    let total = |sunk| {
        last = (sunk, sink(sunk));
        vertical(&last.1)
    };
    let found = under_total(total, load, guess, most, CARRIED);
    let regions = found.map(|sunk| if last.0 == sunk { last } else { (sunk, sink(sunk)) });
    failure.map_or(Ok(regions), Err)
}
