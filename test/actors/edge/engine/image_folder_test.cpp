#include "actors/edge/engine/image_folder.hpp"
#include "actors/edge/engine/image_layers.hpp"
#include "actors/edge/io/crypto.hpp"
#include "test/temp_folder.hpp"

#include <catch2/catch.hpp>

#include <nlohmann/json.hpp>

#include <set>

namespace roscell::test {

namespace fs = std::filesystem;

namespace {

using document = nlohmann::json;

const std::string low = "sha256:" + std::string(64, 'a');
const std::string high = "sha256:" + std::string(64, 'b');

/// What an engine has saved, unpacked.
struct saved_archive {
  saved_archive() {
    config = document{{"rootfs", {{"diff_ids", {low, high}}}}}.dump();
    id = "sha256:" + sha256_hex(config);
    folder.write("unpacked/some.json", config);
    folder.write("unpacked/1/layer.tar", "low");
    folder.write("unpacked/2/layer.tar", "high");
    folder.write("unpacked/repositories", "{}");
    write_manifest({"1/layer.tar", "2/layer.tar"});
  }

  void write_manifest(const document& layers) const {
    const document manifest{{{"Config", "some.json"},
                             {"RepoTags", {"evil:latest"}},
                             {"Layers", layers}}};
    folder.write("unpacked/manifest.json", manifest.dump());
  }

  std::optional<edge_error> make(size_t layers_there = 0) const {
    return make_image_folder(folder / "unpacked", folder / "image", id,
                             layers_there);
  }

  edge_result<std::vector<std::string>> check() const {
    return check_image_folder(folder / "image", id);
  }

  bool is_refused() const {
    const auto outcome = check();
    const auto* why = std::get_if<edge_error>(&outcome);
    return why != nullptr && why->code == error_code::schema_violation;
  }

  fs::path image(const std::string& name) const {
    return folder / ("image/" + name);
  }

  temp_folder folder;
  std::string config;
  std::string id;
};

} // namespace

TEST_CASE("an image on its way has its config, its layers and no name") {
  const saved_archive saved;
  REQUIRE(!saved.make());
  const auto files = saved.check();
  REQUIRE(std::holds_alternative<std::vector<std::string>>(files));
  const auto& names = std::get<std::vector<std::string>>(files);
  CHECK(names.front() == "manifest.json");
  CHECK(std::set<std::string>(names.begin(), names.end())
        == std::set<std::string>{"manifest.json", saved.id.substr(7) + ".json",
                                 std::string(64, 'a') + ".tar",
                                 std::string(64, 'b') + ".tar"});
  CHECK_FALSE(fs::exists(saved.image("repositories")));
}

TEST_CASE("layers that are there are left out, from the bottom") {
  const saved_archive saved;
  REQUIRE(!saved.make(1));
  CHECK_FALSE(fs::exists(saved.image(std::string(64, 'a') + ".tar")));
  CHECK(fs::exists(saved.image(std::string(64, 'b') + ".tar")));
  CHECK_FALSE(saved.is_refused());
}

TEST_CASE("a layer that is a link in the archive comes as a file") {
  const saved_archive saved;
  fs::rename(saved.folder / "unpacked/2/layer.tar",
             saved.folder / "unpacked/real.tar");
  fs::create_symlink("../real.tar", saved.folder / "unpacked/2/layer.tar");
  REQUIRE(!saved.make());
  CHECK_FALSE(fs::is_symlink(saved.image(std::string(64, 'b') + ".tar")));
  CHECK_FALSE(saved.is_refused());
}

TEST_CASE("what leads out of an engine's archive is not taken") {
  const saved_archive saved;
  saved.folder.write("secret", "x");
  saved.write_manifest({"../secret", "2/layer.tar"});
  CHECK(saved.make()->code == error_code::engine_failed);
}

TEST_CASE("an engine whose ids are no hashes of configs gives no images") {
  saved_archive saved;
  saved.id = low;
  CHECK(saved.make()->message.find("another config") != std::string::npos);
}

TEST_CASE("an image that is not the promised one is not loaded") {
  const saved_archive saved;
  REQUIRE(!saved.make());
  SECTION("another config") {
    saved.folder.write("image/" + saved.id.substr(7) + ".json", "{}");
  }
  SECTION("another file") {
    saved.folder.write("image/index.json", "{}");
  }
  SECTION("a link") {
    fs::create_symlink("manifest.json", saved.image("x"));
  }
  SECTION("a name for it") {
    document manifest = document::parse(
        R"([{"Config":"","RepoTags":["debian:latest"],"Layers":[]}])");
    manifest[0]["Config"] = saved.id.substr(7) + ".json";
    manifest[0]["Layers"] = {std::string(64, 'a') + ".tar",
                             std::string(64, 'b') + ".tar"};
    saved.folder.write("image/manifest.json", manifest.dump());
  }
  SECTION("two images") {
    saved.folder.write("image/manifest.json", "[{},{}]");
  }
  SECTION("other layers") {
    document manifest = document::parse(
        R"([{"Config":"","RepoTags":null,"Layers":["../x.tar"]}])");
    manifest[0]["Config"] = saved.id.substr(7) + ".json";
    saved.folder.write("image/manifest.json", manifest.dump());
  }
  CHECK(saved.is_refused());
}

TEST_CASE("a layer is known with all that are below it") {
  const auto chains = chain_ids({low, high});
  REQUIRE(chains.size() == 2);
  CHECK(chains[0] == low);
  CHECK(chains[1] == "sha256:" + sha256_hex(low + " " + high));
  CHECK(layers_there({low, high}, {low}) == 1);
  CHECK(layers_there({low, high}, chains) == 2);
  CHECK(layers_there({low, high}, {high}) == 0);
  CHECK(layers_there({low, high}, {chains[1]}) == 2);
  CHECK(layers_there({}, {low}) == 0);
}

} // namespace roscell::test
