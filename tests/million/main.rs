//! More than half a million queries about pairs of our own, random and adversarial, with caches of every origin: each answer is
//! checked by `verify` and against everything that answers promise.
//!
//! A theme's work is cut into chunks, each a function of its seed alone; two threads take chunk after chunk.

use std::collections::BTreeMap;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

mod placements;

use placements::{anywhere, approach, on_grid, touching};
use swiftprox::math::{Pose, Vector};
use swiftprox::pair::PairCache;
use testkit::bodies::{Body, any, any_box};
use testkit::cases::{FAMILIES, Random};
use testkit::models::{ELLIPSOIDS, ellipsoid};
use testkit::orbits::{ORBITS, STEPS, poses};
use testkit::properties::{Placed, Session, Tally, Violation};

/// Runs a theme and fails with an example of each property that did not hold.
fn run(theme: &str, chunks: usize, chunk: impl Fn(usize, &mut Session) + Sync) {
    let next = AtomicUsize::new(0);
    let results: Mutex<(Tally, BTreeMap<&str, Vec<String>>)> = Mutex::default();
    let work = || {
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            if index >= chunks {
                return;
            }
            let mut session = Session::new(0x5717_0000 + index as u64);
            chunk(index, &mut session);
            let mut results = results.lock().unwrap();
            results.0 += session.tally;
            for Violation { property, detail } in session.violations {
                results.1.entry(property).or_default().push(format!("chunk {index}: {detail}"));
            }
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    let (tally, mut violations) = results.into_inner().unwrap();
    println!("{theme}: {tally}");
    for (property, details) in &mut violations {
        // The shortest reproducer.
        details.sort_by_key(|detail| (detail.len(), detail.clone()));
        println!("{theme}: violated {} times: {property}: {}\n", details.len(), details[0]);
    }
    assert!(violations.is_empty(), "{theme}: see the output");
}

/// One pair of bodies at `count` placements, the cache kept.
fn many_placements(
    bodies: [&Body; 2],
    count: usize,
    place: fn([&Body; 2], &mut Random) -> [Pose; 2],
    session: &mut Session,
) {
    session.own = PairCache::default();
    for _ in 0..count {
        let poses = place(bodies, &mut session.random);
        session.check(&Placed { bodies, poses });
    }
}

#[test]
fn hard_families() {
    run("hard families", 60 * FAMILIES.len(), |index, session| {
        let (_, generate) = FAMILIES[index % FAMILIES.len()];
        for _ in 0..50 {
            let case = generate(&mut session.random);
            let [a, b] = [case.points_a, case.points_b].map(Body::from_points);
            session.check(&Placed { bodies: [&a, &b], poses: [case.pose_a, case.pose_b] });
        }
    });
}

#[test]
fn teleports() {
    run("teleports", 1_250, |_, session| {
        let [a, b] = [(); 2].map(|()| any(&mut session.random));
        many_placements([&a, &b], 50, anywhere, session);
    });
}

#[test]
fn approaches() {
    run("approaches", 1_000, |_, session| {
        let [a, b] = [(); 2].map(|()| any(&mut session.random));
        approach([&a, &b], session);
    });
}

#[test]
fn touching_surfaces() {
    run("touching surfaces", 1_000, |_, session| {
        let [a, b] = [(); 2].map(|()| any(&mut session.random));
        many_placements([&a, &b], 50, touching, session);
    });
}

#[test]
fn grids_of_boxes() {
    run("grids of boxes", 1_500, |_, session| {
        let [a, b] = [(); 2].map(|()| any_box(&mut session.random));
        many_placements([&a, &b], 50, on_grid, session);
    });
}

#[test]
fn orbits() {
    let ellipsoids: Vec<Body> = [102, 1_002]
        .iter()
        .flat_map(|&n| ELLIPSOIDS.map(|(_, half_axes)| ellipsoid(half_axes, n).expect("an ellipsoid")))
        .map(Body::from_mesh)
        .collect();
    run("orbits", 6 * ORBITS.len() * STEPS.len(), |index, session| {
        let orbit = ORBITS[index / 6 % ORBITS.len()];
        let step = STEPS[index / 6 / ORBITS.len()];
        let bodies = [&ellipsoids[index % 6], &ellipsoids[index % 6]];
        for pair in poses(orbit, step, 600) {
            let pose = |k: usize| Pose::from_row_major(&std::array::from_fn(|i| pair[12 * k + i]));
            session.check(&Placed { bodies, poses: [pose(0), pose(1)] });
        }
    });
}

/// Small bodies of every kind around each other.
#[test]
fn orbits_of_small_bodies() {
    run("orbits of small bodies", 3_000, |index, session| {
        let [a, b] = [(); 2].map(|()| any(&mut session.random));
        let orbit = ORBITS[index % ORBITS.len()];
        let size = 0.5 * (a.reach() + b.reach());
        for pair in poses(orbit, STEPS[session.random.below(5)], 60) {
            let pose = |k: usize| {
                let pose = Pose::from_row_major(&std::array::from_fn(|i| pair[12 * k + i]));
                Pose::new(&pose.rotation(), &Vector::from(pose.translation() * size))
            };
            session.check(&Placed { bodies: [&a, &b], poses: [pose(0), pose(1)] });
        }
    });
}
