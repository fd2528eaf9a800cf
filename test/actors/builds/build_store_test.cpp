#include "actors/builds/build_store.hpp"

#include "actors/edge/disk/build_manifest.hpp"
#include "actors/edge/disk/build_pieces.hpp"
#include "actors/edge/io/crypto.hpp"
#include "test/actors/edge/process/supervision_fixture.hpp"

#include <string>

using namespace roscell;
using namespace roscell::test;
namespace fs = std::filesystem;

namespace {

constexpr int64_t mib = build_piece_bytes;

/// A build of so many MiB and a few bytes, unlike all others.
struct sample_build {
  sample_build(char letter, size_t mebibytes) {
    folder.write("data", std::string(mebibytes * build_piece_bytes, letter));
    folder.write("skill.json", "{}");
    described = value_of(describe_folder(folder.path()));
  }

  const std::string& hash() const {
    return described.name.hash;
  }

  std::string piece(size_t i) const {
    return value_of(read_piece(folder.path(), described.manifest, i));
  }

  temp_folder folder;
  described_build described;
};

struct store_fixture {
  build_store open(int64_t most_mib = 10) const {
    return {data.path(), static_cast<uint64_t>(most_mib * mib),
            [](const fs::path&) { return true; }};
  }

  temp_folder data;
};

edge_result<stored_build> offer(build_store& store, const sample_build& x,
                                int64_t now = 1,
                                const std::set<std::string>& used = {},
                                const std::string& cell = "line") {
  return store.offer(x.described.name, x.described.text, cell, used, now);
}

void bring_whole(build_store& store, const sample_build& x, int64_t now = 1) {
  REQUIRE(std::holds_alternative<stored_build>(offer(store, x, now)));
  for (size_t i = 0; i < x.described.manifest.pieces.size(); ++i)
    REQUIRE(std::holds_alternative<stored_build>(
        store.write(x.hash(), i, x.piece(i))));
}

} // namespace

TEST_CASE_METHOD(store_fixture,
                 "a build is a skill's folder once it is whole and to be used",
                 "[builds]") {
  const sample_build x{'a', 2};
  auto store = open();
  value_of(offer(store, x));
  const auto place = build_store::skills_in(data.path()) / x.hash();
  for (size_t i = 0; i < 3; ++i) {
    CHECK(error_of(store.use(x.hash(), 1)).code == error_code::conflict);
    value_of(store.write(x.hash(), i, x.piece(i)));
    CHECK_FALSE(fs::exists(place));
  }
  CHECK(store.find(x.hash())->whole);
  CHECK(value_of(store.use(x.hash(), 2)).used);
  CHECK(value_of(store.use(x.hash(), 3)).used);
  CHECK(value_of(describe_folder(place)).name.hash == x.hash());
  CHECK(value_of(store.read(x.hash(), 1)) == x.piece(1));
  CHECK(value_of(store.manifest_text(x.hash())) == x.described.text);
}

TEST_CASE_METHOD(store_fixture, "what has come is found again after a start",
                 "[builds]") {
  const sample_build whole{'a', 1};
  const sample_build part{'b', 3};
  const sample_build used{'c', 1};
  {
    auto store = open();
    bring_whole(store, whole);
    bring_whole(store, used);
    value_of(store.use(used.hash(), 1));
    value_of(offer(store, part));
    value_of(store.write(part.hash(), 2, part.piece(2)));
  }
  auto store = open();
  CHECK(store.find(whole.hash())->whole);
  CHECK_FALSE(store.find(whole.hash())->used);
  CHECK(store.find(used.hash())->used);
  CHECK(value_of(store.read(used.hash(), 0)) == used.piece(0));
  CHECK(store.find(part.hash())->pieces
        == std::vector<bool>{false, false, true, false});
  CHECK(value_of(store.read(part.hash(), 2)) == part.piece(2));
  CHECK(error_of(store.read(part.hash(), 1)).code == error_code::conflict);
}

TEST_CASE_METHOD(
    store_fixture,
    "what no record tells of is gone after a start, and is no skill",
    "[builds]") {
  const sample_build x{'a', 1};
  {
    auto store = open();
    bring_whole(store, x);
    value_of(store.use(x.hash(), 1));
  }
  // The power went while it was being dropped, or put to its place.
  fs::remove(data.path() / "about" / (x.hash() + ".json"));
  data.write("kept/part/skill.json", "{}");
  data.write("unfinished/part/data", "x");
  const auto store = open();
  CHECK(store.builds().empty());
  for (const auto* place : {"skills", "kept", "unfinished"})
    CHECK(fs::is_empty(data.path() / place));
}

TEST_CASE_METHOD(store_fixture,
                 "another text of its manifest leaves a build that is whole",
                 "[builds]") {
  const sample_build x{'a', 1};
  auto store = open();
  bring_whole(store, x);
  auto name = x.described.name;
  const auto text = x.described.text + "\n";
  name.manifest = sha256_hex(text);
  CHECK(value_of(store.offer(name, text, "line", {}, 2)).whole);
  CHECK(value_of(store.read(x.hash(), 0)) == x.piece(0));
}

TEST_CASE_METHOD(store_fixture, "what was not used for longest goes for room",
                 "[builds]") {
  const sample_build a{'a', 4};
  const sample_build b{'b', 4};
  const sample_build c{'c', 4};
  auto store = open();
  bring_whole(store, a, 1);
  bring_whole(store, b, 2);
  SECTION("the oldest") {
    value_of(offer(store, c, 3));
    CHECK_FALSE(store.find(a.hash()));
    CHECK(store.find(b.hash()));
  }
  SECTION("unless it was used since") {
    store.touch(a.hash(), 3);
    value_of(offer(store, c, 4));
    CHECK(store.find(a.hash()));
    CHECK_FALSE(store.find(b.hash()));
  }
  SECTION("unless it is in use") {
    value_of(offer(store, c, 3, {a.hash()}));
    CHECK(store.find(a.hash()));
    CHECK_FALSE(store.find(b.hash()));
  }
  SECTION("unless the cell counts on it") {
    CHECK_FALSE(store.pin(a.hash(), true, "line"));
    value_of(offer(store, c, 3));
    CHECK(store.find(a.hash()));
    CHECK_FALSE(store.find(b.hash()));
  }
  SECTION("and nothing where all are in use") {
    CHECK(error_of(offer(store, c, 3, {a.hash(), b.hash()})).code
          == error_code::conflict);
    CHECK(store.find(a.hash()));
    CHECK(store.find(b.hash()));
  }
}

TEST_CASE_METHOD(store_fixture, "a pin outlives a start", "[builds]") {
  const sample_build a{'a', 4};
  const sample_build b{'b', 4};
  {
    auto store = open();
    bring_whole(store, a);
    CHECK_FALSE(store.pin(a.hash(), true, "line"));
  }
  auto store = open(6);
  CHECK(error_of(offer(store, b)).code == error_code::conflict);
  CHECK_FALSE(store.pin(a.hash(), false, "line"));
  value_of(offer(store, b));
}

TEST_CASE_METHOD(store_fixture,
                 "of another cell's builds a node keeps what it runs",
                 "[builds]") {
  const sample_build a{'a', 1};
  const sample_build b{'b', 1};
  auto store = open();
  bring_whole(store, a);
  bring_whole(store, b);
  store.leave_cells_but("line", {});
  CHECK(store.builds().size() == 2);
  store.leave_cells_but("other", {b.hash()});
  CHECK_FALSE(store.find(a.hash()));
  CHECK(store.find(b.hash()));
  CHECK_FALSE(fs::exists(data.path() / "kept" / a.hash()));
}

TEST_CASE_METHOD(store_fixture, "a build for other hosts is no skill here",
                 "[builds]") {
  const sample_build x{'a', 1};
  build_store store{data.path(), 10 * mib,
                    [](const fs::path&) { return false; }};
  bring_whole(store, x);
  CHECK(error_of(store.use(x.hash(), 1)).code == error_code::conflict);
  CHECK(fs::is_empty(build_store::skills_in(data.path())));
  CHECK(value_of(store.read(x.hash(), 0)) == x.piece(0));
}

TEST_CASE_METHOD(store_fixture, "a build that is dropped leaves nothing",
                 "[builds]") {
  const sample_build x{'a', 1};
  auto store = open();
  bring_whole(store, x);
  CHECK_FALSE(store.drop(x.hash()));
  CHECK(store.builds().empty());
  size_t files = 0;
  for (const auto& f : fs::recursive_directory_iterator{data.path()})
    files += f.is_regular_file() ? 1 : 0;
  CHECK(files == 0);
}

TEST_CASE_METHOD(store_fixture, "a folder beside the store becomes a build",
                 "[builds]") {
  auto store = open();
  const sample_build sample{'a', 2};
  const auto take = [&](const build_name& name) {
    const auto folder = data.path() / "images" / "x";
    fs::create_directories(folder.parent_path());
    fs::copy(sample.folder.path(), folder, fs::copy_options::recursive);
    auto result =
        store.take(folder, name, sample.described.text, "line", {}, 1);
    CHECK_FALSE(fs::exists(folder));
    return result;
  };
  auto other = sample.described.name;
  other.manifest = std::string(64, 'f');
  CHECK(std::get<edge_error>(take(other)).code == error_code::schema_violation);
  CHECK(value_of(take(sample.described.name)).whole);
  CHECK(fs::exists(build_store::kept_in(data.path()) / sample.hash()));
  CHECK(value_of(store.read(sample.hash(), 0)) == sample.piece(0));
  // The same once more, and after a start.
  CHECK(value_of(take(sample.described.name)).whole);
  CHECK(open().find(sample.hash())->whole);
}

TEST_CASE_METHOD(store_fixture,
                 "a folder that is too large for the store does not come into "
                 "it",
                 "[builds]") {
  auto store = open(1);
  const sample_build sample{'a', 2};
  const auto folder = data.path() / "x";
  fs::copy(sample.folder.path(), folder, fs::copy_options::recursive);
  const auto result = store.take(folder, sample.described.name,
                                 sample.described.text, "line", {}, 1);
  CHECK(std::get<edge_error>(result).code == error_code::conflict);
  CHECK_FALSE(fs::exists(folder));
  CHECK(store.builds().empty());
}
