//! Marching over one pair of bodies from the last features to the next, and nothing around it: no table, no levels, no second
//! tier, no answer to fill. So the rule alone differs by which marching goes on where several planes are violated.

use std::rc::Rc;

use swiftprox::base::simd::{self, Kernel, Lanes};
use swiftprox::distance::certificate::{Certify, Gap, Minimum};
use swiftprox::distance::marching::{self, March, step_limit};
use swiftprox::math::Pose;
use swiftprox::pair::start::policy::StartFrom;
use swiftprox::pair::start::start_pair;
use swiftprox::placed::Pair;
use swiftprox::placed::frame::Frame;
use swiftprox::placed::state::State;
use swiftprox::placed::voronoi::Rule;
use swiftprox::shape::Shape;

use crate::method::{Method, Reply};
use crate::setting::poses_of;
use testkit::PosePair;

pub struct Marching<const FIRST: bool> {
    name: &'static str,
    shape: Rc<Shape>,
    poses: Vec<[Pose; 2]>,
    state: Option<State>,
    gap: Option<Gap>,
    steps: u32,
}

impl<const FIRST: bool> Marching<FIRST> {
    pub fn new(name: &'static str, shape: Rc<Shape>) -> Marching<FIRST> {
        Marching { name, shape, poses: Vec::new(), state: None, gap: None, steps: 0 }
    }
}

impl<const FIRST: bool> Method for Marching<FIRST> {
    fn name(&self) -> &str {
        self.name
    }

    fn load(&mut self, poses: &[PosePair]) {
        self.poses = poses_of(poses);
    }

    fn forget(&mut self) {
        self.state = None;
    }

    #[inline]
    fn ask(&mut self, i: usize) {
        let polyhedron = self.shape.polyhedron();
        let [pose1, pose2] = &self.poses[i];
        let poses = [pose1, pose2];
        let afresh = || {
            State::vertex_vertex(
                start_pair(&Pair { polyhedra: [polyhedron; 2], poses }, StartFrom::Farthest).vertices(),
            )
        };
        let start = self.state.unwrap_or_else(afresh);
        let mut run = Run::<FIRST> { shape: &self.shape, poses, state: start, steps: 0, keep: Keep { gap: None } };
        simd::dispatch(&mut run);
        self.state = Some(run.state);
        self.steps = run.steps;
        self.gap = run.keep.gap;
    }

    fn reply(&self) -> Reply {
        let nothing = Reply { steps: 0.0, fallback: true, ..Reply::of(f64::NAN) };
        let reply = self.gap.map_or(nothing, |gap| Reply {
            distance: gap.distance,
            interval: [gap.interval.lower, gap.interval.upper],
            fallback: false,
            ..nothing
        });
        Reply { steps: f64::from(self.steps), ..reply }
    }
}

struct Run<'a, const FIRST: bool> {
    shape: &'a Shape,
    poses: [&'a Pose; 2],
    state: State,
    steps: u32,
    keep: Keep<FIRST>,
}

impl<const FIRST: bool> Kernel for Run<'_, FIRST> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(&mut self) {
        let polyhedron = self.shape.polyhedron();
        let frame = Frame::<L>::new(&Pair { polyhedra: [polyhedron; 2], poses: self.poses });
        assert!(frame.in_range, "the poses are sound");
        let limit = step_limit([polyhedron; 2]);
        let (march, steps) = marching::march(&frame, self.state, limit, &mut self.keep);
        let (March::Minimum(at) | March::Limit(at) | March::Open(at)) = march;
        (self.state, self.steps) = (at, steps);
    }
}

/// Keeps what follows from the minimum.
struct Keep<const FIRST: bool> {
    gap: Option<Gap>,
}

impl<L: Lanes, const FIRST: bool> Certify<L> for Keep<FIRST> {
    const RULE: Rule = if FIRST { Rule::First } else { Rule::Most };

    #[inline(always)]
    fn certify(&mut self, frame: &Frame<L>, _: State, minimum: &Minimum<L>) {
        self.gap = Some(minimum.gap(frame));
    }
}
