#pragma once

#include "actors/edge/dds/dds_thread.hpp"
#include "actors/edge/dds/lives/discovery_guard.hpp"

#include <fastdds/rtps/transport/TransportDescriptorInterface.h>

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

/// INTERNAL to this folder: how a participant of Fast DDS gets its datagrams.
/// `datagram_inlet` owns the sockets on which it hears; `discovery_transport`
/// makes the transport of Fast DDS that uses one, and lets only those datagrams
/// pass that Fast DDS reads safely.
namespace roscell {

struct inlet_options {
  std::string address;          ///< IPv4, of this host.
  bool at_loopback = false;     ///< At 127.0.0.1, too, on the same ports.
  std::size_t max_bytes = 0;    ///< Of one datagram; longer ones are dropped.
  std::size_t buffer_bytes = 0; ///< Wanted of the kernel; 0: what it gives.
};

/// The sockets on which one participant hears, all on the DDS thread.
class datagram_inlet {
public:
  using on_datagram = dds_thread::on_datagram;

  explicit datagram_inlet(inlet_options options);

  /// Hears what is sent to a port: `hear` at the own address, `hear_loopback`
  /// at 127.0.0.1. Both are open afterwards, or none: false.
  bool open(std::uint16_t port, on_datagram hear, on_datagram hear_loopback);

  /// Hears what comes over the own address's interface for a group, whose port
  /// others of this host hear, too. Where there is no multicast it is open, and
  /// hears nothing.
  bool open_group(const std::string& group, std::uint16_t port,
                  on_datagram hear);

  bool is_open(std::uint16_t port) const;

  /// Nobody is called for this port any more when it returns. False: it was
  /// not open.
  bool close(std::uint16_t port);

private:
  using entry = dds_thread::entry;

  /// Null where that fails.
  std::unique_ptr<entry> listen(udp_socket socket, on_datagram hear);
  std::unique_ptr<entry> listen_at(const std::string& address,
                                   std::uint16_t port, on_datagram hear);

  const inlet_options options_;
  const std::shared_ptr<dds_thread> thread_;
  mutable std::mutex mutex_; // Guards what follows.
  std::map<std::uint16_t, std::vector<std::unique_ptr<entry>>> ports_;
};

struct discovery_transport_options {
  std::string address;                   ///< IPv4, of this host.
  std::uint32_t max_sent_bytes = 0;      ///< In one datagram.
  std::uint32_t max_heard_bytes = 0;     ///< Longer ones are dropped.
  std::uint32_t socket_buffer_bytes = 0; ///< Wanted; 0: the kernel's own.
  bool serves_programs = false; ///< Hears those of this host at 127.0.0.1.
  std::shared_ptr<discovery_guard> guard; ///< A server's; others have none.
};

/// UDP over IPv4 on one local address only, no shared memory. Fast DDS sends as
/// it always does. It hears on the DDS thread (dds_thread.hpp), and sees only
/// the datagrams that are safe for it (discovery_filter.cpp). A discovery
/// server's guard has a look at them, too (lives/discovery_guard.hpp).
std::shared_ptr<eprosima::fastdds::rtps::TransportDescriptorInterface>
discovery_transport(discovery_transport_options options);

} // namespace roscell
