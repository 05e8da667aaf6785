#pragma once

// Where warnings of the program go that no message on screen carries.

namespace lodestone {

// To stderr: stdout belongs to what commands print. Once, before anything is logged.
void logToStderr();

} // namespace lodestone
