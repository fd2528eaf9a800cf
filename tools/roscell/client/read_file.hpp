#pragma once

#include <cstddef>
#include <string>

namespace roscell::cli {

/// A node takes far less; larger ones are refused there with a better error.
constexpr size_t max_document_bytes = 256UL * 1024 * 1024;

/// The bytes of a file, or of standard input for "-". Throws command_error if
/// it cannot be read, or is larger.
std::string read_file(const std::string& name,
                      size_t max_bytes = max_document_bytes);

} // namespace roscell::cli
