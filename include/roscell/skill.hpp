#pragma once

/// All that the author of a skill needs: target `roscell::skill`.
///
/// One class, an `executor`, does the work. `main` registers it for an
/// implementation model and calls `run`, which reads what the node says, moves
/// frames from the inputs through the executor to the outputs, and returns the
/// exit code. Each header says which threads may call what; where nothing is
/// said, calls come from one thread, one at a time.

#include "roscell/skill/environment.hpp"
#include "roscell/skill/errors.hpp"
#include "roscell/skill/executor.hpp"
#include "roscell/skill/frame.hpp"
#include "roscell/skill/handlers.hpp"
#include "roscell/skill/log_line.hpp"
#include "roscell/skill/pacer.hpp"
#include "roscell/skill/parameters.hpp"
#include "roscell/skill/registry.hpp"
#include "roscell/skill/run.hpp"
#include "roscell/skill/safe_state.hpp"
#include "roscell/skill/stop_event.hpp"
#include "roscell/skill/try_out.hpp"
#include "roscell/skill/typed_ports.hpp"
