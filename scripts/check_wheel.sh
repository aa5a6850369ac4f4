#!/usr/bin/env bash
# Tries a wheel in a root of its own: Debian's Python, the C++ library that numpy loads too, numpy, the wheel, and nothing
# else; no network, no /proc, no devices. Then the same with Debian's software OpenGL, which pictures need. Wheels for
# CPython 3.11 are tried with Debian 12, those for the stable ABI with Python 3.13 of Debian 13; those for aarch64 with
# qemu-aarch64-static of Debian's qemu-user-static, without OpenGL.
#   scripts/check_wheel.sh WHEEL [FOLDER]     FOLDER: where the roots are made (build-wheel/roots)
#   PROGRAM: a vantage that was built without the wheel (build/bin/vantage): the volumes must be its, byte for byte
# Needs no rights where users may make namespaces. Exit 0 only when all of it worked.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
[ $# -ge 1 ] || { echo "usage: $0 WHEEL [FOLDER]" >&2; exit 2; }
wheel=$(realpath "$1")
folder=$(realpath -m "${2:-$here/../build-wheel/roots}")
case $(basename "$wheel") in
  vantage-*-cp311-cp311-*) suite=bookworm interpreter=python3.11 ;;
  vantage-*-cp312-abi3-*) suite=trixie interpreter=python3.13 ;;
  *) echo "$wheel is neither for CPython 3.11 nor for the stable ABI of CPython 3.12" >&2; exit 2 ;;
esac
case $wheel in
  *_x86_64.whl) processor=x86_64 architecture=amd64 emulator= ;;
  *_aarch64.whl) processor=aarch64 architecture=arm64 emulator=qemu-aarch64-static ;;
  *) echo "$wheel is neither for x86-64 nor for aarch64" >&2; exit 2 ;;
esac
if [ -n "$emulator" ] && ! command -v "$emulator" >/dev/null; then
  echo "there is no $emulator: install Debian's qemu-user-static" >&2
  exit 1
fi
python=${PYTHON:-python3}
program=${PROGRAM:-$here/../build/bin/vantage}
packages=$folder/packages-$suite-$architecture
rm -rf "$folder/expected"
mkdir -p "$packages/partial" "$packages/lists/partial" "$packages/archives/partial" "$folder/expected"
same=()
if [ -x "$program" ]; then
  same=(--expected /check/expected)
  for name in plaza town; do
    "$program" compute "$here/../examples/$name/mission.yaml" -o "$folder/expected/$name.ply" --quiet
  done
  "$python" "$here/../python/wheel/same_bytes.py" --program "$program" >"$folder/expected/volumes.csv"
else
  echo "no program at $program: volumes are not compared with it"
fi
: >"$folder/nothing-installed"
# What apt knows of that Debian, apart from what it knows for this machine.
archive=$(cd "$here" && "$python" -c 'import debian_archive; print(debian_archive.archives()[0])')
echo "deb [signed-by=/usr/share/keyrings/debian-archive-keyring.gpg] $archive $suite main" >"$packages/sources.list"
apt=(-q -q -o APT::Architecture="$architecture" -o APT::Architectures::="$architecture" -o Dir::Etc::sourcelist="$packages/sources.list"
  -o Dir::Etc::sourceparts=- -o Dir::State::lists="$packages/lists" -o Dir::Cache="$packages"
  -o Dir::State::status="$folder/nothing-installed" -o APT::Install-Recommends=0 -o Debug::NoLocking=1 -o APT::Sandbox::User=root)
apt-get "${apt[@]}" update

# closure PACKAGE...: what apt would install for these on an empty system
closure() {
  apt-get "${apt[@]}" -q=0 --simulate install "$@" | awk '/^Inst / { print $2 }'
}

# make_root NAME PACKAGE...
make_root() {
  local root=$folder/$1 name file names
  shift
  rm -rf "$root"
  mkdir -p "$root/usr/bin" "$root/usr/sbin" "$root/usr/lib" "$root/usr/lib64" "$root/tmp" "$root/check" "$root/dev"
  head -c 65536 /dev/urandom >"$root/dev/urandom"  # every system has one; `vantage view` makes its token of it
  for name in bin sbin lib lib64; do ln -s "usr/$name" "$root/$name"; done
  names=$(closure "$@")
  for name in $names; do
    file=$(find "$packages" -name "${name}_*.deb" -print -quit)
    if [ -z "$file" ]; then
      (cd "$packages" && apt-get "${apt[@]}" download "$name" 2>/dev/null)
      file=$(find "$packages" -name "${name}_*.deb" -print -quit)
    fi
    # Through a tar, which follows the links that stand for merged folders.
    dpkg-deb --fsys-tarfile "$file" | tar -x -C "$root" --keep-directory-symlink --no-same-owner \
      --exclude='./usr/share/doc/*' --exclude='./usr/share/locale/*' --exclude='./usr/share/man/*'
  done
  local version=${interpreter#python} platform into
  into=(--quiet --root-user-action=ignore --only-binary=:all: --python-version "$version" --target "$root/usr/lib/python3/dist-packages")
  for platform in 2014 _2_17 _2_27 _2_28 _2_34 _2_35; do into+=(--platform "manylinux${platform}_$processor"); done
  "$python" -m pip --disable-pip-version-check install "${into[@]}" --no-deps --require-hashes \
    --requirement <(grep '^numpy==' "$here/../python/requirements.lock")
  "$python" -m pip --disable-pip-version-check install "${into[@]}" --no-deps --no-index "$wheel"
  cp -r "$here/../examples" "$here/check_wheel.py" "$here/read_elf.py" "$here/../python/wheel/same_bytes.py" \
    "$here/../python/wheel/dutch_cube.city.json" "$folder/expected" "$root/check/"
  PYTHONPATH=$here/../tests/hostile "$python" -c 'import pathlib, sys, tilesets
pathlib.Path(sys.argv[1], "draco.glb").write_bytes(tilesets.draco(tilesets.DRACO[1]))
pathlib.Path(sys.argv[1], "meshopt.glb").write_bytes(tilesets.meshopt())' "$root/check"
  if [ -n "$emulator" ]; then cp "$(command -v "$emulator")" "$root/usr/bin/"; fi
  echo "root $(basename "$root"): $(find "$root" -type f | wc -l) files; packages: ${names//$'\n'/ }"
}

# in_root NAME ARGUMENT...: runs the check there
in_root() {
  local root=$folder/$1
  shift
  env -i HOME=/tmp PATH=/usr/bin LANG=C.UTF-8 unshare --user --map-root-user --net \
    "$(command -v chroot)" "$root" ${emulator:+/usr/bin/$emulator} "/usr/bin/$interpreter" /check/check_wheel.py "$@" \
    ${emulator:+--run-by "/usr/bin/$emulator"}
}

make_root bare "$interpreter" libstdc++6
find "$folder/bare" \( -iname '*x11*' -o -iname '*proj.db' -o -iname '*.ttf' -o -iname '*libtbb*' -o -iname '*libcairo*' -o \
  -iname '*fontconfig*' \) -not -path '*/dist-packages/vantage/*' -not -path '*/check/*' | sed "s|^$folder||; s/^/unexpected: /" >"$folder/found"
if [ -s "$folder/found" ]; then cat "$folder/found"; exit 1; fi
in_root bare --no-opengl "${same[@]}"
if [ -n "$emulator" ]; then
  echo "wheel: works in a bare root, under $emulator"
  exit 0
fi
make_root opengl "$interpreter" libstdc++6 libegl1 libgl1-mesa-dri
in_root opengl --picture /check/picture.png "${same[@]}"
cp "$folder/opengl/check/picture.png" "$folder/picture.png"
echo "wheel: works in a bare root; the picture is $folder/picture.png"
