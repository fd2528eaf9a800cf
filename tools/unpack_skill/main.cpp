#include "messages/codec/json_codec.hpp"
#include "tools/unpack_skill/skill_archive.hpp"

#include <sys/resource.h>

#include <iostream>
#include <string>
#include <variant>

namespace {

/// A parser that goes astray takes no more than this of its host.
void bound_this_process() {
  constexpr rlim_t memory_bytes = 1ULL << 30;
  constexpr rlim_t cpu_s = 600;
  const rlimit memory{memory_bytes, memory_bytes};
  const rlimit cpu{cpu_s, cpu_s};
#ifndef __SANITIZE_ADDRESS__
  ::setrlimit(RLIMIT_AS, &memory);
#else
  static_cast<void>(memory);
#endif
  ::setrlimit(RLIMIT_CPU, &cpu);
}

} // namespace

/// `roscell-unpack-skill ARCHIVE FOLDER`, run by `roscell skill add`. Prints
/// one line of JSON: {"folder"} or {"message", "hint"}.
int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: roscell-unpack-skill ARCHIVE FOLDER\n";
    return 2;
  }
  bound_this_process();
  const auto folder = roscell::unpack_skill(argv[1], argv[2]);
  const auto* why = std::get_if<roscell::edge_error>(&folder);
  const roscell::json said =
      why == nullptr
          ? roscell::json{{"folder",
                           std::get<std::filesystem::path>(folder).string()}}
          : roscell::json{{"message", why->message}, {"hint", why->hint}};
  std::cout << said.dump(-1, ' ', false,
                         roscell::json::error_handler_t::replace)
            << std::endl;
  return 0;
}
