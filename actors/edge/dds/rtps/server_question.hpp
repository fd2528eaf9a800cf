#pragma once

#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/reach/udp_question.hpp"

#include <chrono>
#include <functional>
#include <memory>
#include <string>

namespace roscell {

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
