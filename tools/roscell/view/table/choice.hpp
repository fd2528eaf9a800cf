#pragma once

#include "tools/roscell/view/table.hpp"

#include <optional>
#include <string_view>

/// INTERNAL to tables: which columns and rows are shown, in which order.
namespace roscell::cli {

/// The columns that the options choose, and the rows in the order that they
/// request. Throws command_error for a column that there is not.
table chosen(const table& all, const table_options& options);

/// The value of a cell that begins with a number: "12", "-1.5", "0.8/3.8 GiB"
/// (in bytes), "3m05s" (in seconds), "29.9 Hz". Nothing for any other text.
std::optional<double> cell_value(std::string_view text);

} // namespace roscell::cli
