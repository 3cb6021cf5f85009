//! What was measured, as CSV and as a table.

use std::collections::BTreeMap;
use std::fmt::Write;

use super::list::Body;
use super::methods::Question;
use super::truth::Truth;
use crate::method::Reply;
use crate::report::{geometric_mean, in_order};
use crate::timing::Time;
use testkit::orbits::Step;

/// A method on a scene.
pub struct Row {
    question: Question,
    family: &'static str,
    body: String,
    form: String,
    /// Of the first body.
    vertices: usize,
    orbit: String,
    step: Step,
    method: String,
    time: Time,
    /// Poses whose answers were held against the truth.
    judged: usize,
    /// Of those, another verdict or no answer.
    wrong: usize,
    worst_error: f64,
    /// The widest guaranteed interval of all poses; NaN where nothing is guaranteed.
    widest: f64,
    /// Intervals that miss the truth.
    missed: usize,
}

impl Row {
    pub fn new(
        body: &Body,
        (question, orbit, step): (Question, &str, Step),
        method: &str,
        time: Time,
        replies: &[Reply],
        truths: &[Truth],
    ) -> Row {
        let (mut errors, mut wrong, mut missed) = (Vec::new(), 0, 0);
        for truth in truths {
            let reply = &replies[truth.pose];
            let says_apart = reply.distance > 0.0;
            if reply.distance.is_nan() || says_apart != (truth.bounds[1] > 0.0) {
                wrong += 1;
            } else if question != Question::Verdict {
                errors.push(truth.error(reply.distance));
                missed += usize::from(truth.is_missed_by(reply.interval));
            }
        }
        let widths = replies.iter().map(Reply::width).filter(|width| !width.is_nan());
        Row {
            question,
            family: body.family,
            body: body.name.clone(),
            form: body.form.clone(),
            vertices: body.meshes[0].vertices.len(),
            orbit: orbit.into(),
            step,
            method: method.into(),
            time,
            judged: truths.len(),
            wrong,
            worst_error: errors.into_iter().fold(f64::NAN, f64::max),
            widest: if question == Question::Verdict { f64::NAN } else { widths.fold(f64::NAN, f64::max) },
            missed,
        }
    }
}

pub fn csv(rows: &[Row]) -> String {
    let mut text =
        "query,family,body,form,n1,orbit,step,method,best_ns,median_ns,judged,wrong,worst_error,widest,missed\n"
            .to_string();
    // Empty where there is none.
    let error = |error: f64| if error.is_nan() { String::new() } else { format!("{error:.1e}") };
    for row in rows {
        let Row { question, family, body, form, vertices, orbit, step, method, time, judged, wrong, missed, .. } = row;
        let (query, Time { best, median }) = (question.name(), time);
        let [worst_error, widest] = [error(row.worst_error), error(row.widest)];
        let _ = writeln!(
            text,
            "{query},{family},{body},{form},{vertices},{orbit},{step},{method},{best:.0},{median:.0},{judged},{wrong},\
             {worst_error},{widest},{missed}"
        );
    }
    text
}

/// For each query, family and orbit the geometric means of the methods that all its bodies have, at each step.
pub fn print(rows: &[Row]) {
    let scene = |row: &Row| (row.question.name(), row.family, row.orbit.clone());
    for (query, family, orbit) in in_order(rows.iter().map(scene)) {
        let here: Vec<&Row> = rows.iter().filter(|row| scene(row) == (query, family, orbit.clone())).collect();
        let steps = in_order(here.iter().map(|row| row.step));
        let mut times: BTreeMap<(&str, String), Vec<f64>> = BTreeMap::new();
        for row in &here {
            times.entry((&row.method, row.step.to_string())).or_default().push(row.time.best);
        }
        let head: Vec<String> = steps.iter().map(Step::to_string).collect();
        println!("\n| {query}, {family}, {orbit} orbit, ns | bodies | {} | wrong | missed |", head.join(" | "));
        println!("|---|--:|{}--:|--:|", "--:|".repeat(steps.len()));
        for method in in_order(here.iter().map(|row| row.method.as_str())) {
            let own = || here.iter().filter(|row| row.method == method);
            let cells = steps.iter().map(|step| times.get(&(method, step.to_string())));
            let count = cells.clone().flatten().map(Vec::len).max().unwrap_or(0);
            let means: Vec<String> = cells
                .map(|found| found.map_or(String::new(), |t| format!("{:.0}", geometric_mean(t.iter().copied()))))
                .collect();
            let [wrong, missed] = [own().map(|row| row.wrong).sum(), own().map(|row| row.missed).sum::<usize>()];
            println!("| {method} | {count} | {} | {wrong} | {missed} |", means.join(" | "));
        }
    }
    let judged: usize = rows.iter().filter(|row| row.method == "swiftprox").map(|row| row.judged).sum();
    println!("\n{judged} answers of swiftprox were held against integers.");
}
