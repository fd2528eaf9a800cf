#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Builds of skills that nodes of a cell fetch from each other.
namespace roscell::limits::build {

/// Pieces that one source is asked for at a time: one is on its way while the
/// next one is being read.
constexpr size_t questions_of_source = 2;
/// Of more sources than these one at a time will do. What a source sends to
/// many at once comes to all of them late, and they have nothing for each other
/// until then.
constexpr size_t few_sources = 2;
/// Pieces of a build that are on their way at a time, each of which is in
/// memory when it comes.
constexpr size_t questions_of_fetch = 16;
/// A piece that was asked for so long ago is asked of another source as well.
constexpr seconds slow{3};
/// Questions in a row that a source leaves without a piece before it is asked
/// no more.
constexpr int failures_in_a_row = 3;
/// Digits of a hash by which people are told of a build.
constexpr size_t shown_digits = 12;
/// What is written of a stored build beside its manifest.
constexpr size_t about_bytes = 4 * kib;
/// Manifests that a store keeps in memory: those that are being read from.
constexpr size_t manifests_in_memory = 4;

/// Questions that wait for more of a build, on one node.
constexpr size_t waiting = 64;
/// For the disk: making the files of a build, or reading all of it once more.
constexpr minutes disk{2};
/// For all of a build to come to a node, which then pins it and reads it; for a
/// coordinator to hear of that over a session; and for a build to be added to a
/// cell, for which it comes to two nodes.
constexpr minutes fetch{8};
constexpr seconds keeping = fetch + 2 * disk;
constexpr seconds keeping_session = keeping + seconds{10};
constexpr seconds keeping_answer = keeping_session + seconds{10};
constexpr seconds addition = 2 * keeping_answer + disk;
constexpr seconds pull = keeping_answer + disk;
/// How often it is told of a fetch how it gets on.
constexpr seconds progress{1};
/// For one piece, or the manifest, to come from a source.
constexpr seconds piece_call{60};
/// How long a source lets a question for more of a build wait, and how long who
/// asks waits for the answer.
constexpr seconds more{25};
/// A source is asked again once it has this part more than it had: of each
/// piece on its own a hundred nodes would be told a hundred times.
constexpr int part_of_news = 4;
/// Who says the same again sooner does not wait, and would be asked without
/// end.
constexpr seconds least_wait{5};
constexpr seconds more_call{30};
/// Sources of one fetch that are told of.
constexpr size_t sources = 64;

} // namespace roscell::limits::build

/// Container images that come from other nodes' engines.
namespace roscell::limits::image {

/// For an engine to look for an image, which a node is asked by its
/// coordinator, and for its own to list what it has.
constexpr seconds query{12};
constexpr seconds query_session{15};
constexpr seconds query_answer{17};
constexpr seconds list{60};
/// For an image to be saved and to become a build; for the coordinator to hear
/// of that; and for one node after another to try. Who waits for its container
/// has given up before the last of these: what has come by then is kept.
constexpr minutes saving{7};
constexpr seconds sharing = saving + build::disk;
constexpr seconds sharing_session = sharing + seconds{10};
constexpr seconds sharing_answer = sharing_session + seconds{5};
constexpr size_t sources_tried = 2;
constexpr seconds offer = query_answer + sources_tried * sharing_answer;
constexpr seconds offer_session = offer + seconds{5};
constexpr seconds offer_answer = offer_session + seconds{5};
/// For a folder to be packed and loaded.
constexpr minutes loading{7};
/// How often an image is asked for whose source has failed.
constexpr int attempts = 3;
/// Images that are remembered as builds, on their node and its coordinator.
constexpr size_t remembered = 64;

} // namespace roscell::limits::image
