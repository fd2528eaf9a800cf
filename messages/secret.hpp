#pragma once

#include "messages/codec/json_codec.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// Secrets of a node: values that steps are given and that nobody is told.
namespace roscell {

/// Keeps a value under a name, in place of the one that the node had. Instances
/// get it with their next start.
struct secret_setting {
  static constexpr const char* type = "secret_setting";
  std::string name;
  std::string value; ///< In base64.
  std::string node;  ///< Of the cell; empty: the one that is asked.

  static constexpr auto fields() {
    return field_list{required("name", &secret_setting::name),
                      required("value", &secret_setting::value),
                      optional("node", &secret_setting::node)};
  }
};

struct secret_set {
  static constexpr const char* type = "secret_set";
  std::string name;
  bool replaced = false; ///< The node had one of that name.

  static constexpr auto fields() {
    return field_list{required("name", &secret_set::name),
                      optional("replaced", &secret_set::replaced)};
  }
};

/// Asks which secrets the node has.
struct secret_query {
  static constexpr const char* type = "secret_query";

  static constexpr auto fields() {
    return field_list{};
  }
};

struct secret_row {
  std::string name;
  int64_t set_unix_ms = 0;
  std::vector<std::string> instances; ///< That have been given it.

  static constexpr auto fields() {
    return field_list{required("name", &secret_row::name),
                      required("set_unix_ms", &secret_row::set_unix_ms),
                      optional("instances", &secret_row::instances)};
  }
};

struct secret_list {
  static constexpr const char* type = "secret_list";
  std::vector<secret_row> secrets; ///< By name.

  static constexpr auto fields() {
    return field_list{required("secrets", &secret_list::secrets)};
  }
};

/// Forgets a value. What runs keeps it until it ends.
struct secret_removal {
  static constexpr const char* type = "secret_removal";
  std::string name;

  static constexpr auto fields() {
    return field_list{required("name", &secret_removal::name)};
  }
};

struct secret_removed {
  static constexpr const char* type = "secret_removed";
  std::string name;
  std::vector<std::string> instances; ///< That still have it.

  static constexpr auto fields() {
    return field_list{required("name", &secret_removed::name),
                      optional("instances", &secret_removed::instances)};
  }
};

/// INTERNAL to a node: lays the secrets of an instance out for its program, in
/// files of memory.
struct lay_out_secrets {
  std::string instance;
  std::vector<std::string> files;     ///< Names of secrets.
  std::vector<std::string> variables; ///< The same, to be given as variables.
  std::string user; ///< Who reads the files; empty: the node's user.

  static constexpr auto fields() {
    return field_list{required("instance", &lay_out_secrets::instance),
                      required("files", &lay_out_secrets::files),
                      required("variables", &lay_out_secrets::variables),
                      required("user", &lay_out_secrets::user)};
  }
};

struct secrets_laid_out {
  std::string folder; ///< Of the files; empty: there are none.
  /// Of `variables`, in that order. In no reply, log or event.
  std::vector<std::string> values;

  static constexpr auto fields() {
    return field_list{required("folder", &secrets_laid_out::folder),
                      required("values", &secrets_laid_out::values)};
  }
};

/// INTERNAL to a node: an instance is gone, and so are its files.
struct clear_secrets {
  std::string instance;

  static constexpr auto fields() {
    return field_list{required("instance", &clear_secrets::instance)};
  }
};

} // namespace roscell
