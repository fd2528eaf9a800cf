#include "actors/edge/history/audit_file.hpp"

#include "actors/edge/history/limits.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

audit_record change(const std::string& subject) {
  audit_record result;
  result.unix_ms = 5;
  result.from = "operator anna at 10.0.0.3:40112";
  result.request = "task_request";
  result.subject = subject;
  result.outcome = "done";
  return result;
}

void add(audit_file& file, const std::string& subject) {
  REQUIRE(std::holds_alternative<audit_record>(file.append(change(subject))));
}

std::string text_in(const fs::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

void put_text(const fs::path& path, const std::string& text) {
  std::ofstream{path, std::ios::binary} << text;
}

std::string without_line(const std::string& text, const std::string& word) {
  const auto at = text.find(word);
  const auto begin = text.rfind('\n', at) + 1;
  return text.substr(0, begin) + text.substr(text.find('\n', at) + 1);
}

} // namespace

TEST_CASE("audit records go on where an earlier run has ended") {
  const temp_folder folder;
  {
    audit_file file{folder.path()};
    add(file, "one");
    add(file, "two");
  }
  audit_file file{folder.path()};
  add(file, "three");
  const auto all = file.read(0, 0);
  REQUIRE(all.records.size() == 3);
  CHECK(all.gap.empty());
  CHECK(all.records.back().number == 3);
  CHECK(all.records.back().subject == "three");
  CHECK(file.read(2, 0).records.size() == 1);
  CHECK(file.read(0, 2).records.front().subject == "two");
}

TEST_CASE("an audit record that was altered or taken out is seen") {
  const temp_folder folder;
  {
    audit_file file{folder.path()};
    for (const auto* x : {"one", "two", "three"})
      add(file, x);
  }
  const auto place = folder.path() / "audit";
  const auto good = text_in(place);
  auto altered = good;
  altered.replace(altered.find("two"), 3, "tow");
  put_text(place, altered);
  CHECK(audit_file{folder.path()}.read(0, 0).gap == "record 2 was altered");
  put_text(place, without_line(good, "two"));
  CHECK(audit_file{folder.path()}.read(0, 0).gap
        == "record 2 is missing, and what follows it up to 2");
  put_text(place, good);
  CHECK(audit_file{folder.path()}.read(0, 0).gap.empty());
}

TEST_CASE("half an audit record, of a loss of power, is none") {
  const temp_folder folder;
  {
    audit_file file{folder.path()};
    add(file, "one");
  }
  const auto place = folder.path() / "audit";
  put_text(place, text_in(place) + R"({"number":2,"fro)");
  audit_file file{folder.path()};
  add(file, "two");
  const auto all = file.read(0, 0);
  CHECK(all.gap.empty());
  CHECK(all.records.size() == 2);
}

TEST_CASE("audit records take no more than their room, and the newest stay") {
  const temp_folder folder;
  audit_file file{folder.path()};
  const std::string subject(limits::audit::text_bytes, 'x');
  const size_t enough = 3 * limits::audit::file_bytes / subject.size();
  for (size_t i = 0; i < enough; ++i)
    add(file, subject);
  size_t bytes = 0;
  for (const auto& x : fs::directory_iterator{folder.path()})
    bytes += x.file_size();
  CHECK(bytes <= 2 * limits::audit::file_bytes);
  const auto all = audit_file{folder.path()}.read(0, 0);
  CHECK(all.gap.empty());
  CHECK(all.records.size() == limits::audit::newest);
  CHECK(all.records.back().number == static_cast<int64_t>(enough));
}

TEST_CASE("texts of an audit record are bounded, and whole characters") {
  const temp_folder folder;
  audit_file file{folder.path()};
  add(file, std::string(1000, 'x') + "\xff");
  const auto all = file.read(0, 0);
  REQUIRE(all.records.size() == 1);
  CHECK(all.records.front().subject.size() == limits::audit::text_bytes);
  CHECK(all.gap.empty());
}
