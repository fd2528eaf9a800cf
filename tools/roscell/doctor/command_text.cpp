#include "tools/roscell/doctor/command_text.hpp"

#include "actors/edge/io/socket_address.hpp"

#include <pwd.h>
#include <unistd.h>

#include <array>

namespace roscell::cli {

namespace {

/// Anything else might be an option of ssh.
bool is_host(const std::string& text) {
  constexpr uint16_t any_port = 22;
  return !text.empty() && text.front() != '-'
         && parse_host_address(text, any_port) && text.find(':') == text.npos;
}

} // namespace

std::string on_host(const std::string& address, const std::string& command) {
  return "ssh -t " + (is_host(address) ? address : "ADDRESS") + " "
         + shell_word(command);
}

std::string remedies_of(const std::string& doctor, const std::string& check) {
  const auto name = shell_word(check);
  return doctor + " -o json --only " + name + " | jq -r --arg check " + name
         + " '.[] | select(.check == $check) | .remedy // empty' | sh";
}

std::string user_word(uid_t id) {
  constexpr size_t most_bytes = 16384;
  std::array<char, most_bytes> text{};
  passwd row{};
  passwd* found = nullptr;
  getpwuid_r(id, &row, text.data(), text.size(), &found);
  return found == nullptr ? "'#" + std::to_string(id) + "'"
                          : shell_word(found->pw_name);
}

std::string own_user() {
  return user_word(geteuid());
}

} // namespace roscell::cli
