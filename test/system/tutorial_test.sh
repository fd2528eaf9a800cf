# What the pages tell their readers to type, typed.

# Skills of these pages ask for what a program takes that no sanitizer looks after.
export ROSCELL_CGROUP=none

# own_network: this test's own loopback, because pages name well-known ports.
own_network() {
  need_namespaces
  ip netns add "roscell-page-$BASHPID"
  hosts+=("roscell-page-$BASHPID")
  ip -n "${hosts[-1]}" link set lo up
}

# own_tree: a copy of the sources, in which a page may do what it likes. The node
# is not built again: a page gets the one of $ROSCELL_BUILD.
own_tree() {
  tree=$scratch/tree
  mkdir -p "$tree/build/release"
  git ls-files -z --cached --others --exclude-standard \
    | xargs -0 cp --parents -t "$tree"
  ln -s "$ROSCELL_BUILD/bin" "$tree/build/release/bin"
  export CCACHE_BASEDIR=$tree
}

# own_examples: the tasks of docs/examples have this test's paths in that copy.
own_examples() {
  sed -i "s|/tmp/|$scratch/|g" "$tree"/docs/examples/*.{json,yaml}
}

# play PAGE [OPTION...]: does what the page says. In a PID namespace, with which
# everything goes that it has started; the shell buries the orphans in it.
play() {
  local page=$PWD/$1 played
  shift
  (cd "${tree:-$scratch}" && exec ip netns exec "${hosts[-1]}" \
    unshare --fork --pid --mount-proc --kill-child \
    bash -c '"$@"; exit $?' reaper \
    "$root/test/system/scenes/play_document.py" "$page" \
    --replace "/tmp/=$scratch/" --replace "/home/you/.config/roscell=$scratch/user" \
    --replace "/home/you/roscell=${tree:-}" "$@") 2> "$scratch/played" &
  played=$!
  echo "$played" >> "$scratch/pids"
  wait "$played" || fail "$(cat "$scratch/played" "$scratch/busy" 2> /dev/null)"
}

root=$PWD

test_the_tutorial_does_what_it_says() {
  own_network
  own_tree
  play docs/tutorial.md --alike head,arm \
    --instead "ninja -C build/release roscell=ninja -C build/release -n roscell" \
    --instead "roscell run $scratch/tut/task.yaml=roscell run $scratch/tut/task.yaml 2> $scratch/busy" \
    --instead "roscell run $scratch/tut/second.yaml=roscell run $scratch/tut/second.yaml 2> $scratch/busy"
  [[ ! -e skills/shout ]] || fail "it left something in the sources"
}

test_a_cell_in_five_lines_runs_a_task() {
  own_network
  own_tree
  ln -s "$skills" "$tree/build/release/skills"
  own_examples
  play README.md --section "A cell in five lines"
}

test_each_rung_of_the_ladder_of_examples_prints_what_its_page_shows() {
  own_network
  own_tree
  rm -r "$skills"
  use_skills echo image_source rectify pose_estimation
  ln -s "$skills" "$tree/build/release/skills"
  own_examples
  # A machine that is busy is warned of.
  play docs/examples/README.md --section "The ladder" --alike head,arm \
    --replace "roscell run docs/=roscell run 2>> $scratch/busy docs/" \
    --replace "roscell run --set=roscell run 2>> $scratch/busy --set" \
    --instead "cmake --preset release && ninja -C build/release roscell instance_shim skills/all render_scenes compare_poses=true"
}

test_a_skill_of_your_own_takes_five_commands() {
  own_network
  cmake --install "$ROSCELL_BUILD" --component development \
    --prefix "$scratch/prefix" > /dev/null
  export CMAKE_PREFIX_PATH=$scratch/prefix PATH=$ROSCELL_BUILD/bin:$PATH
  play docs/skills.md --section "Five commands" --alike head \
    --instead "roscell run --to \$PWD/build/cell/node.sock task.yaml=roscell run --to \$PWD/build/cell/node.sock task.yaml 2> $scratch/busy" \
    --replace "/home/you=$scratch"
}
