#include "actors/edge/process/environment_file.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

using namespace roscell;
using namespace roscell::test;

namespace {

const std::map<std::string, std::string> place{
    {"ROS_DISCOVERY_SERVER", "10.0.0.9:11811"}};

/// As a program does that listens.
unique_fd listen_to(const std::filesystem::path& path) {
  unique_fd result{::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)};
  CHECK(result);
  return result;
}

std::string heard_by(const unique_fd& listener) {
  std::string result(1024, '\0');
  const auto size = ::read(listener.get(), result.data(), result.size());
  result.resize(size > 0 ? static_cast<size_t>(size) : 0);
  return result;
}

} // namespace

TEST_CASE("a program that listens is told variables, again and again") {
  own_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  CHECK(path == folder.path() / "notify.environment");
  make_environment_file(path);
  const auto listener = listen_to(path);
  CHECK(write_environment_update(path, place));
  CHECK(heard_by(listener)
        == R"({"ROS_DISCOVERY_SERVER":"10.0.0.9:11811"})"
           "\n");
  CHECK(write_environment_update(path, {{"A", "b"}}));
  CHECK(write_environment_update(path, {{"A", "c"}}));
  CHECK(heard_by(listener) == "{\"A\":\"b\"}\n{\"A\":\"c\"}\n");
}

TEST_CASE("nobody waits for a program that listens and does not read") {
  own_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  make_environment_file(path);
  const auto listener = listen_to(path);
  CHECK_FALSE(write_environment_update(path, {{"A", std::string(5000, 'a')}}));
  CHECK(heard_by(listener).empty());
  size_t reported = 0;
  while (reported < 1000
         && write_environment_update(path, {{"A", std::string(4000, 'a')}}))
    ++reported;
  CHECK(reported > 0);
  CHECK(reported < 1000);
}

TEST_CASE("what a program has put in the place of its file is left alone") {
  own_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  std::ofstream{path} << "mine";
  CHECK_FALSE(write_environment_update(path, place));
  CHECK(read_small_file(path, 10) == "mine");
}

TEST_CASE("a program that does not listen is told nothing, and that is known") {
  own_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  CHECK_FALSE(write_environment_update(path, place));
  make_environment_file(path);
  CHECK_FALSE(write_environment_update(path, place));
  listen_to(path); // Which has ended.
  CHECK_FALSE(write_environment_update(path, place));
}

TEST_CASE("each start of a program has a file of its own") {
  own_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  make_environment_file(path);
  const auto former = listen_to(path);
  make_environment_file(path);
  CHECK_FALSE(write_environment_update(path, place));
  CHECK(std::filesystem::status(path).permissions()
        == (std::filesystem::perms::owner_read
            | std::filesystem::perms::owner_write));
}
