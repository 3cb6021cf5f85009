//! Calls about half-spaces and grounds.

use std::ptr::null;

use arbitrary::{Result, Unstructured};
use swiftprox::ffi::StatusCode;
use swiftprox::ffi::depth::*;
use swiftprox::ffi::ground::*;
use swiftprox::ffi::half_space::*;
use swiftprox::ffi::pair::CPlaced;
use swiftprox::ground::{Ground, GroundContact, GroundDistance};
use swiftprox::manifold::{Manifold, ManifoldPoint};
use swiftprox::pair::{HalfSpace, Outcome, SignedDistance};

use super::arguments::{Block, any_pose, array, options, or_null, pair_config, start};
use super::{MOST_POINTS, Program, last_message};
use crate::geometry::{any_number, any_points, inside};

const MOST_TRIANGLES: usize = 8;
const MOST_ROOM: usize = 6;

impl Program {
    /// A ground that lives for one query, or a half-space.
    pub fn ground_or_half_space(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        if u.arbitrary()? {
            return self.half_space(u);
        }
        let mut ground = null();
        // SAFETY: null, or what has the room that it claims.
        let status = unsafe {
            if u.arbitrary()? { ground_of_triangles(u, &mut ground)? } else { ground_of_heights(u, &mut ground)? }
        };
        assert_eq!(status == StatusCode::Ok, !ground.is_null(), "{}", last_message());
        if u.arbitrary()? {
            // SAFETY: as above; the share of the ground goes over to what is made of it.
            ground = unsafe { made_of(u, ground)? };
        }
        let given = if u.ratio(1, 16).unwrap_or(false) { null() } else { ground };
        let asked = self.ask_ground(u, given);
        // SAFETY: as many shares as are given back; null is ignored.
        unsafe {
            assert_eq!(swiftprox_ground_retain(ground), ground);
            swiftprox_ground_release(ground);
            swiftprox_ground_release(ground);
        }
        Ok(if status == StatusCode::Ok && !ground.is_null() { asked? } else { status })
    }

    fn ask_ground(&mut self, u: &mut Unstructured, ground: *const Ground) -> Result<StatusCode> {
        let shape = self.shape(u)?;
        let (pose, place) = (any_pose(u)?, any_pose(u)?);
        let object = CPlaced { shape, pose: or_null(u, pose.at::<f64>())? };
        let placed = CPlacedGround { ground, pose: or_null(u, place.at::<f64>())? };
        if u.arbitrary()? {
            let (kind, config) = (u.int_in_range(-1..=4)?, pair_config(u)?);
            let answer = Block::new(size_of::<GroundDistance>());
            let target = or_null(u, answer.at::<GroundDistance>())?;
            // SAFETY: living handles or null, blocks of the sizes that the header names.
            return Ok(unsafe {
                let status = inside(self.environment, || {
                    swiftprox_pair_ground_distance(kind, object, placed, start(&config), target)
                });
                if !target.is_null() {
                    let said = target.read().answer;
                    assert_eq!(status == StatusCode::Ok, said.outcome != Outcome::None, "{}", last_message());
                }
                status
            });
        }
        let config = manifold_config(u)?;
        let (contact_room, point_room) = (u.int_in_range(0..=MOST_ROOM)?, u.int_in_range(0..=MOST_ROOM)?);
        let contacts = Block::new(size_of::<GroundContact>() * contact_room);
        let points = Block::new(size_of::<ManifoldPoint>() * point_room);
        let (contacts, contact_capacity) = array(u, contacts.at(), contact_room)?;
        let (points, point_capacity) = array(u, points.at(), point_room)?;
        let count = Block::new(size_of::<GroundCount>());
        let target = or_null(u, count.at::<GroundCount>())?;
        // SAFETY: as above; no array has less room than it claims.
        Ok(unsafe {
            let status = inside(self.environment, || {
                swiftprox_pair_ground_contacts(
                    object,
                    placed,
                    start(&config),
                    CGroundRoom { contacts, contact_capacity, points, point_capacity },
                    target,
                )
            });
            if status != StatusCode::Ok && !target.is_null() {
                let GroundCount { contact_count, point_count } = target.read();
                assert_eq!((contact_count, point_count), (0, 0));
            }
            status
        })
    }

    fn half_space(&mut self, u: &mut Unstructured) -> Result<StatusCode> {
        let shape = self.shape(u)?;
        let pose = any_pose(u)?;
        let pose = or_null(u, pose.at::<f64>())?;
        let mut last = 1.0;
        let normal = [any_number(u, &mut last)?, any_number(u, &mut last)?, any_number(u, &mut last)?];
        let plane = Block::of(&[HalfSpace { normal, offset: any_number(u, &mut last)? }]);
        let plane = or_null(u, plane.at::<HalfSpace>())?;
        if u.arbitrary()? {
            let answer = Block::new(size_of::<SignedDistance>());
            let target = or_null(u, answer.at::<SignedDistance>())?;
            // SAFETY: living handles or null, blocks of the sizes that the header names.
            return Ok(unsafe {
                let status = inside(self.environment, || {
                    swiftprox_pair_half_space_distance(CPlaced { shape, pose }, plane, target)
                });
                if !target.is_null() {
                    assert_eq!(status == StatusCode::Ok, target.read().outcome != Outcome::None, "{}", last_message());
                }
                status
            });
        }
        let config = manifold_config(u)?;
        let room = u.int_in_range(0..=MOST_ROOM)?;
        let points = Block::new(size_of::<ManifoldPoint>() * room);
        let (points, room) = array(u, points.at(), room)?;
        let manifold = Block::new(size_of::<Manifold>());
        let target = or_null(u, manifold.at::<Manifold>())?;
        // SAFETY: as above.
        Ok(unsafe {
            let status = inside(self.environment, || {
                swiftprox_pair_half_space_manifold(
                    CPlaced { shape, pose },
                    plane,
                    start(&config),
                    CManifoldRoom { points, capacity: room, distance: std::ptr::null_mut() },
                    target,
                )
            });
            if !target.is_null() {
                let Manifold { outcome, point_count, .. } = target.read();
                assert_eq!(status == StatusCode::Ok, outcome != Outcome::None, "{}", last_message());
                assert!(point_count as usize <= room);
            }
            status
        })
    }
}

fn manifold_config(u: &mut Unstructured) -> Result<Option<Block>> {
    let mut last = 1.0;
    let mut config: CManifoldConfig = CManifoldConfig::DEFAULT;
    config.max_distance = any_number(u, &mut last)?.abs();
    config.reduces = u.arbitrary()?;
    options(u, &config, &[])
}

/// A ground twice at two places, or as a solid, which the share given is returned for; null if it is refused.
///
/// # Safety
/// A living ground or null.
unsafe fn made_of(u: &mut Unstructured, ground: *const Ground) -> Result<*const Ground> {
    let mut made = null();
    // SAFETY: a pose is twelve doubles.
    let poses = [any_pose(u)?, any_pose(u)?].map(|pose| unsafe { pose.at::<[f64; 12]>().read() });
    // SAFETY: as many grounds and poses as are claimed.
    let status = unsafe {
        if u.arbitrary()? {
            swiftprox_ground_create_from_grounds([ground; 2].as_ptr(), poses.as_ptr().cast(), 2, &mut made)
        } else {
            let mut last = 1.0;
            swiftprox_ground_create_solid(ground, any_number(u, &mut last)?, &mut made)
        }
    };
    assert_eq!(status == StatusCode::Ok, !made.is_null(), "{}", last_message());
    // SAFETY: the share that was given.
    unsafe { swiftprox_ground_release(ground) };
    Ok(made)
}

/// # Safety
/// `ground` can be written.
unsafe fn ground_of_triangles(u: &mut Unstructured, ground: &mut *const Ground) -> Result<StatusCode> {
    let vertices: Vec<[f64; 3]> = any_points(u, MOST_POINTS)?.iter().map(|&p| p.into()).collect();
    // Now and then one that is not there.
    let beyond = vertices.len() as u32 - u32::from(!u.ratio(1, 32)?);
    let mut corners = Vec::new();
    for _ in 0..3 * u.int_in_range(0..=MOST_TRIANGLES)? {
        corners.push(u.int_in_range(0..=beyond)?);
    }
    let (vertex_block, corner_block) = (Block::of(&vertices), Block::of(&corners));
    let (vertices, vertex_count) = array(u, vertex_block.at(), vertices.len())?;
    let (corners, triangle_count) = array(u, corner_block.at(), corners.len() / 3)?;
    // SAFETY: what is not null has the room that it claims.
    Ok(unsafe { swiftprox_ground_create_from_triangles(vertices, vertex_count, corners, triangle_count, ground) })
}

/// # Safety
/// As above.
unsafe fn ground_of_heights(u: &mut Unstructured, ground: &mut *const Ground) -> Result<StatusCode> {
    let (rows, columns) = (u.int_in_range(0..=4)?, u.int_in_range(0..=4)?);
    let mut last = 1.0;
    let [row_spacing, column_spacing] = [any_number(u, &mut last)?, any_number(u, &mut last)?];
    let mut heights = Vec::new();
    for _ in 0..rows * columns {
        heights.push(any_number(u, &mut last)?);
    }
    let heights = Block::of(&heights);
    let (heights, _) = array(u, heights.at(), rows * columns)?;
    // SAFETY: as above.
    Ok(unsafe { swiftprox_ground_create_from_heights(rows, columns, row_spacing, column_spacing, heights, ground) })
}
