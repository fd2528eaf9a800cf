#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/edge/session/site_token.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <cstdint>
#include <map>
#include <string>

namespace roscell {

struct join_diagnoser_config {
  io_thread* io = nullptr;
  std::string address; ///< Local IPv4 address.
  site_secret site;
};

struct join_diagnoser_state {
  static constexpr const char* name = "join-diagnoser";

  join_diagnoser_config config;
  uint64_t last_question = 0;
  std::map<uint64_t, caf::typed_response_promise<host_resolved>> names;
  std::map<uint64_t, caf::typed_response_promise<server_probed>> addresses;
};

/// The JOIN DIAGNOSER: helps to find out why a cell cannot be joined. It
/// resolves the coordinator's host name and probes its address, and owns the
/// questions of both kinds that are open. What it finds, failures too, is an
/// answer. Messages: resolve_host and probe_server, in
/// messages/inside/membership.hpp.
join_diagnoser_actor::behavior_type join_diagnoser(
    join_diagnoser_actor::stateful_pointer<join_diagnoser_state> self,
    const join_diagnoser_config& config);

} // namespace roscell
