#include "actors/edge/history/event_lines.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/history/limits.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "schemas/document.hpp"
#include "schemas/message_catalogue.hpp"
#include "schemas/utf8.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <string>
#include <system_error>
#include <utility>
#include <variant>

namespace roscell {

namespace {

/// As the schema has it.
constexpr size_t most_subject_bytes = 256;

std::string plain_line_of(const event& x) {
  return std::to_string(x.sequence) + ' '
         + message_json(x).dump(-1, ' ', false, json::error_handler_t::replace)
         + '\n';
}

} // namespace

std::string line_of(const event& x) {
  auto result = plain_line_of(x);
  if (x.subject.size() <= most_subject_bytes
      && result.size() <= limits::history::line_bytes)
    return result;
  auto fitting = x;
  fitting.subject.resize(std::min(x.subject.size(), most_subject_bytes));
  fitting.subject.resize(fitting.subject.size()
                         - unfinished_utf8(fitting.subject));
  if (result.size() > limits::history::line_bytes)
    fitting.data = json{{"left_out_bytes", x.data.size()}}.dump();
  return plain_line_of(fitting);
}

std::optional<uint64_t> number_of(std::string_view line) {
  uint64_t result = 0;
  const auto* end = line.data() + line.size();
  const auto [rest, error] = std::from_chars(line.data(), end, result);
  if (error != std::errc{} || rest == end || *rest != ' ' || result == 0)
    return std::nullopt;
  return result;
}

std::optional<event> event_of(std::string_view line) {
  const auto number = number_of(line);
  if (!number || line.size() > limits::history::line_bytes)
    return std::nullopt;
  line.remove_prefix(line.find(' ') + 1);
  auto parsed = parse_document(line);
  const auto* document = std::get_if<json>(&parsed);
  if (document == nullptr || validate_message(*document, {message_kind::event}))
    return std::nullopt;
  auto decoded = decode<event>(*document);
  auto* result = std::get_if<event>(&decoded);
  if (result == nullptr || result->sequence != *number)
    return std::nullopt;
  return std::move(*result);
}

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
