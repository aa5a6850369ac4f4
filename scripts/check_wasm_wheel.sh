#!/usr/bin/env bash
# Tries the wheel for WebAssembly: installs it in an environment of its own with wasmtime, and runs python/wasm/tests.
#   VANTAGE: the program whose volumes must have the same bytes (build/bin/vantage)
#   VANTAGE_SHARED: the folder that holds data/ (beside the checkout); PYTHON: python3
set -euo pipefail
cd "$(dirname "$0")/.."
folder=$PWD/build-web/python-tests
stamp=$folder/$(sha256sum python/wasm/requirements.lock | cut -c1-16).stamp
if [ ! -e "$stamp" ]; then
  rm -rf "$folder"
  "${PYTHON:-python3}" -m venv "$folder"
  "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --require-hashes --no-deps --only-binary=:all: \
    --requirement python/wasm/requirements.lock
  touch "$stamp"
fi
"$folder/bin/python" -m pip install --quiet --disable-pip-version-check --no-index --no-deps --force-reinstall dist/vantage-*-py3-none-any.whl
cd "$folder"  # not where the sources are
"$folder/bin/python" -c 'import vantage as vt; print("installed:", vt.__version__, vt.output_formats())'
"$folder/bin/python" -m pytest -q -p no:cacheprovider ../../python/wasm/tests
