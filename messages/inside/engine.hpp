#pragma once

#include "messages/failure.hpp"
#include "messages/inside/runtime.hpp"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

/// What the parts of the engine runtime say to each other. INTERNAL to it.
namespace roscell {

/// An engine's answer to call number `call`, or the end of a stream.
struct engine_answered {
  uint64_t call = 0;
  int status = 0; ///< HTTP status; 0: there is no answer, and `why` says why.
  std::string body;
  failure why;

  static constexpr auto fields() {
    return field_list{required("call", &engine_answered::call),
                      required("status", &engine_answered::status),
                      required("body", &engine_answered::body),
                      required("why", &engine_answered::why)};
  }
};

/// Lines of a streamed answer; none at all when it has just been opened.
struct engine_streamed {
  uint64_t call = 0;
  std::vector<std::string> lines;

  static constexpr auto fields() {
    return field_list{required("call", &engine_streamed::call),
                      required("lines", &engine_streamed::lines)};
  }
};

/// A part of a container's log was read, for call number `call`.
struct engine_log_read {
  uint64_t call = 0;
  std::string text;
  int64_t next_offset = 0;
  bool is_whole = true;               ///< It is all that is there.
  std::vector<int64_t> times_unix_ms; ///< As in a log_excerpt.
  std::string bytes;                  ///< As in a log_excerpt.

  static constexpr auto fields() {
    return field_list{
        required("call", &engine_log_read::call),
        required("text", &engine_log_read::text),
        required("next_offset", &engine_log_read::next_offset),
        required("is_whole", &engine_log_read::is_whole),
        required("times_unix_ms", &engine_log_read::times_unix_ms),
        required("bytes", &engine_log_read::bytes)};
  }
};

/// Reply to `prepare_image`: how the image is called and made.
struct image_planned {
  std::string image; ///< "roscell/<operation>:<hash>"
  std::string dockerfile;
  /// Files of this host whose change makes another image, and how they were.
  std::map<std::string, std::string> made_of;

  static constexpr auto fields() {
    return field_list{required("image", &image_planned::image),
                      required("dockerfile", &image_planned::dockerfile),
                      required("made_of", &image_planned::made_of)};
  }
};

/// Writes the build context of the image that was planned last.
struct pack_image {
  /// The id of its base image, where the name is one that the engine does not
  /// know it by; empty: the name.
  std::string base;

  static constexpr auto fields() {
    return field_list{required("base", &pack_image::base)};
  }
};

struct image_packed {
  std::string file; ///< A tar file, which the receiver removes.

  static constexpr auto fields() {
    return field_list{required("file", &image_packed::file)};
  }
};

/// Asks how to log in where an image is pulled from.
struct find_login {
  std::string image;

  static constexpr auto fields() {
    return field_list{required("image", &find_login::image)};
  }
};

struct login_found {
  std::string header; ///< For the engine, a secret; empty: there is none.

  static constexpr auto fields() {
    return field_list{required("header", &login_found::header)};
  }
};

} // namespace roscell
