#include "test/skills/temp_folder.hpp"
#include "tools/roscell/doctor/host/process_maps.hpp"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

using namespace roscell;

namespace {

void add_process(const std::filesystem::path& at, const std::string& root,
                 const std::string& mapped) {
  create_directories(at);
  std::ofstream{at / "maps"} << "7f00-7f80 rw-s 00000000 00:1b 93  " << mapped
                             << '\n';
  std::filesystem::create_directory_symlink(root, at / "root");
}

} // namespace

TEST_CASE("what a process maps is below its own root, however that is shown") {
  const test::temp_folder folder;
  const std::filesystem::path proc = folder / "proc";
  add_process(proc / "12", "/", "/dev/shm/of the host");
  // From a chroot, of a process with mounts of its own.
  add_process(proc / "13", "/srv/root", "/srv/root/dev/shm/beside it");
  add_process(proc / "14", "/", "/srv/root/dev/shm/of nobody");
  std::vector<std::string> names;
  cli::visit_mapped_files(proc, "/dev/shm", [&](const cli::mapped_file& x) {
    names.push_back(x.name);
  });
  std::sort(names.begin(), names.end());
  CHECK(names == std::vector<std::string>{"beside it", "of the host"});
}
