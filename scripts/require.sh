#!/bin/sh
# Installs what is missing, on Debian and its like where that is possible without asking; else prints the line that does.
# Asks for Rust in any case, which no distribution of today has new enough.
#
#   require.sh COMMAND_OR_FILE=PACKAGE ...
missing=
for pair in "$@"; do
    needed=${pair%%=*}
    command -v "$needed" >/dev/null 2>&1 || [ -e "$needed" ] || missing="$missing ${pair#*=}"
done
if [ -n "$missing" ]; then
    line="apt-get install -y --no-install-recommends$missing"
    if command -v apt-get >/dev/null 2>&1 && [ "$(id -u)" = 0 ]; then
        apt-get update -q && DEBIAN_FRONTEND=noninteractive $line || exit 1
    elif command -v apt-get >/dev/null 2>&1 && sudo -n true 2>/dev/null; then
        sudo apt-get update -q && sudo DEBIAN_FRONTEND=noninteractive $line || exit 1
    else
        echo "missing:$missing; on Debian: sudo $line" >&2
        exit 1
    fi
fi

wanted=$(sed -n 's/^rust-version = "\(.*\)"/\1/p' "$(dirname "$0")/../Cargo.toml")
found=$(cargo --version 2>/dev/null | cut -d ' ' -f 2)
if [ "$(printf '%s\n' "$wanted" "${found:-0}" | sort -V | head -n 1)" != "$wanted" ]; then
    echo "Rust $wanted or newer is needed, found ${found:-none}: curl --proto '=https' --tlsv1.2 -sSf https://sh.rustup.rs | sh" >&2
    exit 1
fi
