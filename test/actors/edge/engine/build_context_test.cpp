#include "actors/edge/engine/build_context.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <fstream>
#include <iterator>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

std::string bytes_of(const fs::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

std::string list(const fs::path& tar) {
  const auto words = run_program(
      {"/bin/tar",
       {"--list", "--verbose", "--numeric-owner", "--file", tar.string()},
       {}},
      std::chrono::seconds{30}, 64 * 1024);
  return std::get<std::string>(words);
}

struct context_bench {
  image_content content() {
    skill.write("bin/run", "#!/bin/sh\n");
    fs::permissions(skill.path() / "bin/run", fs::perms::owner_all);
    const auto library = other.write("libz.so.1.2.3", "library");
    image_content result;
    result.dockerfile = "FROM base\n";
    result.skill_dir = skill.path();
    result.libraries = {{"libz.so.1", library, 7, 0}};
    return result;
  }

  own_folder skill;
  own_folder other;
  own_folder work;
};

} // namespace

TEST_CASE("a build context has Dockerfile, libraries and skill, for everyone") {
  context_bench b;
  auto content = b.content();
  fs::create_symlink("run", b.skill.path() / "bin/link");
  fs::create_symlink(".", b.skill.path() / "loop");
  const auto file =
      std::get<fs::path>(write_build_context(content, b.work.path() / "build"));
  const auto text = list(file);
  for (const auto* part :
       {"-rw-r--r-- 0/0", " Dockerfile\n", " opt/roscell/lib/libz.so.1\n",
        "-rwxr-xr-x 0/0", " opt/roscell/skill/bin/run\n",
        " opt/roscell/skill/bin/link -> run\n",
        " opt/roscell/skill/loop -> .\n"}) {
    INFO(part << " in\n" << text);
    CHECK(text.find(part) != std::string::npos);
  }
  // Nothing but the file stays.
  CHECK(std::distance(fs::directory_iterator{b.work.path() / "build"}, {})
        == 1);
  clean_build_contexts(b.work.path() / "build");
  CHECK(fs::is_empty(b.work.path() / "build"));
}

TEST_CASE("the same content gives the same build context") {
  context_bench b;
  const auto content = b.content();
  const auto one =
      std::get<fs::path>(write_build_context(content, b.work.path()));
  fs::last_write_time(b.skill.path() / "bin/run",
                      fs::file_time_type::clock::now());
  const auto two =
      std::get<fs::path>(write_build_context(content, b.work.path()));
  CHECK(bytes_of(one) == bytes_of(two));
}

TEST_CASE("a build context that cannot be written is a clear error") {
  context_bench b;
  auto content = b.content();
  SECTION("no folder can be made") {
    const auto file = b.other.write("file", "");
    const auto refused = write_build_context(content, file / "build");
    CHECK(std::get<edge_error>(refused).message.find("file/build")
          != std::string::npos);
  }
  SECTION("the skill is gone") {
    content.skill_dir = b.other.path() / "gone";
    const auto refused = write_build_context(content, b.work.path());
    CHECK(std::get<edge_error>(refused).message.find("gone")
          != std::string::npos);
    CHECK(fs::is_empty(b.work.path()));
  }
}
