#pragma once

#include <optional>
#include <string>
#include <string_view>

/// What one who has a secret keeps with others who do not have it.
namespace roscell {

/// AES-256 in Galois/Counter Mode (NIST SP 800-38D) under a key that
/// HMAC-SHA256 makes of the secret. Sealed twice it is two different texts, in
/// bytes.
std::string seal_text(std::string_view secret, std::string_view text);

/// None: it was not sealed under that secret, or has been altered. The reader
/// of outside bytes.
std::optional<std::string> open_sealed(std::string_view secret,
                                       std::string_view sealed);

} // namespace roscell
