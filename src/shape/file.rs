//! Shapes in files: saved once, loaded as they were, levels of detail included; data made on first need are made again.
//!
//! A file begins with eight bytes that say what it is and a version; it ends with a checksum of all before. In between are
//! numbers, little-endian: data that are not the same on every run (the hull's triangulation, labels, links between levels), take
//! long to find (the levels' vertices) or are the caller's choice (the noise of coordinates). A checksum finds damage, not
//! intent, so nothing that an answer's certainty rests on is believed: the hulls are proved anew with exact predicates, planes
//! and their slack computed, each level shown to contain the body and measured. A file of any content gives a sound shape or an
//! error.

use std::path::Path;

use crate::base::binary::{EMPTY_CHECKSUM, Reader, Writer, checksum};
use crate::base::enumerator::Enumerator;
use crate::base::error::{Error, Result};
use crate::base::files::{read_whole, write_whole};
use crate::base::math::Vector;
use crate::base::memory::{collected, copied, in_integers, push};
use crate::base::progress::Progress;
use crate::base::simd::environment::with_default;
use crate::body::build::assembly::{Labels, build_in_steps};
use crate::body::build::check::check_hull_in_steps;
use crate::body::build::contact_faces::find_contact_faces;
use crate::body::build::hull::{Hull, convex_hull_in_steps};
use crate::body::build::outlines::give_contact_faces;
use crate::body::polyhedron::Polyhedron;
use crate::body::polyhedron::lookup::Plan;
use crate::body::tables::{LookupKind, LookupOptions, plan_lookup};
use crate::placed::state::FeatureId;
use crate::shape::levels::hierarchy::{Hierarchy, HierarchyKind, Links};
use crate::shape::{LARGEST_SWEPT_RADIUS, Shape};

/// The first bytes of a shape file. The last one keeps it from passing for text.
const MAGIC: [u8; 8] = *b"SWFTPRX\x1a";

/// The name of a shape file in messages.
const WHAT: &str = "the shape file";

/// The version that is written.
const VERSION: u32 = 4;

/// Versions that are read, too: they have no swept radius, and no deviation.
const VERSION_WITHOUT_RADIUS: u32 = 2;
const VERSION_WITHOUT_DEVIATION: u32 = 3;

/// Saves a shape in a file, replacing any file there.
///
/// # Errors
/// [`Error::File`] if the file cannot be written or is no regular one; the message names it and says why. [`Error::Memory`]: the
/// file is as it was.
pub fn save(shape: &Shape, path: &Path) -> Result<()> {
    write_whole(path, &to_bytes(shape)?)
}

/// Loads a shape that was [saved](save).
///
/// # Errors
/// [`Error::File`] if the file cannot be read, is no regular file, is larger than
/// [`MOST_FILE_BYTES`](crate::base::files::MOST_FILE_BYTES), is no shape file, is of another version or damaged; the message names
/// it and says what is wrong. [`Error::Memory`].
pub fn load(path: &Path) -> Result<Shape> {
    load_in_steps(path, &mut Progress::new(&mut |_| true))
}

/// Same as [`load`], with progress reports.
///
/// # Errors
/// Same as [`load`]; [`Error::Cancelled`] when the caller does not want to go on.
pub fn load_in_steps(path: &Path, progress: &mut Progress) -> Result<Shape> {
    let bytes = read_whole(path, &path.display().to_string())?;
    from_bytes_in_steps(&bytes, progress).map_err(|error| match error {
        Error::Cancelled(_) | Error::Memory(_) => error,
        _ => Error::File(format!("{}: {}", path.display(), error.message())),
    })
}

/// The bytes that [`save`] writes.
///
/// # Errors
/// [`Error::Memory`].
pub fn to_bytes(shape: &Shape) -> Result<Vec<u8>> {
    // Automatic levels are made anew, whether they are made here or not.
    write(shape, 1.0, shape.hierarchy().kind != HierarchyKind::Automatic)
}

/// A shape with every length multiplied by a power of two, as if it had been saved and loaded: proved and measured anew, and its
/// levels, too, the automatic ones if they are made.
///
/// # Errors
/// The faults of the scaled shape; [`Error::Memory`], [`Error::Cancelled`].
pub(super) fn scaled(shape: &Shape, power_of_two: f64, progress: &mut Progress) -> Result<Shape> {
    read(&write(shape, power_of_two, true)?, true, progress)
}

fn write(shape: &Shape, scale: f64, with_levels: bool) -> Result<Vec<u8>> {
    let mut writer = Writer::default();
    writer.raw(MAGIC)?;
    writer.number(VERSION)?;
    let (polyhedron, hierarchy) = (shape.polyhedron(), shape.hierarchy());
    writer.polyhedron(polyhedron, scale)?;
    let (kind, resolution, factor) = match polyhedron.lookup.plan {
        Plan::None => (LookupKind::None, 0, LookupOptions::DEFAULT.radius_factor),
        Plan::AllVertices { .. } => (LookupKind::Automatic, 0, LookupOptions::DEFAULT.radius_factor),
        Plan::Shells { resolution } => (LookupKind::Shells, resolution, LookupOptions::DEFAULT.radius_factor),
        Plan::Spherical { resolution, radius_factor } => (LookupKind::Spherical, resolution, radius_factor),
    };
    writer.number(kind as u32)?;
    writer.number(resolution as u32)?;
    writer.real(factor)?;
    writer.real(polyhedron.contact_faces.noise * scale)?;
    writer.real(at_scale(shape.swept_radius(), scale)?)?;
    writer.real(at_scale(shape.deviation(), scale)?)?;
    writer.number(hierarchy.kind as u32)?;
    let levels = if with_levels { &hierarchy.levels[..] } else { &[] };
    writer.number(levels.len() as u32)?;
    for level in levels {
        writer.polyhedron(&level.polyhedron, scale)?;
        writer.links(&level.children)?;
        writer.links(&level.parents)?;
    }
    let sum = checksum(EMPTY_CHECKSUM, &writer.bytes);
    writer.raw(sum.to_le_bytes())?;
    Ok(writer.bytes)
}

/// The shape that [`load`] reads from a file's bytes.
///
/// # Errors
/// [`Error::File`] if they are no shape, of another version or damaged; [`Error::Memory`].
pub fn from_bytes(bytes: &[u8]) -> Result<Shape> {
    from_bytes_in_steps(bytes, &mut Progress::new(&mut |_| true))
}

/// Same as [`from_bytes`], with progress reports.
///
/// # Errors
/// Same as [`from_bytes`]; [`Error::Cancelled`] when the caller does not want to go on.
pub fn from_bytes_in_steps(bytes: &[u8], progress: &mut Progress) -> Result<Shape> {
    in_integers(|| with_default(|| read(bytes, false, progress)))?
}

fn read(bytes: &[u8], admits_automatic_levels: bool, progress: &mut Progress) -> Result<Shape> {
    /// The share of the time that reading and proving the bodies takes: 0.95 without levels, 0.65 with 32, and this with five.
    const SHARE_OF_BODIES: f64 = 0.8;
    progress.report(0.0)?;
    let mut bodies = progress.part(0.0, SHARE_OF_BODIES);
    let mut reader = Reader::new(WHAT, bytes);
    if reader.take(8).ok() != Some(&MAGIC[..]) {
        return Err(Error::File("this is no shape file".into()));
    }
    let version = reader.number()?;
    if !(VERSION_WITHOUT_RADIUS..=VERSION).contains(&version) {
        return Err(Error::File(format!(
            "a shape file of version {version}; this library reads versions {VERSION_WITHOUT_RADIUS} to {VERSION}"
        )));
    }
    let Some((content, sum)) = bytes.split_last_chunk::<8>() else {
        return damaged("it is cut off");
    };
    if checksum(EMPTY_CHECKSUM, content) != u64::from_le_bytes(*sum) {
        return damaged("its checksum is wrong");
    }
    reader.rest = content.get(12..).unwrap_or_default();
    let mut polyhedron = reader.polyhedron(None, &mut bodies)?;
    let kind = reader.number()?;
    let Some(kind) = read_kind(kind) else {
        return damaged("an unknown kind of look-up table");
    };
    let lookup = LookupOptions { kind, resolution: reader.number()?, radius_factor: reader.real()? };
    polyhedron.lookup = sound(plan_lookup(&polyhedron, &lookup))?;
    let noise = reader.real()?;
    if !(0.0..=f64::MAX).contains(&noise) {
        return damaged("the noise of coordinates is no length");
    }
    let swept_radius = if version == VERSION_WITHOUT_RADIUS { 0.0 } else { reader.real()? };
    if !(0.0..=LARGEST_SWEPT_RADIUS).contains(&swept_radius) {
        return damaged("the swept radius is no length");
    }
    let deviation = if version <= VERSION_WITHOUT_DEVIATION { 0.0 } else { reader.real()? };
    if !(0.0..=LARGEST_SWEPT_RADIUS).contains(&deviation) {
        return damaged("the deviation is no length");
    }
    let contact_faces = find_contact_faces(&polyhedron, noise, &mut bodies.part(reader.done(), reader.done()))?;
    give_contact_faces(&mut polyhedron, contact_faces)?;
    let kind = reader.number()?;
    let Some(kind) = read_kind(kind) else {
        return damaged("an unknown kind of levels");
    };
    let count = reader.number()?;
    let may_have_levels = match kind {
        HierarchyKind::None => false,
        HierarchyKind::Automatic => admits_automatic_levels,
        _ => true,
    };
    if count > 0 && !may_have_levels {
        return damaged("levels where none are saved");
    }
    let mut levels = Vec::new();
    for _ in 0..count {
        let level = (reader.polyhedron(Some(polyhedron.centre), &mut bodies)?, reader.links()?, reader.links()?);
        push(&mut levels, level)?;
    }
    if !reader.rest.is_empty() {
        return damaged("there is more behind its end");
    }
    let hierarchy = sound(Hierarchy::restored(&polyhedron, kind, levels, &mut progress.part(SHARE_OF_BODIES, 1.0)))?;
    Ok(Shape::from_parts(polyhedron, hierarchy, swept_radius)?.with_deviation(deviation))
}

fn read_kind<T: Enumerator>(number: u32) -> Option<T> {
    T::from_number(i32::try_from(number).ok()?)
}

fn damaged<T>(what: &str) -> Result<T> {
    Err(Error::File(format!("{WHAT} is damaged: {what}")))
}

/// Any fault of the data read is damage; a cancelled load is not, nor is a lack of memory.
fn sound<T>(result: Result<T>) -> Result<T> {
    result.or_else(|error| match error {
        Error::Cancelled(_) | Error::Memory(_) => Err(error),
        _ => damaged(error.message()),
    })
}

/// A length at another scale, exactly.
fn at_scale(length: f64, scale: f64) -> Result<f64> {
    let scaled = length * scale;
    if scaled / scale == length {
        return Ok(scaled);
    }
    Err(Error::Argument(format!("at scale {scale:e} the coordinate {length:e} leaves the range of doubles")))
}

impl Writer {
    fn vectors(&mut self, mut list: impl ExactSizeIterator<Item = Vector>, scale: f64) -> Result<()> {
        self.number(list.len() as u32)?;
        list.try_for_each(|v| v.iter().try_for_each(|x| self.real(at_scale(*x, scale)?)))
    }

    /// Centre and centred coordinates, so that a level, whose sums are not exact, comes back as it was.
    fn polyhedron(&mut self, polyhedron: &Polyhedron, scale: f64) -> Result<()> {
        self.number(u32::from(polyhedron.dimension))?;
        polyhedron.centre.iter().try_for_each(|x| self.real(at_scale(*x, scale)?))?;
        self.vectors(polyhedron.vertices.iter().map(|v| v.position), scale)?;
        self.numbers(polyhedron.triangles.as_flattened())?;
        // The labels, as `Labels` has them.
        self.numbers(&polyhedron.vertex_labels)?;
        self.numbers(&polyhedron.face_labels)?;
        self.numbers(&polyhedron.face_label_starts)?;
        self.vectors(polyhedron.polygon_corners.iter().copied(), scale)?;
        self.numbers(&polyhedron.polygon_starts)
    }

    fn links(&mut self, links: &Links) -> Result<()> {
        for list in [&links.vertices, &links.edges, &links.faces] {
            self.number(list.len() as u32)?;
            for feature in list {
                let (kind, index) = match *feature {
                    FeatureId::Vertex(v) => (0, v),
                    FeatureId::Edge(e) => (1, e),
                    FeatureId::Face(f) => (2, f),
                };
                self.raw([kind])?;
                self.number(index)?;
            }
        }
        Ok(())
    }
}

impl<'a> Reader<'a> {
    fn vector(&mut self) -> Result<Vector> {
        let vector = Vector::new(self.real()?, self.real()?, self.real()?);
        if vector.iter().all(|x| x.is_finite()) { Ok(vector) } else { damaged("a coordinate is not finite") }
    }

    /// A polyhedron in a frame of its own, or a level in the centred coordinates of a body whose centre is given. It takes the part
    /// of `progress` that its bytes are of the file.
    fn polyhedron(&mut self, body: Option<Vector>, progress: &mut Progress) -> Result<Polyhedron> {
        /// The share of a body's time that proving its hull takes, about; laying it out takes the rest.
        const SHARE_OF_PROOF: f64 = 0.15;
        let start = self.done();
        let dimension = self.number()?;
        let centre = self.vector()?;
        let positions = self.list(24, Reader::vector)?;
        let corners = self.numbers()?;
        let (triangles, []) = corners.as_chunks::<3>() else {
            return damaged("a triangle is incomplete");
        };
        let labels = Labels {
            vertex_labels: self.numbers()?,
            face_labels: self.numbers()?,
            face_label_starts: self.numbers()?,
            polygon_corners: self.list(24, Reader::vector)?,
            polygon_starts: self.numbers()?,
        };
        let mut progress = progress.part(start, self.done());
        progress.report(0.0)?;
        // The stored vertices of a body are exact sums; those of a level are not, and its hull is that of its centred
        // coordinates.
        let points = match body {
            None => collected(positions.iter().map(|p| p + centre))?,
            Some(_) => copied(&positions)?,
        };
        let hull = match dimension {
            3 => {
                let vertices = collected(0..positions.len() as u32)?;
                let hull = Hull { dimension: 3, vertices, triangles: copied(triangles)? };
                sound(check_hull_in_steps(&points, &hull, &mut progress.part(0.0, SHARE_OF_PROOF)))?;
                hull
            }
            // The triangulation of a flat hull is known.
            _ => sound(convex_hull_in_steps(&points, &mut progress.part(0.0, SHARE_OF_PROOF)))?,
        };
        if u32::from(hull.dimension) != dimension || hull.vertices.len() != positions.len() {
            return damaged("the vertices are not those of a hull");
        }
        progress.report(SHARE_OF_PROOF)?;
        let mut polyhedron = sound(build_in_steps(&points, hull, None, None, &mut progress.part(SHARE_OF_PROOF, 1.0)))?;
        let expected = if body.is_some() { Vector::zeros() } else { centre };
        let is_same = polyhedron.vertices.iter().zip(&positions).all(|(vertex, p)| vertex.position == *p);
        if !(is_same && polyhedron.centre == expected && body.is_none_or(|body| body == centre)) {
            return damaged("vertices are not in the order or the frame in which they are saved");
        }
        if !labels.give_to(&mut polyhedron)? {
            return damaged("labels that do not fit");
        }
        progress.report(1.0)?;
        Ok(polyhedron)
    }

    fn links(&mut self) -> Result<Links> {
        let feature = |reader: &mut Reader<'a>| {
            let kind = reader.take(1)?[0];
            let index = reader.number()?;
            match kind {
                0 => Ok(FeatureId::Vertex(index)),
                1 => Ok(FeatureId::Edge(index)),
                2 => Ok(FeatureId::Face(index)),
                _ => damaged("an unknown kind of feature"),
            }
        };
        Ok(Links { vertices: self.list(5, feature)?, edges: self.list(5, feature)?, faces: self.list(5, feature)? })
    }
}
