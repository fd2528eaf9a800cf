#include "roscell/skill/errors.hpp"
#include "skills/engine/file/file_protocol.hpp"
#include "skills/engine/file/file_reading.hpp"
#include "test/skills/support.hpp"

#include <catch2/catch.hpp>

#include <sched.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <functional>
#include <future>
#include <utility>

using namespace roscell::engine;
using namespace roscell::test;
using Catch::Matchers::Contains;

namespace {

std::unique_ptr<input_handler>
make_input(const std::string& path, const std::string& options = "{}",
           const std::string& type = "text/plain") {
  return make_file_input({{"file", path, type},
                          parameters::parse(options),
                          [](const std::string&) {}});
}

/// Payload of frame `n`, or "nothing".
std::string payload(running_input& input, std::size_t n) {
  auto f = input.sink().wait_for(n);
  return f ? f->payload : "nothing";
}

std::string name(running_input& input, std::size_t n) {
  auto f = input.sink().wait_for(n);
  return f ? f->name : "nothing";
}

const std::string once = R"({"follow":false})";

} // namespace

TEST_CASE("each line of a text file is a frame, also the last one") {
  temp_folder folder{"in.txt", "one\n\nthree"};
  running_input input{make_input(folder / "in.txt", once)};
  CHECK(input.wait() == "ended");
  CHECK(payload(input, 0) == "one");
  CHECK(payload(input, 1).empty());
  CHECK(payload(input, 2) == "three");
  CHECK(name(input, 2) == "in.txt:3");
  CHECK(input.sink().policies() == std::vector<when_full>(3, when_full::wait));
}

TEST_CASE("a text file is followed as it grows") {
  temp_folder folder{"in", "one\n"};
  running_input input{make_input(folder / "in")};
  CHECK(payload(input, 0) == "one");
  folder.append("in", "two\n");
  CHECK(payload(input, 1) == "two");
  // The writer closes the file, so its last line is complete.
  folder.append("in", "three");
  CHECK(payload(input, 2) == "three");
}

TEST_CASE("a text file that is cut is read from its start") {
  temp_folder folder{"in", "a long first line\n"};
  running_input input{make_input(folder / "in")};
  CHECK(payload(input, 0) == "a long first line");
  REQUIRE(::truncate((folder / "in").c_str(), 0) == 0);
  folder.append("in", "new\n");
  CHECK(payload(input, 1) == "new");
}

TEST_CASE("a text file is followed across its replacement") {
  temp_folder folder{"in", "old\nrest"};
  running_input input{make_input(folder / "in")};
  CHECK(payload(input, 0) == "old");
  folder.write("new", "new\n");
  REQUIRE(std::rename((folder / "new").c_str(), (folder / "in").c_str()) == 0);
  CHECK(payload(input, 1) == "rest");
  CHECK(payload(input, 2) == "new");
  folder.append("in", "more\n");
  CHECK(payload(input, 3) == "more");
}

TEST_CASE("a text file may be away for a while") {
  temp_folder folder{"in", "old\n"};
  running_input input{make_input(folder / "in")};
  CHECK(payload(input, 0) == "old");
  REQUIRE(std::rename((folder / "in").c_str(), (folder / "old").c_str()) == 0);
  folder.write("in", "new\n");
  CHECK(payload(input, 1) == "new");
}

TEST_CASE("the files of a folder are frames in the order of their names") {
  temp_folder folder;
  for (const auto* file : {"c", "a", "b", ".hidden"})
    folder.write(file, std::string{"content of "} + file);
  std::filesystem::create_directory(folder / "aa");
  REQUIRE(::mkfifo((folder / "ab").c_str(), 0600) == 0);
  running_input input{make_input(folder / "", once, "image/png")};
  CHECK(input.wait() == "ended");
  CHECK(payload(input, 0) == "content of a");
  CHECK(payload(input, 1) == "content of b");
  CHECK(payload(input, 2) == "content of c");
  CHECK(name(input, 2) == "c");
  CHECK(input.sink().policies().size() == 3);
}

TEST_CASE("an empty folder is waited for, once it is known to be one") {
  temp_folder folder;
  std::filesystem::create_directory(folder / "in");
  std::promise<std::string> said;
  running_input input{make_file_input(
      {{"file", folder / "in", "text/plain"},
       parameters::parse("{}"),
       [&said](const std::string& text) { said.set_value(text); }})};
  auto waiting = said.get_future();
  REQUIRE(waiting.wait_for(patience) == std::future_status::ready);
  CHECK_THAT(waiting.get(), Contains("is empty; waiting for files"));
  folder.write("in/written", "w");
  CHECK(payload(input, 0) == "w");
  folder.write(".tmp", "renamed");
  REQUIRE(std::rename((folder / ".tmp").c_str(), (folder / "in/r").c_str())
          == 0);
  CHECK(payload(input, 1) == "renamed");
  CHECK(name(input, 1) == "r");
}

TEST_CASE("a file of a folder that is replaced is a new frame") {
  temp_folder folder;
  std::filesystem::create_directory(folder / "in");
  folder.write("in/a", "first");
  running_input input{make_input(folder / "in")};
  CHECK(payload(input, 0) == "first");
  folder.write("a", "the second");
  REQUIRE(std::rename((folder / "a").c_str(), (folder / "in/a").c_str()) == 0);
  CHECK(payload(input, 1) == "the second");
  std::filesystem::remove(folder / "in/a");
  folder.write("in/a", "third");
  CHECK(payload(input, 2) == "third");
}

TEST_CASE("a folder that is taken away breaks the input") {
  temp_folder folder;
  std::filesystem::create_directory(folder / "in");
  folder.write("in/a", "a");
  running_input input{make_input(folder / "in")};
  CHECK(payload(input, 0) == "a");
  std::filesystem::remove_all(folder / "in");
  CHECK_THAT(input.wait(), Contains("was taken away"));
}

TEST_CASE("a file of another type is one frame, and one more when replaced") {
  temp_folder folder{"in.png", "line\nline\n"};
  running_input input{make_input(folder / "in.png", "{}", "image/png")};
  CHECK(payload(input, 0) == "line\nline\n");
  folder.write("new", "another");
  REQUIRE(std::rename((folder / "new").c_str(), (folder / "in.png").c_str())
          == 0);
  CHECK(payload(input, 1) == "another");
  folder.write("in.png", "rewritten");
  CHECK(payload(input, 2) == "rewritten");
}

TEST_CASE("a frame that is too large is skipped and said") {
  temp_folder folder;
  folder.write("a", std::string(1024UL * 1024 + 1, 'x'));
  folder.write("b", std::string(1024UL * 1024, 'x'));
  std::string said;
  running_input input{
      make_file_input({{"file", folder / "", "image/png"},
                       parameters_of({{"follow", false}, {"max_frame_mib", 1}}),
                       [&](const std::string& line) { said += line; }})};
  CHECK(input.wait() == "ended");
  CHECK(name(input, 0) == "b");
  CHECK_THAT(said, Contains("/a'") && Contains("max_frame_mib"));
}

TEST_CASE("the rate of an input is limited") {
  temp_folder folder{"in", "1\n2\n3\n4\n5\n"};
  auto start = std::chrono::steady_clock::now();
  running_input input{
      make_input(folder / "in", R"({"follow":false,"rate_hz":100})")};
  CHECK(input.wait() == "ended");
  auto spent = std::chrono::steady_clock::now() - start;
  CHECK(input.sink().policies().size() == 5);
  // Four periods lie between five frames; there is no upper bound to test.
  CHECK(spent >= std::chrono::milliseconds{40});
}

TEST_CASE("an input that waits for its turn ends when the skill stops") {
  temp_folder folder{"in", "1\n2\n"};
  running_input input{make_input(folder / "in", R"({"rate_hz":1e-300})")};
  CHECK(payload(input, 0) == "1");
  // The destructor stops the input and would hang if it did not end.
}

TEST_CASE("an unusable input is refused with its path") {
  temp_folder folder;
  CHECK_THROWS_WITH(make_input(folder / "missing"),
                    Contains("/missing'") && Contains("No such file"));
  CHECK_THROWS_WITH(make_input("relative"), Contains("absolute path"));
  CHECK_THROWS_WITH(make_input("/dev/null"),
                    Contains("neither a regular file"));
  folder.write("in", "");
  CHECK_THROWS_WITH(make_input(folder / "in", R"({"rate_hz":-1})"),
                    Contains("rate_hz"));
}

TEST_CASE("a folder of images leaves out the descriptions beside them") {
  temp_folder folder;
  for (const auto* name : {"a.png", "camera.json", "calibration.yaml", "c.yml",
                           "licence.txt", "README.md", "z"})
    folder.write(name, name);
  running_input images{make_input(folder / "", once, "image/png")};
  CHECK(images.wait() == "ended");
  CHECK(images.sink().policies().size() == 2);
  CHECK(payload(images, 0) == "a.png");
  CHECK(payload(images, 1) == "z");
  running_input all{make_input(folder / "", once)};
  CHECK(all.wait() == "ended");
  CHECK(all.sink().policies().size() == 7);
}

TEST_CASE("a folder in a loop begins again, with what is there then") {
  temp_folder folder;
  folder.write("a", "1");
  folder.write("b", "2");
  running_input input{make_input(
      folder / "", R"({"follow":false,"loop":true,"rate_hz":1000})")};
  CHECK(payload(input, 0) == "1");
  CHECK(payload(input, 1) == "2");
  CHECK(payload(input, 2) == "1");
  CHECK(payload(input, 3) == "2");
  std::filesystem::remove(folder / "a");
  std::filesystem::remove(folder / "b");
  CHECK(input.wait() == "ended");
}

TEST_CASE("an empty folder in a loop ends, or waits for files") {
  temp_folder folder;
  running_input input{
      make_input(folder / "", R"({"follow":false,"loop":true})")};
  CHECK(input.wait() == "ended");
  running_input waiting{
      make_input(folder / "", R"({"loop":true,"rate_hz":1000})")};
  folder.write("a", "1");
  CHECK(payload(waiting, 0) == "1");
  CHECK(payload(waiting, 1) == "1");
}

// Files are followed also where the user has no inotify instance left.

namespace {

constexpr int no_namespace = 77;

/// Runs `body` in a process whose user may have no inotify instance; the user
/// of this process is not touched. True if it was, or such a process cannot be
/// had here.
bool holds_without_inotify(const std::function<bool()>& body) {
  const auto child = ::fork();
  if (child == 0) {
    if (::unshare(CLONE_NEWUSER) != 0)
      ::_exit(no_namespace);
    {
      std::ofstream limit{"/proc/sys/user/max_inotify_instances"};
      if (!(limit << "0" << std::flush))
        ::_exit(no_namespace);
    }
    ::_exit(body() ? 0 : 1);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == no_namespace) {
    WARN("no user namespace can be had here");
    return true;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// An input, and what it has said.
struct said_input {
  said_input(const std::string& path, const std::string& type)
      : input(make_file_input(
          {{"file", path, type},
           parameters::parse("{}"),
           [this](const std::string& line) { said += line + '\n'; }})) {}

  bool gives(std::size_t n, const std::string& text) {
    const auto found = input.sink().wait_for(n);
    return found && found->payload == text;
  }

  std::string said;
  running_input input;
};

} // namespace

TEST_CASE("a text file is followed without inotify, and that is said") {
  temp_folder folder{"in", "one\n"};
  CHECK(holds_without_inotify([&] {
    said_input x{folder / "in", "text/plain"};
    const bool begins = x.gives(0, "one");
    folder.append("in", "two\n");
    const bool grows = x.gives(1, "two");
    folder.write("new", "three\n");
    std::rename((folder / "new").c_str(), (folder / "in").c_str());
    return begins && grows && x.gives(2, "three")
           && x.said.find("fs.inotify.max_user_instances") != std::string::npos;
  }));
}

TEST_CASE("a file of another type is followed without inotify, once for each "
          "content") {
  temp_folder folder{"in", "one"};
  CHECK(holds_without_inotify([&] {
    said_input x{folder / "in", "image/png"};
    const bool begins = x.gives(0, "one");
    folder.write("in", "second");
    return begins && x.gives(1, "second");
  }));
}

TEST_CASE("a folder is followed without inotify") {
  temp_folder folder{"a", "one"};
  CHECK(holds_without_inotify([&] {
    said_input x{folder / "", "application/octet-stream"};
    const bool begins = x.gives(0, "one");
    folder.write("b", "two");
    return begins && x.gives(1, "two");
  }));
}

TEST_CASE("what is still being written is not taken where changes are looked "
          "for") {
  temp_folder folder{"a", "half"};
  CHECK(holds_without_inotify([&] {
    const inotify_watch changes;
    struct stat info {};
    if (!changes.looks() || ::stat((folder / "a").c_str(), &info) != 0)
      return false;
    info.st_mtim.tv_sec = std::time(nullptr) + 3600;
    const bool of_future = changes.may_be_unfinished(info);
    info.st_mtim.tv_sec = std::time(nullptr) - 3600;
    const bool of_past = changes.may_be_unfinished(info);
    std::timespec_get(&info.st_mtim, TIME_UTC);
    return changes.may_be_unfinished(info) && !of_future && !of_past;
  }));
}
