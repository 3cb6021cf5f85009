//! How many instructions a piece of work takes, by valgrind's callgrind, under which this program runs then.

use std::fs;
use std::path::{Path, PathBuf};

use requests::{callgrind_dump, callgrind_look_away, callgrind_runs, callgrind_watch, callgrind_zero};

/// Counts what it is handed, and sees nothing else.
pub struct Callgrind {
    /// What `--callgrind-out-file` says: the n-th dump is a file of this name with `.n` behind.
    out: PathBuf,
    dumps: usize,
}

impl Callgrind {
    /// # Errors
    /// A message where callgrind cannot be told what to count.
    pub fn new(out: &Path) -> Result<Callgrind, String> {
        if callgrind_runs() {
            Ok(Callgrind { out: out.into(), dumps: 0 })
        } else {
            Err("--instructions: to be compiled where valgrind/callgrind.h is (Debian: valgrind), and run as \
                 scripts/bodies.sh does"
                .into())
        }
    }

    /// Instruments what is executed from now on until [`Callgrind::look_away`]: all else runs some ten times as fast, but what was
    /// translated is translated anew.
    pub fn watch(&self) {
        callgrind_watch();
    }

    pub fn look_away(&self) {
        callgrind_look_away();
    }

    /// Instructions of a work that is watched.
    ///
    /// # Errors
    /// A message about the dump that cannot be read.
    pub fn count(&mut self, work: impl FnOnce()) -> Result<u64, String> {
        callgrind_zero();
        work();
        callgrind_dump();
        self.dumps += 1;
        let path = PathBuf::from(format!("{}.{}", self.out.display(), self.dumps));
        let failed = |e: std::io::Error| format!("{}: {e}", path.display());
        let dump = fs::read_to_string(&path).map_err(failed)?;
        fs::remove_file(&path).map_err(failed)?;
        let total = dump.lines().find_map(|line| line.strip_prefix("totals: ")?.trim().parse().ok());
        total.ok_or_else(|| format!("{}: no totals", path.display()))
    }
}

/// Of callgrind.c, which is compiled where valgrind's header is.
#[cfg(callgrind)]
mod requests {
    unsafe extern "C" {
        pub safe fn callgrind_runs() -> bool;
        pub safe fn callgrind_watch();
        pub safe fn callgrind_look_away();
        pub safe fn callgrind_zero();
        pub safe fn callgrind_dump();
    }
}

#[cfg(not(callgrind))]
mod requests {
    pub fn callgrind_runs() -> bool {
        false
    }
    pub fn callgrind_watch() {}
    pub fn callgrind_look_away() {}
    pub fn callgrind_zero() {}
    pub fn callgrind_dump() {}
}
