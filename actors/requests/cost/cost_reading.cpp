#include "actors/requests/cost/cost_reading.hpp"

#include "actors/edge/host/own_cost.hpp"

#include <map>
#include <string>

namespace roscell {

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
  cost_reading result{own.cpu_seconds, own.pss_bytes, own.written_bytes, {}};
  if (table)
    result.peers = session_traffic(*table);
  return result;
}

} // namespace roscell
