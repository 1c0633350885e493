/// \file What the system tells the tool to do: stop, or that nobody reads its output any more.
#pragma once

namespace batten::cli {

/// From here on Ctrl-C (SIGINT), SIGTERM and SIGHUP ask to stop, once; the second one ends the process at once. Closed
/// pipes and size limits become errors of the write that meets them.
void handle_signals();

/// True once a signal asked to stop. Progress bars read it and cancel the stage that they watch.
bool stop_asked();

}  // namespace batten::cli
