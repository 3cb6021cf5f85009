//! Levels of detail: ever simpler convex polyhedra P₁ … P_k around a body P₀, each of which provably contains it, with how far it
//! stands off and which features of neighbouring levels belong together (Ehmann & Lin 2000, §3 and §4).
//!
//! The makers (quadric error simplification, Dobkin-Kirkpatrick, cutting planes) propose points; the code common to all is here.
//! A level is the *exact* hull of its points, laid out like P₀, so all that runs on a body runs on its levels.

mod links;
mod bounding;
mod correspondence;

use std::borrow::Cow;

use crate::base::enumerator::enumerator;
use crate::base::error::{Error, Result};
use crate::base::math::Vector;
use crate::base::memory::{collected, extend, in_integers, push, with_capacity};
use crate::base::progress::Progress;
use crate::base::simd::environment::with_default;
use crate::body::build::assembly::build;
use crate::body::mesh::check_vertex;
use crate::body::polyhedron::{LARGEST, Polyhedron, SMALLEST};
use crate::body::tables::plan_for_level;
use crate::placed::state::FeatureId;
use crate::shape::levels::containment::contains;
use crate::shape::levels::dobkin_kirkpatrick::{DobkinKirkpatrick, Removal};
use crate::shape::levels::outer_cuts::outer_cuts;
use crate::shape::levels::point_distance::PointDistance;
use crate::shape::levels::quadric::simplify;
use bounding::{Scaling, bounding, translated};
use correspondence::{Correspondence, by_identity, by_position};
pub use links::Links;

/// How the levels of a body are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[repr(i32)]
pub enum HierarchyKind {
    /// There are none.
    None = 0,
    /// Simplified by quadric error (Garland & Heckbert 1997), then translated and scaled until they contain the body.
    Quadric = 1,
    /// Dobkin and Kirkpatrick's, without sharp vertices, scaled about the centre of mass and drawn back vertex by vertex.
    DobkinKirkpatrick = 2,
    /// Cut out of a box by planes that touch the body: tight on thin bodies, too.
    OuterCuts = 3,
    /// The caller's, translated and scaled until they contain the body: those of a shape made from levels
    /// (swiftprox_shape_create_from_levels). No shape can build them.
    Given = 4,
    /// Quadric ones by the default options for bodies of 30,000 vertices and more, made by the first query that goes through them;
    /// none for smaller bodies.
    #[default]
    Automatic = 5,
}

enumerator!(HierarchyKind { None, Quadric, DobkinKirkpatrick, OuterCuts, Given, Automatic });

/// Fewest vertices of a body that is given levels on its own account: for two smaller ones no query takes the way through levels
/// where the choice is automatic.
pub const LEAST_VERTICES_FOR_LEVELS: usize = 30_000;

/// The levels to make.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HierarchyOptions {
    /// How.
    pub kind: HierarchyKind,
    /// The fraction of the triangles that a level has left of those of the next finer one, between 0 and 1, both exclusive; less
    /// where that many would have more features than faces of many corners have. Dobkin and Kirkpatrick's own way of building
    /// decides for theirs. This and the following members do not count for automatic levels.
    pub decimation: f64,
    /// No level has fewer triangles.
    pub minimum_triangles: usize,
    /// No more levels than these.
    pub most_levels: usize,
}

impl Default for HierarchyOptions {
    /// Automatic levels; for other kinds a quarter of the triangles from level to level, at least 50, at most 32 levels.
    fn default() -> Self {
        HierarchyOptions { kind: HierarchyKind::Automatic, decimation: 0.25, minimum_triangles: 50, most_levels: 32 }
    }
}

impl HierarchyOptions {
    /// # Errors
    /// [`Error::Argument`] for an option out of range, and for [`HierarchyKind::Given`].
    pub fn check(&self) -> Result<()> {
        if !(self.decimation > 0.0 && self.decimation < 1.0) {
            let message = format!("decimation is {:?}, it must be between 0 and 1, both exclusive", self.decimation);
            return Err(Error::Argument(message));
        }
        if self.kind == HierarchyKind::Given {
            return Err(Error::Argument(
                "levels of kind Given (SWIFTPROX_HIERARCHY_GIVEN) are not built: hand yours to Shape::from_levels \
                 (swiftprox_shape_create_from_levels)"
                    .into(),
            ));
        }
        Ok(())
    }
}

/// One level.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Contains P₀, exactly as the doubles of both give them. Its `centre` is that of P₀, its vertex labels mean nothing.
    pub polyhedron: Polyhedron,
    /// An upper bound, rounding included, of the largest distance of a point of this level from P₀, in P₀'s frame. A pose that
    /// is not quite orthonormal stretches it by at most ‖R‖₂.
    pub deviation: f64,
    /// The child of each feature of this level: a feature of the next finer one (P₀ for the finest level).
    pub children: Links,
    /// The parent of each feature of the next *finer* level: a feature of this one.
    pub parents: Links,
}

impl Level {
    /// Memory held, in bytes.
    pub fn bytes(&self) -> usize {
        let Level { polyhedron, deviation: _, children, parents } = self;
        size_of::<Level>() + polyhedron.heap_bytes() + children.heap_bytes() + parents.heap_bytes()
    }
}

/// The levels of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct Hierarchy {
    /// How they were made.
    pub kind: HierarchyKind,
    /// P₁ … P_k, the finest first. P₀ is not among them.
    pub levels: Vec<Level>,
}

impl Hierarchy {
    /// Automatic levels where none are made, or not yet.
    pub const AUTOMATIC: Hierarchy = Hierarchy { kind: HierarchyKind::Automatic, levels: Vec::new() };

    /// Builds levels, automatic ones at once. There are none for [`HierarchyKind::None`], for a body without interior, for one
    /// too small or too large (2^±200), and where each would be no simpler than the next finer one: a tetrahedron gets none, nor
    /// a box by the default options. Otherwise so many until one more would fall below the minimum of triangles, would have no
    /// interior, or be so thin that no rounding makes it contain P₀. Each has fewer vertices and fewer features than the next
    /// finer one.
    ///
    /// # Errors
    /// [`Error::Argument`] for options out of range, [`Error::Cancelled`], [`Error::Memory`].
    pub fn build(base: &Polyhedron, options: &HierarchyOptions, progress: &mut Progress) -> Result<Hierarchy> {
        in_integers(|| with_default(|| Hierarchy::built(base, options, progress)))?
    }

    fn built(base: &Polyhedron, options: &HierarchyOptions, progress: &mut Progress) -> Result<Hierarchy> {
        options.check()?;
        let centred = centred(base)?;
        let mut builder = Builder::new(&centred, options.kind)?;
        if base.dimension == 3 && builder.is_in_range() {
            match options.kind {
                HierarchyKind::None | HierarchyKind::Given => {}
                HierarchyKind::Automatic if base.vertices.len() < LEAST_VERTICES_FOR_LEVELS => {}
                HierarchyKind::Automatic => builder.add_quadric(&HierarchyOptions::default(), progress)?,
                HierarchyKind::Quadric => builder.add_quadric(options, progress)?,
                HierarchyKind::DobkinKirkpatrick => builder.add_dobkin_kirkpatrick(options, progress)?,
                HierarchyKind::OuterCuts => builder.add_outer_cuts(options, progress)?,
            }
        }
        progress.report(1.0)?;
        Ok(builder.finish(base))
    }

    /// Levels that the caller gives, the finest first: the convex hull of each one's points counts, in the frame of P₀. It is
    /// moved so that its centre of mass falls on that of the next finer level, and scaled about it so that it barely contains P₀.
    /// Its number of features is free.
    ///
    /// # Errors
    /// [`Error::Mesh`] for a coordinate that is not finite and a level without interior or so thin that no rounding makes it
    /// contain P₀, [`Error::Argument`] for a body too small or too large (2^±200), [`Error::Cancelled`], [`Error::Memory`].
    pub fn from_levels(base: &Polyhedron, levels: &[Vec<Vector>], progress: &mut Progress) -> Result<Hierarchy> {
        in_integers(|| with_default(|| Hierarchy::of_given(base, levels, progress)))?
    }

    fn of_given(base: &Polyhedron, levels: &[Vec<Vector>], progress: &mut Progress) -> Result<Hierarchy> {
        let centred = centred(base)?;
        let mut builder = Builder::new(&centred, HierarchyKind::Given)?;
        if !levels.is_empty() && !builder.is_in_range() {
            return Err(Error::Argument("levels need a body of a size between 2^-200 and 2^200".into()));
        }
        for (i, points) in levels.iter().enumerate() {
            let number = i + 1; // P₀ is the caller's level 0
            let done = |k: usize| k as f64 / levels.len() as f64;
            let mut part = progress.part(done(i), done(i + 1));
            part.report(0.0)?;
            if points.is_empty() {
                return Err(Error::Mesh(format!("level {number} has no vertices")));
            }
            for (v, point) in points.iter().enumerate() {
                check_vertex(v, point).map_err(|e| Error::Mesh(format!("level {number}: {e}")))?;
            }
            let points = translated(points, &-base.centre)?;
            let Some(level) = builder.in_general(&points, &mut part)? else {
                return Err(Error::Mesh(format!(
                    "level {number} has no interior, or too little to be made to bound the body"
                )));
            };
            builder.add(level, &mut part)?;
        }
        Ok(builder.finish(base))
    }

    /// From levels that were built before, the finest first: each polyhedron in the centred coordinates of `base`, with its
    /// children and parents. The facts that a query relies on are established anew: that every level contains the body, exactly,
    /// and how far it stands off.
    ///
    /// # Errors
    /// [`Error::Argument`] for a level that does not contain the body, or links out of range; [`Error::Cancelled`],
    /// [`Error::Memory`].
    pub fn restored(
        base: &Polyhedron,
        kind: HierarchyKind,
        levels: Vec<(Polyhedron, Links, Links)>,
        progress: &mut Progress,
    ) -> Result<Hierarchy> {
        let count = levels.len();
        let centred = centred(base)?;
        let mut builder = Builder::new(&centred, kind)?;
        for (i, (polyhedron, children, parents)) in levels.into_iter().enumerate() {
            progress.report(i as f64 / count as f64)?;
            let refused = |what: &str| Err(Error::Argument(format!("level {} {what}", i + 1)));
            if polyhedron.centre != centred.centre {
                return refused("is not in the frame of the body");
            }
            if !contains(&polyhedron, &centred)? {
                return refused("does not contain the body");
            }
            let below = builder.below();
            if !(children.lead(&polyhedron, below) && parents.lead(below, &polyhedron)) {
                return refused("has links to features that do not exist");
            }
            builder.add_linked(polyhedron, Correspondence { children, parents })?;
        }
        progress.report(1.0)?;
        Ok(builder.finish(base))
    }

    /// Memory held, in bytes.
    pub fn heap_bytes(&self) -> usize {
        self.levels.iter().map(Level::bytes).sum()
    }
}

/// A polyhedron in its own centred coordinates.
fn centred(polyhedron: &Polyhedron) -> Result<Cow<'_, Polyhedron>> {
    if polyhedron.centre == Vector::zeros() {
        return Ok(Cow::Borrowed(polyhedron));
    }
    let mut centred = polyhedron.copy()?;
    centred.move_frame(&-polyhedron.centre);
    centred.centre = Vector::zeros();
    Ok(Cow::Owned(centred))
}

/// Vertices, edges and faces.
fn feature_count(polyhedron: &Polyhedron) -> usize {
    polyhedron.vertices.len() + polyhedron.edges.len() + polyhedron.faces.len()
}

/// Levels under construction, all in the centred coordinates of P₀.
struct Builder<'a> {
    base: &'a Polyhedron,
    distance: PointDistance<'a>,
    hierarchy: Hierarchy,
    /// For each vertex of the coarsest level so far a vertex of P₀ near by.
    near: Vec<u32>,
}

impl<'a> Builder<'a> {
    fn new(base: &'a Polyhedron, kind: HierarchyKind) -> Result<Builder<'a>> {
        Ok(Builder {
            base,
            distance: PointDistance::new(base)?,
            hierarchy: Hierarchy { kind, levels: Vec::new() },
            near: collected(0..base.vertices.len() as u32)?,
        })
    }

    /// Whether planes and squares of this body neither over- nor underflow.
    fn is_in_range(&self) -> bool {
        (SMALLEST..=LARGEST).contains(&self.base.radius)
    }

    /// P_{i−1} for the next P_i.
    fn below(&self) -> &Polyhedron {
        self.hierarchy.levels.last().map_or(self.base, |level| &level.polyhedron)
    }

    /// Levels by quadric error simplification: each has a constant fraction of the triangles of the one below.
    fn add_quadric(&mut self, options: &HierarchyOptions, progress: &mut Progress) -> Result<()> {
        let mut remaining = 1.0; // of the work
        while self.hierarchy.levels.len() < options.most_levels {
            let below = self.below();
            // Simplification cuts faces of many corners into triangles, and t triangles have up to 3t + 2 features.
            let simpler = (feature_count(below) - 3) / 3;
            let target = simpler.min((below.triangles.len() as f64 * options.decimation) as usize);
            if target < options.minimum_triangles.max(4) {
                break;
            }
            let positions: Vec<Vector> = collected(below.vertices.iter().map(|v| v.position))?;
            let mut part = progress.part(1.0 - remaining, 1.0 - remaining * options.decimation);
            remaining *= options.decimation;
            let mut simplifying = part.part(0.0, 0.5);
            let points = simplify(&positions, &below.triangles, target, &mut simplifying)?.points;
            let mut adding = part.part(0.5, 1.0);
            match self.in_general(&points, &mut adding)? {
                Some(level) if self.is_simpler(&level) => self.add(level, &mut adding)?,
                _ => break,
            }
        }
        Ok(())
    }

    /// Levels by Dobkin and Kirkpatrick's construction.
    fn add_dobkin_kirkpatrick(&mut self, options: &HierarchyOptions, progress: &mut Progress) -> Result<()> {
        let mut removing = DobkinKirkpatrick::new(self.base)?;
        let count = self.base.vertices.len();
        let mut ids: Vec<u32> = collected(0..count as u32)?;
        // Every level costs about as much: the vertices of the body take part in all of them.
        let minimum = options.minimum_triangles.max(4);
        let levels_to = |left: usize| (left as f64 / minimum as f64).max(1.0).ln();
        let all = levels_to(self.base.triangles.len());
        let done = |left: usize| if all > 0.0 { 1.0 - levels_to(left) / all } else { 0.0 };
        // Since the last level.
        let mut all_filled = Vec::new();
        while self.hierarchy.levels.len() < options.most_levels {
            // The level takes at least a sixteenth away (or is the last), so progress does not fall.
            let left = removing.triangle_count();
            let mut part = progress.part(done(left), done(left - left / 16));
            let Some(Removal { vertices, points, filled }) = removing.next(minimum, &mut part)? else { break };
            let centre = self.base.mass.centre_of_mass;
            let Some(level) = bounding(&points, &centre, self.base, Scaling::WhereNeeded)? else { break };
            extend(&mut all_filled, filled)?;
            if !self.is_simpler(&level) {
                continue;
            }
            all_filled.sort_unstable();
            let id_of = |label: &u32| vertices[*label as usize];
            let ids_above: Vec<u32> = collected(level.vertex_labels.iter().map(id_of))?;
            let correspondence = by_identity([self.below(), &level], [&ids, &ids_above], &all_filled, count)?;
            self.add_linked(level, correspondence)?;
            ids = ids_above;
            all_filled.clear();
        }
        Ok(())
    }

    /// Levels cut out of a box: each has at most a constant fraction of the triangles of the one below.
    fn add_outer_cuts(&mut self, options: &HierarchyOptions, progress: &mut Progress) -> Result<()> {
        let fewer = |triangles: &f64| Some(triangles * options.decimation);
        let targets = std::iter::successors(fewer(&(self.base.triangles.len() as f64)), fewer)
            .map(|target| target as usize)
            .take_while(|&target| target >= options.minimum_triangles.max(4))
            .take(options.most_levels);
        // Three planes meet at every vertex: F planes make 2F − 4 vertices, and faces that are worth 4F − 12 triangles.
        let mut plane_counts: Vec<usize> = collected(targets.map(|target| (target + 12) / 4))?;
        plane_counts.reverse();
        let levels = outer_cuts(self.base, &plane_counts, &mut progress.part(0.0, 0.5))?;
        let mut part = progress.part(0.5, 1.0);
        let count = levels.len();
        for (i, level) in levels.into_iter().rev().enumerate() {
            let done = |k: usize| k as f64 / count as f64;
            if self.is_simpler(&level) {
                self.add(level, &mut part.part(done(i), done(i + 1)))?;
            }
        }
        Ok(())
    }

    /// The next level by the general scheme (Ehmann & Lin 2000, §4.3) from the points of a simplification. `None` if they cannot be
    /// made to bound the body.
    fn in_general(&self, points: &[Vector], progress: &mut Progress) -> Result<Option<Polyhedron>> {
        let hull = build(points, None)?;
        let centre = self.below().mass.centre_of_mass;
        let points: Vec<Vector> = collected((0..hull.vertices.len() as u32).map(|v| hull.local_position(v)))?;
        let points = translated(&points, &(centre - hull.mass.centre_of_mass))?;
        progress.report(0.25)?;
        bounding(&points, &centre, self.base, Scaling::Always)
    }

    /// Whether a level would be simpler than the next finer one: fewer features (Ehmann & Lin 2000, §3), and fewer vertices, too.
    fn is_simpler(&self, level: &Polyhedron) -> bool {
        let below = self.below();
        level.vertices.len() < below.vertices.len() && feature_count(level) < feature_count(below)
    }

    /// Adds a level that contains the body, linked by position.
    fn add(&mut self, polyhedron: Polyhedron, progress: &mut Progress) -> Result<()> {
        progress.report(0.5)?;
        let below = PointDistance::new(self.below())?;
        let correspondence = by_position(&below, &polyhedron)?;
        progress.report(0.75)?;
        self.add_linked(polyhedron, correspondence)?;
        progress.report(1.0)
    }

    /// Adds a level that contains the body.
    fn add_linked(&mut self, polyhedron: Polyhedron, correspondence: Correspondence) -> Result<()> {
        debug_assert_eq!(correspondence.children.vertices.len(), polyhedron.vertices.len());
        debug_assert_eq!(correspondence.parents.vertices.len(), self.below().vertices.len());
        let Correspondence { children, parents } = correspondence;
        let mut deviation = 0.0_f64;
        let mut near = with_capacity(polyhedron.vertices.len())?;
        for (vertex, child) in polyhedron.vertices.iter().zip(&children.vertices) {
            let hint = match *child {
                FeatureId::Vertex(v) => self.near[v as usize],
                _ => 0,
            };
            // The distance from a convex body is a convex function: over a polyhedron it is largest at a vertex.
            let nearest = self.distance.nearest(&vertex.position, hint);
            deviation = deviation.max(nearest.upper);
            near.push(nearest.vertex);
        }
        self.near = near;
        push(&mut self.hierarchy.levels, Level { polyhedron, deviation, children, parents })
    }

    /// The levels in the frame of `base`, and which tables they get.
    fn finish(self, base: &Polyhedron) -> Hierarchy {
        let mut hierarchy = self.hierarchy;
        for Level { polyhedron, .. } in &mut hierarchy.levels {
            if base.centre != Vector::zeros() {
                polyhedron.move_frame(&base.centre);
            }
            polyhedron.lookup = plan_for_level(polyhedron, base);
        }
        hierarchy
    }
}
