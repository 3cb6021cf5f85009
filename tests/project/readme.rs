//! The C code in the README is that of examples, which are compiled and run.

const README: &str = include_str!("../../README.md");
const HELLO: &str = include_str!("../../examples/hello.c");
const SCENE: &str = include_str!("../../examples/scene.c");

/// The blocks of C in the README.
fn blocks() -> Vec<&'static str> {
    let block = |rest: &'static str| rest.split_once("```\n").expect("the block ends").0;
    README.split("```c\n").skip(1).map(block).collect()
}

#[test]
fn the_blocks_of_c_are_from_examples() {
    let [program, scene] = blocks()[..] else { panic!("README.md has {} blocks of C, not 2", blocks().len()) };
    assert!(program == HELLO, "README.md and examples/hello.c differ");
    assert!(SCENE.contains(scene), "README.md has lines that examples/scene.c has not:\n{scene}");
}

/// Every file that the README links to is there.
#[test]
fn links_lead_somewhere() {
    let targets: Vec<&str> =
        README.split("](").skip(1).filter_map(|rest| rest.split_once(')')).map(|(target, _)| target).collect();
    assert!(targets.len() > 10, "{targets:?}");
    for target in targets.iter().filter(|target| !target.starts_with("http")) {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join(target);
        assert!(path.exists(), "README.md links to {target}, which is not there");
    }
}
