# What scripts that build share. To be sourced in the root of the tree.

# Compilers' answers are shared between clones of this tree. GCC knows a header
# that is in a precompiled one by all of its text, so comments count.
export CCACHE_BASEDIR=$PWD CCACHE_NOHASHDIR=1 CCACHE_COMMENTS=1 \
  CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime

# may_build: whether this user may build here. If not, one line says what to do.
may_build() {
  mkdir -p build 2> /dev/null && [[ -w build ]] || {
    echo "$(basename "$0"): $PWD/build cannot be written by" \
      "$(id -un 2> /dev/null || id -u): clone the repository to a folder of" \
      "your own, and run it there" >&2
    return 1
  }
  # A user without a home has no cache of compilers' answers but here.
  [[ -n ${CCACHE_DIR:-} || -w ${HOME:-/nonexistent} ]] \
    || export CCACHE_DIR=$PWD/build/ccache
}

# build TARGET...: the release build of these. A terminal sees how it goes on;
# what is said elsewhere is kept. If it fails one line says what to do.
build() {
  local log=$PWD/build/build.log reason='see above'
  rm -f "$log"
  if ! {
    {
      [[ -f build/release/build.ninja ]] \
        || cmake --preset release > "$log" 2>&1
    } && if [[ -t 1 ]]; then
      ninja -C build/release -j "$(build_jobs)" "$@"
    else
      ninja -C build/release -j "$(build_jobs)" "$@" > "$log" 2>&1
    fi
  }; then
    [[ ! -s $log ]] || reason="$(grep -m 1 -iE 'error|killed' "$log"), see $log"
    echo "$(basename "$0"): it cannot be built: $reason; 'rm -r build/release'" \
      "begins anew" >&2
    return 1
  fi
}

# As many compilers as there are cores, but each has 1.5 GiB of memory.
build_jobs() {
  local memory_jobs
  memory_jobs=$(awk '/^MemAvailable/ {print int($2 / 1024 / 1536)}' /proc/meminfo)
  printf '%s\n' "$(nproc)" "$((memory_jobs > 0 ? memory_jobs : 1))" \
    | sort -n | head -n 1
}
