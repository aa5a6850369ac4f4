#!/usr/bin/env bash
# Fetches the source releases that Debian does not package into .deps/, pinned by version and hash (requirements file
# beside this script). Does nothing when they are already there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
deps="$here/../.deps"
stamp="$deps/$(sha256sum "$here/sources.txt" | cut -c1-16).stamp"
[ -e "$stamp" ] && exit 0
mkdir -p "$deps"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "fetching source releases into .deps/"
python3 -m pip download --quiet --disable-pip-version-check --no-deps --no-binary :all: --require-hashes \
  --dest "$work" -r "$here/sources.txt"
for archive in "$work"/*.tar.gz; do tar -xzf "$archive" -C "$work"; done
rm -rf "$deps/manifold" "$deps/cdt"
mv "$work"/manifold3d-*/ "$deps/manifold"
mv "$work"/pythoncdt-*/CDT/CDT "$deps/cdt"
touch "$stamp"
