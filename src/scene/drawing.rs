//! A scene drawn as it is: objects, boxes, near pairs, and the results of its last query.

use crate::base::math::{Pose, Vector};
use crate::base::simd::environment::with_default;
use crate::draw::{Draw, DrawKind, Pen};
use crate::pair::{Outcome, SignedDistance};
use crate::scene::door::Scene;
use crate::scene::search::query::{PairResult, SceneAnswer};
use crate::scene::world::testing::Testing;

impl Scene {
    /// Draws the edges and the box of each object, grounds too, and of the last query the near pairs that are tested and the listed
    /// results: witness points, normals and contact points, as far as the query gave them.
    pub fn draw(&self, draw: &mut dyn Draw) {
        with_default(|| {
            let mut pen = Pen::new(draw);
            self.draw_objects(&mut pen);
            self.draw_near_pairs(&mut pen);
            self.draw_results(&mut pen);
        });
    }

    fn draw_objects(&self, pen: &mut Pen) {
        for object in self.objects() {
            if pen.wants(DrawKind::Edge) {
                if let Some(ground) = object.ground() {
                    pen.ground(ground.at(object.pose()));
                }
                for (piece, shape) in object.pieces().iter().enumerate() {
                    pen.shape(shape.at(&object.piece_pose_in_world(piece)));
                }
                if let Some(compound) = object.compound() {
                    let pieces = compound.at(object.pose()).placed_pieces();
                    for number in 0..pieces.count() as u32 {
                        let mut room = Pose::IDENTITY;
                        pen.shape(pieces.piece(number, &mut room));
                    }
                }
            }
            if pen.wants(DrawKind::Box) {
                let corners = object.world_box();
                let corner = |bits: usize| Vector::from_fn(|axis, _| corners[bits >> axis & 1][axis]);
                for start in 0..8_usize {
                    for end in [1, 2, 4].map(|bit| start | bit).into_iter().filter(|end| *end != start) {
                        pen.line(DrawKind::Box, corner(start), corner(end));
                    }
                }
            }
        }
    }

    fn draw_near_pairs(&self, pen: &mut Pen) {
        let proxies = &self.world.proxies;
        for pair in self.near.list.pairs.iter().filter(|pair| pair.testing == Testing::Active) {
            let [first, second] = pair.proxies.map(|proxy| proxy as usize);
            if !proxies.is_gone(first) && !proxies.is_gone(second) {
                let [centre1, centre2] = [first, second].map(|proxy| Vector::from(proxies.spheres(proxy).centre));
                pen.line(DrawKind::NearPair, centre1, centre2);
            }
        }
    }

    fn draw_results(&self, pen: &mut Pen) {
        let SceneAnswer { pairs, found, contacts, .. } = self.search.answer();
        for (number, PairResult { answer, .. }) in found.into_iter().chain(pairs).enumerate() {
            let contact = contacts.contacts.get(number);
            match contact.filter(|contact| contact.depth.outcome == Outcome::Intersecting) {
                Some(contact) => pen.witness(&SignedDistance::from(&contact.depth)),
                None => pen.witness(&SignedDistance::from(answer)),
            }
            pen.contacts(contact.map_or(&[], |contact| contacts.points_of(contact)));
        }
    }
}
