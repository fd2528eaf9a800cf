#include "test/schemas/examples.hpp"

#include <filesystem>
#include <fstream>

/// Usage: example_seeds FOLDER: writes each example of a message there, for
/// fuzzers to begin with.
int main(int, char** arguments) {
  const std::filesystem::path folder{arguments[1]};
  for (const auto& x : roscell::test::examples()) {
    const auto path = folder / (x.name + ".json");
    std::filesystem::create_directories(path.parent_path());
    std::ofstream{path} << x.text;
  }
}
