#include "actors/edge/io/unique_fd.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"
#include "test/places.hpp"
#include "tools/roscell/doctor/host/disk.hpp"
#include "tools/roscell/doctor/host/gpu.hpp"
#include "tools/roscell/doctor/host/kernel.hpp"
#include "tools/roscell/doctor/host/programs.hpp"
#include "tools/roscell/doctor/host/shared_memory.hpp"

#include <catch2/catch.hpp>

#include <sys/inotify.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>

using namespace roscell;
using namespace roscell::cli;
using Catch::Contains;

TEST_CASE("a clock that nothing synchronises is a warning", "[doctor]") {
  CHECK(judge_clock({true, true, 20'000}).how == judgement::ok);
  CHECK(judge_clock({true, false, 16'000'000}).how == judgement::warning);
  CHECK(judge_clock({true, true, 2'000'000}).how == judgement::warning);
  CHECK(judge_clock({}).how == judgement::skipped);
}

TEST_CASE("a disk is judged by its room and by its files", "[doctor]") {
  disk_readings disk{"/data", "/data", 0, 50ULL << 30, 1'000'000, true};
  CHECK(judge_disk(disk).front().how == judgement::ok);
  disk.free_files = 0;
  CHECK(judge_disk(disk).front().remedy == "df -i /data");
  disk.free_files = 1'000'000;
  disk.free_bytes = 100ULL << 20;
  CHECK(judge_disk(disk).front().how == judgement::warning);
  disk.free_bytes = 0;
  CHECK(judge_disk(disk).front().how == judgement::broken);
}

TEST_CASE("a folder that is there is given to nobody else", "[doctor]") {
  disk_readings disk{"/run/x", "/run/x", EACCES, 50ULL << 30, 1'000'000, true};
  CHECK(judge_disk(disk).front().remedy == "ls -ld /run/x && id");
  disk.data_dir = "/run/x/$(id)";
  CHECK_THAT(judge_disk(disk).front().remedy,
             Contains("sudo install -d -m 700 -o ")
                 && Contains("'/run/x/$(id)'"));
}

TEST_CASE("fsync is judged by its median", "[doctor]") {
  CHECK(judge_fsync("/data", {0.2, 0.3, 900}).how == judgement::ok);
  CHECK(judge_fsync("/data", {80, 90, 0.1}).how == judgement::warning);
}

TEST_CASE("an engine is broken only where it was asked for", "[doctor]") {
  const asked_engine closed{
      "/var/run/docker.sock", true,
      edge_error{error_code::unauthorized, "no permission", ""}};
  const asked_engine none{"/run/podman/podman.sock", false,
                          edge_error{error_code::unreachable, "none", ""}};
  const asked_engine good{"/run/user/7/podman/podman.sock", true,
                          found_engine{"/run/user/7/podman/podman.sock",
                                       "podman", "", "1.41", true}};
  CHECK(judge_engines("auto", {closed, none}, true)[0].how
        == judgement::warning);
  CHECK(judge_engines("docker", {closed}, true)[0].how == judgement::broken);
  CHECK(judge_engines("auto", {none}, true)[0].how == judgement::skipped);
  CHECK(judge_engines("podman", {none}, true)[0].how == judgement::broken);
  CHECK(judge_engines("process", {}, true)[0].how == judgement::skipped);
  CHECK(judge_engines("auto", {closed, good}, true).size() == 1);
  CHECK(judge_engines("auto", {good}, false)[0].how == judgement::warning);
  // A new start would end the containers that run.
  const asked_engine hangs{"/var/run/docker.sock", true,
                           edge_error{error_code::timeout, "no answer", ""}};
  CHECK(judge_engines("docker", {hangs}, true)[0].remedy
        == "sudo systemctl status docker");
}

TEST_CASE("inotify instances are judged by how many are left", "[doctor]") {
  CHECK(judge_inotify({}).how == judgement::skipped);
  CHECK(judge_inotify({128, 3}).how == judgement::ok);
  const auto few = judge_inotify({128, 120});
  CHECK(few.how == judgement::warning);
  CHECK(few.seen == "120 of 128 inotify instances of this user are in use");
  CHECK(few.remedy == "sudo sysctl -w fs.inotify.max_user_instances=1024");
  CHECK(judge_inotify({4096, 4096}).remedy
        == "sudo sysctl -w fs.inotify.max_user_instances=8192");
}

TEST_CASE("the inotify instances of this user are counted", "[doctor]") {
  const auto before = read_inotify("/proc", ::geteuid());
  CHECK(before.most > 0);
  const unique_fd one{::inotify_init1(IN_CLOEXEC)};
  // Others of this user come and go meanwhile.
  if (one)
    CHECK(read_inotify("/proc", ::geteuid()).used > 0);
  CHECK(read_inotify("/nowhere", ::geteuid()).most < 0);
}

TEST_CASE("what of a GPU is missing is named", "[doctor]") {
  gpu_readings gpu;
  CHECK(judge_gpu(gpu).how == judgement::skipped);
  gpu.card = true;
  CHECK_THAT(judge_gpu(gpu).remedy, Contains("modprobe nvidia"));
  gpu.module = "535.129.03";
  gpu.devices = {"/dev/nvidia0"};
  CHECK_THAT(judge_gpu(gpu).seen, Contains("no libnvidia-ml.so.1"));
  gpu.library = true;
  gpu.library_error = "Driver/library version mismatch";
  CHECK(judge_gpu(gpu).how == judgement::broken);
  CHECK_THAT(judge_gpu(gpu).remedy, Contains("reboot"));
  gpu.library_error.clear();
  gpu.gpus = {"NVIDIA H100, 80 GiB"};
  CHECK(judge_gpu(gpu).how == judgement::ok);
  gpu.unusable_device = "/dev/nvidia0";
  CHECK(judge_gpu(gpu).how == judgement::warning);
  // Nobody is put into the group of root for it.
  CHECK_THAT(judge_gpu(gpu).remedy, Contains("sudo chmod a+rw /dev/nvidia0"));
  gpu.device_group = "video";
  CHECK_THAT(judge_gpu(gpu).remedy, Contains("sudo usermod -aG video "));
}

TEST_CASE("the real library is asked for its GPUs", "[doctor]") {
  checked_host host;
  host.nvml = test::fake_nvml();
  const auto gpu = read_gpu(host);
  CHECK(gpu.library);
  CHECK(gpu.library_error.empty());
  REQUIRE_FALSE(gpu.gpus.empty());
  CHECK_THAT(gpu.gpus.front(), Contains("Fake GPU 0"));
}

TEST_CASE("shared memory is judged by room and by who may write", "[doctor]") {
  shared_memory_readings memory{true, true, true, 0, 8ULL << 30, 8ULL << 30};
  const auto judge = [&] {
    return judge_shared_memory("/dev/shm", memory).how;
  };
  CHECK(judge() == judgement::ok);
  memory.all_write = false;
  CHECK(judge() == judgement::warning);
  memory.write_error = EACCES;
  CHECK(judge() == judgement::broken);
  memory = {true, true, true, 0, 64ULL << 20, 64ULL << 20};
  CHECK(judge() == judgement::warning);
  memory.free = 0;
  CHECK(judge() == judgement::broken);
  memory = {true, false, true, 0, 8ULL << 30, 8ULL << 30};
  CHECK(judge() == judgement::warning);
  CHECK(judge_shared_memory("/dev/shm", {}).how == judgement::broken);
}

TEST_CASE("a folder of fences that is not its user's is told", "[doctor]") {
  const test::temp_folder shm;
  const auto own = "roscell-" + std::to_string(::geteuid());
  std::filesystem::create_directory(shm.path() / own);
  std::filesystem::permissions(shm.path() / own,
                               std::filesystem::perms::owner_all);
  shm.write("roscell-x", "no such folder");
  CHECK(judge_fence_folders(shm.path()).empty());
  const auto other = shm.path() / "roscell-4242";
  std::filesystem::create_directory(other);
  const auto found = judge_fence_folders(shm.path());
  REQUIRE(found.size() == 1);
  CHECK(found.front().how == judgement::broken);
  CHECK(found.front().seen.find("should be '#4242''s") != std::string::npos);
  CHECK(found.front().remedy == "sudo rm -r " + other.string());
}

TEST_CASE("few descriptors, another library and bad skills are told",
          "[doctor]") {
  CHECK(judge_descriptors(1 << 20).how == judgement::ok);
  CHECK(judge_descriptors(1024).how == judgement::warning);
  CHECK(judge_descriptors(64).how == judgement::broken);
  CHECK(judge_versions("2.9.1", "/usr/lib/libfastrtps.so.2.9.1").how
        == judgement::ok);
  CHECK(judge_versions("2.9.1", "/opt/libfastrtps.so.2.10.0").how
        == judgement::warning);
  const auto bad =
      judge_skills(3, {{"/skills/echo/skill.json", "", "no program"}});
  REQUIRE(bad.size() == 1);
  CHECK(bad[0].remedy == "roscell skill check /skills/echo");
  CHECK(judge_skills(0, {})[0].how == judgement::skipped);
}
