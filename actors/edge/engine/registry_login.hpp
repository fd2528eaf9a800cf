#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

/// How this host's user logs in to the registries of container images, as
/// `docker login` and `podman login` have written it down. What is found is a
/// secret, which goes to the engine and nowhere else.
namespace roscell {

struct registry_login {
  std::string user;
  std::string password;
  std::string token; ///< In place of the two.
};

/// What a file of logins says of one registry.
struct login_entry {
  std::optional<registry_login> login;
  std::string helper; ///< A program that knows it: docker-credential-HELPER.
};

/// @param repository the most specific entry counts, as Podman has it:
///   "R/team/app" before "R/team" before "R".
login_entry read_login(const nlohmann::json& document,
                       const std::string& registry,
                       const std::string& repository);

/// What a helper has said; nothing: it is no login.
std::optional<registry_login> read_helper_answer(const std::string& text);

/// As an engine wants it, in X-Registry-Auth.
std::string login_header(const registry_login& login,
                         const std::string& registry);

/// Where logins are.
struct login_places {
  std::filesystem::path own; ///< The node's own file, others may not read it.
  std::vector<std::filesystem::path> files;       ///< Of the engine's user.
  std::map<std::string, std::string> environment; ///< Of helpers.
};

/// Those of this process's user: $DOCKER_CONFIG and ~/.docker for Docker,
/// $REGISTRY_AUTH_FILE, $XDG_RUNTIME_DIR/containers and ~/.config/containers
/// for Podman, which knows those of Docker too.
login_places find_login_places(const std::string& engine,
                               const std::filesystem::path& own);

/// The header for the registry of an image; empty: nobody has logged in there.
/// Waits for the disk, and for a helper. Errors: unauthorized (a file or a
/// helper cannot be used); no word of them is a secret.
edge_result<std::string> find_login_header(const std::string& image,
                                           const login_places& places);

} // namespace roscell
