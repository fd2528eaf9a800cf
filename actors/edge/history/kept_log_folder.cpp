#include "actors/edge/history/kept_log_folder.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/history/limits.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <string_view>
#include <system_error>
#include <tuple>
#include <utility>
#include <variant>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr const char* about_name = "about.json";
/// What a log is called until all of it is there.
constexpr const char* unfinished = ".part";
/// So many logs make room for a new one on a full disk.
constexpr int most_dropped = 8;

std::string name_of(const std::string& instance, int64_t ended_unix_ms) {
  return instance + '@' + std::to_string(ended_unix_ms);
}

/// The end that a name tells; nothing if it is none of ours.
std::optional<int64_t> end_in(std::string_view name, size_t at) {
  int64_t result = 0;
  const auto* end = name.data() + name.size();
  if (at == 0 || at == name.npos)
    return std::nullopt;
  const auto [rest, error] = std::from_chars(name.data() + at + 1, end, result);
  if (error != std::errc{} || rest != end || result < 0)
    return std::nullopt;
  return result;
}

int64_t changed_unix_ms(const struct stat& info) {
  return static_cast<int64_t>(info.st_mtim.tv_sec) * 1000
         + info.st_mtim.tv_nsec / 1'000'000;
}

bool begins_with(std::string_view text, std::string_view beginning) {
  return text.substr(0, beginning.size()) == beginning;
}

bool is_log_file(const fs::path& path) {
  const auto name = path.filename().string();
  return (begins_with(name, "log.") || begins_with(name, "times."))
         && is_file(path);
}

/// The times of lines as a shim notes them.
std::string notes_of(const log_part& part) {
  std::string result;
  int64_t offset = 0;
  int64_t last = 0;
  for (const auto unix_ms : part.times_unix_ms) {
    const time_note note{offset, unix_ms};
    if (unix_ms > 0 && unix_ms != std::exchange(last, unix_ms))
      result.append(reinterpret_cast<const char*>(&note), sizeof(note));
    const auto end = part.text.find('\n', static_cast<size_t>(offset));
    if (end == part.text.npos)
      break;
    offset = static_cast<int64_t>(end) + 1;
  }
  return result;
}

} // namespace

kept_log_folder::kept_log_folder(fs::path folder) : folder_(std::move(folder)) {
  // nop
}

/// The newest first.
std::vector<kept_log_folder::entry> kept_log_folder::entries() const {
  std::vector<entry> result;
  for_each_in(folder_, [&](const fs::path& path) {
    entry x;
    x.name = path.filename().string();
    const auto at = x.name.rfind('@');
    struct stat info {};
    if (!look_at(path, info))
      return;
    const auto end = end_in(x.name, at);
    x.unix_ms = end.value_or(changed_unix_ms(info));
    if (end && S_ISDIR(info.st_mode))
      x.instance = x.name.substr(0, at);
    result.push_back(std::move(x));
  });
  std::sort(result.begin(), result.end(), [](const entry& x, const entry& y) {
    return std::tie(y.unix_ms, y.name) < std::tie(x.unix_ms, x.name);
  });
  return result;
}

/// Nothing where it is damaged. It is kept as a message with one log, so that
/// it is checked like one from outside.
std::optional<kept_log> kept_log_folder::read(const entry& x) const {
  const auto folder = folder_ / x.name;
  const auto file = folder / about_name;
  if (x.instance.empty() || !is_file(file))
    return std::nullopt;
  const auto text = read_small_file(file, limits::history::about_bytes);
  const auto parsed = parse_document(text.value_or(std::string{}));
  const auto* document = std::get_if<json>(&parsed);
  if (document == nullptr || validate_message(*document))
    return std::nullopt;
  auto about = decode<kept_logs>(*document);
  auto* found = std::get_if<kept_logs>(&about);
  if (found == nullptr || found->logs.size() != 1
      || found->logs.front().instance != x.instance)
    return std::nullopt;
  auto result = std::move(found->logs.front());
  result.ended_unix_ms = x.unix_ms;
  result.bytes = 0;
  for_each_in(folder, [&](const fs::path& path) {
    struct stat info {};
    if (begins_with(path.filename().string(), "log.") && look_at(path, info)
        && S_ISREG(info.st_mode))
      result.bytes += static_cast<int64_t>(info.st_size);
  });
  return result;
}

kept_logs kept_log_folder::list(const kept_logs_query& query) const {
  kept_logs result;
  for (const auto& x : entries()) {
    if (!query.instance.empty() && x.instance != query.instance)
      continue;
    if (result.logs.size() >= limits::history::listed_logs)
      break;
    auto about = read(x);
    if (!about)
      ++result.unreadable;
    else if (query.task.empty() || about->task == query.task)
      result.logs.push_back(std::move(*about));
  }
  return result;
}

std::optional<instance_log>
kept_log_folder::newest_of(const std::string& instance) const {
  for (const auto& x : entries())
    if (!instance.empty() && x.instance == instance)
      return instance_log{folder_ / x.name};
  return std::nullopt;
}

/// The folder in which a log is put together. One that was begun before the
/// node ended goes on.
std::optional<fs::path> kept_log_folder::begin(const kept_log& about) {
  std::error_code error;
  fs::create_directories(folder_, error);
  const auto result =
      folder_ / (name_of(about.instance, about.ended_unix_ms) + unfinished);
  if (::mkdir(result.c_str(), 0700) == 0 || errno == EEXIST)
    return is_folder(result) ? std::optional{result} : std::nullopt;
  return std::nullopt;
}

bool kept_log_folder::finish(const fs::path& part, const kept_log& about) {
  constexpr int64_t attempts = 16;
  kept_logs document;
  document.logs.push_back(about);
  document.logs.front().bytes = 0;
  const auto text = message_json(document).dump(-1, ' ', false,
                                                json::error_handler_t::replace)
                    + '\n';
  // That is how its reader knows that nothing follows.
  if (!write_file(part / "exit", {}))
    return false;
  auto written = write_file(part / about_name, text);
  if (!written)
    look();
  for (int i = 0; !written && i < most_dropped && drop_oldest(); ++i)
    written = write_file(part / about_name, text);
  if (!written)
    return false;
  // The same instance has hardly ended twice at one moment.
  for (int64_t i = 0; i < attempts; ++i) {
    const auto name = name_of(about.instance, about.ended_unix_ms + i);
    if (::rename(part.c_str(), (folder_ / name).c_str()) == 0) {
      drop_surplus(about.instance);
      return true;
    }
  }
  return false;
}

void kept_log_folder::drop_surplus(const std::string& instance) {
  size_t runs = 0;
  size_t all = 0;
  for (const auto& x : entries()) {
    const bool surplus =
        ++all > limits::history::logs
        || (x.instance == instance && ++runs > limits::history::runs);
    std::error_code ignored;
    if (surplus)
      fs::remove_all(folder_ / x.name, ignored);
  }
}

bool kept_log_folder::keep(const fs::path& from, const kept_log& about) {
  std::vector<fs::path> files;
  for_each_in(from, [&](const fs::path& x) {
    if (is_log_file(x))
      files.push_back(x);
  });
  if (files.empty() || about.instance.empty())
    return false;
  const auto part = begin(about);
  if (!part)
    return false;
  std::error_code error;
  for (const auto& x : files)
    fs::rename(x, *part / x.filename(), error);
  return finish(*part, about);
}

bool kept_log_folder::keep(const log_part& end, const kept_log& about) {
  const auto part = about.instance.empty() ? std::nullopt : begin(about);
  if (!part)
    return false;
  const auto notes = notes_of(end);
  if (write_file(*part / "log.0", end.text)
      && (notes.empty() || write_file(*part / "times.0", notes))
      && finish(*part, about))
    return true;
  std::error_code ignored;
  fs::remove_all(*part, ignored);
  return false;
}

void kept_log_folder::look() {
  seen_.clear();
  bytes_ = 0;
  for (auto& x : entries()) {
    const auto bytes = bytes_below(folder_ / x.name);
    bytes_ += bytes;
    seen_.push_back({std::move(x), bytes});
  }
}

std::optional<int64_t> kept_log_folder::oldest_unix_ms() const {
  return seen_.empty() ? std::nullopt
                       : std::optional{seen_.back().what.unix_ms};
}

bool kept_log_folder::drop_oldest() {
  if (seen_.empty())
    return false;
  std::error_code ignored;
  fs::remove_all(folder_ / seen_.back().what.name, ignored);
  bytes_ -= seen_.back().bytes;
  seen_.pop_back();
  return true;
}

bool look_at(const fs::path& path, struct stat& info) {
  return ::lstat(path.c_str(), &info) == 0;
}

bool is_folder(const fs::path& path) {
  struct stat info {};
  return look_at(path, info) && S_ISDIR(info.st_mode);
}

bool is_file(const fs::path& path) {
  struct stat info {};
  return look_at(path, info) && S_ISREG(info.st_mode);
}

namespace {

/// What one file or folder, without what is in it, takes on the disk.
uint64_t bytes_of(const fs::path& path) {
  constexpr uint64_t block = 512;
  struct stat info {};
  if (!look_at(path, info))
    return 0;
  return std::max(static_cast<uint64_t>(info.st_blocks) * block,
                  static_cast<uint64_t>(info.st_size));
}

} // namespace

uint64_t bytes_below(const fs::path& path) {
  auto result = bytes_of(path);
  if (is_folder(path))
    for_each_in(path, [&](const fs::path& x) { result += bytes_of(x); });
  return result;
}

bool write_file(const fs::path& path, std::string_view bytes) {
  const unique_fd fd{
      ::open(path.c_str(),
             O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600)};
  return fd && write_whole(fd.get(), bytes);
}

} // namespace roscell
