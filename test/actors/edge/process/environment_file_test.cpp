#include "actors/edge/process/environment_file.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <fcntl.h>
#include <sys/file.h>

#include <filesystem>
#include <map>
#include <string>

using namespace roscell;
using namespace roscell::test;

namespace {

const std::map<std::string, std::string> place{
    {"ROS_DISCOVERY_SERVER", "10.0.0.9:11811"}};

std::string text_in(const std::filesystem::path& path) {
  return read_small_file(path, 1024).value_or("no file");
}

unique_fd listen_to(const std::filesystem::path& path) {
  unique_fd result{::open(path.c_str(), O_RDONLY | O_CLOEXEC)};
  CHECK(::flock(result.get(), LOCK_SH) == 0);
  return result;
}

} // namespace

TEST_CASE("a program that listens is told variables, again and again") {
  own_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  CHECK(path == folder.path() / "notify.environment");
  make_environment_file(path);
  const auto listener = listen_to(path);
  CHECK(tell_environment(path, place));
  CHECK(text_in(path) == R"({"ROS_DISCOVERY_SERVER":"10.0.0.9:11811"})");
  CHECK(tell_environment(path, {{"A", "b"}}));
  CHECK(text_in(path) == R"({"A":"b"})");
}

TEST_CASE("a program that does not listen is told nothing, and that is known") {
  own_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  CHECK_FALSE(tell_environment(path, place));
  make_environment_file(path);
  CHECK_FALSE(tell_environment(path, place));
  listen_to(path); // Which has ended.
  CHECK_FALSE(tell_environment(path, place));
  CHECK(text_in(path).empty());
}

TEST_CASE("each start of a program has a file of its own") {
  own_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  make_environment_file(path);
  const auto former = listen_to(path);
  make_environment_file(path);
  CHECK_FALSE(tell_environment(path, place));
  CHECK(std::filesystem::status(path).permissions()
        == (std::filesystem::perms::owner_read
            | std::filesystem::perms::owner_write));
}
