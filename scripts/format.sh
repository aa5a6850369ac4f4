#!/usr/bin/env bash
# Formats our own C++ sources; with --check only says what is not formatted, exit 1 if anything.
set -euo pipefail
cd "$(dirname "$0")/.."
list=$(git ls-files --cached --others --exclude-standard '*.cpp' '*.h')  # a failure ends this script
files=()
while read -r file; do
  [ ! -e "$file" ] || files+=("$file")
done <<<"$list"
if [ ${#files[@]} -eq 0 ]; then
  echo "format: no sources found" >&2
  exit 1
fi
case "${1:-}" in
  "") clang-format -i "${files[@]}" ;;
  --check)
    wrong=()
    for file in "${files[@]}"; do
      clang-format --dry-run --Werror "$file" 2>/dev/null || wrong+=("$file")
    done
    if [ ${#wrong[@]} -gt 0 ]; then
      printf '%s\n' "${wrong[@]}" >&2
      echo "format: ${#wrong[@]} files are not formatted; run 'make format'" >&2
      exit 1
    fi
    ;;
  *) echo "usage: $0 [--check]" >&2; exit 2 ;;
esac
echo "format: ${#files[@]} files in order"
