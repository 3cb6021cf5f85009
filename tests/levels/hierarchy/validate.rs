//! What holds for every hierarchy, however made.

use swiftprox::base::predicates::ExactPoints;
use swiftprox::body::build::assembly::build;
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::hierarchy::{Hierarchy, HierarchyKind, Level, Links};
use swiftprox::math::{Pose, Vector};
use swiftprox::placed::Pair;
use swiftprox::placed::exact;
use swiftprox::placed::state::FeatureId;

/// Panics with `name` unless all is well.
pub fn validate(name: &str, base: &Polyhedron, hierarchy: &Hierarchy) {
    let mut below = base;
    for (i, level) in hierarchy.levels.iter().enumerate() {
        let name = format!("{name}, {:?} level {}", hierarchy.kind, i + 1);
        let above = &level.polyhedron;
        assert_eq!((above.dimension, above.centre), (3, base.centre), "{name}");
        assert_eq!(above.simple, base.simple, "{name}");
        assert!(contains_by_brute_force(above, base), "{name} does not contain the body");
        check_deviation(&name, base, level);
        check_ranges(&name, above, below, &level.children);
        check_ranges(&name, below, above, &level.parents);
        if hierarchy.kind == HierarchyKind::DobkinKirkpatrick {
            check_rays(&name, base, above, below, &level.children);
        } else {
            check_children(&name, above, below, &level.children);
            check_parents(&name, below, above, &level.parents);
        }
        below = above;
    }
}

/// Every triangle against every vertex, by exact predicates.
pub fn contains_by_brute_force(outer: &Polyhedron, inner: &Polyhedron) -> bool {
    let mut points: Vec<Vector> = outer.vertices.iter().map(|v| v.position).collect();
    let first_inner = points.len() as u32;
    points.extend(inner.vertices.iter().map(|v| v.position));
    let exact = ExactPoints::new(&points).unwrap();
    outer.triangles.iter().all(|corners| {
        let plane = exact.plane(*corners);
        (first_inner..points.len() as u32).all(|v| exact.height(&plane, v) <= 0.0)
    })
}

/// The deviation is an upper bound of the exact distance of some vertices of the level, those that stand off most among them,
/// and tight.
fn check_deviation(name: &str, base: &Polyhedron, level: &Level) {
    let above = &level.polyhedron;
    let stands_off = |v: &u32| {
        let p = above.vertices[*v as usize].position;
        base.faces.iter().map(|face| face.planes.value(0, &p)).fold(0.0, f64::max)
    };
    let mut order: Vec<(f64, u32)> = (0..above.vertices.len() as u32).map(|v| (stands_off(&v), v)).collect();
    order.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut largest = 0.0_f64;
    let spread = (order.len() / 16).max(1);
    let chosen = order.iter().take(24).chain(order.iter().step_by(spread));
    for (_, v) in chosen {
        let point = build(&[above.local_position(*v)], None).unwrap();
        let answer = exact::solve(&Pair { polyhedra: [&point, base], poses: [&Pose::IDENTITY; 2] }, &[]);
        // Where the body is far from its origin the vertices of levels are no doubles in its frame.
        let rounding = if base.centre == Vector::zeros() { 0.0 } else { 2e-16 * base.centre.amax() };
        assert!(answer.lower <= level.deviation + rounding, "{name}: {:e} above {:e}", answer.lower, level.deviation);
        largest = largest.max(answer.upper);
    }
    assert!(level.deviation >= order[0].0 * (1.0 - 1e-12) - 1e-14 * base.radius, "{name}");
    if order.len() <= 24 && base.centre == Vector::zeros() {
        let excess = level.deviation - largest;
        assert!(excess <= 1e-13 * (base.radius + above.radius), "{name}: {:e} is {excess:e} too much", level.deviation);
    }
}

fn check_ranges(name: &str, from: &Polyhedron, to: &Polyhedron, links: &Links) {
    let counts = [links.vertices.len(), links.edges.len(), links.faces.len()];
    assert_eq!(counts, [from.vertices.len(), from.edges.len(), from.faces.len()], "{name}");
    for link in links.vertices.iter().chain(&links.edges).chain(&links.faces) {
        let (index, count) = match *link {
            FeatureId::Vertex(v) => (v, to.vertices.len()),
            FeatureId::Edge(e) => (e, to.edges.len()),
            FeatureId::Face(f) => (f, to.faces.len()),
        };
        assert!((index as usize) < count, "{name}: {link:?}");
    }
}

/// Children are near: the child of a vertex is at most as much farther than the nearest vertex as the triangles around it are
/// large.
fn check_children(name: &str, above: &Polyhedron, below: &Polyhedron, children: &Links) {
    let mut sizes = vec![0.0_f64; below.vertices.len()];
    for corners in &below.triangles {
        let [a, b, c] = corners.map(|v| below.vertices[v as usize].position);
        let size = (b - a).norm().max((c - b).norm()).max((a - c).norm());
        for &v in corners {
            sizes[v as usize] = sizes[v as usize].max(size);
        }
    }
    for (vertex, child) in above.vertices.iter().zip(&children.vertices) {
        let FeatureId::Vertex(child) = *child else { panic!("{name}: the child of a vertex is {child:?}") };
        let distance = |w: usize| (below.vertices[w].position - vertex.position).norm();
        let nearest = (0..below.vertices.len()).map(distance).fold(f64::INFINITY, f64::min);
        let child = child as usize;
        assert!(distance(child) <= (nearest + sizes[child]) * (1.0 + 1e-12), "{name}");
    }
    let vertices_of = |corners: &[u32]| corners.iter().map(|v| children.vertices[*v as usize]).collect::<Vec<_>>();
    if children.edges.iter().all(|child| matches!(child, FeatureId::Vertex(_))) {
        for (edge, child) in above.edges.iter().zip(&children.edges) {
            assert!(vertices_of(&[edge.tail(), edge.head()]).contains(child), "{name}");
        }
    }
}

/// Dobkin and Kirkpatrick's vertices move along rays from the centre of mass: the child of a vertex is on its ray (up to
/// rounding, and all but a few that rounding has put inside a face of the level below), what is kept has itself for a child.
fn check_rays(name: &str, base: &Polyhedron, above: &Polyhedron, below: &Polyhedron, children: &Links) {
    let centre = base.mass.centre_of_mass - base.centre;
    let mut aside = 0;
    for (vertex, child) in above.vertices.iter().zip(&children.vertices) {
        let FeatureId::Vertex(child) = *child else { panic!("{name}: the child of a vertex is {child:?}") };
        let [a, b] = [vertex.position, below.vertices[child as usize].position].map(|p| p - centre);
        let sine = a.cross(&b).norm() / (a.norm() * b.norm());
        aside += usize::from(!(sine <= 1e-9 && a.dot(&b) > 0.0));
    }
    assert!(aside <= above.vertices.len() / 20, "{name}: {aside} of {}", above.vertices.len());
    let mut kept = 0;
    for (edge, child) in above.edges.iter().zip(&children.edges) {
        if let FeatureId::Edge(child) = *child {
            let child = &below.edges[child as usize];
            let ends = [edge.tail(), edge.head()].map(|v| children.vertices[v as usize]);
            assert!(
                ends == [child.tail(), child.head()].map(FeatureId::Vertex)
                    || ends == [child.head(), child.tail()].map(FeatureId::Vertex),
                "{name}"
            );
            kept += 1;
        }
    }
    assert!(kept > 0, "{name}");
}

/// The parent of a face is extreme along its normal, that of an edge or a vertex that of a face around it.
fn check_parents(name: &str, below: &Polyhedron, above: &Polyhedron, parents: &Links) {
    for (face, parent) in below.faces.iter().zip(&parents.faces) {
        let FeatureId::Vertex(parent) = *parent else { panic!("{name}: the parent of a face is {parent:?}") };
        let height = |v: &swiftprox::body::polyhedron::Vertex| face.normal.dot(&v.position);
        let highest = above.vertices.iter().map(height).fold(f64::NEG_INFINITY, f64::max);
        assert!(height(&above.vertices[parent as usize]) >= highest - 1e-14 * above.radius, "{name}");
    }
    for (edge, parent) in below.edges.iter().zip(&parents.edges) {
        assert!([edge.left(), edge.right()].map(|f| parents.faces[f as usize]).contains(parent), "{name}");
    }
}
