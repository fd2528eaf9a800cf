#include "actors/edge/dds/public_presence.hpp"

#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/discovery_participant.hpp"
#include "actors/edge/dds/herald.hpp"

#include <algorithm>
#include <charconv>
#include <condition_variable>
#include <mutex>
#include <random>
#include <utility>

namespace roscell {

namespace {

namespace rtps = eprosima::fastrtps::rtps;

using namespace std::chrono_literals;

/// RTPS 2.3, 9.6.1.4.1.
constexpr const char* multicast_group = "239.255.0.1";

/// RTPS 2.3, 9.6.1.1: PB + DG * domain, the discovery multicast port.
std::uint16_t multicast_port(std::uint32_t domain_id) {
  return static_cast<std::uint16_t>(7400 + 250 * domain_id);
}

/// PB + DG * domain + d1 + PG * participant.
std::uint16_t unicast_port(std::uint32_t domain_id, unsigned place) {
  return static_cast<std::uint16_t>(multicast_port(domain_id) + 10 + 2 * place);
}

participant_settings to_settings(const presence_options& options) {
  participant_settings result;
  result.address = options.address;
  result.announcement = options.announcement;
  result.lease = options.lease;
  result.announcement_period = options.announcement_period;
  return result;
}

edge_error bad_peer(const std::string& text) {
  return {error_code::schema_violation,
          "\"" + text.substr(0, 64) + "\" is no peer",
          "write an IPv4 address, or an address and a UDP port as in "
          "10.0.0.5:32160"};
}

/// The places where the peer in `text` may listen; none if it is no peer.
std::vector<rtps::Locator_t> peer_locators(const std::string& text,
                                           std::uint32_t domain_id) {
  std::vector<rtps::Locator_t> result;
  auto colon = text.find(':');
  auto address = text.substr(0, colon);
  if (!to_socket_address(address, 0))
    return result;
  if (colon == std::string::npos) {
    for (unsigned place = 0; place < limits::discovery::presence_places;
         ++place)
      result.push_back(udp_locator(address, unicast_port(domain_id, place)));
    return result;
  }
  std::uint16_t port = 0;
  const char* last = text.data() + text.size();
  auto [ptr, ec] = std::from_chars(text.data() + colon + 1, last, port);
  if (ec == std::errc{} && ptr == last && port != 0)
    result.push_back(udp_locator(address, port));
  return result;
}

edge_result<rtps::LocatorList_t> all_peers(const presence_options& options) {
  rtps::LocatorList_t result;
  for (auto& peer : options.peers) {
    auto locators = peer_locators(peer, options.domain_id);
    if (locators.empty())
      return bad_peer(peer);
    for (auto& locator : locators)
      result.push_back(locator);
  }
  return result;
}

auto presence_attributes(const presence_options& options, std::uint16_t port,
                         const rtps::LocatorList_t& peers) {
  auto result = make_attributes(to_settings(options), port);
  auto group = udp_locator(multicast_group, multicast_port(options.domain_id));
  result.builtin.metatrafficMulticastLocatorList.push_back(group);
  result.builtin.initialPeersList = peers;
  result.builtin.initialPeersList.push_back(group);
  auto& discovery = result.builtin.discovery_config;
  discovery.discoveryProtocol = rtps::DiscoveryProtocol_t::SIMPLE;
  // Nobody here has topics; without these, those who meet exchange nothing but
  // their announcements.
  discovery.m_simpleEDP.use_PublicationReaderANDSubscriptionWriter = false;
  discovery.m_simpleEDP.use_PublicationWriterANDSubscriptionReader = false;
  // More than one, as nothing is acknowledged.
  discovery.initial_announcements.count = 3;
  discovery.initial_announcements.period = {0, 100'000'000};
  return result;
}

/// When a newcomer is answered, and again when what was said may have got lost.
/// Not by all at the same moment.
std::vector<std::chrono::milliseconds> answer_delays() {
  std::random_device source;
  std::uniform_int_distribution<int> first{0, 10};
  return {std::chrono::milliseconds{first(source)}, 60ms, 200ms, 600ms};
}

/// However many newcomers there are, it is not said more often.
constexpr std::chrono::milliseconds answer_pause{25};

} // namespace

class public_presence::impl {
public:
  explicit impl(presence_events events)
      : events_(std::move(events)),
        herald_(answer_delays(), answer_pause,
                [this] { participant_->announce(); }) {}

  ~impl() {
    close();
  }

  bool open(const presence_options& options, std::uint16_t port,
            const rtps::LocatorList_t& peers) {
    participant_ = rtps_participant::create(
        options.domain_id, presence_attributes(options, port, peers),
        [this](const sighting& seen) { on_sighting(seen); });
    if (participant_ == nullptr)
      return false;
    port_ = participant_->port();
    herald_.start();
    return true;
  }

  void update(const std::string& bytes) {
    if (participant_ == nullptr)
      return;
    participant_->update_announcement(bytes);
    herald_.ask();
  }

  void close() {
    herald_.stop();
    participant_.reset();
  }

  std::uint16_t port() const {
    return port_;
  }

private:
  using clock = std::chrono::steady_clock;

  /// Runs on Fast DDS's threads, one call at a time.
  void on_sighting(const sighting& seen) {
    if (seen.what == sighting::kind::left || seen.what == sighting::kind::lost)
      for (const auto& x : known_.forget(seen.prefix, clock::now()))
        report_change(x);
    else if (auto said = decode(seen.announcement))
      remember(seen.prefix, *said);
  }

  void remember(const guid_prefix& who, const announcement& said) {
    const auto outcome = known_.remember(who, said, clock::now());
    if (outcome.newcomer)
      herald_.ask();
    for (const auto& x : outcome.changes)
      report_change(x);
  }

  void report_change(const presence_table::change& x) {
    const auto& event = x.gone ? events_.on_gone : events_.on_seen;
    if (event)
      event(x.said);
  }

  presence_events events_;
  presence_table known_; // Touched in sightings only.
  std::uint16_t port_ = 0;
  herald herald_;
  std::unique_ptr<rtps_participant> participant_;
};

public_presence::public_presence(std::unique_ptr<impl> x)
    : impl_(std::move(x)) {}

edge_result<std::unique_ptr<public_presence>>
public_presence::open(const presence_options& options, presence_events events) {
  if (auto error = check_settings(options.domain_id, to_settings(options)))
    return *std::move(error);
  auto peers = all_peers(options);
  if (auto* error = std::get_if<edge_error>(&peers))
    return *error;
  auto port = free_port(options.address, unicast_port(options.domain_id, 0),
                        limits::discovery::presence_places);
  if (auto* error = std::get_if<edge_error>(&port))
    return *error;
  auto x = std::make_unique<impl>(std::move(events));
  if (x->open(options, std::get<std::uint16_t>(port), std::get<0>(peers)))
    return std::unique_ptr<public_presence>{new public_presence(std::move(x))};
  return edge_error{error_code::internal,
                    "Fast DDS does not create a participant on "
                        + options.address,
                    "its own log says why"};
}

public_presence::~public_presence() = default;

std::optional<edge_error> public_presence::update(const std::string& bytes) {
  if (auto error = check_announcement(bytes))
    return error;
  impl_->update(bytes);
  return std::nullopt;
}

void public_presence::close() {
  impl_->close();
}

std::uint16_t public_presence::port() const {
  return impl_->port();
}

namespace {

/// What was seen so far. One thread waits; Fast DDS's thread tells.
class survey {
public:
  explicit survey(const std::function<bool(const announcement&)>& enough)
      : enough_(enough) {}

  void add(const announcement& said) {
    std::lock_guard<std::mutex> lock{mutex_};
    drop(said);
    seen_.push_back(said);
    if (enough_ && enough_(said)) {
      over_ = true;
      changed_.notify_one();
    }
  }

  void remove(const announcement& said) {
    std::lock_guard<std::mutex> lock{mutex_};
    drop(said);
  }

  std::vector<announcement> wait(std::chrono::milliseconds span) {
    std::unique_lock<std::mutex> lock{mutex_};
    changed_.wait_for(lock, span, [this] { return over_; });
    return seen_;
  }

private:
  /// A later word of one that has spoken replaces the former. Where it is is a
  /// part of who it is: another one may say the rest as well.
  void drop(const announcement& said) {
    auto same = [&](const announcement& x) {
      return x.uuid == said.uuid && x.node == said.node && x.role == said.role
             && x.session == said.session;
    };
    seen_.erase(std::remove_if(seen_.begin(), seen_.end(), same), seen_.end());
  }

  const std::function<bool(const announcement&)>& enough_;
  std::mutex mutex_; // Guards what follows.
  std::condition_variable changed_;
  bool over_ = false;
  std::vector<announcement> seen_;
};

} // namespace

std::chrono::milliseconds
survey_span(std::chrono::milliseconds least,
            std::chrono::steady_clock::duration opening) {
  using std::chrono::milliseconds;
  constexpr milliseconds most{1000};
  // 60 ms on a quiet host of 2.4 ms, where all are heard within 20 ms.
  constexpr int answers_per_opening = 25;
  const auto answers = answers_per_opening * opening;
  return std::max(
      least, std::min(most, std::chrono::duration_cast<milliseconds>(answers)));
}

edge_result<std::vector<announcement>>
survey_site(presence_options options, std::chrono::milliseconds span,
            const std::function<bool(const announcement&)>& enough) {
  announcement self;
  self.role = "surveyor";
  options.announcement = encode(self);
  survey found{enough};
  presence_events events;
  events.on_seen = [&](const announcement& said) { found.add(said); };
  events.on_gone = [&](const announcement& said) { found.remove(said); };
  const auto begun = std::chrono::steady_clock::now();
  auto presence = public_presence::open(options, std::move(events));
  if (auto* error = std::get_if<edge_error>(&presence))
    return *error;
  const auto opened = std::chrono::steady_clock::now() - begun;
  auto result = found.wait(survey_span(span, opened));
  std::get<0>(presence)->close();
  return result;
}

} // namespace roscell
