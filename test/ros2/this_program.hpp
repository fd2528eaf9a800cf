#pragma once

#include "cell_fixture.hpp"

#include "test/skills/child_process.hpp"

#include <filesystem>

namespace roscell::test {

/// This program again, in a process of its own, with the tests of `tag`.
inline child_process this_program(const std::string& tag,
                                  variables environment) {
  for (const char* name : {"ASAN_OPTIONS", "UBSAN_OPTIONS", "TSAN_OPTIONS"})
    if (const auto* value = std::getenv(name))
      environment[name] = value;
  auto self = std::filesystem::read_symlink("/proc/self/exe").string();
  return {{self, tag}, environment};
}

} // namespace roscell::test
