#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace roscell::test {

/// A folder that is gone, with all it holds, when the test is over.
class temp_folder {
public:
  temp_folder() {
    std::string name =
        std::filesystem::temp_directory_path() / "roscell-test-XXXXXX";
    if (::mkdtemp(name.data()) == nullptr)
      throw std::runtime_error{"cannot make a temporary folder"};
    path_ = name;
  }

  /// A folder with one file.
  temp_folder(const std::filesystem::path& name, const std::string& content)
      : temp_folder{} {
    write(name, content);
  }

  ~temp_folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

  temp_folder(const temp_folder&) = delete;
  temp_folder& operator=(const temp_folder&) = delete;

  const std::filesystem::path& path() const {
    return path_;
  }

  /// The path of `name` in the folder.
  std::string operator/(const std::string& name) const {
    return path_ / name;
  }

  /// Writes a file, with its folders. A name from "/" on is in the folder too.
  std::filesystem::path write(const std::filesystem::path& name,
                              const std::string& content,
                              bool executable = false) const {
    const auto file = path_ / name.relative_path();
    std::filesystem::create_directories(file.parent_path());
    std::ofstream{file, std::ios::binary} << content;
    if (executable)
      std::filesystem::permissions(file, std::filesystem::perms::owner_all);
    return file;
  }

  void append(const std::string& name, const std::string& content) const {
    std::ofstream{*this / name, std::ios::binary | std::ios::app} << content;
  }

private:
  std::filesystem::path path_;
};

} // namespace roscell::test
