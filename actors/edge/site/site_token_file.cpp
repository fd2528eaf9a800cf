#include "actors/edge/site/site_token_file.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/disk/trusted_path.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/site/limits.hpp"

#include <fcntl.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

namespace roscell {

namespace {

namespace fs = std::filesystem;

constexpr size_t made_bytes = 32;

/// An environment variable that says an absolute path, as only those count.
fs::path path_in(const char* variable) {
  const auto* text = std::getenv(variable);
  const fs::path result{text != nullptr ? text : ""};
  return result.is_absolute() ? result : fs::path{};
}

/// Services may have no $HOME.
fs::path home_folder() {
  if (auto reported = path_in("HOME"); !reported.empty())
    return reported;
  std::array<char, 4096> room{};
  struct passwd entry {};
  struct passwd* found = nullptr;
  if (::getpwuid_r(::geteuid(), &entry, room.data(), room.size(), &found) == 0
      && found != nullptr && found->pw_dir != nullptr)
    return fs::path{found->pw_dir};
  return {};
}

fs::path settings_folder() {
  if (::geteuid() == 0)
    return "/etc";
  if (auto reported = path_in("XDG_CONFIG_HOME"); !reported.empty())
    return reported;
  const auto home = home_folder();
  return home.is_absolute() ? home / ".config" : fs::path{};
}

/// Everybody may look into /etc/roscell, which has other files as well.
bool make_folders(const fs::path& folder) {
  if (folder.empty() || ::access(folder.c_str(), F_OK) == 0)
    return true;
  const mode_t mode = folder == "/etc/roscell" ? 0755 : 0700;
  return make_folders(folder.parent_path())
         && (::mkdir(folder.c_str(), mode) == 0 || errno == EEXIST);
}

/// A file that is there is whole, and nobody's but the first one's.
bool put_in_place(const fs::path& file) {
  auto fresh = (file.parent_path() / ".site.token.XXXXXX").string();
  const unique_fd fd{::mkostemp(fresh.data(), O_CLOEXEC)};
  if (!fd)
    return false;
  const bool done =
      write_whole(fd.get(), to_hex(random_bytes(made_bytes)) + "\n")
      && ::fsync(fd.get()) == 0
      && (::link(fresh.c_str(), file.c_str()) == 0 || errno == EEXIST);
  const int problem = errno;
  ::unlink(fresh.c_str());
  errno = problem;
  return done;
}

edge_error cannot_make(const fs::path& file, int problem) {
  return {error_code::internal,
          "cannot make the site token '" + file.string()
              + "': " + std::strerror(problem),
          "let this user write there, or say where it is to be: "
              + std::string{site_token_variable}
              + "=FILE; --site-token FILE takes one that is there"};
}

std::string without_space(const std::string& text) {
  const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
  const auto begin = std::find_if_not(text.begin(), text.end(), is_space);
  const auto end =
      std::find_if_not(text.rbegin(), text.rend(), is_space).base();
  return begin < end ? std::string{begin, end} : std::string{};
}

edge_error unreadable(const fs::path& file) {
  if (file.empty())
    return {error_code::schema_violation,
            "this user has no home directory that could hold a site token",
            site_token_hint(file)};
  const bool readable = ::access(file.c_str(), R_OK) == 0;
  return {error_code::schema_violation,
          "cannot read the site token in '" + file.string() + "': "
              + (readable ? "it has more than "
                                + std::to_string(limits::token::most_bytes)
                                + " bytes"
                          : std::strerror(errno)),
          site_token_hint(file)};
}

std::optional<edge_error> distrusted(const fs::path& file) {
  auto fault = who_may_change(file);
  if (fault.empty())
    fault = who_may_replace(file);
  if (fault.empty())
    return std::nullopt;
  return edge_error{error_code::unauthorized,
                    "the site token in '" + file.string()
                        + "' is not taken: " + fault,
                    "copy it to a place of " + user_text(::geteuid())
                        + " alone, with mode 600"};
}

} // namespace

fs::path own_site_token() {
  if (auto reported = path_in(site_token_variable); !reported.empty())
    return reported;
  const auto settings = settings_folder();
  return settings.empty() ? settings : settings / "roscell" / "site.token";
}

std::optional<edge_error> make_site_token(const fs::path& file) {
  if (file.empty())
    return unreadable(file);
  if (::access(file.c_str(), F_OK) == 0)
    return std::nullopt;
  if (make_folders(file.parent_path()) && put_in_place(file))
    return std::nullopt;
  return cannot_make(file, errno);
}

edge_result<std::string> read_site_token(const fs::path& file) {
  const auto text = read_small_file(file, limits::token::most_bytes);
  if (!text)
    return unreadable(file);
  if (auto why = distrusted(file))
    return *why;
  edge_result<std::string> token = without_space(*text);
  if (std::get<std::string>(token).size() >= limits::token::least_site_bytes)
    return token;
  return edge_error{error_code::schema_violation,
                    "the site token in '" + file.string() + "' is shorter than "
                        + std::to_string(limits::token::least_site_bytes)
                        + " characters",
                    "make one: head -c 32 /dev/urandom | base64"};
}

std::string site_token_hint(const fs::path& file, const std::string& at) {
  const auto here = file.empty() ? "a file of this user, and give it: "
                                   "--site-token FILE"
                                 : "'" + file.string() + "'";
  if (at.empty())
    return "the first coordinator of this user on this host makes one; that of "
           "a cell elsewhere has to be copied to "
           + here;
  return "copy the site token of the coordinator at " + at + " to " + here
         + ": there it is /etc/roscell/site.token if root runs it, else "
           "~/.config/roscell/site.token, unless --site-token says otherwise";
}

} // namespace roscell
