//! One run over families of bodies, motions, queries and methods: how long each method takes, and how far its answers are from the
//! truth in integers.

mod instructions;
mod list;
pub mod manifold;
mod methods;
mod record;
pub mod round;
mod truth;

use swiftprox::math::Pose;
use swiftprox::pair::{Outcome, PairAnswer, PairCache, PairConfig, intersection};
use swiftprox::shape::Shape;

use crate::method::{Cold, Method, replies};
use crate::motion;
use crate::options::Options;
use crate::report;
use crate::setting::poses_of;
use crate::timing::{Time, time_methods};
use list::{Body, Extent};
use methods::{Methods, Question};
use record::Row;
use testkit::PosePair;
use testkit::orbits::Step;
use truth::Truth;

/// What is asked on which orbit; depths and manifolds of the poses of it whose bodies intersect.
const ASKED: [(Question, &str); 6] = [
    (Question::Distance, "small"),
    (Question::Distance, "deep"),
    (Question::Verdict, "small"),
    (Question::Verdict, "deep"),
    (Question::Depth, "deep"),
    (Question::Manifold, "deep"),
];

/// # Errors
/// A message about what cannot be read, made or written.
pub fn run(options: &Options, wanted: &[String]) -> Result<(), String> {
    if let Some(out) = &options.instructions {
        return instructions::run(out, options, wanted);
    }
    let bodies = list::bodies(options, wanted)?;
    let mut rows = Vec::new();
    for (number, body) in bodies.iter().enumerate() {
        let mut methods = Methods::new(body)?;
        for (question, orbit) in ASKED {
            let is_asked = options.asked.is_empty() || options.asked.iter().any(|name| name == question.name());
            // How bodies that meet are told from those that nearly do is a question where nothing is known of them.
            let is_cold_alone = question == Question::Verdict && orbit == "deep";
            if is_asked && (options.cold || !is_cold_alone) && is_measured(body.extent, question, orbit) {
                for &step in &options.steps {
                    rows.extend(measure(body, &mut methods, (question, orbit, step), options)?);
                }
            }
        }
        eprintln!("{}/{}: {} {} done", number + 1, bodies.len(), body.name, body.form);
    }
    record::print(&rows);
    match &options.csv {
        Some(path) => report::write(path, options.passes, &record::csv(&rows)),
        None => Ok(()),
    }
}

/// Manifolds where everything is measured; of bodies that differ in their form alone, one distance and the depth.
fn is_measured(extent: Extent, question: Question, orbit: &str) -> bool {
    match question {
        Question::Manifold => extent == Extent::All,
        Question::Verdict => extent != Extent::Form,
        Question::Distance => extent != Extent::Form || orbit == "small",
        Question::Depth => true,
    }
}

fn measure(
    body: &Body,
    methods: &mut Methods,
    (question, orbit, step): (Question, &str, Step),
    options: &Options,
) -> Result<Vec<Row>, String> {
    let poses = poses_asked(methods, (question, orbit, step), options)?;
    if poses.is_empty() {
        return Ok(Vec::new());
    }
    let truths = Truth::of_some(body, &poses, question);
    let (mut asked, first) = methods.of(question, body.extent);
    if options.cold {
        asked = asked.into_iter().map(|method| Box::new(Cold(method)) as Box<dyn Method>).collect();
    }
    asked.iter_mut().for_each(|method| method.load(&poses));
    let replies: Vec<_> = asked.iter_mut().map(|method| replies(method.as_mut(), poses.len())).collect();
    let (strongest, others) = asked.split_at_mut(first);
    let times: Vec<Time> =
        [strongest, others].into_iter().flat_map(|turns| time_methods(turns, poses.len(), options.passes)).collect();
    let found = asked.iter().zip(times).zip(&replies);
    Ok(found
        .map(|((method, time), replies)| Row::new(body, (question, orbit, step), method.name(), time, replies, &truths))
        .collect())
}

/// The poses at which is asked.
fn poses_asked(
    methods: &Methods,
    (question, orbit, step): (Question, &str, Step),
    options: &Options,
) -> Result<Vec<PosePair>, String> {
    let poses = motion(options, orbit, step)?;
    match question {
        Question::Distance | Question::Verdict => Ok(poses),
        Question::Depth | Question::Manifold => intersecting(methods.shapes(), &poses),
    }
}

/// The poses whose bodies intersect, as this library says; whether they do is judged with the answers.
fn intersecting(shapes: [&Shape; 2], poses: &[PosePair]) -> Result<Vec<PosePair>, String> {
    let (mut cache, mut answer) = (PairCache::default(), PairAnswer::default());
    let mut found = Vec::new();
    for (pose, [pose1, pose2]) in poses.iter().zip(poses_of(poses)) {
        let poses: [&Pose; 2] = [&pose1, &pose2];
        let bodies = [shapes[0].at(poses[0]), shapes[1].at(poses[1])];
        intersection(bodies, &mut cache, &PairConfig::default(), &mut answer).map_err(|e| e.to_string())?;
        if answer.outcome == Outcome::Intersecting {
            found.push(*pose);
        }
    }
    Ok(found)
}
