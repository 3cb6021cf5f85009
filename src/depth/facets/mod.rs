//! How deep two small bodies are in each other, by all facets of their Minkowski difference; nearly none of them is looked at.
//!
//! C = {x − y: x in body 1, y in body 2} has the support h(n) in a direction n. For intersecting bodies the depth is the least
//! h(n) over all unit vectors. Both bodies have a fan of directions ([`Fan`]): nodes, arcs and cells. Those of body 1 as placed
//! and those of body 2, turned round, are laid over each other.
//!
//! *Lemma.* If h ≥ T ≥ 0 at all nodes of both fans and wherever an arc of one crosses an arc of the other, then h ≥ T − s
//! everywhere, where s is the sum of both bodies' [`cell_slack`](Fan::cell_slack). Let n be in the cell of corner v and in that
//! of corner w. There l(n) = n·(v − w) ≤ h(n) is linear, and l ≥ h − s|n| by the meaning of the slack. The set where l ≥ (T −
//! s)|n| is a convex cone. It holds the ends of each stretch of an arc that runs in the other's cell, nodes and crossings, and so
//! the stretch; n is between two points of such stretches. □
//!
//! *Nodes.* At the normal n of face f h(n) = max S(f, w) over the other body's corners w, S(f, w) being how deep w is below the
//! face's plane. One w with S(f, w) ≥ T is enough; the set of all is a mask.
//!
//! *Arcs.* If one w is in the masks of both faces of an edge, then h ≥ T − σ on the whole arc: n = s·a + t·b with s, t ≥ 0, a
//! corner p of the edge is in both planes up to σ, so n·(p − w) ≥ (s + t)(T − σ), and |n| ≤ s + t. No cross product is needed, and
//! nothing is ill-conditioned where edges are parallel. Mostly that leaves one arc or two of each body, and their crossings are
//! looked at one by one (`crossings.rs`).
//!
//! So each answer is its own proof: nothing is kept but which facet was the nearest, as a bound to begin with. The idea of pruning
//! pairs of arcs by the normals' fans is D. Gregorius's (The Separating Axis Test between Convex Polyhedra, GDC 2013).

#[doc(hidden)]
pub mod placed;
mod search;
mod arcs;
mod crossings;
mod witness;
mod kept;

use crate::base::math::{UNIT_ROUNDOFF as U, Vector};
use crate::base::simd::{Lanes, Work};
use crate::body::polyhedron::fan::{Fan, MOST_CORNERS, MOST_EDGES, MOST_FACES};
use crate::placed::frame::Frame;
use arcs::Survivors;
use crossings::Crossings;
pub use crossings::ON_ARC;
pub use kept::{Proved, across, prove};
use placed::PlacedFan;
pub use search::{Facet, NODE, NORMAL, SUPPORT};
use search::{FacetSearch, LeastSupport};
pub use witness::FacetWitness;

/// The result of all facets. (The facet that they find is written in its place: R1, R5.)
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FacetOutcome {
    /// The bodies are apart along the direction, from body 1 to body 2; it is the facet's normal. Nothing else is reported.
    Separated,
    /// They overlap.
    Overlapping,
    /// Rounding hides it.
    Unclear,
}

/// How deep two bodies are in each other.
#[derive(Debug, Clone, Copy)]
pub struct Overlap {
    /// The depth is at least this, more than 0 …
    pub lower: f64,
    /// … and at most this.
    pub upper: f64,
    /// The overlap of the witness points, in between.
    pub depth: f64,
    /// The unit vector, from the inside of the Minkowski difference to the boundary, along which the bodies overlap least.
    pub direction: Vector,
    /// The nearest facet.
    pub facet: Facet,
    /// The place of the facet.
    pub witness: FacetWitness,
}

impl Overlap {
    /// Nothing yet.
    pub const NONE: Overlap = Overlap {
        lower: 0.0,
        upper: 0.0,
        depth: 0.0,
        direction: Vector::new(0.0, 0.0, 0.0),
        facet: Facet::Face(0, 0),
        witness: FacetWitness::NONE,
    };
}

/// The product that gives the cost of looking at all facets: planes of one body times corners of the other.
#[inline(always)]
pub fn work([fan1, fan2]: [&Fan; 2]) -> usize {
    4 * (fan1.planes.len() * fan2.corners.len() + fan2.planes.len() * fan1.corners.len())
}

/// Room for blocks of points and of planes: for 8 corners and 12 faces, as in boxes; of 24 and 44; for all that have a fan. It is
/// zeroed, and all of it takes longer than two boxes do.
const TINY_POINTS: usize = 2;
const TINY_PLANES: usize = 3;
const SMALL_POINTS: usize = 6;
const SMALL_PLANES: usize = 11;
const LARGE_POINTS: usize = 16;
const LARGE_PLANES: usize = 31;

/// Looks at all facets, beginning with one that was the nearest, if the bodies still have it. An interval that would be wider than
/// `widest` is unclear.
#[inline(always)]
pub fn search<L: Lanes>(
    frame: &Frame<L>,
    fans: [&Fan; 2],
    known: Option<Facet>,
    widest: f64,
    found: &mut Overlap,
) -> FacetOutcome {
    let known = known.filter(|facet| is_there(frame, *facet));
    let points = fans[0].points.len().max(fans[1].points.len());
    let planes = fans[0].planes.len().max(fans[1].planes.len());
    if points <= TINY_POINTS && planes <= TINY_PLANES {
        L::out_of_line(&mut InRoom::<L, TINY_POINTS, TINY_PLANES> { frame, fans, known, widest, found })
    } else if points <= SMALL_POINTS && planes <= SMALL_PLANES {
        L::out_of_line(&mut InRoom::<L, SMALL_POINTS, SMALL_PLANES> { frame, fans, known, widest, found })
    } else {
        L::out_of_line(&mut InRoom::<L, LARGE_POINTS, LARGE_PLANES> { frame, fans, known, widest, found })
    }
}

fn is_there<L: Lanes>(frame: &Frame<L>, facet: Facet) -> bool {
    let polyhedra = frame.polyhedra();
    match facet {
        Facet::Face(body, face) => (face as usize) < polyhedra[body].faces.len(),
        Facet::Edges(edges) => (0..2).all(|i| (edges[i] as usize) < polyhedra[i].edges.len()),
    }
}

/// A search with room for this many blocks of points and planes.
struct InRoom<'a, L, const C: usize, const F: usize> {
    frame: &'a Frame<'a, L>,
    fans: [&'a Fan; 2],
    known: Option<Facet>,
    widest: f64,
    found: &'a mut Overlap,
}

impl<L: Lanes, const C: usize, const F: usize> Work for InRoom<'_, L, C, F> {
    type Output = FacetOutcome;

    #[inline(always)]
    fn run(&mut self) -> FacetOutcome {
        let InRoom { frame, fans, known, widest, found } = self;
        let (frame, fans, widest): (&Frame<L>, _, _) = (frame, *fans, *widest);
        let mut search = FacetSearch::<L, C, F> {
            frame,
            fans,
            placed: [PlacedFan::EMPTY; 2],
            longest: 1.02 * frame.size + frame.separation,
            widest,
            best: LeastSupport { value: f64::INFINITY, direction: Vector::zeros(), facet: Facet::Face(0, 0) },
        };
        search.placed[0].place(&frame.bodies[0], fans[0], frame.bodies[0].offset, frame.rigid);
        search.placed[1].place(&frame.bodies[1], fans[1], L::splat(0.0), frame.rigid);
        search.run(*known, found)
    }
}

impl<L: Lanes, const C: usize, const F: usize> FacetSearch<'_, L, C, F> {
    #[inline(always)]
    fn run(&mut self, known: Option<Facet>, found: &mut Overlap) -> FacetOutcome {
        match known {
            Some(facet) => self.begin_with(facet),
            None => self.begin(),
        }
        let mut masks = [[[0; 4]; F]; 2];
        for (body, masks) in masks.iter_mut().enumerate() {
            if self.is_separated() {
                return self.finish(f64::INFINITY, found);
            }
            arcs::find_masks(self, body, masks);
        }
        if self.is_separated() {
            return self.finish(f64::INFINITY, found);
        }
        let mut survivors = [Survivors::NONE; 2];
        survivors[0].find(self.fans[0], &masks[0]);
        if !survivors[0].edges().is_empty() {
            survivors[1].find(self.fans[1], &masks[1]);
        }
        let mut crossings = Crossings { least: f64::INFINITY, is_unclear: false };
        if !survivors[1].edges().is_empty() {
            crossings.look_at(self, &survivors);
        }
        if crossings.is_unclear { FacetOutcome::Unclear } else { self.finish(crossings.least, found) }
    }

    /// The facet that was the nearest.
    #[inline(always)]
    fn begin_with(&mut self, facet: Facet) {
        match facet {
            Facet::Face(body, face) => self.take_face(body, face as usize, self.value_of_face(body, face as usize)),
            Facet::Edges(edges) => {
                let (edge1, edge2) = (&self.fans[0].edges[edges[0] as usize], &self.fans[1].edges[edges[1] as usize]);
                let [body1, body2] = &self.frame.bodies;
                let along1 = body1.rotate(&edge1.direction).to_vector();
                let along2 = body2.rotate(&edge2.direction).to_vector();
                let across = along1.cross(&along2);
                let [left, right] = edge1.faces;
                let (left, right) =
                    (self.placed[0].normal(usize::from(left)), self.placed[0].normal(usize::from(right)));
                let outward = if across.dot(&(left + right)) < 0.0 { -across } else { across };
                let length = outward.norm();
                if !(length > LEAST_SINE) {
                    return self.begin();
                }
                let direction = outward / length;
                self.take(self.support(&direction), &direction, facet);
            }
        }
    }

    /// For each body, the face under which the other's origin is least deep.
    #[inline(always)]
    fn begin(&mut self) {
        for body in 0..2 {
            let other = if body == 0 { Vector::zeros() } else { self.frame.bodies[0].offset.to_vector() };
            let face = self.placed[body].face_above::<L>(&other);
            self.take_face(body, face, self.value_of_face(body, face));
        }
    }

    /// The answer, where `crossings` is the least that is proved of them.
    #[inline(always)]
    fn finish(&self, crossings: f64, found: &mut Overlap) -> FacetOutcome {
        let LeastSupport { direction, facet, .. } = self.best;
        let direction = direction / direction.norm();
        let (value, error) = (self.true_support(&direction), SUPPORT * self.longest);
        let upper = value + error;
        (found.direction, found.facet) = (direction, facet);
        if upper < 0.0 {
            return FacetOutcome::Separated;
        }
        let [fan1, fan2] = self.fans;
        let (of_faces, of_cells) = (fan1.face_slack + fan2.face_slack, fan1.cell_slack + fan2.cell_slack);
        let nodes_and_arcs = self.threshold() - NODE * self.longest - of_faces;
        let lower = (nodes_and_arcs.min(crossings) - of_cells) * (1.0 - 8.0 * U);
        // False for a NaN.
        let is_narrow = upper - lower <= self.widest;
        if !(lower > 0.0 && is_narrow) {
            return FacetOutcome::Unclear;
        }
        (found.lower, found.upper, found.depth) = (lower, upper, value);
        if witness::find(self, &direction, value, &mut found.witness) {
            FacetOutcome::Overlapping
        } else {
            FacetOutcome::Unclear
        }
    }

    /// The support over all vertices, flat ones included.
    #[inline(always)]
    fn true_support(&self, direction: &Vector) -> f64 {
        let [body1, body2] = &self.frame.bodies;
        let [fan1, fan2] = self.fans;
        let are_all_corners = fan1.corners.len() == body1.polyhedron.vertices.len()
            && fan2.corners.len() == body2.polyhedron.vertices.len();
        if are_all_corners {
            return self.support(direction);
        }
        let along = L::from_vector(direction);
        let [towards1, towards2] = [body1.rotate_back(along).to_vector(), -body2.rotate_back(along).to_vector()];
        let mut farthest = [f64::NEG_INFINITY; 2];
        for vertex in &body1.polyhedron.vertices {
            farthest[0] = farthest[0].max(towards1.dot(&vertex.position));
        }
        for vertex in &body2.polyhedron.vertices {
            farthest[1] = farthest[1].max(towards2.dot(&vertex.position));
        }
        farthest[0] + farthest[1] + along.dot(body1.offset)
    }
}

/// Edges that are less far from parallel have no direction across them.
const LEAST_SINE: f64 = 1e-9;

const _: () = assert!(4 * LARGE_POINTS == MOST_CORNERS && 4 * LARGE_PLANES >= MOST_FACES && MOST_EDGES <= 255);
