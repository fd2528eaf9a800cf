#include "actors/edge/dds/discovery_server.hpp"

#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/discovery_participant.hpp"
#include "actors/edge/dds/herald.hpp"
#include "actors/edge/dds/rtps/server_readiness.hpp"

#include <algorithm>
#include <mutex>
#include <set>
#include <utility>

namespace roscell {

namespace {

using eprosima::fastrtps::rtps::DiscoveryProtocol_t;

/// Until Fast DDS's own thread has entered a new client into its database; an
/// announcement before that would not reach the client.
constexpr std::chrono::milliseconds greeting_delay{2};

/// How often the server repeats what a client has not acknowledged. Shorter
/// than Fast DDS's 450 ms because a ROS 2 node's start waits for it.
constexpr std::int32_t serve_repeat_period_ns = 20'000'000;

/// Until Fast DDS knows its own server; some milliseconds, but for a machine
/// that has no time at all.
constexpr std::chrono::seconds ready_limit{10};

/// What a server says of itself until it is told of its remote. Fast DDS does
/// not replace data by the same once more, but keeps both, and looks every 20
/// ms whether the one that it dropped has been acknowledged.
constexpr const char* unready_announcement = "-";

/// A ROS 2 node may put all its endpoints into one datagram of full size.
constexpr std::uint32_t max_server_message_bytes = 65500;

participant_settings to_settings(const cell_server_options& options) {
  participant_settings result;
  result.address = options.address;
  result.announcement = options.announcement;
  result.lease = options.lease;
  result.announcement_period = options.announcement_period;
  result.max_message_bytes = max_server_message_bytes;
  result.serves_programs = true;
  return result;
}

auto to_attributes(const remote_server& x) {
  eprosima::fastdds::rtps::RemoteServerAttributes remote;
  const auto prefix = server_prefix(x.id);
  std::copy(prefix.begin(), prefix.end(), remote.guidPrefix.value);
  remote.metatrafficUnicastLocatorList.push_back(
      udp_locator(x.address, x.port));
  return remote;
}

/// The port that was chosen, or any, if it is free now.
edge_result<std::uint16_t> chosen_port(const cell_server_options& options) {
  auto bound = udp_socket::bind(options.address, options.port);
  if (auto* error = std::get_if<edge_error>(&bound))
    return *error;
  return ntohs(std::get<udp_socket>(bound).local().sin_port);
}

auto server_attributes(const cell_server_options& options, std::uint16_t port,
                       std::shared_ptr<route_gate> route) {
  auto settings = to_settings(options);
  settings.route = std::move(route);
  if (options.remote)
    settings.announcement = unready_announcement;
  auto result = make_attributes(settings, port);
  auto prefix = server_prefix(options.server_id);
  std::copy(prefix.begin(), prefix.end(), result.prefix.value);
  auto& discovery = result.builtin.discovery_config;
  discovery.discoveryProtocol = DiscoveryProtocol_t::SERVER;
  discovery.discoveryServer_client_syncperiod = {0, serve_repeat_period_ns};
  return result;
}

bool is_end(sighting::kind what) {
  return what == sighting::kind::left || what == sighting::kind::lost;
}

} // namespace

class cell_server::impl {
public:
  explicit impl(on_sighting callback)
      : callback_(std::move(callback)),
        greeter_({greeting_delay}, greeting_interval,
                 [this] { participant_->announce(); }) {}

  ~impl() {
    close();
  }

  bool open(const cell_server_options& options, std::uint16_t port) {
    port_ = port;
    if (options.remote) {
      remote_ = server_prefix(options.remote->id);
      route_ = std::make_shared<route_gate>(options.remote->address,
                                            options.remote->port);
    }
    graph_ = options.graph ? options.graph : std::make_shared<ros_graph>();
    participant_ = rtps_participant::create(
        options.domain_id, server_attributes(options, port, route_),
        [this](const sighting& seen) { on_client(seen); }, graph_);
    if (participant_ == nullptr || (options.remote && !add_remote(options)))
      return false;
    greeter_.start();
    return true;
  }

  std::uint16_t port() const {
    return port_;
  }

  const std::shared_ptr<ros_graph>& graph() const {
    return graph_;
  }

  void reach_remote(bool is_there) {
    if (route_)
      route_->open(is_there);
  }

  void update_announcement(const std::string& bytes) {
    if (participant_ != nullptr)
      participant_->update_announcement(bytes);
  }

  void close() {
    greeter_.stop();
    participant_.reset();
  }

private:
  bool add_remote(const cell_server_options& options) {
    server_readiness own{*to_socket_address(options.address, port_),
                         [this] { participant_->announce(); }};
    if (!own.wait(ready_limit))
      return false;
    participant_->add_remote(to_attributes(*options.remote),
                             options.announcement);
    return true;
  }

  void on_client(const sighting& seen) {
    if (seen.name == probe_name)
      return;
    if (route_ && seen.prefix == remote_ && is_end(seen.what))
      route_->open(false);
    count(seen);
    if (callback_)
      callback_(seen);
  }

  void count(const sighting& seen) {
    std::lock_guard<std::mutex> lock{mutex_};
    if (is_end(seen.what))
      clients_.erase(seen.prefix);
    else if (clients_.insert(seen.prefix).second
             && clients_.size() <= max_greeted_clients)
      greeter_.ask();
  }

  std::uint16_t port_ = 0;
  on_sighting callback_;
  std::mutex mutex_; // Guards what follows.
  std::set<guid_prefix> clients_;
  herald greeter_;
  std::shared_ptr<ros_graph> graph_;
  std::shared_ptr<route_gate> route_; // Null: there is no remote server.
  guid_prefix remote_{};
  std::unique_ptr<rtps_participant> participant_;
};

cell_server::cell_server(std::unique_ptr<impl> x) : impl_(std::move(x)) {}

edge_result<std::unique_ptr<cell_server>>
cell_server::open(const cell_server_options& options, on_sighting on_client) {
  if (auto error = check_settings(options.domain_id, to_settings(options)))
    return *std::move(error);
  // Somebody else can take the port that was free a moment ago.
  constexpr int attempts = 3;
  for (int i = 0; i < attempts; ++i) {
    auto port = chosen_port(options);
    if (auto* error = std::get_if<edge_error>(&port))
      return *error;
    auto x = std::make_unique<impl>(on_client);
    if (x->open(options, std::get<std::uint16_t>(port)))
      return std::unique_ptr<cell_server>{new cell_server(std::move(x))};
  }
  return edge_error{error_code::internal,
                    "Fast DDS does not start a discovery server on "
                        + options.address,
                    "its own log says why"};
}

cell_server::~cell_server() = default;

std::uint16_t cell_server::port() const {
  return impl_->port();
}

const std::shared_ptr<ros_graph>& cell_server::graph() const {
  return impl_->graph();
}

void cell_server::reach_remote(bool is_there) {
  impl_->reach_remote(is_there);
}

std::optional<edge_error>
cell_server::update_announcement(const std::string& bytes) {
  if (auto error = check_announcement(bytes))
    return error;
  impl_->update_announcement(bytes);
  return std::nullopt;
}

void cell_server::close() {
  impl_->close();
}

} // namespace roscell
