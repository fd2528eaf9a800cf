#include "actors/edge/history/audit_file.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/history/limits.hpp"
#include "actors/edge/io/crypto.hpp"
#include "actors/edge/io/plain_text.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "schemas/document.hpp"
#include "schemas/utf8.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string_view>
#include <system_error>
#include <utility>

namespace roscell {

namespace {

namespace fs = std::filesystem;

fs::path present_file(const fs::path& folder) {
  return folder / "audit";
}

fs::path former_file(const fs::path& folder) {
  return folder / "audit.1";
}

std::optional<audit_record> record_in(std::string_view line) {
  auto parsed = parse_document(std::string{line});
  const auto* document = std::get_if<json>(&parsed);
  if (document == nullptr)
    return std::nullopt;
  auto read = decode<audit_record>(*document);
  auto* x = std::get_if<audit_record>(&read);
  return x == nullptr ? std::nullopt : std::optional{std::move(*x)};
}

/// Calls `take` with each whole line of both files, the oldest first.
template <class Take>
void each_line(const fs::path& folder, Take take) {
  for (const auto& file : {former_file(folder), present_file(folder)}) {
    const auto text =
        read_small_file(file, 2 * limits::audit::file_bytes).value_or("");
    for (std::string_view rest{text}; !rest.empty();)
      take(take_until(rest, '\n'));
  }
}

edge_error audit_failed(const fs::path& file) {
  return {error_code::internal,
          "cannot write '" + file.string() + "': " + std::strerror(errno),
          "free some disk space, or give this user write access"};
}

void keep_short(std::string& text) {
  text = valid_utf8(text);
  if (text.size() > limits::audit::text_bytes)
    text = valid_utf8(text.substr(0, limits::audit::text_bytes));
}

/// Follows the chain from record to record.
class chain_reader {
public:
  void take(std::string_view line) {
    auto x = record_in(line);
    if (!x)
      return note_gap("the line after record " + std::to_string(last_number_)
                      + " is no record");
    const bool first = last_number_ == 0;
    if (!first && x->number != last_number_ + 1)
      note_gap("record " + std::to_string(last_number_ + 1)
               + " is missing, and what follows it up to "
               + std::to_string(x->number - 1));
    else if (!first && hash_of(*x, last_hash_) != x->hash)
      note_gap("record " + std::to_string(x->number) + " was altered");
    else if (first && x->number == 1 && hash_of(*x, "") != x->hash)
      note_gap("record 1 was altered");
    last_number_ = x->number;
    last_hash_ = x->hash;
    last_ = std::move(*x);
  }

  const std::string& gap() const {
    return gap_;
  }

  /// The last one that was taken; none: the line was no record.
  std::optional<audit_record> last() {
    return std::exchange(last_, std::nullopt);
  }

  int64_t last_number() const {
    return last_number_;
  }

  const std::string& last_hash() const {
    return last_hash_;
  }

private:
  void note_gap(const std::string& text) {
    if (gap_.empty())
      gap_ = text;
  }

  std::string gap_;
  std::optional<audit_record> last_;
  int64_t last_number_ = 0;
  std::string last_hash_;
};

} // namespace

std::string hash_of(const audit_record& x, const std::string& before) {
  sha256_sum sum;
  for (const auto& text :
       {before, std::to_string(x.number), std::to_string(x.unix_ms), x.from,
        x.request, x.subject, x.outcome})
    sum.add_text(text);
  return sum.hex();
}

audit_file::audit_file(fs::path folder) : folder_(std::move(folder)) {
  take_up();
}

void audit_file::take_up() {
  std::error_code ignored;
  fs::create_directories(folder_, ignored);
  const auto file = present_file(folder_);
  const auto text = read_small_file(file, 2 * limits::audit::file_bytes);
  if (text && !text->empty() && text->back() != '\n') {
    const auto whole = text->rfind('\n');
    fs::resize_file(file, whole == std::string::npos ? 0 : whole + 1, ignored);
  }
  chain_reader chain;
  each_line(folder_, [&](std::string_view line) { chain.take(line); });
  last_number_ = chain.last_number();
  last_hash_ = chain.last_hash();
}

/// The former file goes, and this one becomes it.
std::optional<edge_error> audit_file::make_room(size_t bytes) {
  const auto file = present_file(folder_);
  std::error_code problem;
  const auto size = fs::file_size(file, problem);
  if (problem || size + bytes <= limits::audit::file_bytes)
    return std::nullopt;
  if (::rename(file.c_str(), former_file(folder_).c_str()) != 0)
    return audit_failed(file);
  return std::nullopt;
}

edge_result<audit_record> audit_file::append(audit_record x) {
  for (auto* text : {&x.from, &x.request, &x.subject, &x.outcome})
    keep_short(*text);
  x.number = last_number_ + 1;
  x.hash = hash_of(x, last_hash_);
  const auto line = json(x).dump() + "\n";
  if (auto why = make_room(line.size()))
    return *why;
  const auto file = present_file(folder_);
  const unique_fd fd{
      ::open(file.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0600)};
  if (!fd || !write_whole(fd.get(), line) || ::fdatasync(fd.get()) != 0)
    return audit_failed(file);
  last_number_ = x.number;
  last_hash_ = x.hash;
  return x;
}

audit_list audit_file::read(int64_t since, int64_t newest) const {
  const auto most = newest > 0 ? std::min<size_t>(static_cast<size_t>(newest),
                                                  limits::audit::newest)
                               : limits::audit::newest;
  audit_list result;
  chain_reader chain;
  each_line(folder_, [&](std::string_view line) {
    chain.take(line);
    auto x = chain.last();
    if (!x || x->number <= since)
      return;
    if (result.records.size() == most)
      result.records.erase(result.records.begin());
    result.records.push_back(std::move(*x));
  });
  result.gap = chain.gap();
  return result;
}

} // namespace roscell
