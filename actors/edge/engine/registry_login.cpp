#include "actors/edge/engine/registry_login.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/engine/engine_json.hpp"
#include "actors/edge/engine/image_reference.hpp"
#include "actors/edge/engine/limits.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "schemas/utf8.hpp"

#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

using document = nlohmann::json;

/// How Docker's own registry is called in files and by helpers.
constexpr const char* docker_hub = "docker.io";
constexpr const char* docker_hub_url = "https://index.docker.io/v1/";
/// The user of a helper's answer whose secret is a token.
constexpr const char* token_user = "<token>";

document object_in(const document& object, const std::string& name) {
  const auto i = object.is_object() ? object.find(name) : object.end();
  return object.is_object() && i != object.end() && i->is_object()
             ? *i
             : document::object();
}

/// What a registry is called by, whatever else a URL of it says.
std::string host_of_key(const std::string& key) {
  const auto scheme = key.find("://");
  auto host = scheme == std::string::npos ? key : key.substr(scheme + 3);
  host = host.substr(0, host.find('/'));
  return host == "index.docker.io" || host == "registry-1.docker.io"
             ? docker_hub
             : host;
}

std::optional<registry_login> login_of(const document& entry) {
  registry_login result{text_at(entry, "username"), text_at(entry, "password"),
                        text_at(entry, "identitytoken")};
  if (const auto both = from_base64(text_at(entry, "auth"))) {
    const auto colon = both->find(':');
    if (colon != std::string::npos) {
      result.user = both->substr(0, colon);
      result.password = both->substr(colon + 1);
    }
  }
  const bool empty = result.token.empty() && result.user.empty();
  return empty ? std::nullopt : std::optional{std::move(result)};
}

/// Names of logins for a repository, the most specific one first.
std::vector<std::string> keys_for(const std::string& registry,
                                  const std::string& repository) {
  std::vector<std::string> result;
  for (auto part = registry + '/' + repository; part != registry;
       part = part.substr(0, part.rfind('/')))
    result.push_back(part);
  return result;
}

bool is_helper_name(const std::string& name) {
  return !name.empty()
         && std::all_of(name.begin(), name.end(), [](unsigned char c) {
              return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
            });
}

} // namespace

login_entry read_login(const document& file, const std::string& registry,
                       const std::string& repository) {
  login_entry result;
  const auto auths = object_in(file, "auths");
  for (const auto& key : keys_for(registry, repository))
    if (!result.login)
      result.login = login_of(object_in(auths, key));
  const auto helpers = object_in(file, "credHelpers");
  for (const auto& [key, helper] : helpers.items())
    if (helper.is_string() && host_of_key(key) == registry)
      result.helper = helper.get<std::string>();
  if (file.is_object() && result.helper.empty())
    result.helper = text_at(file, "credsStore");
  for (const auto& [key, entry] : auths.items())
    if (!result.login && entry.is_object() && host_of_key(key) == registry)
      result.login = login_of(entry);
  return result;
}

std::optional<registry_login> read_helper_answer(const std::string& text) {
  const auto answer = document::parse(text, nullptr, false);
  if (!answer.is_object())
    return std::nullopt;
  const auto user = text_at(answer, "Username");
  const auto secret = text_at(answer, "Secret");
  if (user.empty() || secret.empty())
    return std::nullopt;
  return user == token_user ? registry_login{{}, {}, secret}
                            : registry_login{user, secret, {}};
}

std::string login_header(const registry_login& login,
                         const std::string& registry) {
  document header{
      {"serveraddress", registry == docker_hub ? docker_hub_url : registry}};
  if (login.token.empty()) {
    header["username"] = login.user;
    header["password"] = login.password;
  } else {
    header["identitytoken"] = login.token;
  }
  auto result = to_base64(
      header.dump(-1, ' ', false, document::error_handler_t::replace));
  std::replace(result.begin(), result.end(), '+', '-');
  std::replace(result.begin(), result.end(), '/', '_');
  return result;
}

namespace {

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string{} : std::string{value};
}

fs::path home() {
  if (auto result = variable("HOME"); !result.empty())
    return result;
  const auto* user = ::getpwuid(::geteuid());
  return user == nullptr ? fs::path{} : fs::path{user->pw_dir};
}

edge_error unusable(const std::string& what, const std::string& registry,
                    const std::string& hint) {
  return {error_code::unauthorized,
          what + ", which may know how to log in to registry '" + registry
              + "'",
          hint};
}

/// The node's own file is a secret of the node.
std::optional<edge_error> secrecy_problem(const fs::path& file,
                                          const std::string& registry) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0)
    return unusable("cannot read '" + file.string() + "'", registry,
                    "name the file of logins: --registry-auth FILE");
  if ((info.st_mode & (S_IRWXG | S_IRWXO)) == 0)
    return std::nullopt;
  return unusable("others may read '" + file.string() + "'", registry,
                  "chmod 600 " + file.string());
}

/// The helper gets the registry's name on its input, by a shell, for programs
/// of ours have none.
edge_result<std::optional<registry_login>>
ask_helper(const std::string& helper, const std::string& registry,
           const std::map<std::string, std::string>& environment) {
  if (!is_helper_name(helper))
    return unusable("'" + helper + "' is no name of a credential helper",
                    registry, "see credsStore and credHelpers in config.json");
  const auto name = "docker-credential-" + helper;
  const program shell{"/bin/sh",
                      {"-c", R"(printf %s "$1" | "$0" get 2>/dev/null)", name,
                       registry == docker_hub ? docker_hub_url : registry},
                      environment};
  const auto said = run_program(shell, limits::engine::login_helper,
                                limits::engine::login_bytes);
  if (const auto* text = std::get_if<std::string>(&said))
    return read_helper_answer(*text);
  const auto& why = std::get<edge_error>(said);
  // Where nobody has logged in it is asked without.
  if (why.message.find("credentials not found") != std::string::npos)
    return std::optional<registry_login>{};
  return unusable(why.code == error_code::timeout ? name + " does not answer"
                                                  : name + " fails",
                  registry, "try it: echo " + registry + " | " + name + " get");
}

edge_result<std::optional<registry_login>>
login_in_file(const fs::path& file, const image_reference& image,
              const std::map<std::string, std::string>& environment) {
  const auto text = read_small_file(file, limits::engine::login_bytes);
  if (!text)
    return std::optional<registry_login>{};
  const auto logins = document::parse(*text, nullptr, false);
  if (!logins.is_object())
    return unusable("'" + file.string() + "' is no JSON object", image.registry,
                    "log in anew: docker login " + image.registry);
  auto known = read_login(logins, image.registry, image.repository);
  if (known.helper.empty() || known.login)
    return std::move(known.login);
  return ask_helper(known.helper, image.registry, environment);
}

} // namespace

login_places find_login_places(const std::string& engine, const fs::path& own) {
  login_places result;
  result.own = own;
  const auto at_home = home();
  const auto add = [&](const fs::path& folder, const fs::path& rest) {
    if (!folder.empty())
      result.files.push_back(folder / rest);
  };
  if (engine == "podman") {
    add(variable("REGISTRY_AUTH_FILE"), "");
    add(variable("XDG_RUNTIME_DIR"), "containers/auth.json");
    result.files.emplace_back("/run/containers/" + std::to_string(::geteuid())
                              + "/auth.json");
    add(at_home, ".config/containers/auth.json");
  }
  add(variable("DOCKER_CONFIG"), "config.json");
  add(at_home, ".docker/config.json");
  for (auto& file : result.files)
    if (!file.has_filename())
      file = file.parent_path();
  constexpr const char* wanted[] = {"PATH",
                                    "HOME",
                                    "XDG_RUNTIME_DIR",
                                    "DBUS_SESSION_BUS_ADDRESS",
                                    "GNUPGHOME",
                                    "PASSWORD_STORE_DIR"};
  for (const auto* name : wanted)
    if (auto value = variable(name); !value.empty())
      result.environment[name] = std::move(value);
  return result;
}

edge_result<std::string> find_login_header(const std::string& image,
                                           const login_places& places) {
  const auto about = parse_image_reference(image);
  auto files = places.files;
  if (!places.own.empty()) {
    if (auto why = secrecy_problem(places.own, about.registry))
      return std::move(*why);
    files.insert(files.begin(), places.own);
  }
  for (const auto& file : files) {
    auto found = login_in_file(file, about, places.environment);
    if (auto* why = std::get_if<edge_error>(&found))
      return std::move(*why);
    if (const auto& login = std::get<std::optional<registry_login>>(found))
      return login_header(*login, about.registry);
  }
  return std::string{};
}

} // namespace roscell
