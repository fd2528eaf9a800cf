# Projects outside of the tree, against what is installed of it.

# The package for developers, as it would be in /usr.
before_all() {
  cmake --install "$ROSCELL_BUILD" --component development --prefix "$suite/prefix"
}

outside() {
  export CMAKE_PREFIX_PATH=$suite/prefix
  ! command -v ccache > /dev/null || export CMAKE_CXX_COMPILER_LAUNCHER=ccache
}

# builds PROJECT [OPTION...]: configures, builds and tests it, in $scratch/build.
builds() {
  cmake -S "$1" -B "$scratch/build" "${@:2}" > "$scratch/log" 2>&1 \
    && cmake --build "$scratch/build" >> "$scratch/log" 2>&1 \
    && ctest --test-dir "$scratch/build" --no-tests=ignore \
         --output-on-failure >> "$scratch/log" 2>&1 \
    || fail "$1: $(tail -20 "$scratch/log")"
}

# says WORDS COMMAND...: the command fails with these words.
says() {
  local words=$1 said
  shift
  said=$("$@" 2>&1) && fail "it did not fail: $*"
  [[ $said == *"$words"* ]] || fail "it said: $said"
}

test_each_example_that_is_a_project_builds_against_what_is_installed() {
  local project
  outside
  for project in docs/examples/*/CMakeLists.txt; do
    rm -rf "$scratch/build"
    builds "$(dirname "$project")"
  done
}

test_a_skill_with_messages_of_its_own_is_whole_where_it_is_installed() {
  outside
  builds docs/examples/thermometer
  cmake --install "$scratch/build" --prefix "$scratch/root" > /dev/null
  "$ROSCELL" skill check "$scratch/root/lib/roscell/skills/thermometer" \
    | has_line "nothing is wrong with skill 'thermometer'"
}

# a_project TEXT: a project of one source, which uses what TEXT makes available.
a_project() {
  mkdir "$scratch/project"
  printf '%s\n' "cmake_minimum_required(VERSION 3.25)" \
    "project(outside LANGUAGES CXX)" "$1" > "$scratch/project/CMakeLists.txt"
  printf '%s\n' '#include "roscell/skill.hpp"' \
    'int main() { return roscell::engine::parameters{}.has("x") ? 1 : 0; }' \
    > "$scratch/project/main.cpp"
}

test_the_sources_give_the_same_targets_and_make_no_more_than_is_asked_for() {
  outside
  a_project "set(ROSCELL_COMPONENTS skill)
include(FetchContent)
FetchContent_Declare(roscell SOURCE_DIR $PWD)
FetchContent_MakeAvailable(roscell)
add_executable(outside main.cpp)
target_link_libraries(outside PRIVATE roscell::skill)
if(CMAKE_RUNTIME_OUTPUT_DIRECTORY OR CMAKE_CXX_STANDARD)
  message(FATAL_ERROR \"a setting of roscell is seen outside of it\")
endif()"
  builds "$scratch/project" -DCMAKE_PREFIX_PATH=
  [[ ! -e $scratch/build/skills ]] || fail "it made skills, too"
  expect "libraries" "$(find "$scratch/build" -name '*.a' -printf '%f ')" \
    "libroscell_skill.a "
  "$scratch/build/outside" || fail "it does not run"
}

test_a_compiler_finds_the_skill_library_by_pkg_config_alone() {
  local flags
  [[ $(sed -n 's/^ROSCELL_SANITIZE:.*=//p' "$ROSCELL_BUILD/CMakeCache.txt") == "" ]] \
    || skip "pkg-config knows of no sanitizer"
  a_project ""
  flags=$(PKG_CONFIG_PATH=$(dirname "$(find "$suite/prefix" -name '*.pc')") \
    pkg-config --cflags --libs roscell-skill) || fail "pkg-config: $flags"
  # Words of flags.
  # shellcheck disable=SC2086
  c++ -std=c++17 -I"$scratch/project" "$scratch/project/main.cpp" $flags \
    -o "$scratch/program" || fail "it does not compile"
  "$scratch/program" || fail "it does not run"
}

test_a_part_that_does_not_exist_is_named() {
  outside
  a_project "find_package(roscell CONFIG REQUIRED COMPONENTS skill flying)"
  says flying cmake -S "$scratch/project" -B "$scratch/build"
}

# nm leaves the longest names of templates as they are. Boost's own code, which
# is compiled once, comes with the node, as docs/decisions.md says.
test_no_symbol_of_the_libraries_can_collide_with_anothers() {
  local symbols
  symbols=$(find "$suite/prefix" -name '*.a' -exec nm -C -g --defined-only {} + \
    2> /dev/null | awk '$2 ~ /^[TDBRC]$/' | grep -vE 'roscell::|_ZNK?7roscell|__odr_asan| boost(::|_asio_)') || true
  [[ -z $symbols ]] || fail "outside of the namespace: ${symbols:0:500}"
}

test_symbols_of_the_libraries_are_not_shown_by_a_plug_in_that_links_them() {
  local shown
  shown=$(find "$suite/prefix" -name '*.a' -exec readelf -sW {} + 2> /dev/null \
    | awk '$5 == "GLOBAL" && $6 == "DEFAULT" && $7 != "UND" && $8 ~ /roscell/') \
    || true
  [[ -z $shown ]] || fail "not hidden: ${shown:0:500}"
}

test_no_header_but_the_public_ones_is_installed_and_none_needs_more() {
  local others
  others=$(find "$suite/prefix/include" -type f -not -path '*/include/roscell/*')
  [[ -z $others ]] || fail "it installs $others"
  others=$(grep -rhoE '#include [<"][a-z_0-9]+/' "$suite/prefix/include" \
    | sort -u | grep -vE '"roscell/|<(caf|fastcdr)/|<sys/') || true
  [[ -z $others ]] || fail "they include $others"
}

test_a_new_skill_takes_no_folder_that_is_there_and_no_name_that_cannot_be() {
  mkdir "$scratch/empty" && cd "$scratch/empty" || exit 1
  "$ROSCELL" skill new shout > /dev/null 2>&1 || fail "it makes none"
  echo "my work" > shout/shout.cpp
  says "there is '$scratch/empty/shout' already" "$ROSCELL" skill new shout
  expect "what was there" "$(cat shout/shout.cpp)" "my work"
  says "such as my_skill" "$ROSCELL" skill new ../my-skill
  expect "folders" "$(ls)" shout
}

test_a_node_offers_no_skill_that_lacks_a_library_and_tells_why() {
  cp -r "$skills/echo" "$skills/lacking"
  cp "$ROSCELL_BUILD/bin/lacking" "$skills/lacking/bin/echo"
  start_node lone --interface lo
  expect "skills that it offers" "$(get lone /v1/skills | jq '.skills | length')" 1
  to lone skills | has_line "refused on lone: $skills/lacking/skill.json.*libgone.so"
}
