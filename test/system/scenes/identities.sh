# A site of identities for tests and benchmarks.

# issue ROLE NAME [SITE]: into NAME.pem; of the site in the folder `site` unless
# another is named.
issue() {
  "$ROSCELL" site issue "$1" "$2" --dir "$scratch/${3:-site}" --out "$scratch/$2.pem" \
    2> "$scratch/issue.err" || fail "$(cat "$scratch/issue.err")"
}

# make_site NAME [FOLDER]
make_site() {
  "$ROSCELL" site create "$1" --dir "$scratch/${2:-site}" 2> "$scratch/issue.err" \
    || fail "$(cat "$scratch/issue.err")"
}

# tcp_of NAME: where that node listens.
tcp_of() {
  sed -n "s/.*node '$1' listens on \([0-9.:]*\) .*/\1/p" "$scratch/$1.log" | head -1
}
