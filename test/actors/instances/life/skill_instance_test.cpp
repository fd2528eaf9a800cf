#include "actors/instances/life/skill_instance.hpp"
#include "actors/instances/limits.hpp"

#include "actors/instances/life/instance_text.hpp"
#include "messages/failure.hpp"
#include "test/actors/fakes/instance_bench.hpp"

#include <string>

using namespace roscell;
using namespace roscell::test;
using namespace std::chrono_literals;

namespace {

using words = std::vector<std::string>;

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

} // namespace

TEST_CASE("the intent is on disk before anything is started") {
  instance_bench b;
  b.store->error = fail(error_code::internal, "disk full");
  b.start();
  CHECK(b.state() == instance_state::failed);
  CHECK(contains(b.reason(), "disk full"));
  CHECK(b.runtime->prepared.empty());
  CHECK(b.runtime->started.empty());
}

TEST_CASE("an instance goes from intent to running in the order drawn") {
  ready_bench b;
  CHECK(b.reported->states()
        == words{"pending", "building", "starting", "starting", "running"});
  CHECK(b.reported->last().container == "c1");
  CHECK(b.store->states("i") == words{"pending", "starting", "running"});
}

TEST_CASE("nothing is built for a runtime that needs no image") {
  instance_bench b;
  b.config.builds_images = false;
  b.start_ready();
  CHECK(b.reported->states()
        == words{"pending", "starting", "starting", "running"});
}

TEST_CASE("a program that is ready before the runtime answers is running") {
  instance_bench b;
  b.runtime->silent = true;
  b.start_ready();
  CHECK(b.state() == instance_state::starting);
  b.answer_start();
  CHECK(b.state() == instance_state::running);
  CHECK(b.reported->last().container == "c1");
}

TEST_CASE("an image that cannot be made ends the instance without a start") {
  instance_bench b;
  b.runtime->prepare_error = fail(error_code::engine_failed, "no base image");
  b.start();
  CHECK(b.state() == instance_state::failed);
  CHECK(contains(b.reason(), "no base image"));
  CHECK(b.runtime->started.empty());
}

TEST_CASE("the end of a failed build's log goes along with the failure") {
  instance_bench b;
  b.runtime->prepare_error =
      to_error({error_code::engine_failed,
                "the build failed",
                {},
                {},
                R"({"log_tail":"Step 2/5 : COPY opt /opt\n"})"});
  b.runtime->log.clear();
  b.start();
  CHECK(b.reported->last().state == instance_state::failed);
  CHECK(b.reported->last().log_tail == "Step 2/5 : COPY opt /opt\n");
}

TEST_CASE("a start that fails is cleaned up and told") {
  instance_bench b;
  b.runtime->start_error = fail(error_code::engine_failed, "no such file");
  b.start();
  CHECK(b.state() == instance_state::failed);
  CHECK(contains(b.reason(), "no such file"));
  CHECK(b.runtime->stopped.size() == 1);
}

TEST_CASE("a runtime that does not answer a start is given up") {
  instance_bench b;
  b.runtime->silent = true;
  b.start();
  b.advance(29s);
  CHECK(b.state() == instance_state::starting);
  b.advance(2s);
  CHECK(b.state() == instance_state::failed);
  CHECK(b.runtime->stopped.size() == 1);
}

TEST_CASE("a program that is not ready in time is ended and its log told") {
  instance_bench b;
  b.start();
  b.advance(29s);
  CHECK(b.state() == instance_state::starting);
  b.advance(2s);
  CHECK(b.state() == instance_state::failed);
  CHECK(b.reason() == "it was not ready within 30 s");
  CHECK(b.reported->last().log_tail == "first line\nlast line\n");
}

TEST_CASE("signs of life keep a program, silence ends it by force at once") {
  ready_bench b;
  for (int i = 0; i < 5; ++i) {
    b.advance(limits::instance::watchdog - 1s);
    b.alive();
  }
  CHECK(b.state() == instance_state::running);
  CHECK(b.runtime->stopped.empty());
  b.advance(limits::instance::watchdog + 1s);
  CHECK(b.state() == instance_state::failed);
  CHECK(contains(b.reason(), "no sign of life"));
  REQUIRE(b.runtime->stopped.size() == 1);
  CHECK(b.runtime->stopped[0].grace_ms == 0);
}

TEST_CASE("words that wait at the socket are heard before a skill is judged") {
  ready_bench b;
  b.runtime->words.alive = true;
  b.advance(limits::instance::watchdog + 1s);
  CHECK(b.state() == instance_state::running);
  CHECK(b.runtime->heard.size() == 1);
  // Only once: the next silence counts from there.
  b.advance(limits::instance::watchdog);
  CHECK(b.state() == instance_state::failed);
}

TEST_CASE("a node that was stopped does not take that for a skill's silence") {
  ready_bench b;
  b.jump(30s);
  SECTION("the skill goes on, too: its words come soon") {
    CHECK(b.state() == instance_state::running);
    b.advance(4s);
    b.alive();
    b.advance(9s);
    CHECK(b.state() == instance_state::running);
  }
  SECTION("the skill hangs: it is given a moment, once") {
    b.advance(4s);
    CHECK(b.state() == instance_state::running);
    b.jump(30s);
    CHECK(b.state() == instance_state::failed);
  }
}

TEST_CASE("a runtime that cannot be asked says nothing about a skill") {
  ready_bench b;
  b.runtime->deaf = true;
  b.advance(60s);
  CHECK(b.state() == instance_state::running);
  b.runtime->deaf = false;
  b.advance(20s);
  CHECK(b.state() == instance_state::failed);
}

TEST_CASE("a skill whose READY=1 waits at the socket is ready") {
  instance_bench b;
  b.start();
  b.runtime->words.ready = true;
  b.advance(limits::instance::ready + 1s);
  CHECK(b.state() == instance_state::running);
}

TEST_CASE("what a program's end means depends on its state and code") {
  instance_bench b;
  auto last = instance_state::failed;
  SECTION("running, 0: it has finished") {
    b.start_ready();
    b.exits(0);
    last = instance_state::stopped;
    CHECK(b.reason() == "finished");
  }
  SECTION("running, not 0: it has failed") {
    b.start_ready();
    b.exits(3);
    CHECK(contains(b.reason(), "exit code 3"));
  }
  SECTION("starting, 0: it was never ready") {
    b.start();
    b.exits(0);
    CHECK(contains(b.reason(), "before it was ready"));
  }
  SECTION("starting, not 0: it has said why") {
    b.start();
    b.exits(2);
    CHECK(b.reason()
          == "it ended with exit code 2 before it was ready: last line");
  }
  CHECK(b.state() == last);
  CHECK(b.store->states("i").back() == to_string(last));
}

TEST_CASE("the end of an earlier container is not this one's") {
  ready_bench b;
  b.exits(1, "c0");
  CHECK(b.state() == instance_state::running);
}

TEST_CASE("a stop before the container exists starts nothing") {
  instance_bench b;
  b.instance = roscell::spawn(b.system, b.context, skill_instance, b.config);
  b.stop();
  CHECK(b.state() == instance_state::stopped);
  CHECK(b.runtime->started.empty());
  CHECK(b.runtime->stopped.empty());
}

TEST_CASE("a stop during the start ends what the start has made") {
  instance_bench b;
  b.runtime->silent = true;
  b.start();
  b.stop();
  REQUIRE(b.runtime->stopped.size() == 1);
  CHECK(b.runtime->stopped[0].instance == "i");
  CHECK(b.state() == instance_state::stopped);
  // The late answer is of a start that nobody wants any more.
  b.answer_start();
  CHECK(b.state() == instance_state::stopped);
}

TEST_CASE("a stop is polite, and repeated ones are the same stop") {
  ready_bench b;
  b.runtime->stops_never = true;
  b.stop("task ended");
  b.stop("again");
  CHECK(b.state() == instance_state::stopping);
  REQUIRE(b.runtime->stopped.size() == 1);
  CHECK(b.runtime->stopped[0].grace_ms == 5000);
  b.exits(0);
  CHECK(b.state() == instance_state::stopping);
  CHECK(b.reason() == "task ended");
}

TEST_CASE("a stop that is repeated by force has no more grace") {
  ready_bench b;
  b.runtime->stops_never = true;
  b.stop();
  b.stop_by_force();
  REQUIRE(b.runtime->stopped.size() == 2);
  CHECK(b.runtime->stopped[0].grace_ms == 5000);
  CHECK(b.runtime->stopped[1].grace_ms == 0);
  CHECK(b.runtime->stopped[1].container == b.runtime->stopped[0].container);
  CHECK(b.state() == instance_state::stopping);
}

TEST_CASE("a program that cannot be ended is told as failed") {
  ready_bench b;
  b.runtime->stop_error = fail(error_code::engine_failed, "it is a zombie");
  b.stop();
  CHECK(b.state() == instance_state::failed);
  CHECK(contains(b.reason(), "it is a zombie"));
}

TEST_CASE("a running program is adopted without a restart") {
  instance_bench b;
  b.adopt_as(instance_state::running, {true, "c1", -1});
  CHECK(b.state() == instance_state::running);
  CHECK(b.runtime->prepared.empty());
  b.advance(limits::instance::watchdog + 1s);
  CHECK(b.state() == instance_state::failed);
}

TEST_CASE("a program adopted while it starts is running once it says so") {
  instance_bench b;
  b.adopt_as(instance_state::starting, {true, "c1", -1});
  CHECK(b.state() == instance_state::starting);
  b.ready();
  CHECK(b.state() == instance_state::running);
  CHECK(b.runtime->started.empty());
}

TEST_CASE("a stop is on disk while it lasts, and a restart carries it on") {
  ready_bench b;
  b.runtime->stops_never = true;
  b.stop();
  CHECK(b.store->states("i").back() == "stopping");
}

TEST_CASE("a stop that a restart has interrupted is carried on") {
  instance_bench b;
  b.adopt_as(instance_state::stopping, {true, "c1", -1});
  CHECK(b.state() == instance_state::stopped);
  CHECK(b.runtime->stopped.size() == 1);
}

TEST_CASE("a program that ended while the node was away is told by its code") {
  instance_bench b;
  SECTION("well") {
    b.adopt_as(instance_state::running, {false, "c1", 0});
    CHECK(b.state() == instance_state::stopped);
  }
  SECTION("badly") {
    b.adopt_as(instance_state::running, {false, "c1", 5});
    CHECK(b.state() == instance_state::failed);
    CHECK(contains(b.reason(), "while the node was away"));
  }
  CHECK(b.runtime->started.empty());
}

TEST_CASE("an intent without a program is begun anew") {
  instance_bench b;
  b.adopt_as(instance_state::pending, {});
  b.ready();
  CHECK(b.state() == instance_state::running);
  CHECK(b.runtime->started.size() == 1);
}

TEST_CASE("a skill that has gone is told, and nothing is started") {
  instance_bench b;
  b.config.row.spec.skill = std::string(64, 'a');
  b.start();
  CHECK(b.state() == instance_state::failed);
  CHECK(contains(b.reason(), "does not have its skill"));
  CHECK(b.runtime->prepared.empty());
}

TEST_CASE("the program outlives the supervisor of its instance") {
  ready_bench b;
  b.kill(b.config.supervisor);
  CHECK(b.runtime->stopped.empty());
}
