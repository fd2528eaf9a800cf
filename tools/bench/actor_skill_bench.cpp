#include "actors/core/actor_context.hpp"
#include "embedding/skills/actor_runtime.hpp"
#include "messages/type_ids.hpp"

#include <caf/actor_system_config.hpp>
#include <caf/scoped_actor.hpp>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <future>
#include <iostream>
#include <string>
#include <vector>

/// Times actor skills: from the runtime's order to start to the instance that
/// says it is ready, and a frame from one instance to the next by the protocol
/// "actor". One JSON line a figure.
namespace {

using namespace roscell;
using clock_type = std::chrono::steady_clock;

struct quiet_config : caf::actor_system_config {
  quiet_config() {
    roscell::add_message_types(*this);
    set("scheduler.policy", caf::atom("sharing"));
    set("scheduler.max-threads", std::size_t{1});
    set("logger.verbosity", caf::atom("quiet"));
  }
};

void print(const std::string& what, double value) {
  std::cout << R"({"figure":")" << what << R"(","value":)" << value
            << R"(,"unit":"us"})" << std::endl;
}

double us(clock_type::duration x) {
  return std::chrono::duration<double, std::micro>{x}.count();
}

double quantile(std::vector<double> xs, double q) {
  std::sort(xs.begin(), xs.end());
  return xs[static_cast<std::size_t>(q * static_cast<double>(xs.size() - 1))];
}

/// Hears what the runtime tells of its instances.
struct listener_state {
  static constexpr const char* name = "listener";
};

using ready_word = std::promise<clock_type::time_point>;

container_listener_actor::behavior_type
listener(container_listener_actor::stateful_pointer<listener_state>,
         ready_word** next) {
  return {
      [](const container_exited&) {},
      [next](const instance_notified& x) {
        if (x.ready)
          (*next)->set_value(clock_type::now());
      },
      [](const runtime_problem_changed&) {},
  };
}

start_container order(const std::string& instance, const std::string& operation,
                      const std::string& in, const std::string& out) {
  const auto end = [](const std::string& name) {
    return R"([{"protocol":"actor","endpoint":")" + name
           + R"(","data_type":"text/plain"}])";
  };
  start_container result;
  result.instance = instance;
  result.image = "actor:" + operation;
  result.environment = {{"ROSCELL_MODEL", "m"},
                        {"ROSCELL_INPUTS", end(in)},
                        {"ROSCELL_OUTPUTS", end(out)}};
  return result;
}

actor_skill_instance::behavior_type idle(actor_skill_instance::pointer,
                                         const actor_skill_context& context) {
  context.ready();
  return {
      [](const skill_frame&) {},
      [](check_life) {},
      [](stop_skill) {},
  };
}

/// Passes a frame on, some number of times.
struct relay {
  int left = 0;
  std::promise<void>* done = nullptr;

  actor_skill_instance::behavior_type
  operator()(actor_skill_instance::pointer,
             const actor_skill_context& context) const {
    context.ready();
    auto rest = std::make_shared<int>(left);
    return {
        [context, rest, done = done](const skill_frame& x) {
          if (*rest == 0)
            return;
          if (--*rest == 0)
            done->set_value();
          context.emit(x.data);
        },
        [](check_life) {},
        [](stop_skill) {},
    };
  }
};

/// Gives the first frame of all.
actor_skill_instance::behavior_type
starter(actor_skill_instance::pointer, const actor_skill_context& context) {
  context.ready();
  engine::frame first;
  first.payload = std::string(4UL * 1024 * 1024, 'x');
  context.emit(std::move(first));
  return {
      [](const skill_frame&) {},
      [](check_life) {},
      [](stop_skill) {},
  };
}

class bench {
public:
  explicit bench(int frames)
      : nodes_(node_config_), workers_(skill_config_),
        self_(nodes_), context_{std::make_shared<actor_directory>(), {}} {
    embedding::actor_runtime_config config;
    config.context = context_;
    config.workers = &workers_;
    config.log_bytes = 65536;
    config.factories = {{"idle", idle},
                        {"ping", relay{frames, &passed_}},
                        {"pong", relay{frames + 1, &ignored_}},
                        {"starter", starter}};
    listener_ = spawn(nodes_, context_, listener, &next_);
    runtime_ = spawn<caf::detached>(nodes_, context_, embedding::actor_runtime,
                                    config, listener_);
  }

  ~bench() {
    self_->send_exit(listener_, caf::exit_reason::user_shutdown);
  }

  /// Microseconds from the order to READY.
  double start(const start_container& what) {
    ready_word ready;
    next_ = &ready;
    const auto begin = clock_type::now();
    self_->request(runtime_, std::chrono::seconds{10}, what)
        .receive([](const container_started&) {},
                 [&](const caf::error& why) {
                   throw std::runtime_error{nodes_.render(why)};
                 });
    return us(ready.get_future().get() - begin);
  }

  void remove(const std::string& instance) {
    self_
        ->request(runtime_, std::chrono::seconds{10},
                  remove_container{instance, {}})
        .receive([](const container_removed&) {}, [](const caf::error&) {});
  }

  void await_passed() {
    passed_.get_future().wait();
  }

private:
  quiet_config node_config_;
  quiet_config skill_config_;
  caf::actor_system nodes_;
  caf::actor_system workers_;
  caf::scoped_actor self_;
  actor_context context_;
  ready_word* next_ = nullptr;
  std::promise<void> passed_;
  std::promise<void> ignored_;
  container_listener_actor listener_;
  embedding::actor_runtime_actor runtime_;
};

void run(int starts, int frames) {
  bench site{frames};
  std::vector<double> times;
  for (int i = 0; i < starts; ++i) {
    times.push_back(site.start(order("i", "idle", "/a", "/b")));
    site.remove("i");
  }
  print("actor skill: order to ready, median", quantile(times, 0.5));
  print("actor skill: order to ready, p99", quantile(times, 0.99));
  site.start(order("ping", "ping", "/to_ping", "/to_pong"));
  site.start(order("pong", "pong", "/to_pong", "/to_ping"));
  const auto begin = clock_type::now();
  site.start(order("starter", "starter", "/none", "/to_ping"));
  site.await_passed();
  print("a frame of 4 MiB from actor to actor",
        us(clock_type::now() - begin) / (2.0 * frames));
}

} // namespace

int main(int argc, char** argv) {
  int starts = 1000;
  int frames = 20'000;
  CLI::App app{"Times actor skills."};
  app.add_option("--starts", starts)->capture_default_str();
  app.add_option("--frames", frames)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  run(starts, frames);
  return 0;
}
