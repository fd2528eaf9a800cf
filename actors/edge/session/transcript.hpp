#pragma once

#include "actors/edge/io/crypto.hpp"

#include <cstdint>
#include <string>
#include <string_view>

/// INTERNAL to this folder.
namespace roscell {

/// What a proof is about: a label that says what kind of proof it is, and a
/// list of texts. Each has its length before it, so that no two lists have the
/// same bytes.
class transcript {
public:
  explicit transcript(std::string_view label);

  transcript& add(std::string_view text);
  transcript& add(int64_t number);

  /// HMAC-SHA256 under `key`.
  digest sign(std::string_view key) const;

private:
  std::string bytes_;
};

/// Whether `proof` is `expected` in hexadecimal digits. The time taken tells
/// nothing about `expected`.
bool is_proof(std::string_view proof, const digest& expected);

} // namespace roscell
