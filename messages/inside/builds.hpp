#pragma once

#include "messages/actors.hpp"
#include "messages/build.hpp"
#include "messages/failure.hpp"
#include "messages/skill.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// What a node's actors say of the builds that the cell passes on.
namespace roscell {

/// Begins a build on this node's disk, or goes on with it.
struct offer_build {
  build_name name;
  std::string manifest; ///< Its text.
  std::string cell;     ///< For which it is.

  static constexpr auto fields() {
    return field_list{required("name", &offer_build::name),
                      required("manifest", &offer_build::manifest),
                      required("cell", &offer_build::cell)};
  }
};

/// What is on the disk of a build.
struct build_held {
  build_name name;
  std::vector<bool> pieces;
  bool whole = false;

  static constexpr auto fields() {
    return field_list{required("name", &build_held::name),
                      required("pieces", &build_held::pieces),
                      required("whole", &build_held::whole)};
  }
};

struct store_piece {
  std::string hash;
  int64_t piece = 0;
  std::string bytes;

  static constexpr auto fields() {
    return field_list{required("hash", &store_piece::hash),
                      required("piece", &store_piece::piece),
                      required("bytes", &store_piece::bytes)};
  }
};

/// Asks what is on the disk of a build; `wait`: once it is more than `beyond`
/// pieces, and of a build that is not there yet once it has begun.
struct build_query {
  std::string hash;
  bool wait = false;
  int64_t beyond = -1;

  static constexpr auto fields() {
    return field_list{required("hash", &build_query::hash),
                      required("wait", &build_query::wait),
                      required("beyond", &build_query::beyond)};
  }
};

/// Asks for the bytes of a piece; negative: for the text of the manifest.
struct piece_query {
  std::string hash;
  int64_t piece = -1;

  static constexpr auto fields() {
    return field_list{required("hash", &piece_query::hash),
                      required("piece", &piece_query::piece)};
  }
};

struct piece_read {
  std::string bytes;

  static constexpr auto fields() {
    return field_list{required("bytes", &piece_read::bytes)};
  }
};

/// The cell counts on the build here, or does no more. For a build of no cell
/// yet, which somebody has brought to this node, it says the cell.
struct pin_build {
  std::string hash;
  bool pinned = true;
  std::string cell;

  static constexpr auto fields() {
    return field_list{required("hash", &pin_build::hash),
                      required("pinned", &pin_build::pinned),
                      required("cell", &pin_build::cell)};
  }
};

/// A build that is whole is to run here: it becomes a skill of this node.
struct use_build {
  std::string hash;

  static constexpr auto fields() {
    return field_list{required("hash", &use_build::hash)};
  }
};

/// Asks what skill a build is that is whole.
struct describe_build {
  std::string hash;

  static constexpr auto fields() {
    return field_list{required("hash", &describe_build::hash)};
  }
};

struct build_described {
  build_name name;
  installed_skill skill;

  static constexpr auto fields() {
    return field_list{required("name", &build_described::name),
                      required("skill", &build_described::skill)};
  }
};

/// The node is in this cell now: what it has of others goes, unless it runs.
struct belong_to_cell {
  std::string cell;

  static constexpr auto fields() {
    return field_list{required("cell", &belong_to_cell::cell)};
  }
};

struct drop_build {
  std::string hash;

  static constexpr auto fields() {
    return field_list{required("hash", &drop_build::hash)};
  }
};

struct build_dropped {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// Has this node fetch a build.
struct fetch_build {
  build_name name;
  std::string cell;
  std::vector<build_source> sources;

  static constexpr auto fields() {
    return field_list{required("name", &fetch_build::name),
                      required("cell", &fetch_build::cell),
                      required("sources", &fetch_build::sources)};
  }
};

/// The build is here, whole and checked.
struct build_fetched {
  std::string hash;

  static constexpr auto fields() {
    return field_list{required("hash", &build_fetched::hash)};
  }
};

/// Whom the node agent asks for builds.
struct serve_builds {
  build_keeper_actor keeper;
  build_fetcher_actor fetcher;
  skill_watcher_actor watcher;
  image_exchange_actor images{}; ///< Invalid: this node has no engine.

  static constexpr auto fields() {
    return field_list{required("keeper", &serve_builds::keeper),
                      required("fetcher", &serve_builds::fetcher),
                      required("watcher", &serve_builds::watcher),
                      required("images", &serve_builds::images)};
  }
};

/// INTERNAL to a fetch: a source has answered question number `question`.
struct source_answered {
  uint64_t question = 0;
  int64_t status = 0; ///< HTTP status; 0: none, and `why` says why.
  std::string body;
  failure why;

  static constexpr auto fields() {
    return field_list{required("question", &source_answered::question),
                      required("status", &source_answered::status),
                      required("body", &source_answered::body),
                      required("why", &source_answered::why)};
  }
};

} // namespace roscell
