//! Checks every documented invariant of a polyhedron.

use std::collections::HashMap;

use dashu_ratio::RBig;
use swiftprox::body::polyhedron::{Edge, MergedFace, NONE, PlaneBlock, Polyhedron};
use swiftprox::math::Vector;

use testkit::random::Random;

const UNIT_ROUNDOFF: f64 = f64::EPSILON / 2.0;

/// Panics at the first invariant that does not hold for the hull of `points`.
pub fn validate(points: &[Vector], p: &Polyhedron) {
    vertices(points, p);
    neighbours(p);
    supports(p);
    if p.dimension >= 2 {
        edges(p);
        faces(p);
        topology(p);
        slacks(p);
    } else {
        assert!(p.edges.len() == usize::from(p.dimension == 1) && p.faces.is_empty() && p.triangles.is_empty());
    }
    mass(p);
}

fn normal(block: &PlaneBlock, lane: usize) -> Vector {
    Vector::new(block.x[lane], block.y[lane], block.z[lane])
}

fn value(block: &PlaneBlock, lane: usize, at: &Vector) -> f64 {
    normal(block, lane).dot(at) + block.offset[lane]
}

fn is_unit(v: &Vector) -> bool {
    (v.norm() - 1.0).abs() <= 4.0 * f64::EPSILON
}

fn vertices(points: &[Vector], p: &Polyhedron) {
    assert_eq!(p.vertex_labels.len(), p.vertices.len());
    let mut first = HashMap::new();
    for (i, point) in points.iter().enumerate() {
        first.entry(point.map(|x| (x + 0.0).to_bits())).or_insert(i as u32);
    }
    for (v, vertex) in p.vertices.iter().enumerate() {
        let label = p.vertex_labels[v];
        let point = points[label as usize];
        assert_eq!(p.local_position(v as u32), point, "centring is exact");
        assert_eq!(vertex.position - (point - p.centre), Vector::zeros());
        assert_eq!(first[&point.map(|x| (x + 0.0).to_bits())], label, "the label is the first duplicate");
        assert!(vertex.position.norm() <= p.radius);
    }
    assert!(p.radius <= p.vertices.iter().map(|v| v.position.norm()).fold(0.0, f64::max) * (1.0 + 1e-14));
}

fn neighbours(p: &Polyhedron) {
    let mut expected: Vec<Vec<u32>> = vec![Vec::new(); p.vertices.len()];
    for t in &p.triangles {
        for k in 0..3 {
            expected[t[k] as usize].push(t[(k + 1) % 3]);
        }
    }
    if p.dimension == 1 {
        expected = vec![vec![1], vec![0]];
    } else if p.dimension == 0 {
        expected = vec![vec![0]];
    }
    for (v, list) in expected.iter_mut().enumerate() {
        list.sort_unstable();
        list.dedup();
        let vertex = &p.vertices[v];
        assert_eq!(vertex.more as usize, list.len().div_ceil(8) - 1);
        let mut found = Vec::new();
        let mut edges_over = false;
        for (b, block) in p.neighbour_blocks(v as u32).enumerate() {
            for lane in 0..8 {
                let (head, edge) = (block.head[lane], block.edge[lane]);
                let rough = [block.x[lane], block.y[lane], block.z[lane]];
                let direction = p.direction_to(v as u32, head);
                if 8 * b + lane < list.len() {
                    found.push(head);
                    assert!(!(edges_over && edge != NONE), "edges come first");
                    edges_over = edge == NONE;
                } else {
                    assert_eq!((head, edge), (block.head[0], block.edge[0]));
                    assert_eq!(rough, [block.x[0], block.y[0], block.z[0]]);
                }
                if p.dimension == 0 {
                    assert_eq!(direction, Vector::zeros());
                    continue;
                }
                assert!(is_unit(&direction));
                let difference = p.vertices[head as usize].position - vertex.position;
                let off = direction - difference / difference.amax() / (difference / difference.amax()).norm();
                assert!(off.amax() <= 4.0 * f64::EPSILON);
                assert!(
                    (0..3)
                        .all(|k| (f64::from(rough[k]) - direction[k]).abs()
                            <= 2f64.powi(-24) * direction[k].abs() + 1e-38)
                );
                if edge != NONE {
                    let edge = &p.edges[edge as usize];
                    let ends = [edge.tail(), edge.head()];
                    let beside = [v as u32, head]
                        .iter()
                        .all(|w| ends.contains(w) || distance_to_edge(p, edge, *w) <= 17.0 * UNIT_ROUNDOFF * p.radius);
                    assert!(beside, "neighbour {head} of {v} is not on the edge {ends:?}");
                }
            }
        }
        found.sort_unstable();
        assert_eq!(&found, list);
    }
    if p.dimension >= 2 {
        flat_vertices(p);
    }
    // Each edge is found from both its ends.
    for (e, edge) in p.edges.iter().enumerate() {
        for end in [edge.tail(), edge.head()] {
            assert!(p.neighbour_blocks(end).any(|b| b.edge.contains(&(e as u32))));
        }
    }
}

/// A vertex is a corner, or within an edge, or inside a face and knows which.
fn flat_vertices(p: &Polyhedron) {
    let mut corners = 0;
    for v in 0..p.vertices.len() as u32 {
        let is_corner = p.edges.iter().any(|edge| edge.tail() == v || edge.head() == v);
        let knows_edges = p.neighbour_blocks(v).any(|block| block.edge.iter().any(|edge| *edge != NONE));
        let face = p.face_around(v);
        corners += usize::from(is_corner);
        assert_eq!(face.is_none(), knows_edges);
        assert!(p.dimension == 3 || knows_edges);
        match p.edge_by_flat_vertex(v) {
            None => assert!(is_corner),
            Some(edge) if knows_edges => {
                assert!(
                    !is_corner && distance_to_edge(p, &p.edges[edge as usize], v) <= 17.0 * UNIT_ROUNDOFF * p.radius
                );
            }
            Some(edge) => {
                let edge = &p.edges[edge as usize];
                assert!([edge.left(), edge.right()].contains(&face.unwrap()));
            }
        }
        if let Some(face) = face {
            let is_in = |t: usize| p.triangles[t].contains(&v);
            assert!((0..p.triangles.len()).filter(|t| is_in(*t)).any(|t| p.face_of_triangle[t] == face));
        }
    }
    assert_eq!(p.corner_count(), corners);
}

fn distance_to_edge(p: &Polyhedron, edge: &Edge, v: u32) -> f64 {
    let offset = p.vertices[v as usize].position - p.vertices[edge.tail() as usize].position;
    offset.cross(&normal(&edge.planes, 0)).norm()
}

/// In random directions and along normals: the climb ends at the maximum over all vertices, up to rounding.
fn supports(p: &Polyhedron) {
    let mut random = Random::new(17);
    let mut directions: Vec<Vector> = (0..20).map(|_| random.direction()).collect();
    directions.extend((0..3).flat_map(|k| [Vector::ith(k, 1.0), Vector::ith(k, -1.0)]));
    directions.extend(p.faces.iter().take(20).map(|f| normal(&f.planes, 0)));
    for direction in directions {
        let start = random.below(p.vertices.len()) as u32;
        let (v, steps) = p.support(&direction, start);
        assert!((steps as usize) < p.vertices.len().max(1));
        let height = |v: usize| direction.dot(&p.vertices[v].position);
        let highest = (0..p.vertices.len()).map(height).fold(f64::NEG_INFINITY, f64::max);
        // A strict local maximum is the global one; at ties plain doubles may stop short of it.
        let mut heads = p.neighbour_blocks(v).flat_map(|block| block.head);
        let strict = heads.all(|head| p.direction_to(v, head).dot(&direction) < -1e-15);
        if strict {
            assert_eq!(height(v as usize), highest);
        }
    }
}

fn edges(p: &Polyhedron) {
    let mut bevels = 0;
    for (e, edge) in p.edges.iter().enumerate() {
        assert!(edge.tail() < edge.head());
        let [a, b] = [edge.tail(), edge.head()].map(|v| p.vertices[v as usize].position);
        let direction = normal(&edge.planes, 0);
        let size = p.radius;
        let tolerance = 8.0 * UNIT_ROUNDOFF * size;
        assert!((0..4).all(|lane| is_unit(&normal(&edge.planes, lane))));
        assert!(((b - a).norm() - edge.length).abs() <= 1e-15 * edge.length);
        assert!(((b - a) - direction * edge.length).norm() <= tolerance);
        assert!(value(&edge.planes, 0, &a).abs() <= tolerance);
        assert!(value(&edge.planes, 1, &b).abs() <= tolerance);
        assert_eq!(normal(&edge.planes, 1), -direction);
        assert_eq!(edge.tail_position, a);
        for (lane, face) in [(2, edge.left()), (3, edge.right())] {
            let side = normal(&edge.planes, lane);
            assert!(side.dot(&direction).abs() <= 4.0 * f64::EPSILON);
            assert!(value(&edge.planes, lane, &a).abs() <= tolerance);
            assert!(value(&edge.planes, lane, &b).abs() <= tolerance);
            let face = &p.faces[face as usize];
            assert_eq!(edge.normals[lane - 2], normal(&face.planes, 0));
            assert!(edge.slack >= face.slack);
            let expected =
                if lane == 2 { direction.cross(&edge.normals[0]) } else { edge.normals[1].cross(&direction) };
            assert!((expected.normalize() - side).norm() <= 4.0 * f64::EPSILON);
        }
        let sine = edge.normals[0].dot(&normal(&edge.planes, 3));
        if sine > 0.0 {
            assert_eq!(edge.reciprocal_sine, 1.0 / sine);
        } else {
            assert_eq!(edge.reciprocal_sine, f64::INFINITY);
        }
        if edge.normals[0].dot(&edge.normals[1]) < 0.0 {
            bevels += 1;
            let bevel = &p.bevels[edge.bevel as usize];
            assert!(is_unit(&bevel.normal));
            assert!(bevel.normal.dot(&direction).abs() <= 1e-15);
            let [left, right] = edge.normals.map(|n| bevel.normal.dot(&n));
            // A short edge may lean out of a merged face.
            let lean = 1e-15 + 64.0 * UNIT_ROUNDOFF * p.radius / edge.length;
            assert!((left - right).abs() <= lean && left >= -lean, "bevel of edge {e} halves: {left:e} {right:e}");
        } else {
            assert_eq!(edge.bevel, NONE);
        }
    }
    assert_eq!(bevels, p.bevels.len());
}

fn sides<'a>(p: &'a Polyhedron, face: &MergedFace) -> &'a [u32] {
    &p.sides[face.first_side as usize..(face.first_side + face.side_count) as usize]
}

fn side_plane<'a>(p: &'a Polyhedron, face: &'a MergedFace, i: usize) -> (&'a PlaneBlock, usize) {
    if i < 3 { (&face.planes, i + 1) } else { (&p.more_sides[face.first_more as usize + (i - 3) / 4], (i - 3) % 4) }
}

fn faces(p: &Polyhedron) {
    let tolerance = 64.0 * UNIT_ROUNDOFF * p.radius;
    let mut used_blocks = 0;
    for (f, face) in p.faces.iter().enumerate() {
        let n = normal(&face.planes, 0);
        assert!(is_unit(&n));
        let sides = sides(p, face);
        assert!(sides.len() >= 3);
        assert!((0..).zip(sides).all(|(side, edge)| p.side(face, side) == *edge));
        let ends: Vec<[u32; 2]> = sides
            .iter()
            .map(|s| {
                let edge = &p.edges[*s as usize];
                assert!((edge.left() == f as u32) != (edge.right() == f as u32), "an edge has two faces");
                if edge.left() == f as u32 { [edge.tail(), edge.head()] } else { [edge.head(), edge.tail()] }
            })
            .collect();
        assert!(ends.iter().any(|[tail, _]| *tail == face.vertex));
        for i in 0..ends.len() {
            assert_eq!(ends[i][1], ends[(i + 1) % ends.len()][0], "sides form a loop");
        }
        let corners: Vec<Vector> = ends.iter().map(|[tail, _]| p.vertices[*tail as usize].position).collect();
        assert!(corners.iter().all(|c| value(&face.planes, 0, c).abs() <= tolerance));
        for (i, [tail, head]) in ends.iter().enumerate() {
            let (block, lane) = side_plane(p, face, i);
            let [a, b] = [tail, head].map(|v| p.vertices[*v as usize].position);
            let inward = n.cross(&(b - a)).normalize();
            assert!((inward - normal(block, lane)).norm() <= 1e-14, "side {i} of face {f}");
            if corners.len() <= 100 {
                for c in &corners {
                    let outside = -value(block, lane, c);
                    assert!(outside <= tolerance, "face {f} leaves side {i} of {corners:?} by {outside:e}");
                }
            }
        }
        let last = ends.len().saturating_sub(3).div_ceil(4);
        for i in ends.len()..3 + 4 * last {
            let (block, lane) = side_plane(p, face, i);
            assert_eq!((normal(block, lane), block.offset[lane]), (Vector::zeros(), f64::MAX));
        }
        used_blocks += last;
    }
    assert_eq!(used_blocks, p.more_sides.len());
    assert_eq!(p.face_label_starts.len(), p.faces.len() + 1);
    for f in 0..p.faces.len() {
        let labels = p.labels_of_face(f as u32);
        assert!(!labels.is_empty() && labels.is_sorted());
    }
}

fn topology(p: &Polyhedron) {
    // Every half-edge of the triangulation has its twin; in a flat body diagonals occur twice in each direction.
    let mut half_edges: HashMap<[u32; 2], i32> = HashMap::new();
    for t in &p.triangles {
        for k in 0..3 {
            *half_edges.entry([t[k], t[(k + 1) % 3]]).or_default() += 1;
        }
    }
    for ([a, b], count) in &half_edges {
        assert_eq!(half_edges.get(&[*b, *a]), Some(count));
        assert!(p.dimension == 2 || *count == 1);
    }
    let (v, t) = (p.vertices.len(), p.triangles.len());
    assert_eq!(v + t, 3 * t / 2 + 2, "Euler, triangulated");
    let mut corners: Vec<u32> = p.edges.iter().flat_map(|e| [e.tail(), e.head()]).collect();
    corners.sort_unstable();
    corners.dedup();
    assert_eq!(corners.len() + p.faces.len(), p.edges.len() + 2, "Euler, merged");
    assert_eq!(p.sides.len(), 2 * p.edges.len());
    assert_eq!(p.face_of_triangle.len(), p.triangles.len());
    for (triangle, face) in p.triangles.iter().zip(&p.face_of_triangle) {
        let planes = &p.faces[*face as usize].planes;
        let bound = 33.0 * UNIT_ROUNDOFF * p.radius;
        assert!(triangle.iter().all(|v| value(planes, 0, &p.vertices[*v as usize].position).abs() <= bound));
    }
}

/// Slacks bound the exact rise over all vertices: exact rationals where doubles leave it open.
fn slacks(p: &Polyhedron) {
    let mut on_face: Vec<Vec<u32>> = vec![Vec::new(); p.faces.len()];
    for (triangle, face) in p.triangles.iter().zip(&p.face_of_triangle) {
        on_face[*face as usize].extend(triangle);
    }
    let stride = (p.faces.len() / 300).max(1);
    for (face, own) in p.faces.iter().zip(&on_face).step_by(stride) {
        check_slack(p, &normal(&face.planes, 0), own, face.slack);
    }
    let stride = (p.edges.len() / 300).max(1);
    for (e, edge) in p.edges.iter().enumerate().step_by(stride).filter(|(_, edge)| edge.bevel != NONE) {
        let bevel = &p.bevels[edge.bevel as usize];
        check_slack(p, &bevel.normal, &vertices_of_edge(p, e as u32), bevel.slack);
    }
}

/// The vertices that know an edge: its ends and the flat vertices within.
fn vertices_of_edge(p: &Polyhedron, edge: u32) -> Vec<u32> {
    let knows = |v: &u32| p.neighbour_blocks(*v).any(|block| block.edge.contains(&edge));
    (0..p.vertices.len() as u32).filter(knows).collect()
}

fn check_slack(p: &Polyhedron, n: &Vector, own: &[u32], slack: f64) {
    assert!(slack >= 0.0);
    let rounding = 16.0 * UNIT_ROUNDOFF * p.radius;
    let height = |v: u32| n.dot(&p.vertices[v as usize].position);
    let highest = (0..p.vertices.len() as u32).map(height).fold(f64::NEG_INFINITY, f64::max);
    let lowest = own.iter().map(|v| height(*v)).fold(f64::INFINITY, f64::min);
    let tops = (0..p.vertices.len() as u32).filter(|v| height(*v) >= highest - rounding);
    let top = tops.map(|v| exact_dot(n, &p.vertices[v as usize].position)).max().unwrap();
    let bottoms = own.iter().filter(|v| height(**v) <= lowest + rounding);
    let bottom = bottoms.map(|v| exact_dot(n, &p.vertices[*v as usize].position)).min().unwrap();
    let rise = top - bottom;
    assert!(rise <= rational(slack), "slack {slack:e} is less than the exact rise {:e}", rise.to_f64().value());
    // Merging costs two bounds of 16uρ, computing it a few roundings.
    assert!(slack <= 48.0 * UNIT_ROUNDOFF * p.radius, "slack {slack:e} of radius {:e}", p.radius);
}

fn rational(x: f64) -> RBig {
    RBig::try_from(x).unwrap()
}

fn exact_dot(a: &Vector, b: &Vector) -> RBig {
    rational(a.x) * rational(b.x) + rational(a.y) * rational(b.y) + rational(a.z) * rational(b.z)
}

fn mass(p: &Polyhedron) {
    let centre = p.mass.centre_of_mass;
    let positions = (0..p.vertices.len() as u32).map(|v| p.local_position(v));
    for position in positions.clone() {
        assert!(
            (position - p.centre - (centre - p.centre)).norm()
                <= p.mass.radius * (1.0 + 1e-15) + p.centre.norm() * 1e-15
        );
        assert!((0..3).all(|k| p.mass.lower[k] <= position[k] && position[k] <= p.mass.upper[k]));
    }
    for k in 0..3 {
        assert_eq!(positions.clone().map(|x| x[k]).fold(f64::INFINITY, f64::min), p.mass.lower[k]);
        assert_eq!(positions.clone().map(|x| x[k]).fold(f64::NEG_INFINITY, f64::max), p.mass.upper[k]);
        let slop = 4.0 * UNIT_ROUNDOFF * centre[k].abs();
        assert!(p.mass.lower[k] - slop <= centre[k] && centre[k] <= p.mass.upper[k] + slop);
    }
    assert_eq!(p.mass.volume > 0.0, p.dimension == 3);
}
