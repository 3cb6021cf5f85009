#!/bin/sh
# The site, in BUILD/site, from a built tree:  make.sh BUILD
#
# The pages, the references of C, C++, Rust and Python, and a crowd in 3-D. What is installed suffices; only a pdoc or a Python
# package that is missing comes from PyPI, into BUILD/python/venv. Without them the site has no Python reference. PYTHON is the one
# that has markdown-it, REPLAY the path of swiftprox-replay.
set -eu
mkdir -p "$1"
build=$(cd "$1" && pwd)
cd "$(dirname "$0")/../.."
python=${PYTHON:-python3}
site=$build/site
rm -rf "$site"
mkdir -p "$site/reference"

docs/reference/make.sh "$build/docs"
cp -r "$build/docs/html" "$site/reference/c"

target=${CARGO_TARGET_DIR:-target}
rm -rf "$target/doc"
RUSTDOCFLAGS='-D warnings' cargo doc --locked --quiet --no-deps
cp -r "$target/doc" "$site/reference/rust"
# Its pages of help and settings go back to there.
echo '<!DOCTYPE html><meta http-equiv="refresh" content="0; url=swiftprox/index.html">' >"$site/reference/rust/index.html"

venv=$build/python/venv
[ -x "$venv/bin/pip" ] || "$python" -m venv "$venv" || true
{ "$venv/bin/python" -c 'import swiftprox' || "$venv/bin/pip" install --quiet --retries 1 .; } 2>/dev/null &&
    { "$venv/bin/python" -c 'import pdoc' || "$venv/bin/pip" install --quiet --retries 1 pdoc; } 2>/dev/null &&
    "$venv/bin/python" -m pdoc -o "$site/reference/python" swiftprox ||
    echo "no Python reference: the package or pdoc cannot be had"

"$python" scripts/page_scene.py 400 60 >"$build/crowd"
"${REPLAY:-$build/tools/swiftprox-replay}" "$build/crowd" --query contact --max-distance 0.5 --html "$site/crowd.html"

# The last: it links to what is there.
"$python" docs/site/pages.py "$site"
"$python" docs/site/test_site.py "$site"
