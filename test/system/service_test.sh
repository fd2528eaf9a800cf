# The units as files: what systemd says of them, and what the manual does.

units=tools/roscell/service

test_the_units_have_taken_away_what_a_node_does_not_need() {
  command -v systemd-analyze > /dev/null || skip "systemd-analyze is missing"
  local unit level
  for unit in roscell.service roscell@.service; do
    # An instance of a template has a name.
    cp "$units/$unit" "$scratch/${unit/@/@arm}"
    systemd-analyze security --offline=true --threshold=40 --no-pager \
      "$scratch/${unit/@/@arm}" > "$scratch/said" 2>&1 \
      || fail "$unit: $(tail -n 2 "$scratch/said")"
  done
  level=$(grep -o 'Overall exposure level.*: [0-9.]*' "$scratch/said" | grep -o '[0-9.]*$')
  grep -q "Overall exposure level for roscell.service: $level" docs/service.md \
    || fail "docs/service.md has another level than $level"
}

test_the_manual_has_the_unit_as_it_is() {
  sed -n '/^```ini$/,/^```$/{/^```/!p}' docs/service.md \
    | sed '/^WantedBy=multi-user.target$/q' > "$scratch/said"
  diff "$scratch/said" "$units/roscell.service" \
    || fail "docs/service.md has another unit"
}
