#!/usr/bin/env bash
# Builds the fuzz targets and runs each for a while, two at a time, beginning with its corpus (fuzz/README.md says what they check):
#
#   fuzz.sh SECONDS [TARGET ...]
#
# What fails is kept in fuzz/artifacts, with the command that repeats it; what is new on the way in the build folder.
set -euo pipefail
cd "$(dirname "$0")/../fuzz"
limits="-max_total_time=$1"
shift
targets=("$@")
((${#targets[@]})) || targets=(mesh_readers shape_files recordings hull pairs swept compounds grounds casts rays c_calls)

cargo=(cargo)
wanted=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' ../Cargo.toml)
nightly=$(cargo +nightly --version 2>/dev/null | cut -d ' ' -f 2 || true)
if [ "$(printf '%s\n' "$wanted" "${nightly:-0}" | sort -V | head -n 1)" = "$wanted" ]; then
    cargo+=(+nightly)
else
    echo "fuzz: no nightly Rust $wanted or newer (rustup toolchain install nightly), so without the address sanitizer"
fi
export CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}/fuzz"
RUSTC_WRAPPER="$PWD/rustc.sh" "${cargo[@]}" build --locked --profile checked --features libfuzzer --bins

export TMPDIR=$(mktemp -d)
trap 'rm -rf "$TMPDIR"' EXIT
# Short stacks of allocations, and freed memory kept for 16 MB: several times as many executions a second.
export ASAN_OPTIONS=malloc_context_size=4:detect_stack_use_after_return=0:quarantine_size_mb=16

# One target; says how many executions there were, or all of it if it fails.
run() {
    local target=$1 limits=$2 program="$CARGO_TARGET_DIR/checked/$1" new="$CARGO_TARGET_DIR/corpus/$1" log="$TMPDIR/$1.log"
    mkdir -p "$new" "artifacts/$target"
    if "$program" "$new" "corpus/$target" $limits -max_len=512 -timeout=60 \
        -rss_limit_mb=2048 -malloc_limit_mb=256 -artifact_prefix="artifacts/$target/" -print_final_stats=1 >"$log" 2>&1; then
        echo "fuzz: $target: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") executions, $(
            sed -n 's/.*\(cov: [0-9]*\).*/\1/p' "$log" | tail -n 1) edges, no failure"
    else
        grep -avE '^#[0-9]+.*(NEW|REDUCE|pulse|RELOAD)' "$log" | tail -n 150
        echo "fuzz: $target failed; again: $program fuzz/artifacts/$target/..."
        return 1
    fi
}
export -f run
printf '%s\n' "${targets[@]}" | xargs -P 2 -I {} bash -c 'run {} "'"$limits"'"'
