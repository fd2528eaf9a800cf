#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace roscell::test {

/// A folder that stands for "/" and goes away with this object.
class fixture_root {
public:
  fixture_root() {
    auto path =
        (std::filesystem::temp_directory_path() / "roscell-XXXXXX").string();
    if (mkdtemp(path.data()) == nullptr)
      throw std::runtime_error{"no temporary folder"};
    path_ = path;
  }

  ~fixture_root() {
    std::error_code ec;
    std::filesystem::remove_all(path_, ec);
  }

  fixture_root(const fixture_root&) = delete;
  fixture_root& operator=(const fixture_root&) = delete;

  std::string path() const {
    return path_;
  }

  void write(const std::string& file, const std::string& text) {
    auto at = std::filesystem::path{path_ + file};
    std::filesystem::create_directories(at.parent_path());
    std::ofstream{at, std::ios::binary} << text;
  }

private:
  std::string path_;
};

} // namespace roscell::test
