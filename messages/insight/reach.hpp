#pragma once

#include "messages/codec/described.hpp"
#include "messages/codec/json_codec.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

/// Finding out which packets of one node reach another, and what comes back.
namespace roscell {

/// Opens a UDP port among those of DDS's data, for a minute, that answers the
/// probes of other nodes. Repeating it prolongs that.
struct reach_opening {
  static constexpr const char* type = "reach_opening";
  std::string node; ///< Where; empty: the one that is asked.

  static constexpr auto fields() {
    return field_list{optional("node", &reach_opening::node)};
  }
};

struct reach_opened {
  static constexpr const char* type = "reach_opened";
  std::string node;
  std::string version;          ///< Of the program.
  std::string address;          ///< "ip:port" of HTTP and heartbeats.
  std::string discovery_server; ///< "ip:port"; empty: it runs none now.
  uint16_t data_port = 0;       ///< UDP, of this answer.
  int64_t clock_unix_us = 0;    ///< The node's, when it answered.

  static constexpr auto fields() {
    return field_list{
        required("node", &reach_opened::node),
        required("version", &reach_opened::version),
        required("address", &reach_opened::address),
        optional("discovery_server", &reach_opened::discovery_server),
        required("data_port", &reach_opened::data_port),
        required("clock_unix_us", &reach_opened::clock_unix_us)};
  }
};

/// A node that is to be reached: what its `reach_opened` says.
struct reach_goal {
  std::string node;
  std::string address;
  std::string discovery_server;
  uint16_t data_port = 0;

  static constexpr auto fields() {
    return field_list{
        required("node", &reach_goal::node),
        required("address", &reach_goal::address),
        optional("discovery_server", &reach_goal::discovery_server),
        required("data_port", &reach_goal::data_port)};
  }
};

/// Has a node try to reach others, by each way that it needs.
struct reach_query {
  static constexpr const char* type = "reach_query";
  std::string node; ///< Which one; empty: the one that is asked.
  std::vector<reach_goal> goals;

  static constexpr auto fields() {
    return field_list{optional("node", &reach_query::node),
                      required("goals", &reach_query::goals)};
  }
};

/// How one port answers.
enum class port_answer {
  silent,               ///< Not at all, in time.
  closed,               ///< The host says that nothing listens there.
  unreachable,          ///< The network says that there is no way to the host.
  unauthenticated_peer, ///< Something else than what was looked for.
  found,                ///< As it should.
};

constexpr auto enum_words(port_answer) {
  return std::array<std::string_view, 5>{"silent", "closed", "unreachable",
                                         "stranger", "found"};
}

/// By what one node reaches another.
enum class reach_way {
  session,   ///< TCP: sessions and HTTP.
  heartbeat, ///< UDP at the same port.
  discovery, ///< UDP of the discovery server.
  data,      ///< UDP of DDS's data.
  large,     ///< The same, by a datagram that has to be sent in fragments.
  multicast, ///< By which nodes find each other without an address.
};

constexpr auto enum_words(reach_way) {
  return std::array<std::string_view, 6>{"session", "beat",  "discovery",
                                         "data",    "large", "multicast"};
}

/// What came of one try.
struct reach_row {
  std::string node; ///< That was to be reached.
  reach_way way = reach_way::session;
  uint16_t port = 0;
  port_answer answer = port_answer::silent;
  double round_trip_ms = -1; ///< Negative: nothing came back.

  static constexpr auto fields() {
    return field_list{required("node", &reach_row::node),
                      required("way", &reach_row::way),
                      required("port", &reach_row::port),
                      required("answer", &reach_row::answer),
                      optional("round_trip_ms", &reach_row::round_trip_ms)};
  }
};

/// Reply to `reach_query`.
struct reach_report {
  static constexpr const char* type = "reach_report";
  std::string node; ///< That has tried.
  std::vector<reach_row> rows;

  static constexpr auto fields() {
    return field_list{required("node", &reach_report::node),
                      required("rows", &reach_report::rows)};
  }
};

/// INTERNAL to the reach prober: the tries of a question have ended.
struct reach_settled {
  uint64_t question = 0;
  std::vector<reach_row> rows;

  static constexpr auto fields() {
    return field_list{required("question", &reach_settled::question),
                      required("rows", &reach_settled::rows)};
  }
};

} // namespace roscell
