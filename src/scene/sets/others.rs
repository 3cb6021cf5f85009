//! All pieces that are in no set: those in the trees, and those that have to be gone through one by one.

use crate::base::error::Result;
use crate::base::memory::{extend, push};
use crate::pair::Placed;
use crate::scene::near::tree::{Branch, Held, Tree};
use crate::scene::sets::members::{ObjectSet, PieceSide, holds};
use crate::scene::world::boxes::Aabb;
use crate::scene::world::content::World;

/// The world, its trees while they are fitted, and whom the question leaves out.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Others<'a> {
    pub world: &'a World,
    pub trees: Option<&'a [Tree; 2]>,
    pub set: &'a ObjectSet<'a>,
}

impl<'a> Others<'a> {
    /// Whether a piece is one of them, and not gone.
    pub fn has(&self, proxy: usize) -> bool {
        let label = &self.world.proxies.labels[proxy];
        !label.is_gone() && !holds(self.set, label.object)
    }

    /// Whether a piece that a tree holds is one of them and in its box.
    pub fn has_in_tree(&self, proxy: usize) -> bool {
        !self.world.proxies.motions[proxy].has_escaped && self.has(proxy)
    }

    /// Those that are in no tree: some that have escaped, or all.
    pub fn loose(&self) -> impl Iterator<Item = usize> + use<'a> {
        let others = *self;
        let escaped = others.trees.map_or(&[][..], |_| &others.world.proxies.escaped);
        let all = if others.trees.is_some() { 0..0 } else { 0..others.world.proxies.len() };
        escaped.iter().map(|&proxy| proxy as usize).chain(all).filter(move |&proxy| others.has(proxy))
    }

    /// A box that a piece is in.
    pub fn box_of(&self, proxy: usize) -> &'a Aabb {
        let is_in_tree = self.trees.is_some() && !self.world.proxies.motions[proxy].has_escaped;
        if is_in_tree { &self.world.proxies.boxes[proxy] } else { &Aabb::EVERYWHERE }
    }

    /// A piece where the scene has it.
    pub fn placed(&self, proxy: usize) -> Placed<'a> {
        self.world.proxies.shapes[proxy].at(&self.world.proxies.poses[proxy])
    }

    /// A piece where the scene has it, as one of a pair.
    pub fn side(&self, proxy: usize) -> PieceSide<'a> {
        PieceSide { proxy: proxy as u32, spheres: self.world.proxies.spheres(proxy), placed: self.placed(proxy) }
    }

    /// Lists those whose boxes pass a test that no box within one that fails passes, and all loose ones, in order of creation.
    ///
    /// # Errors
    /// [`Error::Memory`](crate::base::error::Error::Memory).
    pub fn list(&self, open: &mut Vec<Branch>, found: &mut Vec<u32>, test: impl Fn(&Aabb) -> bool) -> Result<()> {
        found.clear();
        extend(found, self.loose().map(|proxy| proxy as u32))?;
        let boxes = &self.world.proxies.boxes;
        for tree in self.trees.into_iter().flatten() {
            open.clear();
            extend(open, tree.root())?;
            while let Some(branch) = open.pop() {
                if !test(tree.bounds(branch, boxes)) {
                    continue;
                }
                match tree.held(branch) {
                    Held::Proxy(proxy) if self.has_in_tree(proxy as usize) => push(found, proxy)?,
                    Held::Proxy(_) => {}
                    Held::Branches([left, right]) => {
                        push(open, left)?;
                        push(open, right)?;
                    }
                }
            }
        }
        found.sort_unstable();
        Ok(())
    }
}
