#pragma once

#include "messages/codec/json_codec.hpp"
#include "schemas/validator.hpp"

#include <cstddef>
#include <string>
#include <vector>

/// What checks of documents share that go beyond what a schema can say.
namespace roscell::checks {

using pointer = json::json_pointer;
using error_list = std::vector<schema_error>;

/// A value and where it stands in the document.
struct place {
  const json& value;
  pointer at;

  /// Its member or null, which has no members in turn.
  place operator/(const char* name) const {
    static const json none;
    auto i = value.is_object() ? value.find(name) : value.end();
    auto found = value.is_object() && i != value.end();
    return {found ? *i : none, at / name};
  }

  std::vector<place> items() const {
    std::vector<place> result;
    if (value.is_array())
      for (size_t i = 0; i < value.size(); ++i)
        result.push_back({value[i], at / i});
    return result;
  }

  /// Its text; empty if it is no string.
  std::string text() const {
    return value.is_string() ? value.get<std::string>() : std::string{};
  }
};

/// Notes that something else was expected there; what is not there is said to
/// be missing.
void refuse(error_list& errors, const place& x, const std::string& expected);

void append(error_list& errors, const error_list& others);

/// Each item of a list is to have another value of a member.
void check_unique(error_list& errors, const place& list, const char* member,
                  const std::string& what);

/// Whether a path has a "..".
bool climbs(const std::string& path);

void check_absolute(error_list& errors, const place& x,
                    const std::string& what);

void check_devices(error_list& errors, const place& list);

/// A skill's descriptor as a member registers it.
void check_descriptor(error_list& errors, const place& skill);

/// As an author writes it. What a member registers has been looked at when it
/// read the file.
void check_written_descriptor(error_list& errors, const place& skill);

} // namespace roscell::checks
