//! The workflows for public hosting call targets that the Makefile has, and on hosts without make a part of `cross.sh`.

#[test]
fn each_step_is_a_target_of_the_makefile() {
    let workflows =
        concat!(include_str!("../../.github/workflows/ci.yml"), include_str!("../../.github/workflows/hosts.yml"));
    let makefile = include_str!("../../Makefile");
    let cross = include_str!("../../scripts/cross.sh");
    let mut targets = Vec::new();
    let mut parts = Vec::new();
    for run in workflows.lines().filter_map(|line| line.trim_start().strip_prefix("- run: ")) {
        if let Some(target) = run.strip_prefix("make ") {
            assert!(makefile.contains(&format!("\n{target}:")), "{run}: the Makefile has no such target");
            targets.push(target);
        } else if let Some(part) = run.strip_prefix("sh scripts/cross.sh ") {
            assert!(cross.contains(&format!("\n    {part}) ")), "{run}: the script has no such part");
            parts.push(part);
        } else {
            assert!(run.starts_with("apt-get "), "{run}");
        }
    }
    assert_eq!(targets, ["lint", "test", "packages", "cross"]);
    assert_eq!(parts, ["native"]);
}
