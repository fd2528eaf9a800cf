#include "actors/edge/session/limits.hpp"
#include "actors/edge/session/site_token.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <future>
#include <set>
#include <string>
#include <vector>

using namespace roscell;
using namespace roscell::test;

namespace {

namespace fs = std::filesystem;

mode_t mode_of(const fs::path& path) {
  struct stat info {};
  REQUIRE(::stat(path.c_str(), &info) == 0);
  return info.st_mode & 07777;
}

const std::string a_token = "0123456789abcdef0123456789abcdef";
const std::string another_token = "fedcba9876543210fedcba9876543210";

} // namespace

TEST_CASE("a site token is made once, for its owner only") {
  temp_folder folder;
  const auto file = folder.path() / "user" / "roscell" / "site.token";
  REQUIRE_FALSE(make_site_token(file));
  CHECK(mode_of(file) == 0600);
  CHECK(mode_of(file.parent_path()) == 0700);
  const auto token = value_of(read_site_token(file));
  CHECK(token.size() == 64);
  REQUIRE_FALSE(make_site_token(file));
  CHECK(value_of(read_site_token(file)) == token);
  // Nothing else is left in the folder.
  CHECK(std::distance(fs::directory_iterator{file.parent_path()}, {}) == 1);
}

TEST_CASE("coordinators that make the site token at one moment agree on one") {
  temp_folder folder;
  const auto file = folder.path() / "site.token";
  std::vector<std::future<std::string>> all;
  for (int i = 0; i < 16; ++i)
    all.push_back(std::async(std::launch::async, [&] {
      return make_site_token(file)
                 ? std::string{"not made"}
                 : std::get<std::string>(read_site_token(file));
    }));
  std::set<std::string> tokens;
  for (auto& x : all)
    tokens.insert(x.get());
  CHECK(tokens.size() == 1);
  CHECK(tokens.count("not made") == 0);
}

TEST_CASE("where no site token can be made it is told where, and what to do") {
  temp_folder folder;
  const auto file = folder.write("file", "") / "site.token";
  const auto why = make_site_token(file);
  REQUIRE(why);
  CHECK(why->message.find("'" + file.string() + "'") != std::string::npos);
  CHECK(why->hint.find("ROSCELL_SITE_TOKEN=FILE") != std::string::npos);
  CHECK(make_site_token({})->message.find("no home directory")
        != std::string::npos);
}

TEST_CASE("a site token that others may have changed is not taken") {
  temp_folder folder;
  const auto file = folder.write("site.token", a_token + "\n");
  CHECK(value_of(read_site_token(file)) == a_token);
  SECTION("they may write to it") {
    REQUIRE(::chmod(file.c_str(), 0622) == 0);
  }
  SECTION("it is theirs") {
    if (::chown(file.c_str(), 4711, 4711) != 0)
      return;
  }
  SECTION("they may replace it") {
    REQUIRE(::chmod(folder.path().c_str(), 0777) == 0);
  }
  const auto why = error_of(read_site_token(file));
  CHECK(why.code == error_code::unauthorized);
  CHECK(why.message.find("is not taken: ") != std::string::npos);
}

TEST_CASE("what is no site token is told as what it is") {
  temp_folder folder;
  CHECK(
      error_of(read_site_token(folder.path() / "none")).message.find("No such")
      != std::string::npos);
  CHECK(error_of(read_site_token(folder.write("short", "abc")))
            .message.find("is shorter than 16 characters")
        != std::string::npos);
  const std::string long_text(limits::token::most_bytes + 1, 'x');
  CHECK(error_of(read_site_token(folder.write("long", long_text)))
            .message.find("it has more than 4096 bytes")
        != std::string::npos);
}

TEST_CASE(
    "a user's site token is where the environment says, else in his folder "
    "of settings") {
  ::setenv(site_token_variable, "/somewhere/token", 1);
  CHECK(own_site_token() == "/somewhere/token");
  // Where a relative path leads depends on who starts the node.
  ::setenv(site_token_variable, "token", 1);
  const auto own = own_site_token();
  CHECK(own.is_absolute());
  CHECK(own.filename() == "site.token");
  CHECK(own.parent_path().filename() == "roscell");
  if (::geteuid() == 0)
    CHECK(own == "/etc/roscell/site.token");
  ::unsetenv(site_token_variable);
}

TEST_CASE("a node learns of a token that is made or changed later") {
  temp_folder folder;
  const auto file = folder.path() / "site.token";
  const auto secret = site_secret::in_file(file);
  const auto copy = secret;
  CHECK(secret.text().empty());
  CHECK(secret.what_lacks().message.find(file.string()) != std::string::npos);
  CHECK(secret.what_lacks().hint.find(file.string()) != std::string::npos);
  folder.write("site.token", a_token);
  CHECK(copy.text() == a_token);
  CHECK(secret.text() == a_token);
  CHECK(secret.what_lacks().message.empty());
  folder.write("fresh", another_token);
  fs::rename(folder.path() / "fresh", file);
  CHECK(secret.text() == another_token);
}

TEST_CASE(
    "a file that has gone, or is not to be trusted, takes no token away") {
  temp_folder folder;
  const auto file = folder.write("site.token", a_token);
  const auto secret = site_secret::in_file(file);
  CHECK(secret.text() == a_token);
  folder.write("fresh", another_token);
  REQUIRE(::chmod((folder.path() / "fresh").c_str(), 0666) == 0);
  fs::rename(folder.path() / "fresh", file);
  CHECK(secret.text() == a_token);
  fs::remove(file);
  CHECK(secret.text() == a_token);
  folder.write("site.token", another_token);
  CHECK(secret.text() == another_token);
}

TEST_CASE("without a file there is no token ever, and a fixed one stays") {
  CHECK(site_secret{}.text().empty());
  CHECK_FALSE(site_secret{}.what_lacks().message.empty());
  CHECK(site_secret{"fixed"}.text() == "fixed");
  CHECK(site_secret::in_file({}).text().empty());
}
