#!/bin/sh
# Installs Debian packages where that is possible without asking. Else one line on stderr says why not, and what would.
#
#   apt.sh PACKAGE ...
line="apt-get install -y --no-install-recommends $*"
if ! command -v apt-get >/dev/null 2>&1; then
    echo "missing: $*, by the names of Debian's packages; install them and try again" >&2
    exit 1
elif [ "$(id -u)" = 0 ]; then
    as_root=
elif sudo -n true 2>/dev/null; then
    as_root=sudo
else
    echo "missing: $*; sudo $line" >&2
    exit 1
fi

echo "installing: $line"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# A source that is out of reach need not be the one that has the packages: whether they are there the second command says.
$as_root apt-get update -qq >"$log" 2>&1
if ! $as_root env DEBIAN_FRONTEND=noninteractive $line -qq >>"$log" 2>&1; then
    reason=$(grep -m 1 '^E:' "$log" || grep -m 1 '^W:' "$log" || tail -n 1 "$log")
    echo "apt-get cannot install $*: ${reason#?: }; with a network that reaches Debian's mirrors, try again: $line" >&2
    exit 1
fi
