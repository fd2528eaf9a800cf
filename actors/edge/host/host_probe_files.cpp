#include "actors/edge/host/host_probe_files.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <fcntl.h>
#include <unistd.h>

namespace roscell {

std::optional<std::string> read_file(const std::string& path,
                                     std::size_t max_bytes) {
  int fd = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0)
    return std::nullopt;
  std::string result(max_bytes, '\0');
  std::size_t filled = 0;
  ssize_t got = 1;
  while (filled < max_bytes && got > 0) {
    got = read(fd, result.data() + filled, max_bytes - filled);
    filled += got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  close(fd);
  if (got < 0)
    return std::nullopt;
  result.resize(filled);
  return result;
}

std::string_view take_word(std::string_view& text) {
  constexpr std::string_view blanks = " \t\n";
  text.remove_prefix(std::min(text.find_first_not_of(blanks), text.size()));
  auto result = text.substr(0, text.find_first_of(blanks));
  text.remove_prefix(result.size());
  return result;
}

std::string_view take_line(std::string_view& text) {
  auto result = text.substr(0, text.find('\n'));
  text.remove_prefix(std::min(result.size() + 1, text.size()));
  return result;
}

std::optional<long long> to_number(std::string_view word) {
  long long result = 0;
  auto* last = word.data() + word.size();
  auto [ptr, ec] = std::from_chars(word.data(), last, result);
  if (ec != std::errc{} || ptr != last)
    return std::nullopt;
  return result;
}

std::optional<double> to_fraction(std::string_view word) {
  double result = 0;
  auto* last = word.data() + word.size();
  auto [ptr, ec] =
      std::from_chars(word.data(), last, result, std::chars_format::fixed);
  if (ec != std::errc{} || ptr != last || !std::isfinite(result) || result < 0)
    return std::nullopt;
  return result;
}

} // namespace roscell
