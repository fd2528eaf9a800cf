#include "actors/edge/disk/build_manifest.hpp"
#include "actors/edge/disk/build_pieces.hpp"
#include "actors/edge/disk/folder_hash.hpp"
#include "actors/edge/io/crypto.hpp"

#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/stat.h>

#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

constexpr size_t mib = build_piece_bytes;

/// Files that begin and end within pieces, an empty one, a program and a link.
void write_skill(const temp_folder& at) {
  at.write("bin/run", std::string(mib / 2, 'r'));
  ::chmod((at.path() / "bin/run").c_str(), 0755);
  at.write("data/empty", "");
  at.write("data/model", std::string(2 * mib + 7, 'm'));
  at.write("skill.json", "{}");
  fs::create_symlink("model", at.path() / "data/latest");
}

described_build described(const temp_folder& at) {
  return value_of(describe_folder(at.path()));
}

/// A manifest with another text is another one: its name says so.
edge_result<build_manifest> parsed(const build_manifest& manifest) {
  json document;
  to_json(document, manifest);
  const auto text = document.dump();
  return parse_manifest(text, {hash_of(manifest), sha256_hex(text),
                               static_cast<int64_t>(bytes_of(manifest))});
}

void copy_pieces(const temp_folder& from, const build_manifest& manifest,
                 const fs::path& to) {
  for (size_t i = 0; i < manifest.pieces.size(); ++i)
    CHECK_FALSE(write_piece(to, manifest, i,
                            value_of(read_piece(from.path(), manifest, i))));
}

} // namespace

TEST_CASE("a manifest says the hash that a folder has", "[builds]") {
  temp_folder skill;
  write_skill(skill);
  const auto build = described(skill);
  CHECK(build.name.hash == value_of(hash_folder(skill.path())));
  CHECK(build.manifest.pieces.size() == 3);
  CHECK(value_of(parse_manifest(build.text, build.name)).files.size() == 5);
}

TEST_CASE("a build is written piece by piece into the same build", "[builds]") {
  temp_folder skill;
  write_skill(skill);
  const auto build = described(skill);
  temp_folder copy;
  REQUIRE_FALSE(begin_build(copy.path(), build.manifest));
  CHECK(find_pieces(copy.path(), build.manifest)
        == std::vector<bool>(3, false));
  copy_pieces(skill, build.manifest, copy.path());
  CHECK(find_pieces(copy.path(), build.manifest) == std::vector<bool>(3, true));
  CHECK_FALSE(finish_build(copy.path(), build.manifest, build.name));
  CHECK(value_of(hash_folder(copy.path())) == build.name.hash);
  CHECK(fs::read_symlink(copy.path() / "data/latest") == "model");
}

TEST_CASE("nothing of an unfinished build can be executed", "[builds]") {
  temp_folder skill;
  write_skill(skill);
  const auto build = described(skill);
  temp_folder copy;
  REQUIRE_FALSE(begin_build(copy.path(), build.manifest));
  copy_pieces(skill, build.manifest, copy.path());
  CHECK((fs::status(copy.path() / "bin/run").permissions()
         & fs::perms::owner_exec)
        == fs::perms::none);
  CHECK_FALSE(fs::exists(copy.path() / "data/latest"));
}

TEST_CASE("other bytes than a piece's are not written", "[builds]") {
  temp_folder skill;
  write_skill(skill);
  const auto build = described(skill);
  temp_folder copy;
  REQUIRE_FALSE(begin_build(copy.path(), build.manifest));
  auto bytes = value_of(read_piece(skill.path(), build.manifest, 0));
  SECTION("changed") {
    bytes[5] = 'x';
    CHECK(write_piece(copy.path(), build.manifest, 0, bytes)->code
          == error_code::schema_violation);
  }
  SECTION("cut off") {
    bytes.pop_back();
    CHECK(write_piece(copy.path(), build.manifest, 0, bytes));
  }
  SECTION("of another piece") {
    CHECK(write_piece(copy.path(), build.manifest, 1, bytes));
  }
  SECTION("of one that is not there") {
    CHECK(write_piece(copy.path(), build.manifest, 3, bytes));
  }
  CHECK(find_pieces(copy.path(), build.manifest)
        == std::vector<bool>(3, false));
}

TEST_CASE("a build that was edited gives no piece", "[builds]") {
  temp_folder skill;
  write_skill(skill);
  const auto build = described(skill);
  skill.write("bin/run", std::string(mib / 2, 'x'));
  CHECK(error_of(read_piece(skill.path(), build.manifest, 0)).code
        == error_code::conflict);
}

TEST_CASE("a manifest is refused that leads out of its folder or lies",
          "[builds]") {
  temp_folder skill;
  write_skill(skill);
  auto manifest = described(skill).manifest;
  auto& first = manifest.files.front();
  const std::string path = GENERATE("../out", "/etc/passwd", "bin/../../x",
                                    "./run", "bin/", "a/./b");
  SECTION("a path") {
    first.path = path;
  }
  SECTION("a link") {
    manifest.files = {
        {"a", 0, false, "", path == "bin/" ? "/bin" : "../" + path}};
    manifest.pieces.clear();
  }
  SECTION("a link with bytes") {
    first.link = "x";
  }
  SECTION("files in another order") {
    std::swap(manifest.files[0], manifest.files[1]);
  }
  SECTION("a file below a file") {
    manifest.files.insert(manifest.files.begin() + 1,
                          {"bin/run/x", 0, false, first.sha256, ""});
  }
  SECTION("a piece too few") {
    manifest.pieces.pop_back();
  }
  CHECK(error_of(parsed(manifest)).code == error_code::schema_violation);
}

TEST_CASE("a manifest of another build or another text is refused",
          "[builds]") {
  temp_folder skill;
  write_skill(skill);
  const auto build = described(skill);
  auto name = build.name;
  auto text = build.text;
  SECTION("another hash of the build") {
    name.hash = std::string(64, 'a');
  }
  SECTION("another hash of the manifest") {
    name.manifest = std::string(64, 'a');
  }
  SECTION("another size") {
    ++name.bytes;
  }
  SECTION("another text") {
    text += " ";
  }
  CHECK(error_of(parse_manifest(text, name)).code
        == error_code::schema_violation);
}
