#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/notify_socket.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

TEST_CASE("a notify socket takes what programs say and merges it") {
  temp_folder folder;
  const auto path = notify_path(folder.path());
  CHECK(path == folder.path() / "notify");
  const auto socket = value_of(open_notify_socket(path));
  CHECK_FALSE(receive_notifications(socket.get()).ready);
  CHECK(send_notification(path, "READY=1"));
  CHECK(send_notification(path, std::string(5000, 'x') + "\nSTOPPING=1"));
  CHECK(send_notification(path, "STATUS=fine"));
  const auto words = receive_notifications(socket.get());
  CHECK(words.ready);
  CHECK_FALSE(words.stopping);
  CHECK(words.status == "fine");
}

TEST_CASE("a restarted node takes over the path of a notify socket") {
  temp_folder folder;
  const auto path = notify_path(folder.path());
  auto old = value_of(open_notify_socket(path));
  const auto fresh = value_of(open_notify_socket(path));
  CHECK(send_notification(path, "READY=1"));
  CHECK_FALSE(receive_notifications(old.get()).ready);
  CHECK(receive_notifications(fresh.get()).ready);
}

TEST_CASE("a path too long for a socket has a short one that stays the same") {
  temp_folder folder;
  const auto deep = folder.path() / std::string(90, 'a') / std::string(90, 'b');
  fs::create_directories(deep);
  const auto path = notify_path(deep);
  CHECK(path.native().size() < sizeof(sockaddr_un::sun_path));
  CHECK(path == notify_path(deep));
  CHECK(path != notify_path(deep.parent_path() / std::string(90, 'c')));
  const auto socket = value_of(open_notify_socket(path));
  CHECK(send_notification(path, "WATCHDOG=1"));
  CHECK(receive_notifications(socket.get()).alive);
  fs::remove(path);
}

TEST_CASE("a folder that others may write to is not trusted") {
  temp_folder folder;
  ::chmod(folder.path().c_str(), 0777);
  CHECK(error_of(open_notify_socket(folder.path() / "notify")).code
        == error_code::engine_failed);
}

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
  temp_folder folder;
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
  temp_folder folder;
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
  temp_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  std::ofstream{path} << "mine";
  CHECK_FALSE(write_environment_update(path, place));
  CHECK(read_small_file(path, 10) == "mine");
}

TEST_CASE("a program that does not listen is told nothing, and that is known") {
  temp_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  CHECK_FALSE(write_environment_update(path, place));
  make_environment_file(path);
  CHECK_FALSE(write_environment_update(path, place));
  listen_to(path); // Which has ended.
  CHECK_FALSE(write_environment_update(path, place));
}

TEST_CASE("each start of a program has a file of its own") {
  temp_folder folder;
  const auto path = environment_file_of(folder.path() / "notify");
  make_environment_file(path);
  const auto former = listen_to(path);
  make_environment_file(path);
  CHECK_FALSE(write_environment_update(path, place));
  CHECK(std::filesystem::status(path).permissions()
        == (std::filesystem::perms::owner_read
            | std::filesystem::perms::owner_write));
}
