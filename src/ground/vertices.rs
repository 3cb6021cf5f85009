//! The vertices of a body where it is. Those of a small one are all placed once, and looked at four at a time.

use crate::base::error::Result;
use crate::base::math::{Pose, Vector, is_unit};
use crate::base::memory::push;
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::fan::PointBlock;
use crate::distance::certificate::of_vertex;
use crate::pair::Placed;

/// Looking at so many vertices takes no longer than a climb.
const MOST_PLACED: usize = 64;

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
        let count = body.shape.polyhedron().vertices.len() as u32;
        if count as usize <= MOST_PLACED {
            for first in (0..count).step_by(4) {
                let points = [0, 1, 2, 3].map(|k| point(body, (first + k).min(count - 1)));
                let [x, y, z] = [0, 1, 2].map(|axis| points.map(|point| point[axis]));
                push(room, PointBlock { x, y, z })?;
            }
        }
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

    /// Where a vertex is.
    pub fn point(&self, vertex: u32) -> Vector {
        point(self.body, vertex)
    }

    /// A vertex that is lowest along a unit vector, as far as rounding lets one see; a climb begins at `start`.
    ///
    /// Two heights are each right to 4u of |p|₁, so another may be lower by 8u of that.
    pub fn lowest(&self, up: &Vector, start: u32) -> u32 {
        debug_assert!(is_unit(up));
        debug_assert!(is_unit(up));
        if self.blocks.is_empty() {
            return self.polyhedron().support(&self.pose().rotate_back(&-up), start).0;
        }
        let (mut least, mut places, mut place) = ([f64::INFINITY; 4], [0.0; 4], 0.0);
        for block in self.blocks {
            for lane in 0..4 {
                let height = up.x * block.x[lane] + up.y * block.y[lane] + up.z * block.z[lane];
                let is_lower = height < least[lane];
                least[lane] = if is_lower { height } else { least[lane] };
                places[lane] = if is_lower { place } else { places[lane] };
            }
            place += 1.0;
        }
        let lane = (1..4).fold(0, |best, lane| if least[lane] < least[best] { lane } else { best });
        let last = self.polyhedron().vertices.len() as u32 - 1;
        (4 * places[lane] as u32 + lane as u32).min(last)
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
