#include "actors/edge/process/elf_properties.hpp"

#include <catch2/catch.hpp>

#include <elf.h>

#include <cstring>
#include <string>
#include <vector>

using namespace roscell;

namespace {

/// The beginning of a program with program headers of these types.
std::string elf_program(const std::vector<uint32_t>& types,
                        uint16_t machine = EM_X86_64) {
  Elf64_Ehdr header{};
  std::memcpy(header.e_ident, ELFMAG, SELFMAG);
  header.e_ident[EI_CLASS] = ELFCLASS64;
  header.e_ident[EI_DATA] = ELFDATA2LSB;
  header.e_machine = machine;
  header.e_phoff = sizeof(header);
  header.e_phnum = static_cast<uint16_t>(types.size());
  std::string result(reinterpret_cast<const char*>(&header), sizeof(header));
  for (const auto type : types) {
    Elf64_Phdr part{};
    part.p_type = type;
    result.append(reinterpret_cast<const char*>(&part), sizeof(part));
  }
  return result;
}

bool is_static(const std::string& bytes) {
  return parse_elf(bytes).value().is_static;
}

} // namespace

TEST_CASE("a program tells for which machine it is") {
  CHECK(parse_elf(elf_program({}))->architecture == "amd64");
  CHECK(parse_elf(elf_program({}, EM_AARCH64))->architecture == "arm64");
  CHECK(parse_elf(elf_program({}, EM_ARM))->architecture == "arm");
  CHECK(parse_elf(elf_program({}, EM_386))->architecture == "386");
  CHECK(parse_elf(elf_program({}, EM_S390))->architecture.empty());
}

TEST_CASE("only a program without anything dynamic is static") {
  CHECK(is_static(elf_program({PT_LOAD, PT_NOTE})));
  CHECK_FALSE(is_static(elf_program({PT_LOAD, PT_INTERP, PT_DYNAMIC})));
  CHECK_FALSE(is_static(elf_program({})));
}

TEST_CASE("what is damaged is never taken for static") {
  const auto whole = elf_program({PT_LOAD, PT_NOTE});
  for (size_t size = SELFMAG; size < whole.size(); ++size)
    CHECK_FALSE(is_static(whole.substr(0, size)));
  auto far = whole;
  std::memset(far.data() + offsetof(Elf64_Ehdr, e_phoff), 0xFF, 8);
  CHECK_FALSE(is_static(far));
  auto other_order = whole;
  other_order[EI_DATA] = ELFDATA2MSB;
  CHECK(parse_elf(other_order)->architecture.empty());
}

TEST_CASE("what is no program at all has no properties") {
  for (const auto* text : {"", "#!/bin/sh\n", "\177EL"})
    CHECK_FALSE(parse_elf(text));
  CHECK_FALSE(read_elf("/no/such/program"));
  const auto own = read_elf("/proc/self/exe");
  CHECK_FALSE(own->is_static);
  CHECK(own->interpreter.find("/ld-linux") != std::string::npos);
}
