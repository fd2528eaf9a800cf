#include "tools/roscell/client/target.hpp"

#include "actors/edge/session/limits.hpp"
#include "actors/edge/trust/site_identity.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <variant>

namespace roscell::cli {

namespace fs = std::filesystem;

namespace {

const fs::path system_data_dir = "/var/lib/roscell";

/// Value of an environment variable; empty if it is not set.
std::string environment(const char* name) {
  const auto* value = std::getenv(name);
  return value == nullptr ? "" : value;
}

uint16_t parse_port(std::string_view text) {
  uint16_t port = 0;
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, port);
  if (error != std::errc{} || rest != end || port == 0)
    throw std::invalid_argument{"not a port number: '" + std::string{text}
                                + "'"};
  return port;
}

target parse_tcp(std::string_view text) {
  target result;
  std::string_view rest;
  if (text.front() == '[') {
    const auto end = text.find(']');
    if (end == text.npos)
      throw std::invalid_argument{"']' is missing"};
    result.host = text.substr(1, end - 1);
    rest = text.substr(end + 1);
    if (!rest.empty() && rest.front() != ':')
      throw std::invalid_argument{"a ':' must follow the ']'"};
  } else {
    const auto colon = text.find(':');
    result.host = text.substr(0, colon);
    if (colon != text.npos)
      rest = text.substr(colon);
  }
  if (result.host.empty())
    throw std::invalid_argument{"the host is missing"};
  if (!rest.empty())
    result.port = parse_port(rest.substr(1));
  return result;
}

/// First line of a file that may hold no more than a token.
std::optional<std::string> read_token(const fs::path& file) {
  errno = 0;
  std::ifstream in{file};
  if (!in)
    return std::nullopt;
  std::string text(4097, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<size_t>(in.gcount()));
  const auto end = text.find_last_not_of(" \t\r\n");
  text.resize(end == text.npos ? 0 : end + 1);
  return text;
}

/// True if a socket can be bound to `host`, an address in numbers.
bool is_this_machine(const std::string& host) {
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  const auto* name = host == "localhost" ? "127.0.0.1" : host.c_str();
  if (getaddrinfo(name, nullptr, &hints, &found) != 0)
    return false;
  const int fd = socket(found->ai_family, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool bound =
      fd >= 0 && bind(fd, found->ai_addr, found->ai_addrlen) == 0;
  if (fd >= 0)
    close(fd);
  freeaddrinfo(found);
  return bound;
}

/// A directory that this user may not look into may hold it: that is for the
/// connection to say.
bool may_exist(const fs::path& socket) {
  std::error_code problem;
  return fs::exists(socket, problem) || problem == std::errc::permission_denied;
}

std::string checked(std::string token, const std::string& source) {
  const bool bad =
      token.size() > limits::token::most_bytes
      || token.find_first_not_of("0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                 "abcdefghijklmnopqrstuvwxyz-._~+/=")
             != token.npos;
  if (bad)
    throw command_error{exit_usage, source + " holds no bearer token"};
  return token;
}

} // namespace

std::string target::text() const {
  if (is_local())
    return "unix:" + socket.string();
  const bool v6 = host.find(':') != host.npos;
  return (v6 ? "[" + host + "]" : host) + ":" + std::to_string(port);
}

target parse_target(std::string_view text) {
  constexpr std::string_view scheme = "unix:";
  if (text.substr(0, scheme.size()) == scheme)
    text.remove_prefix(scheme.size());
  else if (!text.empty() && text.find('/') == text.npos)
    return parse_tcp(text);
  if (text.empty() || text.front() != '/')
    throw std::invalid_argument{
        "a socket is named by its absolute path, not by '" + std::string{text}
        + "'"};
  target result;
  result.socket = text;
  return result;
}

fs::path default_data_dir() {
  if (geteuid() == 0)
    return system_data_dir;
  if (auto state = environment("XDG_STATE_HOME"); !state.empty())
    return fs::path{state} / "roscell";
  if (auto home = environment("HOME"); !home.empty())
    return fs::path{home} / ".local/state/roscell";
  return system_data_dir;
}

target default_target() {
  if (auto to = environment("ROSCELL_TO"); !to.empty()) {
    try {
      return parse_target(to);
    } catch (const std::invalid_argument& e) {
      throw command_error{exit_usage, "ROSCELL_TO: " + std::string{e.what()}};
    }
  }
  target result;
  result.socket = default_data_dir() / "node.sock";
  const auto shared = system_data_dir / "node.sock";
  std::error_code ignored;
  if (!fs::exists(result.socket, ignored) && may_exist(shared))
    result.socket = shared;
  return result;
}

std::string find_token(const fs::path& file, const target& to) {
  if (!file.empty()) {
    auto token = read_token(file);
    if (!token)
      throw command_error{exit_usage,
                          "cannot read the token file " + file.string() + ": "
                              + std::strerror(errno),
                          "--token-file takes a copy of the node's "
                          "DATA_DIR/token"};
    if (token->empty())
      throw command_error{exit_usage, "no token is in " + file.string(),
                          "--token-file takes a copy of the node's "
                          "DATA_DIR/token"};
    if (const auto warning = open_secret_warning(file); !warning.empty())
      print_note("roscell: " + printable(warning));
    return checked(*token, file.string());
  }
  if (auto token = environment("ROSCELL_TOKEN"); !token.empty())
    return checked(token, "ROSCELL_TOKEN");
  // Another machine has no use for our token and must not learn it.
  if (!is_this_machine(to.host))
    return {};
  for (const auto& dir : {default_data_dir(), system_data_dir})
    if (auto token = read_token(dir / "token"); token && !token->empty())
      return checked(*token, (dir / "token").string());
  return {};
}

fs::path login_file_of(const target& to) {
  fs::path folder{"/etc/roscell"};
  if (auto own = environment("XDG_CONFIG_HOME"); !own.empty())
    folder = fs::path{own} / "roscell";
  else if (auto home = environment("HOME"); !home.empty() && geteuid() != 0)
    folder = fs::path{home} / ".config/roscell";
  return folder / "logins" / (to.text() + ".pem");
}

std::shared_ptr<site_identity> find_identity(const fs::path& file,
                                             const target& to) {
  auto said = file.empty() ? fs::path{environment("ROSCELL_IDENTITY")} : file;
  std::error_code ignored;
  if (said.empty() && fs::exists(login_file_of(to), ignored))
    said = login_file_of(to);
  if (said.empty())
    return nullptr;
  auto read = site_identity::in_file(said);
  if (const auto* why = std::get_if<edge_error>(&read))
    throw command_error{exit_usage, why->message, why->hint};
  return std::get<std::shared_ptr<site_identity>>(std::move(read));
}

std::string open_secret_warning(const fs::path& file) {
  std::error_code problem;
  const auto mode = fs::status(file, problem).permissions();
  if (problem || (mode & fs::perms::others_read) == fs::perms::none)
    return {};
  return "every user of this machine can read the token in " + file.string()
         + "; chmod 600 " + file.string();
}

} // namespace roscell::cli
