//! Pose files: one line a query, 24 numbers; blank lines and lines that start with # are skipped.

use std::fs;
use std::path::Path;

use super::PosePair;

/// The first `count` poses of a file (all, when it has fewer).
///
/// # Errors
/// A message with the file and the line.
pub fn read_poses(path: &Path, count: usize) -> Result<Vec<PosePair>, String> {
    let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
    let mut poses = Vec::new();
    for (number, line) in text.lines().enumerate() {
        if poses.len() == count {
            break;
        }
        if line.trim().is_empty() || line.starts_with('#') {
            continue;
        }
        let numbers: Result<Vec<f64>, _> = line.split_whitespace().map(str::parse).collect();
        let pose = numbers.ok().and_then(|n| PosePair::try_from(n).ok());
        poses.push(pose.ok_or_else(|| format!("{}:{}: expected 24 numbers", path.display(), number + 1))?);
    }
    Ok(poses)
}
