#include "actors/core/actor_context.hpp"

#include "test/fixture.hpp"

#include <caf/actor_system_config.hpp>
#include <caf/scoped_actor.hpp>

#include <condition_variable>
#include <memory>
#include <mutex>
#include <set>
#include <thread>

namespace roscell::test {

namespace {

using namespace std::chrono_literals;

using blocked_actor = caf::typed_actor<caf::replies_to<int>::with<int>>;

/// Who works, and on which threads; they go on when they are let go.
class gate : public std::enable_shared_from_this<gate> {
public:
  void pass(bool blocks) {
    report_thread_end();
    std::unique_lock lock{mutex_};
    threads_.insert(std::this_thread::get_id());
    ++within_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return !blocks || open_; });
    --within_;
  }

  bool await(size_t within) {
    std::unique_lock lock{mutex_};
    return changed_.wait_for(lock, 20s, [&] { return within_ >= within; });
  }

  /// Until `is_so`, which is looked at when a thread has ended.
  template <class Predicate>
  bool await_ends(Predicate&& is_so) {
    std::unique_lock lock{mutex_};
    return changed_.wait_for(lock, 20s, is_so);
  }

  void open() {
    const std::lock_guard lock{mutex_};
    open_ = true;
    changed_.notify_all();
  }

  size_t threads() {
    const std::lock_guard lock{mutex_};
    return threads_.size();
  }

private:
  /// The present thread says when it ends, which may be after the test has.
  void report_thread_end() {
    struct last_word {
      std::shared_ptr<gate> at;

      ~last_word() {
        const std::lock_guard lock{at->mutex_};
        at->changed_.notify_all();
      }
    };
    thread_local const last_word at_end{shared_from_this()};
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
  size_t within_ = 0;
  std::set<std::thread::id> threads_;
};

struct blocked_state {
  static constexpr const char* name = "blocked";
};

/// Blocks at the gate for each odd number.
blocked_actor::behavior_type
blocked(blocked_actor::stateful_pointer<blocked_state>, gate* at) {
  return {[at](int x) {
    at->pass(x % 2 != 0);
    return x;
  }};
}

struct on_blocking_threads {
  on_blocking_threads() {
    config.set("scheduler.policy", caf::atom("sharing"));
    config.set("scheduler.max-threads", size_t{1});
    system = std::make_unique<caf::actor_system>(config);
    context.directory = std::make_shared<actor_directory>();
    context.blocking = std::make_shared<blocking_threads>(*system);
  }

  blocked_actor start() {
    return spawn_blocking(*system, context, blocked, at.get());
  }

  /// What the actor answers; -1: nothing in time.
  int ask(const blocked_actor& whom, int x) {
    caf::scoped_actor self{*system};
    int result = -1;
    self->request(whom, 20s, x)
        .receive([&](int y) { result = y; }, [](const caf::error&) {});
    return result;
  }

  bool becomes(size_t threads) {
    return at->await_ends([&] { return context.blocking->size() == threads; });
  }

  caf::actor_system_config config;
  actor_context context;
  std::shared_ptr<gate> at = std::make_shared<gate>();
  std::unique_ptr<caf::actor_system> system; // Ends first.
};

/// Is to be resumed again each time before its thread has let go of it, as an
/// actor whose message comes in that moment; blocks the last time.
struct busy_job : caf::resumable, caf::ref_counted {
  busy_job(std::shared_ptr<blocking_threads> t, std::shared_ptr<gate> g)
      : threads{std::move(t)}, at{std::move(g)} {
    // nop
  }

  void exec() {
    ref();
    threads->exec_later(this);
  }

  resume_result resume(caf::execution_unit*, size_t) override {
    if (--left > 0) {
      at->pass(false);
      exec();
    } else {
      at->pass(true);
    }
    return awaiting_message;
  }

  void intrusive_ptr_add_ref_impl() override {
    ref();
  }

  void intrusive_ptr_release_impl() override {
    deref();
  }

  std::shared_ptr<blocking_threads> threads;
  std::shared_ptr<gate> at;
  int left = 100;
};

} // namespace

TEST_CASE("an actor that hangs on a disk holds up no other, and no worker",
          "[blocking]") {
  on_blocking_threads x;
  const auto first = x.start();
  const auto second = x.start();
  caf::anon_send(first, 1);
  caf::anon_send(second, 1);
  REQUIRE(x.at->await(2));
  // The one worker of the scheduler answers, and so does a third.
  const auto scheduled = spawn(*x.system, x.context, blocked, x.at.get());
  CHECK(x.ask(scheduled, 2) == 2);
  CHECK(x.ask(x.start(), 4) == 4);
  x.at->open();
  CHECK(x.ask(first, 2) == 2);
}

TEST_CASE("actors that block now and then keep one thread among them",
          "[blocking]") {
  on_blocking_threads x;
  std::vector<blocked_actor> actors;
  for (int i = 0; i < 5; ++i)
    actors.push_back(x.start());
  for (const auto& actor : actors)
    caf::anon_send(actor, 1);
  REQUIRE(x.at->await(actors.size()));
  CHECK(x.context.blocking->size() == actors.size());
  x.at->open();
  CHECK(x.becomes(1));
  // That one is not given up for new ones.
  const auto before = x.at->threads();
  for (const auto& actor : actors)
    CHECK(x.ask(actor, 2) == 2);
  CHECK(x.at->threads() <= before + 1);
}

TEST_CASE("an actor with a message again goes on on the thread that it has",
          "[blocking]") {
  on_blocking_threads x;
  const auto job = caf::make_counted<busy_job>(x.context.blocking, x.at);
  x.context.blocking->enter();
  job->exec();
  REQUIRE(x.at->await(1));
  CHECK(x.at->threads() == 1);
  CHECK(x.context.blocking->size() == 1);
  x.context.blocking->leave();
  x.at->open();
  CHECK(x.becomes(0));
}

TEST_CASE("threads of actors that block end with the last of them",
          "[blocking]") {
  on_blocking_threads x;
  auto first = x.start();
  auto second = x.start();
  CHECK(x.ask(first, 2) == 2);
  CHECK(x.ask(second, 2) == 2);
  caf::anon_send_exit(first, caf::exit_reason::user_shutdown);
  CHECK(x.becomes(1));
  CHECK(x.ask(second, 4) == 4);
  caf::anon_send_exit(second, caf::exit_reason::user_shutdown);
  CHECK(x.becomes(0));
  // Others can begin after that.
  CHECK(x.ask(x.start(), 6) == 6);
}

TEST_CASE("an actor that blocks gets its messages in their order, each once",
          "[blocking]") {
  on_blocking_threads x;
  const auto actor = x.start();
  caf::scoped_actor self{*x.system};
  constexpr int all = 20'000;
  for (int i = 0; i < all; ++i)
    self->send(actor, 2 * i);
  for (int i = 0; i < all; ++i) {
    int answer = -1;
    self->receive([&](int y) { answer = y; }, caf::after(20s) >> [] {});
    if (answer != 2 * i)
      FAIL("message " << i << " was answered by " << answer);
  }
  CHECK(x.context.blocking->size() <= 2);
}

TEST_CASE("without threads of their own actors that block run as all others",
          "[blocking]") {
  on_blocking_threads x;
  x.context.blocking = nullptr;
  CHECK(x.ask(x.start(), 2) == 2);
}

} // namespace roscell::test
