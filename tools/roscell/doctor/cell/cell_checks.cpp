#include "tools/roscell/doctor/cell/cell_checks.hpp"

#include "messages/cell.hpp"
#include "tools/roscell/doctor/cell/cell_findings.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/doctor/node/asked_nodes.hpp"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

namespace roscell::cli {

namespace {

using std::chrono::system_clock;

/// As many goals as a question may have.
constexpr size_t most_goals = 64;

/// What is pasted here, so that it is done on the host where it was found.
std::string remedy_there(const reach_opened& host, const finding& x) {
  if (x.remedy.empty())
    return {};
  return on_host(host_of(host), x.remedy.size() <= longest_remedy
                                    ? x.remedy
                                    : remedies_of("roscell doctor", x.check));
}

/// The look at one cell, in the order in which it is done.
class cell_check_run {
public:
  cell_check_run(const node_client& node, const check_progress& report_progress)
      : node_(node), report_progress_(report_progress) {}

  findings all(const std::string& own) {
    find_nodes();
    if (names_.empty())
      return std::move(found_);
    open_ports();
    add(judge_versions(cell_));
    add(judge_clocks(clocks_, cell_));
    try_pairs();
    check_hosts(own);
    return std::move(found_);
  }

private:
  void add(findings more) {
    for (auto& x : more)
      found_.push_back(std::move(x));
  }

  void find_nodes() {
    try {
      const auto reported = node_.ask({{"type", "cell_query"}}, answer_limit)
                                .get<cell_description>();
      cell_.coordinator = reported.coordinator;
      for (const auto& x : reported.nodes)
        if (x.state == row_state::active)
          names_.push_back(x.identity.name);
    } catch (const std::exception& e) {
      add({named_finding("reach", "cell",
                         finding_of_failure(e, judgement::broken))});
    }
  }

  void open_ports() {
    report_progress_("asking " + std::to_string(names_.size()) + " nodes");
    // One after the other: the time of each answer tells of its clock.
    for (const auto& name : names_) {
      const auto sent = system_clock::now();
      const auto x =
          ask_node<reach_opened>(node_, name, {{"type", reach_opening::type}});
      const auto came = system_clock::now();
      if (!x.problem.seen.empty()) {
        add({named_finding("reach", "cell", x.problem)});
        continue;
      }
      cell_.nodes[name] = x.reply;
      note_clock(x.reply, sent, came);
    }
  }

  void note_clock(const reach_opened& x, system_clock::time_point sent,
                  system_clock::time_point came) {
    using milliseconds = std::chrono::duration<double, std::milli>;
    const auto half = milliseconds{came - sent}.count() / 2;
    const auto middle = milliseconds{sent.time_since_epoch()}.count() + half;
    clocks_.push_back(
        {x.node, static_cast<double>(x.clock_unix_us) / 1000 - middle, half});
  }

  /// What a node is to reach: all the others.
  std::vector<json> questions_of(const std::string& name) const {
    std::vector<json> result;
    for (const auto& [other, x] : cell_.nodes) {
      if (other == name)
        continue;
      if (result.empty() || result.back().at("goals").size() == most_goals)
        result.push_back(
            {{"type", reach_query::type}, {"goals", json::array()}});
      result.back()["goals"].push_back(
          reach_goal{other, x.address, x.discovery_server, x.data_port});
    }
    return result;
  }

  std::vector<std::string> answering() const {
    std::vector<std::string> result;
    for (const auto& [name, x] : cell_.nodes)
      result.push_back(name);
    return result;
  }

  void try_pairs() {
    const auto names = answering();
    if (names.size() < 2)
      return;
    report_progress_("trying each way between "
                     + std::to_string(names.size() * (names.size() - 1))
                     + " pairs");
    const auto reported = ask_all(names, [this](const std::string& name) {
      answer_of<reach_report> all;
      all.node = all.reply.node = name;
      for (const auto& question : questions_of(name)) {
        auto x = ask_node<reach_report>(node_, name, question);
        if (!x.problem.seen.empty())
          return x;
        for (auto& row : x.reply.rows)
          all.reply.rows.push_back(std::move(row));
      }
      return all;
    });
    for (const auto& x : reported)
      add(x.problem.seen.empty()
              ? judge_reach(x.reply, cell_)
              : findings{named_finding("reach", "cell", x.problem)});
  }

  void check_hosts(const std::string& own) {
    auto names = answering();
    names.erase(std::remove(names.begin(), names.end(), own), names.end());
    if (names.empty())
      return;
    report_progress_("checking " + std::to_string(names.size()) + " hosts");
    for (auto& x : ask_all(names, [this](const std::string& name) {
           return ask_node<examination>(node_, name,
                                        {{"type", examination_query::type}});
         })) {
      if (!x.problem.seen.empty())
        x.reply.found = {named_finding("host", "cell", x.problem)};
      for (auto& one : x.reply.found) {
        one.node = x.node;
        one.remedy = remedy_there(cell_.nodes.at(x.node), one);
        found_.push_back(std::move(one));
      }
    }
  }

  const node_client& node_;
  const check_progress& report_progress_;
  std::vector<std::string> names_; ///< Of all that are there.
  reached_cell cell_;
  std::vector<clock_reading> clocks_;
  findings found_;
};

} // namespace

const std::vector<check>& cell_checks() {
  static const std::vector<check> all{
      {"reach", "cell", "each node reaches each other by all its ports", {}},
      {"cell-clocks", "cell", "how far the nodes' clocks differ", {}},
      {"cell-versions", "cell", "all nodes are of one version", {}},
  };
  return all;
}

bool is_cell_check(const std::string& name) {
  const auto& all = cell_checks();
  return std::any_of(all.begin(), all.end(),
                     [&](auto& x) { return name == x.name; });
}

findings check_cell(const node_client& node, const std::string& own,
                    const std::vector<std::string>& only,
                    const check_progress& report_progress) {
  auto found = cell_check_run{node, report_progress}.all(own);
  const auto is_unwanted = [&](const finding& x) {
    return !only.empty() && x.how != judgement::broken
           && std::find(only.begin(), only.end(), x.check) == only.end();
  };
  found.erase(std::remove_if(found.begin(), found.end(), is_unwanted),
              found.end());
  return found;
}

} // namespace roscell::cli
