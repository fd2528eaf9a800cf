#pragma once

#include "messages/introspection.hpp"

#include <string>
#include <vector>

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

/// Writes several records in one transaction: all of them or none. The last
/// one of a key counts.
struct store_records {
  std::vector<store_record> records;

  static constexpr auto fields() {
    return std::make_tuple(required("records", &store_records::records));
  }
};

struct record_stored {
  static constexpr auto fields() {
    return std::make_tuple();
  }
};

} // namespace roscell
