#include "actors/node/state_store.hpp"

#include "messages/failure.hpp"
#include "test/actors/fakes/supervision_fakes.hpp"

#include <variant>

using namespace roscell;
using namespace roscell::test;

TEST_CASE("the state store writes records and removes them when empty") {
  virtual_time time;
  const scratch_folder folder;
  auto opened = sqlite_store::open(folder.path() / "state.db");
  REQUIRE(std::holds_alternative<sqlite_store>(opened));
  const auto database =
      std::make_shared<sqlite_store>(std::move(std::get<sqlite_store>(opened)));
  // Not detached here: the test's time is virtual, the disk is not.
  const auto store =
      roscell::spawn(time.system, time.context, state_store, database);
  const auto keys = [&] {
    auto loaded = database->load("tasks");
    return std::get<std::vector<sqlite_store::record>>(loaded);
  };
  const auto write = [&](const std::string& value) {
    const auto answer =
        time.ask<record_stored>(store, store_record{"tasks", "t", value});
    time.settle();
    REQUIRE(*answer);
    CHECK(**answer);
  };
  write(R"({"a":1})");
  CHECK(keys() == std::vector<sqlite_store::record>{{"t", R"({"a":1})"}});
  write("");
  CHECK(keys().empty());
  time.kill(store);
}
