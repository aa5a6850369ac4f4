#!/usr/bin/env bash
# Fetches the source releases that Debian does not package into .deps/, pinned by version and hash (sources.txt beside
# this script). Does nothing when they are already there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
deps="$here/../.deps"
stamp="$deps/$(sha256sum "$here/sources.txt" | cut -c1-16).stamp"
[ -e "$stamp" ] && exit 0
mkdir -p "$deps"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
echo "fetching source releases into .deps/"
if ! python3 "$here/fetch_releases.py" "$here/sources.txt" "$work"; then
  echo "could not fetch the releases pinned in scripts/sources.txt; is the Python package index reachable?" >&2
  exit 1
fi
for archive in "$work"/*.tar.gz; do tar -xzf "$archive" -C "$work"; done
rm -rf "$deps/manifold" "$deps/cdt" "$deps/highs"
mv "$work"/manifold3d-*/ "$deps/manifold"
mv "$work"/pythoncdt-*/CDT/CDT "$deps/cdt"
mv "$work"/highspy-*/ "$deps/highs"
touch "$stamp"
