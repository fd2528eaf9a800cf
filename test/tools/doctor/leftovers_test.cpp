#include "tools/roscell/doctor/bounded_command.hpp"
#include "tools/roscell/doctor/host/leftovers.hpp"

#include <catch2/catch.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

using namespace roscell;
using namespace roscell::cli;
namespace fs = std::filesystem;

namespace {

const std::string fence_name(32, 'a');

/// A place where everybody may make what they like, as /dev/shm.
class open_folder {
public:
  open_folder() {
    auto name = (fs::temp_directory_path() / "leftovers-XXXXXX").string();
    at_ = mkdtemp(name.data());
  }

  ~open_folder() {
    fs::remove_all(at_);
  }

  /// A fence whose moment has passed.
  fs::path add_fence(const std::string& folder, const std::string& name) const {
    fs::create_directories(at_ / folder);
    const auto path = at_ / folder / name;
    std::ofstream{path}.write("\0\0\0\0\0\0\0\0", 8);
    return path;
  }

  std::vector<fs::path> found() const {
    return find_fence_leftovers(at_, 1'000'000'000).files;
  }

  const fs::path& at() const {
    return at_;
  }

private:
  fs::path at_;
};

std::string own_fences() {
  return "roscell-" + std::to_string(geteuid());
}

} // namespace

TEST_CASE("a fence that has passed is found by its name", "[doctor]") {
  const open_folder shm;
  const auto fence = shm.add_fence(own_fences(), fence_name);
  CHECK(shm.found() == std::vector{fence});
}

TEST_CASE("what others put beside fences is no fence", "[doctor]") {
  const open_folder shm;
  shm.add_fence(own_fences(), "$(id)");
  shm.add_fence(own_fences(), fence_name + "0");
  shm.add_fence("roscell-x", fence_name);
  shm.add_fence("roscell-" + std::to_string(geteuid() + 1), fence_name);
  CHECK(shm.found().empty());
}

TEST_CASE("no link is followed to a fence, and no pipe is waited for",
          "[doctor]") {
  const open_folder shm;
  const auto fence = shm.add_fence("elsewhere", fence_name);
  fs::create_directory_symlink(shm.at() / "elsewhere", shm.at() / own_fences());
  CHECK(shm.found().empty());
  fs::remove(shm.at() / own_fences());
  fs::create_directory(shm.at() / own_fences());
  fs::create_symlink(fence, shm.at() / own_fences() / fence_name);
  REQUIRE(mkfifo((shm.at() / own_fences() / std::string(32, 'b')).c_str(), 0600)
          == 0);
  CHECK(shm.found().empty());
}

TEST_CASE("a file is removed by its remedy, whatever it is called",
          "[doctor]") {
  using namespace std::chrono_literals;
  const open_folder shm;
  const auto file = shm.add_fence("any", "$(touch run) ; '`touch run`");
  const auto remedy =
      judge_leftovers({{file}, 1}, "ROSCell's fences", "").remedy;
  CHECK(run_bounded({"sh", "-c", "cd " + shm.at().string() + "; " + remedy}, 5s)
            .code
        == 0);
  CHECK_FALSE(fs::exists(file));
  CHECK_FALSE(fs::exists(shm.at() / "run"));
}
