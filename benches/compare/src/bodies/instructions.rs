//! How many instructions queries of the strongest ways take, which no other program on the machine changes: a line for a body,
//! query and motion, a column for a method.

use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::Path;

use super::list::{Body, Extent};
use super::methods::{Methods, Question};
use super::{list, poses_asked};
use crate::callgrind::Callgrind;
use crate::method::Method;
use crate::options::Options;
use crate::report::{self, in_order};
use testkit::orbits::Step;

/// What is asked on which orbit, as charts and tables have it.
const ASKED: [(Question, &str); 3] =
    [(Question::Distance, "small"), (Question::Verdict, "small"), (Question::Depth, "deep")];
/// Bodies of more vertices take callgrind minutes, most of them in what is not counted.
const MOST_VERTICES: usize = 2002;

/// For the head of the file.
const HOW: &str = "instructions of processors with AVX2, the most that valgrind knows";

/// What was counted of a body.
struct Count {
    question: Question,
    family: &'static str,
    body: String,
    form: String,
    step: Step,
    /// Of each method by name: instructions a query.
    instructions: Vec<(String, u64)>,
}

/// Under valgrind, whose `--callgrind-out-file` is `out`.
///
/// # Errors
/// A message about what cannot be read, made or written.
pub fn run(out: &Path, options: &Options, wanted: &[String]) -> Result<(), String> {
    let path = options.csv.as_ref().ok_or("--instructions: --csv FILE is missing")?;
    let mut callgrind = Callgrind::new(out)?;
    let counts = count(list::bodies(options, wanted)?, options, &mut callgrind)?;
    report::write_as(path, HOW, &csv(&counts))
}

fn count(bodies: Vec<Body>, options: &Options, callgrind: &mut Callgrind) -> Result<Vec<Count>, String> {
    let is_counted = |body: &Body| {
        body.extent != Extent::Form && body.meshes.iter().all(|mesh| mesh.vertices.len() <= MOST_VERTICES)
    };
    let mut counts = Vec::new();
    for body in bodies.into_iter().filter(is_counted) {
        let body = Body { extent: Extent::Strongest, ..body };
        let methods = Methods::new(&body)?;
        for (question, orbit) in ASKED {
            let (mut asked, _) = methods.of(question, body.extent);
            callgrind.watch();
            for &step in &options.steps {
                let poses = poses_asked(&methods, (question, orbit, step), options)?;
                if poses.len() < 2 {
                    continue;
                }
                let mut instructions = Vec::new();
                for method in &mut asked {
                    method.load(&poses);
                    instructions.push((method.name().into(), warm(method.as_mut(), poses.len(), callgrind)?));
                }
                let Body { family, name, form, .. } = &body;
                counts.push(Count {
                    question,
                    family: *family,
                    body: name.clone(),
                    form: form.clone(),
                    step,
                    instructions,
                });
            }
            callgrind.look_away();
        }
        eprintln!("{} {} done", body.name, body.form);
    }
    Ok(counts)
}

/// Instructions a query after the first. What is made on first need is made before.
fn warm(method: &mut dyn Method, count: usize, callgrind: &mut Callgrind) -> Result<u64, String> {
    method.run_backwards(count);
    method.forget();
    method.run(0..1);
    Ok(callgrind.count(|| method.run(1..count))? / (count as u64 - 1))
}

fn csv(counts: &[Count]) -> String {
    let methods = in_order(counts.iter().flat_map(|count| count.instructions.iter().map(|(method, _)| method)));
    let mut text = "query,family,body,form,step".to_string();
    methods.iter().for_each(|method| text.extend([",", method.as_str()]));
    text.push('\n');
    for Count { question, family, body, form, step, instructions } in counts {
        let found: BTreeMap<_, _> = instructions.iter().map(|(method, count)| (method, count)).collect();
        let _ = write!(text, "{},{family},{body},{form},{step}", question.name());
        for method in &methods {
            text.push(',');
            if let Some(count) = found.get(method) {
                text += &count.to_string();
            }
        }
        text.push('\n');
    }
    text
}
