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
    pub groups: u32,
    pub mask: u32,
}

/// A scene and what it should hold.
pub struct Scene {
    pub handle: *mut SceneHandle,
    pub objects: Vec<Object>,
    /// Pairs of objects that were deactivated, the earlier one first.
    pub inactive: HashSet<[ObjectId; 2]>,
    /// The remainder by 3 of the sum of ids that the filter refuses.
    pub refused: Option<u64>,
    /// The program's own pairs.
    pub given: Option<Vec<[ObjectId; 2]>>,
}

impl Scene {
    /// An empty one.
    pub fn new(handle: *mut SceneHandle) -> Scene {
        Scene { handle, objects: Vec::new(), inactive: HashSet::new(), refused: None, given: None }
    }

    /// Filters of objects and activation aside from the program's own word.
    pub fn is_active(&self, a: &Object, b: &Object) -> bool {
        let may_meet = !(a.fixed && b.fixed) && a.groups & b.mask != 0 && b.groups & a.mask != 0;
        may_meet && !self.inactive.contains(&[a.id, b.id])
    }

    pub fn is_tested(&self, a: &Object, b: &Object) -> bool {
        let is_given = |given: &Vec<[ObjectId; 2]>| given.contains(&[a.id, b.id]) || given.contains(&[b.id, a.id]);
        self.is_active(a, b)
            && !self.refused.is_some_and(|remainder| refuses(remainder, a.id, b.id))
            && self.given.as_ref().is_none_or(is_given)
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

/// What the filter says no to.
pub fn refuses(remainder: u64, a: ObjectId, b: ObjectId) -> bool {
    (a.to_bits() % 3 + b.to_bits() % 3) % 3 == remainder
}
