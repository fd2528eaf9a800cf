#pragma once

#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "messages/insight/reach.hpp"

#include <netinet/in.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// What is asked of a UDP port, and how its answer is told.
struct udp_question {
  std::string local_address; ///< Dotted; the answer comes to a port of it.
  sockaddr_in to{};          ///< May be a multicast group.
  std::chrono::milliseconds limit{0};
  /// The next datagram; an answer is to come to `own`.
  std::function<std::vector<std::uint8_t>(const sockaddr_in& own)> ask;
  /// What a datagram says; none: it is no answer.
  std::function<std::optional<port_answer>(
      const std::uint8_t* datagram, std::size_t size, const sockaddr_in& from)>
      judge;
  /// What is sent at the end; may be null.
  std::function<std::vector<std::vector<std::uint8_t>>()> farewell;
};

struct udp_answer {
  port_answer answer = port_answer::silent;
  double round_trip_ms = -1; ///< Since the last datagram; negative: none came.
};

/// Asks up to three times, since datagrams get lost. `done` is called once, on
/// the io thread, within the limit; not at all once the io thread has been told
/// to stop. From any thread.
void ask_udp(const std::shared_ptr<io_core>& core, udp_question what,
             std::function<void(udp_answer)> done);

/// Asks a UDP port, as discovery_probe.hpp says, whether a discovery server
/// listens there: `found`, or `unauthenticated_peer` if its GUID prefix is none
/// of the well-known ones. `done` is called once, on the io thread, within
/// `limit`; not at all once the io thread has been told to stop. From any
/// thread.
void ask_discovery_port(const std::shared_ptr<io_core>& core,
                        const std::string& local_address,
                        const socket_address& server,
                        std::chrono::milliseconds limit,
                        std::function<void(udp_answer)> done);

} // namespace roscell
