//! Branch and bound over the trees of both bodies: solves only pairs of elements that may hold the lowest
//! gap.
//!
//! Every pair of nodes has a lower bound of its gap. A pair is dropped if it cannot come below the lowest gap
//! so far, or if its nodes share no abscissa or no tangent. Otherwise the larger node is replaced by its
//! children, the one with the lower bound first. The elements that touched in the last search are solved
//! first: most other pairs are then too high.
//!
//! Cost: elements of one body follow each other along x, so that a node shares abscissae with few nodes of
//! its own size. At most some multiple of n_W + n_R pairs are looked at, and with a good first gap some
//! dozens.

use super::body::TreeNode;
use super::candidates::{Candidate, Meeting, Search};
use super::placed::{PlacedBounds, placed_bounds};
use super::stretches::SAME_TANGENT;
use super::{arcs, stretches};

/// A pair of nodes that may hold the lowest gap.
#[derive(Debug, Clone, Copy)]
struct Pending {
    wheel: u32,
    rail: u32,
    bound: f64,
}

/// A node of the wheel as placed in the search of number `search`.
#[derive(Debug, Clone, Copy)]
struct StandingNode {
    placed: PlacedBounds,
    search: u64,
}

/// The placed nodes of the wheel and the pairs that wait; kept between searches, so that a search allocates
/// nothing.
#[derive(Debug, Clone)]
pub(super) struct Walk {
    wheel: Vec<StandingNode>,
    rail: Vec<PlacedBounds>,
    links: [Vec<Link>; 2],
    /// Number of this search.
    search: u64,
    /// Pairs that wait, the next one last.
    waiting: [Pending; DEEPEST_WAIT],
    /// Number of pairs of nodes looked at.
    pub pairs: u64,
}

/// More pairs than ever wait: each pair that is replaced leaves at most one behind, down two balanced trees
/// of at most 2³² nodes.
const DEEPEST_WAIT: usize = 80;

/// How the tree continues below a node.
#[derive(Debug, Clone, Copy)]
struct Link {
    /// Index of the right child, or 0 for a leaf; the left child follows its parent.
    right: u32,
    /// Index of a leaf's element.
    element: u32,
    /// Larger side of the bounding box \[mm\].
    size: f64,
}

impl Link {
    fn of(node: &TreeNode) -> Self {
        Self { right: node.right, element: node.element, size: node.size }
    }

    fn is_leaf(&self) -> bool {
        self.right == 0
    }
}

impl Walk {
    /// Makes the walk over two trees.
    pub fn new(wheel: &[TreeNode], rail: &[TreeNode]) -> Self {
        Self {
            wheel: vec![StandingNode { placed: PlacedBounds::HIDDEN, search: 0 }; wheel.len()],
            rail: rail.iter().map(|node| PlacedBounds::rail(&node.bounds)).collect(),
            links: [wheel, rail].map(|nodes| nodes.iter().map(Link::of).collect()),
            search: 0,
            waiting: [Pending { wheel: 0, rail: 0, bound: f64::NEG_INFINITY }; DEEPEST_WAIT],
            pairs: 0,
        }
    }

    /// Finds all candidates up to `within` above the lowest, and some more.
    pub fn all(&mut self, search: &mut Search, last: Option<Meeting>) {
        let solved = last.map(|meeting| meeting.elements);
        if let Some(meeting) = last {
            meet(search, meeting.elements, None);
            if search.candidates.is_empty()
                && let Some(gap) = gap_at(search, &meeting)
            {
                search.lowest = search.lowest.min(gap);
            }
        }
        self.search += 1;
        self.waiting[0] = Pending { wheel: 0, rail: 0, bound: f64::NEG_INFINITY };
        let mut count = 1;
        let mut ceiling = search.bound_ceiling();
        while count > 0 {
            count -= 1;
            let Pending { wheel, rail, bound } = self.waiting[count];
            if bound > ceiling {
                continue;
            }
            let (above, below) = (self.links[0][wheel as usize], self.links[1][rail as usize]);
            let [a, b] = if above.is_leaf() && below.is_leaf() {
                let elements = [above.element, below.element];
                if solved != Some(elements) {
                    meet(search, elements, Some(&self.wheel[wheel as usize].placed));
                    ceiling = search.bound_ceiling();
                }
                continue;
            } else if below.is_leaf() || (!above.is_leaf() && above.size >= below.size) {
                [[wheel + 1, rail], [above.right, rail]]
            } else {
                [[wheel, rail + 1], [wheel, below.right]]
            };
            self.pairs += 2;
            let (a, b) = (self.pending(search, a), self.pending(search, b));
            // The lower bound on top. No branches: which pairs stay is as good as random.
            let swapped = a.bound < b.bound;
            let (first, next) = if swapped { (b, a) } else { (a, b) };
            self.waiting[count] = first;
            count += usize::from(first.bound <= ceiling);
            self.waiting[count] = next;
            count += usize::from(next.bound <= ceiling);
        }
    }

    /// Pairs two nodes with a lower bound of their gap, infinite if they cannot touch.
    #[inline(always)]
    fn pending(&mut self, search: &Search, [wheel, rail]: [u32; 2]) -> Pending {
        let standing = &mut self.wheel[wheel as usize];
        if standing.search != self.search {
            let bounds = &search.bodies[0].nodes[wheel as usize].bounds;
            let placed = placed_bounds(search.attitude, bounds).widened(search.slack, SAME_TANGENT);
            *standing = StandingNode { placed, search: self.search };
        }
        Pending { wheel, rail, bound: standing.placed.gap_over(&self.rail[rail as usize]) }
    }
}

/// Looks for contact of two elements; `placed` holds the bounds of the wheel's element, if they are known.
fn meet(search: &mut Search, elements: [u32; 2], placed: Option<&PlacedBounds>) {
    if arcs::meet(search, elements) {
        search.solves += 1;
    } else {
        stretches::meet(search, elements, placed);
    }
}

/// Returns the place of contact near a former one, on the same elements; `None` if it has left them.
pub(super) fn follow(search: &Search, meeting: &Meeting) -> Option<Candidate> {
    let [wheel, rail] = stretches::follow(search, meeting.elements, meeting.parameters)?;
    search.candidate(meeting.elements, &wheel, &rail)
}

/// Returns an upper bound of the lowest gap \[mm\]: the gap over the wheel's point of a former place of
/// contact.
fn gap_at(search: &Search, meeting: &Meeting) -> Option<f64> {
    let [above, below] = search.bodies;
    let [wheel, _] = search.elements(meeting.elements);
    let own = wheel.place(&above.coefficients, meeting.parameters[0]).station;
    let outline = search.attitude.outline(&own);
    if !(below.extent[0].contains(outline.x) && outline.cos > 0.0) {
        return None;
    }
    let foot = below.point_at(outline.x).2.station;
    let gap = outline.z - foot.z + search.slack;
    ((foot.x - outline.x).abs() <= search.slack && gap.is_finite()).then_some(gap)
}
