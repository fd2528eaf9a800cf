#pragma once

#include "actors/edge/io/io_thread.hpp"
#include "actors/house/house.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <cstdint>
#include <map>
#include <string>

namespace roscell {

struct join_scout_config {
  io_thread* io = nullptr;
  std::string address; ///< Local IPv4 address.
};

struct join_scout_state {
  static constexpr const char* name = "join-scout";

  join_scout_config config;
  uint64_t last_question = 0;
  std::map<uint64_t, caf::typed_response_promise<host_resolved>> names;
  std::map<uint64_t, caf::typed_response_promise<address_scouted>> addresses;
};

/// The JOIN SCOUT. Messages: messages/inside/scouting.hpp.
join_scout_actor::behavior_type
join_scout(join_scout_actor::stateful_pointer<join_scout_state> self,
           const join_scout_config& config);

} // namespace roscell
