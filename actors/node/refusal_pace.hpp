#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <string>

namespace roscell {

/// Which refusals are told of: one an address and second, of few addresses, so
/// that whoever knocks without end fills no log. Pure; told the time.
class refusal_pace {
public:
  using time_point = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::seconds pause{1};
  static constexpr size_t most_addresses = 64;

  /// How many there were from there since the last that was told of, this one
  /// counted; 0: it is not told of.
  size_t count(const std::string& address, time_point now);

private:
  struct entry {
    time_point reported;
    size_t since = 0;
  };

  void forget_old(time_point now);

  std::map<std::string, entry> entries_;
};

} // namespace roscell
