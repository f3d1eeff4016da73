#!/usr/bin/env bash
# The C interface under valgrind: memcheck over all C and C++ test programs (no error, nothing lost), helgrind over those
# with threads. Needs valgrind, a C and a C++ compiler and libode-dev. Prints a line a program; fails if any program does.
#
#   tools/sanitize.sh [PROGRAM …]       names as in crates/libode/tests/c and tests/alone, without endings
set -euo pipefail
cd "$(dirname "$0")/.."

for tool in valgrind cc c++; do
  command -v "$tool" >/dev/null || { echo "SKIPPED: no $tool"; exit 0; }
done
cargo build --release --quiet -p libode
target=$(cargo metadata --format-version 1 --no-deps | sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
ln -s "$target/release/libode.so" "$work/libode.so.8"
ln -s "$target/release/libode.so" "$work/libode.so"
export LD_LIBRARY_PATH=$work

# The standard library and the loader keep a little for ever: still reachable, not lost. A callback that leaves by longjmp
# skips frames that own memory, as in C++: programs that do so may lose some.
memcheck=(valgrind --quiet --error-exitcode=99 --leak-check=full --show-leak-kinds=definite --errors-for-leak-kinds=definite)
without_leaks=(valgrind --quiet --error-exitcode=99)
helgrind=(valgrind --tool=helgrind --quiet --error-exitcode=99)

failed=0
judge() {
  local name=$1 status=0
  shift
  # A program that ends by a fault on purpose may end in any way but with an error of memory.
  "$@" >"$work/out" 2>"$work/err" || status=$?
  if [ "$status" = 99 ]; then
    echo "$name: FAILED"
    sed -n '/^==/p' "$work/err" | sed -n '1,40p'
    failed=1
  else
    echo "$name: clean"
  fi
}

for source in crates/libode/tests/c/*.c crates/libode/tests/c/*.cpp crates/libode/tests/alone/*.cpp; do
  name=$(basename "${source%.*}")
  if [ $# -gt 0 ] && [[ " $* " != *" $name "* ]]; then continue; fi
  compiler=cc
  case $source in *.cpp) compiler="c++ -std=c++17" ;; esac
  $compiler -g -w -I crates/libode/include -o "$work/$name" "$source" -L "$work" -lode -lm -lpthread
  case $name in
    escapes | hostile | plain_errors | space_pairs) tool=("${without_leaks[@]}") ;;
    *) tool=("${memcheck[@]}") ;;
  esac
  judge "memcheck $name" "${tool[@]}" "$work/$name"
  # The library's own threads wait on futexes, which helgrind does not understand; the programs' threads use pthreads.
  case $name in eight_threads | shared_data) judge "helgrind $name" "${helgrind[@]}" "$work/$name" ;; esac
done
exit "$failed"
