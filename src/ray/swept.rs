//! A ray cast at a body with a swept radius, in doubles: closed forms propose, planes and balls prove.
//!
//! The body is its hull with a ball of the radius. It is behind each plane that supports it, and has the ball around each point
//! of the hull. So a ray enters no sooner than through such a plane, and no later than into such a ball. Both meet where it
//! enters.
//!
//! The search is for a point, a side or a triangle of the hull's vertices that the line meets first with the ball. It starts from
//! any vertex. It replaces the feature by one that is met sooner, with the support vertex along its normal, until none is
//! farther. A line that misses the feature goes to the nearest of it first, seen along the line (Gilbert, Johnson & Keerthi
//! 1988).

use super::line::{Chord, Line};
use super::rounded::{Beside, RoundedCorner, RoundedTouch, nearest_beside, sooner_touch};
use super::search::fill;
use super::{Ray, RayAnswer, RayOutcome, swept_exact};
use crate::answer::{feature_of_vertices, label, normalised};
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector, is_unit};
use crate::base::simd::{Lanes, Portable};
use crate::body::polyhedron::Polyhedron;
use crate::depth::polytope::farthest;
use crate::placed::state::FeatureId;

/// Most vertices that are looked at for one end; mostly there are a few.
const MOST_STEPS: u32 = 64;

/// Casts a ray at a polyhedron with a ball of a radius, which is not 0, at a pose; all are checked.
pub(super) fn cast(polyhedron: &Polyhedron, pose: &Pose, ray: &Ray, radius: f64) -> RayAnswer {
    debug_assert!(radius > 0.0);
    let (mut answer, mut guess) = (RayAnswer::default(), [f64::NAN; 2]);
    if let Some(line) = Line::new(polyhedron, pose, ray, radius) {
        let is_proved = match polyhedron.dimension {
            0 => prove_ball(&line, ray, &mut answer),
            _ => prove(&line, ray, &mut answer, &mut guess),
        };
        if is_proved {
            return answer;
        }
    }
    RayAnswer { steps: answer.steps, ..swept_exact::cast(polyhedron, pose, ray, radius, guess) }
}

/// The same, whatever doubles prove.
pub(super) fn cast_in_integers(polyhedron: &Polyhedron, pose: &Pose, ray: &Ray, radius: f64) -> RayAnswer {
    let answer = cast(polyhedron, pose, ray, radius);
    if answer.exact != 0 {
        return answer;
    }
    let guess = [answer.entry[0], answer.exit[0]];
    RayAnswer { steps: answer.steps, ..swept_exact::cast(polyhedron, pose, ray, radius, guess) }
}

/// Says what doubles prove, if that is all; and about where the ends are.
fn prove(line: &Line, ray: &Ray, answer: &mut RayAnswer, guess: &mut [f64; 2]) -> bool {
    if line.passes_sphere() {
        answer.outcome = RayOutcome::Miss;
        return true;
    }
    let norm = line.direction.norm();
    let along = line.direction * (1.0 / norm);
    let (touch, vertices, vertex, excess) = match first(line, &along, &mut answer.steps) {
        SweptEnd::At { touch, vertices, vertex, excess } => (touch, vertices, vertex, excess),
        SweptEnd::Beside { normal, vertex, excess } => {
            answer.outcome = RayOutcome::Miss;
            return line.is_in_front(&normal, vertex, excess, ray.t_max);
        }
        SweptEnd::Lost => return false,
    };
    guess[0] = touch.at / norm;
    let Some(entry) = line.crossing_of_support(&touch.normal, vertex, excess) else { return false };
    if entry.faces && entry.at[0] > ray.t_max {
        answer.outcome = RayOutcome::Miss;
        return true;
    }
    let SweptEnd::At { touch: last, vertex, excess, .. } = first(line, &-along, &mut answer.steps) else {
        return false;
    };
    guess[1] = -last.at / norm;
    let Some(exit) = line.crossing_of_support(&last.normal, vertex, excess) else { return false };
    if !entry.faces || exit.faces {
        return false;
    }
    if exit.at[1] < 0.0 {
        answer.outcome = RayOutcome::Miss;
        return true;
    }
    let Chord::Passed { entry: [_, sooner], .. } = line.chord(&touch.foot, norm) else { return false };
    let Chord::Passed { exit: [later, _], .. } = line.chord(&last.foot, norm) else { return false };
    if !fill(answer, line, ray, [entry.at[0], sooner], [later, exit.at[1]]) {
        return false;
    }
    if answer.outcome == RayOutcome::Hit {
        fill_surface(answer, line, &touch, &vertices);
    }
    true
}

/// The same of a single vertex: the ball around it is all of the body.
fn prove_ball(line: &Line, ray: &Ray, answer: &mut RayAnswer) -> bool {
    let centre = line.vertex(0);
    let (entry, exit) = match line.chord(&centre, line.direction.norm()) {
        Chord::Passed { entry, exit } if entry[0] <= ray.t_max && exit[1] >= 0.0 => (entry, exit),
        Chord::Unclear => return false,
        Chord::Passed { .. } | Chord::Missed => {
            answer.outcome = RayOutcome::Miss;
            return true;
        }
    };
    if !fill(answer, line, ray, entry, exit) {
        return false;
    }
    if answer.outcome == RayOutcome::Hit {
        let way = line.direction * entry[0] - centre;
        answer.normal = normalised(&way);
        answer.feature = label(line.polyhedron, FeatureId::Vertex(0), &Vector::zeros());
    }
    true
}

/// How a search ended. The vertex is the farthest along the normal, up to an excess.
enum SweptEnd {
    /// Where the line meets the body first, near these vertices.
    At { touch: RoundedTouch, vertices: [u32; 3], vertex: u32, excess: f64 },
    /// Next to the body, which the normal leads out of.
    Beside { normal: Vector, vertex: u32, excess: f64 },
    /// Nowhere.
    Lost,
}

/// Looks for where the line along a unit vector first meets the body.
///
/// Each touch is sooner than the one before, and what is beside the line is nearer to it: nothing comes twice.
fn first(line: &Line, along: &Vector, steps: &mut u32) -> SweptEnd {
    debug_assert!(is_unit(along));
    if line.polyhedron.dimension == 1 {
        return first_of_ends(line, along);
    }
    let tolerance = 64.0 * U * line.reach;
    let support = |towards: &Vector, near: Option<u32>| {
        let (vertex, excess) = farthest(line.polyhedron, Portable::from_vector(&line.rotate_back(towards)), near);
        (corner(line, vertex), excess)
    };
    // The newest, and those that the search was at before.
    let (mut corners, mut count) = ([support(&line.towards_sphere(along), None).0; 4], 1);
    let (mut soonest, mut nearest) = (f64::INFINITY, f64::INFINITY);
    let mut ended = SweptEnd::Lost;
    for _ in 0..MOST_STEPS {
        *steps += 1;
        let touch = sooner_touch(along, line.swept_radius, &corners[..count], soonest);
        let (members, normal, foot) = match &touch {
            Some(touch) => {
                soonest = touch.at;
                (touch.members, touch.normal, touch.foot)
            }
            None if soonest < f64::INFINITY => return ended,
            None => {
                let Beside { members, across } = nearest_beside(along, &corners[..count]);
                let distance = across.norm();
                if !(distance < nearest) {
                    return ended;
                }
                nearest = distance;
                (members, -Vector::from(normalised(&across)), corners[0].place)
            }
        };
        let kept = members.indices.map(|k| corners[k]);
        let (farther, excess) = support(&normal, Some(corners[0].vertex));
        let vertex = farther.vertex;
        ended = match touch {
            Some(touch) => SweptEnd::At { touch, vertices: kept.map(|corner| corner.vertex), vertex, excess },
            None => SweptEnd::Beside { normal, vertex, excess },
        };
        if !(normal.dot(&(farther.place - foot)) > tolerance) {
            return ended;
        }
        corners = [farther, kept[0], kept[1], kept[2]];
        count = 1 + members.count;
    }
    SweptEnd::Lost
}

/// The same of a segment. The end that is farther as computed is the farthest up to the rounding of heights, which counts in any
/// case.
fn first_of_ends(line: &Line, along: &Vector) -> SweptEnd {
    let corners = [corner(line, 0), corner(line, 1)];
    let farther = |normal: &Vector| u32::from(normal.dot(&(corners[1].place - corners[0].place)) > 0.0);
    let touch = sooner_touch(along, line.swept_radius, &corners, f64::INFINITY);
    let soonest = touch.as_ref().map_or(f64::INFINITY, |touch| touch.at);
    if let Some(touch) = sooner_touch(along, line.swept_radius, &corners[1..], soonest) {
        return SweptEnd::At { vertices: [1; 3], vertex: farther(&touch.normal), touch, excess: 0.0 };
    }
    if let Some(touch) = touch {
        let vertices = touch.members.indices.map(|k| k as u32);
        return SweptEnd::At { vertices, vertex: farther(&touch.normal), touch, excess: 0.0 };
    }
    let sides = [nearest_beside(along, &corners).across, nearest_beside(along, &corners[1..]).across];
    let is_first = sides[0].norm_squared() < sides[1].norm_squared();
    let normal = -(if is_first { sides[0] } else { sides[1] }).normalize();
    SweptEnd::Beside { normal, vertex: farther(&normal), excess: 0.0 }
}

fn corner(line: &Line, vertex: u32) -> RoundedCorner {
    RoundedCorner { vertex, place: line.vertex(vertex) }
}

/// The surface where a ray comes in.
fn fill_surface(answer: &mut RayAnswer, line: &Line, touch: &RoundedTouch, vertices: &[u32; 3]) {
    let positions = vertices.map(|v| line.polyhedron.vertices[v as usize].position);
    let point: Vector = positions.iter().zip(touch.weights).map(|(position, weight)| position * weight).sum();
    let towards = line.rotate_back(&touch.normal);
    let feature = feature_of_vertices(line.polyhedron, &vertices[..touch.members.count], &point, &towards, 0.0);
    answer.normal = touch.normal.into();
    answer.feature = label(line.polyhedron, feature, &point);
}
