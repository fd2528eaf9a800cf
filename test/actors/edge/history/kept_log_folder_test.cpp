#include "actors/edge/history/kept_log_folder.hpp"
#include "actors/edge/history/limits.hpp"

#include "test/actors/edge/process/supervision_fixture.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <string>

using namespace roscell;
using namespace roscell::test;

namespace {

namespace fs = std::filesystem;

struct log_bench {
  kept_log about(const std::string& instance, int64_t ended_unix_ms,
                 const std::string& task = "t") const {
    kept_log result;
    result.instance = instance;
    result.task = task;
    result.step = "s";
    result.node = "arm";
    result.operation = "echo";
    result.reason = "removed";
    result.ended_unix_ms = ended_unix_ms;
    return result;
  }

  bool keep(const std::string& instance, int64_t ended_unix_ms,
            const std::string& text = "said\n") {
    instances.write(instance + "/log.0", text);
    return kept.keep(instances.path() / instance,
                     about(instance, ended_unix_ms));
  }

  std::string read(const std::string& instance) const {
    const auto log = kept.newest_of(instance);
    return log ? log->read_from(0).text : "none";
  }

  std::vector<std::string> listed(const kept_logs_query& query = {}) const {
    std::vector<std::string> result;
    for (const auto& x : kept.list(query).logs)
      result.push_back(x.instance);
    return result;
  }

  temp_folder instances;
  temp_folder data;
  fs::path folder = data.path() / "history" / "logs";
  kept_log_folder kept{folder};
};

using names = std::vector<std::string>;

} // namespace

TEST_CASE("a log is moved to the others with its times and its end") {
  log_bench b;
  const time_note note{0, 5000};
  b.instances.write("t-s-1/log.0", "one\n");
  b.instances.write("t-s-1/log.4", "two\n");
  b.instances.write("t-s-1/times.0",
                    {reinterpret_cast<const char*>(&note), sizeof(note)});
  b.instances.write("t-s-1/exit", "{}");
  REQUIRE(b.kept.keep(b.instances.path() / "t-s-1", b.about("t-s-1", 7000)));
  CHECK_FALSE(fs::exists(b.instances.path() / "t-s-1" / "log.0"));
  const auto part = b.kept.newest_of("t-s-1")->read_from(0, true);
  CHECK(part.text == "one\ntwo\n");
  CHECK(part.ended);
  CHECK(part.times_unix_ms == std::vector<int64_t>{5000, 5000});
  auto wanted = b.about("t-s-1", 7000);
  wanted.bytes = 8;
  const auto list = b.kept.list({});
  REQUIRE(list.logs.size() == 1);
  CHECK(list.logs.front() == wanted);
  CHECK(list.unreadable == 0);
}

TEST_CASE("the end of an engine's log is kept as a shim's is") {
  log_bench b;
  log_part end;
  end.text = "one\ntwo\nthree\n";
  end.times_unix_ms = {1000, 1000, 2000};
  REQUIRE(b.kept.keep(end, b.about("t-s-1", 7000)));
  const auto part = b.kept.newest_of("t-s-1")->read_from(0, true);
  CHECK(part.text == end.text);
  CHECK(part.times_unix_ms == end.times_unix_ms);
  CHECK(part.ended);
}

TEST_CASE("where there is no log none is kept") {
  log_bench b;
  CHECK_FALSE(b.kept.keep(b.instances.path() / "none", b.about("t-s-1", 7000)));
  b.instances.write("t-s-1/exit", "{}");
  CHECK_FALSE(
      b.kept.keep(b.instances.path() / "t-s-1", b.about("t-s-1", 7000)));
  CHECK(b.listed().empty());
  CHECK(b.read("t-s-1") == "none");
  CHECK(b.read("") == "none");
}

TEST_CASE("kept logs are listed by their ends, of an instance or a task") {
  log_bench b;
  b.keep("t-s-1", 2000);
  b.keep("t-s-2", 10'000);
  b.instances.write("u-s-1/log.0", "said\n");
  b.kept.keep(b.instances.path() / "u-s-1", b.about("u-s-1", 3000, "u"));
  CHECK(b.listed() == names{"t-s-2", "u-s-1", "t-s-1"});
  CHECK(b.listed({"t-s-1", ""}) == names{"t-s-1"});
  CHECK(b.listed({"", "t"}) == names{"t-s-2", "t-s-1"});
  CHECK(b.listed({"", "v"}).empty());
}

TEST_CASE("of one instance the last three runs are kept") {
  log_bench b;
  b.keep("t-s-2", 1000);
  for (const int64_t end : {2000, 3000, 4000, 5000})
    b.keep("t-s-1", end, "run " + std::to_string(end) + "\n");
  CHECK(b.listed({"t-s-1", ""}).size() == limits::history::runs);
  CHECK(b.read("t-s-1") == "run 5000\n");
  CHECK(b.listed({"t-s-2", ""}).size() == 1);
  // Two ends at one moment are two.
  b.keep("t-s-3", 6000, "first\n");
  b.keep("t-s-3", 6000, "second\n");
  CHECK(b.listed({"t-s-3", ""}).size() == 2);
  CHECK(b.read("t-s-3") == "second\n");
}

TEST_CASE("the oldest log goes first, and what it took is free") {
  log_bench b;
  CHECK_FALSE(b.kept.drop_oldest());
  CHECK_FALSE(b.kept.oldest_unix_ms());
  b.keep("t-s-1", 1000, std::string(10'000, 'x'));
  b.keep("t-s-2", 2000);
  b.kept.look();
  CHECK(b.kept.count() == 2);
  CHECK(b.kept.oldest_unix_ms() == 1000);
  const auto before = b.kept.bytes();
  CHECK(before >= 10'000);
  REQUIRE(b.kept.drop_oldest());
  CHECK(b.kept.bytes() <= before - 10'000);
  CHECK(b.kept.oldest_unix_ms() == 2000);
  CHECK(b.listed() == names{"t-s-2"});
}

TEST_CASE("what is damaged is counted, goes with age, and harms no other") {
  log_bench b;
  b.keep("t-s-1", 1000);
  b.keep("t-s-2", 2000);
  const auto about = b.folder / "t-s-2@2000" / "about.json";
  SECTION("what is noted beside a log is cut off") {
    fs::resize_file(about, 20);
  }
  SECTION("it is gone") {
    fs::remove(about);
  }
  SECTION("it is too long") {
    fs::resize_file(about, 1'000'000);
  }
  SECTION("it is of another instance") {
    fs::copy_file(b.folder / "t-s-1@1000" / "about.json", about,
                  fs::copy_options::overwrite_existing);
  }
  SECTION("it is a pipe that nobody writes to") {
    fs::remove(about);
    REQUIRE(::mkfifo(about.c_str(), 0600) == 0);
  }
  SECTION("names are none") {
    std::ofstream{about}
        << R"({"type":"kept_logs","logs":[{"instance":"t-s-2","task":"../x",)"
        << R"("state":"stopped","exit_code":null,"ended_unix_ms":1}]})";
  }
  SECTION("it is a file") {
    fs::remove_all(about.parent_path());
    std::ofstream{about.parent_path()} << "text";
  }
  SECTION("its name is none of ours") {
    fs::rename(about.parent_path(), b.folder / "t-s-2@x");
  }
  const auto list = b.kept.list({});
  CHECK(list.logs.size() == 1);
  CHECK(list.unreadable == 1);
  CHECK(b.read("t-s-1") == "said\n");
  b.kept.look();
  CHECK(b.kept.count() == 2);
  CHECK((b.kept.drop_oldest() && b.kept.drop_oldest()));
  CHECK(fs::is_empty(b.folder));
}

TEST_CASE("a link among kept logs is not followed") {
  log_bench b;
  temp_folder other;
  b.keep("t-s-1", 1000);
  fs::copy(b.folder / "t-s-1@1000", other.path() / "stolen",
           fs::copy_options::recursive);
  fs::create_directory_symlink(other.path() / "stolen",
                               b.folder / "t-s-2@2000");
  // A log file that leads elsewhere is moved nowhere.
  other.write("secret", "a secret\n");
  b.instances.write("t-s-3/times.0", "");
  fs::create_symlink(other.path() / "secret",
                     b.instances.path() / "t-s-3" / "log.0");
  b.kept.keep(b.instances.path() / "t-s-3", b.about("t-s-3", 3000));
  CHECK(b.read("t-s-2") == "none");
  CHECK(b.read("t-s-3").empty());
  CHECK(b.kept.list({}).unreadable == 1);
  b.kept.look();
  while (b.kept.drop_oldest()) {
  }
  CHECK(fs::exists(other.path() / "stolen" / "log.0"));
}

TEST_CASE("a log that was being moved when the power went is moved on") {
  log_bench b;
  b.keep("t-s-2", 1000);
  fs::create_directory(b.folder / "t-s-1@2000.part");
  std::ofstream{b.folder / "t-s-1@2000.part" / "log.0"} << "one\n";
  b.instances.write("t-s-1/log.4", "two\n");
  REQUIRE(b.kept.keep(b.instances.path() / "t-s-1", b.about("t-s-1", 2000)));
  CHECK(b.read("t-s-1") == "one\ntwo\n");
  CHECK(b.listed() == names{"t-s-1", "t-s-2"});
}
