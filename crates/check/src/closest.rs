//! Finds the point of a body closest to a point, and the closest points of two bodies, with parry on meshes that shrink around
//! them.

use super::body::{Solid, spread};
use super::meshes::Vector;
use super::patch::{CurveMesh, ParameterPoint};
use super::sampler::SampledSurface;

/// First cell, as a share of the local scale.
const FIRST_CELL: f64 = 1.0 / 16.0;
/// Last cell, as a share of the local scale.
const LAST_CELL: f64 = 1e-6;
/// Number of cells a side.
const CELLS: usize = 4;
/// Factor from the cells of one mesh to those of the next. The place found on one mesh is then well inside the next one.
pub(crate) const CLOSER: f64 = 0.125;

/// Most meshes of a search, sideways moves included.
const MOST_MESHES: usize = 200;

/// Last cell of the pair search, as a share of the local scale: GJK handles pairs of triangles, and its own
/// tolerance shows below this size.
const LAST_PAIR_CELL: f64 = 1e-5;

/// Number of times that each foot of a pair is found anew from the other foot.
const ALTERNATIONS: usize = 4;

/// A closest point on a body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Closest {
    /// Place on the body.
    pub place: ParameterPoint,
    /// Coordinates of the point \[mm\].
    pub point: Vector,
    /// Distance of this point from the other one \[mm\].
    pub distance: f64,
    /// Rigorous bound of the distance's error from the last mesh's chords \[mm\].
    pub error: f64,
}

/// Returns the point of a body that is closest to `point`, over all curves near the coarse result; `None` where the search on one of
/// them, which may hold it, does not settle.
pub(super) fn to_point(solid: &Solid, point: Vector) -> Option<Closest> {
    let near = solid.near(point).into_iter().map(|start| on_curve(&solid.surface, start, point));
    let found: Option<Vec<Closest>> = near.collect();
    found?.into_iter().min_by(|a, b| a.distance.total_cmp(&b.distance))
}

fn on_curve(surface: &SampledSurface, start: ParameterPoint, point: Vector) -> Option<Closest> {
    let mut window = ClosingWindow::new(start, FIRST_CELL);
    for _ in 0..MOST_MESHES {
        let patch = window.patch(surface)?;
        let hit = patch.mesh.closest_to(point);
        let (last, cells) = (window.cell <= LAST_CELL, window.cells(surface));
        if window.move_to(surface, &patch, patch.place(&hit)) && last {
            let place = window.place;
            let [error, _] = surface.chordal_bound(place.curve, place.t, cells);
            return Some(Closest { place, point: hit.point, distance: hit.point.distance(point), error });
        }
    }
    None
}

/// Returns the closest points of the two bodies near a pair of places: \[on the rail, on the wheel\].
pub(super) fn of_bodies(rail: &Solid, wheel: &Solid, start: [ParameterPoint; 2]) -> Option<[Closest; 2]> {
    let mut windows = start.map(|place| ClosingWindow::new(place, FIRST_CELL));
    let surfaces = [&rail.surface, &wheel.surface];
    for _ in 0..MOST_MESHES {
        let patches = [windows[0].patch(surfaces[0])?, windows[1].patch(surfaces[1])?];
        let Some(pair) = patches[0].mesh.closest_pair(&patches[1].mesh) else {
            // Chords of coarse cells may cross where the bodies are apart.
            windows.iter_mut().for_each(|w| w.cell *= CLOSER);
            continue;
        };
        let mut settled = true;
        for k in 0..2 {
            let place = patches[k].place(&patches[k].mesh.closest_to(pair[k]));
            settled &= windows[k].move_to(surfaces[k], &patches[k], place);
        }
        if !settled {
            continue;
        }
        if windows[0].cell <= LAST_PAIR_CELL {
            break;
        }
    }
    let mut feet = None;
    let mut on_wheel = surfaces[1].point(windows[1].place.curve, windows[1].place.t, windows[1].place.v);
    for _ in 0..ALTERNATIONS {
        let below = to_point(rail, on_wheel)?;
        let above = to_point(wheel, below.point)?;
        on_wheel = above.point;
        feet = Some([below, above]);
    }
    feet
}

/// A window of cells around a place. It shrinks from mesh to mesh.
struct ClosingWindow {
    place: ParameterPoint,
    cell: f64,
}

impl ClosingWindow {
    fn new(place: ParameterPoint, cell: f64) -> Self {
        Self { place, cell }
    }

    /// Returns the cell sizes in t and v.
    fn cells(&self, surface: &SampledSurface) -> [f64; 2] {
        let h = self.cell * surface.curves[self.place.curve].scale;
        [h, surface.v_cell(self.place.curve, self.place.t, h)]
    }

    fn patch(&self, surface: &SampledSurface) -> Option<CurveMesh> {
        let [h, k] = self.cells(surface);
        let (ParameterPoint { curve, t, v }, half) = (self.place, CELLS as f64 / 2.0);
        let length = surface.curves[curve].length;
        let t = spread((t - half * h).max(0.0), (t + half * h).min(length), CELLS);
        CurveMesh::new(surface, curve, t, spread(v - half * k, v + half * k, CELLS))
    }

    /// Moves the window to a place of the patch. If the place is inside the patch, the window shrinks. Returns whether it
    /// was inside.
    fn move_to(&mut self, surface: &SampledSurface, patch: &CurveMesh, place: ParameterPoint) -> bool {
        let length = surface.curves[place.curve].length;
        let inside = !patch.at_border(&place, length);
        self.place = ParameterPoint { t: place.t.clamp(0.0, length), ..place };
        if inside {
            self.cell *= CLOSER;
        }
        inside
    }
}
