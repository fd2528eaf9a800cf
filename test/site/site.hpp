#pragma once

#include "actors/cell/cell_coordinator.hpp"
#include "actors/membership/membership.hpp"
#include "test/lossy_link.hpp"

#include <array>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// A whole site in miniature: real cell coordinators and memberships with their
/// members and peers. Around them are fakes of discovery, connections, REST and
/// disks, which can be made bad; time is virtual.
namespace roscell::test {

using namespace std::chrono_literals;

/// One machine: a coordination node, or one that looks for a cell. Its disk
/// survives a kill.
struct site_party {
  size_t index = 0;
  bool coordinates = false;
  std::string name;
  std::string uuid;
  std::string address;
  std::string cell;             ///< Coordinators only.
  std::string discovery_server; ///< The same.
  std::string configured;       ///< Nodes only; see `membership_record`.
  std::map<std::string, std::map<std::string, std::string>> disk; ///< By table.
  bool disk_full = false;

  unsigned life = 0;                  ///< Counts its starts.
  caf::actor edge;                    ///< Plays every part around it.
  cell_coordinator_actor coordinator; ///< Invalid unless it coordinates.
  membership_actor membership;        ///< Invalid if it does.
  std::string looking_for;            ///< A discovery server.
  std::optional<node_presence> announced;
  std::map<size_t, node_presence> shown; ///< What it sees of which party.

  house context; ///< Tells facts as this party's.

  bool alive() const {
    return edge != nullptr;
  }

  /// Whoever hears of discovery; the party lives.
  caf::actor brain() const;

  /// The state of its actor, which nothing works on meanwhile.
  cell_coordinator_state& cell_state() const;
  membership_status& status() const;
};

/// A request that an operator has sent to a coordinator.
struct site_request {
  size_t asked = 0;
  std::string text;
  std::function<bool()> is_answered;
  bool closed = false; ///< The coordinator was killed, so the caller knows.
};

/// A frame, a half of a REST call, an attempt to connect or a write to disk.
struct site_message {
  size_t number = 0; ///< The first is 1.
  const char* what = "";
  size_t from = 0;
  size_t to = 0; ///< As `from` for a write.
};

struct told_at {
  std::chrono::milliseconds when{0}; ///< Since the start.
  size_t party = 0;
  unsigned life = 0; ///< Of the party.
  std::string what;
  std::string subject;
  json data;
};

/// Everything; to be kept at one place, for the actors point to it.
class site {
public:
  struct connection {
    wire_ptr link;
    std::array<size_t, 2> parties; ///< Who accepted, who opened.
  };

  site(virtual_time& clock, uint32_t seed);
  ~site();

  site(const site&) = delete;
  site& operator=(const site&) = delete;

  virtual_time& time;
  std::mt19937 random;
  wire_faults faults;
  /// Of a half of a REST call.
  double lose_call = 0;
  std::vector<std::unique_ptr<site_party>> parties;
  std::vector<connection> connections;
  std::vector<site_request> requests;
  std::vector<told_at> facts;
  /// Decides about a message; may be empty.
  std::function<frame_fate(const site_message&)> judge;
  size_t messages = 0;

  site_party& add_coordinator(const std::string& uuid);
  site_party& add_node(const std::string& configured = "");

  void start(site_party& x);
  void kill(site_party& x);

  /// Asks a coordinator that lives.
  template <class Reply, class Request>
  void ask(const site_party& whom, const Request& what) {
    auto reply = time.ask<Reply>(whom.coordinator, what);
    requests.push_back({whom.index, message_json(what).dump(),
                        [reply] { return reply->has_value(); }});
  }

  // -- what can go wrong ------------------------------------------------------

  /// Only parties of the same side reach each other.
  void split(const std::vector<int>& sides);
  /// These two cannot connect to each other; what is connected stays.
  void block(size_t x, size_t y);
  /// These two do not see each other's public presence.
  void hide(size_t x, size_t y);
  /// Ends all of that and every silence.
  void heal_all();

  bool reachable(size_t x, size_t y) const;

  void pass(std::chrono::milliseconds span) {
    time.pass(span);
  }

  /// The same, but stops in the middle of a moment once `stop` says so.
  bool pass_until(std::chrono::milliseconds span,
                  const std::function<bool()>& stop);

  size_t pick(size_t count) {
    return random() % count;
  }

  // -- INTERNAL: from the edges ----------------------------------------------

  /// Runs `work` in the edge of that party, if this life of it goes on.
  void later(const site_party& x, std::chrono::milliseconds delay,
             std::function<void()> work);
  void run_work(uint64_t number);
  frame_fate decide(const char* what, size_t from, size_t to);
  /// Shows everybody what is to be seen and has not been shown yet.
  void spread();
  void withdraw(site_party& x);
  /// Tells a node of the coordinator that it looks for.
  void look_up(site_party& x);
  wire_ptr connect(const site_party& from, const site_party& to);
  site_party* find_address(const std::string& address);
  house context;

private:
  bool sees(const site_party& viewer, const site_party& subject) const;
  site_party& add_party(const std::string& name);
  void keep_facts(site_party& x);
  void show(site_party& viewer, const site_party& subject);
  void fade(site_party& viewer, size_t subject,
            std::chrono::milliseconds delay);

  std::vector<int> sides_;
  std::set<std::pair<size_t, size_t>> blocked_;
  std::set<std::pair<size_t, size_t>> hidden_;
  std::map<uint64_t, std::function<void()>> work_;
  uint64_t last_work_ = 0;
  std::vector<caf::actor> fact_keepers_; ///< One a party.
  std::chrono::steady_clock::time_point start_;
};

/// Plays discovery, connector, registration client, disk and agent of a party.
caf::behavior site_edge(caf::event_based_actor* self, site* place,
                        site_party* me);

/// What the site's nodes prove switches with.
constexpr auto site_token = "a token of this site";

} // namespace roscell::test
