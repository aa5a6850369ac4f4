#!/usr/bin/env bash
# Builds a wheel into dist/ that needs nothing but Python, numpy and what every Linux system of its tag has. Its libraries
# are built once, into .deps/wheel (wheel_libraries.toml beside this script says which, and from what).
#   scripts/build_wheel.sh        PYTHON: for which interpreter (python3)
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD
jobs=${JOBS:-$(nproc)}
python=${PYTHON:-python3}
deps=$root/.deps/wheel

scripts/build_wheel_libraries.py --jobs "$jobs"

# An environment of this interpreter with the tools.
tag=$("$python" -c 'import sys; print(f"cp{sys.version_info[0]}{sys.version_info[1]}")')
tools=$deps/python-$tag
stamp=$tools/$(sha256sum python/wheel-requirements.lock | cut -c1-16).stamp
if [ ! -e "$stamp" ]; then
  rm -rf "$tools"
  "$python" -m venv "$tools"
  "$tools/bin/python" -m pip install --quiet --disable-pip-version-check --require-hashes --no-deps --only-binary=:all: \
    --requirement python/wheel-requirements.lock
  touch "$stamp"
fi

build=$root/build-wheel/$tag
rm -rf "$build/raw"
# Linking writes the map that the list of licences is made of: without one, the module is linked again.
[ -e "$build/cmake/python/vantage_python.map" ] || rm -f "$build"/cmake/python/vantage/_core.*.so
# What CMake remembers of libraries holds until they are built anew.
if [ -n "$(find "$deps" -maxdepth 1 -name '*.stamp' -newer "$build/cmake/CMakeCache.txt" 2>/dev/null)" ]; then
  rm -f "$build/cmake/CMakeCache.txt"
fi
mkdir -p "$build/raw" dist
PATH=$tools/bin:$PATH CMAKE_PREFIX_PATH=$deps/prefix PKG_CONFIG_LIBDIR=$deps/prefix/lib/pkgconfig \
CMAKE_BUILD_PARALLEL_LEVEL=$jobs "$tools/bin/python" -m pip wheel --disable-pip-version-check --no-deps --no-build-isolation \
  --wheel-dir "$build/raw" --verbose \
  --config-settings=build-dir="$build/cmake" \
  --config-settings=cmake.args=-GNinja \
  --config-settings=cmake.define.CMAKE_PREFIX_PATH="$deps/prefix" \
  --config-settings=cmake.define.PKG_CONFIG_ARGN=--static \
  --config-settings=cmake.define.VANTAGE_LINK_PROJ=ON \
  --config-settings=cmake.define.VANTAGE_WITH_DRACO=OFF \
  --config-settings=cmake.define.VANTAGE_WITH_MESHOPT=OFF \
  --config-settings=cmake.define.VANTAGE_WHEEL=ON \
  . >"$build/log" 2>&1 </dev/null || { tail -n 40 "$build/log" >&2; echo "the whole log: $build/log" >&2; exit 1; }
grep -h '^licences:' "$build/log" || true

# Nothing is left to bundle: this names the systems that the wheel fits. Those of build_portable_wheels.py fit older ones.
rm -f dist/vantage-*-"$tag"-manylinux_2_3?_*.whl
PATH=$tools/bin:$PATH "$tools/bin/python" -m auditwheel repair --wheel-dir dist "$build"/raw/vantage-*.whl >>"$build/log" 2>&1 ||
  { tail -n 20 "$build/log" >&2; exit 1; }
"$tools/bin/python" scripts/wheel_licences.py check dist/vantage-*-"$tag"-manylinux_2_3?_*.whl
"$tools/bin/python" -m zipfile --list dist/vantage-*-"$tag"-manylinux_2_3?_*.whl | grep -q share/web/index.html ||
  echo "the page of \`vantage view\` is not in it: run \`make web\` first"
du -h dist/vantage-*-"$tag"-manylinux_2_3?_*.whl
