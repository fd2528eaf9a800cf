#pragma once

#include "actors/edge/process/instance_log.hpp"
#include "messages/kept_log.hpp"

#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

namespace roscell {

/// The logs of instances that are gone, in a folder for each:
/// `<instance>@<when it ended>/`, in which are the files that its shim has
/// written, and `about.json`. Runtimes put them there and the NODE HISTORY
/// takes the oldest away, both at once, so whatever is there may be gone at the
/// next look. What is damaged, or not ours, is passed over; links are not
/// followed. Blocks on the disk.
class kept_log_folder {
public:
  /// @param folder `<data-dir>/history/logs`; it is made when it is needed.
  explicit kept_log_folder(std::filesystem::path folder);

  /// Moves the log that a shim keeps in `from` here. False if there is none, or
  /// it cannot be moved: what is left there is nobody's.
  bool keep(const std::filesystem::path& from, const kept_log& about);

  /// The same for the end of a log that an engine keeps.
  bool keep(const log_part& end, const kept_log& about);

  /// Which are there; the newest end first.
  kept_logs list(const kept_logs_query& query) const;

  /// The newest log of that instance; nothing if none is kept.
  std::optional<instance_log> newest_of(const std::string& instance) const;

  /// Reads how much there is, for what is asked below.
  void look();

  /// What they take on the disk, with what is damaged.
  uint64_t bytes() const {
    return bytes_;
  }

  size_t count() const {
    return seen_.size();
  }

  /// When the instance of the oldest log ended; nothing if there is none.
  std::optional<int64_t> oldest_unix_ms() const;

  /// Removes the oldest. False if there is none.
  bool drop_oldest();

private:
  /// One log, or what lies in its place.
  struct entry {
    std::string name;
    std::string instance; ///< Empty: it is no log of ours.
    int64_t unix_ms = 0;  ///< Its end, or when it was made.
  };

  struct sized_entry {
    entry what;
    uint64_t bytes = 0;
  };

  std::vector<entry> entries() const;
  std::optional<kept_log> read(const entry& x) const;
  std::optional<std::filesystem::path> begin(const kept_log& about);
  bool finish(const std::filesystem::path& part, const kept_log& about);
  void drop_surplus(const std::string& instance);

  std::filesystem::path folder_;
  std::vector<sized_entry> seen_; ///< The oldest last.
  uint64_t bytes_ = 0;
};

// INTERNAL to the folder of kept logs: what lies on the disk, of which links
// are not followed and nothing need be there any more.

bool look_at(const std::filesystem::path& path, struct stat& info);

bool is_folder(const std::filesystem::path& path);

bool is_file(const std::filesystem::path& path);

/// Calls `visit` with each path in the folder, as far as it can be read.
template <class Visit>
void for_each_in(const std::filesystem::path& folder, Visit&& visit) {
  std::error_code error;
  for (std::filesystem::directory_iterator i{folder, error}, end;
       !error && i != end; i.increment(error))
    visit(i->path());
}

/// What a file, or a folder with its files, takes on the disk.
uint64_t bytes_below(const std::filesystem::path& path);

/// Replaces the content of a file. False: it may have a part of it.
bool write_file(const std::filesystem::path& path, std::string_view bytes);

} // namespace roscell
