#include "actors/edge/cgroup/cgroup_place.hpp"

#include "test/actors/edge/process/supervision_fixture.hpp"

#include <filesystem>
#include <fstream>
#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

/// A folder that looks as a hierarchy of version 2. What is enabled there it
/// only notes, the last word.
struct fake_unified {
  fake_unified() {
    make("");
    make("system.slice");
    make("system.slice/roscell.service");
  }

  void make(const std::string& name) const {
    const auto path = folder.path() / name;
    fs::create_directories(path);
    for (const auto* file :
         {"cgroup.procs", "cgroup.controllers", "cgroup.subtree_control"})
      std::ofstream{path / file};
  }

  cgroup_sight sight() const {
    return {{{true, {}, "/", folder.path()}},
            {{{}, "/system.slice/roscell.service"}}};
  }

  temp_folder folder;
};

std::vector<std::string> folders_in(const cgroup_request& request,
                                    const cgroup_sight& sight) {
  std::vector<std::string> result;
  for (const auto& alternative : places_to_try(request, sight))
    for (const auto& x : alternative)
      result.push_back(x.folder.string());
  return result;
}

cgroup_sight version_1() {
  return {{{true, {}, "/", "/sys/fs/cgroup/unified"},
           {false, {"memory"}, "/", "/sys/fs/cgroup/memory"},
           {false, {"cpu", "cpuacct"}, "/", "/sys/fs/cgroup/cpu,cpuacct"}},
          {{{}, "/"}, {{"memory"}, "/jobs"}, {{"cpu", "cpuacct"}, "/"}}};
}

} // namespace

TEST_CASE("the place that the package prepares comes first", "[cgroup]") {
  const fake_unified host;
  const auto top = host.folder.path().string();
  CHECK(folders_in({"auto", "u", true}, host.sight())
        == std::vector<std::string>{top + "/roscell.slice/instances",
                                    top + "/roscell", top + "/system.slice",
                                    top + "/system.slice/roscell.service"});
  CHECK(folders_in({"auto", "u", false}, host.sight())
        == std::vector<std::string>{top + "/roscell.slice/instances",
                                    top + "/system.slice",
                                    top + "/system.slice/roscell.service"});
}

TEST_CASE("of version 1 it is each hierarchy, beside the node or prepared",
          "[cgroup]") {
  CHECK(folders_in({"auto", "u", true}, version_1())
        == std::vector<std::string>{
            "/sys/fs/cgroup/memory/roscell-instances",
            "/sys/fs/cgroup/cpu,cpuacct/roscell-instances",
            "/sys/fs/cgroup/memory/jobs", "/sys/fs/cgroup/cpu,cpuacct"});
}

TEST_CASE("a folder that is named is the only place", "[cgroup]") {
  const fake_unified host;
  CHECK(folders_in({"/sys/fs/cgroup/x/y", "u", true}, host.sight())
        == std::vector<std::string>{"/sys/fs/cgroup/x/y"});
  CHECK(folders_in({"/sys/fs/cgroup/x/y", "u", true}, version_1())
        == std::vector<std::string>{"/sys/fs/cgroup/memory/x/y",
                                    "/sys/fs/cgroup/cpu,cpuacct/x/y"});
  CHECK(folders_in({"none", "u", true}, host.sight()).empty());
}

TEST_CASE("a node has a folder of its own there, and those that ended go",
          "[cgroup]") {
  const fake_unified host;
  const auto top = host.folder.path() / "roscell.slice/instances";
  host.make("roscell.slice/instances");
  fs::create_directories(top / "node-of-another");
  fs::create_directories(top / "node-in-use/instance");
  fs::create_directories(top / "something-else");
  const auto place = find_cgroup_place({"auto", "uuid", false}, host.sight());
  CHECK(place.version == 2);
  REQUIRE(place.parents.size() == 1);
  CHECK(place.parents[0].folder == top / "node-uuid");
  CHECK(fs::is_directory(top / "node-uuid"));
  CHECK_FALSE(fs::exists(top / "node-of-another"));
  CHECK(fs::exists(top / "node-in-use/instance"));
  CHECK(fs::exists(top / "something-else"));
  remove_place(place);
  CHECK_FALSE(fs::exists(top / "node-uuid"));
}

TEST_CASE("where nothing can be made it is said why", "[cgroup]") {
  const fake_unified host;
  CHECK(find_cgroup_place({"none", "u", true}, host.sight()).text
        == "none: it was told so");
  CHECK(find_cgroup_place({"auto", "u", true}, {}).text
        == "none: this host has no cgroups");
  const auto named =
      find_cgroup_place({"/no/such/folder", "u", false}, host.sight());
  CHECK(named.version == 0);
  CHECK(named.text.find("'/no/such/folder' cannot be used")
        != std::string::npos);
}

TEST_CASE("without memory it is said that memory is not bounded", "[cgroup]") {
  const fake_unified host;
  host.make("roscell.slice/instances");
  const auto folder = host.folder.path() / "roscell.slice/instances/node-u";
  fs::create_directories(folder);
  std::ofstream{folder / "cgroup.subtree_control"} << "pids";
  const auto place = find_cgroup_place({"auto", "u", false}, host.sight());
  CHECK(place.version == 2);
  CHECK_FALSE(place.has("memory"));
  CHECK(place.text.find("but not memory") != std::string::npos);
}
