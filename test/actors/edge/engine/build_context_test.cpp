#include "actors/edge/engine/build_context.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <catch2/catch.hpp>

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

  temp_folder skill;
  temp_folder other;
  temp_folder work;
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

namespace {

image_recipe echo_recipe() {
  return {"echo",
          "0123abcd",
          "debian:bookworm-slim",
          {"bin/echo", "an \"argument\""},
          {{"libz.so.1", "/usr/lib/libz.so.1.2.13", 121280, 1700000000}}};
}

} // namespace

TEST_CASE("a Dockerfile is base image, libraries, skill and entry point") {
  CHECK(dockerfile_of(echo_recipe())
        == "FROM debian:bookworm-slim\n"
           "# \"libz.so.1\" is \"/usr/lib/libz.so.1.2.13\", 121280 bytes of "
           "1700000000\n"
           "COPY opt /opt\n"
           "ENV LD_LIBRARY_PATH=/opt/roscell/lib\n"
           "WORKDIR /opt/roscell/skill\n"
           "LABEL roscell.skill=0123abcd\n"
           "ENTRYPOINT [\"/opt/roscell/skill/bin/echo\","
           "\"an \\\"argument\\\"\"]\n");
}

TEST_CASE("without libraries nothing is said of them") {
  auto recipe = echo_recipe();
  recipe.libraries.clear();
  CHECK(dockerfile_of(recipe).find("LD_LIBRARY_PATH") == std::string::npos);
}

TEST_CASE("no name can add an instruction to a Dockerfile") {
  auto recipe = echo_recipe();
  recipe.entry_point = {"bin/a\nRUN b", "\xff\nRUN c"};
  recipe.libraries[0].file = "/lib/x\nRUN d";
  const auto text = dockerfile_of(recipe);
  CHECK(text.find("\nRUN") == std::string::npos);
}

TEST_CASE("an image is named by the operation and all that goes into it") {
  const auto name = image_name("echo", dockerfile_of(echo_recipe()));
  CHECK(name.size() == std::string{"roscell/echo:"}.size() + 32);
  CHECK(name.rfind("roscell/echo:", 0) == 0);
  CHECK(name == image_name("echo", dockerfile_of(echo_recipe())));
  auto changed = echo_recipe();
  SECTION("another skill") {
    changed.skill = "4567";
  }
  SECTION("another base image") {
    changed.base_image = "debian:trixie";
  }
  SECTION("another entry point") {
    changed.entry_point.pop_back();
  }
  SECTION("a newer library") {
    ++changed.libraries[0].modified_unix_s;
  }
  CHECK(name != image_name("echo", dockerfile_of(changed)));
}

TEST_CASE("an operation's name becomes one that images can have") {
  const auto repository = [](const std::string& operation) {
    const auto name = image_name(operation, "");
    return name.substr(0, name.find(':'));
  };
  CHECK(repository("pose_estimation") == "roscell/pose_estimation");
  CHECK(repository("Detect-2.Fast") == "roscell/detect_2_fast");
  CHECK(repository("__a__b__") == "roscell/a_b");
  CHECK(repository("---") == "roscell/skill");
}
