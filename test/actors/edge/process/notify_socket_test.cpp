#include "actors/edge/process/notify_socket.hpp"

#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/stat.h>
#include <sys/un.h>

#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

TEST_CASE("a notify socket takes what programs say and merges it") {
  own_folder folder;
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
  own_folder folder;
  const auto path = notify_path(folder.path());
  auto old = value_of(open_notify_socket(path));
  const auto fresh = value_of(open_notify_socket(path));
  CHECK(send_notification(path, "READY=1"));
  CHECK_FALSE(receive_notifications(old.get()).ready);
  CHECK(receive_notifications(fresh.get()).ready);
}

TEST_CASE("a path too long for a socket has a short one that stays the same") {
  own_folder folder;
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
  own_folder folder;
  ::chmod(folder.path().c_str(), 0777);
  CHECK(error_of(open_notify_socket(folder.path() / "notify")).code
        == error_code::engine_failed);
}
