#pragma once

#include <array>
#include <chrono>
#include <cstdint>

/// INTERNAL to actors/edge/dds.
namespace roscell {

/// When a discovery server may introduce itself to another one again.
///
/// With each server that it gets to know Fast DDS 2.9.1 introduces itself anew
/// to all, one by one, before it looks at the next one
/// (`DiscoveryDataBase::match_new_server_`): where a whole cell joins at one
/// moment that is the square of its members. So each pause is twice as long as
/// the one before, until there was nothing to say for the longest one. What was
/// not said is not lost: HEARTBEATs follow, and who misses something asks for
/// it. Pure: it is told the time.
class introduction_pacing {
public:
  using time_point = std::chrono::steady_clock::time_point;

  static constexpr std::chrono::milliseconds first_pause{70};
  static constexpr std::chrono::milliseconds longest_pause{2000};

  /// Whether server `id` is to hear it now.
  bool ask(std::uint8_t id, time_point now);

  /// It begins anew with this server.
  void forget(std::uint8_t id);

private:
  struct pace {
    time_point next = time_point::min();
    std::chrono::milliseconds pause = first_pause;
  };

  std::array<pace, 256> paces_;
};

} // namespace roscell
