#include "tools/roscell/daemon/interface_choice.hpp"

#include "tools/roscell/exit_code.hpp"

#include <unistd.h>

#include <charconv>
#include <iostream>
#include <variant>

namespace roscell::cli {

namespace {

/// The number in `text`, from 1 to `most`; 0 if it is none.
size_t parse_choice(const std::string& text, size_t most) {
  size_t choice = 0;
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, choice);
  return error == std::errc{} && rest == end && choice <= most ? choice : 0;
}

} // namespace

interface_address ask_for_interface(const std::vector<interface_address>& all,
                                    std::istream& answers, std::ostream& out) {
  out << "Which network interface connects this node to its cell?\n";
  for (size_t i = 0; i < all.size(); ++i)
    out << "  " << i + 1 << "  " << all[i].name << "  " << all[i].address
        << (all[i].loopback ? "  (this machine only)" : "") << "\n";
  std::string line;
  while (out << "Number: " << std::flush && std::getline(answers, line)) {
    if (const auto choice = parse_choice(line, all.size()); choice != 0)
      return all[choice - 1];
    out << "Please type a number from 1 to " << all.size() << ".\n";
  }
  throw command_error{exit_usage, "no interface was chosen",
                      "use --interface; there are " + describe_interfaces(all)};
}

interface_address choose_interface(const std::string& wanted) {
  if (!wanted.empty()) {
    auto found = resolve_interface(wanted);
    if (const auto* why = std::get_if<edge_error>(&found))
      throw command_error{exit_usage, "--interface: " + why->message,
                          why->hint};
    return std::get<interface_address>(found);
  }
  const auto all = list_interfaces();
  if (isatty(STDIN_FILENO) == 1 && !all.empty())
    return ask_for_interface(all, std::cin, std::cerr);
  throw command_error{exit_usage, "--interface is missing",
                      "there are " + describe_interfaces(all)};
}

} // namespace roscell::cli
