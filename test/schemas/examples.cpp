#include "test/schemas/examples.hpp"

#include "test/places.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace roscell::test {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> sorted_lines(const fs::path& path) {
  std::istringstream text{read_file(path)};
  std::vector<std::string> result;
  for (std::string line; std::getline(text, line);)
    result.push_back(line);
  std::sort(result.begin(), result.end());
  return result;
}

example read_example(const fs::path& path) {
  example result;
  result.type = path.parent_path().filename().string();
  result.file = path;
  result.document = json::parse(read_file(path));
  result.valid = path.filename().string().rfind("valid-", 0) == 0;
  if (!result.valid)
    result.where = sorted_lines(fs::path{path}.replace_extension(".where"));
  return result;
}

} // namespace

std::string read_file(const fs::path& path) {
  std::ifstream file{path, std::ios::binary};
  if (!file)
    throw std::runtime_error{"cannot read " + path.string()};
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::vector<example> examples() {
  std::vector<fs::path> paths;
  auto folder = source_dir() / "test/schemas/examples";
  for (const auto& entry : fs::recursive_directory_iterator{folder})
    if (entry.path().extension() == ".json")
      paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<example> result;
  for (const auto& path : paths)
    result.push_back(read_example(path));
  return result;
}

} // namespace roscell::test
