#pragma once

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>

namespace roscell::engine {

/// The parameters of a model with the step's overrides applied. Every getter
/// returns `fallback` when the parameter is absent, and throws start_error
/// when it has another type or is out of its range (bounds included). Unknown
/// parameters are not an error: they belong to another part of the skill.
class parameters {
public:
  parameters();

  /// Throws start_error unless `values` is an object.
  explicit parameters(nlohmann::json values);

  bool flag(const std::string& name, bool fallback) const;

  std::uint64_t count(const std::string& name, std::uint64_t fallback,
                      std::uint64_t least, std::uint64_t most) const;

  double number(const std::string& name, double fallback, double least,
                double most) const;

  std::string text(const std::string& name, const std::string& fallback) const;

  /// For parameters that are lists or objects.
  const nlohmann::json& values() const noexcept {
    return values_;
  }

private:
  nlohmann::json values_;
};

} // namespace roscell::engine
