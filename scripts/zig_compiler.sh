#!/usr/bin/env bash
# Makes .deps/zig/TARGET, with a C and a C++ compiler for another system, of zig from PyPI (pinned by hash in
# python/wheel/zig-requirements.lock), and prints that folder. Does nothing when it is there.
#   scripts/zig_compiler.sh TARGET       as zig names it: x86_64-linux-gnu.2.17
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
[ $# -eq 1 ] || { echo "usage: $0 TARGET" >&2; exit 2; }
target=$1
lock=$here/../python/wheel/zig-requirements.lock
zig=$(realpath -m "$here/../.deps/zig")
stamp=$zig/$(sha256sum "$lock" | cut -c1-16).stamp
if [ ! -e "$stamp" ]; then
  rm -rf "$zig"
  mkdir -p "$zig"
  if ! python3 -m pip install --quiet --disable-pip-version-check --root-user-action=ignore --require-hashes --no-deps \
    --only-binary=:all: --target "$zig/python" --requirement "$lock" >&2; then
    echo "could not install zig as $lock pins it: can the Python package index be reached?" >&2
    exit 1
  fi
  touch "$stamp"
fi
folder=$zig/$target
mkdir -p "$folder"
# write_command NAME ARGUMENT...: a command that calls zig so
write_command() {
  local file=$folder/$1
  shift
  cat >"$file.new" <<SCRIPT
#!/bin/sh
export ZIG_GLOBAL_CACHE_DIR="$zig/cache" ZIG_LOCAL_CACHE_DIR="$zig/cache"
exec "$zig/python/ziglang/zig" $* "\$@"
SCRIPT
  chmod +x "$file.new"
  mv "$file.new" "$file"
}
# Compilers are known to CMake and ccache by their names.
write_command clang cc -target "$target"
write_command clang++ c++ -target "$target"
write_command ar ar
write_command ranlib ranlib
# What is to be linked before zig's own compiler-rt, on Linux on x86-64 alone: elsewhere long double needs more of it.
runtime=$here/../cmake/zig_runtime.c
archive=$folder/libvantage_zig.a
if [ "$archive" -ot "$runtime" ]; then
  rm -f "$archive"
  if [[ $target == x86_64-linux-* ]]; then
    "$folder/clang" -O2 -g0 -fPIC -fno-builtin -ffp-contract=off -fno-sanitize=all -fcf-protection -c "$runtime" -o "$folder/runtime.o"
    "$folder/ar" rcs "$archive" "$folder/runtime.o"
  else
    "$folder/ar" rcs "$archive"
  fi
fi
echo "$folder"
