//! The vertices of a body where it is. Those of a small one are all placed once, and looked at four at a time.

use crate::base::error::Result;
use crate::base::math::{Pose, Vector, is_unit};
use crate::base::memory::reserve;
use crate::base::simd::{self, Kernel, Lanes};
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::fan::PointBlock;
use crate::distance::certificate::of_vertex;
use crate::pair::Placed;

/// A body and the positions of its vertices in the world.
#[derive(Clone, Copy)]
pub(super) struct Vertices<'a> {
    pub body: Placed<'a>,
    /// The last block repeats the last vertex. Empty for a body with many.
    blocks: &'a [PointBlock],
}

impl<'a> Vertices<'a> {
    /// Places the vertices of a body in `room`.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn place(body: Placed<'a>, room: &'a mut Vec<PointBlock>) -> Result<Vertices<'a>> {
        room.clear();
        let polyhedron = body.shape.polyhedron();
        reserve(room, polyhedron.vertex_blocks.len())?;
        simd::dispatch(&mut PlacedVertices {
            blocks: &polyhedron.vertex_blocks,
            centre: &polyhedron.centre,
            pose: body.pose,
            room,
        });
        Ok(Vertices { body, blocks: room })
    }

    /// The body's geometry.
    pub fn polyhedron(&self) -> &'a Polyhedron {
        self.body.shape.polyhedron()
    }

    /// The body's pose.
    pub fn pose(&self) -> &'a Pose {
        self.body.pose
    }

    /// Whether all are placed: the body has not many.
    pub fn are_placed(&self) -> bool {
        !self.blocks.is_empty()
    }

    /// The place of a vertex.
    pub fn point(&self, vertex: u32) -> Vector {
        let Some(block) = self.blocks.get(vertex as usize / 4) else { return point(self.body, vertex) };
        let lane = vertex as usize % 4;
        Vector::new(block.x[lane], block.y[lane], block.z[lane])
    }

    /// A vertex that is lowest along a unit vector, as far as rounding lets one see; a climb begins at `start`.
    ///
    /// Two heights are each right to 4u of |p|₁, so another may be lower by 8u of that.
    pub fn lowest(&self, up: &Vector, start: u32) -> u32 {
        debug_assert!(is_unit(up));
        if self.blocks.is_empty() {
            return self.polyhedron().support(&self.pose().rotate_back(&-up), start).0;
        }
        let lowest = simd::dispatch(&mut Find { blocks: self.blocks, up });
        lowest.min(self.polyhedron().vertices.len() as u32 - 1)
    }

    /// How much lower the body may be than its lowest vertex, beyond the rounding of heights.
    pub fn excess(&self, lowest: u32, up: &Vector) -> f64 {
        if !self.blocks.is_empty() {
            return 0.0;
        }
        of_vertex(self.polyhedron(), lowest, &self.pose().rotate_back(&-up))
    }
}

fn point(body: Placed, vertex: u32) -> Vector {
    body.pose.transform(&body.shape.polyhedron().local_position(vertex))
}

/// Places blocks of vertices.
struct PlacedVertices<'a> {
    blocks: &'a [PointBlock],
    centre: &'a Vector,
    pose: &'a Pose,
    room: &'a mut Vec<PointBlock>,
}

impl Kernel for PlacedVertices<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(&mut self) {
        let rows = &self.pose.rows;
        for block in self.blocks {
            let x = L::load(&block.x).add(L::splat(self.centre.x));
            let y = L::load(&block.y).add(L::splat(self.centre.y));
            let z = L::load(&block.z).add(L::splat(self.centre.z));
            let mut placed = PointBlock { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4] };
            // One by one (rule R2).
            for (row, to) in rows.iter().zip([&mut placed.x, &mut placed.y, &mut placed.z]) {
                let sum = L::splat(row[2]).mul_add(z, L::splat(row[3]));
                *to = L::splat(row[0]).mul_add(x, L::splat(row[1]).mul_add(y, sum)).to_array();
            }
            // There is room.
            self.room.push(placed);
        }
    }
}

/// Finds the lowest of placed vertices.
struct Find<'a> {
    blocks: &'a [PointBlock],
    up: &'a Vector,
}

impl Kernel for Find<'_> {
    type Output = u32;

    #[inline(always)]
    fn run<L: Lanes>(&mut self) -> u32 {
        let [x, y, z] = [L::splat(self.up.x), L::splat(self.up.y), L::splat(self.up.z)];
        let (mut least, mut places, mut place) = (L::splat(f64::INFINITY), L::splat(0.0), L::splat(0.0));
        for block in self.blocks {
            let height = L::load(&block.z).mul_add(z, L::load(&block.y).mul_add(y, L::load(&block.x).mul(x)));
            places = place.where_greater(least, height, places);
            least = least.min(height);
            place = place.add(L::splat(1.0));
        }
        let (_, lane) = least.least();
        4 * places.to_array()[lane] as u32 + lane as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;
    use crate::shape::{Shape, ShapeOptions};

    /// No vertex is lower than the lowest by more than rounding, of bodies that are scanned and of those that are climbed; a scan
    /// and its excess bound what exact vertices reach.
    #[test]
    fn no_vertex_is_lower_than_the_lowest() {
        let mut random = Random::new(0x10e);
        for round in 0..if cfg!(miri) { 3 } else { 200 } {
            let points: Vec<Vector> = (0..4 + round % 90).map(|_| random.direction()).collect();
            let Ok(shape) = Shape::from_points(&points, &ShapeOptions::default()) else { continue };
            let pose = Pose::new(&random.rotation(), &(random.vector() * 10.0));
            let (body, mut room) = (shape.at(&pose), Vec::new());
            let vertices = Vertices::place(body, &mut room).unwrap();
            let (up, count) = (random.direction(), shape.polyhedron().vertices.len() as u32);
            let lowest = vertices.lowest(&up, 0);
            assert!(lowest < count);
            let low = up.dot(&vertices.point(lowest)) - vertices.excess(lowest, &up);
            assert!((0..count).all(|vertex| up.dot(&vertices.point(vertex)) >= low - 1e-14), "{round}");
        }
    }
}
