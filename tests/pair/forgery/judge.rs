//! What of an answer is false, by the oracle: in rational numbers, and with twice the allowance that `verify` states.

use dashu_ratio::RBig;
use swiftprox::body::polyhedron::Polyhedron;
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::{DecidedBy, Feature, FeatureKind, Outcome, PairAnswer};
use swiftprox::placed::Pair;
use swiftprox::placed::exact;

use super::scenes::Scene;
use testkit::cases::{coordinates, row_major};
use testkit::certificate::{dot, proved_by};
use testkit::oracle::{Matrix3x4, Polytope, Truth, rational, transform, truth};

const IDENTITY: Matrix3x4 = [1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
const U: f64 = f64::EPSILON / 2.0;

pub struct Judge<'a> {
    scene: &'a Scene,
    poses: [Pose; 2],
    truth: Truth,
    /// The doubles next to the distance, unless they intersect.
    pub bounds: Option<[f64; 2]>,
    /// What the members other than verdict and interval may miss by.
    pub allowed: f64,
    /// The size of both bodies.
    pub size: f64,
}

impl<'a> Judge<'a> {
    /// The scene's bodies at other poses. Of bodies that are too large for the oracle a certificate tells the distance; points in
    /// them are not judged.
    pub fn new(scene: &'a Scene, poses: [Pose; 2]) -> Judge<'a> {
        let [pose_a, pose_b] = [row_major(&poses[0]), row_major(&poses[1])];
        let [a, b] = [scene.shapes[0].polyhedron(), scene.shapes[1].polyhedron()];
        let solved = exact::solve(&Pair { polyhedra: [a, b], poses: [&poses[0], &poses[1]] }, &[]);
        let truth = match &scene.polytopes {
            Some([a, b]) => truth(a, &pose_a, b, &pose_b),
            None => {
                let [points_a, points_b] = [coordinates(&scene.points[0]), coordinates(&scene.points[1])];
                let labels = |pair: &[u32; 2]| [a.vertex_labels[pair[0] as usize], b.vertex_labels[pair[1] as usize]];
                let pairs: Vec<_> = solved.pairs.iter().map(labels).collect();
                let shortest = proved_by(&points_a, &pose_a, &points_b, &pose_b, &pairs).unwrap();
                Truth { squared_distance: dot(&shortest, &shortest) }
            }
        };
        assert!(truth.lies_between(solved.lower, solved.upper) && truth.intersecting() == solved.intersecting);
        let bounds = (!truth.intersecting()).then_some([solved.lower, solved.upper]);
        let place = |polyhedron: &Polyhedron, pose: &Pose| pose.transform(&polyhedron.centre);
        let between = length(&(place(a, &poses[0]) - place(b, &poses[1])));
        let size = a.radius + b.radius;
        let allowed = 64.0 * U * (size + between + length(&a.centre) + length(&b.centre)) + 128.0 * f64::from_bits(1);
        Judge { scene, poses, truth, bounds, allowed, size }
    }

    /// What is false in an answer; what it has in common with a `known` one that is true is not looked at again.
    pub fn lie_in(&self, answer: &PairAnswer, known: Option<&PairAnswer>) -> Option<&'static str> {
        let PairAnswer { outcome, lower, distance, upper, .. } = *answer;
        let in_order = lower >= 0.0 && lower <= distance && distance <= upper;
        match outcome {
            Outcome::None => return Some("it holds nothing"),
            _ if !in_order => return Some("the interval is out of order"),
            Outcome::Intersecting if upper > 0.0 => return Some("a distance of bodies that intersect"),
            Outcome::Intersecting => {
                if self.truth.intersecting() && known.is_some_and(|known| is_same_proof(answer, known)) {
                } else if answer.decided_by == DecidedBy::InscribedSpheres && answer.proof_count == 0 {
                    if !self.truth.intersecting() {
                        return Some("bodies that are apart");
                    }
                } else if !self.is_proof(answer) {
                    return Some("the proof proves nothing");
                }
            }
            Outcome::Undecided if lower > 0.0 => return Some("no verdict, with a lower end above 0"),
            Outcome::Beyond if upper < f64::INFINITY || distance > lower => return Some("more than a lower end"),
            Outcome::Separated | Outcome::Beyond if self.truth.intersecting() => return Some("they intersect"),
            _ => {}
        }
        if !self.truth.lies_between(lower, upper) {
            return Some("the distance is not in the interval");
        }
        if outcome == Outcome::Separated && lower == 0.0 && self.truth.lies_between(5e-324, f64::INFINITY) {
            return Some("a lower end of 0");
        }
        if outcome != Outcome::Intersecting && answer.proof_count > 0 {
            return Some("a proof of nothing");
        }
        let says_points = says_points(answer);
        if says_points && matches!(outcome, Outcome::Beyond | Outcome::Undecided) {
            return Some("points that are not to be said");
        }
        let says_normal = answer.normal.iter().any(|x| !x.is_nan());
        let has_normal = matches!(outcome, Outcome::Separated | Outcome::Beyond) || says_points;
        if has_normal != says_normal {
            return Some("a normal or none");
        }
        if has_normal && let Some(lie) = self.lie_in_normal(answer) {
            return Some(lie);
        }
        if says_points { self.lie_in_points(answer, known) } else { None }
    }

    fn is_proof(&self, answer: &PairAnswer) -> bool {
        let Some(pairs) = answer.proof.get(..answer.proof_count as usize) else { return false };
        let world = |i: usize, label: u32| {
            let point = self.scene.points[i].get(label as usize)?;
            Some(transform(&row_major(&self.poses[i]), &[point.x, point.y, point.z].map(rational)))
        };
        let difference = |&[v, w]: &[u32; 2]| {
            let (v, w) = (world(0, v)?, world(1, w)?);
            Some([&v[0] - &w[0], &v[1] - &w[1], &v[2] - &w[2]])
        };
        let Some(corners) = pairs.iter().map(difference).collect::<Option<Vec<_>>>() else { return false };
        let origin = Polytope::new(&[[0.0; 3]]);
        !corners.is_empty() && truth(&Polytope::from_rationals(corners), &IDENTITY, &origin, &IDENTITY).intersecting()
    }

    fn lie_in_normal(&self, answer: &PairAnswer) -> Option<&'static str> {
        if answer.normal.iter().any(|x| !x.is_finite()) {
            return Some("a normal of no numbers");
        }
        let normal = answer.normal.map(rational);
        let excess = dot(&normal, &normal) - RBig::ONE;
        if !is_within(&excess, 32.0 * U) {
            return Some("a normal that is no unit vector");
        }
        if answer.outcome == Outcome::Intersecting {
            return None;
        }
        let heights = |i: usize| {
            let pose = row_major(&self.poses[i]);
            let height =
                move |p: &Vector| dot(&answer.normal.map(rational), &transform(&pose, &[p.x, p.y, p.z].map(rational)));
            self.scene.points[i].iter().map(height).collect::<Vec<_>>()
        };
        let gap = heights(0).into_iter().min()? - heights(1).into_iter().max()?;
        let least = rational(answer.lower.min(f64::MAX)) - rational(2.0 * self.allowed);
        (gap < least).then_some("the bodies are nearer along the normal")
    }

    fn lie_in_points(&self, answer: &PairAnswer, known: Option<&PairAnswer>) -> Option<&'static str> {
        let locals = [answer.local1, answer.local2];
        let worlds = [answer.world1, answer.world2];
        let features = [answer.feature1, answer.feature2];
        if locals.iter().chain(&worlds).flatten().any(|x| !x.is_finite()) {
            return Some("points of no numbers");
        }
        let exactly = [0, 1].map(|i| transform(&row_major(&self.poses[i]), &locals[i].map(rational)));
        let across = [0, 1, 2].map(|k| &exactly[0][k] - &exactly[1][k]);
        let apart = Truth { squared_distance: dot(&across, &across) };
        let a = 2.0 * self.allowed;
        if !apart.lies_between((answer.lower - a).max(0.0), answer.upper + a) {
            return Some("the points are not that far apart");
        }
        for i in 0..2 {
            let (polyhedron, pose) = (self.scene.shapes[i].polyhedron(), &self.poses[i]);
            let reach = polyhedron.radius + length(&polyhedron.centre) + length(&pose.translation());
            let off = [0, 1, 2].map(|k| &exactly[i][k] - rational(worlds[i][k]));
            let off = Truth { squared_distance: dot(&off, &off) };
            if !off.lies_between(0.0, 2.0 * (64.0 * U * reach + 1024.0 * f64::from_bits(1))) {
                return Some("a point that is not the same in the world");
            }
            let known = known.map(|known| ([known.local1, known.local2][i], [known.feature1, known.feature2][i]));
            if known.is_none_or(|(local, _)| local != locals[i])
                && let Some(polytopes) = &self.scene.polytopes
                && !truth(&polytopes[i], &IDENTITY, &Polytope::new(&[locals[i]]), &IDENTITY).lies_between(0.0, a)
            {
                return Some("a point out of its body");
            }
            if known != Some((locals[i], features[i])) {
                let near = a + 128.0 * U * polyhedron.radius + 2.0 * (answer.upper - answer.lower);
                let near = if answer.outcome == Outcome::Intersecting { f64::INFINITY } else { near };
                if let Some(lie) = self.lie_in_feature(i, &features[i], &locals[i], near) {
                    return Some(lie);
                }
            }
        }
        None
    }

    fn lie_in_feature(&self, i: usize, feature: &Feature, point: &[f64; 3], near: f64) -> Option<&'static str> {
        let corner = |label: u32| self.scene.points[i].get(label as usize).map(|p| [p.x, p.y, p.z]);
        let ids = match feature.kind {
            FeatureKind::None => return Some("no feature"),
            FeatureKind::Vertex => &feature.ids[..1],
            FeatureKind::Edge => &feature.ids[..],
            FeatureKind::Face => return (feature.ids[0] > 1_000).then_some("no such face"),
        };
        let Some(corners) = ids.iter().map(|&id| corner(id)).collect::<Option<Vec<_>>>() else {
            return Some("no such feature");
        };
        let missed = truth(&Polytope::new(&corners), &IDENTITY, &Polytope::new(&[*point]), &IDENTITY);
        (!missed.lies_between(0.0, near)).then_some("a point off its feature")
    }
}

fn says_points(answer: &PairAnswer) -> bool {
    let points = [answer.local1, answer.local2, answer.world1, answer.world2];
    let features = [answer.feature1, answer.feature2];
    points.iter().flatten().any(|x| !x.is_nan()) || features.iter().any(|f| f.kind != FeatureKind::None)
}

fn is_same_proof(answer: &PairAnswer, other: &PairAnswer) -> bool {
    other.outcome == Outcome::Intersecting && (answer.proof_count, answer.proof) == (other.proof_count, other.proof)
}

fn is_within(x: &RBig, most: f64) -> bool {
    let most = rational(most);
    *x <= most && -x.clone() <= most
}

/// Without overflow.
fn length(v: &Vector) -> f64 {
    let scale = v.amax();
    if scale > 0.0 && scale.is_finite() { (v / scale).norm() * scale } else { scale }
}
