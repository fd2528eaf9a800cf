#include "actors/membership/discovery.hpp"

#include "actors/core/alarm.hpp"
#include "actors/core/edge_failure.hpp"
#include "actors/edge/io/socket_address.hpp"

#include <utility>

namespace roscell {

namespace {

std::string address_of(discovery_self self) {
  const auto& st = self->state;
  return st.config.address + ":" + std::to_string(st.server->port());
}

/// On the port that programs know; where that is taken, on another one, which
/// is better than none.
edge_result<std::unique_ptr<cell_server>> open_server(discovery_self self,
                                                      uint16_t known_port) {
  const auto& st = self->state;
  const auto remote = parse_socket_address(st.served.remote);
  if (!remote)
    return edge_error{error_code::schema_violation,
                      "'" + st.served.remote + "' is no address of a server",
                      ""};
  cell_server_options options;
  options.address = st.config.address;
  options.server_id = static_cast<uint8_t>(st.served.server_id);
  options.domain_id = static_cast<uint32_t>(st.served.domain_id);
  options.remote = remote_server{remote->address, remote->port,
                                 static_cast<uint8_t>(st.served.remote_id)};
  options.graph = st.config.graph;
  options.numbers = st.config.numbers;
  std::vector<uint16_t> ports{st.config.discovery_port, 0};
  if (known_port != 0)
    ports.insert(ports.begin(), known_port);
  for (const auto port : ports) {
    options.port = port;
    auto opened = cell_server::open(options);
    const auto* why = std::get_if<edge_error>(&opened);
    if (why == nullptr || why->code != error_code::conflict || port == 0)
      return opened;
  }
  return edge_error{error_code::internal, "no port was tried", ""};
}

/// Programs announce themselves within 4 s, stock ones within 3 s, and their
/// server tells of them at once: who is not told of by now is not there.
constexpr std::chrono::seconds doubt{10};

void begin_doubt(discovery_self self, const follow_server& request) {
  auto& st = self->state;
  st.met[static_cast<uint8_t>(request.server_id)] = ++st.meetings;
  if (request.tells_anew)
    send_lasting_actor_later(discovery_actor{self}, doubt,
                             follow_server{request.server_id,
                                           server_contact::settled, false,
                                           st.meetings});
}

/// Another meeting may have begun since the one that this is about. Without a
/// meeting it is about a server that has been lost for long.
void settle(discovery_self self, cell_server& own,
            const follow_server& request) {
  const auto id = static_cast<uint8_t>(request.server_id);
  const auto x = self->state.met.find(id);
  if (x == self->state.met.end()) {
    if (request.meeting == 0)
      own.forget(id);
  } else if (x->second == request.meeting) {
    own.end_doubt(id);
  }
}

/// Whether only the coordinator's server is another one, or elsewhere.
bool is_same_server(const discovery_place& x, const discovery_place& y) {
  return x.server_id == y.server_id && x.domain_id == y.domain_id;
}

void point_to_remote(discovery_self self) {
  const auto& place = self->state.served;
  if (const auto at = parse_socket_address(place.remote))
    self->state.server->set_remote(
        {at->address, at->port, static_cast<uint8_t>(place.remote_id)});
}

} // namespace

void follow_another_server(discovery_self self, const follow_server& request) {
  auto& st = self->state;
  auto* const own = st.config.cell ? st.config.cell : st.server.get();
  if (own == nullptr || request.server_id < 0 || request.server_id > UINT8_MAX)
    return;
  const auto id = static_cast<uint8_t>(request.server_id);
  switch (request.contact) {
  case server_contact::met:
    own->meet(id);
    return begin_doubt(self, request);
  case server_contact::settled:
    return settle(self, *own, request);
  case server_contact::lost:
    st.met.erase(id);
    return own->lose(id);
  case server_contact::gone:
    st.met.erase(id);
    return own->forget(id);
  }
}

caf::result<programs_served>
serve_programs_of_node(discovery_self self, const serve_programs& request) {
  auto& st = self->state;
  const bool is_same = st.server && is_same_server(st.served, request.place);
  st.served = request.place;
  if (is_same) {
    point_to_remote(self);
  } else {
    st.server.reset();
    auto opened = open_server(self, request.port);
    if (auto* why = std::get_if<edge_error>(&opened))
      return to_caf(*why);
    st.server = std::get<std::unique_ptr<cell_server>>(std::move(opened));
  }
  follow_another_server(self, {request.place.remote_id,
                               request.remote_is_there ? server_contact::met
                                                       : server_contact::lost,
                               request.tells_anew});
  return programs_served{address_of(self)};
}

} // namespace roscell
