#include "actors/node/cell_claim.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/public_presence.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/session/session_link.hpp"
#include "actors/membership/limits.hpp"
#include "actors/node/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace roscell {

namespace {

caf::error name_in_use(const announcement& other) {
  return fail(error_code::conflict,
              "the cell name '" + other.cell + "' is in use: node '"
                  + other.node + "' at " + other.session + " coordinates it",
              "", "choose another --cell, or take it over with --force");
}

caf::error is_a_copy(const announcement& other) {
  return fail(
      error_code::conflict,
      "this coordinator runs at " + other.session
          + " already: the data directory is a copy",
      "",
      "stop that one to go on with its cell here, or start this one once "
      "with --new-identity and another --cell: then it is another cell");
}

/// Who of those that were asked has proven what he claims. The io thread tells,
/// the start of the node waits.
class proof_round {
public:
  explicit proof_round(size_t asked) : open_(asked), proven_(asked) {}

  void settle(size_t number, bool proven) {
    std::lock_guard guard{mutex_};
    proven_[number] = proven;
    if (--open_ == 0)
      changed_.notify_one();
  }

  /// Who has not answered in time has proven nothing.
  std::vector<bool> wait() {
    std::unique_lock guard{mutex_};
    changed_.wait_for(guard, limits::token::claim_proof,
                      [this] { return open_ == 0; });
    return proven_;
  }

private:
  std::mutex mutex_; // Guards what follows.
  std::condition_variable changed_;
  size_t open_;
  std::vector<bool> proven_;
};

/// No more than are asked at once, and nobody twice.
/// @param asked those who have been asked, with those that are returned. Many
/// who prove nothing leave as much room in the second look as in the first.
std::vector<announcement> without_repetitions(std::vector<announcement> claims,
                                              std::set<std::string>& asked) {
  std::vector<announcement> result;
  for (auto& x : claims)
    if (result.size() < limits::token::claims
        && asked.insert(x.session + " " + x.uuid).second)
      result.push_back(std::move(x));
  return result;
}

/// Those that prove to be the coordinators that they claim to be.
std::vector<bool> ask_for_proofs(const std::vector<announcement>& claims,
                                 const node_config& config,
                                 const node_data& data, node_edges& edges) {
  const auto round = std::make_shared<proof_round>(claims.size());
  session_options options;
  options.handshake_timeout = limits::token::claim_proof;
  const joiner_identity self{config.name, data.identity.uuid,
                             data.identity.epoch};
  for (size_t i = 0; i < claims.size(); ++i) {
    const auto at = parse_socket_address(claims[i].session);
    if (!at) {
      round->settle(i, false);
      continue;
    }
    ask_for_proof(*edges.io,
                  {at->address, at->port, claims[i].cell, claims[i].uuid}, self,
                  data.site, options,
                  [round, i](const auto& why) { round->settle(i, !why); });
  }
  return round->wait();
}

caf::expected<std::vector<announcement>>
seek_coordinators(const node_config& config, std::chrono::milliseconds span) {
  presence_options options;
  options.address = config.address;
  options.domain_id = config.public_domain_id;
  // Names that do not resolve yet are looked up again when the node announces
  // itself, which tells of them.
  options.peers =
      await_hosts(config.peers, limits::discovery::peer_names).addresses;
  auto seen = survey_site(options, span, {});
  if (auto* why = std::get_if<edge_error>(&seen))
    return to_caf(*why);
  return std::get<std::vector<announcement>>(std::move(seen));
}

/// The lowest id that no coordinator announces.
uint8_t free_server_id(const std::vector<announcement>& seen,
                       const std::string& own_uuid) {
  std::set<int64_t> used;
  for (const auto& x : seen)
    if (x.role == "coordinator" && x.uuid != own_uuid)
      used.insert(x.server);
  uint8_t result = 0;
  while (result < UINT8_MAX && used.count(result) > 0)
    ++result;
  return result;
}

/// Others that claim the name of the cell, or to be this coordinator.
std::vector<announcement> claims_among(const std::vector<announcement>& seen,
                                       const node_config& config,
                                       const std::string& own,
                                       const node_edges& edges) {
  std::vector<announcement> result;
  for (const auto& x : seen)
    if (x.role == "coordinator" && x.cell == config.cell
        && x.session != edges.http_address && (x.uuid == own || !config.force))
      result.push_back(x);
  return result;
}

/// Where this coordinator was at its last start, if that is elsewhere: another
/// one may run there on a data directory of which this one is a copy, and not
/// be heard in time on a busy host.
std::vector<announcement> former_place(const node_config& config,
                                       const node_data& data,
                                       const node_edges& edges) {
  if (data.led_from.empty() || data.led_from == edges.http_address)
    return {};
  announcement result;
  result.role = "coordinator";
  result.node = config.name;
  result.cell = config.cell;
  result.session = data.led_from;
  result.uuid = data.identity.uuid;
  return {std::move(result)};
}

/// The refusal where one of them proves its claim; the others are told of.
caf::error refuse_owner(const std::vector<announcement>& claims,
                        const node_config& config, const node_data& data,
                        node_edges& edges, const actor_context& context) {
  const auto& own = data.identity.uuid;
  const auto proven = ask_for_proofs(claims, config, data, edges);
  for (size_t i = 0; i < claims.size(); ++i) {
    if (proven[i])
      return claims[i].uuid == own ? is_a_copy(claims[i])
                                   : name_in_use(claims[i]);
    // What it was itself, at an address that it has left, is no news.
    if (claims[i].uuid != own)
      context.publish_event(
          events::claim_ignored, claims[i].node,
          {{"cell", claims[i].cell}, {"address", claims[i].session}});
  }
  return caf::none;
}

} // namespace

caf::expected<uint8_t> claim_cell(const node_config& config,
                                  const node_data& data, node_edges& edges,
                                  const actor_context& context) {
  using namespace limits::discovery;
  const auto& own = data.identity.uuid;
  std::set<std::string> asked;
  std::vector<announcement> seen;
  if (auto refusal = refuse_owner(former_place(config, data, edges), config,
                                  data, edges, context))
    return refusal;
  // Who is heard first may claim what it cannot prove, where the owner of the
  // name, who is slower, can. More than two looks would let unauthenticated
  // peers hold up the start for ever.
  for (const auto span : {survey, second_survey}) {
    auto around = seek_coordinators(config, span);
    if (!around)
      return around.error();
    seen = std::move(*around);
    const auto claims =
        without_repetitions(claims_among(seen, config, own, edges), asked);
    if (claims.empty())
      break;
    if (auto refusal = refuse_owner(claims, config, data, edges, context))
      return refusal;
  }
  if (auto why = keep_address(data, edges.http_address))
    return why;
  return config.server_id.value_or(free_server_id(seen, own));
}

} // namespace roscell
