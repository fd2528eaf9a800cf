#include "tools/roscell/view/table/choice.hpp"

#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <numeric>
#include <utility>

namespace roscell::cli {

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
  for (size_t i = 0; i < all.columns.size(); ++i)
    if (plain_name(all.columns[i].name) == plain_name(name))
      return i;
  std::vector<std::string> names;
  for (const auto& x : all.columns)
    names.push_back(x.name);
  throw command_error{exit_usage, "there is no column '" + name + "'",
                      "the columns are " + joined(names, ", ")};
}

std::vector<size_t> chosen_columns(const table& all,
                                   const table_options& options) {
  std::vector<size_t> result;
  for (const auto& name : options.columns)
    result.push_back(index_of(all, name));
  if (!result.empty())
    return result;
  for (size_t i = 0; i < all.columns.size(); ++i)
    if (options.wide || all.columns[i].rank < only_wide)
      result.push_back(i);
  return result;
}

std::string cell(const std::vector<std::string>& row, size_t i) {
  return i < row.size() ? row[i] : std::string{};
}

/// Numbers before words, and nothing behind both.
bool is_less(const std::string& x, const std::string& y) {
  if (x.empty() || y.empty())
    return !x.empty();
  const auto a = cell_value(x);
  const auto b = cell_value(y);
  if (a && b)
    return *a < *b;
  return a || b ? a.has_value() : x < y;
}

void sort_rows(std::vector<std::vector<std::string>>& rows, size_t by,
               bool from_the_end) {
  std::stable_sort(rows.begin(), rows.end(), [&](const auto& x, const auto& y) {
    const auto a = cell(x, by);
    const auto b = cell(y, by);
    // What is not known stays behind, whatever the direction.
    return from_the_end && !a.empty() && !b.empty() ? is_less(b, a)
                                                    : is_less(a, b);
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

table chosen(const table& all, const table_options& options) {
  auto rows = all.rows;
  if (!options.sort.empty()) {
    const bool from_the_end = options.sort.front() == '-';
    sort_rows(rows, index_of(all, options.sort.substr(from_the_end ? 1 : 0)),
              from_the_end);
  }
  table result;
  const auto order = chosen_columns(all, options);
  for (const auto i : order) {
    result.columns.push_back(all.columns[i]);
    // What was asked for by name is not left out.
    if (!options.columns.empty())
      result.columns.back().rank = always_shown;
  }
  for (const auto& row : rows) {
    auto& to = result.rows.emplace_back();
    for (const auto i : order)
      to.push_back(cell(row, i));
  }
  return result;
}

} // namespace roscell::cli
