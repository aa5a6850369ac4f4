#!/usr/bin/env bash
# Makes .deps/python, a Python environment with what python/requirements.txt pins. Does nothing when it is there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
folder="$here/../.deps/python"
stamp="$folder/$(sha256sum "$here/../python/requirements.txt" | cut -c1-16).stamp"
[ -e "$stamp" ] && exit 0
echo "making a Python environment in .deps/python"
rm -rf "$folder"
mkdir -p "$(dirname "$folder")"
if ! python3 -m venv "$folder"; then
  echo "python3 cannot make environments: on Debian, install python3-venv" >&2
  exit 1
fi
if ! "$folder/bin/python" -m pip install --quiet --disable-pip-version-check --requirement "$here/../python/requirements.txt"; then
  echo "could not install what python/requirements.txt pins; is the Python package index reachable?" >&2
  exit 1
fi
touch "$stamp"
