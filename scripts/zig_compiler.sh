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
# What is to be linked before zig's own compiler-rt, so that nothing is taken from that: one object, which has sin, cos, exp,
# log and memcpy of its own beside what is needed, and these would take the place of glibc's.
# On other systems than Linux nothing is put before it.
runtime=$here/../cmake/zig_runtime.c
hypot=$here/../cmake/zig_hypot.c
archive=$folder/libvantage_zig.a
# compile_c_runtime: what x86-64 needs of it
compile_c_runtime() {
  "$folder/clang" -O2 -g0 -fPIC -fno-builtin -ffp-contract=off -fno-sanitize=all -fcf-protection -c "$runtime" -o "$folder/runtime.o"
}
# compile_zig_runtime: all of it but what glibc has. On aarch64 long double has 128 bits, and needs much of it.
compile_zig_runtime() {
  local source=$folder/compiler-rt lines
  rm -rf "$source"
  mkdir -p "$source"
  cp -r "$zig/python/ziglang/lib/compiler_rt.zig" "$zig/python/ziglang/lib/compiler_rt" "$source/"
  sed -i -E '\|// Math routines|,\|// BigInt|d; \|"compiler_rt/(memcpy\|memmove\|ssp)\.zig"|d; /symbol\(&(memset|memcmp|bcmp|strlen),/d' \
    "$source/compiler_rt.zig"
  sed -i '/symbol(&__divxc3,/d' "$source/compiler_rt/divc3.zig"  # of 80 bits, which no function of this processor takes
  (cd "$source" && ZIG_GLOBAL_CACHE_DIR=$zig/cache ZIG_LOCAL_CACHE_DIR=$zig/cache "$zig/python/ziglang/zig" build-obj \
    -target "$target" -O ReleaseFast -fPIC -fstrip -ffunction-sections --name runtime -femit-bin=../runtime.o compiler_rt.zig)
  lines=$(readelf -sW "$folder/runtime.o" | awk '
    $7 == "UND" && $8 !~ /^(memcpy|memset|fmaxl)?$/ { print $8 " is not defined" }
    $7 != "UND" && $8 ~ /^(sin|cos|tan|exp|exp2|log|log2|log10|fma|fmod|sqrt|memcpy|memset|strlen)$/ { print $8 " is defined" }')
  [ -z "$lines" ] || { echo "zig's compiler-rt is another one than expected: $lines" >&2; exit 1; }
}
# compile_hypot: in place of glibc's, on aarch64
compile_hypot() {
  "$folder/clang" -O2 -g0 -fPIC -fno-builtin-hypot -fno-math-errno -fvisibility=hidden -ffp-contract=off -fno-sanitize=all \
    -mbranch-protection=standard -c "$hypot" -o "$folder/hypot.o"
}
if [ "$archive" -ot "$runtime" ] || [ "$archive" -ot "$hypot" ] || [ "$archive" -ot "$0" ]; then
  rm -f "$archive"
  objects=("$folder/runtime.o")
  case $target in
    x86_64-linux-*) compile_c_runtime ;;
    aarch64-linux-*)
      compile_zig_runtime
      compile_hypot
      objects+=("$folder/hypot.o")
      ;;
    *) objects=() ;;
  esac
  "$folder/ar" rcs "$archive" "${objects[@]}"
fi
echo "$folder"
