#include "tools/roscell/top/layout/listing.hpp"

#include "tools/roscell/view/table/choice.hpp"

#include <algorithm>
#include <cctype>

namespace roscell::cli::top {

namespace {

char lowered(char c) {
  return static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
}

bool shows(const item& x, const std::string& filter) {
  return contains_words(x.id, filter)
         || std::any_of(x.cells.begin(), x.cells.end(), [&](const cell& c) {
              return contains_words(c.text, filter);
            });
}

bool is_nothing(const cell& x) {
  return x.usage ? x.usage->capacity <= 0 : x.text.empty() || x.text == "-";
}

/// By what a cell is sorted, where that is a number.
std::optional<double> number_of(const cell& x) {
  return x.usage ? x.usage->part() : cell_value(x.text);
}

bool is_before(const cell& x, const cell& y, bool backwards) {
  if (is_nothing(x) || is_nothing(y))
    return !is_nothing(x) && is_nothing(y);
  const auto& first = backwards ? y : x;
  const auto& second = backwards ? x : y;
  const auto a = number_of(first);
  const auto b = number_of(second);
  if (a && b)
    return *a < *b;
  return a || b ? a.has_value() : first.text < second.text;
}

/// "discovery-server" means "DISCOVERY SERVER".
std::string plain_column_name(const std::string& name) {
  std::string result;
  for (const auto c : name)
    result += c == '-' || c == '_' ? ' ' : lowered(c);
  return result;
}

} // namespace

bool contains_words(const std::string& text, const std::string& part) {
  const auto found =
      std::search(text.begin(), text.end(), part.begin(), part.end(),
                  [](char x, char y) { return lowered(x) == lowered(y); });
  return part.empty() || found != text.end();
}

std::optional<size_t> column_of(const listing& all, const std::string& name) {
  for (size_t i = 0; i < all.columns.size(); ++i)
    if (plain_column_name(all.columns[i].name) == plain_column_name(name))
      return i;
  return std::nullopt;
}

listing chosen(listing all, const std::string& filter,
               const item_order& order) {
  auto& items = all.items;
  items.erase(std::remove_if(items.begin(), items.end(),
                             [&](const item& x) { return !shows(x, filter); }),
              items.end());
  std::stable_sort(
      items.begin(), items.end(), [&](const item& x, const item& y) {
        return is_before(x.cells.at(order.column), y.cells.at(order.column),
                         order.backwards);
      });
  return all;
}

} // namespace roscell::cli::top
