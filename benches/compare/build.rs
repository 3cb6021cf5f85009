//! Notes the compiler, and compiles the shims of those peers in C and C++ that pkg-config finds (Debian: libfcl-dev,
//! libccd-dev); without them the comparison leaves them out.

use std::process::Command;

fn main() {
    println!("cargo:rustc-env=COMPILER={}", compiler());
    println!("cargo:rustc-env=PARRY={}", parry());
    // No -march: Eigen's alignment, and with it the ABI, must be that of the installed library.
    let fcl = ["src/fcl.cpp", "src/crowd/fcl.cpp"];
    link_shim("fcl", "libfcl-dev", &fcl, cc::Build::new().cpp(true).std("c++14"));
    link_shim("ccd", "libccd-dev", &["src/ccd.c"], cc::Build::new().std("c99"));
}

/// Sets the condition `package` where there is such a library.
fn link_shim(package: &str, debian: &str, sources: &[&str], build: &mut cc::Build) {
    sources.iter().for_each(|source| println!("cargo:rerun-if-changed={source}"));
    println!("cargo:rustc-check-cfg=cfg({package})");
    let Some(flags) = pkg_config("--cflags", package) else {
        println!("cargo:warning=pkg-config finds no {package} (Debian: {debian}): compared without it");
        return;
    };
    build.opt_level(3).define("NDEBUG", None).warnings(false).files(sources);
    for flag in flags.split_whitespace() {
        build.flag(flag);
    }
    build.compile(&format!("{package}_shim"));
    for flag in pkg_config("--libs", package).unwrap_or_default().split_whitespace() {
        println!("cargo:rustc-link-arg={flag}");
    }
    println!("cargo:rustc-cfg={package}");
}

/// The version of parry that Cargo.toml pins.
fn parry() -> String {
    println!("cargo:rerun-if-changed=Cargo.toml");
    let manifest = std::fs::read_to_string("Cargo.toml").expect("the manifest of this package");
    let version = manifest.lines().find_map(|line| line.strip_prefix("parry3d-f64 = \"="));
    version.expect("parry3d-f64 pinned to a version").trim_end_matches('"').to_string()
}

/// For the head of result files: `rustc --version` and the code generation flags in force.
fn compiler() -> String {
    let rustc = std::env::var("RUSTC").unwrap_or_else(|_| "rustc".into());
    let version = Command::new(rustc).arg("--version").output().ok();
    let version = version.map(|o| String::from_utf8_lossy(&o.stdout).trim().to_string()).unwrap_or_default();
    let flags = std::env::var("CARGO_ENCODED_RUSTFLAGS").unwrap_or_default().replace('\x1f', " ");
    if flags.is_empty() { version } else { format!("{version}, {flags}") }
}

fn pkg_config(what: &str, package: &str) -> Option<String> {
    let output = Command::new("pkg-config").args([what, package]).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}
