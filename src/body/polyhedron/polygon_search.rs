//! Which of many polygons on one face holds a point: a binary space partition of each face by lines along edges of its polygons
//! (Fuchs, Kedem & Naylor 1980). No polygon is cut: one that a line crosses reaches over it, and a point near by is looked for on
//! both sides. Caps of triangles, which have a diagonal that halves them, are searched in logarithmic time, and so are grids.

use std::ops::Range;

use crate::base::error::Result;
use crate::base::math::{UNIT_ROUNDOFF, Vector, moderate, moderate_unit};
use crate::base::memory::{OnNeed, collected, extend, filled, push};

/// No node, and no polygon.
const NONE: u32 = u32::MAX;

/// Faces of no more polygons are looked through.
pub const FEW_POLYGONS: usize = 8;

/// Polygons of a leaf.
const LEAF: usize = 4;

/// Each side of a line has a fifth of the polygons at least, so that depth is logarithmic.
const LEAST_SHARE: usize = 5;

/// More than the depth of 2³² polygons: log(2³² / 4) / log(5 / 4) is 94.
const DEPTH: usize = 96;

/// Edges of a sampled polygon that are tried as lines.
const MOST_EDGES: usize = 4;

/// The partitions of a body's faces, made by the first query that names a polygon of a face of many.
#[derive(Debug, Clone)]
pub struct PolygonSearch {
    /// The partitions, once made.
    pub made: OnNeed<Partitions>,
}

/// For one body they are the same, whether they are made yet or not.
impl PartialEq for PolygonSearch {
    fn eq(&self, _: &PolygonSearch) -> bool {
        true
    }
}

impl PolygonSearch {
    /// Not made yet.
    pub const fn new() -> PolygonSearch {
        PolygonSearch { made: OnNeed::new() }
    }

    /// Memory that it holds beyond its own size: none until it is made.
    pub fn heap_bytes(&self) -> usize {
        self.made.get().map_or(0, |Partitions { roots, nodes, order, .. }| {
            size_of_val(&roots[..]) + size_of_val(&nodes[..]) + size_of_val(&order[..])
        })
    }
}

/// Polygons by their corners: polygon k has `corners[starts[k]..starts[k + 1]]`.
#[derive(Clone, Copy)]
pub struct Polygons<'a> {
    /// See there.
    pub corners: &'a [Vector],
    /// See there.
    pub starts: &'a [u32],
    /// The body's radius.
    pub radius: f64,
}

/// Less than so much of the radius's square is a product of sides that may be rounding alone.
const SLIVER: f64 = 1e-12;

impl<'a> Polygons<'a> {
    /// The corners of polygon k.
    #[inline(always)]
    pub fn corners_of(self, k: u32) -> &'a [Vector] {
        &self.corners[self.starts[k as usize] as usize..self.starts[k as usize + 1] as usize]
    }

    /// Whether a point over the plane of polygon k is in its prism. The sides of a sliver say nothing, or the same of all points on
    /// its line: there the point is between the polygon's ends, too.
    pub fn holds(self, k: u32, normal: &Vector, point: &Vector) -> bool {
        let corners = self.corners_of(k);
        debug_assert!(corners.len() >= 3);
        if moderate_unit(self.radius) != 1.0 {
            return holds_at_any_size(corners, normal, point);
        }
        let Some(mut last) = corners.last() else { return false };
        let mut most = 0.0;
        let is_inside_sides = corners.iter().all(|corner| {
            let inside = normal.cross(&(corner - last)).dot(&(point - last));
            last = corner;
            most = if inside > most { inside } else { most };
            inside >= 0.0
        });
        is_inside_sides && (most > SLIVER * self.radius * self.radius || is_between_ends(corners, point))
    }

    /// How far a polygon reaches along a direction, from where.
    fn extent(self, k: u32, direction: &Vector) -> [f64; 2] {
        let heights = self.corners_of(k).iter().map(|corner| direction.dot(corner));
        heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], height| [least.min(height), most.max(height)])
    }
}

/// A partition of each face of many polygons.
#[derive(Debug, Clone)]
pub struct Partitions {
    /// The root for each face, or [`NONE`] where its polygons are few.
    roots: Vec<u32>,
    nodes: Vec<SearchNode>,
    /// The numbers k of `face_labels`, leaf by leaf.
    order: Vec<u32>,
    /// A bound of the rounding error of a height.
    margin: f64,
}

/// A line across some polygons of a face, or a leaf.
#[derive(Debug, Clone, Copy)]
struct SearchNode {
    /// The line's unit normal in the plane of the face.
    normal: Vector,
    /// How far polygons on the near side reach along the normal, and where those on the far side, `next`, begin.
    reaches: [f64; 2],
    /// The far side; the near side is the next node. [`NONE`] of a leaf.
    next: u32,
    /// A leaf's polygons.
    first: u32,
    count: u32,
}

impl Partitions {
    /// From the polygons on each face, as a range of their numbers, and its unit normal; all within `radius` of the origin.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn new(
        polygons: Polygons,
        faces: impl Iterator<Item = (Range<u32>, Vector)>,
        radius: f64,
    ) -> Result<Partitions> {
        debug_assert!(radius >= 0.0);
        let margin = 64.0 * UNIT_ROUNDOFF * radius;
        let mut partitions = Partitions { roots: Vec::new(), nodes: Vec::new(), order: Vec::new(), margin };
        for (range, normal) in faces {
            let is_divided = range.len() > FEW_POLYGONS;
            push(&mut partitions.roots, if is_divided { partitions.nodes.len() as u32 } else { NONE })?;
            if is_divided {
                let first = partitions.order.len();
                extend(&mut partitions.order, range.clone())?;
                let mut face = FaceToDivide::new(polygons, range, normal, margin)?;
                partitions.divide(&mut face, first, partitions.order.len())?;
            }
        }
        Ok(partitions)
    }

    /// Adds the partition of a range of `order`.
    fn divide(&mut self, face: &mut FaceToDivide, first: usize, end: usize) -> Result<()> {
        debug_assert!(first < end && end <= self.order.len());
        let node = self.nodes.len();
        let (normal, count) = (Vector::zeros(), (end - first) as u32);
        push(&mut self.nodes, SearchNode { normal, reaches: [0.0; 2], next: NONE, first: first as u32, count })?;
        if end - first <= LEAF {
            return Ok(());
        }
        let line = face.best_line(&mut self.order[first..end]);
        let middle = first + face.order_by(&line, &mut self.order[first..end]);
        let extent = |k: &u32| face.polygons.extent(*k, &line.normal);
        let near = self.order[first..middle].iter().map(|k| extent(k)[1]).fold(f64::NEG_INFINITY, f64::max);
        let far = self.order[middle..end].iter().map(|k| extent(k)[0]).fold(f64::INFINITY, f64::min);
        self.nodes[node].normal = line.normal;
        self.nodes[node].reaches = [near + self.margin, far - self.margin];
        self.divide(face, first, middle)?;
        self.nodes[node].next = self.nodes.len() as u32;
        self.divide(face, middle, end)
    }

    /// The first of a divided face's polygons that holds a point. None where rounding puts the point in none of them.
    pub fn find(&self, polygons: Polygons, face: u32, normal: &Vector, point: &Vector) -> Option<u32> {
        let mut found = NONE;
        self.for_each_leaf(face, point, |leaf| {
            for &k in leaf {
                if k < found && polygons.holds(k, normal, point) {
                    found = k;
                }
            }
        });
        (found != NONE).then_some(found)
    }

    /// The leaves whose polygons may hold a point of a divided face.
    #[inline(always)]
    pub fn for_each_leaf(&self, face: u32, point: &Vector, mut visit: impl FnMut(&[u32])) {
        // At each node at most one side waits while the other is looked at.
        let mut waiting = [0; DEPTH];
        waiting[0] = self.roots[face as usize];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let index = waiting[count];
            let Some(node) = self.nodes.get(index as usize) else { continue };
            if node.next == NONE {
                visit(&self.order[node.first as usize..(node.first + node.count) as usize]);
                continue;
            }
            let height = node.normal.dot(point);
            if height >= node.reaches[1] {
                waiting[count] = node.next;
                count += 1;
            }
            if height <= node.reaches[0] {
                waiting[count] = index + 1;
                count += 1;
            }
        }
    }
}

/// [`Polygons::holds`] where products of lengths may be no doubles.
#[cold]
#[inline(never)]
fn holds_at_any_size(corners: &[Vector], normal: &Vector, point: &Vector) -> bool {
    let along = |i: usize| moderate(&(corners[(i + 1) % corners.len()] - corners[i]));
    let is_inside = |i: usize| normal.cross(&along(i)).dot(&moderate(&(point - corners[i]))) >= 0.0;
    (0..corners.len()).all(is_inside) && is_between_ends(corners, point)
}

/// Whether a point is between the ends of a polygon along its longest side, up to some roundings of coordinates.
#[cold]
#[inline(never)]
fn is_between_ends(corners: &[Vector], point: &Vector) -> bool {
    let side = |i: usize| corners[(i + 1) % corners.len()] - corners[i];
    let longer = |a: Vector, b: Vector| if b.amax() > a.amax() { b } else { a };
    let along = (0..corners.len()).map(side).fold(Vector::zeros(), longer);
    // Divided first, for bodies of any size.
    let along = along / along.amax();
    let at = |v: &Vector| (v - corners[0]).dot(&along);
    let (low, high) = corners.iter().map(at).fold((0.0_f64, 0.0_f64), |(low, high), at| (low.min(at), high.max(at)));
    let rounding = 16.0 * UNIT_ROUNDOFF * (corners[0].amax() + point.amax());
    (low - rounding..=high + rounding).contains(&at(point))
}

/// A line in the plane of a face: points p with normal·p = offset.
#[derive(Clone, Copy)]
struct SearchLine {
    normal: Vector,
    offset: f64,
}

/// A face while it is divided.
struct FaceToDivide<'a> {
    polygons: Polygons<'a>,
    normal: Vector,
    margin: f64,
    /// The number of its first polygon.
    first: u32,
    /// The means of its polygons' corners.
    middles: Vec<Vector>,
    /// Polygons on the far side of a line, while they are ordered.
    far: Vec<u32>,
}

impl<'a> FaceToDivide<'a> {
    fn new(polygons: Polygons<'a>, range: Range<u32>, normal: Vector, margin: f64) -> Result<FaceToDivide<'a>> {
        debug_assert!(margin >= 0.0);
        let middle = |k: u32| {
            let corners = polygons.corners_of(k);
            corners.iter().sum::<Vector>() / corners.len() as f64
        };
        let (first, far) = (range.start, filled(0, range.len())?);
        Ok(FaceToDivide { polygons, normal, margin, first, middles: collected(range.map(middle))?, far })
    }

    fn middle(&self, k: u32) -> &Vector {
        &self.middles[(k - self.first) as usize]
    }

    fn is_near(&self, k: u32, line: &SearchLine) -> bool {
        line.normal.dot(self.middle(k)) < line.offset
    }

    /// The line that leaves the fewest polygons to look at, among lines along edges of three of them. Where all leave too many on
    /// one side, the polygons are halved across the direction in which they spread most.
    fn best_line(&self, range: &mut [u32]) -> SearchLine {
        debug_assert!(range.len() > LEAF);
        let mut best = (range.len() - range.len() / LEAST_SHARE + 1, None);
        for part in [2, 1, 3] {
            let corners = self.polygons.corners_of(range[part * range.len() / 4]);
            for (i, corner) in corners.iter().enumerate().take(MOST_EDGES) {
                let across = self.normal.cross(&(corners[(i + 1) % corners.len()] - corner));
                let length = across.norm();
                if length > 0.0 {
                    let line = SearchLine { normal: across / length, offset: across.dot(corner) / length };
                    let left = self.most_left(&line, range);
                    if left < best.0 {
                        best = (left, Some(line));
                    }
                }
            }
        }
        best.1.unwrap_or_else(|| self.halving_line(range))
    }

    /// How many polygons are on one side of a line or reach over it, at most; all where a side has too few.
    fn most_left(&self, line: &SearchLine, range: &[u32]) -> usize {
        let (mut near, mut crossing) = (0, 0);
        for &k in range {
            let [least, most] = self.polygons.extent(k, &line.normal);
            near += usize::from(self.is_near(k, line));
            crossing += usize::from(least < line.offset - self.margin && most > line.offset + self.margin);
        }
        let least = near.min(range.len() - near);
        if least * LEAST_SHARE < range.len() { range.len() } else { range.len() - least + crossing }
    }

    fn halving_line(&self, range: &mut [u32]) -> SearchLine {
        let (mut low, mut high) = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
        for &k in &*range {
            (low, high) = (low.inf(self.middle(k)), high.sup(self.middle(k)));
        }
        let axis = (high - low).imax();
        let height = |k: u32| self.middle(k)[axis];
        let (_, &mut half, _) = range.select_nth_unstable_by(range.len() / 2, |a, b| height(*a).total_cmp(&height(*b)));
        SearchLine { normal: Vector::ith(axis, 1.0), offset: height(half) }
    }

    /// Puts the polygons on the near side first, in the order that they had: a fan's are in order around its hub. Gives their
    /// number, or half of all where one side has too few.
    fn order_by(&mut self, line: &SearchLine, range: &mut [u32]) -> usize {
        let (mut near, mut far) = (0, 0);
        for i in 0..range.len() {
            let k = range[i];
            if self.is_near(k, line) {
                range[near] = k;
                near += 1;
            } else {
                self.far[far] = k;
                far += 1;
            }
        }
        range[near..].copy_from_slice(&self.far[..far]);
        let least = near.min(far);
        if least * LEAST_SHARE < range.len() { range.len() / 2 } else { near }
    }
}
