//! Notes the compiler, and compiles the shims of valgrind and of those peers in C and C++ that are there: what pkg-config finds
//! (Debian: libfcl-dev, libccd-dev, libbullet-dev), of the environment of Python that `PEERS_PYTHON` names coal and mujoco, and the
//! Jolt that is built in the folder `PEERS_JOLT`. The comparison leaves out what is not there.

use std::path::{Path, PathBuf};
use std::process::Command;

fn main() {
    println!("cargo:rustc-env=COMPILER={}", compiler());
    println!("cargo:rustc-env=PARRY={}", parry());
    // No -march: Eigen's alignment, and with it the ABI, must be that of the installed library.
    let fcl = ["src/crowd/fcl.cpp", "src/peers/fcl.cpp", "src/cast/fcl.cpp", "src/compound/fcl.cpp"];
    Shim { peer: "fcl", sources: &fcl, flags: pkg_config("fcl", "libfcl-dev") }
        .link(cc::Build::new().cpp(true).std("c++14"));
    let ccd = pkg_config("ccd", "libccd-dev");
    Shim { peer: "ccd", sources: &["src/peers/ccd.c"], flags: ccd }.link(cc::Build::new().std("c99"));
    // Of the header alone, which is of any precision.
    let bullet = pkg_config("bullet", "libbullet-dev").map(|flags| Flags { link: Vec::new(), ..flags });
    Shim { peer: "bullet", sources: &["src/peers/bullet.cpp"], flags: bullet }
        .link(cc::Build::new().cpp(true).std("c++14"));
    let bullet64 = pkg_config("bullet-float64", "libbullet-dev");
    Shim {
        peer: "bullet64",
        sources: &[
            "src/cast/bullet.cpp",
            "src/resting/bullet.cpp",
            "src/peers/bullet_round.cpp",
            "src/compound/bullet.cpp",
        ],
        flags: bullet64,
    }
    .link(cc::Build::new().cpp(true).std("c++14"));
    // Of the header alone; what valgrind's libraries are for is another thing.
    let valgrind = pkg_config("valgrind", "valgrind").map(|flags| Flags { link: Vec::new(), ..flags });
    Shim { peer: "callgrind", sources: &["src/callgrind.c"], flags: valgrind }.link(cc::Build::new().std("gnu99"));
    let packages = python_packages();
    let coal = packages.as_deref().and_then(coal);
    Shim { peer: "coal", sources: &["src/peers/coal.cpp", "src/compound/coal.cpp"], flags: coal }
        .link(cc::Build::new().cpp(true).std("c++17"));
    let mujoco = packages.as_deref().and_then(mujoco);
    Shim { peer: "mujoco", sources: &["src/peers/mujoco.c"], flags: mujoco }.link(cc::Build::new().std("c99"));
    Shim { peer: "jolt", sources: &["src/peers/jolt.cpp", "src/ground/jolt.cpp"], flags: jolt() }
        .link(cc::Build::new().cpp(true).std("c++17"));
    let headers =
        ["peers/bullet.h", "peers/hull.h", "peers/peer.h", "cast/peer.h", "compound/peer.h", "compound/managers.h"];
    for header in headers {
        println!("cargo:rerun-if-changed=src/{header}");
    }
}

/// What the compiler and the linker are to be told.
struct Flags {
    compile: Vec<String>,
    link: Vec<String>,
}

struct Shim<'a> {
    peer: &'a str,
    sources: &'a [&'a str],
    /// None where the library is not there.
    flags: Option<Flags>,
}

impl Shim<'_> {
    /// Sets the condition that is named as the peer where there is such a library.
    fn link(self, build: &mut cc::Build) {
        let Shim { peer, sources, flags } = self;
        sources.iter().for_each(|source| println!("cargo:rerun-if-changed={source}"));
        println!("cargo:rustc-check-cfg=cfg({peer})");
        let Some(Flags { compile, link }) = flags else { return };
        build.opt_level(3).define("NDEBUG", None).warnings(false).files(sources);
        for flag in compile {
            build.flag(flag);
        }
        build.compile(&format!("{peer}_shim"));
        link.iter().for_each(|flag| println!("cargo:rustc-link-arg={flag}"));
        println!("cargo:rustc-cfg={peer}");
    }
}

/// Where the environment of Python has its packages.
fn python_packages() -> Option<PathBuf> {
    println!("cargo:rerun-if-env-changed=PEERS_PYTHON");
    let python = std::env::var("PEERS_PYTHON").ok().filter(|python| !python.is_empty())?;
    let output = Command::new(python).args(["-c", "import sysconfig; print(sysconfig.get_path('purelib'))"]).output();
    Some(String::from_utf8_lossy(&output.ok()?.stdout).trim().into())
}

/// coal's wheel has its headers and library, and needs Eigen's headers.
fn coal(packages: &Path) -> Option<Flags> {
    let prefix = packages.join("cmeel.prefix");
    let [include, library] = [prefix.join("include"), prefix.join("lib")].map(|path| path.display().to_string());
    if !prefix.join("include/coal/distance.h").exists() {
        return None;
    }
    let mut flags = pkg_config("eigen3", "libeigen3-dev")?;
    flags.compile.push(format!("-I{include}"));
    flags.link = vec![format!("-L{library}"), "-lcoal".into(), format!("-Wl,-rpath,{library}")];
    Some(flags)
}

/// MuJoCo's wheel has its headers and library; the name of the library ends with its version.
fn mujoco(packages: &Path) -> Option<Flags> {
    let folder = packages.join("mujoco");
    let is_library = |name: &str| name.starts_with("libmujoco.so");
    let names = std::fs::read_dir(&folder).ok()?.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let library = names.into_iter().find(|name| is_library(name))?;
    let folder = folder.display();
    Some(Flags {
        compile: vec![format!("-I{folder}/include")],
        link: vec![format!("{folder}/{library}"), format!("-Wl,-rpath,{folder}")],
    })
}

/// What scripts/jolt.sh has built: its jolt.pc has the definitions and instruction sets that the shim must share.
fn jolt() -> Option<Flags> {
    println!("cargo:rerun-if-env-changed=PEERS_JOLT");
    let folder = std::env::var("PEERS_JOLT").ok().filter(|folder| !folder.is_empty())?;
    pkg_config(&format!("{folder}/jolt.pc"), "none; see scripts/jolt.sh")
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

/// What pkg-config says of a package; a warning that names Debian's where it finds none.
fn pkg_config(package: &str, debian: &str) -> Option<Flags> {
    let ask = |what: &str| {
        let output = Command::new("pkg-config").args([what, package]).output().ok()?;
        let flags = String::from_utf8_lossy(&output.stdout).split_whitespace().map(str::to_string).collect();
        output.status.success().then_some(flags)
    };
    let flags = ask("--cflags").zip(ask("--libs")).map(|(compile, link)| Flags { compile, link });
    if flags.is_none() {
        println!("cargo:warning=pkg-config finds no {package} (Debian: {debian}): compared without it");
    }
    flags
}
