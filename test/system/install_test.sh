# What tools/install.sh and tools/demo.sh say on a computer that is not ready.

# fake COMMAND SCRIPT: that command of the test's PATH.
fake() {
  printf '#!/bin/sh\n%s\n' "$2" > "$scratch/bin/$1"
  chmod +x "$scratch/bin/$1"
}

# bare_path: a PATH with little more than the scripts need, and no sudo.
bare_path() {
  local command
  mkdir "$scratch/bin"
  chmod a+rx "$scratch" "$scratch/bin"
  for command in bash env basename dirname realpath id grep tail mktemp mkdir \
    rm cat wc setpriv; do
    ln -s "$(command -v "$command")" "$scratch/bin/"
  done
  fake apt-get 'exit 0'
  fake dpkg-query 'exit 1'
}

# says_one_line WORDS COMMAND...: it fails, and tells why in one line with these
# words.
says_one_line() {
  local words=$1
  shift
  PATH=$scratch/bin "$@" < /dev/null > "$scratch/out" 2> "$scratch/err" \
    && fail "it did not fail"
  expect "lines of error" "$(wc -l < "$scratch/err")" 1
  grep -qF "$words" "$scratch/err" || fail "it says: $(cat "$scratch/err")"
}

as_nobody=()
if [[ $(id -u) -eq 0 ]]; then
  as_nobody=(setpriv --reuid 65534 --regid 65534 --clear-groups)
fi

test_who_is_not_root_and_has_no_sudo_is_told_what_root_must_run() {
  bare_path
  says_one_line "let root run: $PWD/tools/install.sh --with-tests" \
    "${as_nobody[@]}" tools/install.sh --with-tests
}

test_without_a_terminal_sudo_is_not_waited_for() {
  bare_path
  fake sudo '[ "$1" = -n ] && echo "sudo: a password is required" >&2; exit 1'
  fake setsid "exec $(command -v setsid) -w \"\$@\""
  says_one_line "cannot install: sudo: a password is required; mend that" \
    setsid "${as_nobody[@]}" tools/install.sh
}

test_the_reason_why_apt_fails_is_told_in_one_line() {
  [[ $(id -u) -eq 0 ]] || skip "installing needs root"
  bare_path
  fake apt-get 'echo "E: no network" >&2; echo "E: and more" >&2; exit 100'
  says_one_line "cannot install: E: no network" tools/install.sh
}

test_who_may_not_write_the_tree_is_told_so_before_anything_is_done() {
  bare_path
  mkdir -p "$scratch/tree/tools" "$scratch/tree/build"
  cp tools/*.sh "$scratch/tree/tools"
  chmod 0555 "$scratch/tree/build"
  says_one_line "build cannot be written by" \
    "${as_nobody[@]}" "$scratch/tree/tools/demo.sh"
}
