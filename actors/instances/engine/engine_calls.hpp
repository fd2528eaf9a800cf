#pragma once

#include "actors/instances/engine/engine_runtime.hpp"

#include <caf/error.hpp>

#include <string>

/// INTERNAL to the engine runtime: what its parts share.
namespace roscell {

using engine_runtime_pointer =
    engine_runtime_actor::stateful_pointer<engine_runtime_state>;

/// Asks the engine; the answer comes as a message to this actor, which calls
/// `then`.
void ask_engine(engine_runtime_pointer self, engine_request what,
                engine_runtime_state::continuation then);

/// Asks for a streamed answer, whose lines come as `engine_streamed`; `then`
/// is called at its end.
struct opened_call {
  uint64_t call = 0;
  engine_stream stream;
};
opened_call stream_lines(engine_runtime_pointer self, engine_request what,
                         engine_runtime_state::continuation then);

/// Registers what happens at the end of a call.
uint64_t expect_answer(engine_runtime_pointer self,
                       engine_runtime_state::continuation then);

/// The message for an answer, made on the io thread.
engine_answered to_message(uint64_t call, engine_answer answer);

/// Whether the engine could not be asked at all, so that nothing is known.
bool is_lost(const engine_answered& x);

bool is_good(const engine_answered& x);

/// What went wrong, as a sentence that begins with `what`: engine_failed.
caf::error engine_failure(const std::string& what, const engine_answered& x);

/// The JSON object of a good answer; an empty object if it is none.
json object_of(const engine_answered& x);

/// A part of an object; the default if it is not there, or something else.
std::string text_at(const json& object, const char* name);
int64_t number_at(const json& object, const char* name, int64_t otherwise);
bool flag_at(const json& object, const char* name);

/// An object in an object; empty if it is none.
json object_at(const json& object, const char* name);

} // namespace roscell
