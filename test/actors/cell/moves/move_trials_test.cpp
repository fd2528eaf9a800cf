#include "test/actors/fakes/trial_node.hpp"

#include <cstdlib>
#include <iostream>

/// Random sites whose nodes are lost in the middle of everything, then calm.
/// Never two of a step run at once, as the programs themselves see it, and in
/// the end nothing hangs. A failure prints its seed; ROSCELL_SEED=N runs that
/// one alone and tells what happens, ROSCELL_MOVE_SEEDS=N runs so many,
/// ROSCELL_FIRST is the first one.
namespace roscell::test {

namespace {

/// What the suite runs.
constexpr unsigned move_seeds = 250;

class move_trial {
public:
  move_trial(uint32_t seed, bool reports) : site_(cell_, seed, reports) {
    cell_.base.has.cpu.used = 4;
    const auto count = 2 + pick(3);
    for (uint32_t i = 0; i < count; ++i)
      site_.add("n" + std::to_string(i)).join();
    const auto tasks = 1 + pick(4);
    for (uint32_t i = 0; i < tasks; ++i)
      post_task();
  }

  ~move_trial() {
    for (const auto& node : site_.nodes)
      node->drop_promises();
  }

  move_trial(const move_trial&) = delete;
  move_trial& operator=(const move_trial&) = delete;

  /// What is wrong in the end; empty: nothing.
  std::string run() {
    const auto events = 10 + pick(35);
    for (uint32_t i = 0; i < events && site_.fault.empty(); ++i) {
      disturb();
      site_.live(pause());
    }
    calm_down();
    return site_.fault.empty() ? left_over() : site_.fault;
  }

  size_t starts() const {
    return site_.starts;
  }

private:
  uint32_t pick(uint32_t end) {
    return site_.pick(end);
  }

  trial_node& some_node() {
    return *site_.nodes[pick(site_.nodes.size())];
  }

  std::string some_task() {
    return tasks_.empty() ? "t0" : tasks_[pick(tasks_.size())];
  }

  /// From nothing to beyond the longest fence.
  std::chrono::milliseconds pause() {
    constexpr uint32_t longest_ms[]{1, 1000, 5000, 12'000, 40'000, 320'000};
    const auto which = pick(12);
    return std::chrono::milliseconds{
        pick(longest_ms[which < 6 ? which : which % 4 + 1]) + 1};
  }

  double after_s() {
    constexpr double drawn[]{24, 30, 60, 120, 300};
    return pick(2) == 0 ? drawn[pick(5)] : 24 + pick(277);
  }

  json some_step(size_t i) {
    auto step = echo_step("s" + std::to_string(i), pick(5) == 0 ? 2 : 1);
    if (pick(3) == 0)
      step["operation"] = "grasp";
    if (pick(4) > 0) {
      const auto after = after_s();
      step["on_node_loss"] = {{"policy", "move"}, {"after_s", after}};
      if (step["operation"] == "grasp") {
        if (after < 26)
          step.erase("on_node_loss");
        else
          step["safe_timeout_s"] = 1 + pick(static_cast<uint32_t>(after) - 25);
      }
    }
    step["priority"] = pick(10);
    return step;
  }

  void post(const json& what) {
    site_.note("asked: " + what.dump());
    replies_.push_back({what.dump(), cell_.post(what)});
  }

  void post_task() {
    const auto task = "t" + std::to_string(tasks_.size());
    std::vector<json> steps;
    const auto count = 1 + pick(3);
    for (uint32_t i = 0; i < count; ++i)
      steps.push_back(some_step(i));
    auto request = echo_task(task, steps);
    if (pick(2) == 0)
      request["preempt"] = "yes";
    requests_[task] = request;
    tasks_.push_back(task);
    post(request);
  }

  /// A task of that name may run where a node is away, and nobody has said that
  /// it is off, where it says so.
  void post_again() {
    if (tasks_.empty())
      return;
    auto request = requests_.at(some_task());
    for (const auto& step : request.at("pipeline"))
      if (step.count("on_node_loss") == 0)
        return;
    request["request_id"] = "r" + std::to_string(replies_.size());
    post(request);
  }

  void post_termination() {
    post(termination(some_task(), pick(4) == 0));
  }

  void post_release() {
    auto& node = some_node();
    if (node.in_session())
      post({{"type", "node_release"},
            {"node", node.name()},
            {"instances", pick(3) == 0 ? "terminate" : "reschedule"}});
  }

  void lose_some() {
    some_node().cut(pick(2) == 0);
    if (pick(3) == 0) {
      site_.live(std::chrono::milliseconds{pick(9000) + 1});
      some_node().cut(pick(2) == 0);
    }
  }

  void find_some() {
    for (const auto& node : site_.nodes)
      if (!node->in_session() && pick(2) == 0)
        node->join();
  }

  void finish_some() {
    auto& node = some_node();
    if (!node.programs().empty() && pick(3) == 0)
      node.finish(node.programs().begin()->first);
  }

  void begin_anew() {
    if (pick(3) > 0)
      return;
    site_.note("the coordinator begins anew");
    // Each member loses its session with it.
    for (const auto& node : site_.nodes)
      node->cut(true);
    replies_.clear();
    cell_.begin_anew();
    site_.live(std::chrono::milliseconds{1});
  }

  void disturb() {
    switch (pick(20)) {
    case 0:
    case 1:
    case 2:
    case 3:
      return lose_some();
    case 4:
    case 5:
    case 6:
    case 7:
      return find_some();
    case 8:
    case 9:
      return post_task();
    case 10:
      return post_termination();
    case 11:
      return post_again();
    case 12:
      return post({{"type", "task_restart"}, {"task", some_task()}});
    case 13:
    case 14:
      return post({{"type", "node_drain"}, {"node", some_node().name()}});
    case 15:
      return post({{"type", "node_undrain"}, {"node", some_node().name()}});
    case 16:
      return post_release();
    case 17:
      return post({{"type", "cell_rebalance"}, {"min_gain", 0.001}});
    case 18:
      return finish_some();
    default:
      return begin_anew();
    }
  }

  /// All nodes are back, and no request takes longer.
  void calm_down() {
    if (!site_.fault.empty())
      return;
    site_.note("calm");
    for (const auto& node : site_.nodes)
      node->cut(true);
    site_.live(std::chrono::seconds{1});
    for (const auto& node : site_.nodes) {
      node->join();
      post({{"type", "node_undrain"}, {"node", node->name()}});
    }
    site_.live(std::chrono::hours{1});
  }

  std::string left_over() {
    for (const auto& [what, reply] : replies_)
      if (!*reply)
        return "no reply to " + what;
    const auto summary = cell_.request({{"type", "cell_query"}});
    for (const auto& node : summary.at("nodes"))
      if (node.at("state") == "departing")
        return "a node departs for ever: " + node.dump();
    const auto state = state_of_coordinator();
    for (const auto* what :
         {"moves", "orders", "unsafe", "placement_lock", "remains"})
      if (state.at(what) != 0)
        return std::string{what} + " are left over: " + state.dump();
    size_t programs = 0;
    for (const auto& node : site_.nodes)
      programs += node->programs().size();
    if (state.at("may_run") != programs)
      return "of " + std::to_string(programs)
             + " programs it is known: " + state.at("may_run").dump();
    return programs_left_over();
  }

  json state_of_coordinator() {
    auto reply = cell_.time.ask<actor_state>(cell_.coordinator, state_query{});
    cell_.time.settle();
    return json::parse((*reply)->value().json_text);
  }

  /// Each program is wanted, and each step that runs has one.
  std::string programs_left_over() {
    std::map<std::string, std::string> wanted;
    for (const auto& task : cell_.tasks())
      for (const auto& x : task.at("instances"))
        if (x.at("state") == "running")
          wanted[x.at("spec").at("instance")] = x.at("node");
    for (const auto& node : site_.nodes)
      for (const auto& [id, x] : node->programs()) {
        if (wanted.erase(id) == 0)
          return id + " runs on " + node->name()
                 + ", and nobody wants it: " + cell_.tasks().dump();
      }
    return wanted.empty() ? "" : wanted.begin()->first + " does not run";
  }

  paper_cell cell_;
  trial_site site_;
  std::vector<std::string> tasks_;
  std::map<std::string, json> requests_;
  std::vector<std::pair<std::string, pending_reply>> replies_;
};

unsigned number_of(const char* variable, unsigned otherwise) {
  const auto* text = std::getenv(variable);
  return text ? static_cast<unsigned>(std::stoul(text)) : otherwise;
}

} // namespace

TEST_CASE("Never two of a step run at once, whatever is lost and asked for",
          "[moves][random]") {
  const auto* one = std::getenv("ROSCELL_SEED");
  const auto first =
      one ? number_of("ROSCELL_SEED", 1) : number_of("ROSCELL_FIRST", 1);
  const auto count = one ? 1 : number_of("ROSCELL_MOVE_SEEDS", move_seeds);
  unsigned bad = 0;
  size_t starts = 0;
  for (unsigned i = 0; i < count; ++i) {
    move_trial trial{first + i, one != nullptr};
    const auto fault = trial.run();
    starts += trial.starts();
    if (fault.empty())
      continue;
    ++bad;
    std::cerr << "ROSCELL_SEED=" << first + i << " fails: " << fault
              << std::endl;
  }
  std::cerr << count << " seeds from " << first << ", " << starts << " starts, "
            << bad << " bad\n";
  CHECK(bad == 0);
}

} // namespace roscell::test
