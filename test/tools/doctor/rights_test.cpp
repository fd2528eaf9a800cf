#include "tools/roscell/doctor/host/rights.hpp"

#include "actors/edge/session/site_token.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

using namespace roscell;
using namespace roscell::cli;

namespace {

namespace fs = std::filesystem;

/// A host whose user has his site token in a folder of this test.
struct doors_fixture {
  doors_fixture() {
    ::setenv(site_token_variable, token().c_str(), 1);
    host.config.data_dir = folder / "data";
  }

  ~doors_fixture() {
    ::unsetenv(site_token_variable);
  }

  fs::path token() const {
    return folder / "site.token";
  }

  void write_token(const std::string& text, mode_t mode = 0600) const {
    std::ofstream{token()} << text;
    REQUIRE(::chmod(token().c_str(), mode) == 0);
  }

  finding look() const {
    const auto found = check_site_token(host);
    REQUIRE(found.size() == 1);
    return found[0];
  }

  test::temp_folder own;
  const fs::path folder = own.path();
  checked_host host;
};

const std::string good_token(32, 'x');

} // namespace

TEST_CASE_METHOD(doors_fixture, "The doctor says which site token is used, and "
                                "why that one") {
  CHECK(look().how == judgement::warning);
  CHECK(look().seen.find("there is no site token in '" + token().string()
                         + "', named by $ROSCELL_SITE_TOKEN")
        == 0);
  write_token(good_token);
  CHECK(look().how == judgement::ok);
  CHECK(look().seen.find(token().string()) != std::string::npos);
  host.config.site_token_file = folder / "given";
  CHECK(look().seen.find("given by --site-token") != std::string::npos);
}

TEST_CASE_METHOD(doors_fixture,
                 "The doctor says what is wrong with a site token") {
  write_token(good_token, 0644);
  CHECK(look().how == judgement::warning);
  CHECK(look().remedy == "chmod 600 " + token().string());
  write_token(good_token, 0666);
  CHECK(look().how == judgement::broken);
  write_token("short");
  CHECK(look().how == judgement::broken);
}

TEST_CASE_METHOD(doors_fixture,
                 "Root is told of skills that others may change") {
  fs::create_directories(folder / "skills" / "echo");
  host.config.skill_dirs = {folder / "skills"};
  const auto reported = [&] {
    for (const auto& x : find_open_skills(host.config))
      if (x.what.find((folder / "skills").string()) != std::string::npos)
        return x.what;
    return std::string{};
  };
  REQUIRE(::chmod((folder / "skills").c_str(), 0755) == 0);
  REQUIRE(::chmod((folder / "skills" / "echo").c_str(), 0755) == 0);
  CHECK(reported().empty());
  REQUIRE(::chmod((folder / "skills" / "echo").c_str(), 0777) == 0);
  if (::geteuid() != 0)
    CHECK(reported().empty());
  else
    CHECK(reported().find("echo: everybody may write to it")
          != std::string::npos);
}
