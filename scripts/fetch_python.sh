#!/usr/bin/env bash
# Makes .deps/python, a Python environment with what python/requirements.lock pins, by version and hash. Does nothing when
# it is there. scripts/pin_python.py makes the lock from python/requirements.txt, for CPython 3.11 to 3.13 on x86-64 and
# aarch64 Linux. For others VANTAGE_PYTHON_LOCK names a lock of one's own.
#   scripts/fetch_python.sh jupyter     the same for .deps/jupyter and python/jupyter-requirements.lock
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
name=${1:-python}
folder="$here/../.deps/$name"
requirements=requirements
[ "$name" = python ] || requirements=$name-requirements
lock=${VANTAGE_PYTHON_LOCK:-$here/../python/$requirements.lock}
stamp="$folder/$(sha256sum "$lock" | cut -c1-16).stamp"
[ -e "$stamp" ] && exit 0
echo "making a Python environment in .deps/$name"
rm -rf "$folder"
mkdir -p "$(dirname "$folder")"
if ! python3 -m venv "$folder"; then
  echo "python3 cannot make environments: on Debian, install python3-venv" >&2
  exit 1
fi
if ! "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --require-hashes --no-deps --only-binary=:all: \
  --requirement "$lock"; then
  cat >&2 <<TEXT
could not install what $lock pins. Can the Python package index be reached? The lock is for CPython 3.11
to 3.13 on x86-64 and aarch64 Linux. For another Python or processor make a lock of your own, and name it:
  mkdir -p .deps && scripts/pin_python.py --into .deps python/$requirements.txt
  VANTAGE_PYTHON_LOCK=\$PWD/.deps/$requirements.lock scripts/fetch_python.sh $name
TEXT
  exit 1
fi
touch "$stamp"
