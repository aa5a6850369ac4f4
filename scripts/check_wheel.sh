#!/usr/bin/env bash
# Tries a wheel in a root of its own: Debian's Python, the C++ library that numpy loads too, numpy, the wheel, and nothing
# else; no network, no /proc, no /dev. Then the same with Debian's software OpenGL, which pictures need.
#   scripts/check_wheel.sh WHEEL [FOLDER]     FOLDER: where the roots are made (build-wheel/roots)
#   PROGRAM: a vantage that was built without the wheel (build/bin/vantage): the volumes must be its, byte for byte
# Needs no rights where users may make namespaces. Exit 0 only when all of it worked.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
[ $# -ge 1 ] || { echo "usage: $0 WHEEL [FOLDER]" >&2; exit 2; }
wheel=$(realpath "$1")
folder=$(realpath -m "${2:-$here/../build-wheel/roots}")
[[ $(basename "$wheel") == vantage-*-cp311-*.whl ]] || { echo "$wheel is no wheel for Debian's Python 3.11" >&2; exit 2; }
python=${PYTHON:-python3}
program=${PROGRAM:-$here/../build/bin/vantage}
rm -rf "$folder/expected"
mkdir -p "$folder/packages" "$folder/expected"
same=()
if [ -x "$program" ]; then
  same=(--expected /check/expected)
  for name in plaza town; do
    "$program" compute "$here/../examples/$name/mission.yaml" -o "$folder/expected/$name.ply" --quiet
  done
else
  echo "no program at $program: volumes are not compared with it"
fi
: >"$folder/nothing-installed"

# closure PACKAGE...: what apt would install for these on an empty system
closure() {
  apt-get -o Dir::State::status="$folder/nothing-installed" -o APT::Install-Recommends=0 -o Debug::NoLocking=1 \
    --simulate install "$@" | awk '/^Inst / { print $2 }'
}

# make_root NAME PACKAGE...
make_root() {
  local root=$folder/$1 name file
  shift
  rm -rf "$root"
  mkdir -p "$root/usr/bin" "$root/usr/sbin" "$root/usr/lib" "$root/usr/lib64" "$root/tmp" "$root/check"
  for name in bin sbin lib lib64; do ln -s "usr/$name" "$root/$name"; done
  for name in $(closure "$@"); do
    file=$(find "$folder/packages" -name "${name}_*.deb" -print -quit)
    if [ -z "$file" ]; then
      (cd "$folder/packages" && apt-get -q -q download "$name" 2>/dev/null)
      file=$(find "$folder/packages" -name "${name}_*.deb" -print -quit)
    fi
    # Through a tar, which follows the links that stand for merged folders.
    dpkg-deb --fsys-tarfile "$file" | tar -x -C "$root" --keep-directory-symlink --no-same-owner \
      --exclude='./usr/share/doc/*' --exclude='./usr/share/locale/*' --exclude='./usr/share/man/*'
  done
  local into=(--quiet --root-user-action=ignore --only-binary=:all: --python-version 3.11
    --target "$root/usr/lib/python3/dist-packages")
  "$python" -m pip --disable-pip-version-check install "${into[@]}" --no-deps --require-hashes \
    --requirement <(grep '^numpy==' "$here/../python/requirements.lock")
  "$python" -m pip --disable-pip-version-check install "${into[@]}" --no-deps --no-index "$wheel"
  cp -r "$here/../examples" "$here/check_wheel.py" "$here/read_elf.py" "$folder/expected" "$root/check/"
  echo "root $(basename "$root"): $(find "$root" -type f | wc -l) files; packages: $(closure "$@" | tr '\n' ' ')"
}

# in_root NAME ARGUMENT...: runs the check there
in_root() {
  local root=$folder/$1
  shift
  env -i HOME=/tmp PATH=/usr/bin LANG=C.UTF-8 unshare --user --map-root-user --net \
    "$(command -v chroot)" "$root" /usr/bin/python3.11 /check/check_wheel.py "$@"
}

make_root bare python3.11 libstdc++6
find "$folder/bare" \( -iname '*x11*' -o -iname '*proj.db' -o -iname '*.ttf' -o -iname '*libtbb*' -o -iname '*libcairo*' -o \
  -iname '*fontconfig*' \) -not -path '*/dist-packages/vantage/*' -not -path '*/check/*' | sed "s|^$folder||; s/^/unexpected: /" >"$folder/found"
if [ -s "$folder/found" ]; then cat "$folder/found"; exit 1; fi
in_root bare --no-opengl "${same[@]}"
make_root opengl python3.11 libstdc++6 libegl1 libgl1-mesa-dri
in_root opengl --picture /check/picture.png "${same[@]}"
cp "$folder/opengl/check/picture.png" "$folder/picture.png"
echo "wheel: works in a bare root; the picture is $folder/picture.png"
