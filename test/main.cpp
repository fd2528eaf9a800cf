#define CATCH_CONFIG_MAIN
#include <catch2/catch.hpp>

#include <cstdlib>
#include <errno.h>
#include <fstream>
#include <iostream>
#include <sstream>

namespace {

/// What a shell gives to a test program for it to run this case alone: Catch
/// takes a comma for an "or", and a bracket for a tag.
std::string argument_for(const std::string& name) {
  std::string result = "'";
  for (const char c : name) {
    if (c == '\'')
      result += R"('\')";
    if (c == ',' || c == '[' || c == '"' || c == '\\')
      result += '\\';
    result += c;
  }
  return result + '\'';
}

/// Writes each test case down, where and as tools/testing/results.sh says, and
/// tells how to run alone what has failed.
struct case_writer : Catch::TestEventListenerBase {
  using TestEventListenerBase::TestEventListenerBase;

  void testCaseStarting(const Catch::TestCaseInfo& info) override {
    TestEventListenerBase::testCaseStarting(info);
    timer.start();
  }

  void testCaseEnded(const Catch::TestCaseStats& stats) override {
    const auto& name = stats.testInfo.name;
    const bool ok = stats.totals.assertions.allOk();
    if (const char* path = std::getenv("ROSCELL_RESULTS")) {
      std::ostringstream line;
      line << "case\tunit\t" << name << '\t' << timer.getElapsedSeconds()
           << '\t' << (ok ? "ok" : "FAILED") << "\t\n";
      std::ofstream{path, std::ios::app} << line.str() << std::flush;
    }
    if (!ok)
      std::cout << "    -- alone: " << program_invocation_name << ' '
                << argument_for(name) << '\n';
    TestEventListenerBase::testCaseEnded(stats);
  }

  Catch::Timer timer;
};

CATCH_REGISTER_LISTENER(case_writer)

} // namespace
