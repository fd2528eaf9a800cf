#pragma once

#include "messages/failure.hpp"
#include "messages/insight/reach.hpp"
#include "messages/node.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// Finding out why nobody answers at the address of a discovery server.
namespace roscell {

/// Asks for the IPv4 address of a host.
struct resolve_host {
  std::string host; ///< A name, or an address already.

  static constexpr auto fields() {
    return field_list{required("host", &resolve_host::host)};
  }
};

struct host_resolved {
  std::string address; ///< In numbers.

  static constexpr auto fields() {
    return field_list{required("address", &host_resolved::address)};
  }
};

/// Asks who is at an address where a discovery server should be.
struct probe_server {
  std::string address; ///< IPv4, in numbers.
  uint16_t port = 0;   ///< UDP of the discovery server.

  static constexpr auto fields() {
    return field_list{required("address", &probe_server::address),
                      required("port", &probe_server::port)};
  }
};

/// A TCP port, and who is behind it.
struct probed_port {
  uint16_t port = 0;
  port_answer answer = port_answer::silent;
  std::vector<node_hello> hello; ///< One if `found`. A hint: nothing is proved.

  static constexpr auto fields() {
    return field_list{required("port", &probed_port::port),
                      required("answer", &probed_port::answer),
                      required("hello", &probed_port::hello)};
  }
};

struct server_probed {
  port_answer discovery = port_answer::silent; ///< Of the UDP port.
  std::vector<probed_port> tcp; ///< The same number, then the usual HTTP port.

  static constexpr auto fields() {
    return field_list{required("discovery", &server_probed::discovery),
                      required("tcp", &server_probed::tcp)};
  }
};

/// INTERNAL to the join diagnoser: what came of a question.
struct diagnosis_settled {
  uint64_t question = 0;
  std::string address;  ///< Of a host, if one was asked for.
  server_probed probed; ///< Else this.
  failure problem;      ///< Why the host has no address, if it has none.

  static constexpr auto fields() {
    return field_list{required("question", &diagnosis_settled::question),
                      required("address", &diagnosis_settled::address),
                      required("scouted", &diagnosis_settled::probed),
                      required("problem", &diagnosis_settled::problem)};
  }
};

} // namespace roscell
