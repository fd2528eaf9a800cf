#include "actors/node/limits.hpp"
#include "actors/node/state_store.hpp"

#include "actors/core/limits.hpp"
#include "messages/failure.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

#include <sys/resource.h>

#include <csignal>
#include <variant>

using namespace roscell;
using namespace roscell::test;

namespace {

using records = std::vector<sqlite_store::record>;

/// A store on a real file. Not detached here: the test's time is virtual, the
/// disk is not.
struct store_on_disk {
  virtual_time time;
  temp_folder folder;
  std::shared_ptr<sqlite_store> database;
  state_store_actor actor;

  store_on_disk() {
    auto opened = sqlite_store::open(folder.path() / "state.db");
    REQUIRE(std::holds_alternative<sqlite_store>(opened));
    database = std::make_shared<sqlite_store>(
        std::move(std::get<sqlite_store>(opened)));
    actor = roscell::spawn(time.system, time.context, state_store, time.context,
                           database);
  }

  ~store_on_disk() {
    time.kill(actor);
  }

  store_on_disk(const store_on_disk&) = delete;
  store_on_disk& operator=(const store_on_disk&) = delete;

  template <class Message>
  caf::expected<record_stored> write_record(const Message& x) {
    const auto answer = time.ask<record_stored>(actor, x);
    time.settle();
    REQUIRE(*answer);
    return **answer;
  }

  records tasks() {
    auto loaded = database->load("tasks");
    return std::get<records>(loaded);
  }
};

/// Lets this process write no byte to any file, as on a disk that is full.
class full_disk {
public:
  full_disk() {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit none{0, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &none);
  }

  ~full_disk() {
    make_room();
    std::signal(SIGXFSZ, handler_);
  }

  full_disk(const full_disk&) = delete;
  full_disk& operator=(const full_disk&) = delete;

  void make_room() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
  }

private:
  rlimit before_{};
  void (*handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

store_record patient(const std::string& key, const std::string& value) {
  return {"tasks", key, value, true};
}

} // namespace

TEST_CASE("the state store writes records and removes them when empty") {
  store_on_disk store;
  CHECK(store.write_record(store_record{"tasks", "t", R"({"a":1})"}));
  CHECK(store.tasks() == records{{"t", R"({"a":1})"}});
  CHECK(store.write_record(store_record{"tasks", "t", ""}));
  CHECK(store.tasks().empty());
}

TEST_CASE("the state store writes several records at once") {
  store_on_disk store;
  CHECK(store.write_record(
      store_records{{{"tasks", "a", "1"}, {"tasks", "b", "2"}}}));
  CHECK(store.write_record(
      store_records{{{"tasks", "a", ""}, {"tasks", "c", "3"}}}));
  CHECK(store.tasks() == records{{"b", "2"}, {"c", "3"}});
}

TEST_CASE("no records are stored at once") {
  store_on_disk store;
  CHECK(store.write_record(store_records{}));
  CHECK(store.tasks().empty());
}

TEST_CASE("what may not wait is refused while the disk is full") {
  store_on_disk store;
  full_disk disk;
  const auto answer = store.write_record(store_record{"tasks", "t", "1"});
  REQUIRE_FALSE(answer);
  INFO(to_failure(answer.error()).message);
  CHECK(to_failure(answer.error()).message.find("no room is left")
        != std::string::npos);
  CHECK_FALSE(store.write_record(
      store_records{{patient("a", "1"), {"tasks", "b", "2"}}}));
  disk.make_room();
  store.time.advance(std::chrono::minutes{1});
  CHECK(store.tasks().empty());
}

TEST_CASE("what may wait is written when there is room") {
  store_on_disk store;
  full_disk disk;
  CHECK(store.write_record(patient("a", "1")));
  CHECK(store.write_record(patient("a", "2")));
  CHECK(store.write_record(patient("b", "3")));
  store.time.advance(std::chrono::minutes{1});
  CHECK(store.tasks().empty());
  disk.make_room();
  store.time.advance(limits::retry::longest);
  CHECK(store.tasks() == records{{"a", "2"}, {"b", "3"}});
  CHECK_FALSE(store.time.scheduler.clock().has_pending_timeout());
}

TEST_CASE("the next record takes along what waits") {
  store_on_disk store;
  {
    full_disk disk;
    CHECK(store.write_record(patient("a", "1")));
    CHECK(store.write_record(patient("b", "2")));
  }
  CHECK(store.write_record(store_record{"tasks", "a", "3"}));
  CHECK(store.tasks() == records{{"a", "3"}, {"b", "2"}});
}

TEST_CASE("not more than a bound of records waits") {
  store_on_disk store;
  full_disk disk;
  for (size_t i = 0; i < limits::store::waiting; ++i)
    CHECK(store.write_record(patient(std::to_string(i), "1")));
  CHECK_FALSE(store.write_record(patient("one more", "1")));
}
