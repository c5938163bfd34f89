#!/usr/bin/env bash
# Builds and tests the presets that find faults which a release hides; `tidy` runs clang-tidy with the shipped config.
#
#   ./check.sh                    dev, asan, ubsan and tsan
#   ./check.sh asan               one of them
#   ./check.sh tidy [FILE...]     clang-tidy over all sources, or over these
#   JOBS=1 ./check.sh dev         with one processor
#
# Goes on after a failure; ends with one line for each, and exit code 1 when one failed.
set -uo pipefail
cd "$(dirname "$0")"
jobs="${JOBS:-$(nproc)}"

# Sizes out of damaged files are to be refused by an exception, as without a sanitizer, not to end the program.
export ASAN_OPTIONS="allocator_may_return_null=1 ${ASAN_OPTIONS:-}"
export LSAN_OPTIONS="suppressions='$PWD/cmake/lsan_suppressions.txt' print_suppressions=0 ${LSAN_OPTIONS:-}"
export TSAN_OPTIONS="suppressions='$PWD/cmake/tsan_suppressions.txt' ${TSAN_OPTIONS:-}"

test_preset() {
  cmake --preset "$1" >"build/$1.configure.log" 2>&1 || { cat "build/$1.configure.log"; return 1; }
  cmake --build --preset "$1" -j "$jobs" || return 1
  # Modules are loaded by the sanitizer's dlopen(), for which the program's own search path does not count.
  LD_LIBRARY_PATH="$PWD/build/$1/lib" ctest --preset "$1" -j "$jobs"
}

# All sources are read in the units of the release, which share their headers: in an eighth of the time.
tidy() {
  local preset=release units=("$@") options=()
  (($#)) && preset=dev
  cmake --preset "$preset" >build/tidy.configure.log 2>&1 || { cat build/tidy.configure.log; return 1; }
  cmake --build --preset "$preset" --target roomgraph_revision || return 1
  if ! (($#)); then
    mapfile -t units < <(grep -o '"file": "[^"]*"' build/release/compile_commands.json | cut -d '"' -f 4 | grep -v "^$PWD/\(build/release/\)\?tests/")
    options=(--checks=-bugprone-suspicious-include --header-filter='/(libs|apps|plugins)/')
  fi
  printf '%s\n' "${units[@]}" |
    xargs -d '\n' -P "$jobs" -n 1 clang-tidy -p "build/$preset" --quiet --warnings-as-errors='*' "${options[@]}" 2>/dev/null
}

case "${1:-}" in
  -h | --help) sed -n '2,/^set /s/^# \{0,1\}//p' "$0"; exit 0 ;;
esac
mkdir -p build
checks=("$@")
((${#checks[@]})) || checks=(dev asan ubsan tsan)
if [ "${checks[0]}" = tidy ]; then
  tidy "${checks[@]:1}" && echo "tidy: clean"
  exit
fi
for check in "${checks[@]}"; do
  case "$check" in
    dev | release | asan | ubsan | tsan | coverage) ;;
    *) echo "check.sh: no preset '$check'; there are dev, release, asan, ubsan, tsan, coverage, and tidy" >&2; exit 2 ;;
  esac
done

failed=0
summary=()
for check in "${checks[@]}"; do
  started=$SECONDS
  if test_preset "$check"; then outcome=passed; else outcome=FAILED failed=1; fi
  summary+=("$(printf '%-8s %s in %d min' "$check" "$outcome" "$(((SECONDS - started + 59) / 60))")")
done
printf '%s\n' "${summary[@]}"
exit "$failed"
