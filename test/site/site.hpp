#pragma once

#include "test/lossy_link.hpp"
#include "test/site/site_party.hpp"
#include "test/site/site_task.hpp"

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
/// members and peers, request routers and pipelines, node agents, container
/// supervisors and skill instances. Around them are fakes of discovery,
/// connections, REST, disks, hosts and programs, which can be made bad; time is
/// virtual.
namespace roscell::test {

using namespace std::chrono_literals;

/// A request that an operator has sent to a coordinator.
struct site_request {
  size_t asked = 0;
  std::string text;
  instance_policy policy = instance_policy::refuse;
  std::function<bool()> is_answered;
  /// Why it was refused; nothing while there is no answer.
  std::function<std::optional<failure>()> refusal;
  bool closed = false; ///< The coordinator was killed, so the caller knows.
};

/// A frame, a half of a REST call, an attempt to connect or a write to disk.
struct site_message {
  size_t number = 0; ///< The first is 1.
  const char* what = "";
  size_t from = 0;
  size_t to = 0; ///< As `from` for a write.
};

struct site_event {
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
  double drop_call = 0;
  std::vector<std::unique_ptr<site_party>> parties;
  std::vector<connection> connections;
  std::vector<site_request> requests;
  std::vector<std::unique_ptr<site_task>> tasks;
  std::vector<site_event> events;
  /// Decides about a message; may be empty.
  std::function<frame_fate(const site_message&)> judge;
  size_t messages = 0;

  size_t containers = 0;               ///< Number of the last one.
  std::map<std::string, size_t> homes; ///< Where which instance was started.
  std::set<std::string> finished;      ///< Instances that ended with 0.
  std::vector<std::string> violations; ///< What must never happen, and did.

  site_party& add_coordinator(const std::string& uuid);
  site_party& add_node(const std::string& configured = "");

  /// How often something was told by anybody.
  size_t count(const std::string& event) const;

  void start(site_party& x);
  void kill(site_party& x);
  /// The machine loses its power: what runs on it ends too.
  void crash(site_party& x);
  /// SIGSTOP for its process, but neither for the kernel nor for what runs
  /// there, and SIGCONT.
  void freeze(site_party& x);
  void thaw(site_party& x);
  bool is_frozen(const site_party& x) const {
    return frozen_.count(x.index) > 0;
  }

  /// Whether a cell's coordinator lives and does not hear that node.
  bool has_lost(const std::string& cell, const std::string& node) const;

  /// Asks a coordinator that lives.
  template <class Reply, class Request>
  void ask(const site_party& whom, const Request& what) {
    auto reply = time.ask<Reply>(whom.coordinator, what);
    requests.push_back({whom.index, message_json(what).dump(), what.instances,
                        [reply] { return reply->has_value(); },
                        [reply]() -> std::optional<failure> {
                          if (!reply->has_value() || **reply)
                            return std::nullopt;
                          return to_failure((*reply)->error());
                        }});
  }

  site_task& add_task(const site_party& coordinator,
                      const std::vector<json>& steps);
  /// Asks the task's coordinator, which lives.
  void request(site_task& x);
  void terminate(site_task& x);

  // -- what can go wrong ------------------------------------------------------

  /// Only parties of the same side reach each other.
  void split(const std::vector<int>& sides);
  /// Nothing passes from one to the other; the way back is open.
  void cut_one_way(size_t from, size_t to);
  /// These two cannot connect to each other; what is connected stays.
  void block(size_t x, size_t y);
  /// These two do not see each other's public presence.
  void hide(size_t x, size_t y);
  /// Ends all of that and every silence.
  void heal_all();

  bool passes(size_t from, size_t to) const;
  bool reachable(size_t x, size_t y) const {
    return passes(x, y) && passes(y, x);
  }

  std::chrono::steady_clock::time_point now() const {
    return time.scheduler.clock().now();
  }

  void pass(std::chrono::milliseconds span) {
    pass_until(span, [] { return false; });
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
  void report_violation(const std::string& what);
  site_party* find_address(const std::string& address);
  actor_context context;

private:
  bool sees(const site_party& viewer, const site_party& subject) const;
  site_party& add_party(const std::string& name);
  void collect_events(site_party& x);
  void call(site_task& x, const json& document, bool ends);
  void close_calls(const site_party& x);
  void settle();
  bool run_one();
  void keep_frozen_back();
  void update_links();
  void show(site_party& viewer, const site_party& subject);
  void fade(site_party& viewer, size_t subject,
            std::chrono::milliseconds delay);

  std::vector<int> sides_;
  std::set<std::pair<size_t, size_t>> one_way_; ///< From, to: cut.
  std::set<std::pair<size_t, size_t>> blocked_;
  std::set<std::pair<size_t, size_t>> hidden_;
  std::map<uint64_t, std::function<void()>> work_;
  uint64_t last_work_ = 0;
  std::vector<caf::actor> event_collectors_;         ///< One a party.
  std::map<size_t, std::set<caf::actor_id>> frozen_; ///< By party.
  std::map<size_t, std::vector<caf::resumable*>> kept_back_;
  std::chrono::steady_clock::time_point start_;
};

/// Plays discovery, connector, registration client, disk, probe and runtime of
/// a party.
caf::behavior site_edge(caf::event_based_actor* self, site* place,
                        site_party* me);

/// Somebody who was killed is seen for so long, at least. It is ten minutes in
/// production; nothing depends on it but how long a test takes.
constexpr auto ghost_span = 15s;

/// A step of a task request; any deployment and any node if these are empty.
json work_step(const std::string& id, const program_script& script = {},
               const std::string& deployment = "",
               const std::string& node = "");

/// What the site's nodes prove switches with.
constexpr auto site_token = "a token of this site";

} // namespace roscell::test
