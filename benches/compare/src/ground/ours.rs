//! This library's contacts of bodies with a ground.

use swiftprox::ground::{Ground, GroundContacts, ground_contacts};
use swiftprox::manifold::ManifoldConfig;
use swiftprox::math::Pose;
use swiftprox::shape::Shape;

use super::scenes::{BODIES, MARGIN};
use super::{Counted, Grounded, is_ghost};

pub const NAME: &str = "swiftprox";

/// All points of a contact, or four of them.
pub struct Ours<'a> {
    ground: Ground,
    shape: &'a Shape,
    poses: &'a [Pose],
    config: ManifoldConfig,
    found: GroundContacts,
}

impl<'a> Ours<'a> {
    pub fn new(ground: Ground, shape: &'a Shape, poses: &'a [Pose]) -> Ours<'a> {
        let config = ManifoldConfig { max_distance: MARGIN, ..ManifoldConfig::default() };
        Ours { ground, shape, poses, config, found: GroundContacts::default() }
    }
}

impl Grounded for Ours<'_> {
    fn name(&self) -> &'static str {
        NAME
    }

    fn forget(&mut self) {}

    fn ask(&mut self, i: usize) {
        let body = self.shape.at(&self.poses[i]);
        if let Err(error) = ground_contacts(body, self.ground.at(&Pose::IDENTITY), &self.config, &mut self.found) {
            panic!("body {} at step {}: {error}", i % BODIES, i / BODIES);
        }
    }

    fn counted(&self) -> Counted {
        let ghosts = self.found.contacts.iter().filter(|contact| is_ghost(contact.manifold.normal[2]));
        Counted { normals: self.found.contacts.len(), points: self.found.points.len(), ghosts: ghosts.count() }
    }
}
