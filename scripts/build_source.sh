#!/usr/bin/env bash
# Makes the source files of a release from the last commit, into dist/:
#   vantage-VERSION.tar.xz                     the tree as it is in git
#   vantage_VERSION.orig.tar.xz and others     Debian's source package, with the releases of scripts/sources.txt as
#   vantage_VERSION-REVISION.dsc               additional tarballs, since a build of Debian has no network
# Needs Debian's dpkg-dev. The same commit gives the same bytes.
#   scripts/build_source.sh [FOLDER]
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
dist=${1:-$root/dist}
version=$(sed -n 's/.*VANTAGE_VERSION "\([^"]*\)".*/\1/p' include/vantage/version.h)
changed=$(git status --porcelain --untracked-files=no)
if [ -n "$changed" ]; then
  printf 'the source tarball holds the last commit, and these files differ from it: commit or restore them\n%s\n' "$changed" >&2
  exit 1
fi
revision=$(sed -n '1s/^vantage (\(.*\)) .*/\1/p' debian/changelog)
if [ "${revision%-*}" != "$version" ]; then
  echo "debian/changelog begins with version $revision, and include/vantage/version.h says $version" >&2
  exit 1
fi
releases=.deps/releases
while read -r pin _; do
  [[ $pin == *==* ]] || continue
  if [ ! -e "$releases/${pin/==/-}.tar.gz" ]; then
    mkdir -p "$releases"
    python3 scripts/fetch_releases.py scripts/sources.txt "$releases"
  fi
done <scripts/sources.txt
release() {  # release NAME: the file of a pinned release, whose hash is looked at again
  local pin sha256 file
  pin=$(grep "^$1==" scripts/sources.txt)
  sha256=${pin##*sha256:}
  pin=${pin%% *}
  file=$releases/${pin/==/-}.tar.gz
  echo "$sha256  $file" | sha256sum --check --quiet >&2
  echo "$file"
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
archive() {  # archive FILE [PATHSPEC...]
  local file=$1
  shift
  git archive --format=tar --prefix="vantage-$version/" HEAD "$@" | xz -6 -T1 >"$file"
}
mkdir -p "$dist"
rm -f "$dist"/vantage-*.tar.xz.new "$dist"/vantage_*.orig*.tar.* "$dist"/vantage_*.debian.tar.xz "$dist"/vantage_*.dsc
archive "$work/vantage-$version.tar.xz"
archive "$work/vantage_$version.orig.tar.xz" -- . ':(exclude)debian'
cp "$(release manifold3d)" "$work/vantage_$version.orig-manifold.tar.gz"
cp "$(release pythoncdt)" "$work/vantage_$version.orig-cdt.tar.gz"
cp "$(release highspy)" "$work/vantage_$version.orig-highs.tar.gz"
tar -xf "$work/vantage-$version.tar.xz" -C "$work"
for part in manifold cdt highs; do
  mkdir "$work/vantage-$version/$part"
  tar -xf "$work/vantage_$version.orig-$part.tar.gz" -C "$work/vantage-$version/$part" --strip-components=1
done
export SOURCE_DATE_EPOCH
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
(cd "$work" && dpkg-source --build "vantage-$version" >log 2>&1) || { tail -n 20 "$work/log" >&2; exit 1; }
mv "$work"/vantage-"$version".tar.xz "$work"/vantage_* "$dist"/
ls -s --block-size=K "$dist"/vantage-"$version".tar.xz "$dist"/vantage_*
