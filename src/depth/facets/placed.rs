//! A fan in the world, relative to body 2's origin.

use crate::base::math::Vector;
use crate::base::simd::Lanes;
use crate::body::polyhedron::fan::{FaceBlock, Fan, PointBlock};
use crate::placed::frame::Body;

/// A fan in the world, with room for this many blocks of points and of planes.
#[derive(Clone, Copy)]
pub struct PlacedFan<const C: usize, const F: usize> {
    points: [PointBlock; C],
    point_blocks: usize,
    plane_blocks: usize,
    planes: [FaceBlock; F],
}

impl<const C: usize, const F: usize> PlacedFan<C, F> {
    /// An empty one.
    pub const EMPTY: PlacedFan<C, F> = PlacedFan {
        points: [PointBlock { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4] }; C],
        point_blocks: 0,
        plane_blocks: 0,
        planes: [FaceBlock { x: [0.0; 4], y: [0.0; 4], z: [0.0; 4], reach: [0.0; 4] }; F],
    };

    /// Places a body's fan, its centred origin at `origin`. Points are R·p + T, as in [`Frame::difference`]; the normal of a face
    /// is that of the placed face, of unit length up to rounding.
    ///
    /// [`Frame::difference`]: crate::placed::frame::Frame::difference
    #[inline(always)]
    pub fn place<L: Lanes>(&mut self, body: &Body<L>, fan: &Fan, origin: L, rigid: bool) {
        let columns = body.columns();
        let [x0, y0, z0] = [origin.splat_x(), origin.splat_y(), origin.splat_z()];
        let turn = FanTurn::of(&columns);
        self.point_blocks = fan.points.len();
        for (placed, own) in self.points.iter_mut().zip(&fan.points) {
            let [x, y, z] = turn.apply([L::load(&own.x), L::load(&own.y), L::load(&own.z)]);
            *placed = PointBlock { x: x.add(x0).to_array(), y: y.add(y0).to_array(), z: z.add(z0).to_array() };
        }
        // Normals turn by R⁻ᵀ, which is R up to rounding, or else the matrix of cofactors over the determinant.
        let [a, b, c] = columns;
        let turn = if rigid { turn } else { FanTurn::of(&[b.cross(c), c.cross(a), a.cross(b)]) };
        self.plane_blocks = fan.planes.len();
        for (placed, own) in self.planes.iter_mut().zip(&fan.planes) {
            let [mut x, mut y, mut z] = turn.apply([L::load(&own.x), L::load(&own.y), L::load(&own.z)]);
            let mut reach = L::load(&own.reach);
            if !rigid {
                // |R⁻ᵀn| is the length over the determinant.
                let length = x.mul_add(x, y.mul_add(y, z.mul(z))).sqrt();
                reach = reach.mul(L::splat(turn_determinant(&columns))).div(length);
                [x, y, z] = [x.div(length), y.div(length), z.div(length)];
            }
            let reach = x.mul_add(x0, y.mul_add(y0, z.mul_add(z0, reach)));
            *placed = FaceBlock { x: x.to_array(), y: y.to_array(), z: z.to_array(), reach: reach.to_array() };
        }
    }

    /// The placed points.
    #[inline(always)]
    pub fn points(&self) -> &[PointBlock] {
        &self.points[..self.point_blocks]
    }

    /// A corner, in the world.
    #[inline(always)]
    pub fn point(&self, corner: usize) -> Vector {
        let PointBlock { x, y, z } = &self.points[corner / 4];
        Vector::new(x[corner % 4], y[corner % 4], z[corner % 4])
    }

    /// The normal of a face.
    #[inline(always)]
    pub fn normal(&self, face: usize) -> Vector {
        let FaceBlock { x, y, z, .. } = &self.planes[face / 4];
        Vector::new(x[face % 4], y[face % 4], z[face % 4])
    }

    /// How far the body reaches along a face's normal.
    #[inline(always)]
    pub fn reach(&self, face: usize) -> f64 {
        self.planes[face / 4].reach[face % 4]
    }

    /// The least product of a corner with a vector.
    #[inline(always)]
    pub fn least<L: Lanes>(&self, along: &Vector) -> f64 {
        let [nx, ny, nz] = [L::splat(along.x), L::splat(along.y), L::splat(along.z)];
        let mut least = L::splat(f64::INFINITY);
        for PointBlock { x, y, z } in self.points() {
            least = least.min(nx.mul_add(L::load(x), ny.mul_add(L::load(y), nz.mul(L::load(z)))));
        }
        least.least().0
    }

    /// The corners whose product with a vector is at most so much, as bits; those that the last block repeats are there, too.
    #[inline(always)]
    pub fn at_most<L: Lanes>(&self, along: &Vector, most: f64) -> u64 {
        let [nx, ny, nz] = [L::splat(along.x), L::splat(along.y), L::splat(along.z)];
        let (most, mut bits) = (L::splat(most), 0);
        for (block, PointBlock { x, y, z }) in self.points().iter().enumerate() {
            let product = nx.mul_add(L::load(x), ny.mul_add(L::load(y), nz.mul(L::load(z))));
            bits |= u64::from(product.at_most(most)) << (4 * block);
        }
        bits
    }

    /// The face whose plane is least high above a point.
    #[inline(always)]
    pub fn face_above<L: Lanes>(&self, point: &Vector) -> usize {
        let [px, py, pz] = [L::splat(point.x), L::splat(point.y), L::splat(point.z)];
        let mut best = (f64::INFINITY, 0);
        for (block, FaceBlock { x, y, z, reach }) in self.planes[..self.plane_blocks].iter().enumerate() {
            let below = L::load(z).negated_mul_add(pz, L::load(reach));
            let below = L::load(x).negated_mul_add(px, L::load(y).negated_mul_add(py, below));
            let (least, lane) = below.least();
            if least < best.0 {
                best = (least, 4 * block + lane);
            }
        }
        best.1
    }
}

/// A matrix, each entry in all lanes.
#[derive(Clone, Copy)]
struct FanTurn<L>([[L; 3]; 3]);

impl<L: Lanes> FanTurn<L> {
    #[inline(always)]
    fn of([a, b, c]: &[L; 3]) -> FanTurn<L> {
        FanTurn([
            [a.splat_x(), b.splat_x(), c.splat_x()],
            [a.splat_y(), b.splat_y(), c.splat_y()],
            [a.splat_z(), b.splat_z(), c.splat_z()],
        ])
    }

    /// Four vectors at a time.
    #[inline(always)]
    fn apply(&self, [x, y, z]: [L; 3]) -> [L; 3] {
        let [p, q, r] = &self.0;
        [
            p[2].mul_add(z, p[1].mul_add(y, p[0].mul(x))),
            q[2].mul_add(z, q[1].mul_add(y, q[0].mul(x))),
            r[2].mul_add(z, r[1].mul_add(y, r[0].mul(x))),
        ]
    }
}

/// The determinant of the columns.
#[inline(always)]
fn turn_determinant<L: Lanes>([a, b, c]: &[L; 3]) -> f64 {
    a.dot(b.cross(*c))
}
