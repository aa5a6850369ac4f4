#!/usr/bin/env bash
# Installs the npm packages of this folder, as package-lock.json has them, where they are not there yet.
set -euo pipefail
cd "$(dirname "$0")"
if ! cmp -s package-lock.json node_modules/.installed.json; then
  npm ci --ignore-scripts --no-audit --no-fund --loglevel=error
  cp package-lock.json node_modules/.installed.json
fi
