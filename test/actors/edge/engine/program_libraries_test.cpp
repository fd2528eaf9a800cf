#include "actors/edge/engine/program_libraries.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"
#include "test/places.hpp"

#include <elf.h>

#include <algorithm>
#include <fstream>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

bool has(const std::vector<shared_library>& xs, const std::string& stem) {
  return std::any_of(xs.begin(), xs.end(), [&](const auto& x) {
    return x.name.rfind(stem + ".so", 0) == 0;
  });
}

} // namespace

TEST_CASE("the dynamic linker's words are read line by line") {
  const auto list = parse_library_list(
      "\tlinux-vdso.so.1 (0x00007ffd)\n"
      "\tlibz.so.1 => /lib/x86_64-linux-gnu/libz.so.1 (0x00007f30)\n"
      "\tlibgone.so.7 => not found\n"
      "\t/lib64/ld-linux-x86-64.so.2 (0x00007f72)\n"
      "nonsense => /x\n\t => \n");
  REQUIRE(list.size() == 3);
  CHECK(list[0].name == "libz.so.1");
  CHECK(list[0].path == "/lib/x86_64-linux-gnu/libz.so.1");
  CHECK(list[1].name == "libgone.so.7");
  CHECK(list[1].path.empty());
  CHECK(list[2].path.empty());
}

TEST_CASE("a library that is too old is not found, with the version") {
  const auto list = parse_library_list(
      "/x/prog: /lib/x86_64-linux-gnu/libc.so.6: version `GLIBC_2.99' not "
      "found (required by /x/prog)\n"
      "/x/prog: : version `' not found\nversion `1' not found\n");
  REQUIRE(list.size() == 2);
  CHECK(list[0].name == "libc.so.6 (GLIBC_2.99)");
  CHECK(list[0].path.empty());
  CHECK(is_c_library(list[0].name));
}

TEST_CASE("the C library is the image's own") {
  for (const auto* name :
       {"libc.so.6", "libm.so.6", "libpthread.so.0", "ld-linux-x86-64.so.2",
        "libnss_dns.so.2", "linux-vdso.so.1"})
    CHECK(is_c_library(name));
  for (const auto* name : {"libcrypto.so.3", "libmount.so.1", "libstdc++.so.6",
                           "libdlfoo.so.1", "libgcc_s.so.1"})
    CHECK_FALSE(is_c_library(name));
}

TEST_CASE("a program's libraries are all those that it loads") {
  temp_folder folder;
  fs::create_directories(folder.path() / "bin");
  // This test is a dynamic program itself.
  fs::copy_file("/proc/self/exe", folder.path() / "bin/run");
  const auto found = find_libraries(folder.path(), folder.path() / "bin/run");
  const auto& libraries = std::get<std::vector<shared_library>>(found);
  CHECK(has(libraries, "libcrypto"));
  CHECK(has(libraries, "libstdc++"));
  CHECK_FALSE(has(libraries, "libc"));
  for (const auto& x : libraries) {
    CHECK(fs::file_size(x.file) == x.bytes);
    CHECK(x.name.find('/') == std::string::npos);
  }
}

TEST_CASE("a script needs no library, but a program beside it does") {
  temp_folder folder{"bin/run", "#!/bin/sh\n"};
  const auto found = find_libraries(folder.path(), folder.path() / "bin/run");
  CHECK(std::get<std::vector<shared_library>>(found).empty());
  fs::copy_file("/proc/self/exe", folder.path() / "bin/other");
  const auto more = find_libraries(folder.path(), folder.path() / "bin/run");
  CHECK(has(std::get<std::vector<shared_library>>(more), "libcrypto"));
}

TEST_CASE("a damaged program is a clear error, a damaged file beside it none") {
  temp_folder folder;
  const auto damaged = folder.write("bin/damaged", "\177ELF and no more");
  const auto refused = find_libraries(folder.path(), damaged);
  REQUIRE(std::holds_alternative<edge_error>(refused));
  CHECK(std::get<edge_error>(refused).message.find("damaged")
        != std::string::npos);
  folder.write("bin/run", "#!/bin/sh\n");
  const auto found = find_libraries(folder.path(), folder.path() / "bin/run");
  CHECK(std::get<std::vector<shared_library>>(found).empty());
}

TEST_CASE("a program that lacks a library is known without starting it") {
  const auto missing = missing_libraries(test::lacking_program());
  CHECK(std::get<std::vector<std::string>>(missing)
        == std::vector<std::string>{"libgone.so"});
  const auto none = missing_libraries("/proc/self/exe");
  CHECK(std::get<std::vector<std::string>>(none).empty());
}

TEST_CASE("a static program needs no library, and no linker is asked") {
  Elf64_Ehdr header{};
  std::ifstream{"/proc/self/exe", std::ios::binary}.read(
      reinterpret_cast<char*>(&header), sizeof(header));
  header.e_phoff = sizeof(header);
  header.e_phnum = 1;
  Elf64_Phdr part{};
  part.p_type = PT_LOAD;
  std::string bytes(reinterpret_cast<const char*>(&header), sizeof(header));
  bytes.append(reinterpret_cast<const char*>(&part), sizeof(part));
  temp_folder folder;
  const auto program = folder.write("bin/run", bytes);
  const auto found = find_libraries(folder.path(), program);
  CHECK(std::get<std::vector<shared_library>>(found).empty());
  const auto missing = missing_libraries(program);
  CHECK(std::get<std::vector<std::string>>(missing).empty());
}

TEST_CASE("a script lacks no library, nor does a program for another machine") {
  temp_folder folder;
  const auto script = folder.write("run", "#!/bin/sh\n");
  // The header of a program, up to what says that it is for System/390.
  const auto foreign =
      folder.write("foreign", std::string("\177ELF\2\1\1\0\0\0\0\0\0\0\0\0"
                                          "\2\0\x16\0\1\0\0\0",
                                          24));
  for (const auto& path : {script, foreign})
    CHECK(std::get<std::vector<std::string>>(missing_libraries(path)).empty());
}
