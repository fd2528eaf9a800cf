#include "test/places.hpp"

namespace roscell::test {

std::filesystem::path source_dir() {
  return ROSCELL_SOURCE_DIR;
}

std::filesystem::path build_dir() {
  return ROSCELL_BINARY_DIR;
}

std::string fake_nvml() {
  return ROSCELL_FAKE_NVML;
}

std::string lacking_program() {
  return ROSCELL_LACKING_PROGRAM;
}

std::string python() {
  return ROSCELL_PYTHON;
}

} // namespace roscell::test
