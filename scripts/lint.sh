#!/usr/bin/env bash
# clang-tidy with .clang-tidy over our own sources, exit 1 on any finding.
#   scripts/lint.sh              all sources
#   scripts/lint.sh --library    those of the libraries, the program and the Python package, where it is built
#   scripts/lint.sh --changed    those that differ from the branch main
#   scripts/lint.sh --recent     those that the last 25 commits changed (all, where the history is shorter)
#   scripts/lint.sh FILE...      these
# Needs the compile commands of a build (make build; BUILD: its folder). JOBS: how many at once. What was found clean is not
# checked again until it, something that it includes, the rules or clang-tidy change (kept in ~/.cache/vantage-lint;
# VANTAGE_LINT_CACHE names another folder).
set -euo pipefail
cd "$(dirname "$0")/.."
build=${BUILD:-build}
if [ ! -e $build/compile_commands.json ]; then
  echo "no $build/compile_commands.json: run 'make build' first" >&2
  exit 1
fi
case "${1:-}" in
  --library)
    list=$(git ls-files 'src/**/*.cpp' 'python/src/*.cpp')
    ;;
  "") list=$(git ls-files 'src/**/*.cpp' 'python/src/*.cpp' 'bench/*.cpp' 'tests/*.cpp') ;;
  --changed)
    list=$(git diff --name-only main && git ls-files --others --exclude-standard)
    list=$(grep -E '^(src|python|bench|tests)/.*\.cpp$' <<<"$list" | sort -u) || true
    ;;
  --recent)
    if first=$(git rev-parse --quiet --verify HEAD~25); then list=$(git diff --name-only --diff-filter=d "$first")
    else list=$(git ls-files); fi
    list=$(grep -E '^(src|python)/.*\.cpp$' <<<"$list") || true
    ;;
  *) list=$(printf '%s\n' "$@") ;;
esac
# Only what the build compiles: fuzz targets and the consumer test have builds of their own. Files are compared as they
# really lie, and checked under the name that the build knows: this folder may have been entered by a symbolic link.
# Where the build joins sources (JOIN_SOURCES=ON), what includes them is checked.
declare -A known
while read -r file; do
  known[$(realpath -m -- "$file")]=$file
  case $file in
    */Unity/unity_*)
      while read -r joined; do known[$(realpath -m -- "$joined")]=$file; done \
        < <(sed -n 's/^#include "\(.*\)"$/\1/p' "$file")
      ;;
  esac
done < <(sed -n 's/^ *"file": "\(.*\)",\{0,1\}$/\1/p' $build/compile_commands.json)
sources=()
declare -A chosen
while read -r file; do
  unit=
  [ -z "$file" ] || unit=${known[$(realpath -m -- "$file")]:-}
  [ -z "$unit" ] || { sources+=("$file"); chosen[$unit]=1; }
done <<<"$list"
mapfile -t compiled < <(printf '%s\n' "${!chosen[@]}" | sort)
if [ ${#sources[@]} -eq 0 ]; then
  if [[ "${1:-}" =~ ^--(changed|recent)$ ]] && [ ${#known[@]} -gt 0 ]; then
    echo "lint: nothing to check"
    exit 0
  fi
  echo "lint: none of the files is among the ${#known[@]} that $build/compile_commands.json compiles" >&2
  exit 1
fi
# clang-tidy 20 has modernize-use-std-numbers for this.
mapfile -t headers < <(git ls-files '*.h' 2>/dev/null)
if grep -nE '\<M_(E|LOG2E|LOG10E|LN2|LN10|PI|PI_2|PI_4|1_PI|2_PI|2_SQRTPI|SQRT2|SQRT1_2)\>|\<3\.1415|\<6\.2831|\<1\.5707|\<2\.7182|\<1\.4142' "${sources[@]}" "${headers[@]}"; then
  echo "lint: such constants are in <numbers>" >&2
  exit 1
fi
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# Its own counts of suppressed warnings in system headers go to standard error: noise.
if ! printf '%s\0' "${compiled[@]}" |
  xargs -0 -I FILE -P "${JOBS:-$(nproc)}" python3 scripts/lint_file.py $build FILE 2>"$log"; then
  grep -vE 'warnings? (generated|treated as error)' "$log" >&2 || true
  echo "lint: findings above" >&2
  exit 1
fi
echo "lint: ${#sources[@]} files clean"
