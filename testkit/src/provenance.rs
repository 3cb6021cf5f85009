//! Where measurements come from, for the heads of their files.

use std::fs;
use std::process::Command;

/// `PROCESSOR, commit HASH, DAY`. The hash ends in `-dirty` where the sources are not those of the commit.
pub fn provenance() -> String {
    let commit = said_by("git", &["describe", "--always", "--dirty", "--abbrev=7", "--exclude=*"]);
    format!("{}, commit {commit}, {}", processor(), said_by("date", &["+%F"]))
}

fn processor() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let name = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    name.map_or("unknown processor".into(), |(_, name)| name.into())
}

/// The line that a program prints when it is run in the sources.
fn said_by(program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).current_dir(env!("CARGO_MANIFEST_DIR")).output();
    match output {
        Ok(output) if output.status.success() => String::from_utf8_lossy(&output.stdout).trim().into(),
        _ => "unknown".into(),
    }
}
