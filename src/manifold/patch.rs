//! The patch of a body that looks towards the other: a merged face, or several that a contact face combines.

use super::answer::Reference;
use crate::answer::faces_at;
use crate::base::math::{UNIT_ROUNDOFF, Vector};
use crate::body::polyhedron::{FacePart, NONE, Polyhedron};
use crate::body::tables;
use crate::shape::Placed;

/// Points nearer to each other than this, relative to the size of the pair, count as one place, 2⁻²⁷: far above rounding, and
/// above what aligned bricks at rest move by; far below what shows.
pub const COINCIDENT: f64 = f64::from_bits((1023 - 27) << 52);

/// Corners of the earlier patch that are looked at; a climb takes about as long.
const MOST_LOOKED_AT: usize = 8;

/// In bodies with no more vertices than this, a look at all of them takes less time than a climb.
const SOONER_CLIMBED: usize = 32;

/// A polygon that a manifold is made over.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Patch {
    /// A merged face.
    Merged(u32),
    /// A contact face.
    Contact(u32),
}

impl Patch {
    /// The patch of a number, if there is one: merged faces come first.
    pub fn of_number(polyhedron: &Polyhedron, number: u32) -> Option<Patch> {
        match number.checked_sub(polyhedron.faces.len() as u32) {
            None => Some(Patch::Merged(number)),
            Some(face) => polyhedron.contact_faces.faces.get(face as usize).map(|_| Patch::Contact(face)),
        }
    }

    /// Its number.
    pub fn number(self, polyhedron: &Polyhedron) -> u32 {
        match self {
            Patch::Merged(face) => face,
            Patch::Contact(face) => polyhedron.faces.len() as u32 + face,
        }
    }

    /// The unit outward normal.
    pub fn normal(self, polyhedron: &Polyhedron) -> &Vector {
        match self {
            Patch::Merged(face) => &polyhedron.faces[face as usize].normal,
            Patch::Contact(face) => &polyhedron.contact_faces.faces[face as usize].normal,
        }
    }

    /// How many corners it has.
    pub fn corner_count(self, polyhedron: &Polyhedron) -> usize {
        match self {
            Patch::Merged(face) => polyhedron.faces[face as usize].side_count as usize,
            Patch::Contact(face) => polyhedron.contact_faces.faces[face as usize].corner_count as usize,
        }
    }

    /// The vertex at a corner.
    pub fn vertex(self, polyhedron: &Polyhedron, corner: usize) -> u32 {
        match self {
            Patch::Merged(face) => {
                let record = &polyhedron.faces[face as usize];
                let edge = &polyhedron.edges[polyhedron.side(record, corner as u32) as usize];
                if edge.left() == face { edge.tail() } else { edge.head() }
            }
            Patch::Contact(face) => {
                let contact = &polyhedron.contact_faces;
                contact.corners[contact.faces[face as usize].first_corner as usize + corner]
            }
        }
    }

    /// The caller's polygon that it goes by: of several the lowest, as which of them holds a point may change while it stays.
    pub fn label(self, polyhedron: &Polyhedron) -> u32 {
        match self {
            Patch::Merged(face) => polyhedron.labels_of_face(face).first().copied().unwrap_or(0),
            Patch::Contact(face) => polyhedron.contact_faces.faces[face as usize].label,
        }
    }
}

/// A patch that looks towards the other body.
#[derive(Debug, Clone, Copy)]
pub struct Facing {
    pub patch: Patch,
    /// The cosine between its normal and the direction towards the other body.
    pub parallel: f64,
}

/// The patch most parallel to a direction, which is in the world, among those at the vertex that reaches farthest along it; the
/// last one, if it is as parallel up to `sticky`. The witness point, in the body's own frame, reaches as far. `None` of bodies
/// without faces.
pub fn facing(body: Placed, direction: &Vector, witness: &Vector, last: Option<u32>, sticky: f64) -> Option<Facing> {
    let polyhedron = body.shape.polyhedron();
    let towards = body.pose.rotate_back(direction);
    let cosine = |patch: Patch| Facing { patch, parallel: patch.normal(polyhedron).dot(&towards) };
    let last = last.and_then(|number| Patch::of_number(polyhedron, number)).map(cosine);
    // No normal is longer than 1, rounding apart, and so none is more parallel.
    if let Some(last) = last
        && last.parallel >= towards.norm() * (1.0 + 16.0 * UNIT_ROUNDOFF) - sticky
    {
        return Some(last);
    }
    let vertex = farthest_vertex(polyhedron, &towards, &(witness - polyhedron.centre), last.map(|last| last.patch))?;
    let contact = &polyhedron.contact_faces;
    // Number by number (rule R1).
    let (mut best, mut parallel) = (None, f64::NEG_INFINITY);
    let mut look_at = |patch: Patch| {
        let own = patch.normal(polyhedron).dot(&towards);
        if own > parallel {
            (best, parallel) = (Some(patch), own);
        }
    };
    contact.at(vertex).map(Patch::Contact).for_each(&mut look_at);
    let around = polyhedron.face_around(vertex);
    let mut look_at_merged = |face: u32| {
        if contact.part(face) == FacePart::Whole {
            look_at(Patch::Merged(face));
        }
    };
    around.into_iter().for_each(&mut look_at_merged);
    faces_at(polyhedron, vertex).for_each(look_at_merged);
    // If there are only slivers, they must serve.
    let best = match best {
        Some(patch) => Facing { patch, parallel },
        None => {
            let merged = around.into_iter().chain(faces_at(polyhedron, vertex)).map(|face| cosine(Patch::Merged(face)));
            merged.reduce(|a, b| if b.parallel > a.parallel { b } else { a })?
        }
    };
    Some(last.filter(|last| last.parallel >= best.parallel - sticky).unwrap_or(best))
}

/// The cosine between a patch's normal and the contact's from which on the patch may be the reference: 10°.
pub const PARALLEL: f64 = 0.984_8;

/// By how much less parallel the last reference may be and stay.
pub const STICKY: f64 = 1e-3;

/// The same of the incident patch, which is not nearly parallel: only ties are broken.
pub const STICKY_INCIDENT: f64 = 1e-6;

/// The patches that a manifold is made over, and which of them is the reference.
pub struct Patches {
    pub facing: [Option<Facing>; 2],
    pub reference: usize,
}

/// Which of two patches is the reference.
#[inline(always)]
pub fn choose(facing: [Option<Facing>; 2], last: &Reference) -> Option<Patches> {
    let parallel = |i: usize| facing[i].map_or(-1.0, |facing| facing.parallel);
    let best = if parallel(1) > parallel(0) { 1 } else { 0 };
    let reference = match last.body {
        body @ 1..=2 if parallel(body as usize - 1) >= parallel(best) - STICKY => body as usize - 1,
        _ => best,
    };
    (parallel(reference) >= PARALLEL).then_some(Patches { facing, reference })
}

/// A vertex that reaches farthest along a direction, up to [`COINCIDENT`]. `None` of bodies without faces.
///
/// All neighbours of a vertex may be as high as itself up to rounding, as on the far face of a mesh that is flat up to rounding:
/// there a climb ends. The witness point is the judge of that, and then all vertices are looked at. A corner of the earlier patch
/// that is as far is mostly there.
fn farthest_vertex(polyhedron: &Polyhedron, towards: &Vector, witness: &Vector, last: Option<Patch>) -> Option<u32> {
    let first = polyhedron.edges.first().filter(|edge| edge.left() != NONE)?.tail();
    let height = |v: u32| polyhedron.vertices[v as usize].position.dot(towards);
    let far = witness.dot(towards) - COINCIDENT * polyhedron.radius;
    if let Some(last) = last {
        let corners = 0..last.corner_count(polyhedron).min(MOST_LOOKED_AT);
        let mut corners = corners.map(|corner| last.vertex(polyhedron, corner));
        if let Some(vertex) = corners.find(|vertex| height(*vertex) >= far) {
            return Some(vertex);
        }
    }
    if polyhedron.vertices.len() > SOONER_CLIMBED {
        let (reached, _) = polyhedron.support(towards, tables::farthest(polyhedron, towards).unwrap_or(first));
        if height(reached) >= far {
            return Some(reached);
        }
    }
    (0..polyhedron.vertices.len() as u32).reduce(|a, b| if height(b) > height(a) { b } else { a })
}
