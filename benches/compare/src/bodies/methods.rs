//! Which methods are asked what, each in its strongest configuration: warm, its support climbing where that is left to the user.

use std::rc::Rc;

use swiftprox::hierarchy::{HierarchyKind, HierarchyOptions};
use swiftprox::mesh::PolygonMesh;
use swiftprox::pair::{Levels, PairConfig};
use swiftprox::shape::{InputPolicy, Shape, ShapeOptions};

use super::list::{Body, Extent};
use super::manifold::{OwnManifold, ParryManifold, parry_polyhedron};
use super::round::{FAMILY, Round};
use crate::depth::{self, ours::Depth, parry::Contact, triangulated};
use crate::method::Method;
use crate::parry::{Climbing, Parry, Rings, Verdict};
use crate::peers::{self, Asked};
use crate::setting::{Query, setting_of_pair};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Question {
    Distance,
    Verdict,
    Depth,
    Manifold,
}

impl Question {
    pub fn name(self) -> &'static str {
        match self {
            Question::Distance => "distance",
            Question::Verdict => "verdict",
            Question::Depth => "depth",
            Question::Manifold => "manifold",
        }
    }
}

/// Absolute errors that approximate distances are asked for; the bodies have radius 1.
const ERRORS: [f64; 6] = [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-9];
/// The same through levels of detail, which a pair that is to be exact does not go through by itself.
const ERRORS_BY_LEVELS: [f64; 3] = [1e-1, 1e-2, 0.0];
/// What is left of the triangles from one level to the next.
const DECIMATION: f64 = 0.25;

const STRONGEST_DISTANCES: [&str; 3] = ["coal-1e-10", "mujoco-1e-6", "jolt-1e-6"];
const FURTHER_DISTANCES: [&str; 11] = [
    "coal-1e-1",
    "coal-1e-2",
    "coal-1e-4",
    "coal-1e-6",
    "bullet-1e-4",
    "fcl-1e-2",
    "fcl-1e-6",
    "fcl-1e-10",
    "fcl-indep-1e-2",
    "fcl-indep-1e-6",
    "fcl-indep-1e-10",
];
const STRONGEST_VERDICTS: [&str; 3] = ["libccd-mpr-1e-4", "coal-1e-6", "jolt-1e-6"];
/// Of round bodies, by the libraries' own primitives.
const ROUND: [&str; 2] = ["coal-round-1e-10", "bullet-round-1e-6"];
const FURTHER_VERDICTS: [&str; 4] = ["libccd-gjk-1e-4", "mujoco-1e-6", "fcl-1e-6", "fcl-indep-1e-6"];

/// What methods are made of.
pub struct Methods {
    shapes: [Rc<Shape>; 2],
    /// None where neither body has levels.
    layered: Option<[Rc<Shape>; 2]>,
    triangles: [PolygonMesh; 2],
    rings: [Rc<Rings>; 2],
    /// Of bodies that the others have primitives for.
    round: Option<[f64; 2]>,
}

impl Methods {
    /// # Errors
    /// A message of what a body is refused for.
    pub fn new(body: &Body) -> Result<Methods, String> {
        let failed = |e: swiftprox::error::Error| format!("{}: {e}", body.name);
        let made = |options: &ShapeOptions| -> Result<[Rc<Shape>; 2], String> {
            let shape = |k: usize| {
                // A point or a segment has no faces to be taken as they are.
                let input = if body.family == FAMILY { InputPolicy::Hull } else { options.input };
                let options = ShapeOptions { input, swept_radius: body.radii[k], ..*options };
                Shape::from_mesh(&body.meshes[k], &options).map(Rc::new).map_err(failed)
            };
            Ok([shape(0)?, shape(1)?])
        };
        let hierarchy =
            HierarchyOptions { kind: HierarchyKind::Quadric, decimation: DECIMATION, ..HierarchyOptions::default() };
        let has_levels = |shapes: &[Rc<Shape>; 2]| shapes.iter().any(|shape| !shape.hierarchy().levels.is_empty());
        let layered = match body.extent {
            Extent::All => Some(made(&ShapeOptions { hierarchy, ..ShapeOptions::default() })?).filter(has_levels),
            Extent::Strongest | Extent::Form => None,
        };
        let triangles = [0, 1].map(|k| triangulated(&body.meshes[k]).expect("fans of a mesh that was taken"));
        let rings = triangles.each_ref().map(|mesh| Rc::new(Rings::new(mesh)));
        Ok(Methods {
            shapes: made(&ShapeOptions::default())?,
            layered,
            triangles,
            rings,
            round: (body.family == FAMILY).then_some(body.radii),
        })
    }

    pub fn shapes(&self) -> [&Shape; 2] {
        self.shapes.each_ref().map(|shape| &**shape)
    }

    /// The methods that are to be asked, and how many of them take their turns first: slow ones leave the caches and the branch
    /// predictors to those after them.
    pub fn of(&self, question: Question, extent: Extent) -> (Vec<Box<dyn Method>>, usize) {
        let [mut strongest, own, peers] = match question {
            Question::Distance => self.of_distance(),
            Question::Verdict => self.of_verdict(),
            Question::Depth => self.of_depth(),
            Question::Manifold => self.of_manifold(),
        };
        let first = strongest.len();
        if extent == Extent::All {
            strongest.extend(interleaved(own, peers));
        }
        (strongest, first)
    }

    fn of_distance(&self) -> [Vec<Box<dyn Method>>; 3] {
        let shapes = self.shapes.each_ref();
        let exact = setting_of_pair("swiftprox", Query::Distance, shapes, PairConfig::default());
        if let Some(radii) = self.round {
            return [self.with_primitives(Question::Distance, exact, radii), Vec::new(), Vec::new()];
        }
        let parry = Box::new(Parry::new(self.rings.clone(), Climbing::First));
        let approximate = |error: f64| {
            let config = PairConfig { absolute_error: error, ..PairConfig::default() };
            setting_of_pair(format!("swiftprox-{error:e}"), Query::Approximate, shapes, config)
        };
        let by_levels = |shapes: &[Rc<Shape>; 2], error: f64| {
            let config = PairConfig { absolute_error: error, levels: Levels::All, ..PairConfig::default() };
            let (query, name) = match error {
                0.0 => (Query::Distance, "swiftprox-levels".to_string()),
                _ => (Query::Approximate, format!("swiftprox-levels-{error:e}")),
            };
            setting_of_pair(name, query, shapes.each_ref(), config)
        };
        let mut own: Vec<_> = ERRORS.map(approximate).into();
        own.extend(self.layered.iter().flat_map(|shapes| ERRORS_BY_LEVELS.map(|error| by_levels(shapes, error))));
        [
            self.with_peers(Asked::Distance, vec![exact, parry], &STRONGEST_DISTANCES),
            own,
            self.with_peers(Asked::Distance, Vec::new(), &FURTHER_DISTANCES),
        ]
    }

    fn of_verdict(&self) -> [Vec<Box<dyn Method>>; 3] {
        let own = setting_of_pair("swiftprox", Query::Intersection, self.shapes.each_ref(), PairConfig::default());
        if let Some(radii) = self.round {
            return [self.with_primitives(Question::Verdict, own, radii), Vec::new(), Vec::new()];
        }
        let parry = Box::new(Verdict::new(self.rings.clone()));
        [
            self.with_peers(Asked::Verdict, vec![own, parry], &STRONGEST_VERDICTS),
            Vec::new(),
            self.with_peers(Asked::Verdict, Vec::new(), &FURTHER_VERDICTS),
        ]
    }

    fn of_depth(&self) -> [Vec<Box<dyn Method>>; 3] {
        let shapes = self.shapes.each_ref();
        let of_error = |error: f64| Box::new(Depth::new(shapes, error)) as Box<dyn Method>;
        if let Some(radii) = self.round {
            return [self.with_primitives(Question::Depth, of_error(0.0), radii), Vec::new(), Vec::new()];
        }
        let parry = Box::new(Contact::new(self.rings.clone()));
        [
            self.with_peers(Asked::Depth, vec![of_error(0.0), parry], &depth::STRONGEST),
            depth::ERRORS.map(of_error).into(),
            self.with_peers(Asked::Depth, Vec::new(), &depth::OTHERS),
        ]
    }

    fn of_manifold(&self) -> [Vec<Box<dyn Method>>; 3] {
        let mut all: Vec<Box<dyn Method>> = vec![Box::new(OwnManifold::new(depth::ours::NAME, self.shapes.each_ref()))];
        if let [Some(first), Some(second)] = self.triangles.each_ref().map(parry_polyhedron) {
            all.push(Box::new(ParryManifold::new("parry", [first, second])));
        }
        [all, Vec::new(), Vec::new()]
    }

    /// Our method, and the others by their own primitives.
    fn with_primitives(&self, question: Question, own: Box<dyn Method>, radii: [f64; 2]) -> Vec<Box<dyn Method>> {
        let asked = match question {
            Question::Distance => Asked::Distance,
            Question::Verdict => Asked::Verdict,
            Question::Depth | Question::Manifold => Asked::Depth,
        };
        let mut all = vec![own, Round::method(question, self.triangles.each_ref(), radii)];
        all.extend(ROUND.iter().filter_map(|name| peers::round(asked, name, self.triangles.each_ref(), radii)));
        all
    }

    fn with_peers(&self, asked: Asked, mut all: Vec<Box<dyn Method>>, names: &[&str]) -> Vec<Box<dyn Method>> {
        all.extend(peers::of_names(asked, names, self.triangles.each_ref()));
        all
    }
}

/// No two that search alike follow each other: the second would find the branch predictors trained on the very poses.
fn interleaved(own: Vec<Box<dyn Method>>, peers: Vec<Box<dyn Method>>) -> Vec<Box<dyn Method>> {
    let (mut own, mut peers) = (own.into_iter(), peers.into_iter());
    let mut all = Vec::new();
    loop {
        let pair = [own.next(), peers.next()];
        if pair.iter().all(Option::is_none) {
            return all;
        }
        all.extend(pair.into_iter().flatten());
    }
}
