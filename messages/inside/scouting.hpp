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
struct scout_address {
  std::string address; ///< IPv4, in numbers.
  uint16_t port = 0;   ///< UDP of the discovery server.

  static constexpr auto fields() {
    return field_list{required("address", &scout_address::address),
                      required("port", &scout_address::port)};
  }
};

/// A TCP port, and who is behind it.
struct scouted_port {
  uint16_t port = 0;
  port_answer answer = port_answer::silent;
  std::vector<node_hello> hello; ///< One if `found`. A hint: nothing is proved.

  static constexpr auto fields() {
    return field_list{required("port", &scouted_port::port),
                      required("answer", &scouted_port::answer),
                      required("hello", &scouted_port::hello)};
  }
};

struct address_scouted {
  port_answer discovery = port_answer::silent; ///< Of the UDP port.
  std::vector<scouted_port> tcp; ///< The same number, then the usual HTTP port.

  static constexpr auto fields() {
    return field_list{required("discovery", &address_scouted::discovery),
                      required("tcp", &address_scouted::tcp)};
  }
};

/// INTERNAL to the join scout: what came of a question.
struct scout_settled {
  uint64_t question = 0;
  std::string address;     ///< Of a host, if one was asked for.
  address_scouted scouted; ///< Else this.
  failure problem;         ///< Why the host has no address, if it has none.

  static constexpr auto fields() {
    return field_list{required("question", &scout_settled::question),
                      required("address", &scout_settled::address),
                      required("scouted", &scout_settled::scouted),
                      required("problem", &scout_settled::problem)};
  }
};

} // namespace roscell
