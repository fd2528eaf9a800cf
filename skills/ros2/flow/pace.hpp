#pragma once

#include "roscell/skill/stop_event.hpp"

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>

namespace roscell::ros2 {

/// How far apart the datagrams of a writer's large messages should leave. A
/// reliable reader asks for what it has lost; a best-effort one does not, and a
/// stock program has only the 208 KiB of a socket that nobody tuned. So while
/// such a reader is there, a message takes up to half the time until the next
/// one. Pure; told the time.
class writer_pace {
public:
  using clock = std::chrono::steady_clock;

  /// So many best-effort readers of stock programs there are now.
  void set_best_effort_readers(int count) {
    best_effort_readers_ = count;
  }

  /// A message of that size is about to leave. Returns the distance of its
  /// datagrams; 0: none but that of large messages in general.
  clock::duration next_gap(clock::time_point now, std::size_t bytes);

private:
  int best_effort_readers_ = 0;
  clock::time_point last_{};
  clock::duration interval_{}; ///< Between messages, smoothed.
};

/// Holds datagrams back, as the writers of a participant ask; for all of them
/// the shortest request counts, so that none falls behind. May be used by
/// several threads.
class datagram_pacer {
public:
  void set_gap(const void* writer, writer_pace::clock::duration gap);
  void forget(const void* writer);

  /// To be called before each datagram; returns at once for small ones.
  void wait_turn(std::size_t bytes);

private:
  void choose();

  std::mutex mutex_; // Guards the requests.
  std::map<const void*, writer_pace::clock::duration> gaps_;
  std::atomic<writer_pace::clock::duration> gap_{};
  writer_pace::clock::time_point due_{}; // Of Fast DDS's sending lock.
  const engine::stop_event never_;
};

// INTERNAL to this folder.

using transport_ptr =
    std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>;

/// Called for each port on which messages to this host alone are heard. It
/// must live as long as what the transport belongs to.
using port_handler = std::function<void(std::uint32_t port)>;

/// Lets the pacer decide when each datagram leaves by `lower`, and tells of the
/// ports that `lower` has opened: Fast DDS goes on without one where it finds
/// none that is free.
transport_ptr paced(transport_ptr lower, std::shared_ptr<datagram_pacer> pacer,
                    port_handler on_listening);

} // namespace roscell::ros2
