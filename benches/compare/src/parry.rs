//! parry3d-f64's GJK in its strongest configuration: a support map of our own that climbs the hull from the vertex of
//! the call before, its rings of neighbours stored with their coordinates, and the last separating direction handed back
//! in. Poses are stored as parry's own (quaternion and translation), the relative pose is formed within the timing.

use std::cell::Cell;
use std::rc::Rc;

use parry3d_f64::math::{Matrix3, Pose, Rotation, Vector};
use parry3d_f64::query::details::closest_points_support_map_support_map_with_params as distance;
use parry3d_f64::query::details::intersection_test_support_map_support_map_with_params as intersects;
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};
use parry3d_f64::shape::SupportMap;

use crate::method::{Method, Reply};
use swiftprox::mesh::PolygonMesh;
use testkit::PosePair;

/// Parry's own form of two poses. A quaternion cannot hold a matrix that is not quite orthonormal.
pub fn pose_pair(poses: &PosePair) -> (Pose, Pose) {
    (pose_of(&poses[..12]), pose_of(&poses[12..]))
}

/// Parry's own form of the row-major `[R|T]`.
pub fn pose_of(m: &[f64]) -> Pose {
    let column = |j: usize| Vector::new(m[j], m[4 + j], m[8 + j]);
    let rotation = Matrix3::from_cols(column(0), column(1), column(2));
    Pose::from_parts(column(3), Rotation::from_mat3(&rotation).normalize())
}

/// A hull as rings of neighbours.
pub struct Rings {
    vertices: Vec<Vector>,
    /// Vertex v's ring is `ring[starts[v]..starts[v + 1]]`.
    starts: Vec<u32>,
    ring: Vec<(Vector, u32)>,
}

impl Rings {
    /// Every vertex must be extreme: a climb ends at a vertex as high as all its neighbours, which one inside a face can be
    /// without being the highest.
    pub fn new(mesh: &PolygonMesh) -> Rings {
        let vertices: Vec<Vector> = mesh.vertices.iter().map(|v| Vector::new(v.x, v.y, v.z)).collect();
        let mut neighbours = vec![Vec::new(); vertices.len()];
        for f in 0..mesh.face_count() {
            let face = mesh.face(f);
            for (k, &from) in face.iter().enumerate() {
                neighbours[from as usize].push(face[(k + 1) % face.len()]);
            }
        }
        if mesh.face_count() == 0 && vertices.len() == 2 {
            neighbours = vec![vec![1], vec![0]];
        }
        let (mut starts, mut ring) = (vec![0], Vec::new());
        for list in neighbours {
            ring.extend(list.into_iter().map(|to| (vertices[to as usize], to)));
            starts.push(ring.len() as u32);
        }
        Rings { vertices, starts, ring }
    }

    pub fn vertices(&self) -> &[Vector] {
        &self.vertices
    }
}

/// One body's view of the rings: where its last climb ended. It goes on to the steepest of a ring, or to the first that rises.
pub struct Climber<'a, const STEEPEST: bool> {
    pub rings: &'a Rings,
    pub last: &'a Cell<u32>,
}

impl<const STEEPEST: bool> SupportMap for Climber<'_, STEEPEST> {
    #[inline]
    fn local_support_point(&self, direction: Vector) -> Vector {
        let rings = self.rings;
        let mut at = self.last.get();
        let mut point = rings.vertices[at as usize];
        let mut height = point.dot(direction);
        loop {
            let from = at;
            let range = rings.starts[from as usize] as usize..rings.starts[from as usize + 1] as usize;
            for &(neighbour, index) in &rings.ring[range] {
                let other = neighbour.dot(direction);
                if other > height {
                    (at, point, height) = (index, neighbour, other);
                    if !STEEPEST {
                        break;
                    }
                }
            }
            if at == from {
                self.last.set(at);
                return point;
            }
        }
    }
}

/// A climber on body 2 that turns directions by a matrix, formed once a query, where parry's provided `support_point`
/// turns them by the quaternion each time.
struct TurnedClimber<'a> {
    climber: Climber<'a, false>,
    rotation: Matrix3,
}

impl SupportMap for TurnedClimber<'_> {
    #[inline]
    fn local_support_point(&self, direction: Vector) -> Vector {
        self.climber.local_support_point(direction)
    }

    #[inline]
    fn support_point(&self, pose: &Pose, direction: Vector) -> Vector {
        let r = &self.rotation;
        let local = Vector::new(r.x_axis.dot(direction), r.y_axis.dot(direction), r.z_axis.dot(direction));
        *r * self.local_support_point(local) + pose.translation
    }
}

/// Two hulls at poses, and what a query leaves to the next: where climbs ended, and the last direction.
pub struct ClimbedPair {
    rings: [Rc<Rings>; 2],
    pub poses: Vec<(Pose, Pose)>,
    last: [Cell<u32>; 2],
    pub direction: Option<Vector>,
}

impl ClimbedPair {
    pub fn new(rings: [Rc<Rings>; 2]) -> ClimbedPair {
        ClimbedPair { rings, poses: Vec::new(), last: [Cell::new(0), Cell::new(0)], direction: None }
    }

    pub fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses.iter().map(pose_pair).collect();
    }

    pub fn forget(&mut self) {
        self.last = [Cell::new(0), Cell::new(0)];
        self.direction = None;
    }

    #[inline]
    pub fn climbers<const STEEPEST: bool>(&self) -> [Climber<'_, STEEPEST>; 2] {
        [0, 1].map(|k| Climber { rings: &self.rings[k], last: &self.last[k] })
    }

    /// Hull 2 in the frame of hull 1.
    #[inline]
    pub fn relative_pose(&self, i: usize) -> Pose {
        let (pose1, pose2) = &self.poses[i];
        pose1.inv_mul(pose2)
    }
}

/// How the support maps are written.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Climbing {
    /// To the first neighbour that rises: of 1,002 vertices a tenth faster than to the steepest.
    First,
    /// To the steepest neighbour, as hill climbing is mostly written: of 10,002 vertices a tenth faster at random poses.
    Steepest,
    /// To the first, and body 2 turns directions by a matrix, not as parry's trait provides it: a sixth faster when coherent.
    FirstWithMatrix,
}

pub struct Parry {
    climbing: Climbing,
    pair: ClimbedPair,
    simplex: VoronoiSimplex,
    answer: GJKResult,
}

impl Parry {
    pub fn new(rings: [Rc<Rings>; 2], climbing: Climbing) -> Parry {
        Parry {
            climbing,
            pair: ClimbedPair::new(rings),
            simplex: VoronoiSimplex::new(),
            answer: GJKResult::Intersection,
        }
    }
}

impl Method for Parry {
    fn name(&self) -> &str {
        match self.climbing {
            Climbing::First => "parry-hc",
            Climbing::Steepest => "parry-hc-steepest",
            Climbing::FirstWithMatrix => "parry-hc-matrix",
        }
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.pair.load(poses);
    }

    fn forget(&mut self) {
        self.pair.forget();
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        let pose12 = self.pair.relative_pose(i);
        let (simplex, direction) = (&mut self.simplex, self.pair.direction);
        self.answer = match self.climbing {
            Climbing::First => {
                let [climber1, climber2] = self.pair.climbers::<false>();
                distance(&pose12, &climber1, &climber2, f64::MAX, simplex, direction)
            }
            Climbing::Steepest => {
                let [climber1, climber2] = self.pair.climbers::<true>();
                distance(&pose12, &climber1, &climber2, f64::MAX, simplex, direction)
            }
            Climbing::FirstWithMatrix => {
                let [climber1, climber] = self.pair.climbers::<false>();
                let rotation = Matrix3::from_quat(pose12.rotation);
                distance(&pose12, &climber1, &TurnedClimber { climber, rotation }, f64::MAX, simplex, direction)
            }
        };
        if let GJKResult::ClosestPoints(_, _, direction) = self.answer {
            self.pair.direction = Some(direction);
        }
    }

    fn reply(&self) -> Reply {
        let distance = match self.answer {
            GJKResult::ClosestPoints(point1, point2, _) => (point1 - point2).length(),
            GJKResult::Intersection => 0.0,
            GJKResult::NoIntersection(_) | GJKResult::Proximity(_) => f64::NAN,
        };
        Reply::of(distance)
    }
}

/// The verdict alone, by a GJK that stops at the first direction that separates.
pub struct Verdict {
    pair: ClimbedPair,
    simplex: VoronoiSimplex,
    intersecting: bool,
}

impl Verdict {
    pub fn new(rings: [Rc<Rings>; 2]) -> Verdict {
        Verdict { pair: ClimbedPair::new(rings), simplex: VoronoiSimplex::new(), intersecting: false }
    }
}

impl Method for Verdict {
    fn name(&self) -> &str {
        "parry-hc"
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.pair.load(poses);
    }

    fn forget(&mut self) {
        self.pair.forget();
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        let pose12 = self.pair.relative_pose(i);
        let [climber1, climber2] = self.pair.climbers::<false>();
        let (intersecting, direction) =
            intersects(&pose12, &climber1, &climber2, &mut self.simplex, self.pair.direction);
        self.intersecting = intersecting;
        self.pair.direction = Some(direction);
    }

    fn reply(&self) -> Reply {
        Reply::of(if self.intersecting { 0.0 } else { f64::INFINITY })
    }
}
