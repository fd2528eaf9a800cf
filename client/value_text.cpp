#include "client/value_text.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace roscell {

std::string format_number(double value, int decimals) {
  if (!std::isfinite(value))
    return "-";
  std::array<char, 352> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*f", decimals, value);
  std::string text = buffer.data();
  if (text.find('.') != std::string::npos) {
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.')
      text.pop_back();
  }
  return text == "-0" ? "0" : text;
}

std::string format_significant(double value, int digits) {
  if (!std::isfinite(value))
    return "-";
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%.*g", digits, value);
  return buffer.data();
}

std::string format_mib(double mib) {
  return format_number(mib, std::abs(mib) < 10 ? 1 : 0);
}

namespace {

constexpr double mib_per_gib = 1024;

bool is_in_gib(double mib) {
  return std::abs(mib) >= mib_per_gib;
}

std::string format_gib(double mib) {
  return format_number(mib / mib_per_gib, 1);
}

} // namespace

std::string format_memory(double mib) {
  return is_in_gib(mib) ? format_gib(mib) + " GiB" : format_mib(mib) + " MiB";
}

std::string format_memory(double used_mib, double capacity_mib) {
  return is_in_gib(capacity_mib)
             ? format_gib(used_mib) + "/" + format_memory(capacity_mib)
             : format_mib(used_mib) + "/" + format_memory(capacity_mib);
}

std::string format_bytes(double bytes) {
  constexpr std::array units{"B", "KiB", "MiB", "GiB", "TiB"};
  constexpr double next_unit = 1024;
  size_t unit = 0;
  while (bytes >= next_unit && unit + 1 < units.size()) {
    bytes /= next_unit;
    ++unit;
  }
  return format_mib(bytes) + " " + units[unit];
}

std::string format_age(std::chrono::milliseconds age) {
  const auto seconds = std::max<int64_t>(0, age.count() / 1000);
  std::array<char, 48> buffer{};
  auto put = [&](int64_t large, const char* unit, int64_t small,
                 const char* small_unit) {
    std::snprintf(buffer.data(), buffer.size(), "%lld%s%02lld%s",
                  static_cast<long long>(large), unit,
                  static_cast<long long>(small), small_unit);
    return std::string{buffer.data()};
  };
  if (seconds < 60)
    return std::to_string(seconds) + "s";
  if (seconds < 3600)
    return put(seconds / 60, "m", seconds % 60, "s");
  if (seconds < 86400)
    return put(seconds / 3600, "h", seconds / 60 % 60, "m");
  return put(seconds / 86400, "d", seconds / 3600 % 24, "h");
}

std::string format_since(int64_t since_unix_ms, int64_t now_unix_ms) {
  // 2020: what was noted before, and is told after, was noted by a clock that
  // had not been set.
  constexpr int64_t first_true_ms = 1'577'836'800'000;
  if (since_unix_ms <= 0
      || (since_unix_ms < first_true_ms && now_unix_ms >= first_true_ms))
    return "-";
  // Compared first: the difference of any two numbers might overflow.
  if (since_unix_ms > now_unix_ms)
    return "0s";
  return format_age(std::chrono::milliseconds{now_unix_ms - since_unix_ms});
}

std::string joined(const std::vector<std::string>& words,
                   std::string_view between) {
  std::string result;
  for (const auto& word : words) {
    if (!result.empty())
      result += between;
    result += word;
  }
  return result;
}

std::string listed(const std::set<std::string>& names) {
  return joined({names.begin(), names.end()});
}

std::string listed(const std::map<std::string, std::string>& pairs) {
  std::vector<std::string> words;
  words.reserve(pairs.size());
  for (const auto& [key, value] : pairs)
    words.push_back(key + "=" + value);
  return joined(words);
}

} // namespace roscell
