#include "actors/requests/cost/cost_ring.hpp"

#include "actors/edge/host/own_process.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

namespace roscell {

namespace {

using seconds = std::chrono::duration<double>;

constexpr const char* other_peers = "other";

/// What a counter has grown by. One that is less than it was has begun anew.
double growth(double before, double now) {
  return now < before ? now : now - before;
}

} // namespace

void cost_ring::slice::add(const slice& other) {
  span += other.span;
  cpu_s += other.cpu_s;
  pss_byte_s += other.pss_byte_s;
  written_bytes += other.written_bytes;
  builds.sent_bytes += other.builds.sent_bytes;
  builds.received_bytes += other.builds.received_bytes;
  peers.resize(std::max(peers.size(), other.peers.size()));
  for (size_t i = 0; i < other.peers.size(); ++i) {
    peers[i].sent_bytes += other.peers[i].sent_bytes;
    peers[i].received_bytes += other.peers[i].received_bytes;
  }
}

void cost_ring::track::add(const slice& other) {
  filling.add(other);
  if (filling.span < length)
    return;
  if (complete.size() == most)
    complete.erase(complete.begin());
  complete.push_back(std::exchange(filling, {}));
}

cost_ring::slice cost_ring::track::sum() const {
  auto result = filling;
  for (const auto& x : complete)
    result.add(x);
  return result;
}

void cost_ring::mark(time_point now, const cost_reading& reading) {
  auto placed = reading;
  placed.peers = by_place(reading.peers);
  if (last_at_) {
    const auto passed = slice_until(now, placed);
    for (auto& x : tracks_)
      x.add(passed);
  }
  last_at_ = std::max(now, last_at_.value_or(now));
  last_ = std::move(placed);
}

std::vector<cost_window> cost_ring::windows() const {
  std::vector<cost_window> result;
  for (const auto& x : tracks_)
    result.push_back(window_of(x));
  return result;
}

/// A peer that is not known gets a place if there is one.
size_t cost_ring::place_of(const std::string& peer) {
  auto& known = last_.peers;
  if (known.empty())
    known.push_back({other_peers});
  const auto found =
      std::find_if(known.begin(), known.end(),
                   [&](const auto& x) { return x.peer == peer; });
  if (found != known.end())
    return static_cast<size_t>(found - known.begin());
  if (known.size() > max_peers)
    return 0;
  known.push_back({peer});
  return known.size() - 1;
}

/// The counters of each place, those that are not told with 0.
std::vector<peer_traffic>
cost_ring::by_place(const std::vector<peer_traffic>& reported) {
  std::vector<size_t> places;
  places.reserve(reported.size());
  for (const auto& x : reported)
    places.push_back(place_of(x.peer));
  std::vector<peer_traffic> result;
  for (const auto& x : last_.peers)
    result.push_back({x.peer});
  for (size_t i = 0; i < reported.size(); ++i) {
    auto& sum = result[places[i]];
    sum.sent_bytes += reported[i].sent_bytes;
    sum.received_bytes += reported[i].received_bytes;
  }
  return result;
}

cost_ring::traffic cost_ring::traffic_between(const peer_traffic& before,
                                              const peer_traffic& now) {
  return {
      static_cast<float>(growth(before.sent_bytes, now.sent_bytes)),
      static_cast<float>(growth(before.received_bytes, now.received_bytes))};
}

/// @param reading its peers by place.
cost_ring::slice cost_ring::slice_until(time_point now,
                                        const cost_reading& reading) const {
  slice result;
  // Who asks while another one marks may have looked at the clock before.
  result.span = std::max(now - *last_at_, time_point::duration{0});
  result.cpu_s = growth(last_.cpu_s, reading.cpu_s);
  result.pss_byte_s = reading.pss_bytes * seconds{result.span}.count();
  result.written_bytes = growth(last_.written_bytes, reading.written_bytes);
  result.builds = traffic_between(last_.builds, reading.builds);
  for (size_t i = 0; i < reading.peers.size(); ++i)
    result.peers.push_back(traffic_between(last_.peers[i], reading.peers[i]));
  return result;
}

cost_window cost_ring::window_of(const track& x) const {
  const auto sum = x.sum();
  cost_window result;
  result.window = x.window;
  result.span_s = seconds{sum.span}.count();
  result.cpu_s = sum.cpu_s;
  result.pss_bytes =
      result.span_s > 0 ? sum.pss_byte_s / result.span_s : last_.pss_bytes;
  result.written_bytes = sum.written_bytes;
  result.builds_sent_bytes = sum.builds.sent_bytes;
  result.builds_received_bytes = sum.builds.received_bytes;
  for (size_t i = 0; i < sum.peers.size(); ++i)
    if (sum.peers[i].sent_bytes > 0 || sum.peers[i].received_bytes > 0)
      result.peers.push_back({last_.peers[i].peer, sum.peers[i].sent_bytes,
                              sum.peers[i].received_bytes});
  return result;
}

namespace {

std::vector<peer_traffic> session_traffic(const metric_table& table) {
  std::map<std::string, peer_traffic> peers;
  for (const auto& x : table.samples(metric::session_sent_bytes))
    peers[x.labels.front()].sent_bytes = x.sum;
  for (const auto& x : table.samples(metric::session_received_bytes))
    peers[x.labels.front()].received_bytes = x.sum;
  std::vector<peer_traffic> result;
  for (auto& [name, traffic] : peers) {
    traffic.peer = name;
    result.push_back(traffic);
  }
  return result;
}

} // namespace

cost_reading read_cost(const std::shared_ptr<metric_table>& table) {
  const auto own = read_own_cost();
  cost_reading result{
      own.cpu_seconds, own.pss_bytes, own.written_bytes, {}, {}};
  if (!table)
    return result;
  result.peers = session_traffic(*table);
  for (const auto& x : table->samples(metric::builds_sent_bytes))
    result.builds.sent_bytes += x.sum;
  for (const auto& x : table->samples(metric::builds_received_bytes))
    result.builds.received_bytes += x.sum;
  return result;
}

cost_meter::cost_meter(reader read) : read_(std::move(read)) {}

void cost_meter::mark(cost_ring::time_point now) {
  std::lock_guard guard{mutex_};
  ring_.mark(now, read_());
}

std::vector<cost_window> cost_meter::windows(cost_ring::time_point now) {
  std::lock_guard guard{mutex_};
  ring_.mark(now, read_());
  return ring_.windows();
}

} // namespace roscell
