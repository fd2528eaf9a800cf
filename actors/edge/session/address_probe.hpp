#pragma once

#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "messages/inside/membership.hpp"

#include <functional>
#include <memory>
#include <string>

namespace roscell {

class site_identity;

/// Looks who is at an address where a discovery server should be: asks its UDP
/// port, and by HTTP the TCP port of the same number and the one that nodes use
/// by default. All at once; `done` is called once, on the io thread, within
/// `limits::membership::probed`. From any thread.
void probe_address(const std::shared_ptr<io_core>& core,
                   const std::string& local_address,
                   const socket_address& server,
                   const std::shared_ptr<site_identity>& identity,
                   std::function<void(server_probed)> done);

/// Asks the HTTP server of a node who it is. `done` is called once, on the io
/// thread, within `limits::membership::probed_port`.
/// @param identity by which it asks; null: in clear.
void ask_for_hello(const std::shared_ptr<io_core>& core,
                   const socket_address& node,
                   const std::shared_ptr<site_identity>& identity,
                   std::function<void(probed_port)> done);

} // namespace roscell
