#include "actors/node/state_store.hpp"

#include "messages/failure.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

#include <variant>

using namespace roscell;
using namespace roscell::test;

namespace {

using records = std::vector<sqlite_store::record>;

/// A store on a real file. Not detached here: the test's time is virtual, the
/// disk is not.
struct store_on_disk {
  virtual_time time;
  scratch_folder folder;
  std::shared_ptr<sqlite_store> database;
  state_store_actor actor;

  store_on_disk() {
    auto opened = sqlite_store::open(folder.path() / "state.db");
    REQUIRE(std::holds_alternative<sqlite_store>(opened));
    database = std::make_shared<sqlite_store>(
        std::move(std::get<sqlite_store>(opened)));
    actor = roscell::spawn(time.system, time.context, state_store, database);
  }

  ~store_on_disk() {
    time.kill(actor);
  }

  store_on_disk(const store_on_disk&) = delete;
  store_on_disk& operator=(const store_on_disk&) = delete;

  template <class Message>
  caf::expected<record_stored> tell(const Message& x) {
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

} // namespace

TEST_CASE("the state store writes records and removes them when empty") {
  store_on_disk store;
  CHECK(store.tell(store_record{"tasks", "t", R"({"a":1})"}));
  CHECK(store.tasks() == records{{"t", R"({"a":1})"}});
  CHECK(store.tell(store_record{"tasks", "t", ""}));
  CHECK(store.tasks().empty());
}

TEST_CASE("the state store writes several records at once") {
  store_on_disk store;
  CHECK(store.tell(store_records{{{"tasks", "a", "1"}, {"tasks", "b", "2"}}}));
  CHECK(store.tell(store_records{{{"tasks", "a", ""}, {"tasks", "c", "3"}}}));
  CHECK(store.tasks() == records{{"b", "2"}, {"c", "3"}});
}

TEST_CASE("no records are stored at once") {
  store_on_disk store;
  CHECK(store.tell(store_records{}));
  CHECK(store.tasks().empty());
}
