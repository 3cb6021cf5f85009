//! How deep two bodies are in each other by one facet of C = {x − y} that was the least before, and one deep point.
//!
//! *Lemma.* Let a facet be at heights from l to t > 0 along a unit vector m, at all places up to r aside of the origin, and let q
//! be a point of C at the height −h, a aside. If rh > at and (rh − at)² ≥ t²((r + a)² + (h + t)²), C holds the ball of radius l.
//! For let u = c·e + s·m be a unit vector, e across m and c ≥ 0. C has the points (r, t') and (a', −h) of the plane of e and m, l ≤
//! t' ≤ t, |a'| ≤ a. From the condition r > t and h > t. If s ≥ 0, the first gives rc + t's ≥ l(c + s) ≥ l. At u = −m the second
//! gives h > l. In between, each gives a sinusoid, concave where it is positive; so the greater of both is least at an end, or
//! where they are equal: u is there across the line through both points, which is (rh + t'a')/√((r − a')² + (h + t')²) from the
//! origin, at least (rh − ta)/√((r + a)² + (h + t)²) ≥ t. □
//!
//! *Two discs.* Where the foot is next to a side, as where equal boxes stand on each other, r is too small. Let C have a second
//! disc around the foot, of radius R > t, at heights from l − e > 0 to t. With s = r/t ≤ 1 the ball is in C if R ≥ r + e(1 − s²)/2s
//! and the condition above holds of R. For let θ be the angle of u and m. The first disc gives l·cos θ + r·sin θ ≥ l up to tan(θ/2)
//! = s. The second gives (l − e)cos θ + R·sin θ ≥ l if R ≥ l·tan(θ/2) + e·cot θ, which is convex up to 90°: it holds up to there if
//! at both ends, and beyond 90° as above. If e is no more than rounding, the second disc proves l − e alone. □
//!
//! The second disc is on a face that looks at the other body, or on the corners of a contact face; or, where one side is near, on
//! the facet and on that across the side.
//! Of such a fold by an angle φ the condition is r ≥ t·tan(φ/2), rounding apart, and that is so wherever the facet is the least.
//!
//! *From above*: along m the bodies overlap by no more than both reach.
//!
//! Any facet and any bytes will do: indices are looked at, all else is proved anew. Where the origin's foot is beyond a side of the
//! facet, the next facet across that side is looked at, as in gift wrapping (Chand & Kapur 1970).

mod facet;
mod wide_disc;
mod face;
mod edges;

use super::search::Facet;
use crate::base::math::Vector;
use crate::base::simd::{Lanes, Work};
use crate::body::polyhedron::Polyhedron;
use crate::placed::exact::VertexPair;
use crate::placed::frame::Frame;
use edges::AtEdges;
use face::{AtFace, look_at_face};
pub use facet::Proved;
use facet::{NextFacet, most_across};

/// Facets that are looked at.
const MOST_FACETS: u32 = 10;

/// The depth that a facet, or one a few steps from it, proves.
///
/// # Errors
/// The last facet that was looked at, if none proves one.
#[inline(always)]
pub fn prove<L: Lanes>(frame: &Frame<L>, facet: Facet) -> Result<Proved<L>, Facet> {
    let [polyhedron1, polyhedron2] = frame.polyhedra();
    let is_suited = |polyhedron: &Polyhedron| polyhedron.dimension == 3 && polyhedron.outlines.shortest > 0.0;
    // Bodies farther apart do not intersect.
    let are_near = frame.separation <= 2.0 * frame.size;
    if !(are_near && is_suited(polyhedron1) && is_suited(polyhedron2)) {
        return Err(facet);
    }
    match look(frame, facet) {
        Ok(proved) => Ok(proved),
        Err(NextFacet::Facet(next)) => L::out_of_line(&mut FacetWalk { frame, next }),
        Err(NextFacet::Nothing) => Err(facet),
    }
}

/// The face most across a direction, which is from the inside of C to its boundary, at vertices that are farthest along it: where a
/// walk may begin. `None` of flat bodies.
#[inline(always)]
pub fn across<L: Lanes>(frame: &Frame<L>, direction: &Vector, vertices: VertexPair) -> Option<Facet> {
    let [polyhedron1, polyhedron2] = frame.polyhedra();
    if polyhedron1.dimension < 3 || polyhedron2.dimension < 3 {
        return None;
    }
    let along = L::from_vector(direction);
    let (face1, cosine1) = most_across(polyhedron1, vertices[0], frame.bodies[0].rotate_back(along));
    let (face2, cosine2) = most_across(polyhedron2, vertices[1], frame.bodies[1].rotate_back(along).negate());
    Some(if cosine1 >= cosine2 { Facet::Face(0, face1) } else { Facet::Face(1, face2) })
}

struct FacetWalk<'a, L> {
    frame: &'a Frame<'a, L>,
    next: Facet,
}

impl<L: Lanes> Work for FacetWalk<'_, L> {
    type Output = Result<Proved<L>, Facet>;

    #[inline(always)]
    fn run(&mut self) -> Self::Output {
        for steps in 1..MOST_FACETS {
            match look(self.frame, self.next) {
                Ok(proved) => return Ok(Proved { steps, ..proved }),
                Err(NextFacet::Facet(next)) => self.next = next,
                Err(NextFacet::Nothing) => break,
            }
        }
        Err(self.next)
    }
}

#[inline(always)]
fn look<L: Lanes>(frame: &Frame<L>, facet: Facet) -> Result<Proved<L>, NextFacet> {
    match facet {
        Facet::Face(body, face) => {
            let [polyhedron1, polyhedron2] = frame.polyhedra();
            let are_small = !polyhedron1.vertex_blocks.is_empty() & !polyhedron2.vertex_blocks.is_empty();
            if frame.rigid & are_small {
                look_at_face::<L, true>(frame, body.min(1), face)
            } else {
                L::out_of_line(&mut AtFace { frame, body: body.min(1), face })
            }
        }
        Facet::Edges(edges) => L::out_of_line(&mut AtEdges { frame, edges }),
    }
}
