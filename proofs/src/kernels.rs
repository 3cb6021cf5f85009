//! The library's kernels and formulas, run on the tape.

use std::collections::BTreeMap;

use crate::random::Random;

use crate::count::{Counter, Polynomial};
use crate::library::*;
use crate::symbolic::{Symbol, Symbolic};
use crate::tape::{self, Claim, Node, Op, Tape, finished, input, known, value};

/// A kernel that has run.
pub struct Kernel {
    /// Its name, with `_fused` or `_plain` where lanes fuse or do not.
    pub name: String,
    /// What it did.
    pub tape: Tape,
    /// Its results.
    pub roots: Vec<(String, Node)>,
    /// What it rests on.
    pub claims: Vec<Claim>,
    /// What is counted of it.
    pub values: Vec<Value>,
}

/// A value to be counted below cuts.
pub struct Value {
    /// Unique within its kernel.
    pub name: String,
    /// Where it is.
    pub node: Node,
    /// What is taken for an input, with its name.
    pub cuts: BTreeMap<Node, String>,
}

impl Kernel {
    /// As it is committed.
    pub fn print(&self) -> String {
        self.tape.print(&self.roots, &self.claims)
    }

    /// What rounding makes of a value.
    ///
    /// # Panics
    /// If there is none of that name.
    pub fn polynomial(&self, name: &str) -> Polynomial {
        let value = self.values.iter().find(|value| value.name == name);
        let value = value.unwrap_or_else(|| panic!("{}: no value {name}", self.name));
        Counter::new(&self.tape, value.cuts.clone()).count(value.node)
    }
}

/// What a kernel's function hands back.
#[derive(Default)]
struct Found {
    roots: Vec<(String, Node)>,
    claims: Vec<Claim>,
    values: Vec<Value>,
}

impl Found {
    fn root(&mut self, name: &str, node: Node) -> &mut Found {
        self.roots.push((name.to_string(), node));
        self
    }

    /// A root that is counted, too.
    fn counted(&mut self, name: &str, node: Node, cuts: &[(Node, &str)]) -> &mut Found {
        self.value(name, node, cuts).root(name, node)
    }

    /// A kernel that runs twice, or computes something twice, has a cut in several places.
    fn value(&mut self, name: &str, node: Node, cuts: &[(Node, &str)]) -> &mut Found {
        let everywhere = |(node, name): &(Node, &str)| {
            tape::equal(*node).into_iter().map(|node| (node, name.to_string())).collect::<Vec<_>>()
        };
        let cuts = cuts.iter().flat_map(everywhere).collect();
        self.values.push(Value { name: name.to_string(), node, cuts });
        self
    }
}

/// A kernel's name, and what runs it.
type Named = (&'static str, fn() -> Found);

/// All of them, run on a machine that fuses and on one that does not.
pub fn all() -> Vec<Kernel> {
    let on_lanes: [Named; 12] = [
        ("difference", difference),
        ("rotate_back", rotate_back),
        ("rigid", rigid),
        ("certificate", certificate),
        ("enclosure", enclosure),
        ("planes", planes),
        ("fan", fan),
        ("plane_values", plane_block),
        ("remainder", remainder),
        ("offset", offset),
        ("edges", edges),
        ("round", round),
    ];
    let scalar: [Named; 14] = [
        ("bounds", bounds),
        ("interval", interval),
        ("round_ends", round_ends),
        ("balls", balls),
        ("determinant_error", determinant_errors),
        ("turn", turn),
        ("least_within", least_of_sagging_chord),
        ("gjk", gjk),
        ("predicates", predicates),
        ("normals", normals),
        ("pose", pose_in_plain),
        ("double_double", double_double),
        ("wide", wide),
        ("turned", turned_pose),
    ];
    let run = |name: String, is_fused: bool, kernel: fn() -> Found| {
        tape::begin(is_fused);
        let Found { roots, claims, values } = kernel();
        Kernel { name, tape: finished(), roots, claims, values }
    };
    let of_lanes = on_lanes.iter().flat_map(|(name, kernel)| {
        [(true, "fused"), (false, "plain")].map(|(is_fused, form)| run(format!("{name}_{form}"), is_fused, *kernel))
    });
    of_lanes.chain(scalar.iter().map(|(name, kernel)| run(name.to_string(), false, *kernel))).collect()
}

/// A kernel of [`all`].
pub fn named<'a>(kernels: &'a [Kernel], name: &str) -> &'a Kernel {
    kernels.iter().find(|kernel| kernel.name == name).unwrap_or_else(|| panic!("no kernel {name}"))
}

fn vector(name: &str, v: Vector) -> Vector {
    for k in 0..3 {
        input(&format!("{name}{k}"), v[k]);
    }
    v
}

fn symbols(name: &str, random: &mut Random) -> [Symbol; 3] {
    [0, 1, 2].map(|k| Symbol(input(&format!("{name}{k}"), random.signed())))
}

fn symbol(name: &str, x: f64) -> Symbol {
    Symbol(input(name, x))
}

fn pose(random: &mut Random, name: &str, reach: f64) -> Pose {
    let pose = Pose::new(&random.rotation(), &(random.vector() * reach));
    for (i, row) in pose.rows.iter().enumerate() {
        for k in 0..3 {
            input(&format!("R{name}_{i}{k}"), row[k]);
        }
        input(&format!("T{name}_{i}"), row[3]);
    }
    pose
}

/// A tetrahedron around the origin whose centre is its origin.
fn tetrahedron(random: &mut Random, name: &str) -> Polyhedron {
    let corners = [[1.0, 1.0, 1.0], [-1.0, -1.0, 1.0], [-1.0, 1.0, -1.0], [1.0, -1.0, -1.0]];
    let corners = corners.map(|corner| Vector::from(corner) + random.vector() * 0.2);
    let body = build(&corners, None).expect("a tetrahedron");
    for (index, vertex) in body.vertices.iter().enumerate() {
        vector(&format!("{name}{index}_"), vertex.position);
    }
    body
}

/// A segment around the origin.
fn segment(random: &mut Random, name: &str) -> Polyhedron {
    let [along, aside] = [random.direction(), random.vector() * 0.1];
    let body = build(&[aside + along, aside - along], None).expect("a segment");
    assert_eq!(body.centre, Vector::zeros());
    for (index, vertex) in body.vertices.iter().enumerate() {
        vector(&format!("{name}{index}_"), vertex.position);
    }
    body
}

/// Runs on a frame of two bodies in each other.
fn in_frame(f: impl Fn(&Frame<Symbolic>, &mut Random, &mut Found)) -> Found {
    in_frame_of(tetrahedron, f)
}

fn in_frame_of(
    body: fn(&mut Random, &str) -> Polyhedron,
    f: impl Fn(&Frame<Symbolic>, &mut Random, &mut Found),
) -> Found {
    let mut random = Random::new(0x70_72_6f_6f_66);
    let bodies = [body(&mut random, "v"), body(&mut random, "w")];
    let poses = [pose(&mut random, "1", 0.05), pose(&mut random, "2", 0.05)];
    let frame = Frame::<Symbolic>::new(&Pair { polyhedra: [&bodies[0], &bodies[1]], poses: [&poses[0], &poses[1]] });
    assert!(frame.in_range && frame.rigid);
    // What follows from size and separation is computed on scalars: by the same formulas on the tape, and known by its bits.
    let (size, apart) = (symbol("size", frame.size), symbol("separation", frame.separation));
    let _ = rounding(size, apart);
    let mut found = Found::default();
    f(&frame, &mut random, &mut found);
    found
}

fn operands<const N: usize>(node: Node) -> [Node; N] {
    finished().operands(node).try_into().unwrap_or_else(|_| panic!("node {node} has not {N} operands"))
}

/// [`Frame::difference`]: x − y in world axes, and what it is made of.
fn difference() -> Found {
    in_frame(|frame, random, found| {
        let (p, q) = (vector("p", random.vector()), vector("q", random.vector()));
        let difference = frame.difference(&p, &q);
        for k in 0..3 {
            let [sum, second] = operands(difference.0[k]);
            let [first, offset] = operands(sum);
            let name = |what: &str| format!("{what}{k}");
            found.counted(&name("first"), first, &[]).counted(&name("second"), second, &[]);
            found.counted(&name("offset"), offset, &[]);
            let cuts = [(first, "x"), (offset, "o"), (second, "y")];
            found.value(&name("sum"), sum, &cuts).counted(&name("D"), difference.0[k], &cuts);
        }
        // The length of the offset, and what bounds it.
        let [x, y, z, _] = frame.bodies[0].offset.0;
        let square = dot([Symbol(x), Symbol(y), Symbol(z)], [Symbol(x), Symbol(y), Symbol(z)]);
        let length = separation(square, Symbol::from(0.0));
        assert_eq!(value(length.0).to_bits(), frame.separation.to_bits());
        found.counted("separation", length.0, &[(x, "ox"), (y, "oy"), (z, "oz")]);
    })
}

/// [`Body::rotate_back`](swiftprox::placed::frame::Body::rotate_back): RᵀU.
fn rotate_back() -> Found {
    in_frame(|frame, random, found| {
        let u = vector("U", random.vector());
        let g = frame.bodies[0].rotate_back(Symbolic::from_vector(&u));
        for k in 0..3 {
            found.counted(&format!("g{k}"), g.0[k], &[]);
        }
        let turned = frame.bodies[0].rotate_lanes(Symbolic::from_vector(&u));
        for k in 0..3 {
            found.counted(&format!("x{k}"), turned.0[k], &[]);
        }
    })
}

/// How a frame tells that its poses are rigid: entries of RᵀR − I, and the sum of their squares against a limit.
fn rigid() -> Found {
    let mut found = in_frame(|_, _, _| ());
    let claim = finished().claims[0];
    assert_eq!((claim.relation, value(claim.right)), ("<=", RIGID_TOGETHER * RIGID_TOGETHER));
    found.claims.push(claim);
    // The entries are what is squared.
    let tape = finished();
    let below = tape.below(&[claim.left], &BTreeMap::new());
    let squared = |node: &&Node| match tape.operands(**node) {
        [a, b, ..] => a == b && matches!(tape.op(**node), Op::Mul | Op::Fma) && tape.op(*a) != Op::Input,
        _ => false,
    };
    let entries: Vec<Node> = below.iter().filter(squared).map(|node| tape.operands(*node)[0]).collect();
    assert_eq!(entries.len(), 4, "two bodies have a square and a product each in lane 0");
    let mut cuts = Vec::new();
    for (node, name) in entries.iter().zip(["square1", "square2", "product1", "product2"]) {
        found.root(name, *node);
        cuts.push((*node, name));
    }
    found.value("sum", claim.left, &cuts);
    found
}

/// What `certificate::interval` is given: products and the reciprocal length of a direction.
fn certificate() -> Found {
    in_frame(|_, random, found| {
        let (u, d) = (vector("U", random.vector()), vector("D", random.vector()));
        let (u, d) = (Symbolic::from_vector(&u), Symbolic::from_vector(&d));
        let length = Symbol(known(u.dot(u))).sqrt();
        let inverse = Symbol::from(1.0) / length;
        let projection = Symbol(known(u.dot(d))) * inverse;
        let distance = Symbol(known(d.dot(d))).sqrt();
        // As `certificate::reciprocal_length` and its callers compute them.
        assert_eq!(value(inverse.0), reciprocal_length(u.dot(u)));
        found.counted("projection", projection.0, &[]).counted("distance", distance.0, &[]);
    })
}

/// `enclosure::sides_of_faces`: four determinants against a bound.
fn enclosure() -> Found {
    in_frame(|frame, _, found| {
        let pairs = [[0, 1], [1, 0], [2, 3], [3, 2]];
        let run = || {
            let before = finished().claims.len();
            let _ = encloses_origin(frame, &pairs);
            finished().claims.split_off(before)
        };
        // Once to know the longest corner, whose bound the second run then knows.
        run();
        let polyhedra = frame.polyhedra();
        let corners = pairs.map(|[v, w]| {
            frame.difference(&polyhedra[0].vertices[v as usize].position, &polyhedra[1].vertices[w as usize].position)
        });
        let squares = Symbolic::components(&corners);
        let [x, y, z] = squares;
        let squares = z.mul_add(z, y.mul_add(y, x.mul(x)));
        let longest = squares.0.iter().copied().max_by(|a, b| value(*a).total_cmp(&value(*b))).expect("four");
        let longest = length_above(Symbol(longest));
        let (size, apart) = (Symbol(known(frame.size)), Symbol(known(frame.separation)));
        let error = difference_error(size, apart, longest);
        let bound = determinant_error(longest, error);
        let claims = run();
        assert!(claims.len() == 4 && claims.iter().all(|claim| claim.relation == ">"));
        assert!(claims.iter().all(|claim| value(claim.right) == value(bound.0)), "the bound has changed");
        let mut cuts = Vec::new();
        for (corner, names) in
            corners.iter().zip([["x0", "y0", "z0"], ["x1", "y1", "z1"], ["x2", "y2", "z2"], ["x3", "y3", "z3"]])
        {
            (0..3).for_each(|k| cuts.push((known(value(corner.0[k])), names[k])));
        }
        for (k, claim) in claims.iter().enumerate() {
            found.value(&format!("determinant{k}"), claim.left, &cuts);
        }
        found.claims = claims;
    })
}

/// `planes::evaluate`: four planes of triangles of a polytope.
fn planes() -> Found {
    let mut random = Random::new(0x70_6c);
    let mut polytope = Box::new(Polytope::<8, 16>::EMPTY);
    for (index, corner) in [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].into_iter().enumerate() {
        let place = vector(["p", "q", "r"][index], Vector::from(corner) + random.vector() * 0.1);
        polytope.positions[index] = [place.x, place.y, place.z, 0.0];
    }
    polytope.corners[0] = [0, 1, 2, 0];
    (polytope.vertex_count, polytope.triangle_count) = (3, 1);
    let rounding = PairRounding {
        difference: 0.0,
        plane: value(input("plane", 1e-15 * random.uniform(1.0, 2.0))),
        determinant: value(input("determinant", 1e-15 * random.uniform(1.0, 2.0))),
        provable: 0.0,
    };
    let centre = vector("c", random.vector() * 0.01);
    let _ = evaluate::<Symbolic, 8, 16>(&mut polytope, &rounding, &centre, 0, 1);
    let mut found = Found::default();
    let tape = finished();
    let normal = [0, 1, 2].map(|k| known(polytope.normals[k][0]));
    let distance = known(polytope.distances[0]);
    let [over, _] = operands(distance);
    let [across, inverse] = operands(normal[0]);
    let cross = normal.map(|node| tape.operands(node)[0]);
    let edges = edges_of(&tape, cross);
    let named: Vec<(Node, &str)> = edges.into_iter().zip(["ex", "ey", "ez", "gx", "gy", "gz"]).collect();
    for k in 0..3 {
        found.counted(&format!("cross{k}"), cross[k], &named).root(&format!("normal{k}"), normal[k]);
    }
    let of_cross: Vec<(Node, &str)> = cross.into_iter().zip(["nx", "ny", "nz"]).collect();
    found.counted("inverse", inverse, &of_cross).value("normal", normal[0], &of_cross);
    let of_normal: Vec<(Node, &str)> = normal.into_iter().zip(["ux", "uy", "uz"]).collect();
    found.counted("over", over, &of_normal).root("distance", distance).root("across", across);
    let claim = *tape.claims.last().expect("the determinants");
    let claim = tape.claims.iter().rev().take(4).next_back().copied().unwrap_or(claim);
    let [left, length] = operands(claim.left);
    assert_eq!(left, distance);
    let [_, sizes] = operands(claim.right);
    found.value("length", length, &of_cross).value("sizes", sizes, &named);
    found.claims.push(claim);
    found
}

/// The components of both edges whose cross product this is: e × g.
fn edges_of(tape: &Tape, cross: [Node; 3]) -> [Node; 6] {
    // Of x: ey·gz − ez·gy, and of y: ez·gx − ex·gz.
    let factors = |node: Node| {
        let (product, other) = match (tape.op(node), tape.operands(node)) {
            (Op::Fnma, [a, b, c]) => (*c, [*a, *b]),
            (Op::Sub, [a, b]) => (*a, [tape.operands(*b)[0], tape.operands(*b)[1]]),
            (op, _) => panic!("{op:?} is no component of a cross product"),
        };
        ([tape.operands(product)[0], tape.operands(product)[1]], other)
    };
    let ([ey, gz], [ez, gy]) = factors(cross[0]);
    let ([_, gx], [ex, _]) = factors(cross[1]);
    [ex, ey, ez, gx, gy, gz]
}

/// [`PlacedFan::place`]: a normal, how far the body reaches along it, a corner, and what a corner is deep below the plane.
fn fan() -> Found {
    in_frame(|frame, _, found| {
        let body = frame.bodies[0];
        let fan = body.polyhedron.fan.as_ref().expect("a small body");
        let plane = &fan.planes[0];
        vector("n", Vector::new(plane.x[0], plane.y[0], plane.z[0]));
        let reach = input("reach", plane.reach[0]);
        let mut placed = PlacedFan::<2, 3>::EMPTY;
        placed.place(&body, fan, body.offset, true);
        let normal = [0, 1, 2].map(|k| known(placed.normal(0)[k]));
        let point = [0, 1, 2].map(|k| known(placed.point(0)[k]));
        let [x, y, z, _] = body.offset.0;
        let cuts =
            [(normal[0], "nx"), (normal[1], "ny"), (normal[2], "nz"), (x, "ox"), (y, "oy"), (z, "oz"), (reach, "r")];
        let deep = known(placed.reach(0));
        for k in 0..3 {
            found.counted(&format!("normal{k}"), normal[k], &[]);
        }
        for k in 0..3 {
            let [turned, offset] = operands(point[k]);
            found.root(&format!("point{k}"), point[k]).value(&format!("corner{k}"), turned, &[]);
            found.value(&format!("point{k}"), point[k], &[(turned, "x"), (offset, "o")]);
        }
        found.counted("reach", deep, &cuts);
        // Its product with a corner: the first of those that `least` looks at.
        let along = placed.normal(0);
        let least = known(placed.least::<Symbolic>(&along));
        let tape = finished();
        let of_normal = [(normal[0], "nx"), (normal[1], "ny"), (normal[2], "nz")];
        found.counted("least", least, &with_factors(&tape, least, &of_normal));
    })
}

/// A normal's components, and beside them those that a product multiplies them with.
fn with_factors<'a>(tape: &Tape, product: Node, normal: &[(Node, &'a str)]) -> Vec<(Node, &'a str)> {
    let mut all = normal.to_vec();
    for (own, factor) in normal.iter().zip(["vx", "vy", "vz"]) {
        let is_product = |node: &Node| {
            matches!(tape.op(*node), Op::Mul | Op::Fma) && tape.value(tape.operands(*node)[0]) == tape.value(own.0)
        };
        let below = tape.below(&[product], &normal.iter().map(|(node, name)| (*node, name.to_string())).collect());
        let node = below.into_iter().find(is_product).expect("a product with the normal");
        all.push((tape.operands(node)[1], factor));
    }
    all
}

/// [`plane_values`] and [`plane_slopes`].
fn plane_block() -> Found {
    let mut random = Random::new(0x70_62);
    let four =
        |name: &str, random: &mut Random| [0, 1, 2, 3].map(|k| value(input(&format!("{name}{k}"), random.signed())));
    let block = PlaneBlock {
        x: four("nx", &mut random),
        y: four("ny", &mut random),
        z: four("nz", &mut random),
        offset: four("offset", &mut random),
    };
    let point = vector("p", random.vector());
    let (values, slopes) =
        (plane_values(&block, Symbolic::from_vector(&point)), plane_slopes(&block, Symbolic::from_vector(&point)));
    // And of vertices in blocks.
    let block = PointBlock { x: four("x", &mut random), y: four("y", &mut random), z: four("z", &mut random) };
    let high = heights(["gx", "gy", "gz"].map(|name| Symbolic([input(name, random.signed()); 4])), &block);
    let mut found = Found::default();
    found.counted("value", values.0[0], &[]).counted("slope", slopes.0[0], &[]).counted("high", high.0[0], &[]);
    found
}

/// The formulas of a pair's bounds: of a difference, of a polytope's planes, of bounding spheres.
fn bounds() -> Found {
    let mut found = Found::default();
    let (size, apart, length) = (symbol("size", 1.25), symbol("separation", 0.75), symbol("length", 0.3));
    found.counted("difference_error", difference_error(size, apart, length).0, &[]);
    found.counted("tolerance", tolerance(size, apart).0, &[]);
    let names = ["difference", "plane", "determinant", "provable"];
    for (name, value) in names.into_iter().zip(rounding(size, apart)) {
        found.counted(name, value.0, &[]);
    }
    let (square, cancelled) = (symbol("square", 0.7), symbol("cancelled", 0.9));
    found.counted("separation", separation(square, cancelled).0, &[]);
    found
}

/// The ends of an interval.
fn interval() -> Found {
    let mut found = Found::default();
    let [distance, projection, error, excess, point] =
        ["distance", "projection", "error", "excess", "point"].map(|name| symbol(name, 0.5));
    let [lower, upper] = ends(distance, projection, error, excess, point);
    found.counted("lower", lower.0, &[]).counted("upper", upper.0, &[]);
    found
}

/// [`NearestOfRound::of`] two segments: the difference of the points whose distance it takes.
fn round() -> Found {
    // Once to know the weights of the ends, which plain doubles compute.
    in_frame_of(segment, |frame, _, _| {
        NearestOfRound::of(frame);
    });
    let [t, s] = tape::unseen()[..2] else { panic!("two weights") };
    assert!([s, t].iter().all(|weight| (0.1..0.9).contains(weight)), "{s} {t}");
    tape::begin(tape::is_fused());
    let weights = [input("s", s), input("t", t)];
    in_frame_of(segment, |frame, _, found| {
        let nearest = NearestOfRound::of(frame);
        assert_eq!(nearest.interval, interval_of_crossing(frame, nearest.distance));
        let tape = finished();
        let [square] = operands(known(nearest.distance));
        let [sum, z] = operands(square);
        let [x, y] = operands(sum);
        // The way that is multiplied, fused or not, and what the multiple is added to or taken off.
        let parts = |node: Node, weight: Node| {
            let own = tape.operands(node);
            let (product, rest) = match tape.op(node) {
                Op::Fma | Op::Fnma => (own, own[2]),
                Op::Add => (tape.operands(own[0]), own[1]),
                Op::Sub => (tape.operands(own[1]), own[0]),
                op => panic!("{op:?} adds no multiple"),
            };
            assert_eq!(product[1], weight);
            (product[0], rest)
        };
        for (k, product) in [x, y, z].into_iter().enumerate() {
            let [apart, _] = operands(product);
            let (way2, moved) = parts(apart, weights[1]);
            let (way1, tails) = parts(moved, weights[0]);
            let [seen, tail2] = operands(tails);
            let [tail1, offset] = operands(seen);
            let [[head1, own1], [head2, own2]] = [way1, way2].map(operands);
            // So that errors of tails are weighted as the tails are.
            assert_eq!([own1, own2], [tail1, tail2]);
            let name = |what: &str| format!("{what}{k}");
            for (what, node) in [("tail1_", tail1), ("tail2_", tail2), ("head1_", head1), ("head2_", head2)] {
                found.value(&name(what), node, &[]);
            }
            found.value(&name("seen"), seen, &[(tail1, "x"), (offset, "o")]);
            found.value(&name("tails"), tails, &[(seen, "x"), (tail2, "y")]);
            found.value(&name("way1_"), way1, &[(head1, "x"), (tail1, "y")]);
            found.value(&name("way2_"), way2, &[(head2, "x"), (tail2, "y")]);
            found.value(&name("moved"), moved, &[(way1, "a"), (tails, "d")]);
            found.counted(&name("apart"), apart, &[(way2, "b"), (moved, "d")]);
        }
    })
}

/// What [`NearestOfRound::of`] has to make of crossing segments, where the differences of their ends are [`Frame::difference`].
fn interval_of_crossing(frame: &Frame<Symbolic>, distance: f64) -> Interval {
    let ends = frame.polyhedra().map(|body| [body.vertices[0].position, body.vertices[1].position]);
    let [way1, way2] = [0, 1].map(|i| frame.bodies[i].rotate(&ends[i][1]).sub(frame.bodies[i].rotate(&ends[i][0])));
    let across = way1.cross(way2);
    let heights = [0, 1, 2, 3].map(|k| across.dot(frame.difference(&ends[0][k / 2], &ends[1][k % 2])));
    let (inverse, sign) = (reciprocal_length(across.dot(across)), heights[0].signum());
    let least = heights.into_iter().map(|height| sign * height).fold(f64::INFINITY, f64::min);
    let [lower, upper] = ends_of_segments(distance, least * inverse, frame.size, frame.separation);
    Interval { lower, upper }
}

/// The ends of the interval of points and segments.
fn round_ends() -> Found {
    let mut found = Found::default();
    let [distance, least, size, apart] = ["distance", "least", "size", "separation"].map(|name| symbol(name, 0.5));
    let [lower, upper] = ends_of_segments(distance, least, size, apart);
    found.counted("lower_of_segments", lower.0, &[]).counted("upper_of_segments", upper.0, &[]);
    let [lower, upper] = ends_of_points(distance, least, apart);
    found.counted("lower_of_points", lower.0, &[]).counted("upper_of_points", upper.0, &[]);
    // The direction is the difference itself.
    let square = symbol("square", 0.7);
    let along = square * (Symbol::from(1.0) / square.sqrt());
    found.counted("along", along.0, &[]);
    found
}

/// Balls around the origins: the square of what these are apart, and what it has to be below.
fn balls() -> Found {
    let mut random = Random::new(0x62);
    let [from, to] = ["p", "q"].map(|name| symbols(name, &mut random));
    let square = square_between(from, to);
    let tape = finished();
    let [sum, z] = operands(square.0);
    let [x, y] = operands(sum);
    let mut found = Found::default();
    let cuts = [(x, "x"), (y, "y"), (z, "z")].map(|(product, name)| (tape.operands(product)[0], name));
    for (node, name) in cuts {
        found.counted(&format!("difference_{name}"), node, &[]);
    }
    found.counted("square", square.0, &cuts);
    let inner = together([symbol("r1", 0.4), symbol("r2", 0.3)], symbol("swept", 0.2));
    found.counted("inner", inner.0, &[]).counted("limit", square_of_rigid(inner).0, &[(inner.0, "inner")]);
    found.counted("shrunk", shrunk(symbol("r", 0.6), symbol("defect", 0.01)).0, &[]);
    found
}

/// What a determinant of an enclosure may be off by.
fn determinant_errors() -> Found {
    let mut found = Found::default();
    let square = symbol("square", 0.7);
    found.counted("longest", length_above(square).0, &[]);
    let (longest, error) = (symbol("L", 0.8), symbol("E", 1e-3));
    found.counted("bound", determinant_error(longest, error).0, &[]);
    found
}

/// The reduction of an angle, and sine and cosine behind it.
fn turn() -> Found {
    let mut found = Found::default();
    let (angle, multiple, r) = (symbol("angle", 2.0), symbol("multiple", 1.0), symbol("r", 0.3));
    found.root("reduced", reduced(angle, multiple).0).root("sine", sine(r).0).root("cosine", cosine(r).0);
    found
}

/// The least gap between two moments.
fn least_of_sagging_chord() -> Found {
    let mut found = Found::default();
    let least = least_within(symbol("first", 0.7), symbol("rise", 0.2), symbol("sag", 0.9));
    let [_, loss] = operands(least.0);
    let [square, _] = operands(loss);
    let [excess, _] = operands(square);
    found.counted("least", least.0, &[(excess, "excess")]);
    found
}

/// Witness points of a simplex, and supports proved at vertices.
fn gjk() -> Found {
    let mut random = Random::new(0x67_6a);
    let [a, b, c, g, x] = ["a", "b", "c", "g", "x"].map(|name| symbols(name, &mut random));
    let (v, w) = (symbol("v", 0.3), symbol("w", 0.4));
    let one = plus_weighted(a, a, b, v);
    let two = plus_weighted(one, a, c, w);
    let mut found = Found::default();
    let [_, part] = operands(two[0].0);
    let [way, _] = operands(part);
    found.counted("way", part, &[]).counted("point", two[0].0, &[(part, "part"), (one[0].0, "one")]).root("d", way);
    found.counted("excess", height_over(g, b, x).0, &[]);
    found.counted("determinant", determinant([a, b, c]).0, &[]);
    found
}

/// A plane through three points and how high a fourth is over it.
fn predicates() -> Found {
    let mut random = Random::new(0x70_72);
    let [a, b, c, p] = ["a", "b", "c", "p"].map(|name| symbols(name, &mut random));
    let (normal, permanent) = normal_and_permanent([&a, &b, &c]);
    let (height, spread) = height_and_spread(normal, permanent, a, p);
    let tape = finished();
    // All differences from a are inputs, each rounded once.
    let of_corners = [b, c, p].map(|v| v.map(|Symbol(node)| node));
    let differences: Vec<(Node, String)> = tape
        .below(&[height.0, spread.0], &BTreeMap::new())
        .into_iter()
        .filter(|node| tape.op(*node) == Op::Sub && of_corners.as_flattened().contains(&tape.operands(*node)[0]))
        .map(|node| (node, format!("{}_{}", tape.name(tape.operands(node)[0]), tape.name(tape.operands(node)[1]))))
        .collect();
    let mut cuts: Vec<(Node, &str)> = differences.iter().map(|(node, name)| (*node, name.as_str())).collect();
    cuts.sort_unstable();
    let mut found = Found::default();
    found.counted("height", height.0, &cuts).counted("spread", spread.0, &cuts);
    found
}

/// A unit vector, and heights over a vertex along a normal.
fn normals() -> Found {
    let mut random = Random::new(0x6e);
    let [v, n, x, s] = ["v", "n", "x", "s"].map(|name| symbols(name, &mut random));
    let mut found = Found::default();
    found.counted("unit", over_length(v)[0].0, &[]);
    let (height, magnitude) = height_and_magnitude(n, x, s);
    let tape = finished();
    let differences = tape.below(&[height.0], &BTreeMap::new()).into_iter().filter(|node| tape.op(*node) == Op::Sub);
    let names: Vec<(Node, String)> = differences.enumerate().map(|(k, node)| (node, format!("d{k}"))).collect();
    let cuts: Vec<(Node, &str)> = names.iter().map(|(node, name)| (*node, name.as_str())).collect();
    found.counted("height", height.0, &cuts).counted("magnitude", magnitude.0, &cuts);
    found
}

/// A pose in plain arithmetic: R·p, and entries of RᵀR − I.
fn pose_in_plain() -> Found {
    let mut random = Random::new(0x70_6f);
    let rows = [0, 1, 2].map(|i| [0, 1, 2, 3].map(|k| Symbol(input(&format!("R{i}{k}"), random.signed()))));
    let p = symbols("p", &mut random);
    let mut found = Found::default();
    found.counted("turned", rotated(&rows, p)[0].0, &[]);
    let entries = orthonormality(&rows);
    found.root("square", entries[0].0).root("product", entries[3].0);
    found
}

/// Double-double arithmetic, operation by operation.
fn double_double() -> Found {
    let [a, b] = [["ah", "al"], ["bh", "bl"]].map(|[hi, lo]| {
        let (high, low) = if hi == "ah" { (0.7, 3.1e-17) } else { (-0.3, 1.3e-17) };
        DoubleDouble { hi: symbol(hi, high), lo: symbol(lo, low) }
    });
    let mut found = Found::default();
    let results = [
        ("two_sum", two_sum(a.hi, b.hi)),
        ("two_product", two_product(a.hi, b.hi)),
        ("sum", a + b),
        ("difference", a - b),
        ("product", a * b),
    ];
    for (name, DoubleDouble { hi, lo }) in results {
        found.root(&format!("{name}_hi"), hi.0).root(&format!("{name}_lo"), lo.0);
    }
    found
}

/// What is built on double-doubles: each number on this tape is one.
fn wide() -> Found {
    let mut random = Random::new(0x77);
    let matrix = |name: &str, random: &mut Random| [0, 1, 2].map(|k| symbols(&format!("{name}{k}"), random));
    let [rows1, rows2, columns1, columns2] = ["R", "Q", "C", "D"].map(|name| matrix(name, &mut random));
    let [apart, centre1, centre2, p, q, normal, opposite] =
        ["T", "c", "d", "p", "q", "n", "m"].map(|name| symbols(name, &mut random));
    let between = plus_difference(&apart, &turned(&rows1, &centre1), &turned(&rows2, &centre2));
    let difference = plus_difference(&between, &turned(&rows1, &p), &turned(&rows2, &q));
    let [below, above] = [(columns1, opposite, p), (columns2, normal, q)]
        .map(|(columns, direction, vertex)| wide_dot(&turned(&columns, &direction), &vertex));
    let gap = over_both(&normal, &between, below, above);
    let [e, f, g] = ["e", "f", "g"].map(|name| symbols(name, &mut random));
    let mut found = Found::default();
    found.root("difference", difference[0].0).root("gap", gap.0);
    found.root("height", wide_height(e, f, g).0);
    found
}

/// A component of the offset of bodies whose centres are not their origins, and of what its sums and products leave off.
fn offset() -> Found {
    let mut random = Random::new(0x6f);
    let mut inputs = |name: &str| Symbolic([input(name, random.signed()); 4]);
    let terms = ["t0", "t1", "t2", "t3", "t4", "t5", "t6"].map(&mut inputs);
    let rests = ["r0", "r1", "r2", "r3", "r4", "r5", "r6"].map(&mut inputs);
    let of_sums = ["s0", "s1", "s2", "s3", "s4", "s5"].map(&mut inputs);
    let mut found = Found::default();
    found.counted("sum", sum_of(terms).0.0[0], &[]).counted("rest", rest_of(rests, of_sums).0[0], &[]);
    found
}

/// What is left of a direction beside the normals of an edge, and of a face.
fn remainder() -> Found {
    let mut random = Random::new(0x72);
    let (first, second) = (vector("n", random.vector()), vector("m", random.vector()));
    // So that the second coefficient is positive.
    let g = vector("g", first * 0.3 + second * 3.0);
    let c1 = value(input("c1", random.uniform(0.1, 0.2)));
    let lanes = [g, first, second].map(|v| Symbolic::from_vector(&v));
    let (c2, rest) = beside(lanes[0], [lanes[1], lanes[2]], c1);
    let mut found = Found::default();
    found.counted("edge", rest.0[0], &[(known(c2), "c2")]);
    let [g, n] = ["h", "k"].map(|name| symbols(name, &mut random));
    found.counted("face", beside_one(g, n, symbol("c", 0.3))[0].0, &[]);
    found
}

/// Differences of points on edges, from those of their tails.
fn edges() -> Found {
    let mut random = Random::new(0x65);
    let [tails, along1, along2] = ["d", "a", "b"].map(|name| Symbolic::from_vector(&vector(name, random.vector())));
    let (s, t) = (value(input("s", random.uniform(0.1, 0.2))), value(input("t", random.uniform(0.3, 0.4))));
    let one = from_foot(tails, along1, t).0[0];
    let two = between_feet(tails, [along1, along2], [s, t]).0[0];
    let mut found = Found::default();
    found.counted("foot", one, &[]).counted("feet", two, &[]);
    let [a, b] = [along1, along2].map(Symbolic::to_vector).map(|v| [v.x, v.y, v.z].map(|x| Symbol(known(x))));
    let square = dot(a, a);
    let newton = correction(square);
    found.counted("square", square.0, &[]).counted("correction", newton.0, &[(square.0, "square")]);
    found.counted("projected", projected(dot(b, a), newton).0, &[(newton.0, "k")]);
    found.counted("cross", along1.cross(along2).0[0], &[]);
    let (leaning, inverse) = (symbol("leaning", 0.7), symbol("inverse", 0.6));
    found.counted("across", misfit_across_edge(leaning, inverse).0, &[]);
    found.counted("between", misfit_between_edges(inverse).0, &[]);
    found.counted("error", error_along(symbol("along", 0.7), symbol("distance", 0.6)).0, &[]);
    found
}

/// Axis, speed and angle of a turn, and an entry of a turned pose.
fn turned_pose() -> Found {
    let mut random = Random::new(0x74);
    let (axis, speed) = axis_and_speed(symbols("v", &mut random), symbol("scale", 0.9));
    let turned_by = angle(symbol("time", 0.4), symbol("w", 0.7));
    let mut found = Found::default();
    found.counted("axis", axis[0].0, &[]).counted("speed", speed.0, &[]).counted("angle", turned_by.0, &[]);
    let crossed = crossed(symbols("a", &mut random), symbols("r", &mut random));
    found.counted("crossed", crossed[0].0, &[]).counted("versine", versine(symbol("cosine", 0.8)).0, &[]);
    let parts = [symbol("p", 0.3), symbol("q", -0.4)];
    let weights = [symbol("by_sine", 0.6), symbol("by_versine", 0.2)];
    found.counted("entry", entry(symbol("start", 0.5), parts, weights).0, &[]);
    found
}
