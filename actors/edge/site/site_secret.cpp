#include "actors/edge/site/site_secret.hpp"

#include "actors/edge/site/site_token_file.hpp"

#include <sys/stat.h>

#include <mutex>
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

const std::filesystem::path& site_secret::file() const {
  return keeper_->file();
}

std::string site_secret::text() const {
  return keeper_->text();
}

site_secret::lack site_secret::what_lacks() const {
  return keeper_->what_lacks();
}

} // namespace roscell
