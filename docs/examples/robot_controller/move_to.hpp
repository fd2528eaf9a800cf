#pragma once

#include "control_loop.hpp"

#include <roscell/node.hpp>

/// The skill "move_to": brings the wrist to the first transform of each message
/// that it gets, and says where the wrist then is.
roscell::actor_skill make_move_to(control_loop& loop);
