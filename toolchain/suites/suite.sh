# Sourced by a suite: goes to the repository's root and writes one row to build/suites.txt when the suite ends, whatever
# its end; toolchain/suites/summary makes a table of them. The suite sets `what` (what ran) and `found` (what it found).
# A row: suite, passed or FAILED, seconds, what, found; separated by tabs.
set -euo pipefail
cd "$(dirname "$0")/../.."

suite=$(basename "$0")
what=""
found=""
SECONDS=0

write_row() {
  local status=$? verdict=passed rows=build/suites.txt
  [ "$status" = 0 ] || verdict=FAILED
  mkdir -p build
  touch "$rows"
  { grep -v "^$suite"$'\t' "$rows" || true; printf '%s\t%s\t%s\t%s\t%s\n' "$suite" "$verdict" "$SECONDS" "$what" "$found"; } \
    >"$rows.new"
  mv "$rows.new" "$rows"
  echo "$suite: $verdict in $SECONDS s; ${what:-nothing ran}${found:+; $found}"
}
trap write_row EXIT
# A suite that is ended from outside has not passed.
trap 'exit 143' TERM

say() { echo "$suite: $*"; }

# build PRESET [TARGET...]: quiet unless something fails.
build() {
  local preset=$1 log=build/$1.log targets=()
  shift
  [ $# = 0 ] || targets=(--target "$@")
  mkdir -p build
  if ! { cmake --preset "$preset" && cmake --build --preset "$preset" "${targets[@]}"; } >"$log" 2>&1; then
    grep -E "error|warning|FAILED" "$log" | head -n 30 || tail -n 60 "$log"
    say "the build failed; its whole output is in $log" >&2
    found="the build failed"
    exit 1
  fi
}

export LSAN_OPTIONS=suppressions=$PWD/tests/leak_suppressions.txt:print_suppressions=0
export UBSAN_OPTIONS=print_stacktrace=1

# Runs a program at the addresses where it was linked, where that is permitted: the sanitizers of clang 14 cannot place
# their shadow memory under the wider randomisation of newer kernels.
fixed_addresses=()
if [ "$(cat /proc/sys/vm/mmap_rnd_bits 2>/dev/null || echo 28)" -gt 28 ] && setarch -R true 2>/dev/null; then
  fixed_addresses=(setarch -R)
fi
