#include "actors/edge/disk/secret_folder.hpp"

#include "actors/edge/disk/limits.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <sys/stat.h>

#include <algorithm>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

unsigned mode_of(const fs::path& path) {
  struct stat info {};
  REQUIRE(::lstat(path.c_str(), &info) == 0);
  return info.st_mode & 07777U;
}

std::vector<std::string> names_in(const stored_secrets& found) {
  std::vector<std::string> result;
  for (const auto& x : found.secrets)
    result.push_back(x.name);
  return result;
}

using words = std::vector<std::string>;

} // namespace

TEST_CASE("a secret on the disk is for the node's user alone", "[secrets]") {
  temp_folder data;
  const secret_folder secrets{data.path() / "secrets"};
  const auto before = ::umask(0);
  REQUIRE_FALSE(secrets.write("key", "value"));
  ::umask(before);
  CHECK(mode_of(data.path() / "secrets") == 0700);
  CHECK(mode_of(data.path() / "secrets/key.secret") == 0600);
}

TEST_CASE("what is written is read, replaced and removed", "[secrets]") {
  temp_folder data;
  const secret_folder secrets{data.path() / "secrets"};
  CHECK(secrets.look().secrets.empty());
  const std::string bytes{"a\0b\xff\n", 5};
  REQUIRE_FALSE(secrets.write("key", "old"));
  REQUIRE_FALSE(secrets.write("key", bytes));
  REQUIRE_FALSE(secrets.write("key.new", "other"));
  CHECK(std::get<std::string>(secrets.read("key")) == bytes);
  CHECK(names_in(secrets.look()) == words{"key", "key.new"});
  CHECK(secrets.look().secrets[0].set_unix_ms > 1'500'000'000'000);
  REQUIRE_FALSE(secrets.remove("key"));
  CHECK(names_in(secrets.look()) == words{"key.new"});
  CHECK(std::holds_alternative<edge_error>(secrets.read("key")));
}

TEST_CASE("what a write that was cut short has left is removed", "[secrets]") {
  temp_folder data;
  const secret_folder secrets{data.path() / "secrets"};
  REQUIRE_FALSE(secrets.write("key", "value"));
  data.write("secrets/other.secret.new", "val");
  const auto found = secrets.look();
  CHECK(names_in(found) == words{"key"});
  CHECK(found.ignored.empty());
  CHECK_FALSE(fs::exists(data.path() / "secrets/other.secret.new"));
}

TEST_CASE("what cannot be a secret stays, and is told", "[secrets]") {
  temp_folder data;
  const secret_folder secrets{data.path() / "secrets"};
  REQUIRE_FALSE(secrets.write("key", "value"));
  data.write("secrets/empty.secret", "");
  data.write("secrets/long.secret",
             std::string(limits::secret::bytes + 1, 'x'));
  data.write("secrets/notes.txt", "x");
  data.write("secrets/-bad.secret", "x");
  data.write("secrets/folder.secret/file", "x");
  fs::create_symlink("/etc/hostname", data.path() / "secrets/link.secret");
  const auto found = secrets.look();
  CHECK(names_in(found) == words{"key"});
  REQUIRE(found.ignored.size() == 6);
  CHECK(found.ignored[0].path == data / "secrets/-bad.secret");
  CHECK(found.ignored[1].reason == "it is empty");
  CHECK(found.ignored[2].reason == "it is no file");
  CHECK(found.ignored[3].reason == "it is no file");
  CHECK(found.ignored[4].reason == "it is longer than 65536 bytes");
  CHECK(fs::exists(data.path() / "secrets/notes.txt"));
}

TEST_CASE("what others could read is closed to them", "[secrets]") {
  temp_folder data;
  const secret_folder secrets{data.path() / "secrets"};
  REQUIRE_FALSE(secrets.write("key", "value"));
  fs::permissions(data.path() / "secrets", fs::perms{0755});
  fs::permissions(data.path() / "secrets/key.secret", fs::perms{0644});
  CHECK(names_in(secrets.look()) == words{"key"});
  CHECK(mode_of(data.path() / "secrets") == 0700);
  CHECK(mode_of(data.path() / "secrets/key.secret") == 0600);
}

TEST_CASE("a folder of secrets that is none is no reason to stop",
          "[secrets]") {
  temp_folder data{"secrets", "a file"};
  const secret_folder secrets{data.path() / "secrets"};
  const auto found = secrets.look();
  REQUIRE(found.ignored.size() == 1);
  CHECK(found.ignored[0].reason == "it is no folder");
  const auto why = secrets.write("key", "value");
  REQUIRE(why);
  CHECK(why->message.find("value") == std::string::npos);
}
