#include "actors/edge/history/event_numbers.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/history/limits.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

/// Always so many digits, so that one write replaces all of the one before.
constexpr size_t number_digits = 16;

/// A number above is not of ours: a double of JSON holds no more.
constexpr uint64_t highest_number = uint64_t{1} << 53;

uint64_t set_aside_in(const std::filesystem::path& file) {
  const auto text = read_small_file(file, number_digits + 1);
  uint64_t result = 0;
  if (!text
      || std::from_chars(text->data(), text->data() + text->size(), result).ec
             != std::errc{}
      || result >= highest_number)
    return 0;
  return result;
}

} // namespace

event_numbers::event_numbers(std::filesystem::path file)
    : file_(std::move(file)), before_(set_aside_in(file_)), end_(before_) {
  // nop
}

std::optional<edge_error> event_numbers::set_aside(uint64_t used) {
  if (end_ >= used + limits::history::numbers / 2)
    return std::nullopt;
  return write(used + limits::history::numbers);
}

std::optional<edge_error> event_numbers::finish(uint64_t used) {
  return write(std::max(used, before_));
}

std::optional<edge_error> event_numbers::write(uint64_t end) {
  auto text = std::to_string(end);
  text = std::string(number_digits - text.size(), '0') + text + '\n';
  const unique_fd fd{
      ::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600)};
  if (!fd
      || ::pwrite(fd.get(), text.data(), text.size(), 0)
             != static_cast<ssize_t>(text.size())
      || ::fdatasync(fd.get()) != 0)
    return edge_error{error_code::internal,
                      "cannot write '" + file_.string()
                          + "': " + std::strerror(errno),
                      "free some disk space, or give this user write access"};
  end_ = end;
  return std::nullopt;
}

} // namespace roscell
