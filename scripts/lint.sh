#!/usr/bin/env bash
# clang-tidy with .clang-tidy over our own sources, exit 1 on any finding.
#   scripts/lint.sh              all sources
#   scripts/lint.sh --changed    those that differ from the branch main
#   scripts/lint.sh FILE...      these
# Needs the compile commands of the release build (make build). JOBS: how many at once.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build
if [ ! -e $build/compile_commands.json ]; then
  echo "no $build/compile_commands.json: run 'make build' first" >&2
  exit 1
fi
case "${1:-}" in
  "") mapfile -t files < <(git ls-files 'src/**/*.cpp' 'bench/*.cpp' 'tests/*.cpp') ;;
  --changed) mapfile -t files < <({ git diff --name-only main; git ls-files --others --exclude-standard; } |
      grep -E '^(src|bench|tests)/.*\.cpp$' | sort -u) ;;
  *) files=("$@") ;;
esac
# Only what the build compiles: fuzz targets and the consumer test have builds of their own.
compiled=()
for file in "${files[@]}"; do
  ! grep -qF "\"$PWD/$file\"" $build/compile_commands.json || compiled+=("$file")
done
if [ ${#compiled[@]} -eq 0 ]; then
  echo "lint: nothing to check"
  exit 0
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# Its own counts of suppressed warnings in system headers go to standard error: noise.
if ! printf '%s\0' "${compiled[@]}" |
  xargs -0 -n 1 -P "${JOBS:-$(nproc)}" timeout 600 clang-tidy --quiet -p $build 2>"$log"; then
  grep -vE 'warnings? (generated|treated as error)' "$log" >&2 || true
  echo "lint: findings above" >&2
  exit 1
fi
echo "lint: ${#compiled[@]} files clean"
