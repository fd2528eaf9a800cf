#pragma once

#include "messages/codec/json_codec.hpp"

#include <string>

namespace roscell::test {

/// What valijson, another implementation of Draft 7, thinks of a document.
bool oracle_accepts(const std::string& schema, const json& document);

/// The same of a schema that refers to no other one.
bool oracle_accepts(const json& schema, const json& document);

} // namespace roscell::test
