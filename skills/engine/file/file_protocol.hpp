#pragma once

#include "roscell/skill/handlers.hpp"
#include "roscell/skill/registry.hpp"

#include <memory>
#include <string>

namespace roscell::engine {

/// The `file` protocol. An endpoint is an absolute path.
///
/// As an input, a folder gives each regular file in it, in the order of names,
/// as one frame; names that begin with a dot are left out, and if the data type
/// is an image's, so are the descriptions that lie beside images (.json, .yaml,
/// .yml, .txt, .md). A regular file gives each line as one frame if the data
/// type is a text type, and else its whole content as one frame. Nothing is
/// lost: the input waits until the executor has room. A frame larger than
/// `max_frame_mib` is skipped and said.
///
/// As an output, an existing folder or a path that ends with '/' gets one file
/// per frame, named after the frame, which appears only when it is complete.
/// Any other path gets one line per frame, appended; missing parent folders
/// are created. Nothing is forced to the disk before it is needed there.
///
/// | parameter | default | meaning |
/// |---|---|---|
/// | follow | true | wait for more lines and files, until stopped; else the
///   skill ends by itself when everything is processed |
/// | loop | false | a folder begins again after its last file, until stopped
/// | rate_hz | 0 | most frames per second of an input; 0 is no limit |
/// | max_frame_mib | 64 | largest frame that is read |
///
/// A last line without a newline becomes a frame when its writer closes the
/// file, when the file is replaced, and at the end if `follow` is false. A
/// file that was cut and has grown past its old length before anybody looked
/// cannot be told from one that has grown: replace it by a rename instead.
void add_file_protocol(registry& target);

/// Throws start_error, naming the path, when it is no usable input.
std::unique_ptr<input_handler> make_file_input(const stream_context& input);

/// Throws start_error, naming the path, when it is no usable output.
std::unique_ptr<output_handler> make_file_output(const stream_context& output);

/// Whether the `file` protocol represents a frame of this type as one line.
bool is_text_type(const std::string& data_type);

} // namespace roscell::engine
