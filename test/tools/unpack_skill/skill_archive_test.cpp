#include "tools/unpack_skill/skill_archive.hpp"

#include "test/temp_folder.hpp"

#include <archive.h>
#include <archive_entry.h>
#include <catch2/catch.hpp>
#include <sys/stat.h>

#include <fstream>
#include <functional>
#include <string>
#include <variant>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

/// What is put into an archive.
struct packed {
  std::string name;
  std::string bytes;
  unsigned type = AE_IFREG;
  unsigned mode = 0644;
  std::string link;
  bool hard = false;
};

fs::path archive_of(const temp_folder& at, const std::vector<packed>& files,
                    bool zip = false) {
  const auto path = at.path() / "skill.archive";
  auto* out = archive_write_new();
  if (zip) {
    archive_write_set_format_zip(out);
  } else {
    archive_write_set_format_pax_restricted(out);
    archive_write_add_filter_gzip(out);
  }
  archive_write_open_filename(out, path.c_str());
  for (const auto& x : files) {
    auto* entry = archive_entry_new();
    archive_entry_set_pathname(entry, x.name.c_str());
    archive_entry_set_filetype(entry, x.type);
    archive_entry_set_perm(entry, x.mode);
    if (x.hard)
      archive_entry_set_hardlink(entry, x.link.c_str());
    else if (!x.link.empty())
      archive_entry_set_symlink(entry, x.link.c_str());
    else
      archive_entry_set_size(entry, static_cast<la_int64_t>(x.bytes.size()));
    archive_write_header(out, entry);
    if (x.type == AE_IFREG && !x.hard)
      archive_write_data(out, x.bytes.data(), x.bytes.size());
    archive_entry_free(entry);
  }
  archive_write_close(out);
  archive_write_free(out);
  return path;
}

} // namespace

TEST_CASE("a skill is unpacked from tar and zip, with its top folder or not",
          "[builds]") {
  const bool zip = GENERATE(false, true);
  const std::string top = GENERATE("", "shout/");
  temp_folder at;
  temp_folder into;
  const auto found =
      unpack_skill(archive_of(at,
                              {{top + "skill.json", "{}"},
                               {top + "bin/run", "#!", AE_IFREG, 0755},
                               {top + "bin/latest", "", AE_IFLNK, 0777, "run"}},
                              zip),
                   into.path());
  REQUIRE(std::holds_alternative<fs::path>(found));
  const auto folder = std::get<fs::path>(found);
  CHECK(folder == (top.empty() ? into.path() : into.path() / "shout"));
  CHECK(fs::file_size(folder / "skill.json") == 2);
  CHECK((fs::status(folder / "bin/run").permissions() & fs::perms::owner_exec)
        != fs::perms::none);
  CHECK(fs::read_symlink(folder / "bin/latest") == "run");
}

TEST_CASE("an archive is refused that would write elsewhere or more than files",
          "[builds]") {
  temp_folder at;
  temp_folder outer;
  const auto into = outer.path() / "into";
  fs::create_directory(into);
  const auto bad = GENERATE(
      packed{"../out", "x"}, packed{"a/../../out", "x"},
      packed{"/tmp/roscell-out", "x"},
      packed{"out", "", AE_IFLNK, 0777, "../.."},
      packed{"out", "", AE_IFLNK, 0777, "/etc"}, packed{"dev", "", AE_IFCHR},
      packed{"pipe", "", AE_IFIFO}, packed{"run", "x", AE_IFREG, 04755},
      packed{"run", "x", AE_IFREG, 02755},
      packed{"hard", "", AE_IFREG, 0644, "skill.json", true});
  const auto found =
      unpack_skill(archive_of(at, {{"skill.json", "{}"}, bad}), into);
  REQUIRE(std::holds_alternative<edge_error>(found));
  CHECK(std::get<edge_error>(found).code == error_code::schema_violation);
  CHECK(std::distance(fs::directory_iterator{outer.path()}, {}) == 1);
  CHECK_FALSE(fs::exists("/tmp/roscell-out"));
}

TEST_CASE("a file is not written through a link of the archive", "[builds]") {
  temp_folder at;
  temp_folder outer;
  const auto into = outer.path() / "into";
  fs::create_directory(into);
  unpack_skill(
      archive_of(at, {{"a", "", AE_IFLNK, 0777, "b"}, {"a/file", "x"}}), into);
  CHECK(fs::exists(into / "a/file"));
  CHECK_FALSE(fs::exists(into / "b"));
}

TEST_CASE("an archive is unpacked up to its bounds and no further",
          "[builds]") {
  temp_folder at;
  temp_folder into;
  archive_limits limits;
  limits.max_files = 3;
  limits.max_bytes = 100;
  std::vector<packed> files{{"a", std::string(50, 'a')},
                            {"b", std::string(50, 'b')}};
  SECTION("within") {
    CHECK(std::holds_alternative<fs::path>(
        unpack_skill(archive_of(at, files), into.path(), limits)));
  }
  SECTION("a byte too many") {
    files.push_back({"c", "c"});
    CHECK(std::holds_alternative<edge_error>(
        unpack_skill(archive_of(at, files), into.path(), limits)));
  }
  SECTION("files too many") {
    files.push_back({"c", ""});
    files.push_back({"d", ""});
    CHECK(std::holds_alternative<edge_error>(
        unpack_skill(archive_of(at, files), into.path(), limits)));
  }
  SECTION("a bomb") {
    limits = {};
    limits.free_bytes = 1024;
    limits.max_ratio = 10;
    CHECK(std::holds_alternative<edge_error>(
        unpack_skill(archive_of(at, {{"zeros", std::string(1 << 20, '0')}}),
                     into.path(), limits)));
  }
}

TEST_CASE("what is no archive is refused, and what is cut off", "[builds]") {
  temp_folder at;
  temp_folder into;
  SECTION("text") {
    at.write("x", "this is no archive");
    CHECK(std::holds_alternative<edge_error>(
        unpack_skill(at.path() / "x", into.path())));
  }
  SECTION("nothing there") {
    CHECK(std::holds_alternative<edge_error>(
        unpack_skill(at.path() / "x", into.path())));
  }
  SECTION("cut off") {
    const auto path = archive_of(at, {{"data", std::string(100'000, 'x')}});
    fs::resize_file(path, fs::file_size(path) / 2);
    CHECK(std::holds_alternative<edge_error>(unpack_skill(path, into.path())));
  }
}
