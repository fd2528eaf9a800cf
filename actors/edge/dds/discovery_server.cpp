#include "actors/edge/dds/discovery_server.hpp"

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/discovery_participant.hpp"
#include "actors/edge/dds/herald.hpp"
#include "actors/edge/dds/rtps/probe_responder.hpp"

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

/// A ROS 2 node may put all its endpoints into one datagram of full size.
constexpr std::uint32_t max_heard_bytes = 65500;

/// Eleven fragments in an Ethernet: of those of a full-sized one more get lost.
constexpr std::uint32_t max_sent_bytes = 16384;

participant_settings to_settings(const cell_server_options& options) {
  participant_settings result;
  result.address = options.address;
  result.announcement = options.announcement;
  result.lease = options.lease;
  result.announcement_period = options.announcement_period;
  result.max_heard_bytes = max_heard_bytes;
  result.max_sent_bytes = max_sent_bytes;
  result.serves_programs = true;
  return result;
}

/// The port that was chosen, or any, if it is free now.
edge_result<std::uint16_t> chosen_port(const cell_server_options& options) {
  auto bound = udp_socket::bind(options.address, options.port);
  if (auto* error = std::get_if<edge_error>(&bound))
    return *error;
  return ntohs(std::get<udp_socket>(bound).local().sin_port);
}

auto server_attributes(const cell_server_options& options, std::uint16_t port,
                       std::shared_ptr<discovery_guard> guard) {
  auto settings = to_settings(options);
  settings.guard = std::move(guard);
  auto result = make_attributes(settings, port);
  auto prefix = server_prefix(options.server_id);
  std::copy(prefix.begin(), prefix.end(), result.prefix.value);
  auto& discovery = result.builtin.discovery_config;
  discovery.discoveryProtocol = DiscoveryProtocol_t::SERVER;
  discovery.discoveryServer_client_syncperiod = {0, serve_repeat_period_ns};
  return result;
}

bool is_same(const remote_server& x, const remote_server& y) {
  return x.address == y.address && x.port == y.port && x.id == y.id;
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
    auto answers = udp_socket::bind(options.address, 0);
    if (std::holds_alternative<edge_error>(answers))
      return false;
    guard_ = std::make_shared<discovery_guard>(
        options.server_id,
        options.numbers ? options.numbers : std::make_shared<number_reserve>(),
        std::get<udp_socket>(std::move(answers)));
    graph_ = options.graph ? options.graph : std::make_shared<ros_graph>();
    if (options.remote && !prepare_for(*options.remote, options.address))
      return false;
    participant_ = rtps_participant::create(
        options.domain_id, server_attributes(options, port, guard_),
        [this](const sighting& seen) { on_client(seen); }, graph_);
    if (participant_ == nullptr
        || (introducer_ && !learn_announcement(options)))
      return false;
    guard_->speak(options.announcement);
    graph_->begin_service();
    serves_ = true;
    greeter_.start();
    return true;
  }

  std::uint16_t port() const {
    return port_;
  }

  const std::shared_ptr<ros_graph>& graph() const {
    return graph_;
  }

  void set_remote(const remote_server& remote) {
    const auto before = this->remote();
    if (!before || is_same(*before, remote))
      return;
    lose(before->id);
    guard_->lives().ignore(remote.id);
    std::lock_guard<std::mutex> lock{mutex_};
    remote_ = remote;
  }

  void meet(std::uint8_t id) {
    // What has been known from an earlier session would be taken for known, and
    // what is still on its way for a sign that this one is known to the other.
    auto& lives = guard_->lives();
    if (lives.is_met(id) || lives.has_spoken(id))
      lose(id);
    lives.meet(id, std::chrono::steady_clock::now());
    // The other one is deaf for as long as this one.
    if (is_remote(id))
      introduce(lives.has_been_lost(id) ? 2 * server_lives::settling
                                        : std::chrono::milliseconds{0});
  }

  void lose(std::uint8_t id) {
    if (is_remote(id))
      introducer_->rest();
    guard_->lose(id);
  }

  void end_doubt(std::uint8_t id) {
    guard_->end_doubt(id);
  }

  void forget(std::uint8_t id) {
    guard_->forget(id);
  }

  void update_announcement(const std::string& bytes) {
    if (participant_ == nullptr)
      return;
    guard_->speak(bytes);
    participant_->update_announcement(bytes);
  }

  void close() {
    greeter_.stop();
    participant_.reset();
    if (std::exchange(serves_, false))
      graph_->end_service();
    introducer_.reset();
  }

private:
  bool prepare_for(const remote_server& remote, const std::string& address) {
    auto socket = udp_socket::bind(address, 0);
    if (std::holds_alternative<edge_error>(socket))
      return false;
    remote_ = remote;
    guard_->lives().ignore(remote.id);
    introducer_ =
        std::make_unique<introducer>(std::get<udp_socket>(std::move(socket)));
    return true;
  }

  bool learn_announcement(const cell_server_options& options) {
    server_readiness own{*to_socket_address(options.address, port_),
                         [this] { participant_->announce(); }};
    auto introduction = own.wait(ready_limit);
    if (!introduction)
      return false;
    introducer_->set_announcement(*std::move(introduction));
    return true;
  }

  void introduce(std::chrono::milliseconds after) {
    const auto to = remote();
    if (const auto at = to_socket_address(to->address, to->port))
      introducer_->seek(*at, after);
  }

  std::optional<remote_server> remote() {
    std::lock_guard<std::mutex> lock{mutex_};
    return remote_;
  }

  bool is_remote(std::uint8_t id) {
    const auto x = remote();
    return x && x->id == id;
  }

  void on_client(const sighting& seen) {
    if (seen.name == probe_name)
      return;
    note(seen);
    count(seen);
    if (callback_)
      callback_(seen);
  }

  void note(const sighting& seen) {
    const auto id = server_lives::id_of(seen.prefix);
    const bool is_the_remote =
        is_remote(id) && seen.prefix == guard_->lives().present(id);
    if (is_end(seen.what)) {
      guard_->gone(seen.prefix);
      // The session goes on, or it would have been lost before.
      if (is_the_remote)
        introduce(introducer::first_pause);
      return;
    }
    guard_->appeared(seen.prefix);
    if (is_the_remote)
      introducer_->rest();
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
  bool serves_ = false;
  on_sighting callback_;
  std::mutex mutex_; // Guards what follows.
  std::set<guid_prefix> clients_;
  std::optional<remote_server> remote_;
  herald greeter_;
  std::shared_ptr<ros_graph> graph_;
  std::shared_ptr<discovery_guard> guard_;
  std::unique_ptr<introducer> introducer_; // Null: there is no remote server.
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

void cell_server::set_remote(const remote_server& remote) {
  impl_->set_remote(remote);
}

void cell_server::meet(std::uint8_t id) {
  impl_->meet(id);
}

void cell_server::lose(std::uint8_t id) {
  impl_->lose(id);
}

void cell_server::end_doubt(std::uint8_t id) {
  impl_->end_doubt(id);
}

void cell_server::forget(std::uint8_t id) {
  impl_->forget(id);
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
