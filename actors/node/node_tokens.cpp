#include "actors/node/node_data.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/edge/session/site_token.hpp"
#include "actors/site/node_identity.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace roscell {

namespace {

namespace fs = std::filesystem;

std::string trim(const std::string& text) {
  const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
  const auto begin = std::find_if_not(text.begin(), text.end(), is_space);
  const auto end =
      std::find_if_not(text.rbegin(), text.rend(), is_space).base();
  return begin < end ? std::string{begin, end} : std::string{};
}

/// Writes a new file that only its owner can read.
caf::error write_secret(const fs::path& path, const std::string& text) {
  const int fd =
      ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  const auto size = static_cast<ssize_t>(text.size());
  const bool written = fd >= 0 && ::write(fd, text.data(), text.size()) == size
                       && ::fsync(fd) == 0;
  const int problem = errno;
  if (fd >= 0)
    ::close(fd);
  if (written)
    return caf::none;
  // Half a secret would be taken for one at the next start.
  if (fd >= 0)
    ::unlink(path.c_str());
  return fail(error_code::internal, "cannot write '" + path.string()
                                        + "': " + std::strerror(problem));
}

} // namespace

caf::expected<std::string> load_bearer_token(const fs::path& file) {
  if (!fs::exists(file))
    if (auto why = write_secret(file, to_hex(random_bytes(32)) + "\n"))
      return why;
  auto token =
      trim(read_small_file(file, limits::token::most_bytes).value_or(""));
  if (token.empty())
    return fail(error_code::internal,
                "cannot read the token in '" + file.string() + "'", "",
                "remove the file, and the node makes a new one");
  return token;
}

caf::expected<site_secret> load_site_secret(const node_config& config) {
  if (has_identity_file(config))
    return load_identity_of(config);
  const bool given = !config.site_token_file.empty();
  const auto file = given ? config.site_token_file : own_site_token();
  if (config.coordinator && !given)
    if (auto why = make_site_token(file))
      return to_caf(*why);
  std::error_code ignored;
  if (!given && !fs::exists(file, ignored))
    return site_secret::in_file(file);
  const auto read = read_site_token(file);
  if (const auto* why = std::get_if<edge_error>(&read))
    return to_caf(*why);
  return site_secret::in_file(file);
}

} // namespace roscell
