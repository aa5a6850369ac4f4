#!/usr/bin/env bash
# Makes .deps/python, a Python environment with what python/requirements.lock pins, by version and hash. Does nothing when
# it is there. scripts/pin_python.py makes the lock from python/requirements.txt.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
folder="$here/../.deps/python"
stamp="$folder/$(sha256sum "$here/../python/requirements.lock" | cut -c1-16).stamp"
[ -e "$stamp" ] && exit 0
echo "making a Python environment in .deps/python"
rm -rf "$folder"
mkdir -p "$(dirname "$folder")"
if ! python3 -m venv "$folder"; then
  echo "python3 cannot make environments: on Debian, install python3-venv" >&2
  exit 1
fi
if ! "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --require-hashes --no-deps --only-binary=:all: \
  --requirement "$here/../python/requirements.lock"; then
  echo "could not install what python/requirements.lock pins, for CPython 3.11 on x86-64 Linux; is the Python package index" \
    "reachable? For another Python or processor, run scripts/pin_python.py python/requirements.txt" >&2
  exit 1
fi
touch "$stamp"
