#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/inside/storage.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string_view>
#include <vector>

namespace roscell {

/// The events of a node in files `events.<number>`, named after the first
/// number that they hold. New ones are appended to the last file until that is
/// large or old; a bound is held by removing whole files, the oldest first.
/// Blocks on the disk; not for two threads at once.
class event_files {
public:
  /// What is in `folder` that is not ours stays as it is.
  explicit event_files(std::filesystem::path folder);

  /// The highest number that is kept; 0: none is.
  uint64_t highest() const;

  /// Durable when it returns; what could not be written whole is taken back.
  /// `now_unix_ms` is by the wall clock.
  std::optional<edge_error> append(const std::vector<event>& events,
                                   int64_t now_unix_ms);

  /// One part of what `query` wants, as much as fits; empty: there is no more.
  /// Lines that cannot be read are left out.
  std::vector<event> read(const past_events_query& query) const;

  /// What the files take on the disk.
  uint64_t bytes() const;

  /// When the oldest file was written for the last time; none: there is none.
  std::optional<int64_t> oldest_unix_ms() const;

  /// Removes the oldest file. False: there is none, or it cannot be removed.
  bool drop_oldest();

private:
  struct file {
    uint64_t bytes = 0;
    int64_t written_unix_ms = 0; ///< For the last time.
  };

  using visitor = std::function<bool(uint64_t, std::string_view)>;

  std::filesystem::path path_of(uint64_t first) const;
  void visit(uint64_t first, const visitor& on_line) const;
  uint64_t begin_of_newest(uint64_t since, uint64_t count) const;
  uint64_t begin_of_time(uint64_t since, int64_t unix_ms) const;
  uint64_t file_for(uint64_t first, int64_t now_unix_ms) const;

  std::filesystem::path folder_;
  std::map<uint64_t, file> files_; ///< By their first numbers.
  int64_t begun_unix_ms_ = 0;      ///< The last file; 0: by an earlier run.
};

} // namespace roscell
