//! Finds the connected components of the patch {s < δ} inside a window, and the closed loops around each.

use super::band::{Band, ONE_SIDE};
use super::corners;
use super::end::End;
use super::fibres;
use super::lines::bands;
use super::lines::joints::PassedJoints;
use super::loops;
use super::loops::Rows;
use super::measure::area_and_length;
use super::outline::Outline;
use super::slice::Slice;
use super::window::Window;
use crate::conformal::Reference;
use crate::numerics::interval::Interval;
use crate::placement::Placement;

/// Number of points on each of the two sides of a loop. The polygon then lies within 1e-4 of the patch's width of the
/// curve. Pieces between corners share the points: on an ellipse as long as the component, each piece would get points in
/// proportion to its angle. Where an end of the wheel bounds a short piece that is as wide as the component, it gets as many as on an
/// ellipse of that width.
const POINTS_PER_SIDE: usize = 128;

/// Least number of points on a piece of a loop between two corners.
const LEAST_POINTS: usize = 2;

/// One connected component of the patch.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Range of ξ \[mm\].
    pub xi: Interval,
    /// What bounds the component at either end of its range of ξ.
    pub ends: [End; 2],
    /// Range of η \[mm\].
    pub eta: Interval,
    /// Both ends of the range of ξ, and every ξ between them where the boundary may have a corner \[mm\],
    /// ascending.
    pub corners: Vec<f64>,
    /// Whether the window cuts the component anywhere.
    pub cut_by_window: bool,
    /// Outer boundary: a closed loop of \[ξ, η\] \[mm\], counter-clockwise seen from +ζ. The first point is
    /// not repeated; the tips are exact.
    pub boundary: Vec<[f64; 2]>,
    /// Boundaries of the holes: closed loops of \[ξ, η\] \[mm\], clockwise. Only a skewed wheel or a body that varies makes
    /// holes.
    pub holes: Vec<Vec<[f64; 2]>>,
    /// Area \[mm²\], with a relative accuracy of about 1e-12, or of the rounding of s over δ if that is larger.
    pub area: f64,
    /// Length of all loops \[mm\], with a relative accuracy of about 1e-10; 1e-7 where the end of a tilted wheel profile
    /// rounds the boundary.
    pub perimeter: f64,
    /// \[s, ξ, η\] of the point with the smallest s \[mm\].
    pub deepest: [f64; 3],
    /// The bands that make up the component, by ascending ξ.
    pub(crate) bands: Vec<Band>,
}

impl Component {
    /// Returns the rectangle around the component.
    pub fn extent(&self) -> Window {
        Window { xi: self.xi, eta: self.eta }
    }
}

/// The patch {s < δ} inside a window.
///
/// # Examples
/// ```
/// # use wheelrail::{Arc, Half, Pair, Profile, Segment};
/// use wheelrail::{Patch, Window};
/// # let rail = Arc::about([0.0, -300.0], 300.0, Half::Upper, [-35.0, 35.0])?;
/// # let rail = Profile::new("crown", "", vec![Segment::arc(rail)])?;
/// # let wheel = Profile::new("cylinder", "", vec![Segment::arc(Arc::line([-60.0, 0.0], [60.0, 0.0])?)])?;
/// # let pair = Pair::new(rail, wheel, 460.0)?;
/// let placement = pair.placed(0.0, 0.0, 0.0)?; // a crown of 300 mm below a cylinder of 460 mm
/// let patch = Patch::new(&placement, 0.05, &Window::UNBOUNDED);
/// let component = &patch.components[0];
/// let half = f64::sqrt(300.0 * 300.0 - 299.95 * 299.95);
/// assert!((component.xi.high - half).abs() < 1e-11);
/// assert!((patch.area() / (std::f64::consts::PI * half * component.eta.high) - 1.0).abs() < 1e-3); // nearly an ellipse
/// # Ok::<(), wheelrail::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Patch {
    /// Approach δ \[mm\].
    pub approach: f64,
    /// The window in which the patch was searched for.
    pub window: Window,
    /// The connected components, by ascending ξ.
    pub components: Vec<Component>,
}

impl Patch {
    /// Finds all components inside the window. A line of constant ξ meets a component in one interval of η. Under a skewed wheel, beyond the
    /// end of a tilted body, and where the patch is found from samples, it may meet it in several, and a component may have holes.
    ///
    /// Degenerate cases: the patch is empty if s < δ nowhere, at a mere touch with δ = 0, and for δ = NaN. A part is missed only where it is
    /// shallower than 1e-12 mm; of several slices of a line where it is shallower than 1e-8 mm and narrower than 1e-6 R along ξ; and beside an
    /// upright place of a body, within 1/512 of the range of ξ.
    ///
    /// Where a body varies the patch is found from samples: a part is missed if it does not hold C and is narrower than 0.5 mm along ξ, or
    /// than 0.25 to 1 mm along η, or shallower than 1e-11 mm; what lies more than 120 mm and 2 √(2Rδ) ahead of C or behind is left out, and
    /// the boundary is interpolated to 1e-9 of its width.
    pub fn new(placement: &Placement, approach: f64, window: &Window) -> Self {
        Self::of(Outline::new(placement, approach, window, Reference::Plane))
    }

    /// Finds all components of the conformal patch {t < δ cos α} over the rail's surface, inside a window of σ and η: wherever this type
    /// says ξ it is σ, and s is t + δ (1 − cos α). Area \[mm²\] and perimeter \[mm\] are those on the rail's surface.
    ///
    /// Degenerate cases: the patch is empty if t < δ cos α nowhere, for δ = NaN, and if the rail has no surface at C. A part is missed as
    /// in [`Self::new`]; over a roller's surface also within 1/512 of the range of σ at a step, and beside a hollow kink of a skewed wheel where
    /// it is shallower than 1e-4 mm. There the patch is found from samples where such a kink gives the lines two lowest places that may differ
    /// by more, or where lines leave a tilted body over its end within the patch and enter it again.
    ///
    /// On a rail the patch is where the point of the rail, raised by δ cos α along its normal, lies in the wheel. Where the wheel's surface
    /// ends or steps within the patch, that is up to δ |sin α| along ξ beside where its points along the normals end.
    pub fn over_rail(placement: &Placement, approach: f64, window: &Window) -> Self {
        Self::of(Outline::new(placement, approach, window, Reference::Rail))
    }

    fn of(mut outline: Outline<'_>) -> Self {
        let components =
            regions(&mut outline).into_iter().map(|region| region.component(&mut outline)).collect();
        Self { approach: outline.slicer.approach(), window: outline.window, components }
    }

    /// Returns the components inside another window, or `None` if that window cuts a component.
    pub fn within(&self, window: &Window) -> Option<Self> {
        let mut components = Vec::new();
        for component in &self.components {
            let extent = component.extent();
            if window.surrounds(&extent) {
                components.push(component.clone());
            } else if extent.meets(window) {
                return None;
            }
        }
        Some(Self { approach: self.approach, window: *window, components })
    }

    /// Returns the intervals of η of the patch at ξ, each with the index of its component, in no order. If some intervals
    /// end at ξ and others begin there, it returns those on the left.
    pub fn slices(&self, xi: f64) -> Vec<(usize, Slice)> {
        let mut slices = Vec::new();
        for (index, component) in self.components.iter().enumerate() {
            let bands = &component.bands;
            let ended = bands.iter().any(|band| band.xi.high == xi);
            let over =
                |band: &&Band| (band.xi.low < xi && xi <= band.xi.high) || (xi == band.xi.low && !ended);
            slices.extend(bands.iter().filter(over).map(|band| (index, band.slice(xi))));
        }
        slices
    }

    /// Returns whether the window cuts any component.
    pub fn cut_by_window(&self) -> bool {
        self.components.iter().any(|component| component.cut_by_window)
    }

    /// Returns the total area \[mm²\].
    pub fn area(&self) -> f64 {
        self.components.iter().fold(0.0, |area, component| area + component.area)
    }

    /// Returns the smallest box around all components, or `None` for an empty patch.
    pub fn extent(&self) -> Option<Window> {
        self.components.iter().map(Component::extent).reduce(Window::hull)
    }
}

/// The bands of one component, before it is measured.
struct BandGroup {
    bands: Vec<Band>,
}

/// Collects the bands of the patch into components, by ascending ξ.
fn regions(outline: &mut Outline<'_>) -> Vec<BandGroup> {
    let (placement, window) = (outline.slicer.placement(), outline.window);
    let (mut bands, lanes) = match &mut outline.slicer.by_samples {
        Some(by_samples) => (Vec::new(), fibres::bands(by_samples, placement, &window)),
        None => bands::bands(outline),
    };
    for (number, (mut band, lane)) in lanes.into_iter().enumerate() {
        band.lane = Some(number);
        bands.push(band);
        outline.slicer.lanes.push(lane);
    }
    bands.sort_by(|a, b| a.xi.low.total_cmp(&b.xi.low));
    let meeting: Vec<[usize; 2]> = (0..bands.len())
        .flat_map(|i| (0..bands.len()).map(move |j| [i, j]))
        .filter(|&[i, j]| bands[i].meets(&bands[j]))
        .collect();
    // For each band, this holds the index of the first band of its component.
    let mut first: Vec<usize> = (0..bands.len()).collect();
    for [i, j] in meeting {
        (bands[i].ends[1], bands[j].ends[0]) = (None, None);
        let ended = bands[i].sides[1];
        // Both found these edges, each in its own way.
        for branch in 0..2 {
            let begun = &mut bands[j].sides[0][branch];
            if (*begun - ended[branch]).abs() <= ONE_SIDE * ended.width() {
                *begun = ended[branch];
            }
        }
        let (kept, joined) = (first[i].min(first[j]), first[i].max(first[j]));
        first.iter_mut().filter(|k| **k == joined).for_each(|k| *k = kept);
    }
    let mut regions: Vec<BandGroup> = Vec::new();
    let mut heads: Vec<usize> = Vec::new();
    for (band, head) in bands.into_iter().zip(first) {
        match heads.iter().position(|known| *known == head) {
            Some(place) => regions[place].bands.push(band),
            None => {
                heads.push(head);
                regions.push(BandGroup { bands: vec![band] });
            }
        }
    }
    regions
}

impl BandGroup {
    fn xi(&self) -> Interval {
        self.bands.iter().fold(Interval::NONE, |xi, band| xi.hull(band.xi))
    }

    /// Returns what bounds the component at either end of its range of ξ.
    fn ends(&self) -> [End; 2] {
        let xi = self.xi();
        [0, 1].map(|end| {
            let outermost = self.bands.iter().filter(|band| band.xi[end] == xi[end]);
            // A band that continues in another one is not outermost.
            outermost.filter_map(|band| band.ends[end]).next().unwrap_or(End::ProfileEnd)
        })
    }

    fn component(mut self, outline: &mut Outline<'_>) -> Component {
        let deepest = self.deepest(outline);
        let rows = self.rows(outline, deepest[0]);
        let (xi, eta, ends) = (self.xi(), across(&rows), self.ends());
        let window = outline.window.eta;
        let at_window = |row: &[f64; 3]| row[1] == window.low || row[2] == window.high;
        let cut_by_window = self.bands.iter().any(|band| band.ends.contains(&Some(End::Window)))
            || rows.iter().flatten().any(at_window);
        let mut loops = loops::loops(&self.bands, &rows);
        // The outer loop is the one with the largest area.
        loops.sort_by(|a, b| loops::enclosed(b).total_cmp(&loops::enclosed(a)));
        let mut loops = loops.into_iter();
        let boundary = loops.next().unwrap_or_default();
        let mut sums = [0.0, loops::walls(&self.bands)];
        for band in &self.bands {
            let [area, length] = area_and_length(band);
            sums = [sums[0] + area, sums[1] + length];
        }
        let mut corners: Vec<f64> = self.bands.iter().flat_map(|band| &band.corners).copied().collect();
        sort(&mut corners);
        Component {
            xi,
            ends,
            eta,
            corners,
            cut_by_window,
            boundary,
            holes: loops.collect(),
            area: sums[0],
            perimeter: sums[1],
            deepest,
            bands: self.bands,
        }
    }

    /// Finds the corners of every band, and its slices at the points of the loops. These are every corner, the ξ between
    /// two corners (they crowd towards round ends), and the ξ where each branch is farthest out in η. `least` is the least s \[mm\].
    fn rows(&mut self, outline: &mut Outline<'_>, least: f64) -> Vec<Rows> {
        let slicer = &mut outline.slicer;
        let depth = slicer.approach() - least;
        for band in &mut self.bands {
            band.corners.extend(band.xi.ends().into_iter().chain(slicer.joints(band.xi)));
            let mut more = Vec::new();
            let on_crown = slicer.is_on_roller() && slicer.is_over_rail();
            if let Some(lines) = slicer.lines.as_mut().filter(|_| !on_crown) {
                PassedJoints { lines }.within(band.xi, depth, &mut more);
            }
            if slicer.lines.is_some() && (on_crown || band.lane.is_some()) {
                corners::over_joints(slicer, band, &mut more);
            }
            band.corners.append(&mut more);
            sort(&mut band.corners);
            band.fit(slicer);
            if band.lane.is_some() {
                // Its interpolants are smooth between their own ends only.
                band.corners.extend(band.stretches.iter().map(|stretch| stretch.xi.high));
                sort(&mut band.corners);
            }
        }
        let places = |band: &Band| [band.xi.low, band.xi.middle(), band.xi.high].map(|xi| row(band, xi));
        let places: Rows = self.bands.iter().flat_map(places).collect();
        let whole = [self.xi(), across(&[places])].map(Interval::width);
        let mut all = Vec::with_capacity(self.bands.len());
        for band in &mut self.bands {
            let mut more = Vec::new();
            let mut rows: Rows = band.rows(&graded(band, whole));
            corners::at_window(band, &rows, &mut more);
            if !more.is_empty() {
                rows.extend(more.iter().map(|&xi| row(band, xi)));
                band.corners.append(&mut more);
                sort(&mut band.corners);
                rows.sort_by(|p, q| p[0].total_cmp(&q[0]));
            }
            let mirrored = outline.slicer.is_mirrored(band.lane);
            add_farthest(band, mirrored, &mut rows);
            rows.dedup_by_key(|row| row[0]);
            all.push(rows);
        }
        all
    }

    /// Returns \[s, ξ, η\] of the smallest s. C is the first candidate, so that it is chosen if s is 0 at several because ξ² underflows.
    fn deepest(&self, outline: &mut Outline<'_>) -> [f64; 3] {
        let mut found = Vec::new();
        for band in &self.bands {
            let at_c = band.xi.contains(0.0).then_some(0.0);
            match band.lane {
                Some(lane) => {
                    let holds_c = |edges: [f64; 2]| Interval::from(edges).contains(0.0);
                    let c = at_c.filter(|xi| outline.edges(band.lane, *xi).is_some_and(holds_c));
                    found.extend(c.map(|c| [outline.slicer.separation(c, c), c, c]));
                    found.extend(outline.slicer.least_of(lane));
                }
                None => {
                    let least = outline.slicer.least_of_all(band.xi, outline.window.eta);
                    let places = at_c.into_iter().chain(band.xi.ends()).chain(least);
                    found.extend(places.map(|xi| outline.lowest(xi)));
                }
            }
        }
        let lower = |least: [f64; 3], next: [f64; 3]| {
            if next[0] < least[0] || least[0].is_nan() { next } else { least }
        };
        found.into_iter().fold([f64::NAN, self.xi().low, 0.0], lower)
    }
}

/// Returns ξ and both edges of a band there.
fn row(band: &Band, xi: f64) -> [f64; 3] {
    let [low, high] = band.slice(xi).eta.ends();
    [xi, low, high]
}

/// Adds the rows at which a branch turns and is farthest out in η.
fn add_farthest(band: &Band, mirrored: bool, rows: &mut Rows) {
    let symmetric = mirrored && band.window.low == -band.window.high;
    let branches: &[usize] = if symmetric { &[1] } else { &[0, 1] };
    let mut more = Vec::new();
    for &branch in branches {
        let outward = |k: &usize| if branch == 0 { -rows[*k][1] } else { rows[*k][2] };
        let inner = 1..rows.len().saturating_sub(1);
        let farthest = inner.max_by(|p, q| outward(p).total_cmp(&outward(q)));
        let rises = |k: usize| band.slope(branch, rows[k][0]) * [-1.0, 1.0][branch] > 0.0;
        let turn = farthest.and_then(|k| {
            // Two corners may nearly coincide: the turn then lies beyond the rows beside the farthest one.
            let (mut low, mut high) = (k - 1, k + 1);
            while rises(high) && high + 1 < rows.len() {
                (low, high) = (high, high + 1);
            }
            while !rises(low) && low > 0 {
                (low, high) = (low - 1, low);
            }
            corners::turn_of_branch(band, branch, [rows[low][0], rows[high][0]])
        });
        more.extend(turn);
    }
    for xi in more {
        rows.insert(rows.partition_point(|row| row[0] < xi), row(band, xi));
    }
}

/// Sorts numbers into ascending order and removes repeated ones.
fn sort(numbers: &mut Vec<f64>) {
    numbers.sort_by(f64::total_cmp);
    numbers.dedup();
}

/// Returns the range of η over all rows.
fn across(rows: &[Rows]) -> Interval {
    rows.iter().flatten().fold(Interval::NONE, |eta, row| eta.hull(Interval::new(row[1], row[2])))
}

/// Returns every corner of a band, and ξ between two corners, which crowd towards round ends. `whole` is the length of the
/// component along ξ and η.
fn graded(band: &Band, whole: [f64; 2]) -> Vec<f64> {
    let (grading, share) = (band.grading(), band.xi.width() / whole[0]);
    let edges: Vec<Interval> = band.corners.iter().map(|&xi| band.slice(xi).eta).collect();
    let mut nodes = Vec::with_capacity(2 * POINTS_PER_SIDE);
    nodes.push(band.corners[0]);
    for (piece, t) in band.pieces().enumerate() {
        let [from, to] = [edges[piece], edges[piece + 1]];
        // Both sides of an ellipse rise by half of its width.
        let rise = (to.low - from.low).abs().max((to.high - from.high).abs()) / (2.0 * whole[1]);
        // A part without width, at a mere touch, has no share of it.
        let share = (share * t.width()).max(rise).min(1.0);
        let n = LEAST_POINTS.max((POINTS_PER_SIDE as f64 * share).round() as usize);
        nodes.extend((1..n).map(|k| grading.xi(t.step(k, n))));
        nodes.push(band.corners[piece + 1]);
    }
    nodes.dedup();
    nodes
}
