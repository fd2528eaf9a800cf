#include "actors/edge/session/site_token.hpp"

#include "actors/edge/disk/file_rights.hpp"
#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/edge/trust/site_identity.hpp"

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
#include <mutex>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

/// Tells one state of a file from another.
struct file_mark {
  dev_t device = 0;
  ino_t number = 0;
  off_t size = -1;
  timespec written{};
  timespec changed{};
};

bool same_time(const timespec& x, const timespec& y) {
  return x.tv_sec == y.tv_sec && x.tv_nsec == y.tv_nsec;
}

bool operator==(const file_mark& x, const file_mark& y) {
  return x.device == y.device && x.number == y.number && x.size == y.size
         && same_time(x.written, y.written) && same_time(x.changed, y.changed);
}

file_mark mark_of(const std::filesystem::path& file) {
  struct stat info {};
  if (file.empty() || ::stat(file.c_str(), &info) != 0)
    return {};
  return {info.st_dev, info.st_ino, info.st_size, info.st_mtim, info.st_ctim};
}

} // namespace

class site_secret::keeper {
public:
  explicit keeper(std::string text) : text_(std::move(text)) {}

  explicit keeper(std::filesystem::path file) : file_(std::move(file)) {}

  const std::filesystem::path& file() const {
    return file_;
  }

  std::string text() {
    std::lock_guard guard{mutex_};
    look();
    return text_;
  }

  lack what_lacks() {
    std::lock_guard guard{mutex_};
    look();
    if (!text_.empty())
      return {};
    const auto read = read_site_token(file_);
    const auto* why = std::get_if<edge_error>(&read);
    return why != nullptr ? lack{why->message, why->hint} : lack{};
  }

private:
  /// A file that has gone, or that others may have changed, takes nothing from
  /// a node that has a token: it would lose its cell.
  void look() {
    if (file_.empty())
      return;
    const auto mark = mark_of(file_);
    if (mark == seen_)
      return;
    auto read = read_site_token(file_);
    auto* token = std::get_if<std::string>(&read);
    // What was wrong may be fixed beside the file.
    if (token == nullptr)
      return;
    text_ = std::move(*token);
    seen_ = mark;
  }

  const std::filesystem::path file_;
  std::mutex mutex_; // Guards what follows.
  std::string text_;
  file_mark seen_;
};

site_secret::site_secret() : site_secret(std::string{}) {}

site_secret::site_secret(std::string text)
    : keeper_(std::make_shared<keeper>(std::move(text))) {}

site_secret::site_secret(const char* text) : site_secret(std::string{text}) {}

site_secret::site_secret(std::shared_ptr<keeper> x) : keeper_(std::move(x)) {}

site_secret site_secret::in_file(std::filesystem::path file) {
  return site_secret{std::make_shared<keeper>(std::move(file))};
}

site_secret site_secret::of_identity(std::shared_ptr<site_identity> identity) {
  site_secret result{"site " + identity->site_digest()};
  result.identity_ = std::move(identity);
  return result;
}

const std::shared_ptr<site_identity>& site_secret::identity() const {
  return identity_;
}

const std::filesystem::path& site_secret::file() const {
  return keeper_->file();
}

std::string site_secret::text() const {
  return keeper_->text();
}

site_secret::lack site_secret::what_lacks() const {
  return keeper_->what_lacks();
}

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

std::optional<edge_error> refuse_open_file(const fs::path& file) {
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
  if (auto why = refuse_open_file(file))
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
