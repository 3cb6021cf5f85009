#!/bin/sh
# Sees to it that there is a Rust new enough. Where it is missing, too old, or lacks a command that is needed, one is installed for
# this project alone, into the folder .rust; the old one stays as it is. The commands are in .rust/bin, where the Makefile and CMake
# look first. `rm -r .rust` takes it away.
#
#   rust.sh [COMMAND ...]        further commands that are needed: cargo-fmt, cargo-clippy
#
# By rustup where it is installed or a package of the system's, else by the installer of https://rustup.rs. RUSTUP_DIST_SERVER names
# a mirror to both. What cannot be fetched ends in one line on stderr.
cd "$(dirname "$0")/.." || exit 1
wanted=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' Cargo.toml)
# Not the newest: nobody knows its compiler and its lints yet.
version=1.95.0
# It has the script that sh.rustup.rs leads to, too: one host to reach, not two.
server=https://static.rust-lang.org
folder=$PWD/.rust
PATH=$folder/bin:$PATH:$HOME/.cargo/bin

# What the Rust on PATH lacks; nothing if it will do.
lacks() {
    found=$(cargo --version 2>/dev/null | cut -d ' ' -f 2)
    if [ "$(printf '%s\n' "$wanted" "${found:-0}" | sort -V | head -n 1)" != "$wanted" ]; then
        echo "Rust $wanted or newer is needed, found ${found:-none}"
        return
    fi
    # rustup has a proxy for each, installed or not.
    for command in "$@"; do
        "$command" --version >/dev/null 2>&1 || { echo "Rust is needed with $command"; return; }
    done
}

# Runs a command and keeps quiet; where it fails, `reason` is its first word about that.
try() {
    "$@" >"$temporary/log" 2>&1 && return
    reason=$(grep -m 1 -E '^(error|curl)' "$temporary/log" || tail -n 1 "$temporary/log")
    return 1
}

by_rustup() {
    try env RUSTUP_HOME="$folder/rustup" rustup toolchain install "$version" --no-self-update --profile minimal -c rustfmt -c clippy
}

by_installer() {
    command -v curl >/dev/null 2>&1 || try scripts/apt.sh curl ca-certificates || return
    try curl --proto '=https' --tlsv1.2 -sSfo "$temporary/installer" "$server/rustup/rustup-init.sh" || return
    try env RUSTUP_HOME="$folder/rustup" CARGO_HOME="$folder/cargo" RUSTUP_INIT_SKIP_PATH_CHECK=yes sh "$temporary/installer" -y \
        --no-modify-path --profile minimal --default-toolchain "$version" -c rustfmt -c clippy
}

lacking=$(lacks "$@")
[ -n "$lacking" ] || exit 0
echo "$lacking: installing Rust $version into the folder .rust"
temporary=$(mktemp -d)
trap 'rm -rf "$temporary"' EXIT
if command -v rustup >/dev/null 2>&1 || try scripts/apt.sh rustup; then
    by_rustup
else
    by_installer
fi || {
    echo "$lacking, and Rust $version cannot be installed: ${reason:-no reason given}; with a network that reaches" \
        "$server try again, or install Rust yourself: https://rustup.rs" >&2
    exit 1
}
# The link comes last: what was interrupted is not taken for complete.
for toolchain in "$folder/rustup/toolchains/$version"-*; do
    [ ! -d "$toolchain" ] || ln -sfn "rustup/toolchains/${toolchain##*/}/bin" "$folder/bin"
done
lacking=$(lacks "$@")
[ -z "$lacking" ] || { echo "$lacking, in .rust, too: rm -r .rust and try again" >&2; exit 1; }
