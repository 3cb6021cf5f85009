//! Objects of a scene on grounds and half-spaces: bit for bit what pairs say, whatever the scene has seen, from any thread.

use std::sync::Arc;

use swiftprox::error::Error;
use swiftprox::ground::{Ground, GroundContacts, HeightGrid, PlacedGround, ground_contacts};
use swiftprox::manifold::{ManifoldConfig, ManifoldPoint, half_space_manifold};
use swiftprox::math::{Matrix, Pose, Vector};
use swiftprox::object::{ObjectId, ObjectOptions};
use swiftprox::pair::{HalfSpace, Outcome};
use swiftprox::scene::{GroupFilter, ObjectSet, Scene, SceneGroundContact, SetScratch};
use swiftprox::shape::Shape;
use testkit::models::prism;
use testkit::random::{Random, rotation};
use testkit::shapes::{at, cuboid, hull};

const SIDE: usize = 101;

/// 20,000 triangles of gentle hills, 1 apart.
fn hills(random: &mut Random) -> Ground {
    let heights: Vec<f64> = (0..SIDE * SIDE).map(|_| random.uniform(-0.1, 0.1)).collect();
    Ground::from_heights(&HeightGrid { rows: SIDE, columns: SIDE, spacing: [1.0; 2], heights: &heights }).unwrap()
}

/// What the test knows of an object.
struct Known {
    id: ObjectId,
    pieces: Vec<Arc<Shape>>,
    pose: Pose,
    fixed: bool,
    groups: u32,
    mask: u32,
}

struct World {
    scene: Scene,
    objects: Vec<Known>,
}

/// Anywhere over the hills: half of them touch.
fn pose(random: &mut Random) -> Pose {
    let place = Vector::new(random.uniform(1.0, 99.0), random.uniform(1.0, 99.0), random.uniform(0.2, 1.2));
    Pose::new(&rotation(&random.direction(), random.uniform(0.0, 0.3)), &place)
}

fn world(random: &mut Random, count: usize) -> World {
    let round: Vec<Vector> = (0..30).map(|_| random.direction() * 0.5).collect();
    let aside: Vec<Vector> =
        [[0.4, 0.0, 0.6], [0.9, 0.0, 0.6], [0.4, 0.5, 0.6], [0.4, 0.0, -0.3]].map(Vector::from).into();
    let drum: Vec<Vector> = prism(12, 1.0).unwrap().vertices.iter().map(|v| v * 0.5).collect();
    let shapes = [cuboid([0.5, 0.4, 0.3]), hull(&round), hull(&drum), hull(&aside)].map(Arc::new);
    let mut scene = Scene::new();
    let mut objects = Vec::new();
    for number in 0..count {
        // Some are of two pieces.
        let pieces = if number % 5 == 0 {
            vec![shapes[0].clone(), shapes[3].clone()]
        } else {
            vec![shapes[random.below(3)].clone()]
        };
        let (pose, fixed) = (pose(random), random.below(10) == 0);
        let (groups, mask) = (1 << random.below(3), if random.below(4) == 0 { 5 } else { u32::MAX });
        let options = ObjectOptions { pose, fixed, user_data: number as u64, groups, mask };
        let id = scene.add_object(pieces.clone(), &options).unwrap();
        objects.push(Known { id, pieces, pose, fixed, groups, mask });
    }
    World { scene, objects }
}

type Listed = (Vec<SceneGroundContact>, Vec<ManifoldPoint>);

/// The same piece by piece; `ask` writes contacts over what it is given.
fn one_by_one<'a>(
    objects: impl Iterator<Item = (usize, &'a Known, Pose)>,
    filter: GroupFilter,
    mut ask: impl FnMut(&Shape, &Pose, &mut GroundContacts),
) -> Listed {
    let (mut contacts, mut points) = (Vec::new(), Vec::new());
    let mut found = GroundContacts::default();
    for (number, known, pose) in objects {
        if known.groups & filter.mask == 0 || known.mask & filter.groups == 0 {
            continue;
        }
        for (piece, shape) in (0..).zip(&known.pieces) {
            ask(shape, &pose, &mut found);
            let first = points.len();
            points.extend_from_slice(&found.points);
            contacts.extend(found.contacts.iter().map(|contact| {
                let mut contact = *contact;
                contact.first_point += first;
                SceneGroundContact {
                    object: known.id,
                    user_data: number as u64,
                    ground: ObjectId::NULL,
                    piece,
                    contact,
                }
            }));
        }
    }
    (contacts, points)
}

fn free(world: &World) -> impl Iterator<Item = (usize, &Known, Pose)> {
    world.objects.iter().enumerate().filter(|(_, known)| !known.fixed).map(|(k, known)| (k, known, known.pose))
}

fn on_ground(config: &ManifoldConfig, ground: PlacedGround) -> impl FnMut(&Shape, &Pose, &mut GroundContacts) {
    move |shape, pose, found| ground_contacts(shape.at(pose), ground, config, found).unwrap()
}

#[test]
fn a_scene_on_a_ground_is_its_objects_on_it() {
    let mut random = Random::new(0x6704d);
    let ground = hills(&mut random);
    let mut world = world(&mut random, 1000);
    let mut scratch = SetScratch::default();
    let (mut met, mut beyond) = (0, 0);
    for round in 0..4 {
        let place = if round == 3 {
            Pose::new(&rotation(&random.direction(), 0.01), &(random.vector() * 0.05))
        } else {
            Pose::IDENTITY
        };
        let config = ManifoldConfig { max_distance: 0.02, reduces: round % 2 == 1 };
        let filter = if round < 2 { GroupFilter::default() } else { GroupFilter { groups: 2, mask: 3 } };
        let (contacts, points) = one_by_one(free(&world), filter, on_ground(&config, ground.at(&place)));
        // With trees and without, with a scratch that has seen other questions and a new one.
        for prepared in [false, true] {
            if prepared {
                world.scene.prepare().unwrap();
            }
            for scratch in [&mut scratch, &mut SetScratch::default()] {
                let found = world.scene.ground_contacts(None, ground.at(&place), &config, filter, scratch).unwrap();
                assert_eq!(found.contacts, contacts, "{round}");
                assert_eq!(found.points, points, "{round}");
            }
        }
        let pieces: usize = world.objects.iter().map(|known| known.pieces.len()).sum();
        met += contacts.len();
        beyond += pieces;
        for known in world.objects.iter_mut().step_by(3) {
            known.pose = pose(&mut random);
            world.scene.set_pose(known.id, &known.pose).unwrap();
        }
    }
    println!("{met} contacts of {beyond} pieces");
    assert!(met > 1000, "{met}");
}

/// A set is answered in its order, and its poses count, of fixed objects, too.
#[test]
fn a_set_is_asked_where_it_says() {
    let mut random = Random::new(0x5e7);
    let ground = hills(&mut random);
    let world = world(&mut random, 60);
    let (config, filter) = (ManifoldConfig { max_distance: 0.1, ..ManifoldConfig::default() }, GroupFilter::default());
    let chosen: Vec<usize> = (0..60).rev().step_by(2).collect();
    let ids: Vec<ObjectId> = chosen.iter().map(|k| world.objects[*k].id).collect();
    let elsewhere: Vec<Pose> = chosen.iter().map(|_| pose(&mut random)).collect();
    let mut scratch = SetScratch::default();
    for poses in [None, Some(&elsewhere[..])] {
        let placed = chosen.iter().enumerate().filter_map(|(at, &k)| {
            let known = &world.objects[k];
            let pose = poses.map_or(known.pose, |poses| poses[at]);
            (poses.is_some() || !known.fixed).then_some((k, known, pose))
        });
        let (contacts, points) = one_by_one(placed, filter, on_ground(&config, ground.at(&Pose::IDENTITY)));
        let set = ObjectSet { ids: &ids, poses, among: false };
        let found =
            world.scene.ground_contacts(Some(&set), ground.at(&Pose::IDENTITY), &config, filter, &mut scratch).unwrap();
        assert_eq!((found.contacts, found.points), (&contacts[..], &points[..]));
        assert!(contacts.len() > 10, "{}", contacts.len());
    }
}

#[test]
fn a_scene_on_a_half_space_is_its_objects_on_it() {
    let mut random = Random::new(0x4a1f);
    let mut world = world(&mut random, 300);
    let mut scratch = SetScratch::default();
    let mut seen = [0; 3];
    for round in 0..12 {
        let size = random.power(-40, 40);
        let upwards = Vector::z() + random.vector() * 0.01;
        let half_space = HalfSpace { normal: (upwards * size).into(), offset: random.uniform(-0.3, 0.9) * size };
        let reduces = round % 2 == 0;
        let config = ManifoldConfig { max_distance: [0.0, 0.05, 0.3][round % 3], reduces };
        let filter = GroupFilter { groups: 1 << (round % 3), mask: [u32::MAX, 3, 4][round % 3] };
        let (contacts, points) = one_by_one(free(&world), filter, |shape, pose, found| {
            found.contacts.clear();
            found.points.resize(64, ManifoldPoint::default());
            let manifold = half_space_manifold(shape.at(pose), &half_space, &config, &mut found.points).unwrap();
            found.points.truncate(manifold.point_count as usize);
            if manifold.outcome != Outcome::Beyond {
                found.contacts.push(swiftprox::ground::GroundContact { manifold, triangle: u32::MAX, first_point: 0 });
            }
        });
        for prepared in [false, true] {
            if prepared {
                world.scene.prepare().unwrap();
            }
            let found = world.scene.half_space_contacts(None, &half_space, &config, filter, &mut scratch).unwrap();
            assert_eq!((found.contacts, found.points), (&contacts[..], &points[..]), "{round}");
        }
        let deep = contacts.iter().filter(|c| c.contact.manifold.outcome == Outcome::Intersecting).count();
        seen = [seen[0] + deep, seen[1] + contacts.len() - deep, seen[2] + points.len()];
        for known in &mut world.objects {
            known.pose = pose(&mut random);
            world.scene.set_pose(known.id, &known.pose).unwrap();
        }
    }
    assert!(seen.iter().all(|count| *count > 100), "{seen:?}");
}

/// Whatever the directions and magnitudes, no piece that meets the half-space is passed by.
#[test]
fn no_size_hides_a_piece_from_a_half_space() {
    let mut random = Random::new(0x517e);
    let mut met = 0;
    for _ in 0..200 {
        let size = random.power(-90, 90);
        let corners = [(); 6].map(|()| random.vector() * size);
        let shape = Arc::new(hull(&corners));
        let pose = Pose::new(&random.rotation(), &(random.vector() * size * random.power(-3, 20)));
        let mut scene = Scene::new();
        scene.add_object(vec![shape.clone()], &ObjectOptions { pose, ..ObjectOptions::default() }).unwrap();
        scene.prepare().unwrap();
        let normal = random.direction();
        let through = pose.transform(&(corners[0] + random.vector() * size));
        let scale = random.power(-100, 100);
        let half_space = HalfSpace { normal: (normal * scale).into(), offset: normal.dot(&through) * scale };
        let config = ManifoldConfig::default();
        let own = half_space_manifold(shape.at(&pose), &half_space, &config, &mut []).unwrap();
        let (filter, mut scratch) = (GroupFilter::default(), SetScratch::default());
        let found = scene.half_space_contacts(None, &half_space, &config, filter, &mut scratch).unwrap();
        assert_eq!(
            found.contacts.len(),
            usize::from(own.outcome != Outcome::Beyond),
            "{size:e} {pose:?} {half_space:?}"
        );
        met += found.contacts.len();
    }
    assert!(met > 100 && met < 200, "{met}");
}

#[test]
fn threads_are_told_the_same() {
    let mut random = Random::new(0x7a3);
    let ground = hills(&mut random);
    let mut world = world(&mut random, 300);
    world.scene.prepare().unwrap();
    let (config, filter) = (ManifoldConfig { max_distance: 0.05, ..ManifoldConfig::default() }, GroupFilter::default());
    let (scene, ground) = (&world.scene, &ground);
    let ask = || {
        let mut scratch = SetScratch::default();
        let found = scene.ground_contacts(None, ground.at(&Pose::IDENTITY), &config, filter, &mut scratch).unwrap();
        (found.contacts.to_vec(), found.points.to_vec())
    };
    let first = ask();
    std::thread::scope(|scope| {
        let threads = [(); 3].map(|()| scope.spawn(ask));
        for thread in threads {
            assert_eq!(thread.join().unwrap(), first);
        }
    });
}

#[test]
fn what_is_asked_is_checked() {
    let mut random = Random::new(1);
    let ground = hills(&mut random);
    let world = world(&mut random, 3);
    let mut scratch = SetScratch::default();
    let skewed = Pose::new(&Matrix::from_diagonal_element(1.1), &Vector::zeros());
    let stale = [world.objects[0].id, ObjectId::NULL];
    let named = ObjectSet { ids: &stale, ..ObjectSet::default() };
    let uneven = ObjectSet { ids: &stale[..1], poses: Some(&[]), among: false };
    let negative = ManifoldConfig { max_distance: -1.0, ..ManifoldConfig::default() };
    let (config, here, filter) = (ManifoldConfig::default(), at(0.0, 0.0, 0.0), GroupFilter::default());
    let mut ask = |set: Option<&ObjectSet>, place: &Pose, config: &ManifoldConfig| {
        world
            .scene
            .ground_contacts(set, ground.at(place), config, filter, &mut scratch)
            .map(|found| found.contacts.len())
    };
    assert!(matches!(ask(None, &skewed, &config), Err(Error::Pose(_))));
    assert!(matches!(ask(None, &here, &negative), Err(Error::Argument(_))));
    assert!(matches!(ask(Some(&uneven), &here, &config), Err(Error::Argument(_))));
    assert!(
        matches!(ask(Some(&named), &here, &config), Err(Error::Handle(message)) if message.contains("object 1 of 2"))
    );
    let upright = HalfSpace { normal: [0.0; 3], offset: 0.0 };
    let refused = world.scene.half_space_contacts(None, &upright, &config, filter, &mut scratch);
    assert!(matches!(refused, Err(Error::Argument(_))));
}
