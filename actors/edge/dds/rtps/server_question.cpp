#include "actors/edge/dds/rtps/server_question.hpp"

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/io/io_core.hpp"
#include "actors/edge/reach/udp_question.hpp"

#include <utility>
#include <vector>

namespace roscell {

namespace {

using prefixes = std::shared_ptr<std::vector<guid_prefix>>;

std::vector<std::vector<std::uint8_t>> farewells(const prefixes& asked) {
  std::vector<std::vector<std::uint8_t>> result;
  for (const auto& prefix : *asked)
    result.push_back(probe_farewell(prefix));
  return result;
}

udp_question question_for(const sockaddr_in& server) {
  udp_question result;
  result.to = server;
  const auto asked = std::make_shared<std::vector<guid_prefix>>();
  // Another asker each time: a server answers each one once.
  result.ask = [asked](const sockaddr_in& own) {
    asked->push_back(make_probe_prefix());
    return probe_question(asked->back(), own);
  };
  result.judge =
      [server](const std::uint8_t* datagram, std::size_t size,
               const sockaddr_in& from) -> std::optional<port_answer> {
    const auto prefix = probe_answer(datagram, size);
    if (!prefix || from.sin_addr.s_addr != server.sin_addr.s_addr)
      return std::nullopt;
    return server_id_of(*prefix) ? port_answer::found
                                 : port_answer::unauthenticated_peer;
  };
  result.farewell = [asked] { return farewells(asked); };
  return result;
}

} // namespace

void ask_discovery_port(const std::shared_ptr<io_core>& core,
                        const std::string& local_address,
                        const socket_address& server,
                        std::chrono::milliseconds limit,
                        std::function<void(udp_answer)> done) {
  const auto to = to_socket_address(server.address, server.port);
  if (!to)
    return core->post([done = std::move(done)] {
      done({port_answer::unreachable, -1});
    });
  auto what = question_for(*to);
  what.local_address = local_address;
  what.limit = limit;
  ask_udp(core, std::move(what), std::move(done));
}

} // namespace roscell
