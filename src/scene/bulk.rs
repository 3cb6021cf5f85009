//! Many objects added or removed at once: all of them, or none.

use std::sync::Arc;

#[cfg(doc)]
use crate::base::error::Error;
use crate::base::error::Result;
use crate::base::memory::{collected, with_capacity};
use crate::scene::change::Change;
use crate::scene::door::Scene;
use crate::scene::world::object::{ObjectId, ObjectOptions};
use crate::shape::Shape;

impl Scene {
    /// Adds an object of one convex piece for each of the shapes, in their order, as [`Scene::add_object`] does; `options` has as
    /// many. Either all are added or none.
    ///
    /// # Errors
    /// [`Error::Argument`] unless there are as many options as shapes; [`Error::Pose`], [`Error::Limit`], [`Error::Memory`] same
    /// as for [`Scene::add_object`], naming the first that is refused. Nothing is added then.
    pub fn add_shapes(&mut self, shapes: &[Arc<Shape>], options: &[ObjectOptions]) -> Result<Vec<ObjectId>> {
        self.world.check_additions(shapes.len(), options)?;
        let mut ids = with_capacity(shapes.len())?;
        self.near.reserve(shapes.len())?;
        self.world.reserve(shapes.len())?;
        for (shape, options) in shapes.iter().zip(options) {
            let pieces = std::slice::from_ref(shape);
            ids.extend(self.change(Change::Object { pieces: pieces.into(), options: *options })?);
        }
        Ok(ids)
    }

    /// Removes objects and their pairs as [`Scene::remove_object`] does: either all or none.
    ///
    /// # Errors
    /// [`Error::Handle`] for an id that is null, stale or another scene's, [`Error::Argument`] for one that is given twice, naming
    /// the first that is refused; [`Error::Memory`]. Nothing is removed then.
    pub fn remove_objects(&mut self, ids: &[ObjectId]) -> Result<()> {
        let mut sorted = collected((0..).zip(ids).map(|(k, id): (usize, _)| (id.to_bits(), k)))?;
        sorted.sort_unstable();
        self.world.check_removals(ids, &sorted)?;
        ids.iter().try_for_each(|id| self.remove_object(*id))
    }
}
