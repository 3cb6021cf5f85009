//! Writes the scripts into a folder: `make proofs` has them proved.

fn main() -> std::io::Result<()> {
    let folder = std::env::args().nth(1).expect("the folder to write to");
    let kernels = proofs::kernels::all();
    proofs::rows::check(&kernels).expect("bounds that cover what is counted");
    std::fs::create_dir_all(&folder)?;
    for (name, text) in proofs::scripts::scripts(&kernels) {
        std::fs::write(std::path::Path::new(&folder).join(name), text)?;
    }
    Ok(())
}
