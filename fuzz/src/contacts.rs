//! What holds of depths and manifolds, whatever their caches hold.

use arbitrary::{Result, Unstructured};
use swiftprox::base::simd::environment::Environment;
use swiftprox::error::Error;
use swiftprox::manifold::manifold;
use swiftprox::manifold::{Manifold, ManifoldCache, ManifoldConfig, ManifoldPoint};
use swiftprox::math::Vector;
use swiftprox::pair::{DepthAnswer, DepthCache, DepthConfig, Outcome, PairAnswer, Placed, depth};
use swiftprox::verify::{verify, verify_depth, verify_manifold};
use testkit::forgery;
use testkit::manifolds::Gaps;
use testkit::random::Random;
use testkit::swept::Length;

use crate::geometry::inside;

/// A manifold of bodies of a few thousand vertices may have more; then the first are looked at.
const MOST_POINTS: usize = 256;

/// Of larger bodies the truth of gaps takes too long …
const MOST_VERTICES: usize = 16;

/// … of more vertices that of distances …
const FEW_VERTICES: usize = 8;

/// … and of depths that take more vertices of the Minkowski difference.
const MOST_GROWN: usize = 60;

/// What two bodies remember of their contact.
#[derive(Default)]
pub struct Memory {
    depth: DepthCache,
    manifold: ManifoldCache,
}

/// Checks depths and manifolds of two bodies whose exact answer is `known`. Numbers are `measured` in doubles where the bodies
/// leave room for that.
pub fn check(
    u: &mut Unstructured,
    bodies: [Placed; 2],
    known: &PairAnswer,
    measured: bool,
    environment: Environment,
    memory: &mut Memory,
) -> Result<()> {
    if u.ratio(1, 3)? {
        let mut random = Random::new(u.arbitrary::<u32>()?.into());
        memory.depth = damaged(&memory.depth, &mut random);
        memory.manifold = damaged(&memory.manifold, &mut random);
    }
    let truth = truth(bodies);
    if let Some(truth) = &truth {
        for forged in forgery::pairs(known, truth) {
            assert!(verify(bodies, &forged).is_err(), "{forged:?} {}", description(bodies));
        }
    }
    check_depth(bodies, known, truth.as_ref(), environment, &mut memory.depth);
    let reduces = u.arbitrary()?;
    let max_distance = if u.arbitrary()? { 0.0 } else { known.distance.abs() * *u.choose(&[0.5, 1.0, 2.0])? };
    if max_distance.is_finite() {
        let config = ManifoldConfig { max_distance, reduces };
        check_manifold(bodies, known, truth.as_ref(), measured, environment, &config, &mut memory.manifold);
    }
    Ok(())
}

/// The signed distance in rational numbers.
fn truth(bodies: [Placed; 2]) -> Option<Length> {
    let points = bodies.map(|body| {
        let polyhedron = body.shape.polyhedron();
        (0..polyhedron.vertices.len() as u32).map(|v| polyhedron.local_position(v).into()).collect::<Vec<[f64; 3]>>()
    });
    if points.iter().any(|points| points.len() > FEW_VERTICES) {
        return None;
    }
    let (poses, radii) = (bodies.map(|body| *body.pose), bodies.map(|body| body.shape.swept_radius()));
    let (truth, is_exact) = Length::signed([&points[0], &points[1]], &poses, radii, MOST_GROWN);
    is_exact.then_some(truth)
}

fn check_depth(
    bodies: [Placed; 2],
    known: &PairAnswer,
    truth: Option<&Length>,
    environment: Environment,
    cache: &mut DepthCache,
) {
    let ask = |mut cache: DepthCache| {
        let mut answer = DepthAnswer::default();
        depth(bodies, &mut cache, &DepthConfig::default(), &mut answer).expect("accepted poses");
        (answer, cache)
    };
    let before = *cache;
    let (answer, after) = ask(before);
    let told = inside(environment, || ask(before));
    assert_eq!(format!("{told:?}"), format!("{:?}", (answer, after)), "{environment:?}");
    let (cold, after_cold) = ask(DepthCache::default());
    for (answer, own) in [(&answer, after), (&cold, after_cold)] {
        assert_eq!(answer.outcome, known.outcome, "{answer:?}\n{known:?}");
        assert!(answer.lower <= answer.depth && answer.depth <= answer.upper, "{answer:?}");
        for proof in [own, DepthCache::default()] {
            match verify_depth(bodies, &proof, answer) {
                // What is too large or too far apart.
                Ok(()) | Err(Error::Argument(_)) => {}
                // Of very long bodies a proof need not be found from nothing.
                Err(Error::Unverified(text)) if proof != own && text.contains("is not proved") => {}
                Err(error) => panic!("{error}: {answer:?} {}", description(bodies)),
            }
        }
        for forged in truth.into_iter().flat_map(|truth| forgery::depths(answer, truth)) {
            assert!(verify_depth(bodies, &own, &forged).is_err(), "{forged:?} {}", description(bodies));
        }
    }
    assert!(answer.lower <= cold.upper && cold.lower <= answer.upper, "{answer:?}\n{cold:?}");
    *cache = after;
}

fn check_manifold(
    bodies: [Placed; 2],
    known: &PairAnswer,
    truth: Option<&Length>,
    measured: bool,
    environment: Environment,
    config: &ManifoldConfig,
    cache: &mut ManifoldCache,
) {
    let ask = |mut cache: ManifoldCache| {
        let mut points = vec![ManifoldPoint::default(); MOST_POINTS];
        let found = manifold(bodies, &mut cache, config, &mut points).expect("accepted poses");
        points.truncate(found.point_count as usize);
        (found, points, cache)
    };
    let before = *cache;
    let (found, points, after) = ask(before);
    let told = inside(environment, || ask(before));
    assert_eq!(format!("{told:?}"), format!("{:?}", (found, &points, after)), "{environment:?}");
    *cache = after;
    if found.outcome == Outcome::Beyond {
        assert!(points.is_empty() && known.upper > config.max_distance, "{found:?} {known:?}");
        return;
    }
    assert_eq!(found.outcome, known.outcome, "{found:?}\n{known:?}");
    assert!(found.lower <= found.upper && found.found_count >= found.point_count, "{found:?}");
    assert!(!points.is_empty() && (!config.reduces || points.len() <= 4), "{found:?}");
    for point in &points {
        assert!(point.gap_lower <= point.gap_upper && point.gap_lower <= config.max_distance, "{point:?} {found:?}");
    }
    match verify_manifold(bodies, &after, config, &found, &points) {
        // What is too large or too far apart.
        Ok(()) | Err(Error::Argument(_)) => {}
        Err(error) => panic!("{error}: {found:?} {points:?} {}", description(bodies)),
    }
    for forged in truth.into_iter().flat_map(|truth| forgery::manifolds(&found, truth)) {
        let checked = verify_manifold(bodies, &after, config, &forged, &points);
        assert!(checked.is_err(), "{forged:?} {points:?} {}", description(bodies));
    }
    // Asked again and again, with what is remembered since: where nothing else is said, the points keep their ids. The first time
    // damage may have chosen between faces that are as parallel; the third time the facet that then was deepest proves the depth.
    let (_, _, after) = ask(after);
    let (third, points3, after) = ask(after);
    let (fourth, points4, _) = ask(after);
    if (fourth.normal, fourth.reference) == (third.normal, third.reference) && have_places(bodies) {
        assert_eq!(ids(&points4), ids(&points3), "{third:?} {points3:?} {points4:?} {}", description(bodies));
    }
    if measured {
        measure(bodies, &found, &points);
    }
}

/// The vertices and poses of bodies.
fn description(bodies: [Placed; 2]) -> String {
    let of = |body: Placed| {
        let polyhedron = body.shape.polyhedron();
        let vertices: Vec<_> = (0..polyhedron.vertices.len() as u32).map(|v| polyhedron.local_position(v)).collect();
        format!("{vertices:?} with radius {:?} at {:?}", body.shape.swept_radius(), body.pose)
    };
    bodies.map(of).join(" and ")
}

/// Whether either body is larger than one place: 2⁻²⁷ of the pair's size, or what the noise of faces makes one. A smaller one has
/// the witness points of the distance or depth: which of its features is named depends on where their search began.
fn have_places(bodies: [Placed; 2]) -> bool {
    let radii = bodies.map(|body| body.shape.polyhedron().radius);
    let centres = bodies.map(|body| body.pose.transform(&body.shape.polyhedron().centre));
    let size = radii[0] + radii[1] + (centres[1] - centres[0]).norm();
    let slack =
        |body: Placed| body.shape.polyhedron().contact_faces.faces.iter().map(|face| face.slack).fold(0.0, f64::max);
    let noise = 2.0 * (slack(bodies[0]) + slack(bodies[1]));
    radii[0].min(radii[1]) > noise.max(size * 2.0_f64.powi(-27))
}

fn ids(points: &[ManifoldPoint]) -> Vec<u64> {
    let mut ids: Vec<u64> = points.iter().map(|point| point.id).collect();
    ids.sort_unstable();
    ids
}

/// Gaps are those between the points, along the normal, as far as rounding and the intervals go, and of points of the bodies
/// exactly; points are in line and on their bodies.
fn measure(bodies: [Placed; 2], found: &Manifold, points: &[ManifoldPoint]) {
    let normal = Vector::from(found.normal);
    assert!((normal.norm() - 1.0).abs() < 1e-14, "{found:?}");
    let radii: f64 = bodies.iter().map(|body| body.shape.polyhedron().radius + body.shape.swept_radius()).sum();
    let world = bodies.iter().map(|body| {
        let polyhedron = body.shape.polyhedron();
        polyhedron.centre.norm() + body.pose.translation().norm()
    });
    let size = radii + world.sum::<f64>();
    let rounding = 1e-13 * size;
    let slacks = bodies.map(|body| {
        let slabs = &body.shape.polyhedron().contact_faces.faces;
        slabs.iter().map(|face| face.slack).fold(0.0, f64::max)
    });
    let is_small = bodies.iter().all(|body| body.shape.polyhedron().vertices.len() <= MOST_VERTICES);
    let truth = is_small.then(|| Gaps::new(bodies, &found.normal));
    for point in points {
        let apart = Vector::from(point.world1) - Vector::from(point.world2);
        let gap = normal.dot(&apart);
        let holds = point.gap_lower - rounding <= gap && gap <= point.gap_upper + rounding;
        assert!(holds, "{gap:e} {rounding:e} {point:?} {found:?}");
        let off = (apart - normal * gap).norm();
        let in_line = 1e4 * rounding + 4.0 * (slacks[0] + slacks[1]) + (point.gap_upper - point.gap_lower);
        assert!(off <= in_line + 2_f64.powi(-26) * size, "{off:e} {rounding:e} {point:?} {found:?}");
        let Some(truth) = &truth else { continue };
        match truth.check(point) {
            Ok(outs) => {
                let is_on = |i: usize| outs[i] <= 2_f64.powi(-38) * size + 1.02 * slacks[i];
                assert!(is_on(0) && is_on(1), "{outs:?} out: {point:?} {found:?} {}", description(bodies));
            }
            Err(text) => panic!("{text}: {point:?} {found:?} {}", description(bodies)),
        }
    }
}

/// Some of the bytes of a cache are others.
fn damaged<T: Copy>(cache: &T, random: &mut Random) -> T {
    let mut damaged = *cache;
    let most = 1 << random.below(10);
    for _ in 0..random.below(most) {
        let (at, byte) = (random.below(size_of::<T>()), random.below(256) as u8);
        let byte = if random.below(2) == 0 { byte } else { byte % 8 };
        // SAFETY: within the value; caches are of integers alone, without padding, so that any bytes are valid.
        unsafe { (&raw mut damaged).cast::<u8>().add(at).write(byte) };
    }
    damaged
}
