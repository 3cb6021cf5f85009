//! parry3d-f64's contact manifolds of bodies with its triangle mesh or height field, each body's kept from step to step.

use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector as ParryVector};
use parry3d_f64::query::{
    ContactManifold, ContactManifoldsWorkspace, DefaultQueryDispatcher, PersistentQueryDispatcher,
};
use parry3d_f64::shape::{Cuboid, HeightField, HeightFieldFlags, Shape, TriMesh, TriMeshFlags};
use parry3d_f64::utils::Array2;
use swiftprox::math::Pose;

use super::scenes::{BODIES, Hills, Kind, MARGIN, SIDE, Surface};
use super::{Counted, Grounded, is_ghost};
use crate::cast::parry::polyhedron;
use crate::parry::pose_of;

/// What is done about inner edges.
#[derive(Clone, Copy, PartialEq)]
pub enum Edges {
    /// Nothing: as its constructors make grounds.
    Bare,
    /// `FIX_INTERNAL_EDGES`: normals are held within those of the triangles around.
    Fixed,
}

/// What a body remembers.
#[derive(Default)]
struct Kept {
    manifolds: Vec<ContactManifold<(), ()>>,
    workspace: Option<ContactManifoldsWorkspace>,
}

pub struct Parry {
    name: &'static str,
    ground: Box<dyn Shape>,
    place: ParryPose,
    body: Box<dyn Shape>,
    poses: Vec<ParryPose>,
    kept: Vec<Kept>,
    last: usize,
}

impl Parry {
    pub fn new(hills: &Hills, kind: Kind, poses: &[Pose], edges: Edges) -> Result<Parry, String> {
        let (ground, place) = ground(hills, edges)?;
        let body: Box<dyn Shape> = match kind {
            Kind::Box(half) => Box::new(Cuboid::new(half.into())),
            _ => Box::new(polyhedron(&kind.mesh().map_err(|error| error.to_string())?)?),
        };
        Ok(Parry {
            name: if edges == Edges::Fixed { "parry-fixed" } else { "parry" },
            ground,
            place,
            body,
            poses: poses.iter().map(|pose| pose_of(pose.rows.as_flattened())).collect(),
            kept: (0..BODIES).map(|_| Kept::default()).collect(),
            last: 0,
        })
    }
}

/// A ground, and where it is: parry's heights are along y, about the origin, its rows along z.
fn ground(hills: &Hills, edges: Edges) -> Result<(Box<dyn Shape>, ParryPose), String> {
    let is_fixed = edges == Edges::Fixed;
    if hills.surface == Surface::Soup {
        let vertices = hills.vertices.iter().map(|v| ParryVector::new(v.x, v.y, v.z)).collect();
        let flags = if is_fixed { TriMeshFlags::FIX_INTERNAL_EDGES } else { TriMeshFlags::empty() };
        let mesh = TriMesh::with_flags(vertices, hills.triangles.clone(), flags).map_err(|error| error.to_string())?;
        return Ok((Box::new(mesh), ParryPose::IDENTITY));
    }
    // Column by column; its z is minus our y.
    let by_columns = (0..SIDE).flat_map(|j| (0..SIDE).rev().map(move |i| hills.heights[i * SIDE + j])).collect();
    let extent = (SIDE - 1) as f64 * hills.surface.spacing();
    let flags = if is_fixed { HeightFieldFlags::FIX_INTERNAL_EDGES } else { HeightFieldFlags::empty() };
    let scale = ParryVector::new(extent, 1.0, extent);
    let field = HeightField::with_flags(Array2::new(SIDE, SIDE, by_columns), scale, flags);
    let upright = Rotation::from_rotation_x(std::f64::consts::FRAC_PI_2);
    let middle = ParryVector::new(0.5 * extent, 0.5 * extent, 0.0);
    Ok((Box::new(field), ParryPose::from_parts(middle, upright)))
}

impl Grounded for Parry {
    fn name(&self) -> &'static str {
        self.name
    }

    fn forget(&mut self) {
        self.kept.fill_with(Kept::default);
        // The first step finds its manifolds warm, as all others do.
        (0..BODIES).for_each(|i| self.ask(i));
    }

    fn ask(&mut self, i: usize) {
        let Kept { manifolds, workspace } = &mut self.kept[i % BODIES];
        let between = self.place.inv_mul(&self.poses[i]);
        let dispatcher: &dyn PersistentQueryDispatcher<(), ()> = &DefaultQueryDispatcher;
        let asked = dispatcher.contact_manifolds(&between, &*self.ground, &*self.body, MARGIN, manifolds, workspace);
        assert!(asked.is_ok(), "parry answers bodies on grounds");
        self.last = i % BODIES;
    }

    fn counted(&self) -> Counted {
        let mut counted = Counted::default();
        for manifold in &self.kept[self.last].manifolds {
            let points = manifold.points.iter().filter(|point| point.dist <= MARGIN).count();
            if points > 0 {
                counted.normals += 1;
                counted.points += points;
                counted.ghosts += usize::from(is_ghost((self.place.rotation * manifold.local_n1).z));
            }
        }
        counted
    }
}
