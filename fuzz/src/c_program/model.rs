//! What a scene should hold and which pairs it should test, said as plainly as can be.

use std::collections::HashSet;

use swiftprox::ffi::scene::SceneHandle;
use swiftprox::object::ObjectId;

/// An object as the model knows it.
#[derive(Clone)]
pub struct Object {
    pub id: ObjectId,
    pub pieces: usize,
    pub fixed: bool,
    pub user_data: u64,
}

/// A scene and what it should hold.
pub struct Scene {
    pub handle: *mut SceneHandle,
    pub objects: Vec<Object>,
    /// Pairs of objects that were deactivated, the earlier one first.
    pub inactive: HashSet<[ObjectId; 2]>,
}

impl Scene {
    /// An empty one.
    pub fn new(handle: *mut SceneHandle) -> Scene {
        Scene { handle, objects: Vec::new(), inactive: HashSet::new() }
    }

    pub fn is_tested(&self, a: &Object, b: &Object) -> bool {
        !(a.fixed && b.fixed) && !self.inactive.contains(&[a.id, b.id])
    }

    /// The pairs that queries test: objects and pieces, in the order of results.
    pub fn tested(&self) -> Vec<([ObjectId; 2], [u32; 2], [u64; 2])> {
        let mut pairs = Vec::new();
        for (i, a) in self.objects.iter().enumerate() {
            for b in self.objects[i + 1..].iter().filter(|b| self.is_tested(a, b)) {
                for piece1 in 0..a.pieces as u32 {
                    let with = |piece2| ([a.id, b.id], [piece1, piece2], [a.user_data, b.user_data]);
                    pairs.extend((0..b.pieces as u32).map(with));
                }
            }
        }
        pairs
    }

    /// Says of all pairs that `chosen` picks whether they are active.
    pub fn activate(&mut self, active: bool, chosen: impl Fn(&Object, &Object) -> bool) {
        for (i, a) in self.objects.iter().enumerate() {
            for b in self.objects[i + 1..].iter().filter(|b| chosen(a, b)) {
                if active {
                    self.inactive.remove(&[a.id, b.id]);
                } else {
                    self.inactive.insert([a.id, b.id]);
                }
            }
        }
    }

    pub fn find(&self, id: ObjectId) -> Option<usize> {
        self.objects.iter().position(|object| object.id == id)
    }
}
