// Arbitrary bytes as the beginning of a program.
#include "actors/edge/process/elf_properties.hpp"

#include <cstdint>
#include <cstdlib>

using namespace roscell;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* bytes, size_t size) {
  const std::string_view text{reinterpret_cast<const char*>(bytes), size};
  const auto properties = parse_elf(text);
  if (properties && text.substr(0, 4) != "\177ELF")
    std::abort();
  return 0;
}
