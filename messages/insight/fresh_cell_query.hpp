#pragma once

#include "messages/codec/described.hpp"

namespace roscell {

/// As `cell_query`, after the nodes have been asked what they have and what is
/// in use: for somebody who looks. Reply: `cell_description`.
struct fresh_cell_query {
  static constexpr const char* type = "fresh_cell_query";

  static constexpr auto fields() {
    return field_list{};
  }
};

} // namespace roscell
