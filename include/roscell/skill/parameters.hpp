#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace roscell::engine {

/// The parameters of a model with the step's overrides applied. Every getter
/// returns `fallback` when the parameter is absent, and throws start_error
/// when it has another type or is out of its range (bounds included). Unknown
/// parameters are not an error: they belong to another part of the skill.
///
/// They never change. All members may be called from any thread; copies are
/// cheap and share what they hold.
class parameters {
public:
  /// None at all.
  parameters();

  /// Reads a JSON object. Throws start_error when `text` is none.
  static parameters parse(std::string_view text);

  bool has(const std::string& name) const;

  bool flag(const std::string& name, bool fallback) const;

  std::uint64_t count(const std::string& name, std::uint64_t fallback,
                      std::uint64_t least, std::uint64_t most) const;

  double number(const std::string& name, double fallback, double least,
                double most) const;

  std::string text(const std::string& name, const std::string& fallback) const;

  /// A list of at most `most_items` numbers.
  std::vector<double> numbers(const std::string& name,
                              const std::vector<double>& fallback,
                              std::size_t most_items) const;

  /// A list of at most `most_items` texts.
  std::vector<std::string> texts(const std::string& name,
                                 const std::vector<std::string>& fallback,
                                 std::size_t most_items) const;

  /// A parameter of any type as JSON text, for objects and lists of them, to
  /// be read with a library of the author's choice. Empty when it is absent.
  std::string json(const std::string& name) const;

  /// All of them, a JSON object.
  std::string all() const;

private:
  struct content;

  explicit parameters(std::shared_ptr<const content> values);

  std::shared_ptr<const content> content_;
};

} // namespace roscell::engine
