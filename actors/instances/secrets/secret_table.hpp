#pragma once

#include "messages/secret.hpp"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace roscell {

/// Which secrets a node has, and which instances have been given them. It knows
/// no value.
class secret_table {
public:
  bool has(const std::string& name) const {
    return set_at_.count(name) > 0;
  }

  /// Whether another one would be too many.
  bool is_full() const;

  void keep(const std::string& name, int64_t unix_ms);
  void forget(const std::string& name);

  /// An instance has been given these, and no others.
  void give(const std::string& instance, std::set<std::string> names);

  /// An instance has ended, and with it what it was given.
  void take_back(const std::string& instance);

  /// Instances that have been given it, whether the node has it still or not.
  std::vector<std::string> holders_of(const std::string& name) const;

  secret_list list() const;
  std::vector<std::string> names() const;

  size_t given() const {
    return given_.size();
  }

private:
  std::map<std::string, int64_t> set_at_;
  std::map<std::string, std::set<std::string>> given_; ///< By instance.
};

} // namespace roscell
