#include "actors/edge/process/fence_file.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <linux/magic.h>

#include <cstring>
#include <fstream>
#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

/// What the shim reads: 0 if there is no whole number.
int64_t moment_in(const fs::path& path) {
  const auto bytes = read_small_file(path, 64).value_or("");
  int64_t result = 0;
  if (bytes.size() == sizeof(result))
    std::memcpy(&result, bytes.data(), sizeof(result));
  return result;
}

struct made_fence {
  explicit made_fence(int64_t boot_ms) {
    REQUIRE_FALSE(make_fence(path, boot_ms));
  }

  ~made_fence() {
    remove_fence(path);
  }

  temp_folder folder;
  fs::path path = fence_path(folder.path());
};

} // namespace

TEST_CASE("a fence lies in memory, for its owner alone") {
  const made_fence fence{1'000};
  CHECK(moment_in(fence.path) == 1'000);
  struct statfs system {};
  REQUIRE(::statfs(fence.path.c_str(), &system) == 0);
  CHECK(system.f_type == TMPFS_MAGIC);
  struct stat info {};
  REQUIRE(::stat(fence.path.parent_path().c_str(), &info) == 0);
  CHECK((info.st_mode & 0777) == 0700);
  REQUIRE(::stat(fence.path.c_str(), &info) == 0);
  CHECK((info.st_mode & 0777) == 0600);
}

TEST_CASE("a fence is found again by the folder of its instance") {
  temp_folder folder;
  const auto path = fence_path(folder.path() / "i");
  CHECK(path == fence_path(folder.path() / "j" / ".." / "i"));
  CHECK(path != fence_path(folder.path() / "j"));
  // The data directories of two nodes may have the same name.
  CHECK(fence_path("data/i") == fence_path(fs::current_path() / "data/i"));
}

TEST_CASE("a fence is moved on, never back") {
  const made_fence fence{1'000};
  CHECK_FALSE(move_fence(fence.path, 3'000));
  CHECK(moment_in(fence.path) == 3'000);
  CHECK_FALSE(move_fence(fence.path, 2'000));
  CHECK(moment_in(fence.path) == 3'000);
  // A new start does not inherit that of the one before.
  CHECK_FALSE(make_fence(fence.path, 2'000));
  CHECK(moment_in(fence.path) == 2'000);
}

TEST_CASE("a fence stays the same file while it is moved on") {
  // A container sees the file itself, whatever has its name later.
  const made_fence fence{1'000};
  struct stat before {};
  struct stat after {};
  REQUIRE(::stat(fence.path.c_str(), &before) == 0);
  CHECK_FALSE(move_fence(fence.path, 3'000));
  REQUIRE(::stat(fence.path.c_str(), &after) == 0);
  CHECK(before.st_ino == after.st_ino);
}

TEST_CASE("a fence that is gone is not made again, and that is told") {
  const made_fence fence{1'000};
  remove_fence(fence.path);
  const auto why = move_fence(fence.path, 3'000);
  REQUIRE(why);
  CHECK(why->code == error_code::engine_failed);
  CHECK(why->message.find(fence.path.string()) != std::string::npos);
  CHECK_FALSE(fs::exists(fence.path));
}

TEST_CASE("a fence that was cut is whole again when it is moved on") {
  const made_fence fence{1'000};
  REQUIRE(::truncate(fence.path.c_str(), 3) == 0);
  CHECK_FALSE(move_fence(fence.path, 3'000));
  CHECK(moment_in(fence.path) == 3'000);
}

TEST_CASE("no fence is made in a folder that others may write to") {
  temp_folder folder;
  ::chmod(folder.path().c_str(), 0777);
  const auto why = make_fence(folder.path() / "fence", 1'000);
  REQUIRE(why);
  CHECK(why->message.find(folder.path().string()) != std::string::npos);
}
