//! Objects and their pieces put elsewhere.

use super::Scene;
use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::base::memory::filled;
use crate::base::simd::environment::with_default;
use crate::scene::object::{Arrangement, Entry, ObjectId, composed};
use crate::scene::proxies::Proxies;
use crate::scene::recording::format::Record;

impl Scene {
    /// Moves an object, a fixed one too. For twelve numbers see [`Pose::from_row_major`], for R and T [`Pose::new`].
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Pose`] for a pose that is not accepted;
    /// the object then stays where it is.
    pub fn set_pose(&mut self, id: ObjectId, pose: &Pose) -> Result<()> {
        let object = self.objects.get_mut(id)?;
        let (proxies, passes, limit) = (&mut self.proxies, self.passes, self.rotation_limit);
        with_default(|| {
            let defect = check(object, pose, limit)?;
            place(object, pose, defect, proxies, passes);
            Ok(())
        })?;
        self.note(|notes| notes.write(&Record::Pose(notes.number(id)?, *pose)));
        Ok(())
    }

    /// Moves the objects of these ids, each to its pose. Of an object that is given twice the later pose counts.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there is one pose for each, and as [`Scene::set_pose`]; all objects then stay where they are.
    pub fn set_poses(&mut self, ids: &[ObjectId], poses: &[Pose]) -> Result<()> {
        if ids.len() != poses.len() {
            return Err(Error::Argument(format!("{} poses for {} objects", poses.len(), ids.len())));
        }
        let of = |k: usize| format!("pose {k} of {}", poses.len());
        for (k, (id, pose)) in ids.iter().zip(poses).enumerate() {
            let object = self.objects.get(*id).map_err(|e| Error::Handle(format!("{}: {}", of(k), e.message())))?;
            with_default(|| check(object, pose, self.rotation_limit)).map_err(|e| in_pose(&of(k), &e))?;
        }
        let (proxies, passes) = (&mut self.proxies, self.passes);
        let objects = &mut self.objects;
        with_default(|| {
            ids.iter().zip(poses).try_for_each(|(id, pose)| {
                place(objects.get_mut(*id)?, pose, pose.rotation_defect(), proxies, passes);
                Ok(())
            })
        })?;
        self.note(|notes| notes.write(&Record::Poses(notes.numbers(ids)?.into(), poses.into())));
        Ok(())
    }

    /// Moves all objects that are not fixed, in order of creation.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there is one pose for each, [`Error::Pose`] for a pose that is not accepted; all objects then
    /// stay where they are.
    pub fn set_all_poses(&mut self, poses: &[Pose]) -> Result<()> {
        let count = self.objects().filter(|object| !object.fixed()).count();
        if poses.len() != count {
            return Err(Error::Argument(format!("{} poses for {count} objects that are not fixed", poses.len())));
        }
        let moving = self.objects().filter(|object| !object.fixed());
        for (k, (object, pose)) in moving.zip(poses).enumerate() {
            with_default(|| check(object.entry, pose, self.rotation_limit))
                .map_err(|e| in_pose(&format!("pose {k} of {count}"), &e))?;
        }
        let passes = self.passes;
        with_default(|| {
            let mut proxy = 0;
            for pose in poses {
                while !self.proxies.leads_movable(proxy) {
                    proxy += 1;
                }
                let object = self.objects.get_mut(self.proxies.labels[proxy].object)?;
                place(object, pose, pose.rotation_defect(), &mut self.proxies, passes);
                proxy += 1;
            }
            Ok(())
        })?;
        self.note(|notes| notes.write(&Record::AllPoses(poses.into())));
        Ok(())
    }

    /// Moves one piece within its object: its place in the world is that of the object times `pose`, each of the twelve numbers
    /// rounded; the exact body is the one that these rounded numbers give. Points and features of results are in the piece's own
    /// frame.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Argument`] for a piece that the object does not
    /// have, [`Error::Pose`] for a pose that is not accepted, alone or with the object's, [`Error::Memory`]; the piece then stays
    /// where it is.
    pub fn set_piece_pose(&mut self, id: ObjectId, piece: u32, pose: &Pose) -> Result<()> {
        let object = self.objects.get_mut(id)?;
        let (own, at) = (object.proxies(), piece as usize);
        if at >= own.len() {
            return Err(Error::Argument(format!("piece {piece} of an object of {} pieces", own.len())));
        }
        let (proxies, passes, limit) = (&mut self.proxies, self.passes, self.rotation_limit);
        with_default(|| {
            pose.check(limit)?;
            let whole = object.arrangement.as_ref().map_or(proxies.poses[own.start], |arrangement| arrangement.pose);
            let world = composed(&whole, pose);
            let defect = world.checked_defect(limit)?;
            let arrangement = match &mut object.arrangement {
                Some(arrangement) => arrangement,
                none => {
                    none.insert(Box::new(Arrangement { pose: whole, piece_poses: filled(Pose::IDENTITY, own.len())? }))
                }
            };
            arrangement.piece_poses[at] = *pose;
            proxies.place(own.start + at, &world, defect, passes);
            Ok(())
        })?;
        self.note(|notes| notes.write(&Record::PiecePose { object: notes.number(id)?, piece, pose: *pose }));
        Ok(())
    }

    /// Gives an object the piece poses of another one, none or one for each piece, which were accepted with its pose.
    pub(super) fn put_pieces(&mut self, id: ObjectId, piece_poses: Vec<Pose>) -> Result<()> {
        if piece_poses.is_empty() {
            return Ok(());
        }
        let object = self.objects.get_mut(id)?;
        let (proxies, passes) = (&mut self.proxies, self.passes);
        let pose = proxies.poses[object.first_proxy as usize];
        object.arrangement = Some(Box::new(Arrangement { pose, piece_poses }));
        with_default(|| place(object, &pose, pose.rotation_defect(), proxies, passes));
        Ok(())
    }
}

fn in_pose(which: &str, error: &Error) -> Error {
    Error::Pose(format!("{which}: {error}"))
}

/// Refuses a pose that is not accepted, also of one of the pieces, for which the rotation of both is rounded; gives its defect.
fn check(object: &Entry, pose: &Pose, limit: f64) -> Result<f64> {
    let defect = pose.checked_defect(limit)?;
    if let Some(arrangement) = &object.arrangement {
        for (k, piece_pose) in arrangement.piece_poses.iter().enumerate() {
            let world = composed(pose, piece_pose);
            world.check(limit).map_err(|e| Error::Pose(format!("with the pose of piece {k}: {}", e.message())))?;
        }
    }
    Ok(defect)
}

/// Puts all pieces of an object elsewhere. `defect` is that of the pose.
fn place(object: &mut Entry, pose: &Pose, defect: f64, proxies: &mut Proxies, passes: u64) {
    let own = object.proxies();
    match &mut object.arrangement {
        None => own.for_each(|proxy| proxies.place(proxy, pose, defect, passes)),
        Some(arrangement) => {
            arrangement.pose = *pose;
            for (k, proxy) in own.enumerate() {
                let world = arrangement.in_world(k);
                proxies.place(proxy, &world, world.rotation_defect(), passes);
            }
        }
    }
}
