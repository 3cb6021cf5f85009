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

use super::line::Line;
use super::rounded::{Beside, Corner, Touch, first_touch, nearest_beside};
use super::search::fill;
use super::{Ray, RayAnswer, RayOutcome, swept_exact};
use crate::base::math::{Pose, UNIT_ROUNDOFF as U, Vector, is_unit};
use crate::base::simd::{Lanes, Portable};
use crate::pair::{feature_of_vertices, label, normalised};
use crate::polyhedron::Polyhedron;
use crate::solve::polytope::farthest;

/// Most vertices that are looked at for one end; mostly there are a few.
const MOST_STEPS: u32 = 64;

/// Casts a ray at a polyhedron with a ball of a radius, which is not 0, at a pose; all are checked.
pub(super) fn cast(polyhedron: &Polyhedron, pose: &Pose, ray: &Ray, radius: f64) -> RayAnswer {
    debug_assert!(radius > 0.0);
    let (mut answer, mut guess) = (RayAnswer::default(), [f64::NAN; 2]);
    if let Some(line) = Line::new(polyhedron, pose, ray, radius) {
        match prove(&line, ray, &mut answer.steps, &mut guess) {
            Proved::Miss => {
                answer.outcome = RayOutcome::Miss;
                return answer;
            }
            Proved::Passes { touch, part: [entry, exit] } => {
                if fill(&mut answer, &line, ray, entry, exit) {
                    if answer.outcome == RayOutcome::Hit {
                        fill_surface(&mut answer, &line, &touch);
                    }
                    return answer;
                }
            }
            Proved::Nothing => {}
        }
    }
    swept_exact::cast(polyhedron, pose, ray, radius, guess, &mut answer);
    answer
}

/// The same, whatever doubles prove.
pub(super) fn cast_in_integers(polyhedron: &Polyhedron, pose: &Pose, ray: &Ray, radius: f64) -> RayAnswer {
    let mut answer = cast(polyhedron, pose, ray, radius);
    if answer.exact == 0 {
        let guess = [answer.entry[0], answer.exit[0]];
        answer = RayAnswer { steps: answer.steps, ..RayAnswer::default() };
        swept_exact::cast(polyhedron, pose, ray, radius, guess, &mut answer);
    }
    answer
}

/// The result that doubles prove.
#[expect(clippy::large_enum_variant, reason = "on the stack, of one call")]
enum Proved {
    Miss,
    /// The line passes through the body: it comes in at a touch, between these places, and goes out between those.
    Passes {
        touch: Touch,
        part: [[f64; 2]; 2],
    },
    Nothing,
}

fn prove(line: &Line, ray: &Ray, steps: &mut u32, guess: &mut [f64; 2]) -> Proved {
    if line.passes_sphere() {
        return Proved::Miss;
    }
    let length = line.direction.norm();
    let along = line.direction / length;
    let (touch, vertex, excess) = match first(line, along, steps) {
        Ended::At { touch, vertex, excess } => (touch, vertex, excess),
        Ended::Beside { normal, vertex, excess } => {
            let is_miss = line.is_in_front(&normal, vertex, excess, ray.t_max);
            return if is_miss { Proved::Miss } else { Proved::Nothing };
        }
        Ended::Lost => return Proved::Nothing,
    };
    guess[0] = touch.at / length;
    let Some(chord) = line.chord(&touch.foot) else { return Proved::Nothing };
    if line.polyhedron.dimension == 0 {
        let is_miss = chord[0][0] > ray.t_max || chord[1][1] < 0.0;
        return if is_miss { Proved::Miss } else { Proved::Passes { touch, part: chord } };
    }
    let Some(entry) = line.crossing_of_support(&touch.normal, vertex, excess) else { return Proved::Nothing };
    if entry.faces && entry.at[0] > ray.t_max {
        return Proved::Miss;
    }
    let Ended::At { touch: last, vertex, excess } = first(line, -along, steps) else { return Proved::Nothing };
    guess[1] = -last.at / length;
    let Some(last_chord) = line.chord(&last.foot) else { return Proved::Nothing };
    let Some(exit) = line.crossing_of_support(&last.normal, vertex, excess) else { return Proved::Nothing };
    if !entry.faces || exit.faces {
        return Proved::Nothing;
    }
    if exit.at[1] < 0.0 {
        return Proved::Miss;
    }
    Proved::Passes { touch, part: [[entry.at[0], chord[0][1]], [last_chord[1][0], exit.at[1]]] }
}

/// How a search ended. The vertex is the farthest along the normal, up to an excess.
enum Ended {
    /// The place where the line meets the body first.
    At { touch: Touch, vertex: u32, excess: f64 },
    /// Next to the body, which the normal leads out of.
    Beside { normal: Vector, vertex: u32, excess: f64 },
    /// Nowhere.
    Lost,
}

/// Looks for where the line along a unit vector first meets the body.
///
/// Each touch is sooner than the one before, and a feature beside the line is nearer to it: nothing comes twice.
fn first(line: &Line, along: Vector, steps: &mut u32) -> Ended {
    debug_assert!(is_unit(&along));
    let tolerance = 64.0 * U * line.reach;
    let support = |towards: &Vector, near: Option<u32>| {
        let (vertex, excess) = farthest(line.polyhedron, Portable::from_vector(&line.rotate_back(towards)), near);
        (Corner { vertex, place: line.vertex(vertex) }, excess)
    };
    let (mut corner, _) = support(&line.towards_sphere(&along), None);
    let (mut touch, mut beside): (Option<Touch>, Option<Beside>) = (None, None);
    let mut ended = Ended::Lost;
    for _ in 0..MOST_STEPS {
        *steps += 1;
        let kept = match (&touch, &beside) {
            (Some(touch), _) => &touch.corners[..touch.count],
            (None, Some(beside)) => &beside.corners[..beside.count],
            (None, None) => &[],
        };
        let (normal, foot) = if let Some(sooner) = first_touch(&along, line.swept_radius, kept, corner) {
            if touch.is_some_and(|touch| !(sooner.at < touch.at)) {
                return ended;
            }
            touch = Some(sooner);
            (sooner.normal, sooner.foot)
        } else {
            let nearer = nearest_beside(&along, kept, corner);
            let square = nearer.across.norm_squared();
            if touch.is_some() || beside.is_some_and(|beside| !(square < beside.across.norm_squared())) {
                return ended;
            }
            beside = Some(nearer);
            (-nearer.across / square.sqrt(), corner.place)
        };
        let (farther, excess) = support(&normal, Some(corner.vertex));
        let vertex = farther.vertex;
        ended = match touch {
            Some(touch) => Ended::At { touch, vertex, excess },
            None => Ended::Beside { normal, vertex, excess },
        };
        if !(normal.dot(&(farther.place - foot)) > tolerance) {
            return ended;
        }
        corner = farther;
    }
    Ended::Lost
}

/// The surface where a ray comes in.
fn fill_surface(answer: &mut RayAnswer, line: &Line, touch: &Touch) {
    let vertices = touch.corners.map(|corner| corner.vertex);
    let positions = vertices.map(|v| line.polyhedron.vertices[v as usize].position);
    let point: Vector = positions.iter().zip(touch.weights).map(|(position, weight)| position * weight).sum();
    let towards = line.rotate_back(&touch.normal);
    let feature = feature_of_vertices(line.polyhedron, &vertices[..touch.count], &point, &towards, 0.0);
    answer.normal = normalised(&touch.normal);
    answer.feature = label(line.polyhedron, feature, &point);
}
