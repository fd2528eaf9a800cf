#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

/// The few cryptographic helpers of sessions, heartbeats and tokens.
/// All of them may be called from any thread.
namespace roscell {

/// A SHA-256 sized value: a digest or a key.
using digest = std::array<uint8_t, 32>;

/// HMAC-SHA256 (RFC 2104). Throws std::runtime_error if libcrypto fails.
digest hmac_sha256(std::string_view key, std::string_view text);

/// SHA-256 of what is added bit by bit.
class sha256_sum {
public:
  sha256_sum();
  ~sha256_sum();

  sha256_sum(const sha256_sum&) = delete;
  sha256_sum& operator=(const sha256_sum&) = delete;

  void add(std::string_view bytes);

  /// Adds a text so that no other sequence of texts gives the same bytes.
  void add_text(std::string_view text);

  /// In hexadecimal; nothing may be added after it.
  std::string hex();

private:
  struct context;
  std::unique_ptr<context> context_;
};

/// SHA-256 of one text, in hexadecimal.
std::string sha256_hex(std::string_view bytes);

/// The bytes of a digest as a view, e.g. to use it as a key.
std::string_view as_bytes(const digest& value);

/// `size` bytes from the system's generator. Throws std::runtime_error if
/// it has none: a predictable nonce must never be used in its place.
std::string random_bytes(size_t size);

/// Lower-case hexadecimal form.
std::string to_hex(std::string_view bytes);
std::string to_hex(const digest& value);

/// The bytes of a hexadecimal text, of either case. Nothing if the text has
/// another character or an odd length.
std::optional<std::string> from_hex(std::string_view text);

/// Whether the texts are equal. The time taken depends on their lengths only.
bool equal_in_constant_time(std::string_view a, std::string_view b);

} // namespace roscell
