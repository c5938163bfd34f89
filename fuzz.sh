#!/usr/bin/env bash
# Fuzzes the readers of files with libFuzzer, AddressSanitizer and UndefinedBehaviorSanitizer.
#
#   ./fuzz.sh SECONDS               every target for so many seconds, one after the other
#   ./fuzz.sh SECONDS TARGET...     these targets
#   ./fuzz.sh --list                the targets
#   ./fuzz.sh --replay TARGET FILE  one input again, with the whole report
#
# Builds what is needed of the preset `fuzz` first (clang and libclang-rt-14-dev; JOBS=1 for one processor), and fuzz_seeds of
# `release`. Corpora start with the seeds of fuzz/seeds and grow in build/fuzz/corpus/TARGET; the input and the report of a finding stay in build/fuzz/findings.
# Exit code 1 when there is a finding.
set -uo pipefail
cd "$(dirname "$0")"
jobs="${JOBS:-$(nproc)}"

case "${1:---help}" in
  -h | --help) sed -n '2,/^set /s/^# \{0,1\}//p' "$0" | sed '/^set /d'; exit 0 ;;
esac
command -v clang++ >/dev/null || { echo "fuzz.sh: no clang++; apt-get install clang libclang-rt-14-dev" >&2; exit 2; }
mkdir -p build/fuzz/corpus build/fuzz/findings

all_targets="$(sed -n 's/^ROOMGRAPH_FUZZ_TARGET(\(.*\)) {.*/\1/p' fuzz/targets/*.cpp | sort)"
# Targets of one file are one program.
program_of() { echo "fuzz_$(basename "$(grep -l "^ROOMGRAPH_FUZZ_TARGET($1)" fuzz/targets/*.cpp)" .cpp)"; }

build() {  # preset, programs
  local preset="$1" log="build/fuzz/build_$1.log"
  shift
  { cmake --preset "$preset" && nice -n 15 cmake --build --preset "$preset" -j "$jobs" --target "$@"; } >"$log" 2>&1 ||
    { tail -n 40 "$log"; exit 2; }
}

# Sizes out of damaged files are refused by an exception, as without a sanitizer. The plain operators new and delete are our
# own, those of arrays the sanitizer's: it would take them for a mismatch.
export ASAN_OPTIONS="allocator_may_return_null=1:alloc_dealloc_mismatch=0:quarantine_size_mb=16 ${ASAN_OPTIONS:-}"
export LSAN_OPTIONS="suppressions='$PWD/cmake/lsan_suppressions.txt' print_suppressions=0 ${LSAN_OPTIONS:-}"
export UBSAN_OPTIONS="print_stacktrace=1 ${UBSAN_OPTIONS:-}"
# Files of the readers are in memory.
TMPDIR="$(mktemp -d /dev/shm/roomgraph_fuzz.XXXXXX)" || exit 2
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT

# An input of some kilobytes must not need gigabytes.
limits=(-timeout=5 -rss_limit_mb=2048 -malloc_limit_mb=400)
if [ "$1" = --list ]; then
  echo "$all_targets"
  exit 0
elif [ "$1" = --replay ]; then
  program="$(program_of "${2:?target}")"
  build fuzz "$program"
  ROOMGRAPH_FUZZ_TELL=1 ROOMGRAPH_FUZZ_TARGET="$2" "build/fuzz/bin/$program" "${limits[@]}" "${3:?file}"
  exit
fi

seconds="$1"
shift
[[ "$seconds" =~ ^[1-9][0-9]*$ ]] || { echo "fuzz.sh: '$seconds' is no number of seconds" >&2; exit 2; }
targets=("$@")
(($#)) || mapfile -t targets <<<"$all_targets"
programs=()
for target in "${targets[@]}"; do
  grep -qx "$target" <<<"$all_targets" || { echo "fuzz.sh: no target '$target'; ./fuzz.sh --list names them" >&2; exit 2; }
  programs+=("$(program_of "$target")")
done
build release fuzz_seeds
build fuzz "${programs[@]}"
build/release/bin/fuzz_seeds build/fuzz/seeds >/dev/null || exit 2

failed=0 all=0
stat_of() { sed -n "s/^stat::$1: *//p" "$2"; }
printf '%-22s %12s %9s %9s %8s\n' target executions "per s" coverage "MB"
for target in "${targets[@]}"; do
  log="build/fuzz/findings/$target.log"
  mkdir -p "build/fuzz/corpus/$target"
  ROOMGRAPH_FUZZ_TARGET="$target" nice -n 15 "build/fuzz/bin/$(program_of "$target")" "${limits[@]}" -max_total_time="$seconds" -print_final_stats=1 -close_fd_mask=3 \
    -artifact_prefix="build/fuzz/findings/$target-" "build/fuzz/corpus/$target" "build/fuzz/seeds/$target" >"$log" 2>&1
  outcome=$?
  executions="$(stat_of number_of_executed_units "$log")"
  coverage="$(grep -o 'cov: [0-9]*' "$log" | tail -n 1 | cut -d ' ' -f 2)"
  printf '%-22s %12s %9s %9s %8s' "$target" "$executions" "$(stat_of average_exec_per_sec "$log")" "$coverage" "$(stat_of peak_rss_mb "$log")"
  all=$((all + ${executions:-0}))
  if ((outcome)); then
    failed=1
    echo "   FINDING: $(grep -m 1 -E 'ERROR|runtime error|SUMMARY' "$log"); see $log"
  else
    rm -f "$log"
    echo
  fi
done
echo "$all executions"
exit "$failed"
