#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

namespace roscell {
class site_identity;
} // namespace roscell

namespace roscell::cli {

/// HTTP port of a node that does not name another one.
inline constexpr uint16_t http_port_default = 8420;

/// Where a node listens for requests: a Unix socket, or an address and port.
struct target {
  std::filesystem::path socket; ///< Empty: TCP.
  std::string host;
  uint16_t port = http_port_default;

  bool is_local() const {
    return !socket.empty();
  }

  /// "unix:/path" or "host:port", as `parse_target` takes it.
  std::string text() const;
};

/// "unix:/path", an absolute path, "host", "host:port", "[v6]" or "[v6]:port".
/// Throws std::invalid_argument for anything else.
target parse_target(std::string_view text);

/// Where a node keeps its files if nothing else is said: /var/lib/roscell for
/// root, else below the state directory of the user.
std::filesystem::path default_data_dir();

/// The node to ask when none is named: $ROSCELL_TO, else the socket of the
/// user's own node, else that of the system's node if only that one exists.
target default_target();

/// The bearer token for TCP: of `file` if not empty, else $ROSCELL_TOKEN, else,
/// if `to` is this machine, that of its node, else empty. Throws command_error
/// if `file` cannot be read or what was found cannot be a token.
std::string find_token(const std::filesystem::path& file, const target& to);

/// Who asks over TCP: the identity in `file` if not empty, else in that of
/// $ROSCELL_IDENTITY, else what `roscell login` has kept for that node, else
/// null. Throws command_error if it cannot be read.
std::shared_ptr<site_identity> find_identity(const std::filesystem::path& file,
                                             const target& to);

/// Where this user's identity for that node is.
std::filesystem::path login_file_of(const target& to);

/// That everybody on this machine can read a file that holds a secret, and the
/// remedy. Empty if that is not so.
std::string open_secret_warning(const std::filesystem::path& file);

} // namespace roscell::cli
