//! A shape: geometry that any number of objects, scenes and threads share.

#[doc(hidden)]
pub mod levels;
pub(crate) mod extent;
mod transform;
mod patch;
mod face;
mod solids;
mod curved;
mod triangle;
pub mod file;
mod placed;

use std::path::Path;

use crate::base::error::{Error, Result, check_range};
use crate::base::locality::{along_curve, in_order};
use crate::base::mark::Mark;
use crate::base::math::{Matrix, Vector, length};
use crate::base::memory::{OnNeed, copied, found, in_integers, with_capacity};
use crate::base::progress::Progress;
use crate::base::simd::environment::with_default;
use crate::body::build::assembly::build_in_steps;
use crate::body::build::check::{
    FLAT_HINT, HULL_HINT, check_convexity, check_mesh_in_steps, check_surface, is_inside_out, vertex_of_no_face,
};
use crate::body::build::contact_faces::{default_noise, find_contact_faces};
use crate::body::build::hull::{check_points, convex_hull_in_steps};
use crate::body::build::mass::inertia;
use crate::body::build::outlines::give_contact_faces;
use crate::body::mesh::io::read_mesh;
use crate::body::mesh::{Numbers, PolygonMesh, coordinate_unit};
use crate::body::polyhedron::Polyhedron;
use crate::body::tables::support_map::SupportMap;
pub use crate::body::tables::{LookupKind, LookupOptions};
use crate::body::tables::{insist_on_table, plan_lookup};
use crate::shape::levels::hierarchy::{Hierarchy, HierarchyKind, HierarchyOptions, LEAST_VERTICES_FOR_LEVELS};
use extent::Extent;
pub use face::Face;
pub use patch::NO_FACE;
use patch::hull_of_patch;
pub use placed::Placed;
use transform::{InputTransform, transformed};
pub(crate) use triangle::{Triangle, TriangleShape};

/// The input policy that takes every mesh of finite vertices.
const CURE: &str = "the input policy Hull (SWIFTPROX_INPUT_HULL) takes the hull of the vertices";

/// The input policy that takes a mesh without its vertices of no face, if each face has three corners.
const CURE_BY_FACES: &str = "the input policy Patch (SWIFTPROX_INPUT_PATCH) takes the hull of the faces";

/// A refusal of a mesh with the policy that would take it, where it does not name one itself.
fn with_cure(error: Error, mesh: &PolygonMesh) -> Error {
    let Error::Mesh(message) = &error else {
        return error;
    };
    if [FLAT_HINT, HULL_HINT].iter().any(|hint| message.ends_with(hint)) {
        return error;
    }
    match vertex_of_no_face(mesh, &mut Progress::new(&mut |_| true)) {
        Err(error @ Error::Memory(_)) => error,
        // Whoever takes the hull of all should know how far it reaches.
        Ok(Some(v)) => {
            let is_patch = (0..mesh.face_count()).all(|f| mesh.face(f).len() >= 3);
            let by_faces = if is_patch { format!("{CURE_BY_FACES}, ") } else { String::new() };
            Error::Mesh(format!("{message}; {by_faces}{CURE}, also of those in no face (such as vertex {v})"))
        }
        Ok(None) | Err(_) => Error::Mesh(format!("{message}; {CURE}")),
    }
}

/// Default of [`ShapeOptions::convexity_tolerance`].
const CONVEXITY_TOLERANCE: f64 = 1e-9;

/// The same for meshes that went through single precision.
const SINGLE_PRECISION_CONVEXITY_TOLERANCE: f64 = 1e-6;

/// How far a mesh may be from convex whose coordinates are off by so many units of their last place: a vertex by √3 of them, which
/// is two roundings along each axis, and another one the other way ([`coordinate_unit`]).
const UNITS_ALLOWED: f64 = 4.0;

/// The most that coarse coordinates excuse: a mesh farther from convex looks dented.
const MOST_EXCUSED: f64 = 5e-3;

/// How far from convex a mesh may be because of the precision of its coordinates, relative to its bounding box's diagonal: four
/// units of their last place, at least 1e-9 and at most 0.005.
///
/// It depends on the coordinates as they were written down, before any transform.
pub fn precision_tolerance(vertices: &[Vector]) -> f64 {
    let eighth = eighth_diagonal(vertices);
    let found = if eighth > 0.0 { UNITS_ALLOWED / 8.0 * (coordinate_unit(vertices) / eighth) } else { 0.0 };
    found.clamp(CONVEXITY_TOLERANCE, MOST_EXCUSED)
}

/// The policy for input that is not a closed convex mesh with interior.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum InputPolicy {
    /// Refuse it with a message that says where.
    #[default]
    Strict = 0,
    /// Admit bodies without interior (a two-sided polygon); otherwise as strict.
    Flat = 1,
    /// Take the convex hull of the vertices, of any dimension, also of those that belong to no face. Faces label the hull if one of
    /// the other two would admit the mesh; otherwise they are ignored, and a face's label is its own index.
    Hull = 2,
    /// Same as flat, for a mesh that is convex up to the precision of its coordinates: the convex hull counts. A mesh whose faces
    /// all run clockwise seen from outside is turned. Vertices and faces keep the caller's indices. A vertex that the hull
    /// swallows is never the feature of an answer; a face that it swallows shares the hull's face over it, and is named where it
    /// is the nearest of those that share. Without a convexity tolerance the coordinates tell it, before the input transform:
    /// four units of the last place in which they are written (decimals, significant digits, floats), at most 0.005 of the
    /// bounding box's diagonal.
    NearlyConvex = 3,
    /// The faces are a part of the surface of their vertices' hull, or all of it: that hull counts, of any dimension. Vertices of
    /// no face, which some mesh files have, are left out. A face of the hull on which no face of the mesh lies is called
    /// SWIFTPROX_NO_FACE. Whether the faces do lie on the hull is not checked: no verdict and no distance depends on it.
    Patch = 4,
}

/// How a shape is made.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeOptions {
    /// The policy for input that is not a closed convex mesh with interior.
    pub input: InputPolicy,
    /// Stored vertex = scale·(rotation·v) + translation, rounded once to doubles; the local frame of all answers. Accepted like
    /// the rotation of a pose ([`ROTATION_LIMIT`](crate::base::math::ROTATION_LIMIT)).
    pub rotation: Matrix,
    /// See `rotation`.
    pub translation: Vector,
    /// See `rotation`; positive and finite.
    pub scale: f64,
    /// Largest distance of a vertex outside a face of accepted input, relative to the bounding-box diagonal. `None`: 1e-9, or
    /// 1e-6 for meshes that went through single precision; with [`InputPolicy::NearlyConvex`] also [`precision_tolerance`].
    pub convexity_tolerance: Option<f64>,
    /// Levels of detail.
    pub hierarchy: HierarchyOptions,
    /// The table of vertices from which marching starts when the last query tells nothing. It is made by the first query that
    /// looks into it.
    pub lookup: LookupOptions,
    /// A bound of a coordinate's error, in the units of the input, before `scale`: vertices that could lie in one plane up to
    /// this are one face to manifolds. Distance and depth do not change; the intervals of gaps contain the joined faces. `None`:
    /// found from the coordinates and polygons ([`default_noise`]). 0: rounding of doubles only.
    pub face_noise: Option<f64>,
    /// The radius of a ball that is swept over the body, in the units of the input, before `scale`: a point with one is a sphere, a
    /// segment a capsule, a body one with round edges. All answers of pairs, rays and scenes are about the swept body; witness
    /// points are on it, features are of the body without the ball. From 0 (the default) to [`LARGEST_SWEPT_RADIUS`].
    pub swept_radius: f64,
}

impl Default for ShapeOptions {
    fn default() -> Self {
        ShapeOptions {
            input: InputPolicy::Strict,
            rotation: Matrix::identity(),
            translation: Vector::zeros(),
            scale: 1.0,
            convexity_tolerance: None,
            hierarchy: HierarchyOptions::default(),
            lookup: LookupOptions::default(),
            face_noise: None,
            swept_radius: 0.0,
        }
    }
}

/// The largest [`ShapeOptions::swept_radius`], 2¹⁰⁰⁰: sums of a few lengths are finite.
pub const LARGEST_SWEPT_RADIUS: f64 = f64::from_bits((1023 + 1000) << 52);

impl ShapeOptions {
    fn transform(&self) -> InputTransform {
        InputTransform { rotation: self.rotation, translation: self.translation, scale: self.scale }
    }

    /// The radius of the ball in the local frame.
    fn radius(&self) -> Result<f64> {
        check_range("swept_radius", self.swept_radius, 0.0..=LARGEST_SWEPT_RADIUS)?;
        let radius = self.swept_radius * self.scale;
        check_range("swept_radius times scale", radius, 0.0..=LARGEST_SWEPT_RADIUS)?;
        Ok(radius)
    }

    /// A bound of the coordinates' errors in the local frame; `polygons` are over the points, all before the input transform.
    fn noise(&self, points: &[Vector], polygons: Option<&PolygonMesh>) -> Result<f64> {
        let noise = match self.face_noise {
            Some(noise) => {
                check_range("face_noise", noise, 0.0..=f64::MAX)?;
                noise
            }
            None => default_noise(points, polygons),
        };
        Ok((noise * self.scale).min(f64::MAX))
    }

    /// Which part of building the shape, about, the body itself is.
    fn share_of_body(&self) -> f64 {
        match self.hierarchy.kind {
            HierarchyKind::None | HierarchyKind::Given | HierarchyKind::Automatic => 1.0,
            HierarchyKind::Quadric | HierarchyKind::OuterCuts => 0.4,
            HierarchyKind::DobkinKirkpatrick => 0.06,
        }
    }
}

/// Geometry for queries: immutable, shared by any number of owners. Only data made when a query first needs them are ever added:
/// look-up tables of the body and of its levels, maps of its support function, automatic levels.
#[derive(Debug, Clone)]
pub struct Shape {
    polyhedron: Polyhedron,
    /// How far it reaches.
    extent: Extent,
    /// Empty while automatic levels are not made.
    hierarchy: OnNeed<Hierarchy>,
    /// Radius of the ball that is swept over the polyhedron.
    swept_radius: f64,
    /// The curved body holds the polyhedron, and reaches no farther from it than this at any pose; 0 for a body that is its own.
    deviation: f64,
    /// Its support function for approximate distances, as far as it is made.
    pub(crate) support_map: SupportMap,
    pub(crate) mark: Mark,
}

/// Tables, automatic levels and how far it reaches do not count: equal shapes make equal ones.
impl PartialEq for Shape {
    fn eq(&self, other: &Shape) -> bool {
        let [levels, others] = [self.hierarchy(), other.hierarchy()];
        let are_automatic = [levels, others].map(|levels| levels.kind == HierarchyKind::Automatic);
        (&self.polyhedron, self.swept_radius, self.deviation)
            == (&other.polyhedron, other.swept_radius, other.deviation)
            && (are_automatic == [true; 2] || levels == others)
    }
}

impl Shape {
    /// From a mesh in the caller's numbering.
    ///
    /// # Errors
    /// [`Error::Argument`] for options out of range, [`Error::Mesh`] for a mesh that the policy does not admit, with the face,
    /// edge or vertex where.
    pub fn from_mesh(mesh: &PolygonMesh, options: &ShapeOptions) -> Result<Shape> {
        Shape::from_mesh_in_steps(mesh, options, &mut Progress::new(&mut |_| true))
    }

    /// Same as [`Shape::from_mesh`], with progress reports.
    ///
    /// # Errors
    /// Same as [`Shape::from_mesh`]; [`Error::Cancelled`] when the caller does not want to go on.
    pub fn from_mesh_in_steps(mesh: &PolygonMesh, options: &ShapeOptions, progress: &mut Progress) -> Result<Shape> {
        in_integers(|| with_default(|| Shape::of_mesh(mesh, options, progress)))?
    }

    fn of_mesh(mesh: &PolygonMesh, options: &ShapeOptions, progress: &mut Progress) -> Result<Shape> {
        if mesh.vertices.is_empty() {
            return Err(Error::Mesh("the mesh has no vertices".into()));
        }
        if options.input == InputPolicy::Patch {
            return Shape::of_patch(mesh, options, progress);
        }
        let given = mesh;
        let least_tolerance = match options.input {
            InputPolicy::NearlyConvex => precision_tolerance(&mesh.vertices),
            InputPolicy::Strict | InputPolicy::Flat | InputPolicy::Hull | InputPolicy::Patch => CONVEXITY_TOLERANCE,
        };
        let mut mesh = PolygonMesh {
            vertices: transformed(&mesh.vertices, &options.transform(), &mut progress.part(0.0, 0.0))?,
            indices: copied(&mesh.indices)?,
            starts: copied(&mesh.starts)?,
            single_precision: mesh.single_precision,
        };
        let tolerance = match options.convexity_tolerance {
            Some(tolerance) => {
                check_range("convexity_tolerance", tolerance, 0.0..=f64::MAX)?;
                tolerance
            }
            None if mesh.single_precision => least_tolerance.max(SINGLE_PRECISION_CONVEXITY_TOLERANCE),
            None => least_tolerance,
        };
        let tolerance = tolerance * eighth_diagonal(&mesh.vertices) * 8.0;
        check_points(&mesh.vertices)?;
        let mut of_body = progress.part(0.0, options.share_of_body());
        let allow_flat = options.input != InputPolicy::Strict;
        let check_as_given = |mesh: &PolygonMesh, progress: &mut Progress| {
            check_mesh_in_steps(mesh, tolerance, allow_flat, progress).map_err(|error| with_cure(error, mesh))
        };
        // All that follows walks over the surface, so it does that in an order that keeps neighbours near each other.
        let order = along_curve(&mesh.vertices, &mut of_body.part(0.0, 0.02))?;
        let Some((mut ordered, numbers)) = mesh.in_order(order, &mut of_body.part(0.02, 0.05))? else {
            return match options.input {
                InputPolicy::Strict | InputPolicy::Flat | InputPolicy::NearlyConvex => {
                    check_as_given(&mesh, &mut of_body).and(Err(Error::Bug("degenerate faces passed the check".into())))
                }
                InputPolicy::Hull | InputPolicy::Patch => {
                    let noise = options.noise(&given.vertices, None)?;
                    Shape::of_points(&mesh.vertices, noise, options, &mut progress.part(0.05, 1.0))
                }
            };
        };
        let hull = convex_hull_in_steps(&ordered.vertices, &mut of_body.part(0.05, 0.25))?;
        let closed = check_surface(&ordered, &mut of_body.part(0.25, 0.36));
        let turns = options.input == InputPolicy::NearlyConvex && closed.is_ok();
        if turns && is_inside_out(&ordered, &mut of_body.part(0.36, 0.36))? {
            ordered.turn();
            mesh.turn();
        }
        let checked = closed
            .and_then(|()| check_convexity(&ordered, &hull, tolerance, allow_flat, &mut of_body.part(0.36, 0.45)));
        let is_as_promised = found(checked)?.is_some();
        let polygons = match options.input {
            // A message is about the caller's numbers. A face may pass by a plane that the search meets in one order only: that is
            // good enough, as the plane is one of the hull whichever way led there.
            InputPolicy::Strict | InputPolicy::Flat | InputPolicy::NearlyConvex => {
                if !is_as_promised {
                    check_as_given(&mesh, &mut of_body.part(0.45, 0.45))?;
                }
                Some(&ordered)
            }
            InputPolicy::Hull | InputPolicy::Patch => is_as_promised.then_some(&ordered),
        };
        let building = &mut of_body.part(0.45, 1.0);
        let polyhedron = build_in_steps(&ordered.vertices, hull, polygons, Some(&numbers), building)?;
        let noise = options.noise(&given.vertices, polygons.map(|_| given))?;
        Shape::admitted(polyhedron, noise, options, progress)
    }

    /// The hull of an open surface that lies on it.
    fn of_patch(mesh: &PolygonMesh, options: &ShapeOptions, progress: &mut Progress) -> Result<Shape> {
        let Some((mut patch, used)) = mesh.without_unused_vertices()? else {
            return Err(Error::Mesh("a face of the patch names a vertex that is not there".into()));
        };
        if patch.face_count() == 0 {
            return Err(Error::Mesh("the mesh has no faces".into()));
        }
        if let Some(f) = (0..patch.face_count()).find(|f| patch.face(*f).len() < 3) {
            return Err(Error::Mesh(format!("face {f} has fewer than three corners")));
        }
        let noise = options.noise(&patch.vertices, None)?;
        patch.vertices = transformed(&patch.vertices, &options.transform(), &mut progress.part(0.0, 0.0))?;
        let polyhedron = hull_of_patch(&patch, &used, noise, &mut progress.part(0.0, options.share_of_body()))?;
        Shape::admitted(polyhedron, noise, options, progress)
    }

    /// The convex hull of points. A face's label is its own index.
    ///
    /// # Errors
    /// [`Error::Argument`] for options out of range and no points; [`Error::Mesh`] for a point that is not finite and a hull whose
    /// dimension the policy does not admit.
    pub fn from_points(points: &[Vector], options: &ShapeOptions) -> Result<Shape> {
        Shape::from_points_in_steps(points, options, &mut Progress::new(&mut |_| true))
    }

    /// Same as [`Shape::from_points`], with progress reports.
    ///
    /// # Errors
    /// Same as [`Shape::from_points`]; [`Error::Cancelled`] when the caller does not want to go on.
    pub fn from_points_in_steps(points: &[Vector], options: &ShapeOptions, progress: &mut Progress) -> Result<Shape> {
        let build = || {
            let images = transformed(points, &options.transform(), &mut progress.part(0.0, 0.0))?;
            check_points(&images)?;
            Shape::of_points(&images, options.noise(points, None)?, options, progress)
        };
        in_integers(|| with_default(build))?
    }

    /// From finite points that went through the input transform.
    fn of_points(points: &[Vector], noise: f64, options: &ShapeOptions, progress: &mut Progress) -> Result<Shape> {
        let mut of_body = progress.part(0.0, options.share_of_body());
        let order = along_curve(points, &mut of_body.part(0.0, 0.04))?;
        let ordered = in_order(points, &order, &mut of_body.part(0.04, 0.05))?;
        let numbers = Numbers { vertices: order, faces: Vec::new(), bare_face: None, near: f64::INFINITY };
        let hull = convex_hull_in_steps(&ordered, &mut of_body.part(0.05, 0.3))?;
        let polyhedron = build_in_steps(&ordered, hull, None, Some(&numbers), &mut of_body.part(0.3, 1.0))?;
        Shape::admitted(polyhedron, noise, options, progress)
    }

    /// From a mesh file ([`read_mesh`]).
    ///
    /// # Errors
    /// Same as [`read_mesh`] and [`Shape::from_mesh`]; the message names the file.
    pub fn from_file(path: &Path, options: &ShapeOptions) -> Result<Shape> {
        Shape::from_file_in_steps(path, options, &mut Progress::new(&mut |_| true))
    }

    /// Same as [`Shape::from_file`], with progress reports.
    ///
    /// # Errors
    /// Same as [`Shape::from_file`]; [`Error::Cancelled`] when the caller does not want to go on.
    pub fn from_file_in_steps(path: &Path, options: &ShapeOptions, progress: &mut Progress) -> Result<Shape> {
        Shape::from_mesh_in_steps(&read_mesh(path)?, options, progress).map_err(|error| match error {
            Error::Mesh(message) => Error::Mesh(format!("{}: {message}", path.display())),
            other => other,
        })
    }

    /// From levels of detail that the caller gives, the finest first: `meshes[0]` is the body itself, as in [`Shape::from_mesh`];
    /// the convex hull of each further one's vertices counts, moved and scaled until it bounds the body
    /// ([`Hierarchy::from_levels`]). All go through the same input transform.
    ///
    /// # Errors
    /// Same as [`Shape::from_mesh`] and [`Hierarchy::from_levels`]; [`Error::Argument`] for no mesh, or if `options.hierarchy`
    /// asks for levels to be built.
    pub fn from_levels(meshes: &[PolygonMesh], options: &ShapeOptions, progress: &mut Progress) -> Result<Shape> {
        with_default(|| Shape::of_levels(meshes, options, progress))
    }

    fn of_levels(meshes: &[PolygonMesh], options: &ShapeOptions, progress: &mut Progress) -> Result<Shape> {
        let Some((mesh, levels)) = meshes.split_first() else {
            return Err(Error::Argument("no level is given, not even the body itself".into()));
        };
        if !matches!(options.hierarchy.kind, HierarchyKind::None | HierarchyKind::Automatic) {
            return Err(Error::Argument(
                "levels are given, and the options ask for others to be built: their hierarchy must be None or Automatic \
                 (SWIFTPROX_HIERARCHY_NONE, SWIFTPROX_HIERARCHY_AUTOMATIC)"
                    .into(),
            ));
        }
        let Shape { polyhedron, swept_radius, .. } =
            Shape::from_mesh_in_steps(mesh, options, &mut progress.part(0.0, 0.3))?;
        let mut points = with_capacity(levels.len())?;
        for (i, level) in levels.iter().enumerate() {
            let moved = transformed(&level.vertices, &options.transform(), &mut progress.part(0.3, 0.3));
            let in_level = |message: String| format!("level {}: {message}", i + 1);
            points.push(moved.map_err(|error| match error {
                Error::Mesh(message) => Error::Mesh(in_level(message)),
                Error::Cancelled(_) | Error::Memory(_) => error,
                other => Error::Argument(in_level(other.to_string())),
            })?);
        }
        let hierarchy = Hierarchy::from_levels(&polyhedron, &points, &mut progress.part(0.3, 1.0))?;
        Shape::from_parts(polyhedron, hierarchy, swept_radius)
    }

    /// From parts that belong together; automatic levels that are not there are left to be made.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub(crate) fn from_parts(polyhedron: Polyhedron, hierarchy: Hierarchy, swept_radius: f64) -> Result<Shape> {
        debug_assert!(swept_radius >= 0.0);
        let is_to_be_made = hierarchy.kind == HierarchyKind::Automatic && hierarchy.levels.is_empty();
        let made = if is_to_be_made { None } else { Some(hierarchy) };
        let extent = Extent::new(&polyhedron)?;
        let hierarchy = made.map_or_else(OnNeed::new, OnNeed::from);
        let support_map = SupportMap::new(&polyhedron)?;
        // No −0: which lengths are there is told by their bits (`Radii::are_there`).
        let swept_radius = swept_radius.abs();
        Ok(Shape { polyhedron, extent, hierarchy, support_map, swept_radius, deviation: 0.0, mark: Mark::new() })
    }

    /// The same polyhedron, in a curved body that reaches so much farther.
    pub(crate) fn with_deviation(mut self, deviation: f64) -> Shape {
        debug_assert!((0.0..=LARGEST_SWEPT_RADIUS).contains(&deviation));
        self.deviation = deviation.abs();
        self
    }

    /// The same body with other levels of detail, built at once if they are not automatic; those that it has are dropped.
    ///
    /// # Errors
    /// Same as [`Hierarchy::build`].
    pub fn with_levels(self, options: &HierarchyOptions, progress: &mut Progress) -> Result<Shape> {
        with_default(|| options.check())?;
        let Shape { polyhedron, swept_radius, deviation, .. } = self;
        let hierarchy = match options.kind {
            HierarchyKind::Automatic => {
                progress.report(1.0)?;
                Hierarchy::AUTOMATIC
            }
            _ => Hierarchy::build(&polyhedron, options, progress)?,
        };
        Ok(Shape::from_parts(polyhedron, hierarchy, swept_radius)?.with_deviation(deviation))
    }

    /// The same shape with every length multiplied by `scale`, a power of two: vertices, levels of detail and distances are
    /// exactly those multiplied, and labels are the same. Levels are not built anew, automatic ones are taken over if they are
    /// made. The data that answers rest on are proved and measured again, same as by [`file::load`]; that takes up to half as
    /// long as making the shape did.
    ///
    /// A shape that is turned or moved needs no copy: it is a pose, of an object or of a piece of it. At any other scale vertices
    /// would be rounded, faces with them, and levels might no longer contain the body: such a shape is to be made anew
    /// ([`ShapeOptions::scale`]), one that is stretched or mirrored from other vertices.
    ///
    /// # Errors
    /// [`Error::Argument`] for a scale that is not a positive power of two, or at which a length leaves the doubles;
    /// [`Error::Memory`]; [`Error::Cancelled`] when the caller does not want to go on.
    pub fn scaled(&self, scale: f64, progress: &mut Progress) -> Result<Shape> {
        const FRACTION: u64 = (1 << 52) - 1;
        with_default(|| {
            if !(scale.is_normal() && scale > 0.0 && scale.to_bits() & FRACTION == 0) {
                return Err(Error::Argument(format!(
                    "scale {scale:e} is no power of two, so vertices would be rounded: make the shape anew with that scale in its options"
                )));
            }
            in_integers(|| file::scaled(self, scale, progress))?
        })
    }

    /// The polyhedron that queries run on: P₀ of the levels of detail.
    #[inline]
    pub fn polyhedron(&self) -> &Polyhedron {
        &self.polyhedron
    }

    /// The radius of the ball that is swept over the polyhedron, in the local frame; see [`ShapeOptions::swept_radius`]. A pose
    /// does not stretch it.
    #[inline]
    pub fn swept_radius(&self) -> f64 {
        self.swept_radius
    }

    /// How far the curved body reaches beyond its polyhedron at most, wherever it is placed; 0 for all but cylinders, cones and
    /// ellipsoids.
    #[inline]
    pub fn deviation(&self) -> f64 {
        self.deviation
    }

    /// The hull of the corners of a box, as what surrounds something else that is no farther from its origin than `lever`: boxes
    /// and spheres around it hold, and nothing is known to be inside.
    ///
    /// # Errors
    /// [`Error::Argument`] for corners beyond 2¹⁰⁰⁰; [`Error::Memory`](crate::base::error::Error::Memory).
    pub(crate) fn surrounding([lower, upper]: &[Vector; 2], lever: f64) -> Result<Shape> {
        let end = |corner: usize, axis: usize| if corner >> axis & 1 == 1 { upper[axis] } else { lower[axis] };
        let corners = [0, 1, 2, 3, 4, 5, 6, 7].map(|corner| Vector::from_fn(|axis, _| end(corner, axis)));
        let options = ShapeOptions {
            input: InputPolicy::Hull,
            hierarchy: HierarchyOptions { kind: HierarchyKind::None, ..HierarchyOptions::default() },
            lookup: LookupOptions { kind: LookupKind::None, ..LookupOptions::default() },
            ..ShapeOptions::default()
        };
        let mut shape = Shape::from_points(&corners, &options)?;
        shape.extent.inner_radius = f64::NEG_INFINITY;
        shape.extent.lever = shape.extent.lever.min(lever);
        if shape.polyhedron.centre == Vector::zeros() {
            shape.polyhedron.radius = shape.polyhedron.radius.min(lever);
        }
        Ok(shape)
    }

    /// Refuses a curved body where its polyhedron would be taken for it.
    ///
    /// # Errors
    /// [`Error::Argument`], which names the cure.
    pub(crate) fn refuse_deviation(&self, what: &str) -> Result<()> {
        if self.deviation == 0.0 {
            return Ok(());
        }
        Err(Error::Argument(format!(
            "{what} take no cylinder, cone or ellipsoid, as they would take its polyhedron for it, which is up to {:e} smaller: make \
             a hull of the polyhedron's vertices (swiftprox_shape_copy_vertices, swiftprox_shape_create_from_points)",
            self.deviation
        )))
    }

    /// The inertia tensor of a body of mass 1 and of uniform density about its centre of mass, in the axes of the local frame:
    /// symmetric, in units of length squared. Times a body's mass, density times volume, it is the inertia of that body. For a
    /// shape without interior the mass is spread over its area or length. Each entry is within 1e-13 of the largest, unless the
    /// body is thinner than 1e-12 of its size. It takes time in proportion to the triangles.
    pub fn inertia(&self) -> Matrix {
        with_default(|| inertia(&self.polyhedron))
    }

    /// How far it reaches, wherever it is placed.
    #[inline]
    pub(crate) fn extent(&self) -> &Extent {
        &self.extent
    }

    /// The levels of detail that are made, without P₀.
    #[inline]
    pub fn hierarchy(&self) -> &Hierarchy {
        static NOT_MADE: Hierarchy = Hierarchy::AUTOMATIC;
        self.hierarchy.get().unwrap_or(&NOT_MADE)
    }

    /// Whether it would have automatic levels if they were made.
    #[inline]
    pub(crate) fn lacks_levels(&self) -> bool {
        self.hierarchy.get().is_none() & (self.polyhedron.vertices.len() >= LEAST_VERTICES_FOR_LEVELS)
    }

    /// Makes automatic levels if they are not made: the caller is to go through them. Other threads that need them meanwhile
    /// wait. Where memory is lacking there are none, and bodies answer themselves.
    #[inline]
    pub(crate) fn need_levels(&self) {
        if self.lacks_levels() {
            self.make_levels();
        }
    }

    #[cold]
    fn make_levels(&self) {
        self.hierarchy.make(|| or_none(self.build_levels(&mut Progress::new(&mut |_| true))));
    }

    fn build_levels(&self, progress: &mut Progress) -> Result<Hierarchy> {
        Hierarchy::build(&self.polyhedron, &HierarchyOptions::default(), progress)
    }

    /// Makes now, with progress reports, the data that the first query to need them would make: the look-up tables and maps of
    /// support functions, a small part of the work (of needles up to a third) which is not interrupted, the search for polygons
    /// on faces of many, and automatic levels. After that no query of this shape allocates or waits, except for the integer
    /// arithmetic.
    ///
    /// No thread waits for levels that may be cancelled: one that needs them meanwhile makes them, too, and the second result is
    /// dropped.
    ///
    /// # Errors
    /// [`Error::Cancelled`] when the caller does not want to go on, [`Error::Memory`]: no levels are made then, and the shape can
    /// be used as before.
    pub fn prepare(&self, progress: &mut Progress) -> Result<()> {
        with_default(|| self.make_ready(progress))
    }

    fn make_ready(&self, progress: &mut Progress) -> Result<()> {
        /// The table's share of the time that both take, about, at 100,000 and 200,000 vertices.
        const SHARE_OF_TABLE: f64 = 0.06;
        progress.report(0.0)?;
        insist_on_table(&self.polyhedron)?;
        self.polyhedron.insist_on_polygon_search()?;
        self.support_map.insist(&self.polyhedron)?;
        if self.lacks_levels() {
            progress.report(SHARE_OF_TABLE)?;
            let levels = match self.build_levels(&mut progress.part(SHARE_OF_TABLE, 1.0)) {
                Err(Error::Cancelled(message)) => return Err(Error::Cancelled(message)),
                built => or_none(built)?,
            };
            // Another thread may have been first.
            self.hierarchy.set(levels);
        } else {
            progress.report(1.0)?;
        }
        self.hierarchy().levels.iter().try_for_each(|level| insist_on_table(&level.polyhedron))
    }

    /// Memory held, in bytes; the look-up table and automatic levels are included once they are made.
    pub fn bytes(&self) -> usize {
        let made = self.hierarchy().heap_bytes() + self.support_map.heap_bytes();
        size_of::<Shape>() + self.extent.heap_bytes() + self.polyhedron.heap_bytes() + made
    }

    /// Refuses a polyhedron of a dimension that the policy does not admit; gives the others their levels.
    fn admitted(
        mut polyhedron: Polyhedron,
        noise: f64,
        options: &ShapeOptions,
        progress: &mut Progress,
    ) -> Result<Shape> {
        let least = match options.input {
            InputPolicy::Strict => 3,
            InputPolicy::Flat | InputPolicy::NearlyConvex => 2,
            InputPolicy::Hull | InputPolicy::Patch => 0,
        };
        if polyhedron.dimension < least {
            let what = ["all vertices are one point", "all vertices lie on a line", "all vertices lie in a plane"];
            let dimension = usize::from(polyhedron.dimension);
            let hint = [HULL_HINT, HULL_HINT, FLAT_HINT][dimension];
            return Err(Error::Mesh(format!("the body has no interior: {}; {hint}", what[dimension])));
        }
        let share = options.share_of_body();
        progress.report(share)?;
        polyhedron.lookup = plan_lookup(&polyhedron, &options.lookup)?;
        // Next to nothing of the time.
        let contact_faces = find_contact_faces(&polyhedron, noise, &mut progress.part(share, share))?;
        give_contact_faces(&mut polyhedron, contact_faces)?;
        Shape::from_parts(polyhedron, Hierarchy::AUTOMATIC, options.radius()?)?
            .with_levels(&options.hierarchy, &mut progress.part(share, 1.0))
    }
}

/// Automatic levels that were built: without them the bodies answer themselves.
///
/// # Errors
/// [`Error::Memory`].
fn or_none(built: Result<Hierarchy>) -> Result<Hierarchy> {
    debug_assert!(matches!(built, Ok(_) | Err(Error::Memory(_))), "{built:?}");
    Ok(found(built)?.unwrap_or(Hierarchy::AUTOMATIC))
}

/// An eighth of the diagonal of the bounding box, which cannot overflow where half of it might; 0 without points.
fn eighth_diagonal(points: &[Vector]) -> f64 {
    let corner = |pick: fn(f64, f64) -> f64| points.iter().copied().reduce(|a, b| a.zip_map(&b, pick));
    match (corner(f64::min), corner(f64::max)) {
        (Some(lower), Some(upper)) => {
            let eighth = 0.125 * upper - 0.125 * lower;
            length(&eighth)
        }
        _ => 0.0,
    }
}
