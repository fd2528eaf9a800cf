#pragma once

#include "messages/introspection.hpp"

#include <string>

namespace roscell {

/// Writes one record durably; an empty value removes it.
struct store_record {
  std::string table; ///< "instances", "tasks", "identity".
  std::string key;
  std::string value; ///< JSON text.

  static constexpr auto fields() {
    return std::make_tuple(required("table", &store_record::table),
                           required("key", &store_record::key),
                           required("value", &store_record::value));
  }
};

struct record_stored {
  static constexpr auto fields() {
    return std::make_tuple();
  }
};

/// The STATE STORE: the only actor that writes the node's database.
using state_store_actor = introspected_actor::extend<
    // Replies once the record is on disk. Errors: internal (disk full, ...).
    caf::replies_to<store_record>::with<record_stored>>;

} // namespace roscell
