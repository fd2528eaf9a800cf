#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/site.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace roscell {

/// Who has changed what, on the disk: a record a line, each with a hash over
/// itself and the hash before, so that one that was taken out or altered later
/// is seen. The newest are kept, in two files of at most
/// `limits::audit::file_bytes`. Blocks on the disk. One thread at a time.
class audit_file {
public:
  /// What the last run has left half written is cut off.
  explicit audit_file(std::filesystem::path folder);

  /// Its number and hash are set here. Errors: internal (the disk).
  edge_result<audit_record> append(audit_record x);

  /// The newest of those above `since`, at most so many; 0: all that an answer
  /// can hold. Says what of all that is there does not fit together.
  audit_list read(int64_t since, int64_t newest) const;

private:
  void take_up();
  std::optional<edge_error> make_room(size_t bytes);

  std::filesystem::path folder_;
  int64_t last_number_ = 0;
  std::string last_hash_;
};

/// Over the record without its own hash, and the hash before it.
std::string hash_of(const audit_record& x, const std::string& before);

} // namespace roscell
