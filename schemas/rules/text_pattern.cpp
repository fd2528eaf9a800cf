#include "schemas/rules/schema_rule.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <stdexcept>
#include <string>

namespace roscell {

class text_pattern::parser {
public:
  explicit parser(std::string_view expression) : all_(expression) {
    if (all_.size() < 2 || all_.front() != '^' || all_.back() != '$')
      refuse();
    rest_ = all_.substr(1, all_.size() - 2);
  }

  std::vector<part> parse() {
    std::vector<part> result;
    while (!rest_.empty()) {
      auto next = take_class();
      take_count(next);
      result.push_back(std::move(next));
    }
    return result;
  }

private:
  [[noreturn]] void refuse() const {
    throw std::invalid_argument{"pattern outside of the subset: "
                                + std::string{all_}};
  }

  char take() {
    if (rest_.empty())
      refuse();
    auto c = rest_.front();
    rest_.remove_prefix(1);
    return c;
  }

  bool skip(char c) {
    if (rest_.empty() || rest_.front() != c)
      return false;
    rest_.remove_prefix(1);
    return true;
  }

  char32_t take_code_point() {
    const auto digits = std::string{rest_.substr(0, 4)};
    if (digits.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos
        || digits.size() != 4)
      refuse();
    rest_.remove_prefix(4);
    return static_cast<char32_t>(std::stoul(digits, nullptr, 16));
  }

  /// One character, of a class or alone. `\uXXXX` names it by its number;
  /// after any other backslash a character stands for itself.
  char32_t take_character() {
    auto c = take();
    if (static_cast<unsigned char>(c) >= 0x80)
      refuse();
    if (c != '\\')
      return static_cast<unsigned char>(c);
    c = take();
    if (c == 'u')
      return take_code_point();
    if (std::isalnum(static_cast<unsigned char>(c)) != 0)
      refuse();
    return static_cast<unsigned char>(c);
  }

  part take_class() {
    part result;
    if (!skip('[')) {
      constexpr std::string_view operators = "()|?*+{}.^$";
      if (operators.find(rest_.front()) != std::string_view::npos)
        refuse();
      auto c = take_character();
      result.ranges.emplace_back(c, c);
      return result;
    }
    result.negated = skip('^');
    while (!skip(']')) {
      auto first = take_character();
      auto is_range = rest_.size() > 1 && rest_[0] == '-' && rest_[1] != ']';
      auto last = is_range && skip('-') ? take_character() : first;
      result.ranges.emplace_back(first, last);
    }
    return result;
  }

  uint32_t take_number() {
    std::string digits;
    while (!rest_.empty() && std::isdigit(static_cast<unsigned char>(rest_[0])))
      digits += take();
    if (digits.empty() || digits.size() > 6)
      refuse();
    return static_cast<uint32_t>(std::stoul(digits));
  }

  void take_count(part& x) {
    constexpr auto unlimited = std::numeric_limits<uint32_t>::max();
    if (skip('*')) {
      x.at_least = 0;
      x.at_most = unlimited;
    } else if (skip('+')) {
      x.at_most = unlimited;
    } else if (skip('{')) {
      x.at_least = take_number();
      x.at_most = skip(',') ? take_number() : x.at_least;
      if (!skip('}'))
        refuse();
    }
  }

  std::string_view all_;
  std::string_view rest_;
};

namespace {

/// The code points of a text that is valid UTF-8.
std::vector<char32_t> code_points(std::string_view utf8) {
  std::vector<char32_t> result;
  for (auto c : utf8) {
    auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80)
      result.push_back(byte);
    else if (byte >= 0xC0)
      result.push_back(byte & (byte < 0xE0 ? 0x1FU : byte < 0xF0 ? 0x0FU : 7U));
    else if (!result.empty())
      result.back() = result.back() << 6U | (byte & 0x3FU);
  }
  return result;
}

} // namespace

text_pattern::text_pattern(std::string_view expression)
    : parts_(parser{expression}.parse()) {
  // nop
}

bool text_pattern::part::takes(char32_t c) const {
  auto in = std::any_of(ranges.begin(), ranges.end(), [c](const auto& range) {
    return range.first <= c && c <= range.second;
  });
  return in != negated;
}

bool text_pattern::matches(std::string_view utf8) const {
  const auto text = code_points(utf8);
  // Marks where the parts so far can end.
  std::vector<bool> ends(text.size() + 1);
  ends[0] = true;
  for (const auto& x : parts_) {
    std::vector<bool> next(text.size() + 1);
    for (size_t start = 0; start <= text.size(); ++start) {
      if (!ends[start])
        continue;
      for (size_t n = 0; n <= x.at_most && start + n <= text.size(); ++n) {
        if (n >= x.at_least)
          next[start + n] = true;
        if (start + n == text.size() || !x.takes(text[start + n]))
          break;
      }
    }
    ends = std::move(next);
  }
  return ends[text.size()];
}

} // namespace roscell
