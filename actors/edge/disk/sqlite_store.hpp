#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

struct sqlite3;

namespace roscell {

/// Records of a node in one SQLite file: table, key, value. Writes are durable
/// when they return and cost one sync of the disk each. The file is held
/// exclusively. Not for two threads at once.
class sqlite_store {
public:
  using record = std::pair<std::string, std::string>; ///< Key and value.

  /// A record to be written, in place of an older one; no value removes it.
  struct change {
    std::string table;
    std::string key;
    std::optional<std::string> value;
  };

  /// Opens or makes the file and checks it. One that is there is only read, so
  /// that it can be opened where the disk is full; of an older version it is
  /// carried over.
  /// Errors: conflict (another program holds it), internal (damaged, made by a
  /// newer version, no permission, no room to make it).
  static edge_result<sqlite_store> open(const std::filesystem::path& file);

  /// All records of a table, by key.
  edge_result<std::vector<record>> load(const std::string& table);

  /// Who gives way where there is no room to write; false: he has none left to
  /// give. Called by whoever writes.
  void set_room_maker(std::function<bool()> make_room) {
    make_room_ = std::move(make_room);
  }

  /// Writes all of `changes`, in their order, or none of them. Returns what
  /// went wrong.
  std::optional<edge_error> write(const std::vector<change>& changes);

  /// Writes one record, in place of an older one.
  std::optional<edge_error> put(const std::string& table,
                                const std::string& key,
                                const std::string& value);

  /// Removes a record; none of that key is no error.
  std::optional<edge_error> remove(const std::string& table,
                                   const std::string& key);

  /// What this process has written to the file and its journal so far: whole
  /// pages. May be called from any thread.
  uint64_t bytes_written() const {
    return written_->load(std::memory_order_relaxed);
  }

private:
  struct closer {
    void operator()(sqlite3* db) const;
  };

  sqlite_store(std::filesystem::path file, std::unique_ptr<sqlite3, closer> db);

  std::optional<edge_error> prepare();
  std::optional<edge_error> run(const char* sql,
                                const std::vector<std::string>& values,
                                std::vector<record>* rows = nullptr);
  std::optional<edge_error> write_once(const std::vector<change>& changes);
  std::optional<edge_error> apply(const change& x);
  bool lacks_room() const; ///< That was why the last step failed.
  edge_error explain() const;
  void count_written();

  std::filesystem::path file_;
  std::unique_ptr<sqlite3, closer> db_;
  int step_errno_ = 0;   ///< What the system said in the last step.
  bool had_room_ = true; ///< In the last attempt to write.
  std::function<bool()> make_room_;
  /// The store moves, and others read this meanwhile.
  std::shared_ptr<std::atomic<uint64_t>> written_ =
      std::make_shared<std::atomic<uint64_t>>(0);
};

/// What is said of a file that cannot be trusted, and what to do about it.
edge_error damaged_store(const std::filesystem::path& file,
                         const std::string& how);

} // namespace roscell
