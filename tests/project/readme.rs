//! The C example in the README is `examples/hello.c`, which is compiled and run.

const README: &str = include_str!("../../README.md");
const HELLO: &str = include_str!("../../examples/hello.c");

#[test]
fn the_example_is_hello_c() {
    let (_, from_example) = README.split_once("```c\n").expect("README.md has a block of C");
    let (example, _) = from_example.split_once("```\n").expect("the block ends");
    assert!(example == HELLO, "README.md and examples/hello.c differ");
}
