# What weighs what. To be sourced by package.sh, which sets $output and $work.

. tools/packaging/clean_root.sh

[[ $(id -u) -eq 0 ]] || fail "a root file system needs root"
compgen -G "$output/roscell_*.deb" > /dev/null || fail "make the packages first"
root=$(clean_root minimal "" "$output"/roscell_*.deb) \
  || fail "no minimal Debian can be made"
mkdir "$work/root"
tar -C "$work/root" -xf "$root"
cp "$output"/*.deb "$work/root"

# sizes_of PACKAGE: lines "SIZE_KIB NAME" of what its installation adds.
sizes_of() {
  chroot "$work/root" sh -c "apt-get -qs install --no-install-recommends \
    /$1_*.deb | awk '\$1 == \"Inst\" {print \$2}' \
    | xargs apt-cache show --no-all-versions; dpkg-deb -f /$1_*.deb" \
    2> /dev/null \
    | awk '$1 == "Package:" {name = $2}
           $1 == "Installed-Size:" {print $2, name}' | sort -rn
}

for package in roscell roscell-skills roscell-skills-video roscell-tools; do
  sizes_of "$package" > "$work/sizes"
  awk -v name="$package" '
    {sum += $1; line[NR] = sprintf("%8.1f MB  %s", $1 * 1.024 / 1000, $2)}
    END {
      printf "%8.1f MB  %s and all that it needs\n", sum * 1.024 / 1000, name
      if (name == "roscell")
        for (i = 1; i <= NR; ++i) print "  " line[i]
    }' "$work/sizes"
done
