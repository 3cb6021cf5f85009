//! The contacts of objects in a scene with what is in no scene, a ground or a half-space: piece by piece the answer of the pair
//! layer.

use crate::base::error::Result;
use crate::base::memory::push;
use crate::ground::{GroundContact, GroundContacts, PlacedGround, add_contacts};
use crate::manifold::{ManifoldConfig, ManifoldPoint, add_points, half_space_manifold_into};
use crate::pair::{HalfSpace, Outcome, Placed};
use crate::scene::near::tree::Branch;
use crate::scene::sets::members::{self, Boxes, Member, ObjectSet};
use crate::scene::sets::others::Others;
use crate::scene::world::boxes::{Aabb, above, below};
use crate::scene::world::object::ObjectId;
use crate::scene::world::rows::{Label, Spheres};

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
    /// Which piece.
    pub piece: u32,
    /// As of the pair; its points are among those of all contacts. Of a half-space all bits of the triangle are set.
    pub contact: GroundContact,
}

/// The contacts of a scene's objects with a ground or a half-space.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SceneGroundContacts<'a> {
    /// By object, piece and triangle.
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
    pub floor: Floor<'a>,
    pub config: &'a ManifoldConfig,
    pub filter: GroupFilter,
}

/// The room that the question is worked in, and the findings.
pub(crate) struct SetGroundRoom<'a> {
    pub members: &'a mut Vec<Member>,
    pub open: &'a mut Vec<Branch>,
    pub rows: &'a mut Vec<u32>,
    pub ground: &'a mut GroundContacts,
    pub contacts: &'a mut Vec<SceneGroundContact>,
}

/// Lists all contacts of all objects, those of objects in order of creation, or of the set in its order.
///
/// # Errors
/// As `ground::ground_contacts` and `manifold::half_space_manifold`, and for
/// the set as [`members::list`].
pub(crate) fn find(question: GroundQuestion, room: &mut SetGroundRoom) -> Result<()> {
    let GroundQuestion { others, set, floor, config, filter } = question;
    let SetGroundRoom { members, open, rows, ground, contacts } = room;
    contacts.clear();
    ground.points.clear();
    let within = Within::new(floor, config)?;
    // The scene has checked its poses.
    let mut asking = Asking { floor, config: *config, within: &within, ground, contacts };
    let proxies = &others.world.proxies;
    let is_tested = |label: &Label| label.groups & filter.mask != 0 && filter.groups & label.mask != 0;
    let Some(set) = set else {
        others.list(open, rows, |bounds| within.may_reach(bounds))?;
        for row in rows.iter().map(|row| *row as usize) {
            let label = &proxies.labels[row];
            if is_tested(label) && !label.fixed {
                asking.ask(label, &proxies.spheres(row), others.placed(row))?;
            }
        }
        return Ok(());
    };
    members::list(others.world, set, Boxes::Made, members)?;
    for member in &**members {
        let label = &proxies.labels[member.proxy as usize];
        if is_tested(label) && (!label.fixed || set.poses.is_some()) && within.may_reach(&member.bounds) {
            asking.ask(label, &member.spheres, member.placed(others.world))?;
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

/// Asks of one piece after the other.
struct Asking<'a> {
    floor: Floor<'a>,
    config: ManifoldConfig,
    within: &'a Within<'a>,
    ground: &'a mut GroundContacts,
    contacts: &'a mut Vec<SceneGroundContact>,
}

impl Asking<'_> {
    fn ask(&mut self, label: &Label, spheres: &Spheres, body: Placed) -> Result<()> {
        if !self.within.may_reach_ball(spheres) {
            return Ok(());
        }
        let Asking { config, ground, .. } = self;
        ground.contacts.clear();
        match self.floor {
            Floor::Ground(placed) => add_contacts(body, placed, config, ground)?,
            Floor::HalfSpace(half_space) => {
                let first_point = ground.points.len();
                let points = &mut ground.points;
                let manifold = add_points(points, |sink| half_space_manifold_into(body, half_space, config, sink))??;
                if manifold.outcome != Outcome::Beyond {
                    push(&mut ground.contacts, GroundContact { manifold, triangle: u32::MAX, first_point })?;
                }
            }
        }
        let &Label { object, user_data, piece, .. } = label;
        for &contact in &ground.contacts {
            push(self.contacts, SceneGroundContact { object, user_data, piece, contact })?;
        }
        Ok(())
    }
}
