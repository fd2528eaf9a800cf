#include "actors/edge/cgroup/instance_cgroup.hpp"

#include "actors/edge/cgroup/cgroup_tables.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

std::string content_of(const fs::path& file) {
  std::ifstream in{file};
  return {std::istreambuf_iterator<char>{in}, {}};
}

void write(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  std::ofstream{file} << text;
}

/// The place of a node in the real hierarchies, below this process.
struct real_place {
  real_place()
      : place(find_cgroup_place(
          {"auto", "test-" + std::to_string(::getpid()), ::geteuid() == 0},
          see_cgroups())) {
    if (!place.has("memory"))
      WARN("SKIPPED: " + place.text);
  }

  ~real_place() {
    remove_place(place);
  }

  cgroup_place place;
};

/// A process that is in a cgroup, does nothing, and can be waited for.
struct member {
  explicit member(const instance_cgroup& cgroup) {
    std::array<int, 2> entered{};
    REQUIRE(::pipe2(entered.data(), O_CLOEXEC) == 0);
    pid = ::fork();
    if (pid == 0) {
      for (const auto& x : cgroup.folders())
        std::ofstream{x / "cgroup.procs"} << ::getpid() << std::flush;
      ::setsid();
      ::close(entered[0]);
      ::close(entered[1]);
      ::pause();
      ::_exit(0);
    }
    // The other end is closed when it is inside, or has ended.
    ::close(entered[1]);
    char none = 0;
    CHECK(::read(entered[0], &none, 1) == 0);
    ::close(entered[0]);
  }

  ~member() {
    ::kill(pid, SIGKILL);
    ::waitpid(pid, nullptr, 0);
  }

  bool is_in(const fs::path& folder) const {
    const auto text = content_of(folder / "cgroup.procs");
    return text.find(std::to_string(pid) + "\n") != std::string::npos;
  }

  pid_t pid = -1;
};

} // namespace

TEST_CASE("an instance is bounded by what it has reserved", "[cgroup]") {
  const real_place host;
  if (!host.place.has("memory"))
    return;
  const auto cgroup = instance_cgroup::make(host.place, "i", {64, 0.5});
  REQUIRE_FALSE(cgroup.folders().empty());
  const auto use = read_use(cgroup.folders());
  REQUIRE(use);
  CHECK(use->memory_limit_mib == 64);
  CHECK(use->memory_kills == 0);
  CHECK(use->cpu_s >= 0);
  CHECK(cgroup.remove());
  // Less than a program needs is no bound that anybody means.
  const auto small = instance_cgroup::make(host.place, "i", {0.5, 0});
  CHECK(read_use(small.folders())->memory_limit_mib == 6);
  CHECK(small.remove());
  const auto free = instance_cgroup::make(host.place, "i", {0, 0});
  CHECK(read_use(free.folders())->memory_limit_mib < 0);
  CHECK(free.remove());
}

TEST_CASE("all who are in a cgroup are killed, and it is removed", "[cgroup]") {
  const real_place host;
  if (host.place.version == 0)
    return;
  const auto cgroup = instance_cgroup::make(host.place, "i", {});
  {
    const member one{cgroup};
    const member two{cgroup};
    CHECK((one.is_in(cgroup.folders().back())
           && two.is_in(cgroup.folders().back())));
    CHECK_FALSE(cgroup.remove());
    CHECK(cgroup.kill());
  }
  CHECK_FALSE(cgroup.kill());
  CHECK(cgroup.remove());
  CHECK(cgroup.remove());
}

TEST_CASE("what is left of other instances goes, what is known stays",
          "[cgroup]") {
  const real_place host;
  if (host.place.version == 0)
    return;
  const auto kept = instance_cgroup::make(host.place, "kept", {});
  const auto left = instance_cgroup::make(host.place, "left", {});
  CHECK(remove_other_cgroups(host.place, {"kept"}).empty());
  CHECK(fs::exists(kept.folders().front()));
  CHECK_FALSE(fs::exists(left.folders().front()));
  CHECK(kept.remove());
}

TEST_CASE("a cgroup is found again by what its instance's folder says",
          "[cgroup]") {
  const temp_folder folder;
  const cgroup_place place{
      1, {{folder.path() / "a", {}}, {folder.path() / "b", {}}}, ""};
  fs::create_directories(folder.path() / "a");
  fs::create_directories(folder.path() / "records/i");
  const auto records = folder.path() / "records/i";
  // The place of the second one is made anew.
  const auto made = instance_cgroup::make(place, "i", {});
  REQUIRE(made.folders().size() == 2);
  write(folder.path() / "a/i/cgroup.procs", "");
  write(folder.path() / "b/i/cgroup.procs", "");
  made.record(records);
  CHECK(instance_cgroup::recall(records).folders() == made.folders());
  CHECK(instance_cgroup::named(place, "i").folders() == made.folders());
  CHECK(instance_cgroup::named(place, "j").folders().empty());
  CHECK(instance_cgroup::recall(folder.path() / "none").folders().empty());
}

TEST_CASE("a record that names something else is none", "[cgroup]") {
  const temp_folder folder;
  const auto records = folder.path() / "i";
  fs::create_directories(records);
  write(folder.path() / "other/cgroup.procs", "");
  for (const auto& text :
       {(folder.path() / "other").string(), std::string{"i"}, std::string{"/"},
        std::string{":::"}, (folder.path() / "x/i").string()}) {
    fs::remove(records / "cgroup");
    fs::create_symlink(text, records / "cgroup");
    CHECK(instance_cgroup::recall(records).folders().empty());
  }
}

TEST_CASE("the share of CPU is that of the cores that are reserved",
          "[cgroup]") {
  CHECK(cpu_weight_of(1) == 100);
  CHECK(cpu_weight_of(0.001) == 1);
  CHECK(cpu_weight_of(1000) == 10'000);
  CHECK(cpu_shares_of(1) == 1024);
  CHECK(cpu_shares_of(0.0001) == 2);
  CHECK(cpu_shares_of(1000) == 262'144);
}

TEST_CASE("the use of a cgroup is read, of either version", "[cgroup]") {
  const temp_folder folder;
  const auto unified = folder.path() / "unified";
  write(unified / "memory.current", "104857600\n");
  write(unified / "memory.max", "134217728\n");
  write(unified / "memory.stat", "anon 1\ninactive_file 20971520\n");
  write(unified / "memory.events", "low 0\noom 3\noom_kill 2\n");
  write(unified / "cpu.stat", "usage_usec 2500000\nuser_usec 1\n");
  auto use = read_use({unified});
  REQUIRE(use);
  CHECK(use->memory_mib == 80);
  CHECK(use->memory_limit_mib == 128);
  CHECK(use->memory_kills == 2);
  CHECK(use->cpu_s == 2.5);
  const auto memory = folder.path() / "memory";
  const auto cpu = folder.path() / "cpuacct";
  write(memory / "memory.usage_in_bytes", "10485760\n");
  write(memory / "memory.limit_in_bytes", "9223372036854771712\n");
  write(memory / "memory.stat",
        "inactive_file 1\ntotal_inactive_file 2097152\n");
  write(memory / "memory.oom_control", "oom_kill_disable 0\noom_kill 1\n");
  write(cpu / "cpuacct.usage", "1500000000\n");
  use = read_use({memory, cpu});
  REQUIRE(use);
  CHECK(use->memory_mib == 8);
  CHECK(use->memory_limit_mib < 0);
  CHECK(use->memory_kills == 1);
  CHECK(use->cpu_s == 1.5);
  CHECK_FALSE(read_use({folder.path()}));
  write(unified / "memory.current", "no number\n");
  write(unified / "cpu.stat", "garbage");
  CHECK_FALSE(read_use({unified}));
}
