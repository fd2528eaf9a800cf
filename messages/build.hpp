#pragma once

#include "messages/codec/json_codec.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// The content of a skill folder as nodes pass it on: its files one after the
/// other, in the order of their paths, cut into pieces of one size.
namespace roscell {

constexpr uint64_t build_piece_bytes = 1024 * 1024;

/// A file of a build, or a link.
struct build_file {
  std::string path;  ///< Relative, with '/' between its parts.
  int64_t bytes = 0; ///< Of a link 0.
  bool program = false;
  std::string sha256; ///< Of its bytes, in hexadecimal; of a link empty.
  std::string link;   ///< What it points to; empty: it is a file.

  static constexpr auto fields() {
    return field_list{required("path", &build_file::path),
                      optional("bytes", &build_file::bytes),
                      optional("program", &build_file::program),
                      optional("sha256", &build_file::sha256),
                      optional("link", &build_file::link)};
  }
};

/// All that must be known of a build before its first byte comes. The files say
/// the build's hash (`hash_of`), the pieces what each of them must be.
struct build_manifest {
  std::vector<build_file> files;   ///< In the order of their paths.
  std::vector<std::string> pieces; ///< SHA-256 of each, in hexadecimal.

  static constexpr auto fields() {
    return field_list{required("files", &build_manifest::files),
                      required("pieces", &build_manifest::pieces)};
  }
};

/// What names a build beyond doubt, and what it takes.
struct build_name {
  std::string hash;     ///< Of its files: what skills are known by.
  std::string manifest; ///< SHA-256 of the text of its manifest.
  int64_t bytes = 0;    ///< Of all its files.

  static constexpr auto fields() {
    return field_list{required("hash", &build_name::hash),
                      required("manifest", &build_name::manifest),
                      required("bytes", &build_name::bytes)};
  }
};

/// A node that has a build, or gets it now.
struct build_source {
  std::string node;
  std::string address; ///< "ADDR:PORT" of its HTTP server.
  std::string permit;  ///< By which it gives the build to who asks.

  static constexpr auto fields() {
    return field_list{required("node", &build_source::node),
                      required("address", &build_source::address),
                      required("permit", &build_source::permit)};
  }
};

/// A build that a node may lack, and who gives it.
struct build_offer {
  build_name build;
  std::vector<build_source> sources;

  static constexpr auto fields() {
    return field_list{required("build", &build_offer::build),
                      required("sources", &build_offer::sources)};
  }
};

} // namespace roscell
