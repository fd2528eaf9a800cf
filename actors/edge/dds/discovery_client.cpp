#include "actors/edge/dds/discovery_client.hpp"

#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/discovery_participant.hpp"
#include "actors/edge/dds/discovery_seeker.hpp"
#include "actors/edge/host/interfaces.hpp"

#include <algorithm>
#include <atomic>
#include <thread>
#include <utility>

namespace roscell {

namespace {

using namespace std::chrono_literals;
namespace rtps = eprosima::fastrtps::rtps;

/// How often a CLIENT repeats itself until its server is found. The answer
/// normally comes within milliseconds; this is for a lost datagram.
constexpr std::int32_t join_repeat_period_ns = 100'000'000;

/// Where our participants start to look for a free port, counted as ROS 2
/// counts them on one host: ROS 2 nodes that know each other by address alone
/// try the first few places only, so we leave those to them. Nobody looks for a
/// CLIENT at a well-known port, so many nodes on one host take any.
constexpr std::uint32_t first_participant_place = 60;
constexpr unsigned participant_places = 4;

/// RTPS 2.3, 9.6.1.1: PB + DG * domain + d1 + PG * participant.
std::uint16_t client_port(std::uint32_t domain_id) {
  return static_cast<std::uint16_t>(7400 + 250 * domain_id + 10
                                    + 2 * first_participant_place);
}

participant_settings to_settings(const cell_client_options& options) {
  participant_settings result;
  result.address = options.address;
  result.announcement = options.announcement;
  result.lease = options.lease;
  result.announcement_period = options.announcement_period;
  return result;
}

std::optional<edge_error> check(const cell_client_options& options) {
  if (auto error = check_settings(options.domain_id, to_settings(options)))
    return error;
  if (to_socket_address(options.server_address, options.server_port)
      && options.server_port != 0)
    return std::nullopt;
  return edge_error{error_code::schema_violation,
                    "\"" + options.server_address.substr(0, 64) + ':'
                        + std::to_string(options.server_port)
                        + "\" is no IPv4 address and port",
                    ""};
}

edge_result<std::string> local_address(const cell_client_options& options) {
  if (options.address.empty())
    return local_address_towards(
        *to_socket_address(options.server_address, options.server_port));
  auto found = resolve_interface(options.address);
  if (auto* error = std::get_if<edge_error>(&found))
    return *error;
  return std::get<interface_address>(found).address;
}

auto client_attributes(const cell_client_options& options, std::uint16_t port,
                       const guid_prefix& server) {
  auto result = make_attributes(to_settings(options), port);
  auto& discovery = result.builtin.discovery_config;
  discovery.discoveryProtocol = rtps::DiscoveryProtocol_t::CLIENT;
  discovery.discoveryServer_client_syncperiod = {0, join_repeat_period_ns};
  eprosima::fastdds::rtps::RemoteServerAttributes remote;
  std::copy(server.begin(), server.end(), remote.guidPrefix.value);
  remote.metatrafficUnicastLocatorList.push_back(
      udp_locator(options.server_address, options.server_port));
  discovery.m_DiscoveryServers.push_back(remote);
  return result;
}

} // namespace

class cell_client::impl {
public:
  impl(cell_client_options options, cell_client_events events)
      : options_(std::move(options)), events_(std::move(events)) {
    thread_ = std::thread{[this] { run(); }};
  }

  ~impl() {
    close();
  }

  void renew() {
    again_ = true;
    wake_.raise();
  }

  void close() {
    closing_ = true;
    wake_.raise();
    if (thread_.joinable())
      thread_.join();
  }

private:
  void run() {
    server_seeker seeker{
        *to_socket_address(options_.server_address, options_.server_port),
        options_.address, max_probe_interval,
        [this](const std::string& reason) { report(reason); }};
    while (!closing_)
      if (auto server = seeker.seek(wake_))
        stay_registered(*server);
  }

  void stay_registered(const guid_prefix& server) {
    again_ = false;
    known_.reset();
    const auto participant = make_participant(server);
    if (participant == nullptr) {
      wake_.wait(max_probe_interval);
      return;
    }
    while (!closing_ && !again_)
      wake_.wait(-1ms);
  }

  /// Null, with the reason reported, when there is none to be had.
  std::unique_ptr<rtps_participant>
  make_participant(const guid_prefix& server) {
    const auto port = free_port(
        options_.address, client_port(options_.domain_id), participant_places);
    if (const auto* why = std::get_if<edge_error>(&port)) {
      tell_trouble(why->message);
      return nullptr;
    }
    auto result = rtps_participant::create(
        options_.domain_id,
        client_attributes(options_, std::get<std::uint16_t>(port), server),
        [this, server](const sighting& seen) {
          if (seen.prefix == server)
            on_server(seen);
        });
    if (result == nullptr)
      tell_trouble("Fast DDS does not create a participant on "
                   + options_.address + ", UDP port "
                   + std::to_string(std::get<std::uint16_t>(port)));
    return result;
  }

  /// Runs on Fast DDS's threads, one call at a time.
  void on_server(const sighting& seen) {
    if (again_)
      return;
    if (seen.what == sighting::kind::left
        || seen.what == sighting::kind::lost) {
      if (events_.on_server_lost)
        events_.on_server_lost();
      renew();
    } else if (known_ != seen.announcement) {
      known_ = seen.announcement;
      if (events_.on_server)
        events_.on_server({server_id_of(seen.prefix).value_or(0), seen.prefix,
                           seen.announcement});
    }
  }

  void tell_trouble(const std::string& reason) {
    report(reason);
    if (events_.on_trouble)
      events_.on_trouble(reason);
  }

  void report(const std::string& reason) {
    if (events_.on_waiting)
      events_.on_waiting(reason);
  }

  const cell_client_options options_;
  const cell_client_events events_;
  wake_event wake_;
  std::atomic<bool> closing_{false};
  std::atomic<bool> again_{false}; // The registration ends; seek again.
  /// Announcement told last. Only touched between registrations or in the
  /// calls of one participant, which come one at a time.
  std::optional<std::string> known_;
  std::thread thread_;
};

cell_client::cell_client(std::unique_ptr<impl> x) : impl_(std::move(x)) {}

edge_result<std::unique_ptr<cell_client>>
cell_client::open(const cell_client_options& options,
                  cell_client_events events) {
  if (auto error = check(options))
    return *std::move(error);
  auto address = local_address(options);
  if (auto* error = std::get_if<edge_error>(&address))
    return *error;
  auto resolved = options;
  resolved.address = std::get<std::string>(address);
  return std::unique_ptr<cell_client>{new cell_client(
      std::make_unique<impl>(std::move(resolved), std::move(events)))};
}

cell_client::~cell_client() = default;

void cell_client::renew() {
  impl_->renew();
}

void cell_client::close() {
  impl_->close();
}

} // namespace roscell
