#include "actors/edge/trust/site_folder.hpp"
#include "test/actors/edge/trust/site_fixture.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <sys/stat.h>

#include <fstream>

using namespace roscell;
using namespace roscell::test;

namespace {

namespace fs = std::filesystem;

template <class T>
T value_of(edge_result<T> x) {
  if (auto* why = std::get_if<edge_error>(&x))
    throw std::runtime_error(why->message);
  return std::get<T>(std::move(x));
}

template <class T>
edge_error error_of(const edge_result<T>& x) {
  return std::holds_alternative<edge_error>(x) ? std::get<edge_error>(x)
                                               : edge_error{};
}

identity arm() {
  return {"hall", site_role::node, "arm",
          "0a1b2c3d-0000-4000-8000-000000000001"};
}

std::string content(const fs::path& file) {
  std::ifstream in{file};
  return {std::istreambuf_iterator<char>{in}, {}};
}

void write(const fs::path& file, const std::string& text) {
  std::ofstream{file} << text;
}

} // namespace

TEST_CASE("a site is made once, and is the same when it is opened again") {
  temp_folder folder;
  const auto place = folder.path() / "site";
  std::string digest;
  std::string serial;
  {
    auto site = value_of(site_folder::create(place, "hall", site_made_unix_s));
    digest = site.site().digest();
    const auto made =
        value_of(site.issue(arm(), site_made_unix_s, limits::trust::machine_s));
    serial = made.own.chain.front().serial();
    CHECK(made.own.who() == arm());
    CHECK(made.issuing.empty());
    // Another command waits for its turn.
    CHECK(error_of(site_folder::open(place)).code == error_code::conflict);
  }
  CHECK(error_of(site_folder::create(place, "hall", site_made_unix_s)).code
        == error_code::conflict);
  auto site = value_of(site_folder::open(place));
  CHECK(site.site().digest() == digest);
  REQUIRE(site.issued().size() == 1);
  CHECK(site.issued().front().who == arm());
  CHECK(site.issued().front().serial == serial);
  CHECK_FALSE(site.revoke(site.issued().front(), site_made_unix_s));
  CHECK(site.revoke(site.issued().front(), site_made_unix_s)->code
        == error_code::conflict);
  CHECK(site.revoked().contains(serial));
}

TEST_CASE("what was revoked stays so when a site is opened again") {
  temp_folder folder;
  const auto place = folder.path() / "site";
  {
    auto site = value_of(site_folder::create(place, "hall", site_made_unix_s));
    value_of(site.issue(arm(), site_made_unix_s, 1000));
    CHECK_FALSE(site.revoke(site.issued().front(), site_made_unix_s));
  }
  const auto site = value_of(site_folder::open(place));
  CHECK(site.revoked().number() == 1);
  CHECK(site.revoked().contains(site.issued().front().serial));
}

TEST_CASE("a coordinator gets by what it makes identities of nodes") {
  temp_folder folder;
  auto site = value_of(
      site_folder::create(folder.path() / "site", "hall", site_made_unix_s));
  const identity head{"hall", site_role::coordinator, "head", "0a1b"};
  const auto made = value_of(site.issue(head, site_made_unix_s, 1000));
  const auto issuing = value_of(read_identity(made.issuing));
  CHECK(issuing.who() == identity{"hall", site_role::issuer, "head", "0a1b"});
  CHECK(site.issued().size() == 2);
  const auto file = folder.path() / "head.pem";
  CHECK_FALSE(keep_identity(file, made));
  CHECK(value_of(read_identity_file(file)).who() == head);
  CHECK(value_of(read_issuing(file)).has_value());
  CHECK_FALSE(value_of(read_issuing(folder.path() / "none.pem")).has_value());
}

TEST_CASE("the key of a site is for its user alone") {
  temp_folder folder;
  const auto place = folder.path() / "site";
  value_of(site_folder::create(place, "hall", site_made_unix_s));
  struct stat info {};
  REQUIRE(::stat((place / "site.key").c_str(), &info) == 0);
  CHECK((info.st_mode & 0777) == 0600);
  ::chmod((place / "site.key").c_str(), 0666);
  CHECK(error_of(site_folder::open(place)).code == error_code::unauthorized);
}

TEST_CASE("a site that is not whole is not opened, and nothing of it is lost") {
  temp_folder folder;
  const auto place = folder.path() / "site";
  CHECK(error_of(site_folder::open(place)).hint.find("roscell site create")
        != std::string::npos);
  CHECK(error_of(site_folder::create(place, "Hall", site_made_unix_s)).code
        == error_code::schema_violation);
  value_of(site_folder::create(place, "hall", site_made_unix_s));
  for (const auto* name : {"site.key", "site.pem", "issued", "revoked"}) {
    const auto file = place / name;
    const auto before = content(file);
    write(file, "nonsense");
    const auto why = error_of(site_folder::open(place));
    CHECK(why.code == error_code::schema_violation);
    CHECK(why.message.find(name) != std::string::npos);
    CHECK(content(file) == "nonsense");
    write(file, before);
  }
  CHECK(std::holds_alternative<site_folder>(site_folder::open(place)));
  // The key of another site.
  const auto other = folder.path() / "other";
  value_of(site_folder::create(other, "hall", site_made_unix_s));
  write(place / "site.key", content(other / "site.key"));
  CHECK(error_of(site_folder::open(place)).message.find("site.key")
        != std::string::npos);
}

TEST_CASE("an identity is a file for its user alone") {
  temp_folder folder;
  auto site = value_of(
      site_folder::create(folder.path() / "site", "hall", site_made_unix_s));
  const auto made = value_of(site.issue(arm(), site_made_unix_s, 1000));
  const auto file = folder.path() / "arm.pem";
  write(file, text_of(made.own));
  ::chmod(file.c_str(), 0600);
  const auto read = value_of(read_identity_file(file));
  CHECK(read.who() == arm());
  CHECK(read.site.digest() == site.site().digest());
  ::chmod(file.c_str(), 0640);
  CHECK(error_of(read_identity_file(file)).code == error_code::unauthorized);
  CHECK(
      error_of(read_identity_file(folder.path() / "none")).message.find("none")
      != std::string::npos);
}

TEST_CASE("an identity that is not whole is none, and says what is missing") {
  const made_site site;
  const auto arm = site.issue(site_role::node, "arm");
  const auto other = site.issue(site_role::node, "b");
  const auto why = [](const std::string& text) {
    return error_of(read_identity(text)).message;
  };
  CHECK(why("").find("no key") != std::string::npos);
  CHECK(why(arm.key.pem()).find("own certificate") != std::string::npos);
  CHECK(why(arm.key.pem() + arm.mine.pem() + other.mine.pem())
            .find("last certificate")
        != std::string::npos);
  CHECK(why(arm.key.pem() + other.mine.pem() + site.mine.pem())
            .find("key is not that")
        != std::string::npos);
  CHECK(why(std::string(limits::trust::identity_bytes + 1, 'x')).find("longer")
        != std::string::npos);
  CHECK(why(arm.key.pem() + arm.mine.pem() + site.mine.pem()).empty());
}
