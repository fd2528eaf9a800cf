#include "actors/edge/disk/sqlite_store.hpp"

#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <sqlite3.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstring>

namespace roscell {

namespace {

/// Raised when tables or records change in a way that older programs cannot
/// read; these then refuse the file. Records of version 1 are read as they are.
constexpr int layout_version = 2;

/// Write-ahead log and one sync per commit: a record costs a page or two
/// instead of the four writes and three syncs of a rollback journal. The lock
/// is held for good, so that no shared memory file is needed. The log goes back
/// into the file after 64 pages, to keep both small.
constexpr const char* settings = "PRAGMA locking_mode=EXCLUSIVE;"
                                 "PRAGMA page_size=1024;"
                                 "PRAGMA journal_mode=WAL;"
                                 "PRAGMA synchronous=FULL;"
                                 "PRAGMA cache_size=-64;"
                                 "PRAGMA wal_autocheckpoint=64;"
                                 "PRAGMA journal_size_limit=65536;"
                                 "PRAGMA temp_store=MEMORY;";

constexpr const char* layout =
    "BEGIN IMMEDIATE;"
    "CREATE TABLE IF NOT EXISTS records(tbl TEXT NOT NULL, key TEXT NOT NULL,"
    " value TEXT NOT NULL, PRIMARY KEY(tbl, key)) WITHOUT ROWID;"
    "PRAGMA user_version=2;"
    "COMMIT;";

struct statement_closer {
  void operator()(sqlite3_stmt* x) const {
    sqlite3_finalize(x);
  }
};

using statement = std::unique_ptr<sqlite3_stmt, statement_closer>;

std::string column(sqlite3_stmt* row, int index) {
  const auto* text = sqlite3_column_text(row, index);
  if (text == nullptr)
    return {};
  return {reinterpret_cast<const char*>(text),
          static_cast<size_t>(sqlite3_column_bytes(row, index))};
}

/// What an error means to an operator.
edge_error meaning(int code, const std::string& file) {
  switch (code) {
  case SQLITE_BUSY:
  case SQLITE_LOCKED:
    return {error_code::conflict, "'" + file + "' is in use by another program",
            "stop that program, or choose another --data-dir"};
  case SQLITE_CORRUPT:
  case SQLITE_NOTADB:
    return damaged_store(file, {});
  case SQLITE_CANTOPEN:
  case SQLITE_READONLY:
  case SQLITE_PERM:
    return {error_code::internal, "'" + file + "' cannot be written",
            "give this user write access to the file and its folder"};
  case SQLITE_FULL:
    return {error_code::internal, "no room is left to write '" + file + "'",
            "free some disk space"};
  default:
    return {error_code::internal, "'" + file + "' cannot be used", {}};
  }
}

/// SQLite would let everybody read a file that it makes. Where this fails,
/// SQLite tells why. The descriptor must be closed before SQLite locks the
/// file, because any close drops the locks of the process.
void make_private(const std::filesystem::path& file) {
  const unique_fd made{
      ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, S_IRUSR | S_IWUSR)};
}

} // namespace

void sqlite_store::closer::operator()(sqlite3* db) const {
  sqlite3_close(db);
}

sqlite_store::sqlite_store(std::filesystem::path file,
                           std::unique_ptr<sqlite3, closer> db)
    : file_(std::move(file)), db_(std::move(db)) {
  // nop
}

edge_result<sqlite_store>
sqlite_store::open(const std::filesystem::path& file) {
  make_private(file);
  sqlite3* db = nullptr;
  // The handle is there even after a failure, to tell what went wrong.
  const int code =
      sqlite3_open_v2(file.c_str(), &db,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE
                          | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_EXRESCODE,
                      nullptr);
  sqlite_store result{file, std::unique_ptr<sqlite3, closer>{db}};
  if (code != SQLITE_OK)
    return result.explain();
  if (auto error = result.prepare())
    return *error;
  return result;
}

std::optional<edge_error> sqlite_store::prepare() {
  const auto execute = [this](const char* sql) {
    return sqlite3_exec(db_.get(), sql, nullptr, nullptr, nullptr) == SQLITE_OK;
  };
  if (!execute(settings))
    return explain();
  std::vector<record> rows;
  if (auto error =
          run("SELECT user_version, '' FROM pragma_user_version", {}, &rows))
    return error;
  const int version = rows.empty() ? 0 : std::atoi(rows[0].first.c_str());
  if (version > layout_version)
    return edge_error{error_code::internal,
                      "'" + file_.string() + "' was made by a newer version",
                      "install that version, or choose another --data-dir"};
  rows.clear();
  if (auto error =
          run("SELECT quick_check, '' FROM pragma_quick_check(1)", {}, &rows))
    return error;
  if (rows.empty() || rows[0].first != "ok")
    return meaning(SQLITE_CORRUPT, file_.string());
  if (version == layout_version || execute(layout))
    return std::nullopt;
  const auto why = explain();
  const bool readable = version > 0 && lacks_room();
  execute("ROLLBACK");
  // A disk without room keeps nobody from reading what is there.
  return readable ? std::nullopt : std::optional<edge_error>{why};
}

std::optional<edge_error>
sqlite_store::run(const char* sql, const std::vector<std::string>& values,
                  std::vector<record>* rows) {
  sqlite3_stmt* made = nullptr;
  if (sqlite3_prepare_v2(db_.get(), sql, -1, &made, nullptr) != SQLITE_OK)
    return explain();
  const statement x{made};
  for (size_t i = 0; i < values.size(); ++i)
    if (sqlite3_bind_text64(made, static_cast<int>(i + 1), values[i].data(),
                            values[i].size(), SQLITE_TRANSIENT, SQLITE_UTF8)
        != SQLITE_OK)
      return explain();
  for (;;) {
    errno = 0;
    const int code = sqlite3_step(made);
    step_errno_ = errno;
    if (code == SQLITE_DONE)
      return std::nullopt;
    if (code != SQLITE_ROW)
      return explain();
    if (rows != nullptr)
      rows->emplace_back(column(made, 0), column(made, 1));
  }
}

edge_result<std::vector<sqlite_store::record>>
sqlite_store::load(const std::string& table) {
  std::vector<record> result;
  if (auto error =
          run("SELECT key, value FROM records WHERE tbl=? ORDER BY key",
              {table}, &result))
    return *error;
  return result;
}

std::optional<edge_error>
sqlite_store::write(const std::vector<change>& changes) {
  if (changes.empty())
    return std::nullopt;
  auto error = write_once(changes);
  while (error && !had_room_ && make_room_ && make_room_())
    error = write_once(changes);
  return error;
}

std::optional<edge_error>
sqlite_store::write_once(const std::vector<change>& changes) {
  auto error = run("BEGIN IMMEDIATE", {});
  for (auto i = changes.begin(); !error && i != changes.end(); ++i)
    error = apply(*i);
  if (!error)
    error = run("COMMIT", {});
  // SQLite knows it until the next call.
  had_room_ = !error || !lacks_room();
  // After some errors SQLite has rolled back by itself.
  if (error && sqlite3_get_autocommit(db_.get()) == 0)
    run("ROLLBACK", {});
  count_written();
  return error;
}

std::optional<edge_error> sqlite_store::put(const std::string& table,
                                            const std::string& key,
                                            const std::string& value) {
  return write({{table, key, value}});
}

std::optional<edge_error> sqlite_store::remove(const std::string& table,
                                               const std::string& key) {
  return write({{table, key, std::nullopt}});
}

std::optional<edge_error> sqlite_store::apply(const change& x) {
  if (x.value)
    return run("INSERT OR REPLACE INTO records VALUES(?,?,?)",
               {x.table, x.key, *x.value});
  return run("DELETE FROM records WHERE tbl=? AND key=?", {x.table, x.key});
}

void sqlite_store::count_written() {
  int pages = 0;
  int highest = 0;
  std::vector<record> size;
  sqlite3_db_status(db_.get(), SQLITE_DBSTATUS_CACHE_WRITE, &pages, &highest,
                    1);
  if (!run("SELECT page_size, '' FROM pragma_page_size", {}, &size)
      && size.size() == 1)
    written_->fetch_add(static_cast<uint64_t>(pages)
                            * std::strtoull(size[0].first.c_str(), nullptr, 10),
                        std::memory_order_relaxed);
}

/// SQLite takes only a full device for a lack of room; a quota and a limit of
/// the process are some too.
bool sqlite_store::lacks_room() const {
  const int code = sqlite3_errcode(db_.get()) & 0xff;
  // SQLite forgets it when a commit fails.
  const int reported = sqlite3_system_errno(db_.get());
  const int number = reported != 0 ? reported : step_errno_;
  return code == SQLITE_FULL
         || ((code == SQLITE_IOERR || code == SQLITE_CANTOPEN)
             && (number == EDQUOT || number == EFBIG || number == ENOSPC));
}

edge_error sqlite_store::explain() const {
  if (!db_)
    return meaning(SQLITE_NOMEM, file_.string());
  const int code =
      lacks_room() ? SQLITE_FULL : sqlite3_errcode(db_.get()) & 0xff;
  auto result = meaning(code, file_.string());
  result.message += std::string{" ("} + sqlite3_errmsg(db_.get());
  if (const int number = sqlite3_system_errno(db_.get()); number != 0)
    result.message += std::string{", "} + std::strerror(number);
  result.message += ')';
  return result;
}

edge_error damaged_store(const std::filesystem::path& file,
                         const std::string& how) {
  return {error_code::internal,
          "'" + file.string() + "' is damaged" + (how.empty() ? "" : ": ")
              + how,
          "restore a copy of it, or start the node once with --new-identity: "
          "that puts the file aside, ends the instances of before, and begins "
          "anew without the tasks"};
}

} // namespace roscell
