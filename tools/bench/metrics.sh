# What every benchmark prints and counts with.

# figure NAME VALUE UNIT: one JSON line.
figure() {
  jq -nc --arg figure "$1" --argjson value "$2" --arg unit "$3" \
    '{$figure, $value, $unit}'
}

now_ms() {
  date +%s%3N
}

# Median of the numbers that come in.
median() {
  sort -n | awk '{x[NR] = $1} END {print x[int((NR + 1) / 2)]}'
}
