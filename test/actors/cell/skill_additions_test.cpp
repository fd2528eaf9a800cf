#include "actors/builds/build_permits.hpp"
#include "test/actors/fakes/coordinator_fakes.hpp"

/// Builds that somebody adds to a cell.
namespace roscell::test {

namespace {

const std::string shout_hash(64, 'c');

installed_skill shout_skill(const std::string& hash = shout_hash) {
  auto result = echo_skill();
  result.hash = hash;
  result.version = "1.0";
  result.descriptor.operation = "shout";
  result.architectures = {"amd64"};
  return result;
}

/// Two members, and a skill that no node has as a folder.
struct shared_cell : paper_cell {
  fake_agent& arm = add("arm");
  fake_agent& leg = add("leg");
  std::string signature;

  shared_cell() {
    kept_builds[shout_hash] = shout_skill();
  }

  json addition_of(const std::string& node = "arm",
                   const std::string& hash = shout_hash) {
    return message_json(skill_addition{{hash, hash, 7}, node, signature});
  }

  json add_skill(const std::string& node = "arm",
                 const std::string& hash = shout_hash) {
    return request(addition_of(node, hash));
  }

  json listed() {
    return request({{"type", "skill_query"}}).value("builds", json::array());
  }

  json run_shout(const std::string& node) {
    auto step = echo_step("s0", 1, node);
    step["operation"] = "shout";
    return request(echo_task("t", {step}));
  }
};

} // namespace

TEST_CASE_METHOD(shared_cell, "A brief list leaves out the models of builds",
                 "[builds]") {
  add_skill();
  const auto models = [this](bool brief) {
    return request({{"type", "skill_query"}, {"brief", brief}})
        .at("builds")[0]
        .at("skill")
        .at("descriptor")
        .at("models");
  };
  CHECK_FALSE(models(false).empty());
  CHECK(models(true).empty());
}

TEST_CASE_METHOD(shared_cell,
                 "A skill is added once two nodes keep it and it is written "
                 "down",
                 "[builds]") {
  const auto reply = add_skill();
  REQUIRE(reply.at("type") == "skill_added");
  CHECK(reply.at("added").at("keepers") == json{"base", "arm"});
  REQUIRE(base.keepings.size() == 1);
  CHECK(base.keepings[0].offer.sources.front().node == "arm");
  REQUIRE(arm.keepings.size() == 1);
  CHECK(leg.keepings.empty());
  CHECK(builds.count(shout_hash) == 1);
  CHECK(listed().size() == 1);
  CHECK(count("cell_skill_added") == 1);
}

TEST_CASE_METHOD(shared_cell,
                 "A cell that asks for signatures places nothing unsigned",
                 "[builds]") {
  add_skill();
  require_signed_skills = true;
  begin_anew();
  REQUIRE(enter(arm));
  REQUIRE(enter(leg));
  // What was added before, and what lies on nodes.
  CHECK(run_shout("arm").at("type") == "error");
  CHECK(request(echo_task("u", {echo_step("s0", 1, "arm")})).at("type")
        == "error");
  CHECK(add_skill().at("error").at("code") == "unauthorized");
  signature = "eve " + shout_hash;
  CHECK(add_skill().at("error").at("code") == "unauthorized");
  signature = "ada " + shout_hash;
  CHECK(add_skill().at("added").at("signed_by")
        == "spiffe://hall/operator/ada/0a");
  CHECK(builds.at(shout_hash).at("signed_by")
        == "spiffe://hall/operator/ada/0a");
  CHECK(run_shout("arm").at("type") != "error");
}

TEST_CASE_METHOD(shared_cell,
                 "A signature that is none is refused wherever it comes",
                 "[builds]") {
  signature = "eve " + shout_hash;
  CHECK(add_skill().at("error").at("code") == "unauthorized");
  CHECK(listed().empty());
  signature = "ada " + shout_hash;
  CHECK(add_skill().at("added").at("signed_by")
        == "spiffe://hall/operator/ada/0a");
}

TEST_CASE_METHOD(shared_cell, "The same skill again changes nothing",
                 "[builds]") {
  add_skill();
  const auto reply = add_skill("leg");
  CHECK(reply.at("added").at("keepers") == json{"base", "arm"});
  CHECK(base.keepings.size() == 1);
  CHECK(leg.keepings.empty());
}

TEST_CASE_METHOD(shared_cell,
                 "Where one node cannot keep the second copy another one does",
                 "[builds]") {
  arm.gets_nothing = true;
  CHECK(add_skill().at("added").at("keepers") == json{"base", "leg"});
}

TEST_CASE_METHOD(shared_cell, "What no second node can keep is not added",
                 "[builds]") {
  arm.gets_nothing = leg.gets_nothing = true;
  CHECK(error_of(add_skill()) == "unreachable");
  CHECK(listed().empty());
  CHECK(builds.empty());
  // What may have come to them goes.
  CHECK(arm.releases == std::vector<std::string>{shout_hash});
  CHECK(leg.releases == std::vector<std::string>{shout_hash});
  CHECK(remains.empty());
}

TEST_CASE_METHOD(shared_cell,
                 "That a node may keep a build is written down before it does, "
                 "for a coordinator that ends meanwhile",
                 "[builds]") {
  json written;
  arm.on_keeping = [&] { written = remains.at(shout_hash).at("nodes"); };
  REQUIRE(add_skill().at("type") == "skill_added");
  CHECK(written == json::array({"arm"}));
  CHECK(remains.empty());
  CHECK(arm.releases.empty());
}

TEST_CASE_METHOD(shared_cell,
                 "A build that is being added is not added by another at once",
                 "[builds]") {
  slow_disk = true;
  const auto first = post(addition_of());
  CHECK(error_of(reply_of(post(addition_of("leg")))) == "conflict");
  slow_disk = false;
  finish_writes();
  time.settle();
  CHECK(reply_of(first).at("type") == "skill_added");
  CHECK(arm.releases.empty());
  CHECK(add_skill("leg").at("type") == "skill_added");
}

TEST_CASE_METHOD(shared_cell, "What was not added can be added again",
                 "[builds]") {
  arm.gets_nothing = leg.gets_nothing = true;
  add_skill();
  arm.gets_nothing = false;
  CHECK(add_skill().at("type") == "skill_added");
}

TEST_CASE_METHOD(shared_cell, "What cannot be written down is not added",
                 "[builds]") {
  disk_full = true;
  CHECK(error_of(add_skill()) == "internal");
  CHECK(listed().empty());
}

TEST_CASE_METHOD(shared_cell, "What is no skill is not added", "[builds]") {
  CHECK(error_of(add_skill("arm", std::string(64, 'b'))) == "schema_violation");
  CHECK(arm.keepings.empty());
  CHECK(listed().empty());
}

TEST_CASE_METHOD(shared_cell, "Another build of a version is refused",
                 "[builds]") {
  add_skill();
  const std::string other(64, 'b');
  kept_builds[other] = shout_skill(other);
  CHECK(error_of(add_skill("arm", other)) == "conflict");
  CHECK(listed().size() == 1);
}

TEST_CASE_METHOD(shared_cell,
                 "A node that lacks the build is told who gives it, by permits "
                 "for it alone",
                 "[builds]") {
  add_skill();
  const auto reply = run_shout("leg");
  INFO(reply.dump());
  REQUIRE(reply.at("type") == "task_accepted");
  REQUIRE(leg.fetches.size() == 1);
  const auto& offer = leg.fetches[0];
  CHECK(offer.build.hash == shout_hash);
  std::set<std::string> givers;
  std::set<std::string> permits;
  for (const auto& x : offer.sources) {
    givers.insert(x.node);
    permits.insert(x.permit);
  }
  CHECK(givers == std::set<std::string>{"arm", "base"});
  CHECK(permits.size() == 2);
  CHECK(
      permits.count(build_permits::sign("key of base", shout_hash, "10.0.0.9"))
      == 1);
  CHECK(reply.at("allocations")[0].at("fetch_mib") > 0);
}

TEST_CASE_METHOD(shared_cell,
                 "Of nodes that are alike one that has the build is taken",
                 "[builds]") {
  auto& lacking = add("aaa");
  add_skill();
  const auto reply = run_shout("");
  INFO(reply.dump());
  REQUIRE(reply.at("type") == "task_accepted");
  CHECK(lacking.deployments.empty());
  CHECK(reply.at("allocations")[0].value("fetch_mib", 0.0) == 0);
}

TEST_CASE_METHOD(shared_cell,
                 "A node of an earlier version gets no build and no step of it",
                 "[builds]") {
  auto& old = make_agent("old");
  old.fetches_builds = false;
  REQUIRE(enter(old));
  add_skill();
  CHECK(error_of(run_shout("old")) == "no_feasible_allocation");
}

TEST_CASE_METHOD(shared_cell,
                 "A node of another architecture is no place for it",
                 "[builds]") {
  kept_builds[shout_hash].architectures = {"arm64"};
  add_skill();
  CHECK(error_of(run_shout("leg")) == "no_feasible_allocation");
}

TEST_CASE_METHOD(shared_cell, "What runs is not removed", "[builds]") {
  add_skill();
  run_shout("leg");
  const auto removal = json{{"type", "skill_removal"}, {"operation", "shout"}};
  CHECK(error_of(request(removal)) == "conflict");
  CHECK(listed().size() == 1);
  request(termination("t"));
  CHECK(request(removal).at("removed").size() == 1);
  CHECK(listed().empty());
  CHECK(builds.empty());
  CHECK(arm.releases == std::vector<std::string>{shout_hash});
  CHECK(dropped_builds == std::vector<std::string>{shout_hash});
  CHECK(error_of(request(removal)) == "unknown_operation");
}

TEST_CASE_METHOD(shared_cell,
                 "A node that was away lets go what was removed meanwhile",
                 "[builds]") {
  add_skill();
  lose(arm);
  request({{"type", "skill_removal"}, {"operation", "shout"}});
  CHECK(arm.releases.empty());
  begin_anew();
  REQUIRE(enter(arm));
  CHECK(arm.releases == std::vector<std::string>{shout_hash});
}

TEST_CASE_METHOD(
    shared_cell,
    "A build is told of with what runs of it and where it comes to",
    "[builds]") {
  add_skill();
  CHECK_FALSE(listed().at(0).contains("instances"));
  run_shout("leg");
  CHECK(listed().at(0).at("instances") == 1);
  CHECK(listed().at(0).at("coming_to") == json{"leg"});
}

TEST_CASE_METHOD(shared_cell,
                 "Who pulls a skill keeps it no longer than others",
                 "[builds]") {
  add_skill();
  json pull{{"type", "skill_pull"}, {"operation", "shout"}, {"node", "leg"}};
  CHECK(request(pull).at("pulled").at("build").at("hash") == shout_hash);
  REQUIRE(leg.keepings.size() == 1);
  CHECK_FALSE(leg.keepings[0].pinned);
  CHECK(leg.keepings[0].offer.sources.size() == 2);
  CHECK(listed().at(0).at("keepers") == json{"base", "arm"});
  pull["build"] = "bbbbbbbb";
  CHECK(error_of(request(pull)) == "unknown_operation");
  pull["build"] = shout_hash.substr(0, 8);
  pull["node"] = "nobody";
  CHECK(error_of(request(pull)) == "unknown_node");
}

TEST_CASE_METHOD(shared_cell,
                 "The cell's skills outlive a restart of its coordinator",
                 "[builds]") {
  add_skill();
  begin_anew();
  CHECK(listed().size() == 1);
  REQUIRE(enter(leg));
  CHECK(run_shout("leg").at("type") == "task_accepted");
}

TEST_CASE_METHOD(shared_cell,
                 "A node that is not of the cell has nothing to "
                 "add",
                 "[builds]") {
  CHECK(error_of(add_skill("nobody")) == "unknown_node");
}

TEST_CASE_METHOD(shared_cell,
                 "A newer build is at the node before a step ends for it",
                 "[builds][task_updates]") {
  add_skill();
  REQUIRE(run_shout("leg").at("type") == "task_accepted");
  const std::string newer(64, 'd');
  kept_builds[newer] = shout_skill(newer);
  kept_builds[newer].version = "1.1";
  REQUIRE(add_skill("arm", newer).at("type") == "skill_added");
  auto step = echo_step("s0", 1, "leg");
  step["operation"] = "shout";
  auto document = echo_task("t", {step});
  document["type"] = "task_update";
  const auto with = [&](const char* option) {
    auto result = document;
    result[option] = true;
    return request(result);
  };
  CHECK(with("keep_builds").at("outcome") == "unchanged");
  CHECK(with("dry_run").at("changes")[0].at("reasons").size() == 1);
  // It does not come: nothing has ended for it.
  leg.gets_nothing = true;
  const auto old = leg.running.begin()->first;
  REQUIRE(request(document).at("outcome") == "begun");
  time.advance(11s);
  CHECK(leg.running.count(old) == 1);
  CHECK(leg.deployments.size() == 1);
  leg.gets_nothing = false;
  bool was_running = false;
  leg.on_keeping = [&] { was_running = leg.running.count(old) == 1; };
  REQUIRE(request(document).at("outcome") == "begun");
  time.advance(11s);
  CHECK(was_running);
  REQUIRE(leg.running.size() == 1);
  CHECK(leg.running.begin()->second.spec.skill == newer);
  CHECK(leg.keepings.back().offer.build.hash == newer);
  CHECK_FALSE(leg.keepings.back().pinned);
}

} // namespace roscell::test
