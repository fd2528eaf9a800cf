#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// What a column of a list is, whoever shows it.
namespace roscell {

/// How a text looks, by what it means: a terminal has colours for it, a page a
/// style, a screen without colours neither.
enum class look {
  plain,
  strong,
  faint,
  heading,
  good,
  busy,
  bad,
  others,   ///< Of a bar: used by other programs.
  reserved, ///< Of a bar: reserved by instances.
};

enum class align { left, right };

/// What a column may lose where there is too little room.
constexpr int always_shown = 0;
/// Shown where there is room for all, or when it is named, only.
constexpr int only_wide = 100;

struct column {
  std::string name;
  align side = align::left;
  /// The columns of the highest number are shortened and left out first.
  int rank = always_shown;
  bool whole = false;  ///< A part of it says nothing: it is not shortened.
  bool if_any = false; ///< There only if something stands in it.
};

/// Of a resource of a node, in its own unit.
struct usage_share {
  double others = 0;   ///< Used by programs that are none of ours.
  double reserved = 0; ///< By instances.
  double capacity = 0; ///< 0: not known.
};

/// What stands in one column of a row: foreign text as it came.
struct column_value {
  std::string text;
  look how = look::plain; ///< Plain: that of the state word that it is.
  std::optional<usage_share> usage; ///< Of which a bar can be drawn.

  column_value() = default;
  column_value(std::string x, look as = look::plain)
      : text{std::move(x)}, how{as} {}
  column_value(const char* x) : text{x} {}
};

/// A column, and where its value comes from.
template <class Row>
struct described_column {
  column what;
  /// Ages are counted to `now_unix_ms`.
  column_value (*of)(const Row& row, int64_t now_unix_ms);
  /// How the dashboard says it, a word of tools/dashboard/pages/columns.js;
  /// empty: it does not show it.
  const char* said_as = "";
  const char* path = ""; ///< Of what it is read from, in the JSON of a row.
};

template <class Row>
using column_list = std::vector<described_column<Row>>;

} // namespace roscell
