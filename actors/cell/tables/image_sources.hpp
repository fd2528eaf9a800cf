#pragma once

#include <cstddef>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

/// Which node gives a container image to one whose engine lacks it.
namespace roscell {

/// What nodes have said of an image: its id in their engines, by node.
using image_holders = std::map<std::string, std::string>;

/// An image, and the nodes that have it.
struct image_choice {
  std::string image_id; ///< Empty: no node has it.
  std::vector<std::string> nodes;
};

/// The same for all who ask: where nodes mean several images by one name it is
/// the one that most of them have. Nodes that have given it before come first,
/// as they have it as a build already.
image_choice choose_image(const image_holders& holders,
                          const std::set<std::string>& gave_before);

/// Who has got the builds that images are on their way, or gets them now: they
/// are sources for those who come later. The last ones are remembered.
class image_readers {
public:
  /// A node gives an image as that build.
  void add_source(const std::string& image_id, const std::string& build,
                  const std::string& node);

  /// A node gets the build.
  void add_reader(const std::string& build, const std::string& node);

  /// Nodes that have the build, or get it.
  std::vector<std::string> of_build(const std::string& build) const;

  /// Nodes that have made builds of an image.
  std::set<std::string> givers_of(const std::string& image_id) const;

private:
  struct entry {
    std::string build;
    std::string image_id;
    std::set<std::string> givers;
    std::set<std::string> nodes;
  };

  entry* find(const std::string& build);

  std::deque<entry> builds_; ///< The newest comes last.
};

} // namespace roscell
