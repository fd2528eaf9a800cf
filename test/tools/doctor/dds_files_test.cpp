#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"
#include "tools/roscell/doctor/host/dds_files.hpp"

#include <catch2/catch.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <fstream>

using namespace roscell;
using namespace roscell::cli;
using Catch::Contains;
namespace fs = std::filesystem;

namespace {

/// A place where everybody may make what they like, as /dev/shm.
class open_folder {
public:
  fs::path add(const std::string& name) const {
    const auto path = at() / name;
    std::ofstream{path} << "words";
    return path;
  }

  /// For as long as it lives somebody uses the memory.
  unique_fd hold(const std::string& lock, int how) const {
    unique_fd result{::open(add(lock).c_str(), O_RDONLY | O_CLOEXEC)};
    REQUIRE(::flock(result.get(), how) == 0);
    return result;
  }

  findings found() const {
    return judge_dds_memory(find_dds_memory(at()));
  }

  const fs::path& at() const {
    return folder_.path();
  }

private:
  test::temp_folder folder_;
};

} // namespace

TEST_CASE("memory of Fast DDS whose lock nobody holds is left over",
          "[doctor]") {
  const open_folder shm;
  CHECK(shm.found()[0].how == judgement::ok);
  const auto dead = shm.add("fastrtps_dead").string();
  shm.add("fastrtps_dead_el");
  shm.add("fastdds_live");
  const auto living = shm.hold("fastdds_live_el", LOCK_EX);
  shm.add("fastrtps_port7");
  shm.add("fastrtps_port7_el");
  shm.add("sem.fastrtps_port7_mutex");
  auto reading = shm.hold("fastrtps_port7_sl", LOCK_SH);
  const auto found = shm.found();
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0].seen, Contains("2 files of Fast DDS that nobody uses"));
  CHECK(found[0].remedy == "rm -f " + dead + " " + dead + "_el");
  reading.reset();
  CHECK_THAT(shm.found()[0].seen, Contains("6 files of Fast DDS"));
}

TEST_CASE("what has no lock, or is none of Fast DDS's, is not left over",
          "[doctor]") {
  const open_folder shm;
  shm.add("fastrtps_alone");
  shm.add("other_el");
  shm.add("fastrtps_$(touch run)_el");
  REQUIRE(::mkfifo((shm.at() / "fastrtps_pipe_el").c_str(), 0600) == 0);
  fs::create_symlink("/etc/passwd", shm.at() / "fastrtps_link_el");
  CHECK(shm.found()[0].how == judgement::ok);
}

TEST_CASE("programs of other users share only memory that is open to all",
          "[doctor]") {
  dds_memory first{{"/dev/shm/fastrtps_a"}, 1, 4242, false, true};
  dds_memory second{{"/dev/shm/fastrtps_b"}, 1, 4243, true, true};
  const auto found = judge_dds_memory({first, second});
  REQUIRE(found.size() == 1);
  CHECK(found[0].how == judgement::warning);
  CHECK_THAT(found[0].seen, Contains("'#4242', '#4243'"));
  CHECK(found[0].remedy == "sudo -u '#4242' COMMAND");
  first.open_to_all = true;
  CHECK(judge_dds_memory({first, second})[0].how == judgement::ok);
  first.open_to_all = false;
  second.owner = first.owner;
  CHECK(judge_dds_memory({first, second})[0].how == judgement::ok);
}
