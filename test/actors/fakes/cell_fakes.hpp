#pragma once

#include "actors/membership/membership.hpp"
#include "actors/session/member/member.hpp"
#include "test/lossy_link.hpp"

#include <caf/actor_cast.hpp>

#include <deque>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

/// A site in miniature: real members and memberships, tiny fakes of all that is
/// around them, wires that can be made bad, and virtual time.
namespace roscell::test {

using namespace std::chrono_literals;

/// That all of them have.
constexpr auto site_token = "a token of the site";

/// One row of the fake coordinator's registry.
struct fake_row {
  node_identity identity;
  member_actor member;
  bool active = false;
  std::string reason; ///< Why it is not.
  node_registration registration;
};

/// The coordination node: what survives a kill of it, and what it was told.
struct fake_coordinator {
  cell_coordinator_actor actor; ///< Invalid while it is down.
  std::string cell = "cell-1";
  std::string cell_uuid;                  ///< Empty: it tells none.
  std::vector<discovery_place> discovery; ///< What it gives every node.
  std::string name = "base";
  int64_t incarnation = 1;
  std::map<std::string, fake_row> rows; ///< By name.
  std::vector<member_actor> members;    ///< All that were ever made.
  std::vector<instance_verdict> verdicts;
  std::vector<instance_changed> changes;
  std::vector<member_skills_changed> skills; ///< As members have told.
  bool hears_skills = true; ///< Else it is of an earlier version.
  std::string build_key = std::string(64, 'a'); ///< The same where empty.
  std::vector<image_request> image_requests;
  std::vector<member_lost> losses;
  std::optional<failure> refusal; ///< Of registrations.
  bool mute = false;              ///< Does not answer registrations.
  std::vector<json> asked;        ///< By users of members.
  json answer{{"type", "task_description"}, {"tasks", json::array()}};
  std::vector<caf::response_promise> unanswered;
};

/// A node: its disk, what runs on it, and what its parts were asked.
struct fake_node {
  node_identity identity; ///< As its disk has it.
  membership_actor membership;
  caf::actor local; ///< Plays every part that a membership works with.
  bool searching = false;
  size_t searches = 0;
  std::optional<serve_programs> served; ///< Its own discovery server.
  std::optional<failure> serving_refusal;
  std::map<std::string, std::string> environment; ///< Of its instances.
  size_t environments = 0;        ///< How often they were told one.
  wire_ptr link;                  ///< The latest.
  std::optional<failure> refusal; ///< Of sessions.
  server_probed probed; ///< What the join diagnoser sees; nothing answers.
  size_t looks = 0;     ///< Of the join diagnoser.
  size_t claims = 0;    ///< Of its address.
  std::map<std::string, std::string> names; ///< Of hosts, to addresses.
  std::vector<std::string> sought;          ///< Discovery servers.
  size_t announcements = 0;                 ///< Of itself.
  std::optional<failure> deployment_refusal;
  bool disk_full = false;
  std::vector<instance_row> instances;
  std::vector<std::string> acknowledged; ///< Ends that need not be told again.
  std::vector<instance_reservation> reservations;
  std::vector<instance_deployment> deployments;
  std::vector<instance_removal> removals;
  std::chrono::milliseconds deployment_takes{0};
  std::deque<std::pair<caf::response_promise, instance_row>> deploying;
};

/// An event that an actor of the site has told.
struct published_event {
  std::string what;
  std::string subject;
  json data;
};

/// Everything; to be kept at one place, for the actors point to it.
struct fake_site {
  virtual_time& time;
  std::mt19937 random;
  wire_faults faults;
  fake_coordinator base;
  std::vector<std::unique_ptr<fake_node>> nodes;
  std::vector<published_event> events;
  caf::actor event_collector;
  size_t timers_fired = 0;
  std::string unauthenticated_server; ///< Where no coordinator answers.
  actor_context context;

  fake_site(virtual_time& clock, uint32_t seed);
  ~fake_site();

  fake_site(const fake_site&) = delete;
  fake_site& operator=(const fake_site&) = delete;

  /// Lets time pass exactly, from one timer to the next.
  void pass(std::chrono::milliseconds span);

  auto now() const {
    return time.scheduler.clock().now();
  }

  void start_coordinator();
  void kill_coordinator();

  fake_node& add_node(const std::string& name, const std::string& uuid);
  void start(fake_node& x);
  void kill(fake_node& x);
  void join(fake_node& x);

  /// Discovery tells all that look for the coordinator.
  void announce();

  /// As if the coordinator's announcement had changed.
  void announce_to(fake_node& x);

  membership_state status(fake_node& x);
  size_t count(const std::string& event) const;
};

/// A site with a coordinator and one node, "arm-1", that is not started.
struct cell_fixture {
  virtual_time time;
  fake_site site{time, 1};
  fake_node& node;

  cell_fixture() : node(site.add_node("arm-1", "a-1")) {}

  /// Coordinator and node are there, and the node is a member.
  void form_cell() {
    site.start_coordinator();
    site.start(node);
    site.join(node);
    site.pass(1s);
  }

  member_actor member() {
    return site.base.rows.at(node.identity.name).member;
  }

  node_state state() {
    return site.status(node).state;
  }
};

node_resources some_resources(const std::string& node);
instance_spec some_spec(const std::string& instance, const std::string& task);
instance_row some_row(const std::string& instance, const std::string& task);

} // namespace roscell::test
