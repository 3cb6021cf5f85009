//! The contacts of objects in a scene with its grounds, or with what is in no scene, a ground or a half-space: piece by piece the
//! answer of the pair layer.

use std::sync::Arc;

use crate::base::error::{Error, Result};
use crate::base::math::Pose;
use crate::base::memory::{extend, push};
use crate::compound::{Compound, PlacedCompound};
use crate::ground::{GroundContact, GroundContacts, PlacedGround, add_contacts};
use crate::manifold::{ManifoldConfig, ManifoldPoint, add_points, half_space_manifold_into};
use crate::pair::{HalfSpace, Outcome, Placed};
use crate::scene::near::tree::Branch;
use crate::scene::sets::members::{self, Boxes, Member, ObjectSet};
use crate::scene::sets::others::Others;
use crate::scene::world::boxes::{Aabb, above, below};
use crate::scene::world::object::ObjectId;
use crate::scene::world::rows::{Label, Spheres, placed};

/// The groups that something is in which is in no scene, and those that it is tested against, as of an object: it is asked about an
/// object if the mask of each has a bit of the other's groups.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(C)]
pub struct GroupFilter {
    /// One bit for each group; the default is the first.
    pub groups: u32,
    /// One bit for each group; the default is all.
    pub mask: u32,
}

impl Default for GroupFilter {
    fn default() -> Self {
        GroupFilter { groups: 1, mask: u32::MAX }
    }
}

/// One contact of a piece, which is object 1, with a ground or a half-space.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[repr(C)]
pub struct SceneGroundContact {
    /// The object.
    pub object: ObjectId,
    /// The caller's own number of the object.
    pub user_data: u64,
    /// The ground's object; null for what is in no scene.
    pub ground: ObjectId,
    /// Which piece.
    pub piece: u32,
    /// As of the pair; its points are among those of all contacts. Of a half-space all bits of the triangle are set.
    pub contact: GroundContact,
}

/// The contacts of a scene's objects with a ground or a half-space.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SceneGroundContacts<'a> {
    /// By object, piece, ground and triangle.
    pub contacts: &'a [SceneGroundContact],
    /// The points, those of each contact together.
    pub points: &'a [ManifoldPoint],
}

/// The ground or half-space that objects may meet.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Floor<'a> {
    Ground(PlacedGround<'a>),
    HalfSpace(&'a HalfSpace),
}

/// The question: about all objects, or about a set, which `others` leave out.
#[derive(Clone, Copy)]
pub(crate) struct GroundQuestion<'a> {
    pub others: Others<'a>,
    pub set: Option<&'a ObjectSet<'a>>,
    /// None: the grounds of the scene.
    pub floor: Option<(Floor<'a>, GroupFilter)>,
    pub config: &'a ManifoldConfig,
}

/// The room that the question is worked in, and the findings.
pub(crate) struct SetGroundRoom<'a> {
    pub members: &'a mut Vec<Member>,
    pub open: &'a mut Vec<Branch>,
    pub rows: &'a mut Vec<u32>,
    pub near: &'a mut Vec<[u32; 2]>,
    pub ground: &'a mut GroundContacts,
    pub contacts: &'a mut Vec<SceneGroundContact>,
}

/// Lists all contacts of all objects, those of objects in order of creation, or of the set in its order.
///
/// # Errors
/// As `ground::ground_contacts` and `manifold::half_space_manifold`, and for
/// the set as [`members::list`].
pub(crate) fn find(question: GroundQuestion, room: &mut SetGroundRoom) -> Result<()> {
    let GroundQuestion { others, set, floor, config } = question;
    room.contacts.clear();
    room.ground.points.clear();
    if let Some(set) = set {
        members::list(others.world, set, Boxes::Made, room.members)?;
        for (k, id) in set.ids.iter().enumerate() {
            let named = |error: Error| error.about(&format!("object {k} of {} of the set", set.ids.len()));
            members::refuse_ground(others.world, *id).map_err(named)?;
        }
    }
    let Some((floor, filter)) = floor else {
        return find_of_scene(&others, set, config, room);
    };
    let SetGroundRoom { members, open, rows, ground, contacts, .. } = room;
    let floor = &AskedFloor { floor, within: Within::new(floor, config)? };
    let within = &floor.within;
    // The scene has checked its poses.
    let mut asking = Asking { config: *config, ground, contacts };
    let proxies = &others.world.proxies;
    let is_tested = |label: &Label| label.groups & filter.mask != 0 && filter.groups & label.mask != 0;
    let Some(set) = set else {
        others.list(open, rows, |bounds| within.may_reach(bounds))?;
        for row in rows.iter().map(|row| *row as usize) {
            let label = &proxies.labels[row];
            if is_tested(label) && !label.fixed {
                asking.ask_row(
                    floor,
                    proxies.bodies.compound(row),
                    label,
                    (&proxies.spheres(row), others.placed(row)),
                )?;
            }
        }
        return Ok(());
    };
    for member in &**members {
        let label = &proxies.labels[member.proxy as usize];
        if is_tested(label) && (!label.fixed || set.poses.is_some()) && within.may_reach(&member.bounds) {
            let compound = proxies.bodies.compound(member.proxy as usize);
            asking.ask_row(floor, compound, label, (&member.spheres, member.placed(others.world)))?;
        }
    }
    Ok(())
}

/// The same with the grounds of the scene, for the pairs that queries test.
fn find_of_scene(
    others: &Others,
    set: Option<&ObjectSet>,
    config: &ManifoldConfig,
    room: &mut SetGroundRoom,
) -> Result<()> {
    config.check()?;
    let SetGroundRoom { members, open, rows, near, ground: found, contacts } = room;
    let (world, proxies) = (others.world, &others.world.proxies);
    near.clear();
    for (row, ground) in proxies.bodies.grounds() {
        let within = Within::new(Floor::Ground(ground.at(&proxies.poses[row])), config)?;
        match set {
            None => {
                others.list(open, rows, |bounds| within.may_reach(bounds))?;
                extend(near, rows.iter().map(|body| [*body, row as u32]))?;
            }
            Some(_) => {
                let reached = (0..).zip(&**members).filter(|(_, member)| within.may_reach(&member.bounds));
                extend(near, reached.map(|(k, _)| [k, row as u32]))?;
            }
        }
    }
    near.sort_unstable();
    let has_moved = set.is_some_and(|set| set.poses.is_some());
    let mut asking = Asking { config: *config, ground: found, contacts };
    for [body, row] in near.iter().map(|pair| pair.map(|k| k as usize)) {
        let (proxy, placed) = match set {
            None => (body, others.placed(body)),
            Some(_) => (members[body].proxy as usize, members[body].placed(world)),
        };
        if let Some(ground) = proxies.bodies.ground(row)
            && world.is_tested([proxy, row], has_moved)
        {
            let (at, id, label) = (ground.at(&proxies.poses[row]), proxies.labels[row].object, &proxies.labels[proxy]);
            let Some(compound) = proxies.bodies.compound(proxy) else {
                asking.ask_ground(at, id, label, placed)?;
                continue;
            };
            for_each_piece(compound.at(placed.pose), label, |label, piece| asking.ask_ground(at, id, label, piece))?;
        }
    }
    Ok(())
}

/// A test for pieces that are provably not within `max_distance` of a ground or a half-space.
enum Within<'a> {
    /// The ground is in this box, grown by `max_distance`.
    Box(Aabb),
    HalfSpace {
        half_space: &'a HalfSpace,
        max_distance: f64,
    },
}

impl<'a> Within<'a> {
    /// # Errors
    /// The test for the floor and the `max_distance` that are asked for.
    fn new(floor: Floor<'a>, config: &ManifoldConfig) -> Result<Within<'a>> {
        config.check()?;
        Ok(match floor {
            Floor::Ground(ground) => {
                ground.pose.check()?;
                let [lower, upper] = ground.world_box();
                let (lower, upper) = (lower.add_scalar(-config.max_distance), upper.add_scalar(config.max_distance));
                Within::Box(Aabb { lower: lower.map(below).into(), upper: upper.map(above).into() })
            }
            Floor::HalfSpace(half_space) => {
                half_space.check()?;
                Within::HalfSpace { half_space, max_distance: config.max_distance }
            }
        })
    }

    fn may_reach(&self, bounds: &Aabb) -> bool {
        match self {
            Within::Box(grown) => bounds.overlaps(grown),
            Within::HalfSpace { half_space, max_distance } => {
                // A NaN proves nothing.
                !(half_space.gap_of_box(bounds.lower.map(f64::from), bounds.upper.map(f64::from)) > *max_distance)
            }
        }
    }

    /// The same of a ball, closer than its box. For a ground, a walk down its tree tells as much.
    fn may_reach_ball(&self, spheres: &Spheres) -> bool {
        match self {
            Within::Box(_) => true,
            Within::HalfSpace { half_space, max_distance } => {
                !(half_space.gap_of_box(spheres.centre, spheres.centre) - f64::from(spheres.outer) > *max_distance)
            }
        }
    }
}

/// What is asked of each piece.
struct AskedFloor<'a> {
    floor: Floor<'a>,
    within: Within<'a>,
}

/// Asks of one piece after the other.
struct Asking<'a> {
    config: ManifoldConfig,
    ground: &'a mut GroundContacts,
    contacts: &'a mut Vec<SceneGroundContact>,
}

/// Calls `ask` with each piece of a compound where it is, and with the label of it.
fn for_each_piece(
    body: PlacedCompound,
    label: &Label,
    mut ask: impl FnMut(&Label, Placed) -> Result<()>,
) -> Result<()> {
    let pieces = body.placed_pieces();
    for piece in 0..pieces.count() as u32 {
        let mut own = Pose::IDENTITY;
        ask(&Label { piece, ..*label }, pieces.piece(piece, &mut own))?;
    }
    Ok(())
}

impl Asking<'_> {
    /// Asks of a piece, or of all pieces of a compound.
    fn ask_row(
        &mut self,
        asked: &AskedFloor,
        compound: Option<&Arc<Compound>>,
        label: &Label,
        (spheres, body): (&Spheres, Placed),
    ) -> Result<()> {
        let Some(compound) = compound else { return self.ask(asked, label, spheres, body) };
        if !asked.within.may_reach_ball(spheres) {
            return Ok(());
        }
        for_each_piece(compound.at(body.pose), label, |label, piece| {
            let (spheres, _) = placed(piece.shape, piece.pose, piece.pose.rotation_defect());
            self.ask(asked, label, &spheres, piece)
        })
    }

    fn ask(&mut self, asked: &AskedFloor, label: &Label, spheres: &Spheres, body: Placed) -> Result<()> {
        if !asked.within.may_reach_ball(spheres) {
            return Ok(());
        }
        let Asking { config, ground, .. } = self;
        match asked.floor {
            Floor::Ground(placed) => return self.ask_ground(placed, ObjectId::NULL, label, body),
            Floor::HalfSpace(half_space) => {
                ground.contacts.clear();
                let first_point = ground.points.len();
                let points = &mut ground.points;
                let manifold = add_points(points, |sink| half_space_manifold_into(body, half_space, config, sink))??;
                if manifold.outcome != Outcome::Beyond {
                    push(&mut ground.contacts, GroundContact { manifold, triangle: u32::MAX, first_point })?;
                }
            }
        }
        self.list(ObjectId::NULL, label)
    }

    fn ask_ground(&mut self, placed: PlacedGround, id: ObjectId, label: &Label, body: Placed) -> Result<()> {
        self.ground.contacts.clear();
        add_contacts(body, placed, &self.config, self.ground)?;
        self.list(id, label)
    }

    /// Lists the contacts that were found last.
    fn list(&mut self, ground: ObjectId, label: &Label) -> Result<()> {
        let &Label { object, user_data, piece, .. } = label;
        for &contact in &self.ground.contacts {
            push(self.contacts, SceneGroundContact { object, user_data, ground, piece, contact })?;
        }
        Ok(())
    }
}
