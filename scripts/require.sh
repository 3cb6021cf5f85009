#!/bin/sh
# Installs what is missing: Debian packages (scripts/apt.sh), Rust (scripts/rust.sh), and the crates of Cargo.lock. What cannot be
# had ends in one line on stderr.
#
#   require.sh NEEDED=PACKAGE ...        a command; a file, which has a slash in its name; or PYTHON:MODULE
scripts=${0%/*}
missing=
for pair in "$@"; do
    needed=${pair%%=*}
    case $needed in
    *:*) "${needed%%:*}" -c "import ${needed#*:}" >/dev/null 2>&1 ;;
    */*) [ -e "$needed" ] ;;
    *) command -v "$needed" >/dev/null 2>&1 ;;
    esac || missing="$missing ${pair#*=}"
done
# Unquoted: each word is a package.
[ -z "$missing" ] || "$scripts/apt.sh" $missing || exit 1
"$scripts/rust.sh" || exit 1

cd "$scripts/.." || exit 1
PATH=$PWD/.rust/bin:$PATH:$HOME/.cargo/bin
if ! errors=$(cargo fetch --locked --quiet 2>&1); then
    echo "the crates of Cargo.lock cannot be fetched:" $(printf '%s\n' "$errors" | grep -v '^Caused by:\|^$') >&2
    exit 1
fi
