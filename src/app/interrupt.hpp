#pragma once

namespace vigia::app {

/// From the first call on, SIGINT and SIGTERM ask the program to come to its end, once; a second
/// one ends it at once. Blocking reads return early.
void catch_interrupts();
/// Whether one came.
bool interrupted();

}  // namespace vigia::app
