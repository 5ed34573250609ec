# Sourced by the scripts: going to the project's root, talking, configuring and building quietly.
# shellcheck shell=bash

cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit

# Compilations are remembered between build folders where ccache is there; it is not needed.
if command -v ccache >/dev/null; then
  export CMAKE_CXX_COMPILER_LAUNCHER=${CMAKE_CXX_COMPILER_LAUNCHER-ccache}
fi

say() { printf '%s\n' "$*" >&2; }

fail() {
  say "$@"
  exit 1
}

# Runs a command with its output in a log, which is shown only if it fails: quietly LOG COMMAND…
quietly() {
  local log=$1
  shift
  if ! "$@" >"$log" 2>&1; then
    tail -n 60 "$log" >&2
    fail "Failed: $*
The whole output is in $log"
  fi
}

# Ninja's "[12/80] …" lines become one number that moves, where somebody may be watching.
show_build_progress() {
  local line
  while IFS= read -r line; do
    if [[ -t 2 && $line =~ ^\[([0-9]+/[0-9]+)\] ]]; then
      printf '\r  %s ' "${BASH_REMATCH[1]}" >&2
    fi
  done
  [[ ! -t 2 ]] || printf '\r              \r' >&2
}

# configure PRESET [arguments for cmake]: leaves build/PRESET/compile_commands.json behind.
configure() {
  mkdir -p "build/$1"
  quietly "build/$1/configure.log" cmake --preset "$@"
}

configure_and_build() {
  local preset=$1 log=build/$1/build.log
  configure "$@"
  say "Building $preset in build/$preset"
  # The pipe keeps ninja from rewriting lines; pipefail keeps its exit code.
  if ! cmake --build "build/$preset" 2>&1 | tee "$log" | show_build_progress; then
    # What failed stands where it happened, which need not be the end.
    grep --extended-regexp --after-context=30 --max-count=5 '^FAILED|error:|fatal:' "$log" >&2 ||
      tail -n 60 "$log" >&2
    fail "The build failed; the whole output is in $log"
  fi
}
