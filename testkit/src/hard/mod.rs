//! The catalogue of hard families: pairs of convex bodies and flights of poses on which proximity queries are known to fail,
//! each with the reason and a public source. Seeded and parameterised: a sequence is a function of its family, a seed and its
//! index alone, and every index is another set of parameters.
//!
//! The poses of a sequence are meant to be flown in order with the warm start carried on.

mod bodies;
mod contacts;
mod degenerate;
pub mod flight;
mod motions;
mod placing;
mod scales;
mod surfaces;
mod threads;

use swiftprox::body::build::hull::convex_hull;
use swiftprox::mesh::PolygonMesh;

use super::PosePair;
use super::random::Random;

/// A kind of difficulty.
pub struct Family {
    pub name: &'static str,
    /// So many sequences take it once through its parameters, or through enough of what is random.
    pub sweep: usize,
    /// Why it is hard.
    pub why: &'static str,
    /// Where it was seen to fail, or who described it.
    pub sources: &'static [&'static str],
    make: fn(&mut Random, usize) -> Sequence,
}

/// A pair of bodies and the poses it is flown through.
#[derive(Debug, Clone)]
pub struct Sequence {
    /// What its parameters are, a word for a file name.
    pub name: String,
    /// Faces may be missing: then the body is the hull of the vertices, of whatever dimension.
    pub bodies: [PolygonMesh; 2],
    pub poses: Vec<PosePair>,
}

impl Family {
    /// The sequence of an index: the first [`Family::sweep`] go through the parameters, all differ in what is random.
    pub fn sequence(&self, seed: u64, index: usize) -> Sequence {
        let name_bits = self.name.bytes().fold(seed, |bits, byte| bits.rotate_left(7) ^ u64::from(byte));
        let mut random = Random::new(name_bits.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (index as u64) << 32);
        (self.make)(&mut random, index)
    }
}

/// All families.
pub fn families() -> impl Iterator<Item = &'static Family> {
    [
        contacts::FAMILIES,
        surfaces::FAMILIES,
        degenerate::FAMILIES,
        scales::FAMILIES,
        motions::FAMILIES,
        threads::FAMILIES,
    ]
    .into_iter()
    .flatten()
}

/// The faces of a body as triangles: its own, cut into fans, or else those of its hull. None where that has no interior.
pub fn triangles(body: &PolygonMesh) -> Vec<[u32; 3]> {
    if body.face_count() > 0 {
        let fan = |f| {
            let face = body.face(f);
            (2..face.len()).map(|k| [face[0], face[k - 1], face[k]])
        };
        return (0..body.face_count()).flat_map(fan).collect();
    }
    let hull = convex_hull(&body.vertices).expect("finite points");
    if hull.dimension == 3 { hull.triangles } else { Vec::new() }
}
