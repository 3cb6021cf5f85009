//! Objects and their pieces put elsewhere.

use std::ops::Range;

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::base::memory::{filled, with_capacity};
use crate::base::simd::environment::{is_default, with_default};
use crate::base::workers::Workers;
use crate::placed::frame::is_rigid_in_range;
use crate::scene::world::content::World;
use crate::scene::world::object::{Arrangement, Entry, ObjectId, ObjectTable};
use crate::scene::world::proxies::Proxies;
use crate::scene::world::rows::Rows;

impl World {
    /// Moves an object.
    ///
    /// # Errors
    /// See [`Scene::set_pose`](crate::scene::Scene::set_pose).
    pub fn set_pose(&mut self, id: ObjectId, pose: &Pose) -> Result<()> {
        if !is_default() {
            return with_default(move || self.set_pose(id, pose));
        }
        let object = self.objects.get_mut(id)?;
        if let Some(proxy) = object.only_proxy()
            && self.proxies.may_stay_behind(proxy)
            && is_rigid_in_range(pose)
        {
            self.proxies.put(proxy, pose, self.passes);
            return Ok(());
        }
        let defect = check(object, pose)?;
        put(object, pose, defect, &mut self.proxies, self.passes);
        Ok(())
    }

    /// Moves objects, each to its pose.
    ///
    /// # Errors
    /// See [`Scene::set_poses`](crate::scene::Scene::set_poses).
    pub fn set_poses(&mut self, ids: &[ObjectId], poses: &[Pose], workers: &Workers) -> Result<()> {
        if ids.len() != poses.len() {
            return Err(Error::Argument(format!("{} poses for {} objects", poses.len(), ids.len())));
        }
        self.put_all(&Batch { ids, poses, first: 0, count: ids.len() }, workers)
    }

    /// Moves all objects that are not fixed.
    ///
    /// # Errors
    /// See [`Scene::set_all_poses`](crate::scene::Scene::set_all_poses).
    pub fn set_all_poses(&mut self, poses: &[Pose], workers: &Workers) -> Result<()> {
        let mut ids = with_capacity(self.objects.len())?;
        let first_rows = (0..self.proxies.len()).filter(|&row| self.proxies.leads_movable(row));
        ids.extend(first_rows.map(|row| self.proxies.labels[row].object));
        let count = ids.len();
        if poses.len() != count {
            return Err(Error::Argument(format!("{} poses for {count} objects that are not fixed", poses.len())));
        }
        self.put_all(&Batch { ids: &ids, poses, first: 0, count }, workers)
    }

    /// Moves all objects of a batch, or none.
    fn put_all(&mut self, batch: &Batch, workers: &Workers) -> Result<()> {
        if workers.share(batch.count) {
            if let Some(parts) = self.checked_parts(batch, workers)? {
                return self.put_in_parts(batch, &parts, workers);
            }
        } else {
            with_default(|| batch.check(&self.objects))?;
        }
        let (objects, proxies, passes) = (&mut self.objects, &mut self.proxies, self.passes);
        with_default(|| {
            batch.ids.iter().zip(batch.poses).try_for_each(|(id, pose)| {
                put(objects.get_mut(*id)?, pose, pose.rotation_defect(), proxies, passes);
                Ok(())
            })
        })
    }

    /// A batch in parts if none of it is refused; none where their objects are not in order of creation.
    fn checked_parts<'a>(&self, batch: &Batch<'a>, workers: &Workers) -> Result<Option<Vec<Part<'a>>>> {
        let size = workers.part_size(batch.count);
        let check = |batch: Batch| batch.check(&self.objects);
        let checked = workers.map(batch.cut(size), check)?;
        let mut parts: Vec<Part> = with_capacity(checked.len())?;
        let mut are_in_order = true;
        for (batch, rows) in batch.cut(size).zip(checked) {
            match rows? {
                Some(rows) if parts.last().is_none_or(|last| last.rows.end <= rows.start) => {
                    parts.push(Part { batch, rows });
                }
                _ => are_in_order = false,
            }
        }
        Ok(are_in_order.then_some(parts))
    }

    /// Moves all objects of a batch, checked and in parts.
    fn put_in_parts(&mut self, batch: &Batch, parts: &[Part], workers: &Workers) -> Result<()> {
        let (objects, passes) = (&self.objects, self.passes);
        self.proxies.settle();
        // Said first, as a panic of the program's threads may end the call.
        self.proxies.misses_escaped = true;
        let rows = self.proxies.rows();
        let ends = parts.iter().skip(1).map(|next| next.rows.start).chain([rows.len()]);
        let put = |(part, mut rows): (&Part, Rows)| {
            part.batch.ids.iter().zip(part.batch.poses).try_for_each(|(id, pose)| {
                // Which have left their boxes is listed later.
                let place = |proxy, pose: &Pose, defect| _ = rows.place(proxy, pose, defect, passes);
                for_each_piece(objects.get(*id)?, pose, pose.rotation_defect(), place);
                Ok(())
            })
        };
        workers.map(parts.iter().zip(rows.cut_at_each(ends)), put)?.into_iter().collect::<Result<()>>()?;
        batch.ids.iter().zip(batch.poses).try_for_each(|(id, pose)| {
            self.objects.get_mut(*id)?.stand_at(pose);
            Ok(())
        })
    }

    /// Moves one piece within its object.
    ///
    /// # Errors
    /// See [`Scene::set_piece_pose`](crate::scene::Scene::set_piece_pose).
    pub fn set_piece_pose(&mut self, id: ObjectId, piece: u32, pose: &Pose) -> Result<()> {
        let at = piece as usize;
        self.view().get(id)?.refuse_absent(at)?;
        let object = self.objects.get_mut(id)?;
        let own = object.proxies();
        let (proxies, passes) = (&mut self.proxies, self.passes);
        with_default(|| {
            pose.check()?;
            let whole = object.arrangement.as_ref().map_or(proxies.poses[own.start], |arrangement| arrangement.pose);
            let world = whole.after(pose);
            let defect = world.checked_defect()?;
            let arrangement = match &mut object.arrangement {
                Some(arrangement) => arrangement,
                none => {
                    let piece_poses = filled(Pose::IDENTITY, own.len())?;
                    none.insert(Box::new(Arrangement { pose: whole, piece_poses, compound: None }))
                }
            };
            arrangement.piece_poses[at] = *pose;
            proxies.place(own.start + at, &world, defect, passes);
            Ok(())
        })
    }

    /// Gives an object the piece poses of another one, none or one for each piece, which were accepted with its pose.
    pub fn put_pieces(&mut self, id: ObjectId, piece_poses: Vec<Pose>) -> Result<()> {
        if piece_poses.is_empty() {
            return Ok(());
        }
        let object = self.objects.get_mut(id)?;
        let pose = self.proxies.poses[object.first_proxy as usize];
        object.arrangement = Some(Box::new(Arrangement { pose, piece_poses, compound: None }));
        with_default(|| put(object, &pose, pose.rotation_defect(), &mut self.proxies, self.passes));
        Ok(())
    }
}

/// Objects and where each is to go, some of `count`; number `first` is the first of them.
struct Batch<'a> {
    ids: &'a [ObjectId],
    poses: &'a [Pose],
    first: usize,
    count: usize,
}

/// A batch whose objects are in order of creation, and in which rows they are.
struct Part<'a> {
    batch: Batch<'a>,
    rows: Range<usize>,
}

impl<'a> Batch<'a> {
    /// Batches of this size.
    fn cut(&self, size: usize) -> impl Iterator<Item = Batch<'a>> {
        let (first, count) = (self.first, self.count);
        let parts = self.ids.chunks(size).zip(self.poses.chunks(size));
        (first..).step_by(size).zip(parts).map(move |(first, (ids, poses))| Batch { ids, poses, first, count })
    }

    /// Refuses poses that are not accepted; gives the rows of all objects if these are in order of creation.
    fn check(&self, objects: &ObjectTable) -> Result<Option<Range<usize>>> {
        let mut rows = None;
        let mut are_in_order = true;
        for (k, (id, pose)) in (self.first..).zip(self.ids.iter().zip(self.poses)) {
            let of = || format!("pose {k} of {}", self.count);
            let object = objects.get(*id).map_err(|e| Error::Handle(format!("{}: {}", of(), e.message())))?;
            check(object, pose).map_err(|e| Error::Pose(format!("{}: {e}", of())))?;
            let own = object.proxies();
            let Range { start, end } = rows.unwrap_or(own.start..own.start);
            are_in_order &= end <= own.start;
            rows = Some(start..own.end);
        }
        Ok(rows.filter(|_| are_in_order))
    }
}

/// Refuses a pose that is not accepted, also of one of the pieces, for which the rotation of both is rounded; gives its defect.
#[inline(always)]
fn check(object: &Entry, pose: &Pose) -> Result<f64> {
    let defect = pose.checked_defect()?;
    if let Some(arrangement) = &object.arrangement {
        arrangement.check(pose)?;
        for (k, piece_pose) in arrangement.piece_poses.iter().enumerate() {
            let world = pose.after(piece_pose);
            world.check().map_err(|e| Error::Pose(format!("with the pose of piece {k}: {}", e.message())))?;
        }
    }
    Ok(defect)
}

/// Puts all pieces of an object elsewhere. `defect` is that of the pose.
#[inline(always)]
fn put(object: &mut Entry, pose: &Pose, defect: f64, proxies: &mut Proxies, passes: u64) {
    object.stand_at(pose);
    for_each_piece(object, pose, defect, |proxy, pose, defect| proxies.place(proxy, pose, defect, passes));
}

/// Calls `place` with each piece of an object that goes to a pose, with the piece's own, and with the defect of that.
#[inline(always)]
fn for_each_piece(object: &Entry, pose: &Pose, defect: f64, mut place: impl FnMut(usize, &Pose, f64)) {
    match &object.arrangement {
        None => object.proxies().for_each(|proxy| place(proxy, pose, defect)),
        Some(arrangement) => {
            for (proxy, piece_pose) in object.proxies().zip(&arrangement.piece_poses) {
                let world = pose.after(piece_pose);
                place(proxy, &world, world.rotation_defect());
            }
        }
    }
}
