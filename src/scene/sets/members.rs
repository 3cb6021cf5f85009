//! A set of objects, and its pieces where the question has them.

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::base::memory::push;
use crate::pair::Placed;
use crate::scene::world::boxes::Aabb;
use crate::scene::world::content::World;
use crate::scene::world::object::ObjectId;
use crate::scene::world::rows::{Spheres, grown_box, placed};

/// Objects that a question is about.
#[derive(Debug, Clone, Copy, Default)]
pub struct ObjectSet<'a> {
    /// Which, in any order.
    pub ids: &'a [ObjectId],
    /// The pose of each for this question; `None`: the scene's own poses.
    pub poses: Option<&'a [Pose]>,
    /// Pairs of two objects of the set are asked about, too.
    pub among: bool,
}

/// A piece of a set.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Member {
    pub proxy: u32,
    pub pose: Pose,
    pub spheres: Spheres,
    pub bounds: Aabb,
}

impl Member {
    /// A piece of the scene at a pose that is accepted, or where the scene has it; its box only if that is asked for.
    fn new(world: &World, proxy: usize, pose: Option<Pose>, boxes: Boxes) -> Member {
        let shape = &world.proxies.shapes[proxy];
        let (pose, spheres) = match pose {
            Some(pose) => (pose, placed(shape, &pose, pose.rotation_defect()).0),
            None => (world.proxies.poses[proxy], world.proxies.spheres(proxy)),
        };
        let bounds = match boxes {
            Boxes::Made => grown_box(shape, &pose, &spheres, 0.0),
            Boxes::LeftOut => Aabb::EVERYWHERE,
        };
        Member { proxy: proxy as u32, pose, spheres, bounds }
    }

    /// The piece as one of a pair.
    pub fn side<'a>(&'a self, world: &'a World) -> PieceSide<'a> {
        PieceSide { proxy: self.proxy, spheres: self.spheres, placed: self.placed(world) }
    }

    /// The piece where it is.
    pub fn placed<'a>(&'a self, world: &'a World) -> Placed<'a> {
        world.proxies.shapes[self.proxy as usize].at(&self.pose)
    }
}

/// One of a pair of pieces.
#[derive(Clone, Copy)]
pub(crate) struct PieceSide<'a> {
    pub proxy: u32,
    pub spheres: Spheres,
    pub placed: Placed<'a>,
}

/// Whether pieces get boxes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Boxes {
    Made,
    LeftOut,
}

/// Lists the pieces of a set, those of objects in their order.
///
/// # Errors
/// [`Error::Handle`] for an id that names no object of the scene, [`Error::Argument`] unless there is one pose for each,
/// [`Error::Pose`] for a pose that is not accepted, [`Error::Memory`].
pub(crate) fn list(world: &World, set: &ObjectSet, boxes: Boxes, members: &mut Vec<Member>) -> Result<()> {
    members.clear();
    for_each(world, set, |proxy, pose| push(members, Member::new(world, proxy, pose, boxes)))
}

/// The two of these pieces that are in a set, without boxes; all of its poses are looked at.
///
/// # Errors
/// As of [`list`].
pub(crate) fn find(world: &World, set: &ObjectSet, proxies: [u32; 2]) -> Result<[Option<Member>; 2]> {
    let mut found = [None; 2];
    for_each(world, set, |proxy, pose| {
        for (own, found) in proxies.iter().zip(&mut found) {
            if *own as usize == proxy {
                *found = Some(Member::new(world, proxy, pose, Boxes::LeftOut));
            }
        }
        Ok(())
    })?;
    Ok(found)
}

/// Calls `work` with each piece of a set, and with its pose where the set gives poses.
///
/// # Errors
/// As of [`list`], and those of `work`.
#[inline(always)]
fn for_each(world: &World, set: &ObjectSet, mut work: impl FnMut(usize, Option<Pose>) -> Result<()>) -> Result<()> {
    let count = set.ids.len();
    if let Some(poses) = set.poses
        && poses.len() != count
    {
        return Err(Error::Argument(format!("{} poses for a set of {count} objects", poses.len())));
    }
    for (k, id) in set.ids.iter().enumerate() {
        let named = |error: Error| error.about(&format!("object {k} of {count} of the set"));
        let object = world.objects.get(*id).map_err(named)?;
        let pose = set.poses.map(|poses| &poses[k]);
        let check = |pose: &Pose| pose.check().map_err(named);
        pose.map_or(Ok(()), check)?;
        for (piece, proxy) in object.proxies().enumerate() {
            let pose = match (pose, &object.arrangement) {
                (Some(pose), Some(arrangement)) => {
                    arrangement.check(pose).map_err(named)?;
                    let whole = pose.after(&arrangement.piece_poses[piece]);
                    check(&whole)?;
                    Some(whole)
                }
                (pose, _) => pose.copied(),
            };
            work(proxy, pose)?;
        }
    }
    Ok(())
}

/// Refuses a ground where a set holds the bodies that may meet grounds.
///
/// # Errors
/// [`Error::Argument`]; [`Error::Handle`] for an id that names no object of the scene.
pub(crate) fn refuse_ground(world: &World, id: ObjectId) -> Result<()> {
    match world.view().get(id)?.ground() {
        None => Ok(()),
        Some(_) => Err(Error::Argument("it is a ground, which stays where the scene has it: leave it out".into())),
    }
}

/// Whether an object is in a set.
pub(crate) fn holds(set: &ObjectSet, id: ObjectId) -> bool {
    set.ids.contains(&id)
}
