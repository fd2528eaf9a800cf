#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/edge/reach/reach_port.hpp"
#include "actors/edge/session/site_token.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace roscell {

struct reach_prober_config {
  io_thread* io = nullptr;
  std::string node;
  std::string address;          ///< Local IPv4 address.
  std::string http_address;     ///< "ip:port"
  std::string discovery_server; ///< "ip:port"; empty: ask the membership.
  membership_actor membership;  ///< Invalid on a coordination node.
  unsigned domain_id = 0;       ///< Of a node that is in no cell of others.
  site_secret site;
};

/// How long the ports stay open after it was asked for.
constexpr std::chrono::seconds reach_port_life{60};

struct reach_prober_state {
  static constexpr const char* name = "reach-prober";

  reach_prober_config config;
  std::unique_ptr<reach_port> port; ///< Null most of the time.
  unsigned port_domain = 0;         ///< Whose ports it has.
  alarm closing;
  uint64_t last_question = 0;
  std::map<uint64_t, caf::typed_response_promise<reach_report>> questions;
};

/// The REACH PROBER. Messages: messages/insight/reach.hpp.
reach_prober_actor::behavior_type
reach_prober(reach_prober_actor::stateful_pointer<reach_prober_state> self,
             const reach_prober_config& config);

} // namespace roscell
