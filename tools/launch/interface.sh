# Asks for the network interface of a node. To be sourced by launch.sh.

# The interfaces that are up, with their addresses, "lo" last.
interfaces() {
  ip -4 -o addr show up 2> /dev/null \
    | awk '{sub("/.*", "", $4); print ($2 == "lo"), $2, $4}' | sort | cut -d' ' -f 2-
}

# ask_for_interface: prints the address that the person at the terminal chooses.
# The interface of the default route is taken if nothing is typed.
ask_for_interface() {
  local all=() usual choice= chosen= i
  mapfile -t all < <(interfaces)
  usual=$(awk '$2 == "00000000" {print $1; exit}' /proc/net/route)
  echo "Which network interface connects this node to its cell?" >&2
  for i in "${!all[@]}"; do
    echo "  $((i + 1))  ${all[i]/ /  }" >&2
  done
  while [[ -z $chosen ]]; do
    read -r -p "Number${usual:+ [$usual]}: " choice < /dev/tty || return
    if [[ -z $choice ]]; then
      chosen=$usual
    elif [[ $choice =~ ^[1-9][0-9]?$ && -n ${all[choice - 1]:-} ]]; then
      chosen=${all[choice - 1]#* }
    fi
  done
  echo "$chosen"
}
