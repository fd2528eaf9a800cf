#include "actors/edge/host/installed_files.hpp"

#include <catch2/catch.hpp>

#include <fstream>
#include <string>

#include <unistd.h>

using namespace roscell;
namespace fs = std::filesystem;

namespace {

struct prefix {
  fs::path root = fs::temp_directory_path()
                  / ("roscell-installed-" + std::to_string(getpid()));
  prefix() {
    fs::create_directories(root / "bin");
  }
  ~prefix() {
    fs::remove_all(root);
  }
  prefix(const prefix&) = delete;
  prefix& operator=(const prefix&) = delete;
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
