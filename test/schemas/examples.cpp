#include "test/schemas/examples.hpp"

#include "test/places.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace roscell::test {

namespace fs = std::filesystem;

namespace {

example valid_example(const fs::path& path) {
  const auto type = path.parent_path().filename().string();
  const auto text = read_file(path);
  return {type, type + "/" + path.stem().string(),
          text, json::parse(text),
          true, {}};
}

json invalid_document(const fs::path& folder, const json& x) {
  if (x.contains("document"))
    return x["document"];
  const auto valid = "valid-" + x.at("from").get<std::string>() + ".json";
  return json::parse(read_file(folder / valid)).patch(x.at("patch"));
}

example invalid_example(const fs::path& folder, const json& x) {
  const auto type = folder.filename().string();
  const auto document = invalid_document(folder, x);
  auto where = x.at("where").get<std::vector<std::string>>();
  std::sort(where.begin(), where.end());
  return {type,
          type + "/invalid-" + x.at("name").get<std::string>(),
          document.dump(2),
          document,
          false,
          where};
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
  std::vector<example> result;
  auto folder = source_dir() / "test/schemas/examples";
  for (const auto& entry : fs::recursive_directory_iterator{folder}) {
    const auto& path = entry.path();
    if (path.filename() == "invalid.json")
      for (const auto& x : json::parse(read_file(path)))
        result.push_back(invalid_example(path.parent_path(), x));
    else if (path.extension() == ".json")
      result.push_back(valid_example(path));
  }
  std::sort(result.begin(), result.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });
  return result;
}

} // namespace roscell::test
