#include "actors/edge/reach/reach_tries.hpp"

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/reach/reach_port.hpp"
#include "actors/edge/reach/udp_question.hpp"
#include "actors/edge/session/address_probe.hpp"
#include "actors/edge/session/limits.hpp"

#include <chrono>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>

namespace roscell {

namespace {

constexpr auto limit = limits::membership::probed_port;

/// Eleven fragments on Ethernet, as of a small image.
constexpr std::size_t large_datagram = 16 * 1024;

/// What is gathered. Io thread only.
struct reach_draft {
  std::vector<reach_row> rows;
  size_t open = 0;
  std::function<void(std::vector<reach_row>)> done;

  void settle(size_t row, const udp_answer& x) {
    rows[row].answer = x.answer;
    rows[row].round_trip_ms = x.round_trip_ms;
    if (--open == 0)
      done(std::move(rows));
  }
};

/// One try, and where its outcome goes.
struct reach_try {
  const reach_setup& setup;
  std::shared_ptr<reach_draft> draft;
  size_t row;
  socket_address to;
  std::string host; ///< Who is to answer.

  std::function<void(udp_answer)> settles() const {
    return [draft = draft, row = row](const udp_answer& x) {
      draft->settle(row, x);
    };
  }
};

void try_session(const reach_try& x) {
  using clock = std::chrono::steady_clock;
  ask_for_hello(
      x.setup.core, x.to, x.setup.identity,
      [settle = x.settles(), begin = clock::now()](const probed_port& found) {
        const std::chrono::duration<double, std::milli> span =
            clock::now() - begin;
        const bool came = found.answer == port_answer::found;
        settle({found.answer, came ? span.count() : -1});
      });
}

/// Of a host or a group.
std::optional<sockaddr_in> to_datagram_place(const socket_address& x) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(x.port);
  if (inet_pton(AF_INET, x.address.c_str(), &result.sin_addr) != 1)
    return std::nullopt;
  return result;
}

void try_datagram(const reach_try& x, std::size_t size) {
  const auto to = to_datagram_place(x.to);
  const auto host = to_datagram_place({x.host, x.to.port});
  if (!to || !host)
    return x.setup.core->post([settle = x.settles()] {
      settle({port_answer::unreachable, -1});
    });
  udp_question what;
  what.local_address = x.setup.address;
  what.to = *to;
  what.limit = limit;
  const auto nonce = make_reach_nonce();
  what.ask = [nonce, key = x.setup.key, size](const sockaddr_in&) {
    return reach_question(nonce, key, size);
  };
  // A group has many who answer.
  what.judge = [nonce, key = x.setup.key, at = host->sin_addr.s_addr](
                   const std::uint8_t* datagram, std::size_t length,
                   const sockaddr_in& from) -> std::optional<port_answer> {
    const std::string_view bytes{reinterpret_cast<const char*>(datagram),
                                 length};
    if (from.sin_addr.s_addr != at || !is_reach_answer(bytes, nonce, key))
      return std::nullopt;
    return port_answer::found;
  };
  ask_udp(x.setup.core, std::move(what), x.settles());
}

void begin_try(const reach_try& x, reach_way way) {
  if (way == reach_way::session)
    try_session(x);
  else if (way == reach_way::discovery)
    ask_discovery_port(x.setup.core, x.setup.address, x.to, limit, x.settles());
  else
    try_datagram(x,
                 way == reach_way::large ? large_datagram : reach_packet_size);
}

/// Where a goal is reached by a way; none where it cannot be.
std::optional<socket_address> place_of(const reach_goal& goal, reach_way way) {
  auto at = parse_socket_address(goal.address);
  if (way == reach_way::discovery)
    return parse_socket_address(goal.discovery_server);
  if (!at || way == reach_way::session || way == reach_way::heartbeat)
    return at;
  return socket_address{way == reach_way::multicast ? discovery_group
                                                    : at->address,
                        goal.data_port};
}

constexpr reach_way ways[] = {reach_way::session,   reach_way::heartbeat,
                              reach_way::discovery, reach_way::data,
                              reach_way::large,     reach_way::multicast};

void begin_tries(const reach_setup& setup, const std::vector<reach_goal>& goals,
                 const std::shared_ptr<reach_draft>& draft) {
  std::vector<reach_try> tries;
  for (const auto& goal : goals) {
    const auto host = parse_socket_address(goal.address);
    const auto name = host ? host->address : std::string{};
    const auto add = [&](reach_way way, const socket_address& at) {
      tries.push_back({setup, draft, draft->rows.size(), at, name});
      draft->rows.push_back({goal.node, way, at.port});
    };
    for (const auto way : ways)
      if (const auto at = place_of(goal, way))
        add(way, *at);
    const auto first = first_data_port_beside(goal.data_port);
    if (host && first != 0 && first != goal.data_port)
      add(reach_way::data, {name, first});
  }
  draft->open = tries.size();
  if (tries.empty())
    draft->done({});
  for (const auto& x : tries)
    begin_try(x, draft->rows[x.row].way);
}

} // namespace

void try_to_reach(const reach_setup& setup,
                  const std::vector<reach_goal>& goals,
                  std::function<void(std::vector<reach_row>)> done) {
  const auto draft = std::make_shared<reach_draft>();
  draft->done = std::move(done);
  setup.core->post([setup, goals, draft] { begin_tries(setup, goals, draft); });
}

} // namespace roscell
