#pragma once

#include <string>
#include <vector>

namespace roscell {

/// The arguments and the environment of a program as execve(2) takes them:
/// lists of C strings with a null pointer at their ends. To be kept at one
/// place, for these point to it.
class spawn_words {
public:
  /// @param what has the members of `program` (process_spawner.hpp).
  template <class Program>
  explicit spawn_words(const Program& what) : arguments_{what.arguments} {
    arguments_.insert(arguments_.begin(), what.path.string());
    settings_.reserve(what.environment.size());
    for (const auto& [name, value] : what.environment)
      settings_.push_back(name + '=' + value);
    argument_pointers_ = pointers_to(arguments_);
    setting_pointers_ = pointers_to(settings_);
  }

  spawn_words(const spawn_words&) = delete;
  spawn_words& operator=(const spawn_words&) = delete;

  char** arguments() {
    return argument_pointers_.data();
  }

  char** environment() {
    return setting_pointers_.data();
  }

private:
  static std::vector<char*> pointers_to(std::vector<std::string>& texts) {
    std::vector<char*> result;
    result.reserve(texts.size() + 1);
    for (auto& x : texts)
      result.push_back(x.data());
    result.push_back(nullptr);
    return result;
  }

  std::vector<std::string> arguments_;
  std::vector<std::string> settings_;
  std::vector<char*> argument_pointers_;
  std::vector<char*> setting_pointers_;
};

} // namespace roscell
