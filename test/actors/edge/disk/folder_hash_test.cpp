#include "actors/edge/disk/folder_hash.hpp"

#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/stat.h>

#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

std::string hash(const fs::path& folder) {
  return value_of(hash_folder(folder));
}

} // namespace

TEST_CASE("a folder's hash depends on names, contents and x bits only") {
  temp_folder one;
  temp_folder two;
  for (const auto* x : {&one, &two}) {
    x->write("a", "1");
    x->write("b/c", "2");
  }
  const auto before = hash(one.path());
  CHECK(before.size() == 64);
  CHECK(hash(two.path()) == before);
  SECTION("not on times, empty folders or other bits") {
    fs::create_directory(two.path() / "empty");
    fs::last_write_time(two.path() / "a", fs::file_time_type{});
    ::chmod((two.path() / "a").c_str(), 0600);
    CHECK(hash(two.path()) == before);
  }
  SECTION("on a content") {
    two.write("b/c", "3");
    CHECK(hash(two.path()) != before);
  }
  SECTION("on a name") {
    fs::rename(two.path() / "a", two.path() / "A");
    CHECK(hash(two.path()) != before);
  }
  SECTION("on what is a program") {
    ::chmod((two.path() / "a").c_str(), 0700);
    CHECK(hash(two.path()) != before);
  }
  SECTION("on where a content is") {
    two.write("a", "2");
    two.write("b/c", "1");
    CHECK(hash(two.path()) != before);
  }
}

TEST_CASE("a link inside the folder is content, one that leads out is not") {
  temp_folder folder;
  folder.write("skill/a", "1");
  folder.write("outside", "2");
  const auto skill = folder.path() / "skill";
  const auto before = hash(skill);
  std::string target;
  SECTION("inside") {
    fs::create_symlink("a", skill / "link");
    const auto with_link = hash(skill);
    CHECK(with_link != before);
    fs::remove(skill / "link");
    fs::create_symlink("./a", skill / "link");
    CHECK(hash(skill) != with_link);
    return;
  }
  SECTION("absolute") {
    target = skill / "a";
  }
  SECTION("to a neighbour") {
    target = "../outside";
  }
  SECTION("by a detour") {
    target = "./../skill/../outside";
  }
  fs::create_symlink(target, skill / "link");
  CHECK(error_of(hash_folder(skill)).message.find("leads out")
        != std::string::npos);
}

TEST_CASE("a pipe in a skill folder is refused without waiting for it") {
  temp_folder folder;
  REQUIRE(::mkfifo((folder.path() / "pipe").c_str(), 0600) == 0);
  CHECK(error_of(hash_folder(folder.path())).code
        == error_code::schema_violation);
}

TEST_CASE("a folder beyond the limits is refused") {
  temp_folder folder;
  folder.write("a", "12345");
  folder.write("b/c/d/e", "1");
  folder_limits limits;
  SECTION("of files") {
    limits.max_files = 1;
  }
  SECTION("of bytes") {
    limits.max_bytes = 5;
  }
  SECTION("of depth") {
    limits.max_depth = 2;
  }
  CHECK(error_of(hash_folder(folder.path(), limits)).code
        == error_code::schema_violation);
}

TEST_CASE("a folder that is not there cannot be hashed") {
  CHECK(error_of(hash_folder("/no/such/folder")).code == error_code::internal);
}

TEST_CASE(
    "a folder looks otherwise once a file was written, added or removed") {
  temp_folder folder;
  folder.write("a", "1");
  folder.write("b/c", "2");
  const auto look = [&] { return value_of(read_folder(folder.path())); };
  const auto before = look();
  CHECK(before.changed_unix_ms > 1'600'000'000'000);
  CHECK(look().state == before.state);
  SECTION("written, with an old time of its content") {
    folder.write("a", "3");
    fs::last_write_time(folder.path() / "a", fs::file_time_type{});
  }
  SECTION("added") {
    folder.write("d", "");
  }
  SECTION("removed") {
    fs::remove(folder.path() / "b/c");
  }
  CHECK(look().state != before.state);
}
