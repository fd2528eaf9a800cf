#include "actors/node/node_data.hpp"

#include "actors/edge/session/site_token.hpp"
#include "messages/failure.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

namespace roscell::test {

namespace fs = std::filesystem;

namespace {

/// A data directory and what a node finds in it.
struct data_fixture {
  temp_folder folder;
  node_config config;

  data_fixture() {
    config.data_dir = folder.path() / "data";
    ::setenv(site_token_variable, site_token().c_str(), 1);
  }

  /// Of this user, as far as these nodes know.
  fs::path site_token() const {
    return folder.path() / "user" / "site.token";
  }

  node_data open() {
    auto result = open_node_data(config);
    if (!result)
      FAIL(to_failure(result.error()).message);
    return std::move(*result);
  }

  failure refusal() {
    const auto result = open_node_data(config);
    return result ? failure{} : to_failure(result.error());
  }

  void put(const std::string& table, const std::string& key,
           const std::string& value) {
    auto store = value_of(sqlite_store::open(database()));
    REQUIRE_FALSE(store.put(table, key, value));
  }

  fs::path database() const {
    return config.data_dir / "state.db";
  }

  /// What the file is replaced by.
  void overwrite(const std::string& text) const {
    fs::remove(database().string() + "-wal");
    std::ofstream{database(), std::ios::binary} << text;
  }
};

bool says(const failure& why, const std::string& words) {
  return why.message.find(words) != std::string::npos;
}

} // namespace

TEST_CASE_METHOD(data_fixture, "A node is the same at its next start",
                 "[node_data]") {
  const auto first = open().identity.uuid;
  CHECK(first.size() == 36);
  CHECK(open().identity.uuid == first);
}

TEST_CASE_METHOD(data_fixture,
                 "A coordinator knows where it was at its last start",
                 "[node_data]") {
  config.coordinator = true;
  {
    const auto first = open();
    CHECK(first.led_from.empty());
    CHECK_FALSE(keep_address(first, "192.0.2.1:8420"));
  }
  const auto second = open();
  CHECK(second.led_from == "192.0.2.1:8420");
  CHECK_FALSE(keep_address(second, "192.0.2.2:8420"));
}

TEST_CASE_METHOD(data_fixture,
                 "A damaged database never makes a new node by itself",
                 "[node_data]") {
  open();
  SECTION("it is empty") {
    overwrite("");
  }
  SECTION("it is no database") {
    overwrite(std::string(10'000, 'x'));
  }
  SECTION("a record is no JSON") {
    put("identity", "node", "{\"uuid\":");
  }
  SECTION("a record of another table is no JSON") {
    put("tasks", "t", "gone");
  }
  SECTION("the identity is missing") {
    auto store = value_of(sqlite_store::open(database()));
    REQUIRE_FALSE(store.remove("identity", "node"));
  }
  SECTION("the identity is of no node") {
    put("identity", "node", "[]");
  }
  const auto why = refusal();
  CHECK(says(why, "is damaged"));
  CHECK(why.hint.find("--new-identity") != std::string::npos);
  CHECK(says(refusal(), "is damaged"));
}

TEST_CASE_METHOD(data_fixture, "A node begins anew when it is told to",
                 "[node_data]") {
  const auto before = open().identity.uuid;
  SECTION("with a damaged database") {
    overwrite("");
  }
  SECTION("with a sound one, of a copied directory") {}
  config.new_identity = true;
  const auto now = open();
  CHECK(now.identity.uuid != before);
  CHECK(now.put_aside == config.data_dir / "state.db.aside-1");
  CHECK(fs::exists(now.put_aside));
}

TEST_CASE_METHOD(data_fixture,
                 "A first start that was cut off is a first start again",
                 "[node_data]") {
  fs::create_directories(config.data_dir);
  overwrite("");
  CHECK(open().identity.uuid.size() == 36);
}

TEST_CASE_METHOD(data_fixture,
                 "A record that is not understood is told and stays",
                 "[node_data]") {
  open();
  put("tasks", "t", R"({"of":"another version"})");
  {
    const auto data = open();
    CHECK(data.tasks.empty());
    REQUIRE(data.unread.size() == 1);
    CHECK(data.unread[0].table == "tasks");
    CHECK(data.unread[0].key == "t");
  }
  CHECK(open().unread.size() == 1);
}

TEST_CASE_METHOD(data_fixture, "Programs that no record knows are found",
                 "[node_data]") {
  open();
  instance_row known;
  known.spec.instance = "t-a-1";
  put("instances", "t-a-1", json(known).dump());
  fs::create_directories(config.data_dir / "instances" / "t-a-1");
  fs::create_directories(config.data_dir / "instances" / "t-b-2");
  CHECK(open().strays == std::vector<std::string>{"t-b-2"});
}

TEST_CASE_METHOD(
    data_fixture,
    "Where a program was started, and in which boot, is known after "
    "a restart",
    "[node_data]") {
  open();
  instance_row row;
  row.spec.instance = "t-a-2";
  auto record = json(row);
  put("instances", "t-a-2", record.dump());
  record["address"] = "10.0.0.5";
  record["boot"] = "b-1";
  record["spec"]["instance"] = "t-a-1";
  put("instances", "t-a-1", record.dump());
  const auto data = open();
  CHECK(data.unread.empty());
  CHECK(data.instances.size() == 2);
  CHECK(data.started_at
        == std::map<std::string, std::string>{{"t-a-1", "10.0.0.5"}});
  // An earlier version has not written it down.
  CHECK(data.started_in
        == std::map<std::string, std::string>{{"t-a-1", "b-1"}});
}

TEST_CASE_METHOD(data_fixture,
                 "The first coordinator of a user makes his site token, and "
                 "all his nodes have it",
                 "[node_data]") {
  const auto member = open();
  CHECK(member.site.text().empty());
  CHECK_FALSE(fs::exists(site_token()));
  config.data_dir = folder.path() / "head";
  config.coordinator = true;
  const auto head = open();
  CHECK(head.site.text().size() == 64);
  CHECK(member.site.text() == head.site.text());
}

TEST_CASE_METHOD(data_fixture,
                 "A site token that is given is there, and nothing is made "
                 "beside it",
                 "[node_data]") {
  config.coordinator = true;
  config.site_token_file = folder.path() / "given";
  CHECK(says(refusal(), "cannot read the site token"));
  folder.write("given", std::string(32, 'x'));
  CHECK(open().site.text() == std::string(32, 'x'));
  CHECK_FALSE(fs::exists(site_token()));
}

TEST_CASE_METHOD(data_fixture,
                 "A coordinator that cannot have a site token does not start",
                 "[node_data]") {
  config.coordinator = true;
  folder.write("user", "a file where a folder should be");
  CHECK(says(refusal(), "cannot make the site token"));
}

} // namespace roscell::test
