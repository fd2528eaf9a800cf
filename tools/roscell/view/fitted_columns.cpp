#include "tools/roscell/view/table.hpp"

#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace roscell::cli {

namespace {

constexpr size_t gap = 2;

size_t total(const std::vector<size_t>& widths) {
  size_t result = 0;
  for (const auto width : widths)
    if (width > 0)
      result += width + (result > 0 ? gap : 0);
  return result;
}

/// The columns that are there, those that matter least first.
std::vector<size_t> by_rank(const std::vector<column_request>& columns,
                            const std::vector<size_t>& widths) {
  std::vector<size_t> result;
  for (size_t i = columns.size(); i-- > 0;)
    if (widths[i] > 0)
      result.push_back(i);
  std::stable_sort(result.begin(), result.end(), [&](size_t x, size_t y) {
    return columns[x].rank > columns[y].rank;
  });
  return result;
}

/// Shortens as far as need be; false if that is not enough.
bool shorten(const std::vector<column_request>& columns, size_t width,
             bool those_that_stay, std::vector<size_t>& widths) {
  for (const auto i : by_rank(columns, widths)) {
    const auto now = total(widths);
    if (now <= width)
      return true;
    if (columns[i].rank > 0 || those_that_stay)
      widths[i] = std::max(std::min(columns[i].least, widths[i]),
                           widths[i] - std::min(widths[i], now - width));
  }
  return total(widths) <= width;
}

} // namespace

std::vector<size_t> fitted(const std::vector<column_request>& columns,
                           size_t width) {
  std::vector<size_t> natural;
  natural.reserve(columns.size());
  for (const auto& x : columns)
    natural.push_back(std::max<size_t>(1, x.natural));
  while (true) {
    auto widths = natural;
    if (shorten(columns, width, false, widths))
      return widths;
    const auto order = by_rank(columns, natural);
    if (order.empty() || columns[order.front()].rank == 0) {
      shorten(columns, width, true, widths);
      return widths;
    }
    natural[order.front()] = 0;
  }
}

namespace {

/// As it is compared: "discovery-server" means "DISCOVERY SERVER".
std::string plain_name(std::string_view name) {
  std::string result;
  for (const auto c : name)
    result +=
        c == '-' || c == '_'
            ? ' '
            : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return result;
}

size_t index_of(const table& all, const std::string& name) {
  if (const auto found = column_of(all, name))
    return *found;
  std::vector<std::string> names;
  for (const auto& x : all.columns)
    names.push_back(x.name);
  throw command_error{exit_usage, "there is no column '" + name + "'",
                      "the columns are " + joined(names, ", ")};
}

bool has_any(const table& all, size_t i) {
  return std::any_of(all.rows.begin(), all.rows.end(), [&](const auto& row) {
    return i < row.size() && !row[i].text.empty();
  });
}

std::vector<size_t> chosen_columns(const table& all,
                                   const table_options& options) {
  std::vector<size_t> result;
  for (const auto& name : options.columns)
    result.push_back(index_of(all, name));
  if (!result.empty())
    return result;
  for (size_t i = 0; i < all.columns.size(); ++i) {
    const auto& what = all.columns[i];
    if ((options.wide || what.rank < only_wide)
        && (!what.if_any || has_any(all, i)))
      result.push_back(i);
  }
  return result;
}

cell cell_at(const std::vector<cell>& row, size_t i) {
  return i < row.size() ? row[i] : cell{};
}

/// A time that is not known is said as "-".
bool is_nothing(const std::string& x) {
  return x.empty() || x == "-";
}

/// Numbers before words, and nothing behind both.
bool is_less(const std::string& x, const std::string& y) {
  if (is_nothing(x) || is_nothing(y))
    return !is_nothing(x) && is_nothing(y);
  const auto a = cell_value(x);
  const auto b = cell_value(y);
  if (a && b)
    return *a < *b;
  return a || b ? a.has_value() : x < y;
}

void sort_rows(std::vector<std::vector<cell>>& rows, size_t by,
               bool from_the_end) {
  std::stable_sort(rows.begin(), rows.end(), [&](const auto& x, const auto& y) {
    const auto a = cell_at(x, by).text;
    const auto b = cell_at(y, by).text;
    // What is not known stays behind, whatever the direction.
    return from_the_end && !is_nothing(a) && !is_nothing(b) ? is_less(b, a)
                                                            : is_less(a, b);
  });
}

bool shows(const std::vector<cell>& row, const std::string& filter) {
  return std::any_of(row.begin(), row.end(), [&](const cell& x) {
    return contains_words(x.text, filter);
  });
}

double factor_of(std::string_view unit) {
  constexpr std::pair<std::string_view, double> units[] = {
      {"KiB", 1024.0},
      {"MiB", 1024.0 * 1024},
      {"GiB", 1024.0 * 1024 * 1024},
      {"TiB", 1024.0 * 1024 * 1024 * 1024}};
  for (const auto& [name, factor] : units)
    if (unit == name)
      return factor;
  return 1;
}

/// Seconds of "5d03h" and the like, if that is all there is.
std::optional<double> seconds_of(const std::string& text) {
  constexpr std::pair<char, double> units[] = {
      {'s', 1}, {'m', 60}, {'h', 3600}, {'d', 86400}};
  double result = 0;
  for (const auto* at = text.c_str(); *at != '\0';) {
    char* end = nullptr;
    const auto value = std::strtod(at, &end);
    const auto* unit =
        std::find_if(std::begin(units), std::end(units),
                     [&](const auto& x) { return x.first == *end; });
    if (end == at || unit == std::end(units))
      return std::nullopt;
    result += value * unit->second;
    at = end + 1;
  }
  return result;
}

} // namespace

std::optional<double> cell_value(std::string_view text) {
  const std::string copy{text};
  if (copy.empty() || copy.find_first_of("0123456789") > 1)
    return std::nullopt;
  if (const auto seconds = seconds_of(copy))
    return seconds;
  char* end = nullptr;
  const auto value = std::strtod(copy.c_str(), &end);
  if (end == copy.c_str() || (*end != '\0' && *end != '/' && *end != ' '))
    return std::nullopt;
  const auto space = copy.rfind(' ');
  return space == std::string::npos
             ? value
             : value * factor_of(std::string_view{copy}.substr(space + 1));
}

std::optional<size_t> column_of(const table& all, const std::string& name) {
  for (size_t i = 0; i < all.columns.size(); ++i)
    if (plain_name(all.columns[i].name) == plain_name(name))
      return i;
  return std::nullopt;
}

bool contains_words(const std::string& text, const std::string& part) {
  const auto same = [](char x, char y) {
    return std::tolower(static_cast<unsigned char>(x))
           == std::tolower(static_cast<unsigned char>(y));
  };
  return part.empty()
         || std::search(text.begin(), text.end(), part.begin(), part.end(),
                        same)
                != text.end();
}

table chosen(const table& all, const table_options& options) {
  auto rows = all.rows;
  if (!options.filter.empty())
    rows.erase(std::remove_if(
                   rows.begin(), rows.end(),
                   [&](const auto& x) { return !shows(x, options.filter); }),
               rows.end());
  if (!options.sort.empty()) {
    const bool from_the_end = options.sort.front() == '-';
    sort_rows(rows, index_of(all, options.sort.substr(from_the_end ? 1 : 0)),
              from_the_end);
  }
  table result;
  const auto order = chosen_columns(all, options);
  for (const auto i : order) {
    result.columns.push_back(all.columns[i]);
    result.columns.back().if_any = false;
    // What was asked for by name is not left out.
    if (!options.columns.empty())
      result.columns.back().rank = always_shown;
  }
  for (const auto& row : rows) {
    auto& to = result.rows.emplace_back();
    for (const auto i : order)
      to.push_back(cell_at(row, i));
  }
  return result;
}

} // namespace roscell::cli
