#include "actors/edge/host/own_process.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <sys/resource.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace roscell::test {

TEST_CASE("a process's cost is read from the kernel's files", "[own_cost]") {
  temp_folder folder;
  const auto ticks = std::to_string(3 * sysconf(_SC_CLK_TCK));
  folder.write("/stat", "7 (a (b) c) S 1 2 3 4 5 6 7 8 9 10 " + ticks
                            + " 0 0 0 20 0 1 0 " + ticks + "00 4096\n");
  folder.write("/smaps_rollup", "0-1 ---p\nRss: 20 kB\nPss: 10 kB\n");
  folder.write("/io",
               "read_bytes: 1\nwrite_bytes: 4096\ncancelled_write_bytes: 0\n");
  const auto cost = read_own_cost(folder.path());
  CHECK(cost.cpu_seconds == Approx(3));
  CHECK(cost.started_s == Approx(300));
  CHECK(cost.resident_bytes == 20 * 1024);
  CHECK(cost.pss_bytes == 10 * 1024);
  CHECK(cost.written_bytes == 4096);
}

TEST_CASE("what the kernel does not tell costs nothing", "[own_cost]") {
  const temp_folder folder;
  const auto cost = read_own_cost(folder / "nobody");
  CHECK(cost.cpu_seconds == 0);
  CHECK(cost.pss_bytes == 0);
}

TEST_CASE("when the host was booted is the same at each look", "[own_cost]") {
  temp_folder folder{"/stat",
                     "cpu  1 2 3 4\nintr 5 6\nbtime 1700000000\nctxt 7\n"};
  CHECK(read_boot_time(folder / "stat") == 1'700'000'000);
  CHECK(read_boot_time(folder / "nobody") == 0);
  CHECK(read_boot_time() > 0);
  CHECK(read_boot_time() == read_boot_time());
}

TEST_CASE("this process has a cost", "[own_cost]") {
  const auto cost = read_own_cost();
  CHECK(cost.resident_bytes > 0);
  CHECK(cost.open_files > 0);
}

namespace {

/// What proc(5) says of a host, as far as its boot is concerned.
struct paper_host {
  paper_host(const std::string& id, const std::string& started) {
    folder.write("sys/kernel/random/boot_id", id);
    // Field 22; the name in the second one may hold anything.
    folder.write("1/stat",
                 "1 (a) b (init) S 0 1 1 0 -1 4194560 1 2 3 4 5 6 7 8 "
                 "20 0 1 0 "
                     + started + " 1 2\n");
  }

  std::string boot() const {
    return this_boot(folder.path());
  }

  temp_folder folder;
};

} // namespace

TEST_CASE("A boot is another one with its id, or with the first process",
          "[boot_id]") {
  const paper_host host{"b-1\n", "7"};
  CHECK_FALSE(host.boot().empty());
  CHECK(paper_host{"b-1\n", "7"}.boot() == host.boot());
  CHECK(paper_host{"b-2\n", "7"}.boot() != host.boot());
  // A container that is the host of a node was started again.
  CHECK(paper_host{"b-1\n", "8"}.boot() != host.boot());
}

TEST_CASE("A boot that cannot be read is not known", "[boot_id]") {
  CHECK(this_boot("/nonexistent").empty());
  CHECK(paper_host{"", "7"}.boot().empty());
  CHECK(paper_host{"\n", "7"}.boot().empty());
  CHECK(paper_host{"b-1\n", "x"}.boot().empty());
  CHECK(paper_host{std::string(1000, 'b'), "7"}.boot().empty());
}

TEST_CASE("This host has a boot", "[boot_id]") {
  CHECK_FALSE(this_boot().empty());
  CHECK(this_boot() == this_boot());
}

TEST_CASE("A node may open as many descriptors as the host lets it",
          "[descriptor_limit]") {
  rlimit before{};
  REQUIRE(::getrlimit(RLIMIT_NOFILE, &before) == 0);
  auto low = before;
  low.rlim_cur = 256;
  REQUIRE(::setrlimit(RLIMIT_NOFILE, &low) == 0);
  CHECK(raise_descriptor_limit() == before.rlim_max);
  rlimit after{};
  CHECK(::getrlimit(RLIMIT_NOFILE, &after) == 0);
  CHECK(after.rlim_cur == before.rlim_max);
  CHECK(::setrlimit(RLIMIT_NOFILE, &before) == 0);
}

} // namespace roscell::test

using namespace roscell;
namespace fs = std::filesystem;

namespace {

struct prefix {
  test::temp_folder folder;
  const fs::path root = folder.path();

  prefix() {
    fs::create_directories(root / "bin");
  }
};

} // namespace

TEST_CASE_METHOD(prefix,
                 "a shim beside the program comes before the installed") {
  CHECK(find_shim(root / "bin") == root / "lib/roscell/roscell-instance-shim");
  std::ofstream{root / "bin" / "roscell-instance-shim"};
  CHECK(find_shim(root / "bin") == root / "bin" / "roscell-instance-shim");
}

TEST_CASE("skills are installed beside the folder of programs") {
  CHECK(installed_skills("/usr/bin") == "/usr/lib/roscell/skills");
  CHECK(installed_skills("/opt/cell/bin") == "/opt/cell/lib/roscell/skills");
}

TEST_CASE("this process has a folder of programs") {
  CHECK(fs::is_directory(program_folder()));
}

TEST_CASE_METHOD(prefix, "a folder is known by whatever path") {
  fs::create_directory_symlink(root / "bin", root / "programs");
  CHECK(names_folder({root / "programs"}, root / "bin"));
  CHECK_FALSE(names_folder({root}, root / "bin"));
  CHECK_FALSE(names_folder({}, root / "bin"));
}
